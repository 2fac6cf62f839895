#version 450 core
// SPDX-License-Identifier: MIT
// In blocks that hold an edge: one valid pixel for each surface.
// In:  the list of such blocks; position RGBA32F, normal RGBA16F
// Out: the bits of their tiles, see texel.glsl
// Source: beyond Nichols, Shopf, Wyman 2009, who refine such blocks to pixels.
#include "passes/include/pass/view_shared.h"
#include "passes/multires/surface.glsl"

layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(std430, binding = 1) buffer tile_buffer
{
    uvec4 tiles[];
};
layout(std430, binding = 2) readonly buffer shared_buffer
{
    uvec4 dispatch;
    uint shared_blocks[];
};
layout(location = 0) uniform ivec2 share; // x: level of the blocks; y: tiles along a row
layout(location = 2) uniform vec2 limits;

bool shows_surface(ivec2 pixel)
{
    return all(lessThan(pixel, view.size.xy)) && texelFetch(normal_map, pixel, 0).w > 0.0;
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

void main()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint block = group * 64u + gl_LocalInvocationIndex;
    if (block >= dispatch.w)
        return;
    uint code = shared_blocks[block];
    int edge = 1 << share.x;
    ivec2 low = ivec2(code & 0xffffu, code >> 16) * edge, tile = low >> 3;
    uvec2 chosen = share_block(tile * 8, low & 7, edge);
    // Up to 16 blocks lie in one tile.
    int index = tile.y * share.y + tile.x;
    atomicOr(tiles[index].x, chosen.x);
    atomicOr(tiles[index].y, chosen.y);
    atomicAdd(tiles[index].w, uint(bitCount(chosen.x) + bitCount(chosen.y)));
}
