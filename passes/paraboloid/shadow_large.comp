#version 450 core
// SPDX-License-Identifier: MIT
// Triangles of many texels, one a work group; an invocation draws rows of it.
// In:  shadow_triangle[], shadow_eye[], a list, its count; MASK: corners, textures
// Out: scratch
#include "passes/paraboloid/draw.glsl"
#include "passes/paraboloid/scratch.glsl"

layout(local_size_x = 32) in;

layout(binding = 2) uniform usamplerBuffer list;
layout(std430, binding = 1) readonly buffer count_buffer
{
    uint counts[4];
};
layout(location = 2) uniform ivec2 from; // x: which list; y: where it begins

// What of a row, x in [-1, 1] at y, may be on the inner side of plane `n`: a parabola's sign. Where that
// is two pieces, and both are within `span`, it is left as it is; so it is where the row hardly crosses
// the plane, and rounding says where.
void narrow(vec3 n, float y, inout vec2 span)
{
    float c = 2.0 * n.y * y + n.z * (1.0 - y * y);
    float size = n.x * n.x + abs(n.z * c), d = n.x * n.x + n.z * c + sign(n.z) * 1e-6 * size;
    float q = n.x + (n.x < 0.0 ? -1.0 : 1.0) * sqrt(max(d, 0.0));
    vec2 ends = clamp(vec2(q, -c) / vec2(abs(n.z) > 1e-30 ? n.z : 1e-30,
                                         abs(q) > 1e-30 ? q : 1e-30), -4.0, 4.0);
    float low = min(ends.x, ends.y), high = max(ends.x, ends.y);
    float largest = max(max(abs(n.x), abs(n.y)), abs(n.z));
    bool between = n.z >= 0.0, cuts = d > 0.0, sure = abs(q) > 1e-3 * largest;
    vec2 found = between ? (cuts ? vec2(max(span.x, low), min(span.y, high)) : vec2(2.0, -2.0)) : span;
    found.x = !between && cuts && low < found.x ? max(found.x, high) : found.x;
    found.y = !between && cuts && high > found.y ? min(found.y, low) : found.y;
    span = sure ? found : span;
}

float half_chord(float radius, float y)
{
    return sqrt(max(radius * radius - y * y, 0.0));
}

// Columns of a row to look at, of those in `ends`: from x to y, and those beyond the horizon, up to z
// and from w. `ends` loses what is beyond the reach of lookups.
ivec4 columns(edges n, int row, inout ivec2 ends)
{
    float size = float(frame.x), y = (float(row) + 0.5) * (2.0 / size) - 1.0;
    float chord = half_chord(paraboloid_horizon, y), outmost = half_chord(1.0 + reach * 2.0 / size, y);
    vec2 span = (vec2(ends) + vec2(0.5, -0.5)) * (2.0 / size) - 1.0;
    span = vec2(max(span.x, -chord), min(span.y, chord));
    narrow(n.a, y, span);
    narrow(n.b, y, span);
    narrow(n.c, y, span);
    span = clamp(span, -2.0, 2.0);
    vec4 at = (0.5 + 0.5 * vec4(span, -chord, chord)) * size - 0.5;
    vec2 most_ends = (0.5 + 0.5 * vec2(-outmost, outmost)) * size - 0.5;
    ends = ivec2(max(ends.x, int(ceil(most_ends.x - 0.15))), min(ends.y, int(floor(most_ends.y + 1.15))));
    return ivec4(ceil(at.x - 0.15), floor(at.yz + 0.15), ceil(at.w - 0.15));
}

// The first column from x on that is to be looked at.
int skip(int x, ivec4 c)
{
    x = x > c.z && x < c.x ? max(x, min(c.x, c.w)) : x;
    return x > c.z && x > c.y ? max(x, c.w) : x;
}

void draw_row(int triangle, int map, seen s, edges n, int row, ivec2 ends)
{
    ivec4 c = columns(n, row, ends);
    int x = skip(ends.x, c);
    while (x < ends.y) {
        vec4 ray = ray_of(ivec2(x, row), float(frame.x));
        vec3 w = weights_of(n, ray);
        while (min(min(w.x, w.y), w.z) < 0.0 && x < ends.y) {
            x = skip(x + 1, c);
            ray = ray_of(ivec2(x, row), float(frame.x));
            w = weights_of(n, ray);
        }
        if (x < ends.y)
            put(triangle, map, ivec2(x, row), meet(s, ray, w), w);
        x = skip(x + 1, c);
    }
}

void main()
{
    int i = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    if (i >= int(counts[from.x]))
        return;
    uvec4 entry = texelFetch(list, from.y + i);
    int triangle = int(entry.x), map = int(entry.y);
    ivec2 low = ivec2(entry.z & 65535u, entry.z >> 16), extent = ivec2(entry.w & 65535u, entry.w >> 16);
    for (int row = int(gl_LocalInvocationIndex); row < extent.y; row += 32) {
        seen s = see(fetch_triangle(triangle), fetch_eye(frame.y + map));
        draw_row(triangle, map, s, edges_of(s), low.y + row, low.x + ivec2(0, extent.x));
    }
}
