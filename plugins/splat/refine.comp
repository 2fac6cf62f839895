#version 450 core
// SPDX-License-Identifier: MIT
// One round of refinement: looks at the children of the patches that the round before replaced. Those
// with a discontinuity go on to the next round, of the others those that show a surface are done.
// In:  flags; refined patches of the level above; position RGBA32F, normal RGBA16F
//      SHARE: tiles, of what is valid in blocks that hold an edge
// Out: refined patches of this level; receivers of those that are done, see splat.vert
// Source: Nichols, Wyman. Multiresolution Splatting for Indirect Illumination. I3D 2009, as in
//         Nichols, Shopf, Wyman 2009, sec. 3.2.1.
//         Departs from it: compute instead of a geometry shader; patches that are done are not
//         looked at again in every round.
#include "passes/include/pass/view_shared.h"

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
#include "passes/multires/receiver.glsl"
#include "plugins/splat/receiver_row.glsl"

const int group = 128;
layout(local_size_x = group) in;

layout(std430, binding = 0) readonly buffer flag_buffer
{
    uint flags[];
};
layout(std430, binding = 1) buffer queue_buffer
{
    uint queue[]; // refined patches, levels apart as the flags are
};
layout(std430, binding = 2) readonly buffer parent_buffer
{
    uvec4 parents; // xyz: dispatch; w: how many
};
layout(std430, binding = 3) buffer refined_buffer
{
    uvec4 refined; // likewise, of this level
};
layout(std430, binding = 4) buffer patch_buffer
{
    uint patches; // that are done
};
#ifdef SHARE
layout(std430, binding = 5) readonly buffer tile_buffer
{
    uvec4 tiles[];
};
#endif
layout(binding = 0, rgba32f) writeonly uniform image2D receiver_positions;
layout(binding = 1, rgba32f) writeonly uniform image2D receiver_normals;

layout(location = 0) uniform ivec4 round_; // x: level looked at; y: log2 of children along an edge;
                                           // z: parents, -1: as counted; w: 1: the first round
layout(location = 1) uniform ivec4 shape;  // xy: size of level 0 in the pyramid; zw: of the pyramid

struct family {
    multires_texel first; // of the children
    int along;            // log2 of how many along an edge
    uvec2 done;           // a bit a child, by rows
    uint refined;         // likewise; of four at most
};

multires_texel child(family f, int i)
{
    return multires_texel(f.first.level,
                          f.first.at + ivec2(i & ((1 << f.along) - 1), i >> f.along));
}

bool shows_surface(multires_texel t)
{
    ivec2 pixel = (t.at << t.level) + (t.level > 0 ? (1 << (t.level - 1)) - 1 : 0);
    return all(lessThan(pixel, view.size.xy)) && texelFetch(normal_map, pixel, 0).w > 0.0;
}

bool is_refined(multires_texel t)
{
    return t.level > 0 &&
           (flags[multires_flag_index(t.level, t.at, shape.xy)] & multires_refined) != 0u;
}

bool is_patch(multires_texel t)
{
#ifdef SHARE
    ivec2 tile = t.at >> 3;
    int columns = (view.size.x + 7) >> 3;
    return all(lessThan(t.at, view.size.xy)) &&
           multires_valid_in_tile(tiles[tile.y * columns + tile.x], 0, t.at);
#else
    return shows_surface(t);
#endif
}

family find_family(uint index)
{
    int level = round_.x, columns = shape.x >> level;
    family f = family(multires_texel(level, ivec2(int(index) % columns, int(index) / columns)),
                      round_.y, uvec2(0u), 0u);
    uint count = round_.z < 0 ? parents.w : uint(round_.z);
    if (index >= count)
        return f;
    if (round_.w == 0) {
        int above = level + round_.y;
        multires_texel parent =
            multires_unpack(queue[multires_flag_index(above, ivec2(0), shape.xy) + int(index)]);
        f.first.at = parent.at << round_.y;
    }
    for (int i = 0; i < 1 << (2 * f.along); i++) {
        multires_texel t = child(f, i);
        if (is_refined(t))
            f.refined |= 1u << i;
        else if (is_patch(t))
            f.done[i >> 5] |= 1u << (i & 31);
    }
    return f;
}

void store_receiver(multires_texel t, uint row)
{
    vec3 p, n;
    multires_receiver(t, p, n);
    vec2 place = vec2(multires_place(t, shape.xy)) + 0.5;
    vec2 clip = place * 2.0 / vec2(shape.zw) - 1.0;
    imageStore(receiver_positions, receiver_row(row), vec4(p * view.scale.x, clip.x));
    float along = length(n);
    n = along > 1e-6 ? n / along : vec3(0.0); // and where it is not a number
    imageStore(receiver_normals, receiver_row(row), vec4(n, clip.y));
}

shared uint found_done, found_refined, first_done, first_refined;

void main()
{
    uint me = gl_LocalInvocationIndex;
    uint work_group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (me == 0) {
        found_done = 0;
        found_refined = 0;
    }
    barrier();
    family f = find_family(work_group * group + me);
    uint done = bitCount(f.done.x) + bitCount(f.done.y);
    uint row = atomicAdd(found_done, done);
    uint place = atomicAdd(found_refined, bitCount(f.refined));
    barrier();
    if (me == 0) {
        first_done = atomicAdd(patches, found_done);
        first_refined = atomicAdd(refined.w, found_refined);
        atomicMax(refined.x, (first_refined + found_refined + group - 1) / group);
        atomicMax(refined.y, 1u);
        atomicMax(refined.z, 1u);
    }
    barrier();
    row += first_done;
    place += first_refined + multires_flag_index(round_.x, ivec2(0), shape.xy);
    for (int i = 0; i < 1 << (2 * f.along); i++) {
        multires_texel t = child(f, i);
        if ((f.done[i >> 5] >> (i & 31) & 1u) != 0u)
            store_receiver(t, row++);
        else if ((f.refined >> (i & 31) & 1u) != 0u && i < 32)
            queue[place++] = multires_pack(t.level, t.at);
    }
}
