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
#define GATHER_AT(at) vec3(at, gl_WorkGroupID.z)
#else
layout(binding = 0) uniform sampler2D depth_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 0, rgba16f) writeonly uniform image2D change;
layout(binding = 1, rg32f) writeonly uniform image2D range;
#define AT(at) at
#define GATHER_AT(at) at
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
    if (any(greaterThanEqual(at << level, image.xy)))
        b = nothing;
    imageStore(change, AT(place), round_up(vec4(max(b.most - b.least, 0.0), b.depth)));
#ifdef RANGE
    imageStore(range, AT(place), vec4(b.range, 0.0, 0.0));
#endif
}

shared block blocks[group * group];

// The square of the depth derivative at a texel with depth z, from the depths of the neighbours left,
// right, below and above. `inner`: 1 where those along x and y are there. `unit`: 0: relative to the
// largest.
float derivative2(float z, vec4 around, vec2 inner, float unit)
{
#ifdef SLOPE
    vec2 change_ = inner * (around.yw - z);
    float most = max(z, max(around.y, around.w));
#else
    // Over a plane reversed depth is linear on the screen, in perspective too.
    vec2 change_ = inner * (around.xz + around.yw - 2.0 * z);
    float most = max(z, max(max(around.x, around.y), max(around.z, around.w)));
#endif
    most = unit > 0.0 ? unit : most;
    return most > 0.0 ? dot(change_, change_) / max(most * most, 1e-37) : 0.0;
}

// Depths of 4 x 4 texels and one more all round; of normals those, and one more to the right and
// above, where they reach into other blocks.
float z[6][6];
vec3 n[5][5];

void fetch(ivec2 at)
{
    ivec2 last = image.xy - 1;
    vec2 texel = 1.0 / vec2(image.xy);
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 3; x++) {
            // Gathers the four texels about the corner: (0, 1), (1, 1), (1, 0), (0, 0).
            vec4 g = textureGather(depth_map, GATHER_AT((vec2(at) + vec2(2 * x, 2 * y)) * texel));
            z[2 * y + 1][2 * x] = g.x;
            z[2 * y + 1][2 * x + 1] = g.y;
            z[2 * y][2 * x + 1] = g.z;
            z[2 * y][2 * x] = g.w;
        }
    for (int y = 0; y < 5; y++)
        for (int x = 0; x < 5; x++)
            if (x < 4 || y < 4)
                n[y][x] = texelFetch(normal_map, AT(min(at + ivec2(x, y), last)), 0).xyz;
}

// 1 where the neighbours that a depth derivative takes are inside, of four texels from `at` on. Of an
// image two texels wide nothing tells but their difference; a texel beyond repeats the last.
vec4 inner_of(int at, int last)
{
    ivec4 i = at + ivec4(0, 1, 2, 3);
    if (last == 1)
        return vec4(lessThanEqual(i, ivec4(1)));
#ifdef SLOPE
    return vec4(lessThan(i, ivec4(last)));
#else
    return vec4(lessThan(i, ivec4(last))) * vec4(greaterThan(i, ivec4(0)));
#endif
}

// The 2 x 2 texels from (x0, y0) of what was fetched from `at` on. Those beyond the image repeat the
// normals of its rim.
block quad(ivec2 at, int x0, int y0, float unit)
{
    vec4 inner_x = inner_of(at.x, image.x - 1), inner_y = inner_of(at.y, image.y - 1);
    vec4 there_x = vec4(lessThan(at.x + ivec4(0, 1, 2, 3), ivec4(image.x)));
    vec4 there_y = vec4(lessThan(at.y + ivec4(0, 1, 2, 3), ivec4(image.y)));
    block b = nothing;
    for (int i = 0; i < 4; i++) {
        int x = x0 + (i & 1), y = y0 + (i >> 1);
        float here = z[y + 1][x + 1];
        vec4 around = vec4(z[y + 1][x], z[y + 1][x + 2], z[y][x + 1], z[y + 2][x + 1]);
        b.depth = max(b.depth,
                      derivative2(here, around, vec2(inner_x[x], inner_y[y]) * (there_x[x] * there_y[y]),
                                       unit));
#ifdef RANGE
        if (here > 0.0)
            b.range = vec2(min(b.range.x, here), max(b.range.y, here));
#endif
        b.least = min(b.least, min(n[y][x], min(n[y][x + 1], n[y + 1][x])));
        b.most = max(b.most, max(n[y][x], max(n[y][x + 1], n[y + 1][x])));
    }
    b.depth = sqrt(b.depth);
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
    ivec2 at0 = corner * 4;
    fetch(at0);
    for (int i = 0; i < 4; i++) {
        ivec2 at = corner * 2 + ivec2(i & 1, i >> 1);
        block q = quad(at0, 2 * (i & 1), 2 * (i >> 1), unit);
        store(1, at, q);
        b = join(b, q);
    }
    store(2, corner, b);
    int index = me.y * group + me.x;
    for (int level = 3; level <= image.w; level++) {
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
