// SPDX-License-Identifier: MIT
#include "patterns_priv.h"

#include <math.h>
#include <pthread.h>

static void ashlar(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static const float stone[3] = { 0.56f, 0.47f, 0.35f }, joint[3] = { 0.33f, 0.28f, 0.21f };
    const brick b = bond(u, v, 3, 5);
    const float own = hash_unit(b.column, b.row, 11);
    const float grain = cloud(p, 8, 21), fine = noise(p, 128, 128, 31);
    tint(stone, 0.80f + 0.20f * own + 0.26f * (grain - 0.5f) + 0.10f * (fine - 0.5f), rgba);
    rgba[2] *= 0.94f + 0.12f * hash_unit(b.column, b.row, 12);
    blend(rgba, joint, 1.0f - step_smooth(0.0022f, 0.0052f, b.edge + 0.0018f * (fine - 0.5f)));
}

static void limestone(brush *p, float rgba[4])
{
    static const float stone[3] = { 0.64f, 0.58f, 0.48f }, vein[3] = { 0.46f, 0.39f, 0.31f };
    const float a = cloud(p, 4, 41), b = cloud(p, 6, 51), fine = noise(p, 160, 160, 61);
    tint(stone, 0.92f + 0.24f * (a - 0.5f) + 0.08f * (fine - 0.5f), rgba);
    blend(rgba, vein, 0.4f * (1.0f - step_smooth(0.0f, 0.035f, fabsf(b - 0.52f))));
}

static void plaster(brush *p, float rgba[4])
{
    static const float wash[3] = { 0.62f, 0.44f, 0.25f }, bare[3] = { 0.60f, 0.53f, 0.43f };
    const float a = cloud(p, 4, 71), b = cloud(p, 7, 81), fine = noise(p, 200, 200, 91);
    tint(wash, 0.90f + 0.40f * (a - 0.5f) + 0.07f * (fine - 0.5f), rgba);
    blend(rgba, bare, 0.75f * step_smooth(0.56f, 0.68f, b));
}

static void bricks(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static const float clay[3] = { 0.40f, 0.17f, 0.10f }, mortar[3] = { 0.45f, 0.40f, 0.33f };
    const brick b = bond(u, v, 4, 14);
    const float own = hash_unit(b.column, b.row, 101), fine = cloud(p, 32, 111);
    tint(clay, 0.70f + 0.50f * own + 0.35f * (fine - 0.5f), rgba);
    blend(rgba, mortar, 1.0f - step_smooth(0.004f, 0.008f, b.edge));
}

static void paving(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static const float pale[3] = { 0.60f, 0.54f, 0.44f }, dark[3] = { 0.22f, 0.17f, 0.15f };
    static const float gap[3] = { 0.25f, 0.22f, 0.18f };
    // Two slabs a side, and a diamond on every corner.
    const float x = 2.0f * u, y = 2.0f * v;
    const int cx = (int) (x + 0.5f), cy = (int) (y + 0.5f);
    const float dx = fabsf(x - (float) cx), dy = fabsf(y - (float) cy);
    const float diamond = dx + dy; // from the nearest corner
    const float grain = cloud(p, 8, 121), fine = noise(p, 96, 96, 131);
    const int sx = (int) x, sy = (int) y;
    tint(pale, 0.84f + 0.16f * hash_unit(sx, sy, 141) + 0.24f * (grain - 0.5f) + 0.06f * fine,
         rgba);
    blend(rgba, gap, 1.0f - step_smooth(0.006f, 0.014f, fminf(dx, dy)));
    if (diamond < 0.24f) {
        tint(dark, 0.8f + 0.2f * hash_unit(cx % 2, cy % 2, 151) + 0.5f * (grain - 0.5f), rgba);
        blend(rgba, gap, step_smooth(0.222f, 0.236f, diamond));
    }
}

static void terracotta(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static const float clay[3] = { 0.47f, 0.23f, 0.13f }, gap[3] = { 0.30f, 0.25f, 0.20f };
    const float x = 4.0f * u, y = 4.0f * v;
    const int ix = (int) x, iy = (int) y;
    const float fx = x - (float) ix, fy = y - (float) iy;
    const float edge = fminf(fminf(fx, 1.0f - fx), fminf(fy, 1.0f - fy));
    const float grain = cloud(p, 10, 161);
    tint(clay, 0.75f + 0.35f * hash_unit(ix, iy, 171) + 0.30f * (grain - 0.5f), rgba);
    blend(rgba, gap, 1.0f - step_smooth(0.012f, 0.030f, edge));
}

static void clay(brush *p, float rgba[4])
{
    static const float base[3] = { 0.48f, 0.24f, 0.14f }, lichen[3] = { 0.40f, 0.36f, 0.25f };
    const float a = cloud(p, 5, 181), b = cloud(p, 9, 191);
    tint(base, 0.85f + 0.5f * (a - 0.5f) + 0.12f * (noise(p, 64, 64, 201) - 0.5f), rgba);
    blend(rgba, lichen, 0.5f * step_smooth(0.58f, 0.72f, b));
}

static void wood(brush *p, float rgba[4])
{
    const float u = p->u;
    static const float heart[3] = { 0.38f, 0.24f, 0.14f };
    const float x = 5.0f * u;
    const int plank = (int) x;
    const float edge = fminf(x - (float) plank, (float) (plank + 1) - x);
    const float fibre = noise(p, 90, 4, 211u), wide = noise(p, 24, 3, 221u);
    const float own = hash_unit(plank, 0, 231);
    tint(heart, 0.75f + 0.35f * own + 0.35f * (fibre - 0.5f) + 0.35f * (wide - 0.5f), rgba);
    const float seam = step_smooth(0.010f, 0.035f, edge);
    tint((const float[3]){ rgba[0], rgba[1], rgba[2] }, 0.45f + 0.55f * seam, rgba);
}

static void fabric(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    // Warp over weft in turn, 64 threads a side, with a woven lozenge figure.
    const float x = 64.0f * u, y = 64.0f * v;
    const float fx = x - (float) (int) x - 0.5f, fy = y - (float) (int) y - 0.5f;
    const bool over = ((int) x + (int) y) % 2;
    const float thread = 1.0f - (over ? fx * fx : fy * fy) * 1.1f;
    const float lx = fabsf(4.0f * u - (float) (int) (4.0f * u) - 0.5f);
    const float ly = fabsf(2.0f * v - (float) (int) (2.0f * v) - 0.5f);
    const float figure = step_smooth(0.03f, 0.05f, fabsf(lx + ly - 0.5f));
    const float shade = (0.80f + 0.12f * figure) * thread * (0.92f + 0.16f * noise(p, 16, 64, 241));
    tint((const float[3]){ 1.0f, 1.0f, 1.0f }, clamp01(shade), rgba);
}

// How far inside a leaf of the given half width the point is: 1 on the rib, 0 outside. Leaf axis
// from (0, 0) to (0, 1).
static float leaf_inside(float x, float y)
{
    if (y <= 0.0f || y >= 1.0f)
        return 0.0f;
    // Broad near the stalk, pointed at the tip, with a toothed edge.
    const float half = 1.15f * y * (1.0f - y) * (1.25f - 0.9f * y) +
                       0.02f * (1.0f - y) * fabsf(12.0f * y - (float) (int) (12.0f * y) - 0.5f);
    return clamp01(1.0f - fabsf(x) / half);
}

static void leaves(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    // Nine leaves around the card's middle; the last ones lie on top.
    static const float leaf[9][4] = {
        // foot x, foot y, direction cos, sin; length below
        { 0.50f, 0.52f, 0.00f, 1.00f },   { 0.48f, 0.50f, 0.77f, 0.64f },
        { 0.52f, 0.50f, -0.77f, 0.64f },  { 0.50f, 0.48f, 0.98f, -0.17f },
        { 0.50f, 0.48f, -0.98f, -0.17f }, { 0.52f, 0.50f, 0.64f, -0.77f },
        { 0.48f, 0.50f, -0.64f, -0.77f }, { 0.46f, 0.60f, 0.34f, 0.94f },
        { 0.54f, 0.44f, -0.17f, -0.98f },
    };
    static const float green[3] = { 0.16f, 0.27f, 0.07f }, rib[3] = { 0.33f, 0.42f, 0.16f };
    tint(green, 0.9f, rgba); // what filtering at the edges mixes in
    rgba[3] = 0.0f;
    for (int i = 0; i < 9; ++i) {
        const float length = 0.40f + 0.08f * hash_unit(i, 0, 251);
        const float dx = (u - leaf[i][0]) / length, dy = (v - leaf[i][1]) / length;
        const float along = dx * leaf[i][2] + dy * leaf[i][3];
        const float aside = dy * leaf[i][2] - dx * leaf[i][3];
        const float inside = leaf_inside(aside, along);
        if (inside <= 0.0f)
            continue;
        const float own = 0.65f + 0.7f * hash_unit(i, 1, 251);
        tint(green, own * (0.8f + 0.4f * noise(p, 48, 48, 261)), rgba);
        blend(rgba, rib, 0.8f * step_smooth(0.90f, 0.97f, inside));
        rgba[3] = 1.0f;
    }
}

static void (*const painters[PATTERN_COUNT])(brush *p, float rgba[4]) = {
    [PATTERN_ASHLAR] = ashlar,
    [PATTERN_LIMESTONE] = limestone,
    [PATTERN_PLASTER] = plaster,
    [PATTERN_BRICK] = bricks,
    [PATTERN_PAVING] = paving,
    [PATTERN_TERRACOTTA] = terracotta,
    [PATTERN_CLAY] = clay,
    [PATTERN_WOOD] = wood,
    [PATTERN_FABRIC] = fabric,
    [PATTERN_LEAVES] = leaves,
    [PATTERN_PARQUET] = paint_parquet,
    [PATTERN_RUG] = paint_rug,
    [PATTERN_PICTURES] = paint_pictures,
    [PATTERN_TELEVISION] = paint_television,
    [PATTERN_EVENING] = paint_evening,
    [PATTERN_CARTON] = paint_carton,
    [PATTERN_CONCRETE] = paint_concrete,
    [PATTERN_BELT] = paint_belt,
    [PATTERN_SHEET] = paint_sheet,
    [PATTERN_HAZARD] = paint_hazard,
    [PATTERN_FRESCO] = paint_fresco,
    [PATTERN_LAWN] = paint_lawn,
    [PATTERN_BARK] = paint_bark,
    [PATTERN_GRASS] = paint_grass,
    [PATTERN_FERN] = paint_fern,
    [PATTERN_FLOWER] = paint_flower,
};

enum { ENCODE_STEPS = 4096 };

// IEC 61966-2-1 encoding of [0, 1] in steps.
static void encode_table(uint8_t table[ENCODE_STEPS + 1])
{
    for (int i = 0; i <= ENCODE_STEPS; ++i) {
        const double x = (double) i / ENCODE_STEPS;
        const double y = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
        table[i] = (uint8_t) (255.0 * y + 0.5);
    }
}

// Rows `first` to `last` - 1 of a picture: what one thread paints.
typedef struct stripe {
    pattern what;
    int size, first, last;
    const uint8_t *encoded; // [ENCODE_STEPS + 1]
    uint8_t *rgba;          // the whole picture
} stripe;

static void *paint_stripe(void *user)
{
    const stripe *s = user;
    brush p = { 0 };
    uint8_t *out = s->rgba + 4 * (ptrdiff_t) s->size * s->first;
    for (int y = s->first; y < s->last; ++y) {
        for (int x = 0; x < s->size; ++x) {
            float c[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
            p.u = ((float) x + 0.5f) / (float) s->size;
            p.v = ((float) y + 0.5f) / (float) s->size;
            painters[s->what](&p, c);
            for (int i = 0; i < 3; ++i)
                *out++ = s->encoded[(int) (clamp01(c[i]) * ENCODE_STEPS + 0.5f)];
            *out++ = (uint8_t) (255.0f * c[3]);
        }
    }
    return NULL;
}

void pattern_paint(pattern what, int size, uint8_t *rgba)
{
    enum { THREADS = 4 };
    uint8_t table[ENCODE_STEPS + 1];
    stripe whole = { .what = what, .size = size, .encoded = table };
    stripe stripes[THREADS];
    pthread_t threads[THREADS];
    bool started[THREADS] = { false };
    whole.rgba = rgba;
    encode_table(table);
    for (int i = THREADS - 1; i >= 0; --i) {
        stripes[i] = whole;
        stripes[i].first = size * i / THREADS;
        stripes[i].last = size * (i + 1) / THREADS;
        // The first is painted here, and so is one that gets no thread.
        started[i] = i > 0 && !pthread_create(&threads[i], NULL, paint_stripe, &stripes[i]);
        if (!started[i])
            paint_stripe(&stripes[i]);
    }
    for (int i = 0; i < THREADS; ++i)
        if (started[i])
            pthread_join(threads[i], NULL);
}

bool pattern_is_masked(pattern what)
{
    return what == PATTERN_LEAVES || what == PATTERN_GRASS || what == PATTERN_FERN ||
           what == PATTERN_FLOWER;
}
