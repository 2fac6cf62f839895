// SPDX-License-Identifier: MIT
// Values of a multiresolution image at texels that hold no edge, and between them.
#include "passes/multires/texel.glsl"

layout(std430, binding = 0) readonly buffer flag_buffer
{
    uint flags[];
};
#ifdef SAMPLED
layout(binding = 2) uniform sampler2D pyramid;
#else
layout(binding = 0, rgba32f) uniform image2D pyramid;
#endif
layout(location = 0) uniform ivec2 base; // size of level 0

uint flags_of(int level, ivec2 at)
{
    return level > 0 ? flags[multires_flag_index(level, at, base)] : 0u;
}

vec4 value_of(int level, ivec2 at)
{
    ivec2 place = pyramid_origin(base, level) + at;
#ifdef SAMPLED
    return texelFetch(pyramid, place, 0);
#else
    return imageLoad(pyramid, place);
#endif
}

// Whether the texel is there and all of one surface.
bool is_smooth(int level, ivec2 at)
{
    return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, base >> level)) &&
           (flags_of(level, at) & multires_mixed) == 0u;
}

// What a neighbour `step_` beside texel `at` holds. Where there is none, what goes on from the other
// side, so that what is linear stays so; without either the texel's own value `mine`.
vec4 beside(int level, ivec2 at, ivec2 step_, vec4 mine)
{
    if (is_smooth(level, at + step_))
        return value_of(level, at + step_);
    if (is_smooth(level, at - step_))
        return max(2.0 * mine - value_of(level, at - step_), 0.0);
    return mine;
}

// `f` of the way from `mine` to the others. Equal ones give exactly what they are.
vec4 bilinear(vec4 mine, vec4 x, vec4 y, vec4 corner, vec2 f)
{
    return mine + (x - mine) * f.x + (y - mine) * f.y + (corner - x - y + mine) * (f.x * f.y);
}

// Texel `at` of `level` from the four nearest on the next coarser level; the one above it is of one
// surface.
vec4 interpolate_child(int level, ivec2 at)
{
    ivec2 parent = at >> 1, dx = ivec2((at.x & 1) * 2 - 1, 0), dy = ivec2(0, (at.y & 1) * 2 - 1);
    vec4 mine = value_of(level + 1, parent);
    vec4 x = beside(level + 1, parent, dx, mine), y = beside(level + 1, parent, dy, mine);
    // The corner counts if a way round leads there; two surfaces may meet in one point.
    bool reached = is_smooth(level + 1, parent + dx) || is_smooth(level + 1, parent + dy);
    vec4 corner = x + (y - mine);
    if (reached && is_smooth(level + 1, parent + dx + dy))
        corner = value_of(level + 1, parent + dx + dy);
    return max(bilinear(mine, x, y, corner, vec2(0.25)), 0.0);
}
