#version 450 core
// SPDX-License-Identifier: MIT
// Lists the valid texels, tile by tile, always in the same order.
// In:  uvec4[] of tiles; SUM: that alone. Else: how many each 256 of them have
// Out: SUM: how many each 256 tiles have. Else: texels; count and indirect dispatches
//      Source: beyond Nichols, Shopf, Wyman 2009, which culls by stencil.
#include "passes/multires/texel.glsl"

const uint each = 4; // tiles of an invocation: on a CPU barriers cost by how many meet there
const uint group = 64;
layout(local_size_x = group) in;

layout(std430, binding = 0) readonly buffer tile_buffer
{
    uvec4 tiles[];
};
layout(std430, binding = 1) buffer sum_buffer
{
    uint sums[];
};
layout(std430, binding = 2) writeonly buffer texel_buffer
{
    uint texels[];
};
layout(std430, binding = 3) writeonly buffer count_buffer
{
    uvec4 counts[4];
};
layout(location = 0) uniform ivec2 grid;  // tiles
layout(location = 1) uniform int levels;

#include "passes/shading/scan.glsl"

uvec4 tile_at(uint index)
{
    return index < uint(grid.x * grid.y) ? tiles[index] : uvec4(0u);
}

// Of the invocation's tiles.
uint count_here()
{
    uint sum = 0u;
    for (uint i = 0; i < each; i++)
        sum += tile_at(gl_GlobalInvocationID.x * each + i).w;
    return sum;
}

#ifdef SUM
void main()
{
    uint all;
    scan(count_here(), all);
    if (gl_LocalInvocationIndex == 0)
        sums[gl_WorkGroupID.x] = all;
}
#else
void list_bits(uint bits, int level, int log2_along, ivec2 origin, inout uint place)
{
    for (; bits != 0u; bits &= bits - 1u) {
        int bit = findLSB(bits);
        ivec2 at = ivec2(bit & ((1 << log2_along) - 1), bit >> log2_along);
        texels[place++] = multires_pack(level, origin + at);
    }
}

void list_tile(ivec2 tile, uvec4 mask, inout uint place)
{
    for (int level = levels - 1; level >= 3; level--)
        if ((mask.z >> (17 + level) & 1u) != 0u)
            texels[place++] = multires_pack(level, tile >> (level - 3));
    list_bits(mask.z >> 16 & 15u, 2, 1, tile * 2, place);
    list_bits(mask.z & 0xffffu, 1, 2, tile * 4, place);
    list_bits(mask.x, 0, 3, tile * 8, place);
    list_bits(mask.y, 0, 3, tile * 8 + ivec2(0, 4), place);
}

// As a dispatch of work groups that take `each` of them; more than fit one axis fill rows.
uvec4 dispatch_of(uint total, uint each)
{
    uint groups = (total + each - 1u) / each, rows = (groups + 65534u) / 65535u;
    return uvec4(min(groups, 65535u), max(rows, 1u), 1u, 0u);
}

void main()
{
    uint me = gl_LocalInvocationIndex, earlier = 0u, base, here;
    for (uint g = me; g < gl_WorkGroupID.x; g += group)
        earlier += sums[g];
    scan(earlier, base);
    uint place = base + scan(count_here(), here);
    for (uint i = 0; i < each; i++) {
        uint index = gl_GlobalInvocationID.x * each + i;
        uvec4 mask = tile_at(index);
        if (mask.w != 0u)
            list_tile(ivec2(int(index) % grid.x, int(index) / grid.x), mask, place);
    }
    if (me == 0u && gl_WorkGroupID.x == gl_NumWorkGroups.x - 1u) {
        uint total = base + here;
        counts[0] = uvec4(total, 0u, 0u, 0u);
        counts[1] = dispatch_of(total, 64u);
        counts[2] = dispatch_of(total, 256u);
        counts[3] = dispatch_of(total, 1024u);
    }
}
#endif
