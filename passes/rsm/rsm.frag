#version 450 core
// SPDX-License-Identifier: MIT
// Reflective shadow map: what a light sees, and what each texel of it receives.
// Out: position RGBA32F: xyz render space; w area A_j of the texel's footprint, m^2, 0: nothing
//      normal RGBA16F: xyz unit, the face's, turned to the light; w 1, 0: nothing
//      flux RGBA32F: rgb reflected flux rho_j Phi_j, W; a solid angle, sr (directional: m^2)
// Source: Nichols, Shopf, Wyman 2009, sec. 3.2; its eq. 2 and 3 with the texel's own solid angle.
//         EQUAL: with eq. 4's, the same for every texel.
#include "passes/include/pass/scene_shared.h"
#include "passes/gpu_scene/material.glsl"
#include "passes/shading/lights.glsl"
#include "passes/shading/solid_angle.glsl"

layout(std430, binding = 2) readonly buffer face_buffer
{
    ag_gpu_face faces[];
};
layout(std430, binding = 3) readonly buffer light_buffer
{
    ivec4 light_count;
    ag_gpu_light lights[];
};
layout(location = 0) uniform int face;
layout(location = 1) uniform int map_size; // texels along an edge

layout(location = 0) out vec4 out_position;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec4 out_flux;

// A texel counts by samples of the intensity over it, so that small maps keep the light's power.
const int samples_across_map = 64;

// Flux through the texel before reflection, W, and its solid angle, sr.
vec4 texel_flux(ag_gpu_face f, ag_gpu_light light, ivec2 texel)
{
    int n = max(1, samples_across_map / map_size);
    vec2 edge = vec2(f.right.w, f.up.w);
    float cell = 2.0 / float(map_size * n);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; i++) {
        vec2 lo = vec2(texel * n + ivec2(i % n, i / n)) * cell - 1.0;
        vec2 mid = (lo + 0.5 * cell) * edge;
        vec3 away = normalize(f.forward.xyz + f.right.xyz * mid.x + f.up.xyz * mid.y);
#ifdef EQUAL
        float omega = rectangle_solid_angle(-edge, edge) / float(map_size * n * map_size * n); // eq. 4
#else
        float omega = rectangle_solid_angle(lo * edge, (lo + cell) * edge);
#endif
        sum += vec4(light_intensity(light, away) * omega, omega); // eq. 2
    }
    return sum;
}

void main()
{
    ag_gpu_face f = faces[face];
    ag_gpu_light light = lights[f.info.x];
    bool orthographic = f.eye.w > 0.5;
    vec3 d = position - f.eye.xyz;
    vec3 to_light = orthographic ? -f.forward.xyz : -d;
    surface s = surface_here(to_light);

    vec4 flux;
    float footprint_area; // across the light's direction
    float from_light = length(d);
    if (orthographic) {
        footprint_area = 4.0 * f.right.w * f.up.w / (float(map_size) * float(map_size));
        flux = vec4(light.intensity.rgb * footprint_area, footprint_area);
    } else {
        flux = texel_flux(f, light, ivec2(gl_FragCoord.xy));
        footprint_area = flux.a * from_light * from_light; // eq. 3
    }
    // Eq. 3 lacks the cosine; 1e-3 keeps the footprint of a silhouette finite. The footprint lies on
    // the face; what it receives goes by the shading normal, E A_j = Phi cos_shading / cos_face.
    vec3 l = normalize(to_light);
    float cos_face = max(dot(s.face_normal, l), 1e-3);
    float cos_shading = dot(s.normal, l);
    bool lit = cos_shading > 0.0 && dot(s.face_normal, l) > 0.0 && from_light > 0.0;
    vec3 reflected = lit ? surface_albedo(s) * flux.rgb * (cos_shading / cos_face) : vec3(0.0);
    float area = lit ? footprint_area / cos_face : 0.0;

    out_position = vec4(position, area);
    out_normal = vec4(s.face_normal, 1.0);
    out_flux = vec4(reflected, flux.a);
}
