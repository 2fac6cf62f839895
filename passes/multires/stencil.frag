#version 450 core
// SPDX-License-Identifier: MIT
// Leaves the texels of a multiresolution buffer that are valid and show a surface.
// In:  uvec4[] of tiles
// Out: nothing; the stencil operation marks what is not discarded
// Source: Nichols, Shopf, Wyman 2009, sec. 3.2.1, SetStencil(f).
#include "passes/multires/texel.glsl"

layout(std430, binding = 0) readonly buffer tile_buffer
{
    uvec4 tiles[];
};
layout(location = 0) uniform ivec4 pyramid; // xy: size of level 0; z: levels; w: tiles along a row
layout(location = 1) uniform int rows;      // of tiles

void main()
{
    ivec2 place = ivec2(gl_FragCoord.xy);
    multires_texel t = multires_at_place(place, pyramid.xy);
    if (t.level >= pyramid.z || any(greaterThanEqual(t.at, pyramid.xy >> t.level)))
        discard;
    ivec2 corner = t.at << t.level, tile = corner >> 3;
    if (tile.x >= pyramid.w || tile.y >= rows ||
        !multires_valid_in_tile(tiles[tile.y * pyramid.w + tile.x], t.level, t.at))
        discard;
}
