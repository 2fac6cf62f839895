// SPDX-License-Identifier: MIT
// Blocks of texels of reflective shadow maps, and what lies on each surface within one.

// A row for each face with light, in their order: x face; y its first block; z its first work group;
// w blocks along its edge.
layout(std430, binding = 3) readonly buffer table_buffer
{
    ivec4 header; // x: rows; y: work groups; z: texels along a map's edge; w: how many times four
                  // blocks may become one
    ivec4 rows[];
};

const int region = 8; // blocks along the edge of what a work group takes

// The face that a work group works for: the last row that begins no later.
ivec4 row_of(int group)
{
    int lo = 0, hi = header.x - 1;
    while (lo < hi) {
        int mid = (lo + hi + 1) / 2;
        if (rows[mid].z <= group)
            lo = mid;
        else
            hi = mid - 1;
    }
    return rows[lo];
}

// The block of this invocation; beyond the face where the face has fewer than a region's.
ivec2 block_here(ivec4 row)
{
    int across = (row.w + region - 1) / region;
    int place = int(gl_WorkGroupID.x) - row.z;
    return ivec2(place % across, place / across) * region + ivec2(gl_LocalInvocationID.xy);
}

// One surface's part of a block. Empty: weight 0.
struct part {
    vec4 flux_area;       // sums
    vec4 position_weight; // xyz: mean; w: what the means are weighted with: r + g + b of flux
    vec4 normal_place;    // xyz: mean of unit normals, shorter where they bend; w: mean of the
                          // texels' columns
    vec4 place_spread;    // x: mean of their rows; yzw: variance of columns, covariance, of rows
};

const int most_parts = 3;
const part no_part = part(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));

// Whether two places with normals of any length may lie on one surface, that may bend: they face the
// same way within 45 degrees, and neither is above the other's plane by more than half of how far
// apart they are. Of places closer than a hundredth of their size, of that area, the rounding of
// positions decides nothing.
bool same_surface(vec3 p, vec3 n, vec3 q, vec3 m, float area)
{
    vec3 d = q - p;
    float nn = dot(n, n), mm = dot(m, m), nm = dot(n, m), nd = dot(n, d), md = dot(m, d);
    float above = 0.25 * dot(d, d) + 1e-4 * area;
    return nm > 0.0 && nm * nm > 0.5 * nn * mm && nd * nd <= nn * above && md * md <= mm * above;
}

part join(part a, part b)
{
    float weight = a.position_weight.w + b.position_weight.w;
    float t = weight > 0.0 ? b.position_weight.w / weight : 0.0;
    vec2 apart = vec2(b.normal_place.w - a.normal_place.w, b.place_spread.x - a.place_spread.x);
    vec4 between = vec4(0.0, apart.xxy * apart.xyy) * (t * (1.0 - t));
    return part(a.flux_area + b.flux_area,
                vec4(mix(a.position_weight.xyz, b.position_weight.xyz, t), weight),
                mix(a.normal_place, b.normal_place, t),
                mix(a.place_spread, b.place_spread, t) + between);
}

bool takes(part a, part b)
{
    return !(a.position_weight.w > 0.0) ||
           same_surface(a.position_weight.xyz, a.normal_place.xyz, b.position_weight.xyz,
                        b.normal_place.xyz, a.flux_area.w + b.flux_area.w);
}

void swap_if(bool yes, inout part a, inout part b)
{
    part c = a;
    if (yes) {
        a = b;
        b = c;
    }
}

// Adds `b` to the part on its surface. Of one surface too many the faintest adds its energy alone, to
// that which faces as it does most. `one`: all is one surface. No index is variable: that is slow.
void add_part(inout part p[most_parts], part b, bool one)
{
    if (one || takes(p[0], b)) {
        p[0] = join(p[0], b);
    } else if (takes(p[1], b)) {
        p[1] = join(p[1], b);
    } else if (takes(p[2], b)) {
        p[2] = join(p[2], b);
    } else {
        vec3 w = vec3(p[0].position_weight.w, p[1].position_weight.w, p[2].position_weight.w);
        float least = min(w.x, min(w.y, w.z));
        bool swaps = least < b.position_weight.w;
        swap_if(swaps && w.x == least, p[0], b);
        swap_if(swaps && w.x != least && w.y == least, p[1], b);
        swap_if(swaps && w.x != least && w.y != least, p[2], b);
        vec3 n = b.normal_place.xyz;
        vec3 alike = vec3(dot(p[0].normal_place.xyz, n), dot(p[1].normal_place.xyz, n),
                          dot(p[2].normal_place.xyz, n));
        if (alike.x >= max(alike.y, alike.z))
            p[0].flux_area += b.flux_area;
        else if (alike.y >= alike.z)
            p[1].flux_area += b.flux_area;
        else
            p[2].flux_area += b.flux_area;
    }
}
