#version 450 core
// SPDX-License-Identifier: MIT
// Sums the texels of each of the finest blocks, a surface at a time, and all flux.
// In:  position RGBA32F (w area), normal RGBA16F, flux RGBA32F, a layer a face; table
// Out: three parts a block, those there are first; flux of each work group, r + g + b
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

const float least_weight = 1e-37; // W: one over it is still a number

shared float weights[region * region];

// Sums about the first texel of a surface, which says what else is on it.
struct gathered {
    vec4 flux_area;
    vec4 origin_weight; // xyz: the first texel's position; w: r + g + b of flux that is on the surface
    vec3 first_normal;
    vec3 position, normal; // weighted, the position from the origin on
    vec2 place;            // weighted, texels from the block's corner on
    vec3 places;           // weighted squares and product of it
};

void add_texel(inout gathered g, vec4 position, vec3 normal, vec3 flux, vec3 place_weight)
{
    vec2 place = place_weight.xy;
    float weight = place_weight.z;
    if (!(g.origin_weight.w > 0.0)) {
        g.origin_weight.xyz = position.xyz;
        g.first_normal = normal;
    }
    g.flux_area += vec4(flux, position.w);
    g.origin_weight.w += weight;
    g.position += weight * (position.xyz - g.origin_weight.xyz);
    g.normal += weight * normal;
    g.place += weight * place;
    g.places += weight * place.xxy * place.xyy;
}

// 2 for the surface that a texel is on or a new one, else how alike they face.
float likeness(gathered g, vec4 position, vec3 normal)
{
    bool same = same_surface(g.origin_weight.xyz, g.first_normal, position.xyz, normal, position.w);
    return !(g.origin_weight.w > 0.0) || same ? 2.0 : dot(g.first_normal, normal);
}

part finish(gathered g, ivec2 corner)
{
    float to_mean = g.origin_weight.w > 0.0 ? 1.0 / g.origin_weight.w : 0.0;
    vec2 place = g.place * to_mean;
    vec3 spread = g.places * to_mean - place.xxy * place.xyy;
    vec2 middle = place + vec2(corner);
    return part(g.flux_area,
                vec4(g.origin_weight.xyz + g.position * to_mean, g.origin_weight.w),
                vec4(g.normal * to_mean, middle.x), vec4(middle.y, spread));
}

const gathered none = gathered(vec4(0.0), vec4(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec2(0.0),
                               vec3(0.0));

// Adds a square of edge^2 texels to what is there. Its own first three surfaces get a part each;
// of those of several squares the largest do, so that it hardly matters which texel comes first.
void add_square(inout part p[most_parts], ivec3 corner, int edge)
{
    gathered a = none, b = none, c = none;
    for (int i = 0; i < edge * edge; i++) {
        ivec2 place = ivec2(i % edge, i / edge);
        ivec3 texel = corner + ivec3(place, 0);
        vec4 position = texelFetch(position_map, texel, 0);
        vec3 flux = texelFetch(flux_map, texel, 0).rgb;
        vec3 normal = texelFetch(normal_map, texel, 0).xyz;
        float weight = position.w > 0.0 ? flux.r + flux.g + flux.b : 0.0;
        if (!(weight > least_weight))
            continue;
        float to_a = likeness(a, position, normal), to_b = likeness(b, position, normal);
        float to_c = likeness(c, position, normal);
        float most = max(to_a, max(to_b, to_c));
        // One surface too many adds its energy alone.
        vec3 counts = vec3(place, most == 2.0 ? weight : 0.0);
        if (to_a == most)
            add_texel(a, position, normal, flux, counts);
        else if (to_b == most)
            add_texel(b, position, normal, flux, counts);
        else
            add_texel(c, position, normal, flux, counts);
    }
    if (a.origin_weight.w > 0.0)
        add_part(p, finish(a, corner.xy), false);
    if (b.origin_weight.w > 0.0)
        add_part(p, finish(b, corner.xy), false);
    if (c.origin_weight.w > 0.0)
        add_part(p, finish(c, corner.xy), false);
}

void main()
{
    ivec4 row = row_of(int(gl_WorkGroupID.x));
    ivec2 at = block_here(row);
    int edge = header.z / row.w, square = min(edge, 4), squares = edge / square;
    bool inside = all(lessThan(at, ivec2(row.w)));
    part p[most_parts] = part[](no_part, no_part, no_part);
    for (int i = 0; inside && i < squares * squares; i++) {
        ivec2 corner = at * edge + ivec2(i % squares, i / squares) * square;
        add_square(p, ivec3(corner, row.x), square);
    }
    uint me = gl_LocalInvocationIndex;
    weights[me] = dot(p[0].flux_area.rgb + p[1].flux_area.rgb + p[2].flux_area.rgb, vec3(1.0));
    int first = (row.y + at.y * row.w + at.x) * most_parts;
    for (int k = 0; inside && k < most_parts; k++) {
        if (p[k].position_weight.w > 0.0)
            parts[first + k] = p[k];
        else
            parts[first + k].position_weight.w = 0.0;
    }
    for (uint half_ = 32; half_ > 0; half_ /= 2) {
        barrier();
        if (me < half_)
            weights[me] += weights[me + half_];
    }
    if (me == 0)
        sums[gl_WorkGroupID.x] = weights[0];
}
