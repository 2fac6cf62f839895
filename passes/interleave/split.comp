#version 450 core
// SPDX-License-Identifier: MIT
// Takes the G-buffer apart into n x n tiles.
// In:  position RGBA32F, normal RGBA16F
// Out: the same, tile beside tile; 0 where a tile has no pixel
// Source: Laine, Saransaari, Kontkanen, Lehtinen, Aila 2007, sec. 5.1.
#include "passes/interleave/tiles.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 0, rgba32f) writeonly uniform image2D position;
layout(binding = 1, rgba16f) writeonly uniform image2D normal;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, tile * frame.z)))
        return;
    ivec2 from = pixel_of(at), inside = min(from, frame.xy - 1);
    bool there = from == inside;
    imageStore(position, at, there ? texelFetch(position_map, inside, 0) : vec4(0.0));
    imageStore(normal, at, there ? texelFetch(normal_map, inside, 0) : vec4(0.0));
}
