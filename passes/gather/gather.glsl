// SPDX-License-Identifier: MIT
// Irradiance of receivers from all VPLs: gather.comp and gather.frag. BLOCK_X, BLOCK_Y: receivers of
// one invocation. CLAMP: 0 none, 1 disc, 2 constant, 3 footprint, 4 bounded. FAR: near VPLs are left
// out. LIST, SPLIT: see receivers.glsl. VISIBILITY: see visible.glsl.
//
// E_i = sum_j rho_j Phi_j cos_i cos_j / (pi d^2 + A_j)
// Source: Nichols, Shopf, Wyman 2009, eq. 1 and 5.
//         Departs from it: eq. 5 has A_j on top of the fraction, which makes watts of W/m^2.
//         CLAMP 3: near a VPL the exact form factor of its patch, by Lambert's formula for
//         polygons; a disc seen from beside its rim is far off.
//         CLAMP 4: the irradiance of a VPL or its geometry term is bounded. Laine, Saransaari,
//         Kontkanen, Lehtinen, Aila 2007, sec. 5.1.
#include "passes/include/pass/view_shared.h"
#include "passes/include/pass/vpl_shared.h"
#ifdef VISIBILITY
#include "passes/gather/visible.glsl"
#endif

#ifndef BLOCK_X
#define BLOCK_X 2
#define BLOCK_Y 2
#endif
#ifndef CLAMP
#define CLAMP 3
#endif

const int block = BLOCK_X * BLOCK_Y;
const int group = 8;
const int tile = 64; // VPLs of one partial sum
const float pi = 3.14159265358979;

#ifdef FRAGMENT
layout(early_fragment_tests) in;
#else
layout(local_size_x = group, local_size_y = group) in;
#endif

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
#if defined(LIST) || defined(FRAGMENT)
#include "passes/multires/receiver.glsl"
#endif
layout(std430, binding = 0) readonly buffer vpl_buffer
{
    ag_vpl vpls[];
};
layout(std430, binding = 1) readonly buffer count_buffer
{
    uvec4 count;
};
#if CLAMP == 2
layout(location = 0) uniform float clamp_d2; // m^2
#elif CLAMP == 3
layout(location = 0) uniform int on_surface;
#elif CLAMP == 4
layout(location = 0) uniform vec2 bound; // x: of a VPL's irradiance, W/m^2; with y 1 over its flux, 1/m^2
#endif
// Of its receivers' VPLs those of this dispatch: x first, y one past the last; z 1: no dispatch
// follows. Until then the image holds the sum, without its factor.
layout(location = 2) uniform ivec3 span;
layout(binding = 0, rgba32f) uniform image2D indirect;

#include "passes/gather/receivers.glsl"

#if CLAMP == 3
#include "passes/gather/near.glsl"
#ifndef FAR
#define NEAR 1
#endif
#endif

#ifdef NEAR
// Which of the invocation's receivers, at `p`, are near VPL j.
uint receivers_near(int j, vec3 p[block], float unit)
{
    vec3 q = vpls[j].position_area.xyz * unit, m = vpls[j].normal.xyz;
    float area = vpls[j].position_area.w * unit * unit;
    uint found = 0u;
    for (int i = 0; i < block; i++) {
        vec3 d = q - p[i];
        if (patch_is_near(dot(d, d), max(-dot(m, d), 0.0), area))
            found |= 1u << i;
    }
    return found;
}

// Adds VPL j to what receiver i has in the image.
void add_near(int j, int i, float unit)
{
    vec3 p, n;
    fetch_receiver(i, p, n);
    vec3 d = vpls[j].position_area.xyz * unit - p * unit;
    float area = vpls[j].position_area.w * unit * unit;
    n /= max(length(n), 1e-6);
    float cos_j = max(-dot(vpls[j].normal.xyz, d), 0.0); // times |d|
    float share = on_surface != 0 ? patch_share_on_surface(d, n, vpls[j], area)
                                  : patch_share(d, n, vpls[j], area, cos_j, texel_lift);
#ifdef VISIBILITY
    share *= vpl_visibility(vpl_open(j, int(count.x)), p * unit, n);
#endif
    if (is_there(i)) {
        vec4 old = imageLoad(indirect, place_of(i));
        imageStore(indirect, place_of(i), old + vec4(vpls[j].flux.rgb * share, 0.0));
    }
}

// Adds `near` ones of the VPLs from `start` on to the image. Rare and long, so it stands aside of the
// loop over all VPLs and fetches its receivers anew, those that it needs.
void correct_near(int start, uvec2 near, vec3 p[block], float unit)
{
    uint receivers = 0u;
    int j = start;
    while ((near.x | near.y | receivers) != 0u) {
        if (receivers == 0u) {
            j = start + (near.x != 0u ? findLSB(near.x) : 32 + findLSB(near.y));
            near = near.x != 0u ? uvec2(near.x & (near.x - 1u), near.y)
                                : uvec2(0u, near.y & (near.y - 1u));
            receivers = receivers_near(j, p, unit);
        }
        if (receivers != 0u) {
            add_near(j, findLSB(receivers), unit);
            receivers &= receivers - 1u;
        }
    }
}
#endif

void main()
{
    vec3 p[block], n[block], sum[block];
    // Lengths in units of about the scene: d^4 stays in range at any scale. The unit is a power of
    // two, so the scaling rounds nothing.
    float unit = view.scale.x;
    ivec2 run = run_of_vpls(int(count.x));
    int first = run.x + span.x, total = min(run.y, run.x + span.y);
    if (span.x > 0 && first >= total && span.z == 0)
        return;
    for (int i = 0; i < block; i++) {
        fetch_receiver(i, p[i], n[i]);
        p[i] *= unit;
        n[i] /= max(length(n[i]), 1e-6);
        sum[i] = vec3(0.0);
#ifdef NEAR
        if (span.x == 0 && is_there(i))
            imageStore(indirect, place_of(i), vec4(0.0));
#endif
    }
#if CLAMP == 2
    float least = pi * clamp_d2 * unit * unit;
#endif
    for (int start = first; start < total; start += tile) {
        vec3 part[block];
        for (int i = 0; i < block; i++)
            part[i] = vec3(0.0);
#ifdef NEAR
        uvec2 near = uvec2(0u);
#endif
        int end = min(start + tile, total);
        for (int j = start; j < end; j++) {
            vec3 q = vpls[j].position_area.xyz * unit;
            vec3 m = vpls[j].normal.xyz;
            vec3 flux = vpls[j].flux.rgb;
            float area = vpls[j].position_area.w * unit * unit;
#if CLAMP == 3
            // Beside its own surface a disc is too dark: what is not near is a point.
            float spread_area = on_surface != 0 ? 0.0 : area;
#ifdef NEAR
            bool any_near = false;
#endif
#elif CLAMP == 4
            float per = bound.y > 0.5 ? 1.0 : max(max(flux.r, flux.g), max(flux.b, 1e-30));
            float most = bound.x / (unit * unit * per);
#endif
#ifdef VISIBILITY
            vpl_map map = vpl_open(j, int(count.x));
#endif
            for (int i = 0; i < block; i++) {
                vec3 d = q - p[i];
                float d2 = dot(d, d);
                float cos_i = max(dot(n[i], d), 0.0);  // times |d|
                float cos_j = max(-dot(m, d), 0.0);    // times |d|
#if CLAMP == 0 || CLAMP == 4
                float spread = pi * d2;
#elif CLAMP == 2
                float spread = max(pi * d2, least);
#elif CLAMP == 3
                float spread = pi * d2 + spread_area;
#else
                float spread = pi * d2 + area;
#endif
                // d = 0 gives 0: both cosines are.
                float share = cos_i * cos_j / max(d2 * spread, 1e-36);
#if CLAMP == 3
                bool is_near = patch_is_near(d2, cos_j, area);
                share = is_near ? 0.0 : share;
#ifdef NEAR
                any_near = any_near || is_near;
#endif
#elif CLAMP == 4
                share = min(share, most);
#endif
#ifdef VISIBILITY
                if (share > 0.0)
                    share *= vpl_visibility(map, p[i], n[i]);
#endif
                part[i] += flux * share;
            }
#ifdef NEAR
            if (any_near)
                near[(j - start) >> 5] |= 1u << ((j - start) & 31);
#endif
        }
        for (int i = 0; i < block; i++)
            sum[i] += part[i];
#ifdef NEAR
        correct_near(start, near, p, unit);
#endif
    }
    for (int i = 0; i < block; i++) {
        if (!is_there(i))
            continue;
        ivec2 at = place_of(i);
#ifndef NEAR
        if (span.x > 0)
#endif
            sum[i] += imageLoad(indirect, at).rgb;
        float factor = span.z != 0 ? unit * unit / pi * share_of_vpls() : 1.0;
        imageStore(indirect, at, vec4(min(sum[i] * factor, vec3(3.0e38)), 1.0));
    }
}
