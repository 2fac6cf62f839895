#version 450 core
// SPDX-License-Identifier: MIT
// Irradiance of every pixel from all VPLs, without visibility.
// In:  position RGBA32F, normal RGBA16F; ag_vpl[], count
// Out: E / pi RGBA32F, W/(m^2 sr); a 1
// BLOCK_X, BLOCK_Y: receivers of one invocation. CLAMP: 0 none, 1 disc, 2 constant.
//
// E_i = sum_j rho_j Phi_j cos_i cos_j / (pi d^2 + A_j)
// Source: Nichols, Shopf, Wyman 2009, eq. 1 and 5.
//         Departs from it: eq. 5 has A_j on top of the fraction, which makes watts of W/m^2.
#include "passes/include/pass/view_shared.h"
#include "passes/include/pass/vpl_shared.h"

#ifndef BLOCK_X
#define BLOCK_X 2
#define BLOCK_Y 2
#endif
#ifndef CLAMP
#define CLAMP 1
#endif

const int block = BLOCK_X * BLOCK_Y;
const int group = 8;
const int tile = 64; // VPLs of one partial sum
const float pi = 3.14159265358979;

layout(local_size_x = group, local_size_y = group) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(std430, binding = 0) readonly buffer vpl_buffer
{
    ag_vpl vpls[];
};
layout(std430, binding = 1) readonly buffer count_buffer
{
    uvec4 count;
};
layout(location = 0) uniform float clamp_d2; // m^2, CLAMP 2
layout(binding = 0, rgba32f) writeonly uniform image2D indirect;

// Receivers of one invocation lie `group` pixels apart, so that neighbours load neighbours.
ivec2 receiver(int i)
{
    ivec2 base = ivec2(gl_WorkGroupID.xy) * group * ivec2(BLOCK_X, BLOCK_Y);
    return base + ivec2(gl_LocalInvocationID.xy) + group * ivec2(i % BLOCK_X, i / BLOCK_X);
}

void main()
{
    vec3 p[block], n[block], sum[block];
    // Lengths in units of about the scene: d^4 stays in range at any scale. The unit is a power of
    // two, so the scaling rounds nothing.
    float unit = view.scale.x;
    for (int i = 0; i < block; i++) {
        ivec2 at = min(receiver(i), view.size.xy - 1);
        p[i] = texelFetch(position_map, at, 0).xyz * unit;
        n[i] = texelFetch(normal_map, at, 0).xyz;
        n[i] /= max(length(n[i]), 1e-6);
        sum[i] = vec3(0.0);
    }
    int total = int(count.x);
    float least = pi * clamp_d2 * unit * unit;
    for (int start = 0; start < total; start += tile) {
        vec3 part[block];
        for (int i = 0; i < block; i++)
            part[i] = vec3(0.0);
        int end = min(start + tile, total);
        for (int j = start; j < end; j++) {
            vec3 q = vpls[j].position_area.xyz * unit;
            vec3 m = vpls[j].normal.xyz;
            vec3 flux = vpls[j].flux.rgb;
            float area = vpls[j].position_area.w * unit * unit;
            for (int i = 0; i < block; i++) {
                vec3 d = q - p[i];
                float d2 = dot(d, d);
                float cos_i = max(dot(n[i], d), 0.0);  // times |d|
                float cos_j = max(-dot(m, d), 0.0);    // times |d|
#if CLAMP == 0
                float spread = pi * d2;
#elif CLAMP == 1
                float spread = pi * d2 + area;
#else
                float spread = max(pi * d2, least);
#endif
                // d = 0 gives 0: both cosines are.
                part[i] += flux * (cos_i * cos_j / max(d2 * spread, 1e-36));
            }
        }
        for (int i = 0; i < block; i++)
            sum[i] += part[i];
    }
    for (int i = 0; i < block; i++) {
        ivec2 at = receiver(i);
        if (all(lessThan(at, view.size.xy)))
            imageStore(indirect, at, vec4(min(sum[i] * (unit * unit / pi), vec3(3.0e38)), 1.0));
    }
}
