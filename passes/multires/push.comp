#version 450 core
// SPDX-License-Identifier: MIT
// One level of a multiresolution image.
// In:  flags; pyramid RGBA32F with values at the valid texels
// Out: PULL: texels of this level that are refined and hold no edge: the mean of what they cover.
//      Else: texels of this level below valid ones: bilinear between those of the next coarser one.
// Source: Nichols, Wyman 2009, sec. 4.4.
#include "passes/multires/interpolate.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(location = 2) uniform int level;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, base >> level)))
        return;
    ivec2 place = pyramid_origin(base, level) + at;
#ifdef PULL
    if (flags_of(level, at) != multires_refined)
        return;
    ivec2 child = at * 2;
    vec4 lower = value_of(level - 1, child) + value_of(level - 1, child + ivec2(1, 0));
    vec4 upper = value_of(level - 1, child + ivec2(0, 1)) + value_of(level - 1, child + 1);
    imageStore(pyramid, place, 0.25 * (lower + upper));
#else
    if ((flags_of(level + 1, at >> 1) & multires_refined) == 0u)
        imageStore(pyramid, place, interpolate_child(level, at));
#endif
}
