// SPDX-License-Identifier: MIT
// What patterns are painted with, and the painters that patterns.c picks from.
#ifndef PATTERNS_PRIV_H
#define PATTERNS_PRIV_H

#include "patterns.h"

#include <math.h>

// Hash of a lattice point: two rounds of multiply and fold.
static inline uint32_t hash(uint32_t x, uint32_t y, uint32_t seed)
{
    uint32_t h = x * 0x8da6b343u ^ y * 0xd8163841u ^ seed * 0xcb1ab31fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return h ^ h >> 15;
}

static inline float hash_unit(int x, int y, uint32_t seed)
{
    return (float) (hash((uint32_t) x, (uint32_t) y, seed) >> 8) * (1.0f / 16777216.0f);
}

static inline float mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

static inline float clamp01(float x)
{
    return x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x;
}

// 0 below `lo`, 1 above `hi`, smooth between.
static inline float step_smooth(float lo, float hi, float x)
{
    const float t = clamp01((x - lo) / (hi - lo));
    return t * t * (3.0f - 2.0f * t);
}

// ---- where it is painted ---------------------------------------------------------------

enum { CELLS = 64 }; // a power of two; no pattern has as many layers of noise

// The corners of the lattice cell that the last point of a layer of noise was in: a row of pixels
// stays in one for long, and hashing is what painting spends its time on.
typedef struct cell {
    uint32_t seed; // 0: none
    int x, y;
    float corner[4];
} cell;

// A point of the unit square, and what is kept from one to the next.
typedef struct brush {
    float u, v; // [0, 1)
    cell cells[CELLS];
} brush;

// i modulo n for i in [0, 2 n).
static inline int wrap(int i, int n)
{
    return i < n ? i : i - n;
}

static inline const float *corners(brush *b, int ix, int iy, const int lattice[2], uint32_t seed)
{
    cell *c = &b->cells[seed % CELLS];
    if (c->seed == seed && c->x == ix && c->y == iy)
        return c->corner;
    const int nx = lattice[0], ny = lattice[1];
    const int x0 = wrap(ix, nx), x1 = wrap(x0 + 1, nx), y0 = wrap(iy, ny), y1 = wrap(y0 + 1, ny);
    *c = (cell){ seed,
                 ix,
                 iy,
                 { hash_unit(x0, y0, seed), hash_unit(x1, y0, seed), hash_unit(x0, y1, seed),
                   hash_unit(x1, y1, seed) } };
    return c->corner;
}

// Value noise in [0, 1] on a lattice of nx x ny cells over the unit square, which it tiles. A seed
// belongs to one lattice.
static inline float noise(brush *b, int nx, int ny, uint32_t seed)
{
    const float x = b->u * (float) nx, y = b->v * (float) ny;
    const int ix = (int) x, iy = (int) y;
    const float fx = x - (float) ix, fy = y - (float) iy;
    const float sx = fx * fx * (3.0f - 2.0f * fx), sy = fy * fy * (3.0f - 2.0f * fy);
    const float *c = corners(b, ix, iy, (const int[2]){ nx, ny }, seed);
    return mix(mix(c[0], c[1], sx), mix(c[2], c[3], sx), sy);
}

// Four octaves, about [0, 1], mean 0.5. Takes the seeds up to `seed` + 3.
static inline float cloud(brush *b, int cells, uint32_t seed)
{
    float sum = 0.0f, weight = 0.5333333f;
    for (uint32_t i = 0; i < 4; ++i) {
        sum += weight * noise(b, cells << i, cells << i, seed + i);
        weight *= 0.5f;
    }
    return sum;
}

// ---- patterns --------------------------------------------------------------------------

// The linear colour `base` made lighter or darker by `shade`.
static inline void tint(const float base[3], float shade, float rgba[4])
{
    for (int i = 0; i < 3; ++i)
        rgba[i] = base[i] * shade;
}

static inline void blend(float rgba[4], const float over[3], float amount)
{
    for (int i = 0; i < 3; ++i)
        rgba[i] = mix(rgba[i], over[i], amount);
}

// A cell of a running bond: which one, and how far from its edge.
typedef struct brick {
    int column, row;
    float edge; // in tile units
    float x, y; // within the cell, [0, 1]
} brick;

// `columns` by `rows` cells over the tile, every other row moved by half a cell.
static inline brick bond(float u, float v, int columns, int rows)
{
    const float y = v * (float) rows;
    brick b = { .row = (int) y };
    const float x = u * (float) columns + (b.row % 2 ? 0.5f : 0.0f);
    b.column = (int) x % columns;
    b.x = x - (float) (int) x;
    b.y = y - (float) b.row;
    const float ex = fminf(b.x, 1.0f - b.x) / (float) columns;
    const float ey = fminf(b.y, 1.0f - b.y) / (float) rows;
    b.edge = fminf(ex, ey);
    return b;
}

// A painter: the linear colour at the brush's point, which it may move; alpha is 1 already.
// patterns_home.c:
void paint_parquet(brush *p, float rgba[4]);
void paint_rug(brush *p, float rgba[4]);
void paint_pictures(brush *p, float rgba[4]);
void paint_television(brush *p, float rgba[4]);
void paint_evening(brush *p, float rgba[4]);
// patterns_works.c:
void paint_carton(brush *p, float rgba[4]);
void paint_concrete(brush *p, float rgba[4]);
void paint_belt(brush *p, float rgba[4]);
void paint_sheet(brush *p, float rgba[4]);
void paint_hazard(brush *p, float rgba[4]);
// patterns_garden.c
void paint_fresco(brush *p, float rgba[4]);
void paint_lawn(brush *p, float rgba[4]);
void paint_bark(brush *p, float rgba[4]);
void paint_grass(brush *p, float rgba[4]);
void paint_fern(brush *p, float rgba[4]);
void paint_flower(brush *p, float rgba[4]);

#endif // PATTERNS_PRIV_H
