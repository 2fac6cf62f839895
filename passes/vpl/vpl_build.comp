#version 450 core
// SPDX-License-Identifier: MIT
// Makes one VPL of each block of RSM texels, by index face, row, column, and counts the
// valid ones of each group of 256.
// In:  position RGBA32F (w area), normal RGBA16F, flux RGBA32F, a layer a face; faces; how many
//      blocks each face has
// Out: ag_vpl[], invalid ones with area 0; valid VPLs of each 256, 0 before
//
// An invocation makes the VPL of a small block, a work group that of a large one.
//
// A VPL sits on one texel of its block and carries the block's summed flux and area, so that no
// energy is lost or made by choosing fewer.
// Source: Nichols, Shopf, Wyman 2009, sec. 3.2.2, the VPL cache.
//         Departs from it: the flux of the whole block instead of the texel's times the count.
#include "passes/include/pass/scene_shared.h"
#include "passes/include/pass/vpl_shared.h"
#include "passes/vpl/patch.glsl"

layout(local_size_x = 256) in;

layout(binding = 0) uniform sampler2DArray position_map;
layout(binding = 1) uniform sampler2DArray normal_map;
layout(binding = 2) uniform sampler2DArray flux_map;
layout(std430, binding = 0) writeonly buffer vpl_buffer
{
    ag_vpl vpls[];
};
layout(std430, binding = 1) buffer group_buffer
{
    uint valid_in_group[];
};
layout(std430, binding = 2) readonly buffer face_buffer
{
    ag_gpu_face faces[];
};
// A row for each face with light, in their order: x face; y its first VPL; z its first work group;
// w blocks along its edge.
layout(std430, binding = 3) readonly buffer table_buffer
{
    ivec4 header; // x: rows; y: work groups; z: texels along a map's edge; w: 1: jittered
    ivec4 rows[];
};
layout(location = 0) uniform uint seed;

layout(location = 1) uniform int wide_block; // texels along the edge of a block from which on a work
                                             // group sums it

// A block of texels.
struct block_place {
    uint index; // of its VPL
    int edge;   // texels
    ivec3 corner;
};

block_place place_of(ivec4 row, int cell)
{
    int edge = header.z / row.w;
    ivec2 corner = ivec2(cell % row.w, cell / row.w) * edge;
    return block_place(uint(row.y + cell), edge, ivec3(corner, row.x));
}

// The face that a work group works for: the last row that begins no later.
ivec4 row_of(int group)
{
    int lo = 0, hi = header.x - 1;
    while (lo < hi) {
        int mid = (lo + hi + 1) / 2;
        if (rows[mid].z <= group)
            lo = mid;
        else
            hi = mid - 1;
    }
    return rows[lo];
}

// A well-mixed number of three: multiply, xor of high on low bits, twice over.
uint mix_bits(uint x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

// The texel of its block that a VPL would like to sit on.
ivec2 wanted_texel(uint index, int block)
{
    if (header.w == 0)
        return ivec2(block / 2);
    uint h = mix_bits(index * 0x9e3779b9u + mix_bits(seed));
    return ivec2(int(h & 0xffffu) * block >> 16, int(h >> 16) * block >> 16);
}

// What a block holds: the sum of flux and area, and the lit texel nearest to the wanted one.
struct block_sum {
    vec4 flux_area;
    int nearest; // squared distance, texels^2
    int best;    // texel of the block, by row; -1: none is lit
};

// Of two texels equally near the one of the lower index, in whatever order they come.
block_sum add_blocks(block_sum a, block_sum b)
{
    bool second = b.nearest < a.nearest || (b.nearest == a.nearest && b.best < a.best);
    return block_sum(a.flux_area + b.flux_area, second ? b.nearest : a.nearest,
                     second ? b.best : a.best);
}

// Of the block's texels `first`, `first` + `step`, ...
block_sum sum_texels(block_place block, int first, int step)
{
    ivec2 wanted = wanted_texel(block.index, block.edge);
    block_sum sum = block_sum(vec4(0.0), 1 << 30, -1);
    for (int i = first; i < block.edge * block.edge; i += step) {
        ivec2 at = ivec2(i % block.edge, i / block.edge);
        ivec3 texel = block.corner + ivec3(at, 0);
        float area = texelFetch(position_map, texel, 0).w;
        vec3 flux = texelFetch(flux_map, texel, 0).rgb;
        if (area <= 0.0 || max(flux.r, max(flux.g, flux.b)) <= 0.0)
            continue;
        ivec2 off = at - wanted;
        sum = add_blocks(sum, block_sum(vec4(flux, area), off.x * off.x + off.y * off.y, i));
    }
    return sum;
}

// Writes the VPL; false where it is none.
bool store_vpl(block_place block, block_sum sum)
{
    ag_vpl v = ag_vpl(vec4(0.0), vec4(0.0), vec4(0.0));
    if (sum.best >= 0) {
        ivec3 texel = block.corner + ivec3(sum.best % block.edge, sum.best / block.edge, 0);
        vec3 p = texelFetch(position_map, texel, 0).xyz;
        vec3 n = normalize(texelFetch(normal_map, texel, 0).xyz);
        v = ag_vpl(vec4(p, sum.flux_area.a), vec4(n, 0.0), vec4(sum.flux_area.rgb, 0.0));
        pack_edges(faces[texel.z], p, n, v);
    }
    vpls[block.index] = v;
    return sum.best >= 0;
}

shared block_sum parts[256];

void make_wide(block_place block)
{
    uint me = gl_LocalInvocationIndex;
    parts[me] = sum_texels(block, int(me), 256);
    for (uint half_ = 128; half_ > 0; half_ /= 2) {
        barrier();
        if (me < half_)
            parts[me] = add_blocks(parts[me], parts[me + half_]);
    }
    if (me == 0 && store_vpl(block, parts[0]))
        atomicAdd(valid_in_group[block.index / 256], 1u);
}

shared uint valid_here[2]; // of the 256 that the work group begins in, and of the next

void make_small(ivec4 row, int first)
{
    uint me = gl_LocalInvocationIndex;
    uint base = uint(row.y + first) / 256;
    int cell = first + int(me);
    if (me < 2)
        valid_here[me] = 0;
    barrier();
    if (cell < row.w * row.w) {
        block_place block = place_of(row, cell);
        if (store_vpl(block, sum_texels(block, 0, 1)))
            atomicAdd(valid_here[block.index / 256 - base], 1u);
    }
    barrier();
    if (me < 2 && valid_here[me] > 0)
        atomicAdd(valid_in_group[base + me], valid_here[me]);
}

void main()
{
    int group = int(gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x);
    if (group >= header.y) // all of it
        return;
    ivec4 row = row_of(group);
    if (header.z / row.w >= wide_block)
        make_wide(place_of(row, group - row.z));
    else
        make_small(row, (group - row.z) * 256);
}
