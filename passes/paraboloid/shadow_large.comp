#version 450 core
// SPDX-License-Identifier: MIT
// Triangles of many texels, one a work group, by blocks of 8x8 texels.
// In:  shadow_triangle[], shadow_eye[], list, its count; MASK: corners, textures
// Out: scratch
#include "passes/paraboloid/draw.glsl"
#include "passes/paraboloid/scratch.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = 3) readonly buffer list_buffer
{
    uvec4 list[];
};
layout(std430, binding = 7) readonly buffer count_buffer
{
    uint counts[4];
};

// The most that plane `n` has of the rays in a box of (x, y) / (1 + z): along each axis a parabola.
float most_in(vec3 n, vec2 low, vec2 high)
{
    vec2 top = clamp(n.xy / (abs(n.z) > 1e-37 ? n.z : 1e-37), low, high);
    vec2 f = max(max(low * (2.0 * n.xy - n.z * low), high * (2.0 * n.xy - n.z * high)),
                 top * (2.0 * n.xy - n.z * top));
    return f.x + f.y + n.z + 1e-6 * (abs(n.x) + abs(n.y) + abs(n.z));
}

bool may_cover(edges n, ivec2 block)
{
    vec2 low = (vec2(block) + 0.5) * (2.0 / float(frame.x)) - 1.0, high = low + 14.0 / float(frame.x);
    vec2 outmost = max(abs(low), abs(high));
    float rim = dot(outmost, outmost) > horizon * horizon ? (reach + 0.1) * 2.0 / float(frame.x) : 0.0;
    low -= rim;
    high += rim;
    return most_in(n.a, low, high) >= 0.0 && most_in(n.b, low, high) >= 0.0 &&
           most_in(n.c, low, high) >= 0.0;
}

void main()
{
    uint i = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (i >= counts[1])
        return;
    uvec4 entry = list[i];
    int triangle = int(entry.x), map = int(entry.y);
    ivec2 low = ivec2(entry.z & 65535u, entry.z >> 16), extent = ivec2(entry.w & 65535u, entry.w >> 16);
    seen s = see(triangle, frame.y + map);
    edges n = edges_of(s);
    ivec2 at = ivec2(0);
    while (at.y < extent.y) {
        // Blocks without a texel inside are passed over in a loop of their own, which costs less where
        // both sides of a branch run.
        while (at.y < extent.y && !may_cover(n, low + at))
            at = at.x + 8 < extent.x ? at + ivec2(8, 0) : ivec2(0, at.y + 8);
        ivec2 mine = at + ivec2(gl_LocalInvocationID.xy);
        if (all(lessThan(mine, extent)))
            draw_texel(triangle, map, s, n, low + mine);
        at = at.x + 8 < extent.x ? at + ivec2(8, 0) : ivec2(0, at.y + 8);
    }
}
