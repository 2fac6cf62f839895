#version 450 core
// SPDX-License-Identifier: MIT
// Marks what is valid in each tile of 8 x 8 pixels.
// In:  flags; position RGBA32F, normal RGBA16F
// Out: uvec4[] of tiles, see texel.glsl
// Source: Nichols, Shopf, Wyman 2009, sec. 3.2.1: a texel is valid when its own level has no
//         discontinuity and the next coarser one has.
//         Departs from it: blocks of level `share` that hold an edge.
#include "passes/include/pass/view_shared.h"
#include "passes/multires/surface.glsl"
#include "passes/multires/texel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(std430, binding = 0) readonly buffer flag_buffer
{
    uint flags[];
};
layout(std430, binding = 1) writeonly buffer tile_buffer
{
    uvec4 tiles[];
};
layout(location = 0) uniform ivec4 levels; // x: how many; y: share; zw: tiles
layout(location = 1) uniform ivec2 base;   // size of level 0 in the pyramid
layout(location = 2) uniform vec2 limits;

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

uvec2 bit_of(ivec2 at)
{
    int bit = at.y * 8 + at.x;
    return bit < 32 ? uvec2(1u << bit, 0u) : uvec2(0u, 1u << (bit - 32));
}

ivec2 take_first(inout uvec2 bits)
{
    int bit = bits.x != 0u ? findLSB(bits.x) : 32 + findLSB(bits.y);
    bits = bits.x != 0u ? uvec2(bits.x & (bits.x - 1u), bits.y) : uvec2(0u, bits.y & (bits.y - 1u));
    return ivec2(bit & 7, bit >> 3);
}

// Of these pixels the one nearest to the middle of all of them.
ivec2 most_central(uvec2 set)
{
    ivec2 sum = ivec2(0), found = ivec2(0);
    int count = bitCount(set.x) + bitCount(set.y), least = 1 << 30;
    for (uvec2 left = set; (left.x | left.y) != 0u;)
        sum += take_first(left);
    for (uvec2 left = set; (left.x | left.y) != 0u;) {
        ivec2 at = take_first(left), off = at * count - sum;
        int distance_ = off.x * off.x + off.y * off.y;
        found = distance_ < least ? at : found;
        least = min(least, distance_);
    }
    return found;
}

// Those of the pixels that show the same surface as `pixel`, which is one of them.
uvec2 of_surface(uvec2 set, ivec2 origin, ivec2 pixel)
{
    uvec2 found = bit_of(pixel);
    if (min(limits.x, limits.y) <= 0.0)
        return found; // nothing is near enough
    vec3 p = texelFetch(position_map, origin + pixel, 0).xyz;
    vec3 n = texelFetch(normal_map, origin + pixel, 0).xyz;
    for (uvec2 left = set & ~found; (left.x | left.y) != 0u;) {
        ivec2 at = take_first(left);
        vec3 q = texelFetch(position_map, origin + at, 0).xyz;
        vec3 m = texelFetch(normal_map, origin + at, 0).xyz;
        if (surface_is_same(q, m, p, n, limits))
            found |= bit_of(at);
    }
    return found;
}

// One pixel for each surface in a block of `edge` pixels at `corner` of the tile, from the middle of
// what the block shows of it: at its rim another surface touches it, and light changes fast.
uvec2 share_block(ivec2 origin, ivec2 corner, int edge)
{
    uvec2 left = uvec2(0u), chosen = uvec2(0u);
    for (int i = 0; i < edge * edge; i++) {
        ivec2 at = corner + ivec2(i % edge, i / edge);
        if (shows_surface(origin + at))
            left |= bit_of(at);
    }
    while ((left.x | left.y) != 0u) {
        ivec2 pixel = most_central(of_surface(left, origin, most_central(left)));
        chosen |= bit_of(pixel);
        left &= ~of_surface(left, origin, pixel);
    }
    return chosen;
}

// Adds the texel if it is valid and shows a surface.
void add_texel(int level, ivec2 at, ivec2 tile, inout uvec4 mask)
{
    if (level == levels.y && has_flag(multires_mixed, level, at)) {
        if (level == levels.x - 1 || has_flag(multires_refined, level + 1, at >> 1))
            mask.xy |= share_block(tile * 8, (at << level) & 7, 1 << level);
        return;
    }
    if (!is_valid(level, at))
        return;
    int middle = level > 0 ? (1 << (level - 1)) - 1 : 0;
    if (!shows_surface((at << level) + middle))
        return;
    if (level == 0)
        mask.xy |= bit_of(at & 7);
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
