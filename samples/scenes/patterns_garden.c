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
