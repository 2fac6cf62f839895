// SPDX-License-Identifier: MIT
#ifndef TEST_IMAGE_FEED_H
#define TEST_IMAGE_FEED_H

// G-buffers that a test makes up, so that passes run alone:
//
//     feed f;
//     feed_init(&f, 65, 63, 0);
//     feed_plane(&f, (int[4]){ 0, 0, 65, 63 }, (double[3]){ 0, 0, 1 }, 2);
//     feed_begin(&f);
//     ... declare on f.graph with f.scene and f.gbuffer, fg_export() what to look at ...
//     feed_run(&f);
//     float *rgba = feed_texels(&f, res);
//     feed_finish(&f);

#include "fixture.h"

#include <pass/frame.h>

// A camera at the origin that looks along -z; the image's longer edge spans 45 degrees. All is
// background at first.
typedef struct feed {
    int width, height;
    int layers; // 0: the view's; else maps of as many light faces
    bool orthographic;
    float *depth;         // rows from the lower left on, layers in turn
    float (*normal)[4];   // feed_begin() rounds it to half floats
    float (*position)[4]; // render space
    fg_graph *graph;
    ag_scene_res scene; // view and faces alone
    ag_gbuffer gbuffer; // depth, normal and position alone
    uint32_t textures[3], buffers[2];
} feed;

void feed_init(feed *f, int width, int height, int layers);
void feed_finish(feed *f);

// Shows the plane n . p = d within pixels x0, y0 .. x1, y1 of layer 0 where it is nearer than what
// is there. `n` need not be of unit length.
void feed_plane(feed *f, const int pixels[4], const double n[3], double d);

// What differs from seed to seed: where the pixel is, the planes, the noise.
typedef enum feed_kind {
    FEED_EMPTY = 0,
    FEED_ONE_PIXEL,
    FEED_ONE_PLANE, // fills the view
    FEED_PLANES,    // eight rectangles, each of a plane of its own
    FEED_NOISE,     // every pixel of a plane of its own; a fifth shows nothing
    FEED_KINDS,
} feed_kind;

void feed_scene(feed *f, feed_kind kind, uint32_t seed);

// Uploads, and starts a declaration on f->graph.
void feed_begin(feed *f);
// Compiles and runs; the test fails if either does.
void feed_run(feed *f);

// Exported contents, the caller's to free: rgba of all layers, or `words` words of a buffer.
float *feed_texels(const feed *f, fg_res res);
uint32_t *feed_words(const feed *f, fg_res res, size_t words);

// The same numbers on every machine: [0, 1).
double feed_random(uint32_t *state);

#endif // TEST_IMAGE_FEED_H
