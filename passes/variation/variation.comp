#version 450 core
// SPDX-License-Identifier: MIT
// How much depth and normals vary in blocks of 2^l x 2^l texels, levels up to 6, in one dispatch.
// In:  depth DEPTH32F, reversed Z; normal RGBA16F
// Out: flattened pyramid RGBA16F: xyz extent of the normal, w depth derivative, rounded up
//      RANGE: likewise RG32F: least and largest depth
// LIGHT: of each face of a reflective shadow map. SLOPE: the paper's depth derivative.
// Source: Nichols, Shopf, Wyman 2009, sec. 3.2.1; the largest depth derivative and extent of the
//         normal per block.
#include "passes/include/pass/scene_shared.h"
#ifndef LIGHT
#include "passes/include/pass/view_shared.h"
#endif
#include "passes/multires/pyramid.glsl"

const int group = 16; // invocations along a work group's edge; each takes 4 x 4 texels
layout(local_size_x = group, local_size_y = group) in;

#ifdef LIGHT
layout(binding = 0) uniform sampler2DArray depth_map;
layout(binding = 1) uniform sampler2DArray normal_map;
layout(binding = 0, rgba16f) writeonly uniform image2DArray change;
layout(binding = 1, rg32f) writeonly uniform image2DArray range;
layout(std430, binding = 0) readonly buffer face_buffer
{
    ag_gpu_face faces[];
};
#define AT(at) ivec3(at, gl_WorkGroupID.z)
#else
layout(binding = 0) uniform sampler2D depth_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 0, rgba16f) writeonly uniform image2D change;
layout(binding = 1, rg32f) writeonly uniform image2D range;
#define AT(at) at
#endif
layout(location = 0) uniform ivec4 image; // xy: size, texels; z: first level; w: last
layout(location = 1) uniform ivec2 base;  // size of the first level in the pyramid

struct block {
    vec3 least, most; // of the normal
    float depth;      // derivative
    vec2 range;
};

const block nothing = block(vec3(2.0), vec3(-2.0), 0.0, vec2(1.0, 0.0));

block join(block a, block b)
{
    return block(min(a.least, b.least), max(a.most, b.most), max(a.depth, b.depth),
                 vec2(min(a.range.x, b.range.x), max(a.range.y, b.range.y)));
}

// The next half float that is not below v.
vec4 round_up(vec4 v)
{
    return min(mix(vec4(0.0), v * (1.0 + 1.0 / 1024.0) + 6e-8, greaterThan(v, vec4(0.0))), 65504.0);
}

void store(int level, ivec2 at, block b)
{
    int k = level - image.z;
    if (k < 0 || level > image.w || any(greaterThanEqual(at, base >> k)))
        return;
    ivec2 place = pyramid_origin(base, k) + at;
    imageStore(change, AT(place), round_up(vec4(max(b.most - b.least, 0.0), b.depth)));
#ifdef RANGE
    imageStore(range, AT(place), vec4(b.range, 0.0, 0.0));
#endif
}

shared block blocks[group * group];

// How far depth z departs from the line between those beside it. Of an image two texels wide nothing
// tells but their difference; a texel beyond repeats the last.
float bend(vec2 beside, float z, bvec2 inside, int size)
{
    if (size == 2)
        return abs(beside.y - beside.x);
    return all(inside) ? abs(beside.x + beside.y - 2.0 * z) : 0.0;
}

// The depth derivative at a texel with depth z and the depths of its neighbours. `inside`: which of
// left, right, lower and upper neighbour there are. `unit`: 0: relative to the largest.
float derivative(float z, vec4 around, bvec4 inside, float unit)
{
#ifdef SLOPE
    vec2 step_ = vec2(inside.y ? abs(around.y - z) : 0.0, inside.w ? abs(around.w - z) : 0.0);
    float most = max(z, max(around.y, around.w));
#else
    // Over a plane reversed depth is linear on the screen, in perspective too.
    vec2 step_ = vec2(bend(around.xy, z, inside.xy, image.x), bend(around.zw, z, inside.zw, image.y));
    float most = max(z, max(max(around.x, around.y), max(around.z, around.w)));
#endif
    most = unit > 0.0 ? unit : most;
    return most > 0.0 ? length(step_ / most) : 0.0;
}

// The 2 x 2 texels from `at` on.
block quad(ivec2 at, float unit)
{
    float z[4][4];
    vec3 n[3][3];
    ivec2 last = image.xy - 1;
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 4; x++)
            if (!((x == 0 || x == 3) && (y == 0 || y == 3)))
                z[y][x] = texelFetch(depth_map, AT(clamp(at + ivec2(x, y) - 1, ivec2(0), last)), 0).x;
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 3; x++)
            if (x < 2 || y < 2)
                n[y][x] = texelFetch(normal_map, AT(min(at + ivec2(x, y), last)), 0).xyz;
    block b = nothing;
    for (int i = 0; i < 4; i++) {
        int x = i & 1, y = i >> 1;
        ivec2 texel = at + ivec2(x, y);
        if (any(greaterThan(texel, last)))
            continue;
        float here = z[y + 1][x + 1];
        vec4 around = vec4(z[y + 1][x], z[y + 1][x + 2], z[y][x + 1], z[y + 2][x + 1]);
        bvec4 inside = bvec4(texel.x > 0, texel.x < last.x, texel.y > 0, texel.y < last.y);
        b.depth = max(b.depth, derivative(here, around, inside, unit));
        if (here > 0.0)
            b.range = vec2(min(b.range.x, here), max(b.range.y, here));
        b.least = min(b.least, min(n[y][x], min(n[y][x + 1], n[y + 1][x])));
        b.most = max(b.most, max(n[y][x], max(n[y][x + 1], n[y + 1][x])));
    }
    return b;
}

void main()
{
    ivec2 me = ivec2(gl_LocalInvocationID.xy), corner = ivec2(gl_GlobalInvocationID.xy);
#ifdef LIGHT
    float unit = faces[gl_WorkGroupID.z].eye.w > 0.5 ? 1.0 : 0.0;
#else
    float unit = view.forward.w > 0.5 ? 1.0 : 0.0;
#endif
    block b = nothing;
    for (int i = 0; i < 4; i++) {
        ivec2 at = corner * 2 + ivec2(i & 1, i >> 1);
        block q = quad(at * 2, unit);
        store(1, at, q);
        b = join(b, q);
    }
    store(2, corner, b);
    int index = me.y * group + me.x;
    for (int level = 3; level <= 6; level++) {
        int step_ = 1 << (level - 3); // invocations from one block of the level below to the next
        blocks[index] = b;
        barrier();
        if (((me.x | me.y) & (2 * step_ - 1)) == 0) {
            b = join(join(b, blocks[index + step_]),
                     join(blocks[index + step_ * group], blocks[index + step_ * (group + 1)]));
            store(level, corner >> (level - 2), b);
        }
        barrier();
    }
}
