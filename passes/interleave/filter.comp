#version 450 core
// SPDX-License-Identifier: MIT
// Mean over those of the n x n pixels about each that belong to its surface.
// In:  position RGBA32F, normal RGBA16F; light RGBA32F
// Out: light RGBA32F; a 1; all 0 where nothing is
// DISTANCE: the paper's metric of position; else the distance from the pixel's plane.
// Source: Laine, Saransaari, Kontkanen, Lehtinen, Aila 2007, fig. 5.
//         Departs from it: at the image's border the window is shifted inwards, so that every tile
//         stays in it; what is not finite does not count; DISTANCE aside, the metric.
#include "passes/include/pass/view_shared.h"

// Four pixels of an invocation share what they fetch.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D light_map;
layout(binding = 0, rgba32f) writeonly uniform image2D result;
layout(location = 0) uniform ivec4 frame;  // xy: pixels, n at least; z: n
layout(location = 1) uniform vec2 limit;   // alpha, beta

// How far a half float's normal can be from unit length's: each component by 2^-12.
const float normal_error = 1.7321 / 4096.0;
const float down = 1.0 / 256.0; // so that n^2 values of any size have a sum

struct pixel {
    ivec2 first; // of its window
    vec3 p, n;
    float reach;
    vec4 sum; // w: how many
};

pixel pixel_at(ivec2 at)
{
    at = min(at, frame.xy - 1);
    vec3 p = texelFetch(position_map, at, 0).xyz, n = texelFetch(normal_map, at, 0).xyz;
#ifdef DISTANCE
    float reach = limit.x;
#else
    float reach = limit.x * (view.forward.w > 0.5 ? view.scale.y : length(p));
#endif
    // With an even n the window is half a pixel off; sec. 5.2.
    ivec2 first = clamp(at - frame.z / 2, ivec2(0), frame.xy - frame.z);
    return pixel(first, p, n / max(length(n), 1e-6), reach, vec4(0.0));
}

bool of_one_surface(pixel a, vec4 q, vec3 m)
{
    vec3 d = q.xyz - a.p;
#ifdef DISTANCE
    bool near = length(d) < a.reach;
#else
    bool near = abs(dot(d, a.n)) < a.reach + normal_error * length(d);
#endif
    return near && q.w > 0.5 && dot(m, a.n) > limit.y * length(m);
}

void add(inout pixel a, ivec2 me, ivec2 at, vec4 q, vec3 m, vec4 light)
{
    bool in_window = all(greaterThanEqual(at, a.first)) && all(lessThan(at, a.first + frame.z));
    if (in_window && (at == me || of_one_surface(a, q, m)))
        a.sum += light;
}

void store(pixel a, ivec2 at)
{
    if (any(greaterThanEqual(at, frame.xy)))
        return;
    bool there = texelFetch(position_map, at, 0).w > 0.5;
    vec3 mean = min(a.sum.rgb / (max(a.sum.w, 1.0) * down), vec3(3.0e38));
    imageStore(result, at, there ? vec4(mean, 1.0) : vec4(0.0));
}

void main()
{
    ivec2 me = ivec2(gl_GlobalInvocationID.xy) * 2;
    if (any(greaterThanEqual(me, frame.xy)))
        return;
    pixel a = pixel_at(me), b = pixel_at(me + ivec2(1, 0));
    pixel c = pixel_at(me + ivec2(0, 1)), d = pixel_at(me + 1);
    ivec2 end = d.first + frame.z;
    for (int y = a.first.y; y < end.y; y++)
        for (int x = a.first.x; x < end.x; x++) {
            ivec2 at = ivec2(x, y);
            vec4 q = texelFetch(position_map, at, 0);
            vec3 m = texelFetch(normal_map, at, 0).xyz;
            vec3 e = texelFetch(light_map, at, 0).rgb;
            bool finite = !any(isnan(e)) && !any(isinf(e));
            vec4 light = finite ? vec4(e * down, 1.0) : vec4(0.0);
            add(a, me, at, q, m, light);
            add(b, me + ivec2(1, 0), at, q, m, light);
            add(c, me + ivec2(0, 1), at, q, m, light);
            add(d, me + 1, at, q, m, light);
        }
    store(a, me);
    store(b, me + ivec2(1, 0));
    store(c, me + ivec2(0, 1));
    store(d, me + 1);
}
