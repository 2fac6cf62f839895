#version 450 core
// SPDX-License-Identifier: MIT
// Triangles of some texels, one an invocation.
// In:  shadow_triangle[], shadow_eye[], a list, its count; MASK: corners, textures
// Out: scratch
#include "passes/paraboloid/draw.glsl"
#include "passes/paraboloid/scratch.glsl"

layout(local_size_x = 64) in;

layout(binding = 2) uniform usamplerBuffer list;
layout(std430, binding = 1) readonly buffer count_buffer
{
    uint counts[4];
};
layout(location = 2) uniform ivec2 from; // x: which list; y: where it begins

void main()
{
    int group = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    int i = group * 64 + int(gl_LocalInvocationIndex);
    if (i >= int(counts[from.x]))
        return;
    uvec4 entry = texelFetch(list, from.y + i);
    int triangle = int(entry.x), map = int(entry.y);
    ivec2 low = ivec2(entry.z & 65535u, entry.z >> 16), extent = ivec2(entry.w & 65535u, entry.w >> 16);
    draw_box(triangle, map, see(fetch_triangle(triangle), fetch_eye(frame.y + map)), low, extent);
}
