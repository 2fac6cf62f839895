#version 450 core
// SPDX-License-Identifier: MIT
// In: linear light of the size of the picture. Out: x / (1 + x); the texture encodes sRGB.
layout(binding = 0) uniform sampler2D light;
layout(location = 0) out vec4 color;

void main()
{
    vec3 x = texelFetch(light, ivec2(gl_FragCoord.xy), 0).rgb;
    color = vec4(x / (1 + x), 1);
}
