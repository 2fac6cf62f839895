// SPDX-License-Identifier: MIT
// Texture lookups that full and blurred textures share.
#ifndef SURFACE_PRIV_H
#define SURFACE_PRIV_H

#include <pass/surface.h>

#include <math.h>

// Linear RGBA of a texel, counted by rows.
void ag_texel_linear(const ag_texture *t, size_t at, float rgba[4]);

// A bilinear lookup in an image of `size` that wraps as the texture does. Weights sum to 1. Returns
// how many taps there are.
typedef struct ag_tap {
    size_t at;
    float weight;
} ag_tap;
int ag_texture_taps(const ag_texture *t, const int size[2], const float uv[2], ag_tap taps[4]);

// Where a reference looks.
void ag_texture_place(const ag_texture_ref *ref, const float uv[2][2], float at[2]);

static inline float clamp01(float v)
{
    return fminf(fmaxf(v, 0), 1);
}

#endif // SURFACE_PRIV_H
