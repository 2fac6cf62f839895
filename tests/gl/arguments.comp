#version 450 core
// SPDX-License-Identifier: MIT
// In: r32f texture. Out: arguments of an indirect dispatch: as many groups as the texture's
// texel (1, 0) says.
layout(local_size_x = 1) in;
layout(binding = 0) uniform sampler2D from;
layout(std430, binding = 0) writeonly buffer arguments
{
    uint groups[3];
};

void main()
{
    groups[0] = uint(texelFetch(from, ivec2(1, 0), 0).x);
    groups[1] = 1;
    groups[2] = 1;
}
