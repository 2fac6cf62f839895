// SPDX-License-Identifier: MIT
// Texels of the multiresolution buffer.
#include "passes/multires/pyramid.glsl"

struct multires_texel {
    int level;
    ivec2 at; // on its level
};

uint multires_pack(int level, ivec2 at)
{
    return uint(level) << 28 | uint(at.y) << 14 | uint(at.x);
}

multires_texel multires_unpack(uint packed)
{
    return multires_texel(int(packed >> 28), ivec2(packed, packed >> 14) & 0x3fff);
}

// In the flattened image of illumination whose finest level is of size `base`.
ivec2 multires_place(multires_texel t, ivec2 base)
{
    return pyramid_origin(base, t.level) + t.at;
}
