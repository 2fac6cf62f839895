#version 450 core
// SPDX-License-Identifier: MIT
// In and out: a counter that every invocation raises by one.
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer counter
{
    uint count;
};

void main()
{
    atomicAdd(count, 1);
}
