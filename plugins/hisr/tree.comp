#version 450 core
// SPDX-License-Identifier: MIT
// One level of the VPL tree, an invocation a node.
// In:  the level below; LEAF: position RGBA32F (w area), normal RGBA16F, flux RGBA32F (a solid
//      angle), a layer a face
// Out: hisr_node[], 0 where nothing is lit
// Source: Nichols, Shopf, Wyman 2009, sec. 3.5.
//         Departs from it: sums and means of all texels instead of one texel's values; max ||V_j||^2
//         comes of the same reduction.
#include "passes/include/pass/scene_shared.h"
#include "plugins/hisr/hisr_shared.h"
#include "passes/vpl/patch.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) buffer node_buffer
{
    hisr_node nodes[];
};
layout(std430, binding = 1) readonly buffer face_buffer
{
    ag_gpu_face faces[];
};
#include "plugins/hisr/extent.glsl"

layout(location = 0) uniform ivec4 layout_; // x: nodes of this level; y: nodes of a face on it;
                                            // z: where the level starts; w: where the one below does

#ifdef LEAF
layout(binding = 0) uniform sampler2DArray position_map;
layout(binding = 1) uniform sampler2DArray normal_map;
layout(binding = 2) uniform sampler2DArray flux_map;

// Every second bit of a Morton code, from bit 0 on.
int even_bits(int code)
{
    code &= 0x55555555;
    code = (code | code >> 1) & 0x33333333;
    code = (code | code >> 2) & 0x0f0f0f0f;
    code = (code | code >> 4) & 0x00ff00ff;
    return (code | code >> 8) & 0xffff;
}

hisr_node make_node(int index, int face)
{
    hisr_node node = hisr_node(ag_vpl(vec4(0.0), vec4(0.0), vec4(0.0)), vec4(0.0));
    int code = index - face * layout_.y;
    ivec3 texel = ivec3(even_bits(code), even_bits(code >> 1), face);
    vec4 position = texelFetch(position_map, texel, 0);
    vec4 flux = texelFetch(flux_map, texel, 0);
    if (position.w <= 0.0 || max(flux.r, max(flux.g, flux.b)) <= 0.0)
        return node;
    ag_gpu_face f = faces[face];
    vec3 v = position.xyz - f.eye.xyz;
    node.vpl.position_area = position;
    node.vpl.normal.xyz = normalize(texelFetch(normal_map, texel, 0).xyz);
    node.vpl.flux.rgb = flux.rgb;
    pack_edges(f, position.xyz, node.vpl.normal.xyz, node.vpl);
    // Half the diagonals, and the variance, of a parallelogram.
    vec2 eu = unpackHalf2x16(floatBitsToUint(node.vpl.normal.w));
    vec2 ev = unpackHalf2x16(floatBitsToUint(node.vpl.flux.w));
    float radius = 0.5 * sqrt(position.w) * max(length(eu + ev), length(eu - ev));
    float variance = position.w * (dot(eu, eu) + dot(ev, ev)) / 12.0;
    float reach = f.eye.w > 0.5 ? flux.a : flux.a * dot(v, v); // eq. 3
    node.spread = pack_extent(node_extent(sqrt(variance), reach, radius, 0.0, 0.0, 0.0));
    return node;
}
#else
hisr_node make_node(int index, int face)
{
    hisr_node node = hisr_node(ag_vpl(vec4(0.0), vec4(0.0), vec4(0.0)), vec4(0.0));
    int child = layout_.w + 4 * index;
    vec4 flux_area = vec4(0.0);
    float weights[4], heaviest = 0.0;
    node_extent e[4], extent = node_extent(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    vec3 normal = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        vec3 flux = nodes[child + i].vpl.flux.rgb;
        flux_area += vec4(flux, nodes[child + i].vpl.position_area.w);
        weights[i] = flux.r + flux.g + flux.b;
        e[i] = unpack_extent(nodes[child + i].spread);
        if (weights[i] > heaviest) {
            heaviest = weights[i];
            normal = nodes[child + i].vpl.normal.xyz;
        }
    }
    if (heaviest <= 0.0)
        return node;
    float whole = weights[0] + weights[1] + weights[2] + weights[3];
    vec3 position = vec3(0.0), mean = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        weights[i] /= whole;
        position += weights[i] * nodes[child + i].vpl.position_area.xyz;
        mean += weights[i] * sqrt(1.0 - e[i].bend * e[i].bend) * nodes[child + i].vpl.normal.xyz;
    }
    float len = length(mean);
    normal = len > 1e-3 ? mean / len : normal;
    for (int i = 0; i < 4; i++) {
        if (weights[i] <= 0.0)
            continue;
        vec3 off = nodes[child + i].vpl.position_area.xyz - position;
        vec3 m = nodes[child + i].vpl.normal.xyz;
        float along = min(abs(dot(m, normal)), 1.0);
        extent.size += weights[i] * (e[i].size * e[i].size + dot(off, off)); // of now: squared
        extent.reach = max(extent.reach, 4.0 * e[i].reach); // of equal solid angles, eq. 4
        extent.radius = max(extent.radius, length(off) + e[i].radius);
        extent.depth = max(extent.depth, abs(dot(off, normal)) + e[i].depth * along +
                                             e[i].radius * sqrt(1.0 - along * along));
        extent.cone = max(extent.cone, length(m - normal) + e[i].cone);
    }
    extent.size = sqrt(extent.size);
    extent.bend = sqrt(max(1.0 - len * len, 0.0));
    node.vpl.position_area = vec4(position, flux_area.w);
    node.vpl.normal.xyz = normal;
    node.vpl.flux.rgb = flux_area.rgb;
    pack_edges(faces[face], position, normal, node.vpl);
    node.spread = pack_extent(extent);
    return node;
}
#endif

void main()
{
    int index = int(gl_GlobalInvocationID.x);
    if (index < layout_.x)
        nodes[layout_.z + index] = make_node(index, index / layout_.y);
}
