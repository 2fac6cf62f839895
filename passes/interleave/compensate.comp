#version 450 core
// SPDX-License-Identifier: MIT
// Adds the light of near surfaces that a bounded geometry term leaves out.
// In:  position RGBA32F, normal RGBA16F, face RG16; direct light RGBA32F, and what of it is emitted
//      (EMISSIVE); E / pi RGBA32F
// Out: E / pi RGBA32F, W/(m^2 sr)
// Source: Novak, Engelhardt, Dachsbacher 2011; pass/compensate.h says what differs.
#include "passes/include/pass/view_shared.h"
#include "passes/shading/octahedral.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D face_map;
layout(binding = 3) uniform sampler2D direct_map;
#ifdef EMISSIVE
layout(binding = 4) uniform sampler2D emissive_map;
#endif
layout(binding = 5) uniform sampler2D light_map;
layout(binding = 0, rgba32f) writeonly uniform image2D result;
layout(location = 0) uniform ivec4 frame; // xy: pixels; z: n; w: samples
layout(location = 1) uniform float bound; // b, 1/m^2

const float pi = 3.14159265358979;
const float golden = 0.61803398875;
const vec2 golden_turn = vec2(-0.73736888, -0.67549029); // cos and sin of 2 pi times that
// The 3 x 3 pixels reach this far; beyond, and outside of them, is what the rings sample.
const float first_radius = 1.5;
// Of its area, as which a pixel spreads: its light meets at a distance that is no smaller than a pixel.
// With half of it the pixels at the edge of a right angle are right to 3 %, with all 6 % too dark.
const float disc = 0.5;
// A surface seen flatter than this shows as much as one that is not.
const float least_slope = 1e-3;

// What an area of one pixel is at a distance of 1 along the view; orthographic: at any, m^2.
float pixel_area()
{
    vec2 pixel = 2.0 / vec2(frame.xy);
    vec4 a = view.inv_view_proj * vec4(0.0, 0.0, 1.0, 1.0);
    vec4 b = view.inv_view_proj * vec4(pixel.x, 0.0, 1.0, 1.0);
    vec4 c = view.inv_view_proj * vec4(0.0, pixel.y, 1.0, 1.0);
    vec3 p = a.xyz / a.w, q = b.xyz / b.w, r = c.xyz / c.w;
    if (view.forward.w < 0.5) {
        p /= dot(p, view.forward.xyz);
        q /= dot(q, view.forward.xyz);
        r /= dot(r, view.forward.xyz);
    }
    return length(cross(q - p, r - p));
}

// The surface of unit normal that a pixel shows at `p`.
float shown_area(vec3 p, vec3 normal, float pixel)
{
    if (view.forward.w > 0.5)
        return pixel / max(abs(dot(normal, view.forward.xyz)), least_slope);
    float z = dot(p, view.forward.xyz);
    return pixel * z * z * z / max(abs(dot(normal, p)), least_slope * z);
}

struct receiver {
    vec3 p, n;
    float pixel, bound; // in scene units, as all
};

// The light that x gets from what the pixel at `at` reflects, E / pi, beyond what the bound leaves.
vec3 beyond_bound(receiver x, ivec2 at, float weight)
{
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, frame.xy)))
        return vec3(0.0);
    vec4 q = texelFetch(position_map, at, 0);
    vec3 m = octahedral_decode(texelFetch(face_map, at, 0).xy);
    vec3 radiance = texelFetch(direct_map, at, 0).rgb;
#ifdef EMISSIVE
    radiance -= texelFetch(emissive_map, at, 0).rgb;
#endif
    vec3 p = q.xyz * view.scale.x, d = p - x.p;
    float d2 = dot(d, d), area = shown_area(p, m, x.pixel);
    float cosines = max(dot(x.n, d), 0.0) * max(-dot(m, d), 0.0); // times d^2
    float beyond = cosines / max(d2 * (pi * d2 + disc * area), 1e-36) - x.bound;
    bool counts = q.w > 0.5 && beyond > 0.0 && all(lessThan(radiance, vec3(3.0e38)));
    return counts ? max(radiance, vec3(0.0)) * (beyond * area * weight) : vec3(0.0);
}

// Pixels that a length reaches at the distance of `p`; what is as near as that looks larger.
float reach_of(vec3 p, float len, float pixel)
{
    float z = dot(p, view.forward.xyz);
    float depth = view.forward.w > 0.5 ? 1.0 : max(z - len, 0.5 * z);
    return min(len / (depth * sqrt(pixel)), float(max(frame.x, frame.y)));
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, frame.xy)))
        return;
    float unit = view.scale.x;
    vec4 light = texelFetch(light_map, at, 0), q = texelFetch(position_map, at, 0);
    if (q.w < 0.5) {
        imageStore(result, at, light);
        return;
    }
    vec3 n = texelFetch(normal_map, at, 0).xyz;
    receiver x = receiver(q.xyz * unit, n / max(length(n), 1e-6), pixel_area(), bound / (unit * unit));
    if (view.forward.w > 0.5)
        x.pixel *= unit * unit;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 9; i++)
        sum += beyond_bound(x, at + ivec2(i % 3, i / 3) - 1, 1.0);
    // Over the n x n pixels of a block the samples of a ring stand all round, each at another radius
    // within it; those of a pixel follow a spiral, each a golden angle on.
    ivec2 in_block = at % frame.z;
    float t = float(in_block.y * frame.z + in_block.x) + 0.5, angle = 2.0 * pi * t / float(frame.z * frame.z);
    float reach = reach_of(x.p, inversesqrt(pi * x.bound), x.pixel);
    float rings = log(max(reach / first_radius, 1.0)) / float(frame.w); // of one, its logarithm
    vec2 to = first_radius * exp(rings * fract(t * golden)) * vec2(cos(angle), sin(angle));
    mat2 next = exp(rings) * mat2(golden_turn, vec2(-golden_turn.y, golden_turn.x));
    for (int k = 0; k < frame.w && rings > 0.0; k++) {
        ivec2 offset = ivec2(round(to));
        if (any(greaterThan(abs(offset), ivec2(1))))
            sum += beyond_bound(x, at + offset, rings * 2.0 * pi * dot(to, to));
        to = next * to;
    }
    imageStore(result, at, vec4(min(light.rgb + sum, vec3(3.0e38)), light.a));
}
