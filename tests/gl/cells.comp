#version 450 core
// SPDX-License-Identifier: MIT
// Out: r32f, the number of the cell plus SEED.
#include "cell.glsl"
#ifndef SEED
#define SEED 0
#endif
layout(local_size_x = 8, local_size_y = 8) in;
layout(r32f, binding = 0) uniform writeonly image2D to;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, imageSize(to))))
        imageStore(to, at, vec4(cell_number(at) + float(SEED)));
}
