#version 450 core
// SPDX-License-Identifier: MIT
// Brings the scene's vertices to render space and to clip space.
// In:  ag_vertex attributes; the draw id, one per instance
// Out: render-space position, normal (not unit), UV sets, vertex colour, instance
// FACE: through light face `face` instead of the view.
#include "passes/include/pass/view_shared.h"
#include "passes/include/pass/scene_shared.h"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_uv;
layout(location = 3) in vec4 in_color;
layout(location = 4) in uint in_draw;

layout(std430, binding = 0) readonly buffer instance_buffer
{
    ag_gpu_instance instances[];
};

#ifdef FACE
layout(location = 0) uniform int face;
layout(std430, binding = 2) readonly buffer face_buffer
{
    ag_gpu_face faces[];
};
#endif

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 uv;
layout(location = 3) out vec4 color;
layout(location = 4) flat out ivec2 info; // material, clockwise

void main()
{
    vec4 p = vec4(in_position, 1.0);
    vec4 rows[3] = instances[in_draw].rows;
    vec4 normal_rows[3] = instances[in_draw].normal_rows;
    position = vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p));
    normal = vec3(dot(normal_rows[0].xyz, in_normal), dot(normal_rows[1].xyz, in_normal),
                  dot(normal_rows[2].xyz, in_normal));
    uv = in_uv;
    color = in_color;
    info = instances[in_draw].info.xy;
#ifdef FACE
    gl_Position = faces[face].view_proj * vec4(position, 1.0);
#else
    gl_Position = view.view_proj * vec4(position, 1.0);
#endif
}
