// SPDX-License-Identifier: MIT
#ifndef PASS_LIGHTING_H
#define PASS_LIGHTING_H

#include <pass/frame.h>

FG_BEGIN

// What a pass that draws one face of a light hands to its callback.
typedef struct ag_face_user {
    void *owner;
    int face;
} ag_face_user;

// Shadow maps of all lights: passes "shadow.face0" ..., a layer a face.
//
// Shapes: DEPTH32F [size x size x faces], reversed Z.
// Left out where the scene has no light or no geometry.
typedef struct ag_shadow_pass {
    const ag_gpu_scene *gpu;
    ag_scene_res scene;
    fg_res maps;
    int size; // texels
    ag_face_user faces[AG_MAX_FACES];
} ag_shadow_pass;

// `size`: texels, [1, 8192]; 0: 2048 for up to 4 faces, 1024 for up to 24, else 512.
FG_API void ag_shadow_declare(ag_shadow_pass *pass, fg_graph *g, const ag_gpu_scene *gpu,
                              const ag_scene_res *scene, int size);

// Emission and the reflection of punctual lights: pass "direct.light".
//
// A surface counts by its shading normal n, on the side that is seen: albedo / pi E max(0, n . l).
// A light behind the triangle's own plane gives nothing. Shadows by percentage closer filtering
// against the receiver's plane: their edges are 1 texel of the shadow map wide with 4 taps, 3
// with 16.
//
// Shapes: out RGBA32F of the frame's size; a 1.
// Units:  radiance, W/(m^2 sr).
// Source: Reeves, Salesin, Cook. Rendering Antialiased Shadows with Depth Maps. SIGGRAPH 1987.
//         Departs from it: the taps are the texels around the point, not random ones.
typedef struct ag_direct_pass {
    const ag_gpu_scene *gpu;
    ag_scene_res scene;
    ag_gbuffer gbuffer;
    fg_res shadows;
    int taps;
    fg_res out;
} ag_direct_pass;

typedef struct ag_direct_desc {
    const ag_scene_res *scene; // read now, as the next
    const ag_gbuffer *gbuffer;
    fg_res shadows; // may have been left out or be null: nothing is shadowed then, and there is no
                    // light
    int taps;       // of the filter: 4 (or 0), 16
} ag_direct_desc;

FG_API void ag_direct_declare(ag_direct_pass *pass, fg_graph *g, const ag_gpu_scene *gpu,
                              const ag_direct_desc *desc);

FG_END

#endif // PASS_LIGHTING_H
