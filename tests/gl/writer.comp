#version 450 core
// SPDX-License-Identifier: MIT
// Out: VALUE.
layout(local_size_x = 1) in;
layout(std430, binding = 0) writeonly buffer result
{
    int number;
};

void main()
{
    number = VALUE;
}
