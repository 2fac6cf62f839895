#version 450 core
// SPDX-License-Identifier: MIT
// Light of one VPL at one patch: a point at the patch's texel of the multiresolution image.
// In:  receivers RGBA32F, 4096 a row: position times the view's scale, unit normal; w: the texel's
//      place in clip space, x and y. splat_light of the instance
// Out: light, E / pi, W/(m^2 sr)
//
// E_i = rho_j Phi_j cos_i cos_j / (pi d^2 + A_j)
// Source: Nichols, Shopf, Wyman 2009, sec. 3.1; the form factor as in passes/gather/gather.comp.
#include "plugins/splat/receiver_row.glsl"

const float pi = 3.14159265358979;

layout(binding = 0) uniform sampler2D receiver_positions;
layout(binding = 1) uniform sampler2D receiver_normals;
layout(location = 0) in vec4 position_area;
layout(location = 1) in vec4 normal_bound;
layout(location = 2) in vec3 flux;
flat out vec3 light;

void main()
{
    ivec2 row = receiver_row(uint(gl_VertexID));
    vec4 p = texelFetch(receiver_positions, row, 0);
    vec4 n = texelFetch(receiver_normals, row, 0);
    vec3 d = position_area.xyz - p.xyz;
    float d2 = dot(d, d);
    float cos_i = max(dot(n.xyz, d), 0.0);             // times |d|
    float cos_j = max(-dot(normal_bound.xyz, d), 0.0); // times |d|
    float spread = pi * d2 + position_area.w;
    // d = 0 gives 0: both cosines are.
    float share = cos_i * cos_j / max(d2 * spread, 1e-36);
    light = flux * share;
    bool reached = cos_j > normal_bound.w * sqrt(d2) * spread && share > 0.0;
    gl_Position = reached ? vec4(p.w, n.w, 0.5, 1.0) : vec4(2.0, 2.0, 0.5, 1.0); // seen by nobody
}
