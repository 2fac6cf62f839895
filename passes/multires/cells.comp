#version 450 core
// SPDX-License-Identifier: MIT
// Sorts the cells of shared blocks: those with an edge near go on a list, the others are bilinear.
// In:  flags
// Out: a word a block, see cells.glsl; the cells with an edge near, and their dispatch
#include "passes/multires/cells.glsl"
#include "passes/multires/texel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = 0) readonly buffer flag_buffer
{
    uint flags[];
};
layout(std430, binding = 1) writeonly buffer block_buffer
{
    uint blocks[];
};
layout(std430, binding = 2) buffer cell_buffer
{
    uvec4 dispatch; // xy: work groups of 64 invocations; w: cells
    uint cells[];   // y << 16 | x
};
layout(location = 0) uniform ivec2 base;  // size of level 0
layout(location = 1) uniform ivec4 share; // x: level; y: where its flags begin; z: invocations a cell
layout(location = 2) uniform ivec2 image; // pixels

// 0: off the image. What only reaches beyond it is mixed, but there.
uint state_of(ivec2 block)
{
    ivec2 size = base >> share.x;
    if (any(lessThan(block, ivec2(0))) || any(greaterThanEqual(block << share.x, image)))
        return 0u;
    bool mixed = (flags[share.y + block.y * size.x + block.x] & multires_mixed) != 0u;
    return mixed ? 2u : 1u;
}

void append(ivec2 cell)
{
    uint place = atomicAdd(dispatch.w, 1u);
    cells[place] = uint(cell.y) << 16 | uint(cell.x);
    uint groups = (place + 1u) * uint(share.z) / 64u + 1u; // more than fit one axis fill rows
    atomicMax(dispatch.x, min(groups, 65535u));
    if (groups > 65535u)
        atomicMax(dispatch.y, (groups + 65534u) / 65535u);
}

void main()
{
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (state_of(block) == 0u)
        return;
    uint word = 0u, mixed = 0u;
    for (int i = 0; i < 9; i++) {
        uint state = state_of(block + ivec2(i % 3, i / 3) - 1);
        word |= (state & 1u) << i;
        mixed |= (state >> 1) << i;
    }
    // Neighbours about each of the four corners.
    const uint about[4] = { 0x01bu, 0x036u, 0x0d8u, 0x1b0u };
    for (int i = 0; i < 4; i++)
        if ((mixed & about[i]) != 0u) {
            word |= 1u << (9 + i);
            append(block * 2 + ivec2(i & 1, i >> 1));
        }
    blocks[block.y * (base.x >> share.x) + block.x] = word;
}
