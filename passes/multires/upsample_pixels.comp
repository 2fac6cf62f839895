#version 450 core
// SPDX-License-Identifier: MIT
// Brings a multiresolution image that is refined to pixels to every pixel.
// In:  flags; pyramid RGBA32F with values at all texels that hold no edge
// Out: RGBA32F of the frame's size, a 1
// Source: Nichols, Wyman 2009, sec. 4.4.
#include "passes/include/pass/view_shared.h"
#define SAMPLED 1
#include "passes/multires/interpolate.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 1, rgba32f) writeonly uniform image2D result;

// An invocation does what lies under a texel of level 1.
void main()
{
    ivec2 parent = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(parent, base >> 1)))
        return;
    bool refined = (flags_of(1, parent) & multires_refined) != 0u;
    for (int i = 0; i < 4; i++) {
        ivec2 pixel = parent * 2 + ivec2(i & 1, i >> 1);
        vec3 value = refined ? value_of(0, pixel).rgb : interpolate_child(0, pixel).rgb;
        if (all(lessThan(pixel, view.size.xy)))
            imageStore(result, pixel, vec4(value, 1.0));
    }
}
