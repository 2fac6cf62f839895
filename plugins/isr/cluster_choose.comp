#version 450 core
// SPDX-License-Identifier: MIT
// Finds the patch that each block belongs to, and has its first blocks make the patch's VPLs, by
// index face, row, column of the finest blocks.
// In:  parts of each block, those there are first; flux of each work group; variation pyramid RGBA16F; faces; table
// Out: ag_vpl[], area 0 where a block makes none; valid VPLs of each 256, 0 before
// Source: Nichols, Shopf, Wyman 2009, sec. 3.4, fig. 7.
#include "passes/include/pass/scene_shared.h"
#include "passes/include/pass/vpl_shared.h"
#include "passes/multires/pyramid.glsl"
#include "passes/vpl/patch.glsl"
#include "plugins/isr/cluster.glsl"

layout(local_size_x = region, local_size_y = region) in;

layout(binding = 0) uniform sampler2DArray change_map;
layout(std430, binding = 0) readonly buffer part_buffer
{
    part parts[];
};
layout(std430, binding = 1) readonly buffer sum_buffer
{
    float sums[];
};
layout(std430, binding = 2) readonly buffer face_buffer
{
    ag_gpu_face faces[];
};
layout(std430, binding = 4) writeonly buffer vpl_buffer
{
    ag_vpl vpls[];
};
layout(std430, binding = 5) buffer group_buffer
{
    uint valid_in_group[];
};
layout(location = 0) uniform ivec4 pyramid; // xy: size of its finest level; z: which that is; w: last
layout(location = 1) uniform vec3 limits;   // x: depth; y: normal; z: share of flux

const int all_here = region * region;
const int most_levels = 3;

shared vec2 node_flux[most_levels + 1][all_here]; // of level l: the first all_here >> 2 l
shared part shared_parts[all_here * most_parts];

// Flux of the patches of all levels in this region. Returns that of all regions.
float sum_nodes(float flux)
{
    ivec2 me = ivec2(gl_LocalInvocationID.xy);
    float others = 0.0;
    for (int i = me.y * region + me.x; i < header.y; i += all_here)
        others += sums[i];
    node_flux[0][me.y * region + me.x] = vec2(flux, others);
    for (int level = 1; level <= most_levels; level++) {
        int across = region >> level;
        barrier();
        if (all(lessThan(me, ivec2(across)))) {
            int from = 4 * me.y * across + 2 * me.x;
            node_flux[level][me.y * across + me.x] =
                node_flux[level - 1][from] + node_flux[level - 1][from + 1] +
                node_flux[level - 1][from + 2 * across] + node_flux[level - 1][from + 2 * across + 1];
        }
    }
    barrier();
    return node_flux[most_levels][0].y;
}

// Whether a patch of 2^level x 2^level texels holds a discontinuity. Beyond the pyramid: perhaps.
bool is_mixed(ivec2 texel, int level, int face)
{
    int k = level - pyramid.z;
    if (level > pyramid.w)
        return true;
    ivec2 at = pyramid_origin(pyramid.xy, k) + (texel >> level);
    vec4 change = texelFetch(change_map, ivec3(at, face), 0);
    return change.w > limits.x || max(change.x, max(change.y, change.z)) > limits.y;
}

// The level of the patch that this block belongs to, 0 the finest; and whether it is mixed.
int patch_level(ivec4 row, ivec2 at, float whole, out bool mixed)
{
    int edge = header.z / row.w, finest = findMSB(edge);
    ivec2 me = ivec2(gl_LocalInvocationID.xy);
    for (int level = header.w; level > 0; level--) {
        ivec2 node = me >> level;
        mixed = is_mixed(at * edge, finest + level, row.x);
        if (!mixed || node_flux[level][node.y * (region >> level) + node.x].x < limits.z * whole)
            return level;
    }
    mixed = true;
    return 0;
}

// Brings the parts of the four patches at `here` and `step_` blocks on together. A block's parts
// that are there come first.
void merge_four(int here, int step_, bool one)
{
    part p[most_parts] = part[](no_part, no_part, no_part);
    bool more = true;
    for (int k = 0; more && k < most_parts; k++) {
        more = false;
        for (int child = 0; child < 4; child++) {
            int from = here + step_ * ((child & 1) + (child >> 1) * region);
            if (shared_parts[from * most_parts + k].position_weight.w > 0.0) {
                add_part(p, shared_parts[from * most_parts + k], one);
                more = true;
            }
        }
    }
    for (int k = 0; k < most_parts; k++)
        shared_parts[here * most_parts + k] = p[k];
}

shared int patch_of[all_here]; // level; + 4: mixed

// Brings the parts of each patch together in its first block.
void merge_parts()
{
    int me = int(gl_LocalInvocationIndex);
    for (int l = 1; l <= most_levels; l++) {
        barrier();
        int across = region >> l;
        int here = (me / across * region + me % across) << l;
        if (me < across * across && (patch_of[here] & 3) >= l)
            merge_four(here, 1 << (l - 1), patch_of[here] < 4);
    }
    barrier();
}

// Edges of the parallelogram that is spread as a part's texels are: those of a uniform one with edges
// e and f are by (e e^T + f f^T) / 12, which a Cholesky factor fulfils. A texel alone is spread by 1 / 12.
mat2 shape_of(part p)
{
    vec3 s = 12.0 * p.place_spread.yzw + vec3(1.0, 0.0, 1.0);
    float a = sqrt(max(s.x, 1.0)), b = s.y / a;
    return mat2(a, b, 0.0, sqrt(max(s.z - b * b, 0.1)));
}

ag_vpl make_vpl(part p, int face)
{
    vec3 n = p.normal_place.xyz / max(length(p.normal_place.xyz), 1e-6), q = p.position_weight.xyz;
    ag_vpl v = ag_vpl(vec4(q, p.flux_area.w), vec4(n, 0.0), vec4(p.flux_area.rgb, 0.0));
    pack_parallelogram(faces[face], q, n, shape_of(p), v);
    return v;
}

void main()
{
    ivec4 row = row_of(int(gl_WorkGroupID.x));
    ivec2 me = ivec2(gl_LocalInvocationID.xy), at = block_here(row);
    bool inside = all(lessThan(at, ivec2(row.w))), mixed;
    int index = row.y + at.y * row.w + at.x, here = me.y * region + me.x;
    float flux = 0.0;
    for (int k = 0; k < most_parts; k++)
        shared_parts[here * most_parts + k].position_weight.w = 0.0;
    for (int k = 0; inside && k < most_parts; k++) {
        if (!(parts[index * most_parts + k].position_weight.w > 0.0))
            break;
        part p = parts[index * most_parts + k];
        flux += p.flux_area.r + p.flux_area.g + p.flux_area.b;
        shared_parts[here * most_parts + k] = p;
    }
    float whole = sum_nodes(flux);
    int level = patch_level(row, min(at, row.w - 1), whole, mixed);
    patch_of[here] = level + (mixed ? 4 : 0);
    merge_parts();

    // A block that is not its patch's first makes none.
    int made = 0, slot = index * most_parts;
    for (; ((me >> level) << level) == me && inside && made < most_parts; made++) {
        part p = shared_parts[here * most_parts + made];
        if (!(p.position_weight.w > 0.0))
            break;
        vpls[slot + made] = make_vpl(p, row.x);
        atomicAdd(valid_in_group[(slot + made) / 256], 1u);
    }
    for (; inside && made < most_parts; made++)
        vpls[slot + made].position_area.w = 0.0;
}
