#version 450 core
// SPDX-License-Identifier: MIT
// In: a depth texture. Out: what a receiver nearer and one farther than it get.
layout(local_size_x = 1) in;
layout(binding = 0) uniform sampler2DShadow depth;
layout(std430, binding = 0) writeonly buffer result
{
    float nearer, farther;
};

void main()
{
    nearer = textureLod(depth, vec3(0.5, 0.5, 0.75), 0);
    farther = textureLod(depth, vec3(0.5, 0.5, 0.25), 0);
}
