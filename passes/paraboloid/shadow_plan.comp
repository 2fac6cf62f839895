#version 450 core
// SPDX-License-Identifier: MIT
// Work groups for what the lists have.
// In:  counts
// Out: a set of glDispatchComputeIndirect()'s arguments each, four words
layout(local_size_x = 1) in;

layout(std430, binding = 0) writeonly buffer group_buffer
{
    uvec4 groups[3];
};
layout(std430, binding = 1) readonly buffer count_buffer
{
    uint counts[4];
};

const uint along = 32768u; // of a row

void main()
{
    for (int i = 0; i < 3; i++) {
        uint n = i < 2 ? (counts[i] + 63u) / 64u : counts[i];
        groups[i] = uvec4(min(n, along), (n + along - 1u) / along, 1u, 0u);
    }
}
