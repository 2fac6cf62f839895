#version 450 core
// SPDX-License-Identifier: MIT
// Makes one VPL of each block of RSM texels, by index face, row, column, and counts the
// valid ones of each group of 256.
// In:  position RGBA32F (w area), normal RGBA16F, flux RGBA32F, a layer a face; faces
// Out: ag_vpl[], invalid ones with flux 0; valid VPLs of each group
//
// A VPL sits on one texel of its block and carries the block's summed flux and area, so that no
// energy is lost or made by choosing fewer.
// Source: Nichols, Shopf, Wyman 2009, sec. 3.2.2, the VPL cache.
//         Departs from it: the flux of the whole block instead of the texel's times the count.
#include "passes/include/pass/scene_shared.h"
#include "passes/include/pass/vpl_shared.h"

layout(local_size_x = 256) in;

layout(binding = 0) uniform sampler2DArray position_map;
layout(binding = 1) uniform sampler2DArray normal_map;
layout(binding = 2) uniform sampler2DArray flux_map;
layout(std430, binding = 0) writeonly buffer vpl_buffer
{
    ag_vpl vpls[];
};
layout(std430, binding = 1) writeonly buffer group_buffer
{
    uint valid_in_group[];
};
layout(std430, binding = 2) readonly buffer face_buffer
{
    ag_gpu_face faces[];
};
layout(location = 0) uniform ivec4 layout_; // x: blocks along an edge; y: texels along a block's
                                            // edge; z: VPLs in all; w: 1: jittered
layout(location = 1) uniform uint seed;

shared uint valid_here;

// A well-mixed number of three: multiply, xor of high on low bits, twice over.
uint mix_bits(uint x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

// The texel of its block that a VPL would like to sit on.
ivec2 wanted_texel(uint index, int block)
{
    if (layout_.w == 0)
        return ivec2(block / 2);
    uint h = mix_bits(index * 0x9e3779b9u + mix_bits(seed));
    return ivec2(int(h & 0xffffu) * block >> 16, int(h >> 16) * block >> 16);
}

// An edge of the patch as ag_vpl packs it.
float pack_edge(vec3 edge, vec3 t, vec3 b)
{
    vec2 e = clamp(vec2(dot(edge, t), dot(edge, b)), -1e3, 1e3);
    return uintBitsToFloat(packHalf2x16(e));
}

// The patch that a texel at `p` with normal `n` stands for: how the point where its ray meets the
// plane moves with the texel, brought to area 1.
void pack_edges(ag_gpu_face f, vec3 p, vec3 n, inout ag_vpl v)
{
    vec3 du = f.right.xyz * f.right.w, dv = f.up.xyz * f.up.w; // over half the map
    vec3 ray = f.forward.xyz;
    if (f.eye.w < 0.5) {
        ray = p - f.eye.xyz;
        float along = dot(ray, f.forward.xyz);
        du *= along;
        dv *= along;
    }
    float across = dot(ray, n);
    across = abs(across) < 1e-6 * length(ray) ? -1e-6 * length(ray) : across;
    du -= ray * (dot(du, n) / across);
    dv -= ray * (dot(dv, n) / across);
    vec3 t, b;
    vpl_frame(n, t, b);
    float largest = max(length(du), length(dv));
    du /= max(largest, 1e-30);
    dv /= max(largest, 1e-30);
    float to_unit = inversesqrt(max(length(cross(du, dv)), 1e-6));
    v.normal.w = pack_edge(du * to_unit, t, b);
    v.flux.w = pack_edge(dv * to_unit, t, b);
}

ag_vpl make_vpl(uint index)
{
    int grid = layout_.x, block = layout_.y;
    int face = int(index) / (grid * grid);
    int cell = int(index) % (grid * grid);
    ivec2 corner = ivec2(cell % grid, cell / grid) * block;
    ivec2 wanted = wanted_texel(index, block);
    ivec2 best = ivec2(-1);
    int nearest = 1 << 30;
    float area = 0.0;
    vec3 flux = vec3(0.0);
    for (int i = 0; i < block * block; i++) {
        ivec2 at = ivec2(i % block, i / block);
        float a = texelFetch(position_map, ivec3(corner + at, face), 0).w;
        vec3 f = texelFetch(flux_map, ivec3(corner + at, face), 0).rgb;
        if (a <= 0.0 || max(f.r, max(f.g, f.b)) <= 0.0)
            continue;
        area += a;
        flux += f;
        ivec2 off = at - wanted;
        int distance2 = off.x * off.x + off.y * off.y;
        if (distance2 < nearest) {
            nearest = distance2;
            best = at;
        }
    }
    if (best.x < 0)
        return ag_vpl(vec4(0.0), vec4(0.0), vec4(0.0));
    ivec3 texel = ivec3(corner + best, face);
    vec3 p = texelFetch(position_map, texel, 0).xyz;
    vec3 n = normalize(texelFetch(normal_map, texel, 0).xyz);
    ag_vpl v = ag_vpl(vec4(p, area), vec4(n, 0.0), vec4(flux, 0.0));
    pack_edges(faces[face], p, n, v);
    return v;
}

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (gl_LocalInvocationIndex == 0)
        valid_here = 0;
    barrier();
    if (index < uint(layout_.z)) {
        ag_vpl v = make_vpl(index);
        vpls[index] = v;
        if (v.position_area.w > 0.0)
            atomicAdd(valid_here, 1u);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0)
        valid_in_group[gl_WorkGroupID.x] = valid_here;
}
