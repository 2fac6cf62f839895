#version 450 core
// SPDX-License-Identifier: MIT
// Brings a multiresolution image to the pixels of cells that have no edge near: bilinear.
// In:  a word a block, see cells.glsl; pyramid RGBA32F with values at the smooth texels of level SHARE
// Out: RGBA32F of the frame's size, a 1
// Source: Nichols, Wyman 2009, sec. 4.4.
#include "passes/include/pass/view_shared.h"
#include "passes/multires/cells.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 2) uniform sampler2D pyramid;
layout(std430, binding = 1) readonly buffer block_buffer
{
    uint blocks[];
};
layout(binding = 1, rgba32f) writeonly uniform image2D result;
layout(location = 0) uniform ivec4 level; // of SHARE: xy: size; zw: where it stands in the pyramid

vec3 value_of(ivec2 block)
{
    return texelFetch(pyramid, level.zw + block, 0).rgb;
}

// As interpolate.glsl has it.
vec3 beside(uint word, ivec2 block, ivec2 side, vec3 mine)
{
    bool there = neighbour_is_smooth(word, side), behind = neighbour_is_smooth(word, -side);
    vec3 other = value_of(clamp(there ? block + side : block - side, ivec2(0), level.xy - 1));
    return there ? other : behind ? max(2.0 * mine - other, 0.0) : mine;
}

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy), block = cell >> 1, corner = cell * (edge / 2);
    if (any(greaterThanEqual(corner, view.size.xy)))
        return;
    uint word = blocks[block.y * level.x + block.x];
    if (edge_is_near(word, cell))
        return;
    ivec2 side = side_of(cell), dx = ivec2(side.x, 0), dy = ivec2(0, side.y);
    vec3 mine = value_of(block);
    vec3 x = beside(word, block, dx, mine), y = beside(word, block, dy, mine);
    vec3 across = x + (y - mine);
    if (neighbour_is_smooth(word, side))
        across = value_of(block + side);
    // Over edge / 2 pixels from the middle of the block on, or up to it.
    vec2 f = mix(vec2(0.5 * float(edge) - 0.5), vec2(0.5), greaterThan(side, ivec2(0))) / float(edge);
    vec2 step_ = vec2(side) / float(edge);
    for (int v = 0; v < edge / 2; v++) {
        float fy = f.y + float(v) * step_.y;
        vec3 near = mine + (y - mine) * fy, far = x + (across - x) * fy;
        for (int u = 0; u < edge / 2; u++) {
            vec3 value = near + (far - near) * (f.x + float(u) * step_.x);
            imageStore(result, corner + ivec2(u, v), vec4(max(value, vec3(0.0)), 1.0));
        }
    }
}
