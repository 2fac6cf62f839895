#version 450 core
// SPDX-License-Identifier: MIT
// Right alone; does not link with layers.vert, whose output 0 is an int.
layout(location = 0) in vec3 layer;
layout(location = 0) out vec4 color;

void main()
{
    color = vec4(layer, 1);
}
