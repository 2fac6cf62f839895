#version 450 core
// SPDX-License-Identifier: MIT
// Triangles of few texels, one an invocation.
// In:  shadow_triangle[], shadow_eye[], list, its count; MASK: corners, textures
// Out: scratch
#include "passes/paraboloid/draw.glsl"
#include "passes/paraboloid/list.glsl"
#include "passes/paraboloid/scratch.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 3) readonly buffer list_buffer
{
    uvec2 list[];
};
layout(std430, binding = 7) readonly buffer count_buffer
{
    uint counts[4];
};

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint i = group * 64u + gl_LocalInvocationIndex;
    if (i >= counts[0])
        return;
    int map, triangle = int(list[i].x);
    ivec2 low, extent;
    small_unpack(list[i].y, map, low, extent);
    seen s = see(triangle, frame.y + map);
    edges n = edges_of(s);
    ivec2 at = ivec2(0);
    while (at.y < extent.y) {
        draw_texel(triangle, map, s, n, low + at);
        at = at.x + 1 < extent.x ? at + ivec2(1, 0) : ivec2(0, at.y + 1);
    }
}
