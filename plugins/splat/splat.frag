#version 450 core
// SPDX-License-Identifier: MIT
// In:  light of one VPL at one patch
// Out: RGBA32F, added to what is there; a 0
flat in vec3 light;
layout(location = 0) out vec4 sum;

void main()
{
    sum = vec4(light, 0.0);
}
