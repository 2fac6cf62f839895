#version 450 core
// SPDX-License-Identifier: MIT
// In: a picture, rows from the bottom up. Out: it, or `color` where that has any opacity.
layout(binding = 0) uniform sampler2D picture;
layout(location = 1) uniform vec4 color;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;

void main()
{
    result = color.a > 0 ? color : vec4(texture(picture, uv).rgb, 1);
}
