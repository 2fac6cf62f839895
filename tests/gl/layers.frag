#version 450 core
// SPDX-License-Identifier: MIT
// Out: 10 x (1 + layer).
layout(location = 0) flat in int layer;
layout(location = 0) out float color;

void main()
{
    color = 10.0 * float(1 + layer);
}
