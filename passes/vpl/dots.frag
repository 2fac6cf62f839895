#version 450 core
// SPDX-License-Identifier: MIT
// A dot with a dark rim of one pixel.
// In:  offset from the middle, pixels; radius; colour
// Out: display values in [0, 1]
layout(location = 0) in vec2 offset;
layout(location = 1) flat in float radius;
layout(location = 2) flat in vec3 colour;
layout(location = 0) out vec4 display;

void main()
{
    float away = length(offset);
    if (away > radius + 1.0)
        discard;
    display = vec4(away > radius ? vec3(0.0) : colour, 1.0);
}
