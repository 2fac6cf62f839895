// SPDX-License-Identifier: MIT
// Walls and what grows before them.
#include "patterns_priv.h"

void paint_fresco(brush *p, float rgba[4])
{
    static const float bare[3] = { 0.72f, 0.66f, 0.56f };
    const float wide = cloud(p, 3, 271), strokes = noise(p, 60, 9, 281), worn = cloud(p, 9, 291);
    tint((const float[3]){ 1.0f, 1.0f, 1.0f },
         clamp01(0.86f + 0.30f * (wide - 0.5f) + 0.10f * (strokes - 0.5f)), rgba);
    blend(rgba, bare, 0.6f * step_smooth(0.66f, 0.74f, worn));
}

void paint_lawn(brush *p, float rgba[4])
{
    static const float green[3] = { 0.15f, 0.235f, 0.065f }, earth[3] = { 0.24f, 0.17f, 0.10f };
    const float wide = cloud(p, 3, 301), blades = noise(p, 110, 90, 311);
    const float fine = noise(p, 220, 230, 321);
    tint(green, 0.78f + 0.5f * (wide - 0.5f) + 0.55f * (blades - 0.5f) + 0.35f * (fine - 0.5f),
         rgba);
    blend(rgba, earth, 0.55f * step_smooth(0.60f, 0.76f, cloud(p, 6, 331)));
}

void paint_bark(brush *p, float rgba[4])
{
    static const float base[3] = { 0.235f, 0.165f, 0.11f }, moss[3] = { 0.17f, 0.20f, 0.08f };
    const float groove = noise(p, 26, 5, 341), fine = noise(p, 70, 16, 351);
    tint(base, 0.80f + 0.75f * (groove - 0.5f) + 0.35f * (fine - 0.5f), rgba);
    blend(rgba, moss, 0.5f * step_smooth(0.58f, 0.72f, cloud(p, 4, 361)));
}

void paint_grass(brush *p, float rgba[4])
{
    enum { BLADES = 22 };
    static const float green[3] = { 0.17f, 0.29f, 0.07f }, straw[3] = { 0.36f, 0.36f, 0.16f };
    const float up = 1.0f - p->v;
    tint(green, 0.8f, rgba);
    rgba[3] = 0.0f;
    for (int i = 0; i < BLADES; ++i) {
        // Over the foot, leaning and curving; thick at the foot and pointed at the tip.
        const float foot = 0.06f + 0.88f * hash_unit(i, 0, 371);
        const float high = 0.55f + 0.43f * hash_unit(i, 1, 371);
        const float lean = 0.32f * (hash_unit(i, 2, 371) - 0.5f);
        const float t = up / high;
        const float width = 0.030f * (1.0f - t * t) + 0.004f;
        const float x = p->u - foot - lean * t * t;
        if (t >= 1.0f || fabsf(x) > width || foot + lean * t * t < width)
            continue;
        tint(green, (0.65f + 0.5f * t) * (0.75f + 0.5f * hash_unit(i, 3, 371)), rgba);
        blend(rgba, straw, 0.55f * step_smooth(0.6f, 1.0f, t) * hash_unit(i, 4, 371));
        rgba[3] = 1.0f;
    }
}

void paint_fern(brush *p, float rgba[4])
{
    static const float green[3] = { 0.14f, 0.27f, 0.07f }, rib[3] = { 0.28f, 0.34f, 0.13f };
    const float up = 1.0f - p->v, x = fabsf(p->u - 0.5f);
    // Leaflets in pairs along the rib, each a slanting lens, shorter towards the tip.
    const float slant = up - 0.30f * x, row = 15.0f * slant;
    const float reach =
        0.47f * powf(clamp01(1.0f - slant), 0.75f) * step_smooth(0.0f, 0.16f, slant);
    const float across = row - (float) (int) row - 0.5f; // within a leaflet, [-0.5, 0.5]
    const float along = reach > 0.0f ? x / reach : 1.0f;
    const float half = 0.46f * (1.0f - along * along);
    const bool leaflet = slant > 0.0f && along < 1.0f && fabsf(across) < half;
    tint(green, 0.75f + 0.45f * hash_unit((int) row, p->u < 0.5f, 381) + 0.2f * along, rgba);
    blend(rgba, rib, x < 0.014f ? 1.0f : 0.5f * (1.0f - step_smooth(0.0f, 0.10f, fabsf(across))));
    rgba[3] = leaflet || (x < 0.014f && up < 0.97f) ? 1.0f : 0.0f;
}

void paint_flower(brush *p, float rgba[4])
{
    static const float petal[3] = { 0.95f, 0.93f, 0.90f }, middle[3] = { 0.80f, 0.55f, 0.10f };
    const float x = p->u - 0.5f, y = p->v - 0.5f, r = 2.0f * sqrtf(x * x + y * y);
    const float turn = 8.0f * atan2f(y, x) / 6.28318531f + 0.5f;
    const float across = turn - floorf(turn) - 0.5f;
    const float reach = 0.96f - 1.1f * across * across - 0.06f * fabsf(across);
    tint(petal, 0.70f + 0.35f * clamp01(r) - 0.5f * across * across, rgba);
    rgba[3] = r < reach ? 1.0f : 0.0f;
    if (r < 0.24f)
        tint(middle, 0.8f + 0.4f * noise(p, 24, 24, 391), rgba);
}
