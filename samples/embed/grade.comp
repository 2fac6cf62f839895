#version 450 core
// SPDX-License-Identifier: MIT
// The host's own pass. In: direct light, albedo, E / pi. Out: RGBA8, x / (1 + x), gamma 2.2.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D direct_map;
layout(binding = 1) uniform sampler2D albedo_map;
layout(binding = 2) uniform sampler2D light_map;
layout(rgba8, binding = 0) uniform writeonly image2D to;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(to))))
        return;
    vec3 x = texelFetch(direct_map, at, 0).rgb + texelFetch(albedo_map, at, 0).rgb * texelFetch(light_map, at, 0).rgb;
    imageStore(to, at, vec4(pow(x / (1 + x), vec3(1 / 2.2)), 1));
}
