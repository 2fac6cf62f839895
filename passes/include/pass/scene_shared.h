// SPDX-License-Identifier: MIT
// The scene's buffers as C writes and GLSL reads them. Everything is in render space.
#ifndef PASS_SCENE_SHARED_H
#define PASS_SCENE_SHARED_H

#include "shared_types.h"

#ifndef GL_core_profile
typedef struct ag_gpu_instance ag_gpu_instance;
typedef struct ag_gpu_texture_ref ag_gpu_texture_ref;
typedef struct ag_gpu_material ag_gpu_material;
typedef struct ag_gpu_light ag_gpu_light;
typedef struct ag_gpu_face ag_gpu_face;
#endif

struct ag_gpu_instance {
    ag_vec4 rows[3];        // node to render space: position = rows * (p, 1)
    ag_vec4 normal_rows[3]; // its inverse transpose, up to a positive factor
    ag_ivec4 info;          // x: material; y: 1 where front faces wind clockwise
};

struct ag_gpu_texture_ref {
    ag_vec4 row_u; // u' = row_u.xyz . (u, v, 1)
    ag_vec4 row_v;
    ag_ivec4 place; // x: bin, -1: none; y: layer; z: UV set; w: wrap u | wrap v << 2 (ag_wrap)
};

struct ag_gpu_material {
    ag_vec4 base_color;
    ag_vec4 emissive; // rgb W/(m^2 sr); a: alpha cutoff, -1: opaque
    ag_vec4 factors;  // x: metallic; y: roughness; z: 1: emits from both faces
    ag_gpu_texture_ref base_color_tex;
    ag_gpu_texture_ref metallic_roughness_tex;
    ag_gpu_texture_ref emissive_tex;
};

#define AG_GPU_POINT 0
#define AG_GPU_SPOT 1
#define AG_GPU_DIRECTIONAL 2
#define AG_GPU_COSINE_SPOT 3

struct ag_gpu_light {
    ag_vec4 position;  // xyz; w: 1 / max(1e-3, cos_inner - cos_outer)
    ag_vec4 direction; // xyz: unit, the way the light goes; w: cos_outer
    ag_vec4 intensity; // rgb: W/sr, directional W/m^2
    ag_ivec4 info;     // x: AG_GPU_*; y: first face; z: faces
};

// A frustum of a light: clip = (right . d / right.w, up . d / up.w, z, forward . d) with d the way
// from the eye; orthographic w is 1.
struct ag_gpu_face {
    ag_mat4 view_proj; // reversed Z; 1 at znear, 0 at infinity (orthographic: at the far plane)
    ag_vec4 eye;       // xyz; w: 1: orthographic
    ag_vec4 right;     // unit; w: half the width: tangent, orthographic: m
    ag_vec4 up;        // unit; w: half the height
    ag_vec4 forward;   // unit; w: znear, orthographic: 1 / depth range
    ag_ivec4 info;     // x: light
};

#endif // PASS_SCENE_SHARED_H
