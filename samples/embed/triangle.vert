#version 450 core
// SPDX-License-Identifier: MIT
// One triangle over the viewport.

void main()
{
    gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0.5, 1);
}
