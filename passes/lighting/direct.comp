#version 450 core
// SPDX-License-Identifier: MIT
// Light that surfaces emit and reflect of punctual lights.
// In:  G-buffer; lights, faces; shadow maps DEPTH32F, a layer a face
// Out: radiance RGBA32F, W/(m^2 sr); a 1
// LIGHTS: there are some. EMISSIVE: the G-buffer has emission. TAPS: of the shadows' filter, 4 or 16.
#include "passes/include/pass/view_shared.h"
#include "passes/include/pass/scene_shared.h"
#include "passes/shading/octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D normal_map;
layout(binding = 1) uniform sampler2D position_map;
layout(binding = 2) uniform sampler2D albedo_map;
layout(binding = 3) uniform sampler2D face_map;
#ifdef EMISSIVE
layout(binding = 4) uniform sampler2D emissive_map;
#endif
#ifdef LIGHTS
layout(binding = 5) uniform sampler2DArray shadow_maps;
layout(std430, binding = 0) readonly buffer light_buffer
{
    ivec4 light_count;
    ag_gpu_light lights[];
};
layout(std430, binding = 1) readonly buffer face_buffer
{
    ag_gpu_face faces[];
};
#include "passes/shading/lights.glsl"
#include "passes/lighting/shadow.glsl"
#endif
layout(binding = 0, rgba32f) writeonly uniform image2D radiance;

#ifdef LIGHTS
vec3 irradiance(vec3 p, vec3 n, vec3 face_normal)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < light_count.x; i++) {
        vec3 to_light;
        vec3 e = light_irradiance(lights[i], p, to_light);
        float c = max(dot(n, to_light), 0.0);
        if (c <= 0.0 || dot(face_normal, to_light) <= 0.0 || max(e.r, max(e.g, e.b)) <= 0.0)
            continue;
        sum += e * (c * shadow_visibility(lights[i], p, face_normal));
    }
    return sum;
}
#endif

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, view.size.xy)))
        return;
    vec4 p = texelFetch(position_map, at, 0);
    vec3 sum = vec3(0.0);
    if (p.w > 0.5) {
#ifdef EMISSIVE
        sum += texelFetch(emissive_map, at, 0).rgb;
#endif
#ifdef LIGHTS
        vec3 n = texelFetch(normal_map, at, 0).xyz;
        float len = length(n); // half floats are not quite unit
        vec3 face_normal = octahedral_decode(texelFetch(face_map, at, 0).xy);
        vec3 albedo = texelFetch(albedo_map, at, 0).rgb;
        if (len > 0.0)
            sum += albedo / light_pi * irradiance(p.xyz, n / len, face_normal);
#endif
    }
    imageStore(radiance, at, vec4(min(sum, vec3(3.0e38)), 1.0));
}
