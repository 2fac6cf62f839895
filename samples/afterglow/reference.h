// SPDX-License-Identifier: MIT
#ifndef REFERENCE_H
#define REFERENCE_H

#include "image.h"

#include <pass/scene.h>

FG_BEGIN

// The truth that plugins are measured against: a CPU path tracer that shares the scene and
// nothing else with them.
//
// Bounces count transports from surface to surface. 0: what a surface emits and what it reflects
// of punctual lights. N: also light that went from surface to surface up to N times; the light
// of an emissive surface on another one is thus bounce 1. `direct` is bounce 0, `indirect` the
// rest.
typedef enum reference_layer {
    REFERENCE_RADIANCE = 0, // direct + indirect
    REFERENCE_DIRECT,
    REFERENCE_INDIRECT, // outgoing radiance, that is albedo x E / pi
    REFERENCE_ALBEDO,
    REFERENCE_NORMAL,
    REFERENCE_POSITION, // world
} reference_layer;

typedef enum reference_filter {
    REFERENCE_POINT = 0, // pixel centres, as a rasteriser samples
    REFERENCE_BOX,
} reference_filter;

typedef struct reference_desc {
    const fg_log *log;
    const ag_scene *scene; // at its time
    const ag_camera *camera;
    int width, height;
    int bounces; // [0, 64]
    int spp;     // samples a pixel, [1, 1048576]
    uint64_t seed;
    reference_layer layer;
    reference_filter filter;
    bool unshadowed_bounce; // every surface along a bounce ray counts (bounces >= 1), lit as it is,
                            // none hides another
    int threads;            // 0: all. The picture does not depend on it.
    void (*progress)(void *user, double fraction); // optional; from one thread at a time
    void *progress_user;
} reference_desc;

// Errors: FG_ERR_INVALID, FG_ERR_MEMORY.
FG_NODISCARD fg_status reference_render(const reference_desc *desc, image *out);

// The mean of two pictures of (spp + 1) / 2 samples with the seeds 2 seed and 2 seed + 1, and the
// RMS of the noise that is left in it: half that of their difference, since the two are
// independent.
FG_NODISCARD fg_status reference_render_halves(const reference_desc *desc, image *out,
                                               double *noise);

FG_END

#endif // REFERENCE_H
