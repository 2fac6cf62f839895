#version 450 core
// SPDX-License-Identifier: MIT
// In:  a texture
// Out: the same, RGBA16F
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D source;
layout(binding = 0, rgba16f) writeonly uniform image2D copied;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, textureSize(source, 0))))
        imageStore(copied, at, texelFetch(source, at, 0));
}
