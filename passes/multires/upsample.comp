#version 450 core
// SPDX-License-Identifier: MIT
// Brings a multiresolution image to every pixel.
// In:  flags, tiles; pyramid RGBA32F with values at all texels from level SHARE on that hold no edge
//      and at the valid pixels; position RGBA32F, normal RGBA16F
// Out: RGBA32F of the frame's size, a 1
// SHARE: level of the blocks that share pixels, 0: none. CELL: pixels along the edge of what an invocation
// does, at most half a block.
// Source: Nichols, Wyman 2009, sec. 4.4. Departs from it: blocks that hold an edge are interpolated
//         over what lies near of each pixel's own surface.
#include "passes/include/pass/view_shared.h"
#include "passes/multires/interpolate.glsl"
#include "passes/multires/surface.glsl"

#ifndef SHARE
#define SHARE 3
#endif
#ifndef CELL
#define CELL 2
#endif

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(std430, binding = 1) readonly buffer tile_buffer
{
    uvec4 tiles[];
};
layout(binding = 1, rgba32f) writeonly uniform image2D result;
layout(location = 2) uniform vec2 limits;
layout(location = 3) uniform int tiles_across;

void write(ivec2 pixel, vec3 value)
{
    if (all(lessThan(pixel, view.size.xy)))
        imageStore(result, pixel, vec4(value, 1.0));
}

#if SHARE == 0
// A cell is a texel of level 1.
void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, base >> 1)))
        return;
    bool refined = (flags_of(1, cell) & multires_refined) != 0u;
    for (int i = 0; i < 4; i++) {
        ivec2 pixel = cell * 2 + ivec2(i & 1, i >> 1);
        write(pixel, refined ? value_of(0, pixel).rgb : interpolate_child(0, pixel).rgb);
    }
}
#else

const int edge = 1 << SHARE; // pixels along a block's edge
const int pixels = CELL * CELL;
const float own_least = 1e-4; // weight of what stands for a pixel in its own block

// What is known of the cell's pixels while pieces of surfaces are added.
ivec2 corner;
vec3 at_position[pixels], at_normal[pixels], first[pixels], sum[pixels];
float weight[pixels];

// A piece of surface: seen at `p` with normal `n`, at `place` on the screen, lit by `value`.
void add_piece(vec2 place, vec3 p, vec3 n, vec3 value, bool own, bool sure)
{
    for (int i = 0; i < pixels; i++) {
        vec2 off = abs(vec2(corner + ivec2(i % CELL, i / CELL)) + 0.5 - place);
        vec2 tent = max(1.0 - off / float(edge), 0.0);
        float w = max(tent.x * tent.y, own ? own_least : 0.0);
        w = sure || surface_is_same(at_position[i], at_normal[i], p, n, limits) ? w : 0.0;
        bool begins = weight[i] == 0.0 && (w > 0.0 || (own && off.x + off.y < 0.5));
        first[i] = begins ? value : first[i];
        sum[i] += w * (value - first[i]);
        weight[i] += w;
    }
}

void add_bits(uint bits, ivec2 tile_corner, int first_row, ivec2 block, bool own)
{
    for (; bits != 0u; bits &= bits - 1u) {
        int bit = findLSB(bits);
        ivec2 pixel = tile_corner + ivec2(bit & 7, first_row + (bit >> 3));
        if ((pixel >> SHARE) == block)
            add_piece(vec2(pixel) + 0.5, texelFetch(position_map, pixel, 0).xyz,
                      texelFetch(normal_map, pixel, 0).xyz, value_of(0, pixel).rgb, own, false);
    }
}

void add_block(ivec2 block, bool own)
{
    if (any(lessThan(block, ivec2(0))) || any(greaterThanEqual(block, base >> SHARE)))
        return;
    if (is_smooth(SHARE, block)) {
        ivec2 middle = block * edge + edge / 2 - 1;
        vec3 p = vec3(0.0), n = vec3(0.0);
        for (int i = 0; i < 4; i++) {
            p += texelFetch(position_map, middle + ivec2(i & 1, i >> 1), 0).xyz;
            n += texelFetch(normal_map, middle + ivec2(i & 1, i >> 1), 0).xyz;
        }
        add_piece(vec2(block * edge + edge / 2), 0.25 * p, 0.25 * n, value_of(SHARE, block).rgb, own,
                  own);
        return;
    }
    ivec2 tile = (block * edge) >> 3;
    uvec4 mask = tiles[tile.y * tiles_across + tile.x];
    add_bits(mask.x, tile * 8, 0, block, own);
    add_bits(mask.y, tile * 8, 4, block, own);
}

// Where there is an edge near: from the pieces of each pixel's own surface.
void by_pieces(ivec2 block, ivec2 side)
{
    ivec2 last = view.size.xy - 1;
    for (int i = 0; i < pixels; i++) {
        ivec2 pixel = min(corner + ivec2(i % CELL, i / CELL), last);
        at_position[i] = texelFetch(position_map, pixel, 0).xyz;
        at_normal[i] = texelFetch(normal_map, pixel, 0).xyz;
        first[i] = sum[i] = vec3(0.0);
        weight[i] = 0.0;
    }
    for (int i = 0; i < 4; i++)
        add_block(block + side * ivec2(i & 1, i >> 1), i == 0);
    for (int i = 0; i < pixels; i++)
        write(corner + ivec2(i % CELL, i / CELL),
              first[i] + (weight[i] > 0.0 ? sum[i] / weight[i] : vec3(0.0)));
}

// Where there is none: bilinear.
void by_blocks(ivec2 block, ivec2 side)
{
    ivec2 dx = ivec2(side.x, 0), dy = ivec2(0, side.y);
    vec4 mine = value_of(SHARE, block);
    vec4 x = beside(SHARE, block, dx, mine), y = beside(SHARE, block, dy, mine);
    vec4 across = x + (y - mine);
    if (is_smooth(SHARE, block + side))
        across = value_of(SHARE, block + side);
    for (int i = 0; i < pixels; i++) {
        ivec2 pixel = corner + ivec2(i % CELL, i / CELL);
        vec2 f = abs(vec2(pixel - block * edge) + 0.5 - 0.5 * float(edge)) / float(edge);
        write(pixel, max(bilinear(mine, x, y, across, f), 0.0).rgb);
    }
}

// A texel beyond the image is no edge in it.
bool holds_edge(ivec2 block)
{
    return all(greaterThanEqual(block, ivec2(0))) &&
           all(lessThan(block * edge, view.size.xy)) && !is_smooth(SHARE, block);
}

void main()
{
    corner = ivec2(gl_GlobalInvocationID.xy) * CELL;
    if (any(greaterThanEqual(corner, view.size.xy)))
        return;
    ivec2 block = corner >> SHARE;
    // The cell lies in one quarter of its block; the three blocks about that corner matter.
    ivec2 side = mix(ivec2(-1), ivec2(1), greaterThanEqual(corner - block * edge, ivec2(edge / 2)));
    if (holds_edge(block) || holds_edge(block + ivec2(side.x, 0)) ||
        holds_edge(block + ivec2(0, side.y)) || holds_edge(block + side))
        by_pieces(block, side);
    else
        by_blocks(block, side);
}
#endif
