// SPDX-License-Identifier: MIT
// Where pixels lie in the split image: tile (i, j) holds the pixels (a n + i, b n + j).
// Source: Laine, Saransaari, Kontkanen, Lehtinen, Aila 2007, sec. 5.1.
layout(location = 0) uniform ivec4 frame; // xy: pixels; z: n
layout(location = 1) uniform ivec2 tile;  // pixels of one tile

// Both exact for up to 2^22: a division of integers is taken apart lane by lane on CPUs.
int over(int x, int y)
{
    return int((float(x) + 0.5) / float(y));
}

ivec2 over(ivec2 at, ivec2 by)
{
    return ivec2(over(at.x, by.x), over(at.y, by.y));
}

// The pixel of a texel of the split image; there may be none.
ivec2 pixel_of(ivec2 at)
{
    ivec2 of = over(at, tile);
    return (at - of * tile) * frame.z + of;
}

ivec2 place_of(ivec2 pixel)
{
    ivec2 in_tile = over(pixel, frame.zz);
    return (pixel - in_tile * frame.z) * tile + in_tile;
}
