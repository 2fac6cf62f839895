#version 450 core
// SPDX-License-Identifier: MIT
// Out: the number of the cell plus SEED.
#include "cell.glsl"
#ifndef SEED
#define SEED 0
#endif
layout(location = 0) out vec4 color;

void main()
{
    color = vec4(cell_number(ivec2(gl_FragCoord.xy)) + float(SEED), gl_FragCoord.xy, 1);
}
