#version 450 core
// SPDX-License-Identifier: MIT
// As fullscreen.vert, an instance for each layer.
layout(location = 0) flat out int layer;

void main()
{
    vec2 corner = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);
    gl_Position = vec4(corner, 0.5, 1);
    layer = gl_InstanceID;
}
