// SPDX-License-Identifier: MIT
// What is painted for a living room.
#include "patterns_priv.h"

// 1 within `radius` of (x, y), soft over `soft`.
static float disc(float u, float v, float x, float y, float radius, float soft)
{
    return 1.0f - step_smooth(radius - soft, radius + soft, hypotf(u - x, v - y));
}

// 1 within the box, sharp.
static bool within(float u, float v, const float box[4])
{
    return u >= box[0] && v >= box[1] && u < box[2] && v < box[3];
}

// Noise along u alone: where hills end and trees.
static float ridge(brush *p, int cells, uint32_t seed)
{
    const float v = p->v;
    p->v = 0.5f;
    const float height = noise(p, cells, 3, seed);
    p->v = v;
    return height;
}

// From `top` at 0 to `low` at 1.
static void gradient(const float top[3], const float low[3], float t, float rgba[4])
{
    for (int i = 0; i < 3; ++i)
        rgba[i] = mix(top[i], low[i], clamp01(t));
}

void paint_parquet(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static const float oak[3] = { 0.40f, 0.235f, 0.115f };
    // Twelve strips, two lengths a tile, each strip's joints elsewhere.
    const int strip = (int) (12.0f * u);
    const float x = 12.0f * u - (float) strip;
    const float along = 2.0f * v + hash_unit(strip, 3, 301);
    const int length = (int) along % 2;
    const float y = along - (float) (int) along;
    const float edge = fminf(fminf(x, 1.0f - x) / 12.0f, fminf(y, 1.0f - y) / 2.0f);
    const float fibre = noise(p, 160, 5, 311), wide = noise(p, 48, 4, 321);
    const float own = hash_unit(strip, length, 331);
    tint(oak, 0.72f + 0.42f * own + 0.30f * (fibre - 0.5f) + 0.25f * (wide - 0.5f), rgba);
    const float seam = step_smooth(0.0006f, 0.0024f, edge);
    tint((const float[3]){ rgba[0], rgba[1], rgba[2] }, 0.5f + 0.5f * seam, rgba);
}

void paint_rug(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static const float red[3] = { 0.33f, 0.060f, 0.050f }, navy[3] = { 0.06f, 0.09f, 0.20f };
    static const float cream[3] = { 0.62f, 0.52f, 0.36f }, gold[3] = { 0.45f, 0.29f, 0.10f };
    const float a = fabsf(u - 0.5f), b = fabsf(v - 0.5f);
    const float border = 0.5f - fmaxf(a, b); // from the rim
    const float diamond = a / 0.34f + b / 0.36f;
    const float wave = 0.5f + 0.5f * sinf(62.8318f * (a > b ? v : u));
    const bool spot = sinf(75.0f * a) * sinf(75.0f * b) > 0.55f;
    const bool dot = sinf(88.0f * u) * sinf(88.0f * v) > 0.72f;
    const float *ground = dot ? cream : red;
    if (diamond < 0.93f)
        ground = diamond < 0.22f                      ? gold
                 : diamond < 0.40f || diamond > 0.86f ? cream
                 : spot                               ? gold
                                                      : navy;
    if (border < 0.128f)
        ground = border < 0.022f || border > 0.115f                   ? cream
                 : wave > 0.62f && border > 0.045f && border < 0.092f ? gold
                                                                      : navy;
    tint(ground, 0.82f + 0.36f * noise(p, 180, 180, 341), rgba);
}

// ---- paintings ----------------------------------------------------------------------

static void coast(brush *p, float rgba[4])
{
    const float x = p->u, y = p->v;
    static const float high[3] = { 0.25f, 0.42f, 0.62f }, low[3] = { 0.80f, 0.62f, 0.42f };
    static const float sea[3] = { 0.07f, 0.20f, 0.26f }, rock[3] = { 0.16f, 0.11f, 0.09f };
    gradient(high, low, y / 0.55f, rgba);
    if (y > 0.55f)
        tint(sea, 0.7f + 0.9f * noise(p, 6, 40, 351), rgba);
    if (y > 0.80f - 0.45f * x * ridge(p, 7, 352))
        tint(rock, 0.7f + 0.8f * cloud(p, 5, 353), rgba);
}

static void squares(brush *p, float rgba[4])
{
    const float x = p->u, y = p->v;
    static const float color[5][3] = { { 0.72f, 0.66f, 0.52f },
                                       { 0.62f, 0.09f, 0.05f },
                                       { 0.75f, 0.50f, 0.06f },
                                       { 0.07f, 0.14f, 0.40f },
                                       { 0.72f, 0.66f, 0.52f } };
    static const float cut_x[3] = { 0.28f, 0.64f, 0.88f }, cut_y[3] = { 0.22f, 0.55f, 0.80f };
    int i = 0, j = 0;
    bool line = false;
    for (int k = 0; k < 3; ++k) {
        i += x > cut_x[k];
        j += y > cut_y[k];
        line = line || fabsf(x - cut_x[k]) < 0.012f || fabsf(y - cut_y[k]) < 0.012f;
    }
    tint(color[hash((uint32_t) i, (uint32_t) j, 361) % 5], line ? 0.06f : 1.0f, rgba);
}

static void forest(brush *p, float rgba[4])
{
    const float x = p->u, y = p->v;
    static const float mist[3] = { 0.55f, 0.58f, 0.52f }, leaf[3] = { 0.08f, 0.16f, 0.05f };
    gradient(mist, leaf, y, rgba);
    for (int layer = 0; layer < 3; ++layer) {
        const float scale = 9.0f - 2.0f * (float) layer;
        const int tree = (int) (scale * x + 0.37f * (float) layer);
        const float at = scale * x + 0.37f * (float) layer - (float) tree - 0.5f;
        const float top = 0.20f + 0.16f * (float) layer + 0.22f * hash_unit(tree, layer, 371);
        if (y > top && fabsf(at) < 0.55f * (y - top) / (1.0f - top) + 0.02f)
            tint(leaf, 1.9f - 0.55f * (float) layer + 0.3f * noise(p, 40, 40, 372), rgba);
    }
}

static void still_life(brush *p, float rgba[4])
{
    const float x = p->u, y = p->v;
    static const float wall[3] = { 0.24f, 0.13f, 0.09f }, table[3] = { 0.50f, 0.42f, 0.30f };
    static const float fruit[3][3] = { { 0.70f, 0.28f, 0.03f },
                                       { 0.55f, 0.06f, 0.04f },
                                       { 0.55f, 0.52f, 0.08f } };
    tint(y > 0.68f ? table : wall, 0.8f + 0.4f * cloud(p, 4, 381), rgba);
    for (int i = 0; i < 3; ++i) {
        const float at = 0.30f + 0.20f * (float) i, radius = 0.12f + 0.02f * (float) (i % 2);
        const float light = 1.25f - 2.6f * hypotf(x - at + 0.05f, y - 0.58f);
        if (hypotf(x - at, y - 0.64f) < radius)
            tint(fruit[i], fmaxf(light, 0.25f), rgba);
    }
}

void paint_pictures(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static void (*const each[4])(brush *, float[4]) = { coast, squares, forest, still_life };
    const int i = (int) (2.0f * u), j = (int) (2.0f * v);
    p->u = 2.0f * u - (float) i;
    p->v = 2.0f * v - (float) j;
    each[2 * j + i](p, rgba);
}

// ---- the film -----------------------------------------------------------------------

static void sail(brush *p, float time, float rgba[4])
{
    const float x = p->u, y = p->v;
    static const float high[3] = { 0.16f, 0.09f, 0.30f }, low[3] = { 1.0f, 0.42f, 0.10f };
    static const float sun[3] = { 1.0f, 0.85f, 0.45f }, sea[3] = { 0.10f, 0.07f, 0.16f };
    static const float hull[3] = { 0.02f, 0.015f, 0.02f };
    gradient(high, low, y / 0.6f, rgba);
    blend(rgba, sun, disc(x, y, 0.62f, 0.50f + 0.03f * time, 0.11f, 0.01f));
    if (y > 0.6f) {
        tint(sea, 1.0f + noise(p, 5, 36, 391 + (uint32_t) time), rgba);
        const float glint = noise(p, 9, 60, 395 + (uint32_t) time);
        blend(rgba, low, step_smooth(0.45f, 0.8f, glint) * disc(x, 0, 0.62f, 0, 0.16f, 0.08f));
    }
    const float boat = x - 0.12f - 0.10f * time, up = 0.66f - y;
    if (fabsf(boat) < 0.09f + 0.4f * up && up > -0.035f && up < 0.0f)
        tint(hull, 1.0f, rgba);
    if (up > 0.0f && up < 0.30f && boat > -0.005f && boat < 0.10f * (1.0f - up / 0.30f))
        tint(sun, 0.75f, rgba);
}

static void match(brush *p, float time, float rgba[4])
{
    const float x = p->u, y = p->v;
    static const float grass[3] = { 0.07f, 0.36f, 0.06f }, crowd[3] = { 0.30f, 0.22f, 0.22f };
    static const float white[3] = { 0.9f, 0.9f, 0.9f };
    static const float shirts[2][3] = { { 0.85f, 0.06f, 0.05f }, { 0.10f, 0.20f, 0.85f } };
    tint(grass, (int) (8.0f * x + 2.0f * y) % 2 ? 1.0f : 1.35f, rgba);
    if (y < 0.24f)
        tint(crowd, 0.4f + 1.6f * hash_unit((int) (60.0f * x), (int) (60.0f * y), 401), rgba);
    if (fabsf(y - 0.26f) < 0.012f || fabsf(x - 0.5f - 0.12f * (y - 0.6f)) < 0.008f)
        blend(rgba, white, 0.9f);
    for (int i = 0; i < 8; ++i) {
        const float way = 0.06f * time * (i % 2 ? 1.0f : -1.0f);
        const float px = 0.1f + 0.8f * hash_unit(i, 0, 411) + way;
        const float py = 0.38f + 0.5f * hash_unit(i, 1, 411);
        const float body[4] = { px - 0.016f, py - 0.10f, px + 0.016f, py };
        if (within(x, y, body))
            tint(shirts[i % 2], y > py - 0.045f ? 0.5f : 1.0f, rgba);
    }
    blend(rgba, white, disc(x, y, 0.25f + 0.13f * time, 0.75f - 0.08f * time, 0.016f, 0.004f));
}

static void city(brush *p, float time, float rgba[4])
{
    const float x = p->u, y = p->v;
    static const float sky[3] = { 0.015f, 0.025f, 0.10f }, glow[3] = { 0.20f, 0.10f, 0.16f };
    static const float wall[3] = { 0.012f, 0.014f, 0.025f }, lamp[3] = { 1.0f, 0.75f, 0.32f };
    static const float car[3] = { 1.0f, 0.12f, 0.06f };
    gradient(sky, glow, y, rgba);
    blend(rgba, (const float[3]){ 0.9f, 0.9f, 0.8f }, disc(x, y, 0.8f, 0.17f, 0.06f, 0.006f));
    const int house = (int) (9.0f * x);
    const float in = 9.0f * x - (float) house, top = 0.25f + 0.40f * hash_unit(house, 0, 421);
    if (y > top && y < 0.88f) {
        const float wx = 4.0f * in - (float) (int) (4.0f * in),
                    wy = 24.0f * y - (float) (int) (24.0f * y);
        const int column = 4 * house + (int) (4.0f * in), row = (int) (24.0f * y);
        const bool lit = hash_unit(column, row, 431 + (uint32_t) time % 2) > 0.55f;
        tint(wall, 1.0f, rgba);
        if (lit && wx > 0.25f && wx < 0.75f && wy > 0.25f && wy < 0.8f)
            tint(lamp, 0.6f + 0.4f * hash_unit(column, row, 441), rgba);
    }
    const float lane = 7.0f * x + 0.35f * time;
    if (y > 0.92f && y < 0.95f && lane - (float) (int) lane < 0.35f)
        tint(car, 1.0f, rgba);
}

static void balloon(brush *p, float time, float rgba[4])
{
    const float x = p->u, y = p->v;
    static const float high[3] = { 0.10f, 0.34f, 0.85f }, low[3] = { 0.55f, 0.75f, 0.95f };
    static const float white[3] = { 0.95f, 0.95f, 0.95f }, hill[3] = { 0.16f, 0.40f, 0.08f };
    static const float stripes[2][3] = { { 0.90f, 0.10f, 0.05f }, { 0.95f, 0.75f, 0.08f } };
    const float drift = x + 0.04f * time, by = 0.44f - 0.05f * time;
    p->u = drift - (float) (int) drift;
    gradient(high, low, y / 0.75f, rgba);
    blend(rgba, white, step_smooth(0.55f, 0.70f, cloud(p, 4, 451)));
    if (y > 0.78f - 0.10f * sinf(5.0f * x + 1.0f))
        tint(hill, 0.8f + 0.5f * y * noise(p, 30, 30, 461), rgba);
    if (hypotf(x - 0.42f, 1.1f * (y - by)) < 0.20f)
        tint(stripes[(int) (20.0f * fabsf(x - 0.42f) + 0.5f) % 2], 1.0f, rgba);
    const float basket[4] = { 0.39f, by + 0.24f, 0.45f, by + 0.30f };
    if (within(x, y, basket))
        tint(stripes[0], 0.25f, rgba);
}

void paint_television(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static void (*const programme[4])(brush *, float, float[4]) = { sail, match, city, balloon };
    const int i = (int) (4.0f * u), j = (int) (4.0f * v);
    p->u = 4.0f * u - (float) i;
    p->v = 4.0f * v - (float) j;
    programme[j](p, (float) i, rgba);
}

// Low hills under an evening sky; the horizon stands at 0.62 from above.
void paint_evening(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static const float high[3] = { 0.20f, 0.33f, 0.58f }, low[3] = { 0.95f, 0.62f, 0.32f };
    static const float far[3] = { 0.20f, 0.19f, 0.24f }, near[3] = { 0.06f, 0.10f, 0.045f };
    static const float red[3] = { 0.95f, 0.45f, 0.25f };
    gradient(high, low, v / 0.62f, rgba);
    blend(rgba, red, 0.7f * step_smooth(0.52f, 0.72f, cloud(p, 3, 471)) * clamp01(1.6f * v));
    if (v > 0.58f - 0.06f * sinf(9.0f * u + 2.0f) - 0.03f * ridge(p, 20, 481))
        tint(far, 1.0f, rgba);
    if (v > 0.70f - 0.05f * ridge(p, 26, 491) - 0.03f * sinf(5.0f * u))
        tint(near, 0.6f + 0.8f * noise(p, 60, 60, 492), rgba);
}
