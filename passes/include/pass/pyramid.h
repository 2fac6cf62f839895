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
static inline ag_pyramid ag_pyramid_of(int width, int height, int levels)
{
    const int unit = 1 << (levels - 1);
    ag_pyramid p = { .levels = levels };
    p.base[0] = (width + unit - 1) / unit * unit;
    p.base[1] = (height + unit - 1) / unit * unit;
    p.size[0] = levels > 1 ? p.base[0] + p.base[0] / 2 : p.base[0];
    p.size[1] = p.base[1];
    return p;
}

// Where the k-th level of it begins, 0 the finest.
static inline void ag_pyramid_origin(const ag_pyramid *p, int k, int out[2])
{
    out[0] = k == 0 ? 0 : p->base[0];
    out[1] = k == 0 ? 0 : p->base[1] - (p->base[1] >> (k - 1));
}

FG_END

#endif // PASS_PYRAMID_H
