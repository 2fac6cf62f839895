#version 450 core
// SPDX-License-Identifier: MIT
// The multiresolution buffer to look at.
// In:  flags, tiles
// Out: RGBA16F, display values. LEVELS: of the frame's size, the level that covers each pixel, blue the
//      finest, red the coarsest; valid texels' lit pixels of shared blocks white, the others black.
//      Else of the pyramid's size: white where a texel is valid and shows a surface.
#include "passes/multires/texel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = 0) readonly buffer flag_buffer
{
    uint flags[];
};
layout(std430, binding = 1) readonly buffer tile_buffer
{
    uvec4 tiles[];
};
layout(binding = 0, rgba16f) writeonly uniform image2D result;
layout(location = 0) uniform ivec4 pyramid; // xy: size of level 0; z: levels; w: tiles along a row
layout(location = 1) uniform ivec4 image;   // xy: size of the result; z: rows of tiles; w: share

bool is_valid(int level, ivec2 at)
{
    ivec2 tile = (at << level) >> 3;
    return tile.x < pyramid.w && tile.y < image.z &&
           multires_valid_in_tile(tiles[tile.y * pyramid.w + tile.x], level, at);
}

vec3 false_color(float t)
{
    return clamp(vec3(1.5 - abs(4.0 * t - 3.0), 1.5 - abs(4.0 * t - 2.0), 1.5 - abs(4.0 * t - 1.0)), 0.0,
                 1.0);
}

vec3 level_color(ivec2 pixel)
{
    int level = pyramid.z - 1;
    while (level > image.w &&
           (flags[multires_flag_index(level, pixel >> level, pyramid.xy)] & multires_refined) != 0u)
        level--;
    bool shared_ = level == image.w && level > 0 &&
                   (flags[multires_flag_index(level, pixel >> level, pyramid.xy)] & multires_mixed) != 0u;
    if (shared_)
        return vec3(is_valid(0, pixel) ? 1.0 : 0.0);
    if (!is_valid(level, pixel >> level))
        return vec3(0.0); // shows nothing
    return false_color(float(level) / float(max(pyramid.z - 1, 1)));
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, image.xy)))
        return;
#ifdef LEVELS
    vec3 color = level_color(at);
#else
    multires_texel t = multires_at_place(at, pyramid.xy);
    bool inside = t.level < pyramid.z && all(lessThan(t.at, pyramid.xy >> t.level));
    vec3 color = vec3(inside && is_valid(t.level, t.at) ? 1.0 : 0.0);
#endif
    imageStore(result, at, vec4(color, 1.0));
}
