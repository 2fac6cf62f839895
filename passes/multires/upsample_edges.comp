#version 450 core
// SPDX-License-Identifier: MIT
// Brings a multiresolution image to the pixels of cells that have an edge near: each from what lies
// near of its own surface.
// In:  cells; words of blocks, see cells.glsl; tiles; position RGBA32F, normal RGBA16F; pyramid RGBA32F
//      with values at the smooth texels of level SHARE and at the valid pixels
// Out: RGBA32F of the frame's size, a 1
// PART: pixels along the edge of an invocation, at most half a block.
// Source: beyond Nichols, Wyman 2009, who refine such blocks to pixels.
#include "passes/include/pass/view_shared.h"
#include "passes/multires/cells.glsl"

#ifndef PART
#define PART 2
#endif

layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D pyramid;
layout(std430, binding = 0) readonly buffer tile_buffer
{
    uvec4 tiles[];
};
layout(std430, binding = 1) readonly buffer block_buffer
{
    uint blocks[];
};
layout(std430, binding = 2) readonly buffer cell_buffer
{
    uvec4 dispatch;
    uint cells[];
};
layout(binding = 1, rgba32f) writeonly uniform image2D result;
layout(location = 0) uniform ivec4 level; // of SHARE: xy: size; zw: where it stands in the pyramid
layout(location = 1) uniform vec2 limits;
layout(location = 2) uniform int tiles_across;

const int pixels = PART * PART;
const int parts = edge / 2 / PART;  // along a cell's edge
const float own_least = 1e-4; // weight of what stands for a pixel in its own block

// What a pixel has while pieces of surfaces are added.
struct pixel_sum {
    vec3 normal;  // of the plane that it lies on
    float height; // of that
    vec3 first;   // value of the first piece of its surface; before there is one, of the nearest piece
                  // of its own block
    vec3 sum;     // of weight x (value - first), so that equal values give just that
    float weight; // below 0: there is none yet; -1 less the distance to the nearest
};

// A piece of surface: seen at `p` with normal `n`, at `place` on the screen, lit by `value`. Those of
// its own block are always of weight, and a smooth one is its pixels' own surface.
struct piece {
    vec2 place;
    vec3 p, n, value;
    bool own, smooth_;
};

void add(piece s, ivec2 corner, inout pixel_sum to[pixels])
{
    float least = s.own ? own_least : 0.0;
    float reach2 = limits.x * limits.x * dot(s.p, s.p);
    for (int i = 0; i < pixels; i++) {
        vec2 off = abs(vec2(corner + ivec2(i % PART, i / PART)) + 0.5 - s.place);
        vec2 tent = max(1.0 - off / float(edge), 0.0);
        // surface_is_same(), with the pixel's plane at hand.
        float above = dot(s.p, to[i].normal) - to[i].height;
        vec3 bend = to[i].normal - s.n;
        bool same = (s.own && s.smooth_) ||
                    (dot(bend, bend) < limits.y * limits.y && above * above < reach2);
        float w = same ? max(tent.x * tent.y, least) : 0.0;
        float far = -1.0 - off.x - off.y;
        bool begins = to[i].weight < 0.0 && (w > 0.0 || (s.own && far > to[i].weight));
        to[i].first = begins ? s.value : to[i].first;
        to[i].weight = w > 0.0 ? max(to[i].weight, 0.0) + w : begins ? far : to[i].weight;
        if (w > 0.0) // else the value may be no number
            to[i].sum += w * (s.value - to[i].first);
    }
}

// The pieces of a block: bits of its tile, or one for all of a smooth block.
uvec2 pieces_of(ivec2 block, bool smooth_)
{
    if (smooth_)
        return uvec2(1u, 0u);
    if (any(lessThan(block, ivec2(0))) || any(greaterThanEqual(block * edge, view.size.xy)))
        return uvec2(0u);
    ivec2 low = block * edge, tile = low >> 3;
    uvec2 mask = tiles[tile.y * tiles_across + tile.x].xy;
#if SHARE < 3
    uint row = ((1u << edge) - 1u) << (low.x & 7);
    uint rows = SHARE == 2 ? row * 0x01010101u : (row * 0x0101u) << ((low.y & 2) * 8);
    mask &= (low.y & 4) == 0 ? uvec2(rows, 0u) : uvec2(0u, rows);
#endif
    return mask;
}

piece fetch(ivec2 block, int bit, bool own, bool smooth_)
{
    ivec2 pixel = smooth_ ? block * edge + edge / 2
                          : (block * edge & ~7) + ivec2(bit & 7, bit >> 3);
    piece s;
    s.place = vec2(pixel) + (smooth_ ? 0.0 : 0.5);
    s.p = texelFetch(position_map, pixel, 0).xyz;
    s.n = texelFetch(normal_map, pixel, 0).xyz;
    s.value = texelFetch(pyramid, smooth_ ? level.zw + block : pixel, 0).rgb;
    s.own = own;
    s.smooth_ = smooth_;
    return s;
}

void add_all(ivec2 cell, ivec2 corner, inout pixel_sum to[pixels])
{
    ivec2 block = cell >> 1, side = side_of(cell);
    uint word = blocks[block.y * level.x + block.x];
    uvec2 left = uvec2(0u);
    bool smooth_ = false;
    // One piece a round, whichever block it is of: neighbours in a vector unit stay together.
    for (int i = -1; i < 4;) {
        ivec2 step_ = side * ivec2(i & 1, i >> 1);
        if ((left.x | left.y) != 0u) {
            int bit = left.x != 0u ? findLSB(left.x) : 32 + findLSB(left.y);
            left = left.x != 0u ? uvec2(left.x & (left.x - 1u), left.y)
                                : uvec2(0u, left.y & (left.y - 1u));
            add(fetch(block + step_, bit, i == 0, smooth_), corner, to);
        }
        while ((left.x | left.y) == 0u && ++i < 4) {
            step_ = side * ivec2(i & 1, i >> 1);
            smooth_ = neighbour_is_smooth(word, step_);
            left = pieces_of(block + step_, smooth_);
        }
    }
}

void main()
{
    int group = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    int index = group * 64 + int(gl_LocalInvocationIndex);
    if (index >= int(dispatch.w) * parts * parts)
        return;
    uint code = cells[index / (parts * parts)];
    int part = index % (parts * parts);
    ivec2 cell = ivec2(code & 0xffffu, code >> 16);
    ivec2 corner = cell * (edge / 2) + ivec2(part % parts, part / parts) * PART;
    ivec2 last = view.size.xy - 1;
    pixel_sum to[pixels];
    for (int i = 0; i < pixels; i++) {
        ivec2 pixel = min(corner + ivec2(i % PART, i / PART), last);
        vec3 n = texelFetch(normal_map, pixel, 0).xyz;
        float height = dot(texelFetch(position_map, pixel, 0).xyz, n);
        to[i] = pixel_sum(n, height, vec3(0.0), vec3(0.0), -1e9);
    }
    add_all(cell, corner, to);
    for (int i = 0; i < pixels; i++) {
        ivec2 pixel = corner + ivec2(i % PART, i / PART);
        vec3 value = to[i].first + (to[i].weight > 0.0 ? to[i].sum / to[i].weight : vec3(0.0));
        if (all(lessThanEqual(pixel, last)))
            imageStore(result, pixel, vec4(max(value, vec3(0.0)), 1.0));
    }
}
