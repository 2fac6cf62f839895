#version 450 core
// SPDX-License-Identifier: MIT
// Work groups for what the lists have.
// In:  counts
// Out: two sets of glDispatchComputeIndirect()'s arguments, four words each
layout(local_size_x = 1) in;

layout(std430, binding = 0) readonly buffer count_buffer
{
    uint counts[4];
};
layout(std430, binding = 1) writeonly buffer group_buffer
{
    uvec4 groups[2];
};

const uint along = 32768u; // of a row

void main()
{
    uint small_groups = (counts[0] + 63u) / 64u, large = counts[1];
    groups[0] = uvec4(min(small_groups, along), (small_groups + along - 1u) / along, 1u, 0u);
    groups[1] = uvec4(min(large, along), (large + along - 1u) / along, 1u, 0u);
}
