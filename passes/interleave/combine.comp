#version 450 core
// SPDX-License-Identifier: MIT
// Puts the n x n tiles together again.
// In:  light RGBA32F of the split's size
// Out: light RGBA32F of the frame's
// Source: Laine, Saransaari, Kontkanen, Lehtinen, Aila 2007, sec. 5.1.
#include "passes/interleave/tiles.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(binding = 0) uniform sampler2D tiles_map;
layout(binding = 0, rgba32f) writeonly uniform image2D result;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, frame.xy)))
        imageStore(result, at, texelFetch(tiles_map, place_of(at), 0));
}
