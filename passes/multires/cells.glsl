// SPDX-License-Identifier: MIT
// Cells are the quarters of blocks of level SHARE. What a word of `blocks` says of a block: bit
// 3 (y + 1) + x + 1: its neighbour (x, y) is there and smooth, x and y in [-1, 1]; bit 9 + 2 y + x:
// cell (x, y) of it has an edge near.
#ifndef SHARE
#define SHARE 3
#endif

const int edge = 1 << SHARE; // pixels along a block's edge

bool neighbour_is_smooth(uint word, ivec2 side)
{
    return (word >> (3 * (side.y + 1) + side.x + 1) & 1u) != 0u;
}

bool edge_is_near(uint word, ivec2 cell)
{
    return (word >> (9 + 2 * (cell.y & 1) + (cell.x & 1)) & 1u) != 0u;
}

// The three other blocks about the cell's corner of its block lie to this side of it.
ivec2 side_of(ivec2 cell)
{
    return 2 * (cell & 1) - 1;
}
