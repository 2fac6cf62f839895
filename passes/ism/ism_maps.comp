#version 450 core
// SPDX-License-Identifier: MIT
// Imperfect shadow maps: a work group splats a subset of the points into the map of one VPL, fills
// what they leave open, and writes it.
// In:  ag_ism_point[], ag_vpl[], count
// Out: maps R32F, a layer each: 1 / distance in scene units, 0: nothing; ag_ism_eye[]
//
// Source: Ritschel et al. 2008, sec. 4.2 and 4.3; pull-push after Marroquim, Kraus, Cavalcanti,
//         Efficient Point-Based Rendering Using Image Reconstruction, PBG 2007.
//         Departs from it: a splat is the point's disc in its triangle's plane, not a box of one
//         depth, and may miss all texels' middles; reciprocal distances, which are linear over a
//         plane, so that the mean of a plane's texels is that plane's; holes are closed inside
//         surfaces alone.
#include "passes/include/pass/ism_shared.h"
#include "passes/include/pass/view_shared.h"
#include "passes/include/pass/vpl_shared.h"
#include "passes/shading/paraboloid.glsl"

const int group = 256, team = 16;
const int max_size = 64;
const float pi = 3.14159265358979;
// A disc has the area that its point stands for, times this: a surface keeps its size, and what the
// discs leave open of it is what pull-push is for.
const float overlap = 1.0;
// Discs near the eye are cut to so many texels about their middle: 32768 / 256 points of 17 x 17 stay
// below the 65535 rounds that Mesa's software renderer gives all loops of an invocation.
const int reach = 8;
// Discs of more texels than `narrow` are put aside, as far as there is room.
const int narrow = 36;
const uint max_aside = 512u;
// A plane seen flatter than this (sine) has no width in the map; the eye's own is one.
const float flattest = 0.01;
const int levels = 3; // of the pyramid: the widest hole is 8 texels
// Reciprocal distances are one surface's within this ratio; a lower one lies behind it.
const float same_surface = 0.85;

layout(local_size_x = group) in;

layout(std430, binding = 0) readonly buffer point_buffer
{
    ag_ism_point points[];
};
layout(std430, binding = 1) readonly buffer vpl_buffer
{
    ag_vpl vpls[];
};
layout(std430, binding = 2) readonly buffer count_buffer
{
    uvec4 count;
};
layout(std430, binding = 3) writeonly buffer eye_buffer
{
    ag_ism_eye eyes[];
};
layout(location = 0) uniform ivec4 layout_; // x: size; y: maps; z: points of one map; w: subsets
layout(binding = 0, r32f) writeonly uniform image2DArray maps;

// The map and its pyramid: bits of reciprocal distances, which order as the numbers do.
shared uint depths[max_size * max_size * 4 / 3 + 1];
shared uint widest; // bits of the largest disc's radius
shared uint aside_count;
shared int aside[max_aside];

ag_ism_eye make_eye(int map)
{
    int total = int(count.x);
    int first = ism_first_of(map, total, layout_.y), past = ism_first_of(map + 1, total, layout_.y);
    ag_vpl v = vpls[(first + past) / 2];
    vec3 t, b;
    vpl_frame(v.normal.xyz, t, b);
    return ag_ism_eye(vec4(v.position_area.xyz * view.scale.x, 0.0), vec4(t, 0.0), vec4(b, 0.0),
                      vec4(v.normal.xyz, 0.0));
}

// A point's disc as the eye sees it, and the texels that it may cover.
struct disc {
    vec3 middle, normal;
    float radius;
    ivec2 low, extent; // extent 0: there is nothing to see
};

disc see(int i, ag_ism_eye eye, float to_radius)
{
    vec4 at = points[i].position_area;
    vec3 n = points[i].normal.xyz, d = at.xyz - eye.position.xyz;
    vec3 p = vec3(dot(d, eye.tangent.xyz), dot(d, eye.bitangent.xyz), dot(d, eye.normal.xyz));
    disc s = disc(p, vec3(dot(n, eye.tangent.xyz), dot(n, eye.bitangent.xyz), dot(n, eye.normal.xyz)),
                  to_radius * sqrt(max(at.w, 0.0)), ivec2(0), ivec2(0));
    float r = length(p);
    if (at.w <= 0.0 || p.z <= 0.0 || abs(dot(s.normal, p)) < flattest * r)
        return s;
    float size = float(layout_.x);
    vec2 middle = paraboloid_texel(p, r, size);
    float wide = min(0.5 * size * s.radius / (r + p.z) * (1.0 + s.radius / r), float(reach));
    s.low = max(ivec2(floor(middle - wide)), ivec2(0));
    s.extent = max(min(ivec2(floor(middle + wide)), layout_.x - 1) - s.low + 1, ivec2(0));
    return s;
}

void put(disc s, ivec2 texel)
{
    vec3 ray = paraboloid_ray(texel, float(layout_.x));
    float w = dot(s.normal, ray) / dot(s.normal, s.middle); // 1 / distance of the plane
    vec3 off = ray - s.middle * w;                          // from the disc's middle, times w
    if (w <= 0.0 || dot(off, off) > s.radius * s.radius * w * w)
        return;
    uint bits = floatBitsToUint(min(w, 1e12));
    if (bits > depths[texel.y * layout_.x + texel.x])
        atomicMax(depths[texel.y * layout_.x + texel.x], bits);
}

// Wide discs are few and long, and what runs beside them would wait: they are put aside, and a team of
// the group does one after the other.
void splat_all(int map, ag_ism_eye eye)
{
    int me = int(gl_LocalInvocationIndex), first = (map + map / layout_.w) % layout_.w * layout_.z;
    float to_radius = sqrt(overlap / pi * float(layout_.w)), most = 0.0;
    for (int i = first + me; i < first + layout_.z; i += group) {
        disc s = see(i, eye, to_radius);
        most = max(most, s.radius);
        if (s.extent.x * s.extent.y > narrow) {
            uint slot = atomicAdd(aside_count, 1u);
            if (slot < max_aside) {
                aside[slot] = i;
                continue;
            }
        }
        for (ivec2 at = ivec2(0); at.y < s.extent.y && s.extent.x > 0;
             at = at.x + 1 < s.extent.x ? at + ivec2(1, 0) : ivec2(0, at.y + 1))
            put(s, s.low + at);
    }
    atomicMax(widest, floatBitsToUint(most));
    barrier();
    for (uint k = uint(me / team); k < min(aside_count, max_aside); k += group / team) {
        disc s = see(aside[k], eye, to_radius);
        for (int i = me % team; i < s.extent.x * s.extent.y; i += team)
            put(s, s.low + ivec2(i % s.extent.x, i / s.extent.x));
    }
}

// Sizes are powers of two; a division is slow where there is none for vectors.
ivec2 texel_of(int i, int size)
{
    return ivec2(i & (size - 1), i >> findMSB(size));
}

float depth_at(int base, int size, ivec2 at)
{
    return uintBitsToFloat(depths[base + at.y * size + at.x]);
}

// A coarser texel is the mean of those below that are on the nearest surface among them. One alone
// is none: a lonely point grows no further.
void pull(int from, int to, int size)
{
    for (int i = int(gl_LocalInvocationIndex); i < size * size / 4; i += group) {
        ivec2 at = 2 * texel_of(i, size / 2);
        vec4 w = vec4(depth_at(from, size, at), depth_at(from, size, at + ivec2(1, 0)),
                      depth_at(from, size, at + ivec2(0, 1)), depth_at(from, size, at + ivec2(1)));
        float nearest = max(max(max(w.x, w.y), max(w.z, w.w)), 1e-30);
        vec4 same = vec4(greaterThanEqual(w, vec4(same_surface * nearest)));
        float n = dot(same, vec4(1.0));
        depths[to + i] = n < 2.0 ? 0u : floatBitsToUint(dot(w, same) / n);
    }
}

// A texel that is empty, or shows what is behind the surface that the four coarser texels about it
// all have, is a hole in that surface and closed. At its rim one of the four has it not, so that no
// silhouette grows.
void push(int from, int to, int size)
{
    int coarse = size / 2;
    for (int i = int(gl_LocalInvocationIndex); i < size * size; i += group) {
        ivec2 at = texel_of(i, size), own = at / 2;
        ivec2 side = clamp(own + 2 * (at & 1) - 1, ivec2(0), ivec2(coarse - 1));
        vec4 w = vec4(depth_at(from, coarse, own), depth_at(from, coarse, ivec2(side.x, own.y)),
                      depth_at(from, coarse, ivec2(own.x, side.y)), depth_at(from, coarse, side));
        float middle = dot(w, vec4(9.0, 3.0, 3.0, 1.0)) / 16.0;
        bool one_surface = w.x > 0.0 && all(greaterThanEqual(w, same_surface * w.xxxx)) &&
                           all(lessThanEqual(same_surface * w, w.xxxx));
        if (one_surface && uintBitsToFloat(depths[to + i]) < same_surface * middle)
            depths[to + i] = floatBitsToUint(middle);
    }
}

void fill_holes()
{
    int base = 0, size = layout_.x;
    for (int l = 0; l < levels; l++) {
        pull(base, base + size * size, size);
        base += size * size;
        size /= 2;
        barrier();
    }
    for (int l = 0; l < levels; l++) {
        size *= 2;
        push(base, base - size * size, size);
        base -= size * size;
        barrier();
    }
}

void main()
{
    int map = int(gl_WorkGroupID.x), size = layout_.x, me = int(gl_LocalInvocationIndex);
    bool used = map < min(int(count.x), layout_.y); // the same for the whole group
    for (int i = me; i < size * size; i += group)
        depths[i] = 0u;
    if (me == 0)
        widest = aside_count = 0u;
    barrier();
    ag_ism_eye eye = ag_ism_eye(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    if (used) {
        eye = make_eye(map);
        splat_all(map, eye);
    }
    barrier();
    if (used)
        fill_holes();
    eye.position.w = uintBitsToFloat(widest);
    if (me == 0)
        eyes[map] = eye;
    for (int i = me; i < size * size; i += group)
        imageStore(maps, ivec3(texel_of(i, size), map), vec4(uintBitsToFloat(depths[i])));
}
