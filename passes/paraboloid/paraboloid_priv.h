// SPDX-License-Identifier: MIT
#ifndef PARABOLOID_PRIV_H
#define PARABOLOID_PRIV_H

#include "draw_shared.h"

#include <pass/paraboloid.h>

enum {
    PARABOLOID_BATCH = 32,  // maps at once
    PARABOLOID_CLASSES = 3, // lists: list.glsl
};

// What is drawn: the scene's static triangles, those of MASK last.
typedef struct paraboloid_triangles {
    shadow_triangle *triangles;
    shadow_corner *corners; // three of each with MASK
    int32_t (*textures)[4]; // as mask.glsl has them
    uint8_t *alphas;
    int count, opaque, texture_count;
    size_t alpha_count;
    double centre[3];
    double unit; // 1/m, a power of two
} paraboloid_triangles;

// FG_ERR_MEMORY; FG_ERR_UNSUPPORTED: more than INT32_MAX triangles or bytes of alpha. Logged.
fg_status paraboloid_triangles_init(paraboloid_triangles *t, const fg_log *log,
                                    const ag_scene *scene);
void paraboloid_triangles_finish(paraboloid_triangles *t); // accepts a half-built one

// A map's owner.
typedef struct paraboloid_slot {
    double position[3];
    float frame[3][3]; // tangent, bitangent, normal
    bool asked;        // and not drawn
} paraboloid_slot;

typedef enum paraboloid_buffer {
    PARABOLOID_TRIANGLES = 0,
    PARABOLOID_CORNERS,
    PARABOLOID_TEXTURES,
    PARABOLOID_ALPHAS,
    PARABOLOID_LISTS,   // uvec4[PARABOLOID_CLASSES * list]
    PARABOLOID_COUNTS,  // uint[4]
    PARABOLOID_GROUPS,  // uvec4[PARABOLOID_CLASSES]
    PARABOLOID_DRAWN,   // shadow_eye[capacity]
    PARABOLOID_SCRATCH, // uint[batch * size * size]
    PARABOLOID_EYES,    // ivec4, ag_paraboloid_eye_block[capacity]
    PARABOLOID_BUFFERS,
} paraboloid_buffer;

// The order is that of the shaders' bindings.
typedef enum paraboloid_view {
    PARABOLOID_VIEW_TRIANGLES = 0,
    PARABOLOID_VIEW_EYES,
    PARABOLOID_VIEW_LISTS,
    PARABOLOID_VIEWS,
} paraboloid_view;

struct ag_paraboloid_maps {
    const fg_log *log;
    int size, capacity;
    int edge, layers; // maps along a layer's edge; layers
    int batch, list;  // maps drawn at once; entries of a list
    double centre[3], unit;
    int triangles, opaque;
    uint32_t texture, buffers[PARABOLOID_BUFFERS];
    uint64_t sizes[PARABOLOID_BUFFERS];
    uint32_t views[PARABOLOID_VIEWS]; // buffers as textures
    paraboloid_slot *slots;
    ag_paraboloid_eye_block *eyes; // of the next frame
    int eye_count;
    bool changed; // since they were uploaded
    shadow_eye *fresh;
    int *fresh_slots; // of `fresh`
    int fresh_count;
    int drawn;
};

// Draws the fresh maps.
fg_status paraboloid_draw(const fg_run *run, ag_paraboloid_maps *m);

#endif // PARABOLOID_PRIV_H
