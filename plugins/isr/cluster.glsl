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

part join(part a, part b)
{
    float weight = a.position_weight.w + b.position_weight.w;
    float t = weight > 0.0 ? b.position_weight.w / weight : 0.0;
    return part(a.flux_area + b.flux_area,
                vec4(mix(a.position_weight.xyz, b.position_weight.xyz, t), weight),
                mix(a.normal, b.normal, t));
}

// The larger one, with the energy of both.
part swallow(part a, part b)
{
    part larger = a;
    if (b.position_weight.w > a.position_weight.w)
        larger = b;
    larger.flux_area = a.flux_area + b.flux_area;
    return larger;
}

// Whether both may lie on one surface, that may bend: they face the same way within 45 degrees, and
// neither is above the other's plane by more than half of how far apart they are. Of surfaces closer
// than a hundredth of their size the rounding of positions decides nothing.
bool same_surface(part a, part b)
{
    vec3 n = a.normal.xyz / max(length(a.normal.xyz), 1e-6);
    vec3 m = b.normal.xyz / max(length(b.normal.xyz), 1e-6);
    vec3 d = b.position_weight.xyz - a.position_weight.xyz;
    float above = max(abs(dot(n, d)), abs(dot(m, d)));
    return dot(n, m) > 0.7 && above <= 0.5 * length(d) + 1e-2 * sqrt(a.flux_area.w + b.flux_area.w);
}

// Adds `b` to the part on its surface. Of one surface too many the faintest goes to that which faces
// as it does most. `one`: all is one surface.
void add_part(inout part p[most_parts], part b, bool one)
{
    if (!(b.position_weight.w > 0.0))
        return;
    int same = -1, faintest = 0;
    for (int k = most_parts - 1; k >= 0; k--) {
        if (one || !(p[k].position_weight.w > 0.0) || same_surface(p[k], b))
            same = k;
        if (p[k].position_weight.w < p[faintest].position_weight.w)
            faintest = k;
    }
    if (same >= 0) {
        p[same] = join(p[same], b);
        return;
    }
    if (p[faintest].position_weight.w < b.position_weight.w) {
        part other = p[faintest];
        p[faintest] = b;
        b = other;
    }
    int like = 0;
    float most_alike = -2.0;
    for (int k = 0; k < most_parts; k++) {
        float alike = dot(p[k].normal.xyz, b.normal.xyz);
        if (alike > most_alike) {
            most_alike = alike;
            like = k;
        }
    }
    p[like] = swallow(p[like], b);
}
