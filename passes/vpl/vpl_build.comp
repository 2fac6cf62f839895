#version 450 core
// SPDX-License-Identifier: MIT
// Makes one VPL of each block of RSM texels, by index face, row, column, and counts the
// valid ones of each group of 256.
// In:  position RGBA32F (w area), normal RGBA16F, flux RGBA32F, a layer a face; faces
// Out: ag_vpl[], invalid ones with flux 0; valid VPLs of each group
//
// WIDE: a work group makes one VPL of a large block, instead of an invocation.
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
layout(location = 0) uniform ivec4 layout_; // x: blocks along an edge; y: texels along a block's
                                            // edge; z: VPLs in all; w: 1: jittered
layout(location = 1) uniform uint seed;

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
    if (layout_.w == 0)
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

ivec3 corner_of(uint index)
{
    int grid = layout_.x;
    int face = int(index) / (grid * grid);
    int cell = int(index) % (grid * grid);
    return ivec3(ivec2(cell % grid, cell / grid) * layout_.y, face);
}

// Of the block's texels `first`, `first` + `step`, ...
block_sum sum_texels(uint index, int first, int step)
{
    int block = layout_.y;
    ivec3 corner = corner_of(index);
    ivec2 wanted = wanted_texel(index, block);
    block_sum sum = block_sum(vec4(0.0), 1 << 30, -1);
    for (int i = first; i < block * block; i += step) {
        ivec2 at = ivec2(i % block, i / block);
        float area = texelFetch(position_map, corner + ivec3(at, 0), 0).w;
        vec3 flux = texelFetch(flux_map, corner + ivec3(at, 0), 0).rgb;
        if (area <= 0.0 || max(flux.r, max(flux.g, flux.b)) <= 0.0)
            continue;
        ivec2 off = at - wanted;
        sum = add_blocks(sum, block_sum(vec4(flux, area), off.x * off.x + off.y * off.y, i));
    }
    return sum;
}

ag_vpl make_vpl(uint index, block_sum sum)
{
    if (sum.best < 0)
        return ag_vpl(vec4(0.0), vec4(0.0), vec4(0.0));
    int block = layout_.y;
    ivec3 texel = corner_of(index) + ivec3(sum.best % block, sum.best / block, 0);
    vec3 p = texelFetch(position_map, texel, 0).xyz;
    vec3 n = normalize(texelFetch(normal_map, texel, 0).xyz);
    ag_vpl v = ag_vpl(vec4(p, sum.flux_area.a), vec4(n, 0.0), vec4(sum.flux_area.rgb, 0.0));
    pack_edges(faces[texel.z], p, n, v);
    return v;
}

#ifdef WIDE
shared block_sum parts[256];

// A work group a VPL.
void main()
{
    uint index = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
    uint me = gl_LocalInvocationIndex;
    if (index >= uint(layout_.z)) // the whole group
        return;
    parts[me] = sum_texels(index, int(me), 256);
    for (uint half_ = 128; half_ > 0; half_ /= 2) {
        barrier();
        if (me < half_)
            parts[me] = add_blocks(parts[me], parts[me + half_]);
    }
    if (me > 0)
        return;
    ag_vpl v = make_vpl(index, parts[0]);
    vpls[index] = v;
    if (v.position_area.w > 0.0)
        atomicAdd(valid_in_group[index / 256], 1u); // cleared before
}
#else
shared uint valid_here;

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (gl_LocalInvocationIndex == 0)
        valid_here = 0;
    barrier();
    if (index < uint(layout_.z)) {
        ag_vpl v = make_vpl(index, sum_texels(index, 0, 1));
        vpls[index] = v;
        if (v.position_area.w > 0.0)
            atomicAdd(valid_here, 1u);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0)
        valid_in_group[gl_WorkGroupID.x] = valid_here;
}
#endif
