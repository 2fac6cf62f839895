// SPDX-License-Identifier: MIT
#ifndef TEST_IMAGE_PARABOLOID_H
#define TEST_IMAGE_PARABOLOID_H

// Paraboloid maps of a scene, alone in a graph, and what rays say instead.

#include "feed.h"

#include <pass/paraboloid.h>
#include <pass/rays.h>

typedef struct maps_host {
    ag_scene *scene; // owned
    ag_gpu_scene *gpu;
    fg_graph *graph;
    ag_scene_res res;
    ag_paraboloid_maps *maps;
    ag_paraboloid_pass pass;
    ag_rays *rays; // about `centre`, without what moves
    ag_view view;
    double centre[3];
    double unit; // of the maps, 1/m
    int size;
    bool fail; // a pass before the maps' fails
    uint32_t receivers, answers;
    int asked[2]; // VPL, receivers
} maps_host;

// Takes the scene over. The view is from the middle of the scene's box.
void maps_init(maps_host *h, ag_scene *scene, int size, int capacity);
void maps_finish(maps_host *h);

ag_scene *maps_scene(const char *builtin);

// Sets the eyes and runs a frame.
fg_status maps_draw(maps_host *h, const ag_paraboloid_eye *eyes, int count);

// The texels of a slot, rows of reciprocal distances; the caller's to free.
float *maps_read(const maps_host *h, int slot);

// Where a random ray from a random place within the scene's box ends.
ag_paraboloid_eye maps_eye(const maps_host *h, uint32_t *seed, int slot);

// The unit direction of a place in a map, texels' middles at whole numbers; false where no lookup
// comes. What is beyond the horizon shows what is just inside of it.
bool maps_ray(const ag_paraboloid_eye *eye, int size, double x, double y, double d[3]);

// Reciprocal distance by a ray, 0 where it meets nothing, and how far off a map may be.
double maps_by_ray(const maps_host *h, const ag_paraboloid_eye *eye, const double d[3],
                   double *off);

typedef struct maps_verdict {
    int texels, edges, wrong;
} maps_verdict;

// Holds every `step`-th texel along both axes against a ray.
maps_verdict maps_check(const maps_host *h, const ag_paraboloid_eye *eye, const float *texels,
                        int step);

// A receiver: place in the world, unit normal.
typedef struct maps_receiver {
    double position[3];
    float normal[3];
} maps_receiver;

// What a frame's lookups say of receivers, for eye `eye` of those set; the caller's to free. Runs a
// frame with what maps_draw() set last, none of it fresh.
float *maps_look_up(maps_host *h, int eye, const maps_receiver *receivers, int count);

#endif // TEST_IMAGE_PARABOLOID_H
