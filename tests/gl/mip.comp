#version 450 core
// SPDX-License-Identifier: MIT
// In: mip FROM of a r32f texture. Out: the next mip, the sum of four texels.
#ifndef FROM
#define FROM 0
#endif
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D from;
layout(r32f, binding = 0) uniform writeonly image2D to;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(to))))
        return;
    float sum = 0;
    for (int i = 0; i < 4; ++i)
        sum += texelFetch(from, 2 * at + ivec2(i & 1, i >> 1), FROM).x;
    imageStore(to, at, vec4(sum));
}
