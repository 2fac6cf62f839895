#version 450 core
// SPDX-License-Identifier: MIT
// A quad over `place` (left, bottom, right, top in clip space), in the host's own conventions: z in [-1, 1].
layout(location = 0) uniform vec4 place;
layout(location = 0) out vec2 uv;

void main()
{
    uv = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(mix(place.xy, place.zw, uv), -0.5, 1);
}
