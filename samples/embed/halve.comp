#version 450 core
// SPDX-License-Identifier: MIT
// In: a texture. Out: RGBA16F, half its size, the mean of four texels.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D from;
layout(rgba16f, binding = 0) uniform writeonly image2D to;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(to))))
        return;
    vec4 sum = vec4(0);
    for (int i = 0; i < 4; ++i)
        sum += texelFetch(from, 2 * at + ivec2(i & 1, i >> 1), 0);
    imageStore(to, at, sum / 4);
}
