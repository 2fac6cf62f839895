// SPDX-License-Identifier: MIT
#ifndef REFERENCE_PRIV_H
#define REFERENCE_PRIV_H

#include "reference.h"

#include <pass/rays.h>

// ---- samples (reference_sampler.c) ----------------------------------------------------

// The stream of one pixel. Pair `pair` of sample `index`, in [0, 1)^2: over all indices the
// pairs are a scrambled (0,2)-sequence, and the streams of two pixels know nothing of each other.
typedef struct sampler {
    uint32_t key; // of pixel and seed
} sampler;

sampler sampler_of(uint64_t seed, int x, int y);
void sampler_pair(sampler s, uint32_t index, uint32_t pair, double out[2]);

// ---- transport (reference_path.c) -----------------------------------------------------

typedef struct tracer {
    const ag_scene *scene;
    const ag_rays *rays;
    double origin[3]; // world position of the rays' origin
    int bounces;
    bool unshadowed;
    double middle[3], radius; // a sphere around the scene, relative to `origin`
    double *shares;           // of each light in what light_ray() picks; sums to 1 or is all 0
} tracer;

typedef struct ray {
    float from[3], direction[3]; // relative to the tracer's origin
} ray;

// A point on a surface and what it is like for whom looks at it from one side.
typedef struct point {
    float position[3]; // relative to the tracer's origin
    double face[3];    // unit, of the triangle, turned to the viewer
    double normal[3];  // unit, interpolated, turned with the face
    double albedo[3];
    double emission[3]; // towards the viewer, W/(m^2 sr)
} point;

void point_of(const tracer *t, const ag_hit *hit, point *out);

double vec_dot(const double a[3], const double b[3]);
// The unit vector whose cosine to the unit vector `axis` is `cosine`, turned by `angle` around it.
void vec_around(const double axis[3], double cosine, double angle, double out[3]);

// What the point sends to its viewer of punctual lights, shadowed, plus what it emits: bounce 0.
void point_direct(const tracer *t, const point *p, double out[3]);

// Room for the hits of one ray; grows, owned by one thread.
typedef struct hit_list {
    ag_hit *hits;
    int capacity;
} hit_list;

// One sample of what the point sends to its viewer of bounces 1 to `t->bounces`. False: out of
// memory for `list`, which only unshadowed bounces use.
bool point_indirect(const tracer *t, const point *p, sampler s, uint32_t index, hit_list *list,
                    double out[3]);

// ---- rays from lights (reference_light.c) ---------------------------------------------

// Of a tracer with scene, rays and origin. False: out of memory.
bool lights_prepare(tracer *t);
void lights_finish(tracer *t);

// A ray that a light sends: `pick` and `u` in [0, 1) choose which. Its number, -1: no light is
// worth it.
int light_ray(const tracer *t, double pick, const double u[2], ray *out);

// How densely light_ray() covers the surface at the point by that light, per sample and m^2.
double light_density(const tracer *t, int light, const point *p, const double to_light[3],
                     double distance);

#endif // REFERENCE_PRIV_H
