#version 450 core
// SPDX-License-Identifier: MIT
// Light of near VPLs at every pixel, added to that of all others, which interleaved sampling has
// smoothed: one near VPL in n^2 pixels, times n^2, no filter makes whole beside an edge.
// In:  position RGBA32F, normal RGBA16F; ag_vpl[], count; light RGBA32F, E / pi; VISIBILITY: 2
// Out: light RGBA32F
// A work group finds the VPLs that may be near one of its pixels, 256 at a time.
#include "passes/include/pass/view_shared.h"
#include "passes/include/pass/vpl_shared.h"
#include "passes/gather/near.glsl"
#ifdef VISIBILITY
#include "passes/gather/visible.glsl"
#endif

const int edge = 16;
const int group = edge * edge;
const float pi = 3.14159265358979;

layout(local_size_x = edge, local_size_y = edge) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D light_map;
layout(std430, binding = 0) readonly buffer vpl_buffer
{
    ag_vpl vpls[];
};
layout(std430, binding = 1) readonly buffer count_buffer
{
    uvec4 count;
};
layout(binding = 0, rgba32f) writeonly uniform image2D result;

shared uint low[3], high[3]; // of the pixels' box, as ordered() has them
shared uint found[group / 32]; // a bit for each of 256 VPLs, so that they are summed in order

// Floats as integers of the same order, and back.
uint ordered(float v)
{
    uint bits = floatBitsToUint(v);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float unordered(uint bits)
{
    return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits);
}

void measure(bool there, vec3 p)
{
    int me = int(gl_LocalInvocationIndex);
    if (me < 3) {
        low[me] = 0xffffffffu;
        high[me] = 0u;
    }
    barrier();
    for (int k = 0; k < 3 && there; k++) {
        atomicMin(low[k], ordered(p[k]));
        atomicMax(high[k], ordered(p[k]));
    }
    barrier();
}

// Whether VPL j may be near something in the box; without a pixel the box is empty and none is.
bool reaches_box(int j, vec3 box_low, vec3 box_high, float unit)
{
    vec3 q = vpls[j].position_area.xyz * unit;
    vec3 m = vpls[j].normal.xyz, d = max(max(box_low - q, q - box_high), vec3(0.0));
    vec3 ahead = mix(box_low, box_high, greaterThan(m, vec3(0.0))); // the corner farthest along m
    return dot(m, ahead - q) > 0.0 && dot(d, d) < near_areas * vpls[j].position_area.w * unit * unit;
}

// Whether VPL j lights a pixel from near.
bool is_near(int j, vec3 p, vec3 n, float unit)
{
    vec3 d = vpls[j].position_area.xyz * unit - p;
    float area = vpls[j].position_area.w * unit * unit;
    float cos_j = max(-dot(vpls[j].normal.xyz, d), 0.0); // times |d|
    return dot(n, d) > 0.0 && patch_is_near(dot(d, d), cos_j, area);
}

vec3 light_of(int j, vec3 p, vec3 n, float unit)
{
    ag_vpl v = vpls[j];
    vec3 d = v.position_area.xyz * unit - p;
    float share = patch_share_on_surface(d, n, v, v.position_area.w * unit * unit);
#ifdef VISIBILITY
    share *= vpl_visibility(vpl_open(j, int(count.x)), p, n);
#endif
    return v.flux.rgb * share;
}

// Of the 32 VPLs from `first` on that may be near the work group. What takes long is done for those
// that are near the pixel itself: neighbours each take their own next one at a time.
vec3 light_of_word(uint bits, int first, vec3 p, vec3 n, float unit)
{
    uint mine = 0u;
    for (; bits != 0u; bits &= bits - 1u)
        if (is_near(first + findLSB(bits), p, n, unit))
            mine |= bits & (~bits + 1u);
    vec3 sum = vec3(0.0);
    for (; mine != 0u; mine &= mine - 1u)
        sum += light_of(first + findLSB(mine), p, n, unit);
    return sum;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), last = view.size.xy - 1;
    float unit = view.scale.x;
    vec4 position = texelFetch(position_map, min(at, last), 0);
    vec3 p = position.xyz * unit, n = texelFetch(normal_map, min(at, last), 0).xyz;
    bool inside = all(lessThanEqual(at, last));
    bool there = inside && position.w > 0.5 && !any(isnan(p)) && !any(isinf(p));
    int me = int(gl_LocalInvocationIndex), total = int(count.x);
    n /= max(length(n), 1e-6);
    measure(there, p);
    bool empty = low[0] > high[0];
    vec3 box_low = empty ? vec3(0.0) : vec3(unordered(low[0]), unordered(low[1]), unordered(low[2]));
    vec3 box_high = empty ? vec3(0.0) : vec3(unordered(high[0]), unordered(high[1]), unordered(high[2]));
    vec3 sum = vec3(0.0);
    for (int start = 0; start < total; start += group) {
        if (me < group / 32)
            found[me] = 0u;
        barrier();
        if (!empty && start + me < total && reaches_box(start + me, box_low, box_high, unit))
            atomicOr(found[me >> 5], 1u << (me & 31));
        barrier();
        for (int word = 0; word < group / 32; word++)
            sum += light_of_word(there ? found[word] : 0u, start + 32 * word, p, n, unit);
        barrier();
    }
    if (!inside)
        return;
    vec4 light = texelFetch(light_map, at, 0);
    vec3 all = there ? light.rgb + sum * (unit * unit / pi) : light.rgb;
    imageStore(result, at, vec4(min(all, vec3(3.0e38)), light.a));
}
