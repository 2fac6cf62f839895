#version 450 core
// SPDX-License-Identifier: MIT
// Depth of what a light sees; only MASK has anything to do.
#ifdef MASK
#include "passes/gpu_scene/material.glsl"
#endif

void main()
{
#ifdef MASK
    surface_here(vec3(0.0));
#endif
}
