#version 450 core
// SPDX-License-Identifier: MIT
// In:  a texture
// Out: the same
layout(binding = 0) uniform sampler2D source;
layout(location = 0) out vec4 copied;

void main()
{
    copied = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
}
