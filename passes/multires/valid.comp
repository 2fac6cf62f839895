#version 450 core
// SPDX-License-Identifier: MIT
// Marks what is valid in each tile of 8 x 8 pixels.
// In:  flags; normal RGBA16F
// Out: uvec4[] of tiles, see texel.glsl, but for what lies in shared blocks; the list of those
// Source: Nichols, Shopf, Wyman 2009, sec. 3.2.1: a texel is valid when its own level has no
//         discontinuity and the next coarser one has.
//         Departs from it: blocks of level `share` that hold an edge are left to share.comp.
#include "passes/include/pass/view_shared.h"
#include "passes/multires/texel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 1) uniform sampler2D normal_map;
layout(std430, binding = 0) readonly buffer flag_buffer
{
    uint flags[];
};
layout(std430, binding = 1) writeonly buffer tile_buffer
{
    uvec4 tiles[];
};
layout(std430, binding = 2) buffer shared_buffer
{
    uvec4 dispatch;       // xy: work groups of 64; w: blocks
    uint shared_blocks[]; // y << 16 | x
};
layout(location = 0) uniform ivec4 levels; // x: how many; y: share; zw: tiles
layout(location = 1) uniform ivec2 base;   // size of level 0 in the pyramid

bool has_flag(uint flag, int level, ivec2 at)
{
    return level > 0 && (flags[multires_flag_index(level, at, base)] & flag) != 0u;
}

bool shows_surface(ivec2 pixel)
{
    return all(lessThan(pixel, view.size.xy)) && texelFetch(normal_map, pixel, 0).w > 0.0;
}

bool is_valid(int level, ivec2 at)
{
    bool wanted = level == levels.x - 1 || has_flag(multires_refined, level + 1, at >> 1);
    return wanted && !has_flag(multires_refined, level, at);
}

void list_shared(ivec2 block)
{
    uint place = atomicAdd(dispatch.w, 1u);
    shared_blocks[place] = uint(block.y) << 16 | uint(block.x);
    uint groups = place / 64u + 1u; // more than fit one axis fill rows
    atomicMax(dispatch.x, min(groups, 65535u));
    if (groups > 65535u)
        atomicMax(dispatch.y, (groups + 65534u) / 65535u);
}

// Adds the texel if it is valid and shows a surface.
void add_texel(int level, ivec2 at, ivec2 tile, inout uvec4 mask)
{
    if (level == levels.y && has_flag(multires_mixed, level, at)) {
        if (level == levels.x - 1 || has_flag(multires_refined, level + 1, at >> 1))
            list_shared(at);
        return;
    }
    if (!is_valid(level, at))
        return;
    int middle = level > 0 ? (1 << (level - 1)) - 1 : 0;
    if (!shows_surface((at << level) + middle))
        return;
    int bit = (at.y & 7) * 8 + (at.x & 7);
    if (level == 0)
        mask.xy |= bit < 32 ? uvec2(1u << bit, 0u) : uvec2(0u, 1u << (bit - 32));
    else
        mask.z |= 1u << (level == 1   ? (at.y & 3) * 4 + (at.x & 3)
                         : level == 2 ? 16 + (at.y & 1) * 2 + (at.x & 1)
                                      : 17 + level);
}

void main()
{
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(tile, levels.zw)))
        return;
    uvec4 mask = uvec4(0u);
    for (int level = levels.y; level < levels.x; level++) {
        int along = max(8 >> level, 1); // texels of this level along the tile's edge
        ivec2 first = level <= 3 ? tile * along : tile >> (level - 3);
        if (level > 3 && (first << (level - 3)) != tile)
            continue;
        for (int i = 0; i < along * along; i++) {
            ivec2 at = first + ivec2(i % along, i / along);
            if (all(lessThan(at, base >> level)))
                add_texel(level, at, tile, mask);
        }
    }
    mask.w = uint(bitCount(mask.x) + bitCount(mask.y) + bitCount(mask.z));
    tiles[tile.y * levels.z + tile.x] = mask;
}
