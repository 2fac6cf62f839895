// SPDX-License-Identifier: MIT
#ifndef PASS_PYRAMID_H
#define PASS_PYRAMID_H

#include <fg/base.h>

FG_BEGIN

// A pyramid of images flattened into one: the finest at the origin, the others in a column to the
// right of it, the coarsest at the top. passes/multires/pyramid.glsl does the same sums.
//
// `base`: size of its finest level, rounded up so that every coarser one is exactly half as large.
// Texel (x, y) of a level covers texels (2x, 2y) .. (2x + 1, 2y + 1) of the next finer one.
typedef struct ag_pyramid {
    int base[2]; // texels of the finest level, multiples of 2^(levels - 1)
    int levels;  // how many
    int size[2]; // texels of the whole image
} ag_pyramid;

// For an image of width x height texels.
FG_API ag_pyramid ag_pyramid_of(int width, int height, int levels);

// Where the k-th level of it begins, 0 the finest.
FG_API void ag_pyramid_origin(const ag_pyramid *p, int k, int out[2]);

FG_END

#endif // PASS_PYRAMID_H
