// SPDX-License-Identifier: MIT
// One link of a chain: 3 x + 1 of the right neighbour's number, modulo 65536.
#ifdef FROM_UINT
layout(binding = 0) uniform usampler2D from;
#else
layout(binding = 0) uniform sampler2D from;
#endif

uint step_number(ivec2 at)
{
    ivec2 size = textureSize(from, 0);
    uint x = uint(texelFetch(from, ivec2((at.x + 1) % size.x, at.y), 0).x);
    return (3u * x + 1u) & 0xffffu;
}
