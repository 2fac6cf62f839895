#version 450 core
// SPDX-License-Identifier: MIT
// Sends each triangle to its layer.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) flat in int layer[];
layout(location = 0) flat out int layer_out;

void main()
{
    for (int i = 0; i < 3; ++i) {
        gl_Position = gl_in[i].gl_Position;
        gl_Layer = layer[0];
        layer_out = layer[0];
        EmitVertex();
    }
    EndPrimitive();
}
