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
    vec4 normal;          // xyz: mean of unit normals, shorter where they bend
};

const int most_parts = 3;
const part no_part = part(vec4(0.0), vec4(0.0), vec4(0.0));

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
