#version 450 core
// SPDX-License-Identifier: MIT
// Out: RGBA16F, a glow around the middle of a 256 x 256 picture; 8 at its brightest.
layout(location = 0) out vec4 color;

void main()
{
    vec2 d = (gl_FragCoord.xy - 128) / 32;
    color = vec4(vec3(8, 4, 1) / (1 + dot(d, d)), 1);
}
