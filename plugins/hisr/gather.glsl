// SPDX-License-Identifier: MIT
// The gather of hisr, for gather.comp and gather.frag.
//
// BLOCK: receivers of one invocation, consecutive in the list; 1, 4, 16. They share the way through
// the tree and its loads; each adds the nodes of its own cut, so that nothing depends on BLOCK.
// CLAMP: 0 none, 1 disc, 2 constant, 3 footprint: as in passes/gather/gather.glsl.
// BOUND: 0 patch, 1 paper. CUT: how many nodes each receiver took instead of their light.
// VISIBILITY: each node's light is shadowed by the imperfect shadow map of its ancestor at eye_level.
// FRAGMENT: the receiver is the fragment's texel.
//
// Source: Nichols, Shopf, Wyman 2009, sec. 3.5.1.
//         Departs from it: see needs_refinement(). Without recursion or stack, for the order of the
//         nodes says where to go on.
#include "passes/include/pass/view_shared.h"
#include "plugins/hisr/hisr_shared.h"
#include "plugins/hisr/extent.glsl"

#ifndef BLOCK
#define BLOCK 4
#endif
#ifndef CLAMP
#define CLAMP 3
#endif
#ifndef BOUND
#define BOUND 0
#endif

#include "passes/gather/near.glsl"
#ifdef VISIBILITY
#include "passes/ism/visibility.glsl"
#endif

const float pi = 3.14159265358979;

#ifdef FRAGMENT
layout(early_fragment_tests) in;
#else
layout(local_size_x = 64) in;
#endif

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
#include "passes/multires/receiver.glsl"

layout(std430, binding = 0) readonly buffer node_buffer
{
    hisr_node nodes[];
};
layout(std430, binding = 1) readonly buffer total_buffer
{
    hisr_total total;
};
// Of each receiver: the next node << 4 | its level (see main()); all bits: done.
layout(std430, binding = 5) buffer progress_buffer
{
    uint progress[];
};
layout(std430, binding = 6) buffer visited_buffer
{
    uvec4 visited; // xy: nodes that receivers took, low and high word; z: receivers
};
layout(location = 0) uniform ivec4 walk; // x: roots; y: finest level; z: nodes of this dispatch at
                                         // most; w: 1: goes on where the one before stopped
layout(location = 1) uniform float tau;
#if CLAMP == 2
layout(location = 2) uniform float clamp_d2; // m^2
#endif
layout(location = 3) uniform ivec2 base; // of the pyramid
#ifdef VISIBILITY
layout(location = 4) uniform ivec2 eyes; // x: level that has imperfect shadow maps; y: its nodes

// The map of node i of a level.
int map_of(int level, int i)
{
    int over = 2 * (level - eyes.x);
    return ism_map_of(over >= 0 ? i >> over : i << -over, eyes.y);
}
#endif
layout(binding = 0, rgba32f) uniform image2D illumination;

const uint done = 0xffffffffu;
const int no_level = 15;

#ifdef FRAGMENT
// There is one; its number is its place.
int first_receiver()
{
    return int(gl_FragCoord.y) * imageSize(illumination).x + int(gl_FragCoord.x);
}

int receivers_from(int first)
{
    return 1;
}

multires_texel texel_of(int index)
{
    return multires_at_place(ivec2(gl_FragCoord.xy), base);
}
#else
layout(std430, binding = 2) readonly buffer texel_buffer
{
    uint texels[];
};
layout(std430, binding = 3) readonly buffer count_buffer
{
    uvec4 count;
};

int first_receiver()
{
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return int(group * gl_WorkGroupSize.x + gl_LocalInvocationIndex) * BLOCK;
}

int receivers_from(int first)
{
    return min(int(count.x) - first, BLOCK);
}

multires_texel texel_of(int index)
{
    return multires_unpack(texels[min(index, int(count.x) - 1)]);
}
#endif

void fetch(int index, float unit, out ivec2 place, out vec3 p, out vec3 n)
{
    multires_texel t = texel_of(index);
    place = multires_place(t, base);
    multires_receiver(t, p, n);
    p *= unit;
    n /= max(length(n), 1e-6);
}

// Whether a node errs by more than `limit`. `cos_i`, `cos_j`: times |d|, of either sign; `flux`: of
// the strongest channel; lengths as the receivers have them.
bool needs_refinement(node_extent node, float flux, float area, float d2, float cos_i, float cos_j,
                      float limit)
{
#if BOUND == 1
    // Eq. 7: its whole contribution, cosines at 1, of the node's own flux. d is to the nearest
    // point of a disc as large as the patch were it as far from the light as its farthest texel.
    float d = max(sqrt(d2) - sqrt(node.reach / pi), 0.0);
    return flux > limit * (pi * d * d + area);
#else
    // What it contributes at most, by how much that may vary over the patch.
    float inv = inversesqrt(max(d2, 1e-30));
    float ci = clamp((cos_i + node.radius) * inv, 0.0, 1.0);
    float cj = clamp((cos_j + node.depth) * inv + node.cone, 0.0, 1.0);
    float varies = min(2.0 * node.size * inv + node.bend, 1.0);
    return flux * ci * cj * varies > limit * (pi * d2 + area);
#endif
}

#if CLAMP == 3 && !defined(CUT)
// Nodes that some of the receivers are near to wait here for add_near(). It stands outside of the loop
// over the nodes: a driver without branches, as Mesa's software renderer, goes once through all that
// stands within, for every node.
const int near_room = 128;
uint near_nodes[near_room], near_masks[near_room]; // the node; its receivers, bit by bit
#ifdef VISIBILITY
int near_maps[near_room];
#endif
int near_count = 0;

void keep_near(int n, uint mask, int map)
{
    near_nodes[near_count] = uint(n);
    near_masks[near_count] = mask;
#ifdef VISIBILITY
    near_maps[near_count] = map;
#endif
    near_count++;
}

// Adds what waits, a node for one receiver a round.
void add_near(int first, float unit)
{
    uint mask = 0u;
    for (int k = 0; mask != 0u || k < near_count; mask &= mask - 1u) {
        if (mask == 0u)
            mask = near_masks[k++];
        ag_vpl vpl = nodes[near_nodes[k - 1]].vpl;
        ivec2 place;
        vec3 p, normal;
        fetch(first + findLSB(mask), unit, place, p, normal);
        float area = vpl.position_area.w * unit * unit;
        vec3 d = vpl.position_area.xyz * unit - p;
        float cos_j = max(-dot(vpl.normal.xyz, d), 0.0); // times |d|
        float share = patch_share(d, normal, vpl, area, cos_j, texel_lift);
#ifdef VISIBILITY
        share *= ism_visibility(near_maps[k - 1], p, normal);
#endif
        vec4 old = imageLoad(illumination, place);
        imageStore(illumination, place, old + vec4(vpl.flux.rgb * share, 0.0));
    }
    near_count = 0;
}
#else
const int near_room = 1, near_count = 0;
#endif

int level_of(int n)
{
    int level = 0;
    for (int l = 1; l <= 6; l++)
        level += n >= HISR_LEVEL_START(walk.x, l) ? 1 : 0;
    return min(level, walk.y);
}

void count_visits(uint taken, int receivers)
{
    if (walk.w == 0)
        atomicAdd(visited.z, uint(receivers));
    uint before = atomicAdd(visited.x, taken);
    if (before + taken < before)
        atomicAdd(visited.y, 1u);
}

#ifdef CUT
// From blue by green to red over t = 0 .. 1.
vec3 false_colour(float t)
{
    return clamp(vec3(4.0 * t - 2.0, 2.0 - abs(4.0 * t - 2.0), 2.0 - 4.0 * t), 0.0, 1.0);
}
#endif

void main()
{
    int first = first_receiver(), receivers = receivers_from(first);
    if (receivers <= 0 || (walk.w != 0 && progress[first] == done))
        return;
    // Lengths in units of about the scene, as in passes/gather/gather.comp.
    float unit = view.scale.x;
    vec3 p[BLOCK], n[BLOCK], sum[BLOCK], part[BLOCK];
    // A receiver that took a node on level l does not look at what is below it. It looks again at
    // levels up to taken_at.
    int taken_at[BLOCK];
    int node_index = walk.w != 0 ? int(progress[first] >> 4) : 0;
    for (int r = 0; r < BLOCK; r++) {
        ivec2 place;
        fetch(first + r, unit, place, p[r], n[r]);
        sum[r] = part[r] = vec3(0.0);
        taken_at[r] = r >= receivers ? -1 : walk.w != 0 ? int(progress[first + r] & 15u) : no_level;
    }
    // tau is a share of the irradiance that all of the light at once makes where it lands.
    float reference = max(total.flux_area.r, max(total.flux_area.g, total.flux_area.b)) /
                      max(total.flux_area.a, 1e-30);
    float limit = tau > 0.0 ? tau * reference / (unit * unit) : -1.0;
    int level = level_of(node_index);
    int i = node_index - HISR_LEVEL_START(walk.x, level); // on its level
    int steps = 0;
    uint taken = 0u;
    do {
        for (; near_count < near_room && steps < walk.z && (level > 0 || i < walk.x); steps++) {
            int at = HISR_LEVEL_START(walk.x, level) + i;
            hisr_node node = nodes[at];
            bool lit = node.vpl.position_area.w > 0.0, refine = false;
            uint near = 0u;
            if (lit) {
                vec3 q = node.vpl.position_area.xyz * unit;
                vec3 m = node.vpl.normal.xyz;
                vec3 flux = node.vpl.flux.rgb;
                float area = node.vpl.position_area.w * unit * unit;
                float strongest = max(flux.r, max(flux.g, flux.b));
                node_extent extent = unpack_extent(node.spread);
                extent.size *= unit;
                extent.reach *= unit * unit;
                extent.radius *= unit;
                extent.depth *= unit;
                int map = 0;
#ifdef VISIBILITY
                map = map_of(level, i);
#endif
                for (int r = 0; r < BLOCK; r++) {
                    vec3 d = q - p[r];
                    float d2 = dot(d, d);
                    float cos_i = dot(n[r], d), cos_j = -dot(m, d); // times |d|
                    bool open = taken_at[r] >= level;
                    bool finer = level < walk.y && needs_refinement(extent, strongest, area, d2, cos_i,
                                                                    cos_j, limit);
                    bool take = open && !finer;
                    refine = refine || (open && finer);
                    taken_at[r] = open ? (finer ? no_level : level) : taken_at[r];
                    cos_i = max(cos_i, 0.0);
                    cos_j = max(cos_j, 0.0);
#if CLAMP == 0
                    float spread = pi * d2;
#elif CLAMP == 2
                    float spread = max(pi * d2, pi * clamp_d2 * unit * unit);
#else
                    float spread = pi * d2 + area;
#endif
#ifdef CUT
                    part[r] += take ? 1.0 : 0.0;
#else
                    float share = take ? cos_i * cos_j / max(d2 * spread, 1e-36) : 0.0;
#if CLAMP == 3
                    bool is_near = take && patch_is_near(d2, cos_j, area);
                    share = is_near ? 0.0 : share;
                    near |= is_near ? 1u << r : 0u;
#endif
#ifdef VISIBILITY
                    if (share > 0.0)
                        share *= ism_visibility(map, p[r], n[r]);
#endif
                    part[r] += flux * share;
#endif
                    taken += take ? 1u : 0u;
                }
#if CLAMP == 3 && !defined(CUT)
                if (near != 0u)
                    keep_near(at, near, map);
#endif
            }
            if (refine) {
                level++;
                i *= 4;
                continue;
            }
            // On to the next node that is below none of those passed.
            i++;
            int up = min(level, findLSB(i) >> 1);
            level -= up;
            i >>= 2 * up;
            if (level == 0) {
                for (int r = 0; r < BLOCK; r++) {
                    sum[r] += part[r];
                    part[r] = vec3(0.0);
                }
            }
        }
#if CLAMP == 3 && !defined(CUT)
        add_near(first, unit);
#endif
    } while (steps < walk.z && (level > 0 || i < walk.x));
    count_visits(taken, receivers);
    bool ends = level == 0 && i >= walk.x;
    uint next = uint(HISR_LEVEL_START(walk.x, level) + i) << 4;
    float factor = ends ? unit * unit / pi : 1.0;
    for (int r = 0; r < BLOCK; r++) {
        if (r >= receivers)
            break;
        ivec2 place = multires_place(texel_of(first + r), base);
        vec3 all = sum[r] + part[r] + imageLoad(illumination, place).rgb;
#ifdef CUT
        if (ends)
            all = false_colour(log2(max(all.x, 1.0)) / 8.0 - 0.75);
#else
        all = min(all * factor, vec3(3.0e38));
#endif
        imageStore(illumination, place, vec4(all, 1.0));
        progress[first + r] = ends ? done : next | uint(taken_at[r] & 15);
    }
}
