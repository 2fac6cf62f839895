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

multires_texel multires_unpack(uint code)
{
    return multires_texel(int(code >> 28), ivec2(code, code >> 14) & 0x3fff);
}

// In the flattened image of illumination whose finest level is of size `base`.
ivec2 multires_place(multires_texel t, ivec2 base)
{
    return pyramid_origin(base, t.level) + t.at;
}

// What stands there. Right of and above the levels' images it is none of theirs.
multires_texel multires_at_place(ivec2 place, ivec2 base)
{
    if (place.x < base.x)
        return multires_texel(0, place);
    int level = 1;
    while (level < 15 && place.y >= pyramid_origin(base, level + 1).y)
        level++;
    return multires_texel(level, place - pyramid_origin(base, level));
}

// flags: a word a texel of levels 1 and coarser, rows of a level in turn, the levels in turn.
const uint multires_refined = 1u; // what is valid is on finer levels
const uint multires_mixed = 2u;   // it holds an edge or reaches beyond the image

int multires_flag_index(int level, ivec2 at, ivec2 base)
{
    int index = 0;
    for (int l = 1; l < level; l++)
        index += (base.x >> l) * (base.y >> l);
    return index + at.y * (base.x >> level) + at.x;
}

// tiles: what is valid in a tile of 8 x 8 pixels. xy: level 0, bit y * 8 + x; z: level 1 from bit 0
// on, bit y * 4 + x, level 2 from bit 16 on, bit y * 2 + x; bit 17 + l: the texel of level l, 3 and
// up, whose lower left corner the tile is. w: how many of all these show a surface.
bool multires_valid_in_tile(uvec4 tile, int level, ivec2 at)
{
    if (level == 0) {
        int bit = (at.y & 7) * 8 + (at.x & 7);
        return ((bit < 32 ? tile.x : tile.y) >> (bit & 31) & 1u) != 0u;
    }
    int bit = level == 1 ? (at.y & 3) * 4 + (at.x & 3)
              : level == 2 ? 16 + (at.y & 1) * 2 + (at.x & 1)
                           : 17 + level;
    return (tile.z >> bit & 1u) != 0u;
}
