// SPDX-License-Identifier: MIT
// The view as the uniform buffer ag_scene_res.view holds it; read by C and GLSL.
#ifndef PASS_VIEW_SHARED_H
#define PASS_VIEW_SHARED_H

#include "shared_types.h"

#ifndef GL_core_profile
typedef struct ag_view_block ag_view_block;
#endif

struct ag_view_block {
    ag_mat4 view_proj; // render space to clip, reversed Z
    ag_mat4 inv_view_proj;
    ag_vec4 forward; // xyz unit; w 1: orthographic, 0: perspective
    ag_vec4 scale;   // x: a power of two that brings the scene's diagonal to (1/2, 1], 1/m;
                     // y: 1 / x; zw unused
    ag_ivec4 size;   // xy: pixels
};

#ifdef GL_core_profile
layout(std140, binding = 0) uniform ag_view_uniform
{
    ag_view_block view;
};

// Unit vector from a point in render space to the viewer.
vec3 view_to_eye(vec3 position)
{
    return view.forward.w > 0.5 ? -view.forward.xyz : -normalize(position);
}
#endif

#endif // PASS_VIEW_SHARED_H
