// SPDX-License-Identifier: MIT
// How small triangles stand in their list.
const int small_edge = 8, small_area = 16; // texels

bool small_fits(ivec2 extent)
{
    return max(extent.x, extent.y) <= small_edge && extent.x * extent.y <= small_area;
}

// A map of 64, a texel of 1024 x 1024, an extent of 8 x 8.
uint small_pack(uint map, ivec2 low, ivec2 extent)
{
    return map | uint(low.x) << 6 | uint(low.y) << 16 | uint(extent.x - 1) << 26 |
           uint(extent.y - 1) << 29;
}

void small_unpack(uint bits, out int map, out ivec2 low, out ivec2 extent)
{
    map = int(bits & 63u);
    low = ivec2(bits >> 6 & 1023u, bits >> 16 & 1023u);
    extent = ivec2(bits >> 26 & 7u, bits >> 29) + 1;
}
