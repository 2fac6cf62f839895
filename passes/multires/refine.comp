#version 450 core
// SPDX-License-Identifier: MIT
// Which texels of one level of the multiresolution buffer are refined: those that hold an edge, and
// those beside which the levels would differ by more than one.
// In:  change RGBA16F pyramid; flags of the next finer level
// Out: flags of this level
// Source: Nichols, Shopf, Wyman 2009, sec. 3.2.1, IsDiscontinuity(f, i).
#include "passes/multires/texel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D change;
layout(std430, binding = 0) buffer flag_buffer
{
    uint flags[];
};
layout(location = 0) uniform ivec4 level; // x: this one; y: first of the variation pyramid; zw: pixels
layout(location = 1) uniform ivec4 base;  // xy: size of level 0 in the pyramid; z: 1: balanced;
                                          // w: 1: the finest level with flags
layout(location = 2) uniform vec2 limits; // depth derivative, extent of the normal

bool is_discontinuity(ivec2 at)
{
    ivec2 place = pyramid_origin(base.xy >> level.y, level.x - level.y) + at;
    vec4 c = texelFetch(change, place, 0);
    return c.w >= limits.x || max(c.x, max(c.y, c.z)) >= limits.y;
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = base.xy >> level.x;
    if (any(greaterThanEqual(at, size)))
        return;
    bool beyond = any(greaterThan((at + 1) << level.x, level.zw));
    bool mixed = beyond || is_discontinuity(at);
    bool refined = mixed;
    if (base.w == 0) {
        int reach = base.z; // children, and what lies about them
        ivec2 lo = max(at * 2 - reach, ivec2(0)), hi = min(at * 2 + 1 + reach, size * 2 - 1);
        for (int y = lo.y; y <= hi.y; y++)
            for (int x = lo.x; x <= hi.x; x++)
                refined = refined || (flags[multires_flag_index(level.x - 1, ivec2(x, y), base.xy)] &
                                      multires_refined) != 0u;
    }
    flags[multires_flag_index(level.x, at, base.xy)] =
        (refined ? multires_refined : 0u) | (mixed ? multires_mixed : 0u);
}
