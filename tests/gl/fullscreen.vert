#version 450 core
// SPDX-License-Identifier: MIT
// One triangle over the viewport at depth `DEPTH` (1 near, 0 far).
#ifndef DEPTH
#define DEPTH 0.5
#endif

void main()
{
    vec2 corner = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);
    gl_Position = vec4(corner, DEPTH, 1);
}
