#version 450 core
// SPDX-License-Identifier: MIT
// Sums the light that leaves a pixel's surface for the eye.
// In:  direct RGBA32F; albedo RGBA16F; E / pi of indirect light; glossy radiance
// Out: radiance RGBA32F, W/(m^2 sr); a 1
// DIRECT, INDIRECT, GLOSSY_LIGHT: the input is there.
#include "passes/include/pass/view_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D direct_map;
layout(binding = 1) uniform sampler2D albedo_map;
layout(binding = 2) uniform sampler2D indirect_map;
layout(binding = 3) uniform sampler2D glossy_map;
layout(binding = 0, rgba32f) writeonly uniform image2D result;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, view.size.xy)))
        return;
    vec3 sum = vec3(0.0);
#ifdef INDIRECT
    sum += texelFetch(albedo_map, at, 0).rgb * texelFetch(indirect_map, at, 0).rgb;
#endif
#ifdef GLOSSY_LIGHT
    sum += texelFetch(glossy_map, at, 0).rgb;
#endif
#ifdef DIRECT
    sum += texelFetch(direct_map, at, 0).rgb;
#endif
    imageStore(result, at, vec4(min(sum, vec3(3.0e38)), 1.0));
}
