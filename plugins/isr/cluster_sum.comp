#version 450 core
// SPDX-License-Identifier: MIT
// Sums the texels of each of the finest blocks, a surface at a time, and all flux.
// In:  position RGBA32F (w area), normal RGBA16F, flux RGBA32F, a layer a face; table
// Out: three parts a block; flux of each work group, r + g + b
// Source: Nichols, Shopf, Wyman 2009, sec. 3.4.
#include "plugins/isr/cluster.glsl"

layout(local_size_x = region, local_size_y = region) in;

layout(binding = 0) uniform sampler2DArray position_map;
layout(binding = 1) uniform sampler2DArray normal_map;
layout(binding = 2) uniform sampler2DArray flux_map;
layout(std430, binding = 0) writeonly buffer part_buffer
{
    part parts[];
};
layout(std430, binding = 1) writeonly buffer sum_buffer
{
    float sums[];
};

shared float weights[region * region];

void main()
{
    ivec4 row = row_of(int(gl_WorkGroupID.x));
    ivec2 at = block_here(row);
    int edge = header.z / row.w;
    bool inside = all(lessThan(at, ivec2(row.w)));
    part p[most_parts];
    for (int k = 0; k < most_parts; k++)
        p[k] = no_part;
    for (int i = 0; inside && i < edge * edge; i++) {
        ivec3 texel = ivec3(at * edge + ivec2(i % edge, i / edge), row.x);
        vec4 position = texelFetch(position_map, texel, 0);
        vec3 flux = texelFetch(flux_map, texel, 0).rgb;
        vec3 normal = texelFetch(normal_map, texel, 0).xyz;
        float weight = position.w > 0.0 ? flux.r + flux.g + flux.b : 0.0;
        add_part(p, part(vec4(flux, position.w), vec4(position.xyz, weight), vec4(normal, 0.0)),
                 false);
    }
    for (int k = 0; inside && k < most_parts; k++)
        parts[(row.y + at.y * row.w + at.x) * most_parts + k] = p[k];

    uint me = gl_LocalInvocationIndex;
    weights[me] = 0.0;
    for (int k = 0; k < most_parts; k++)
        weights[me] += p[k].flux_area.r + p[k].flux_area.g + p[k].flux_area.b;
    for (uint half_ = 32; half_ > 0; half_ /= 2) {
        barrier();
        if (me < half_)
            weights[me] += weights[me + half_];
    }
    if (me == 0)
        sums[gl_WorkGroupID.x] = weights[0];
}
