// SPDX-License-Identifier: MIT
// What is painted for a factory.
#include "patterns_priv.h"

void paint_carton(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static const float board[3] = { 0.70f, 0.70f, 0.70f }, tape[3] = { 0.84f, 0.86f, 0.86f };
    static const float paper[3] = { 0.95f, 0.98f, 1.0f }, ink[3] = { 0.12f, 0.12f, 0.12f };
    const float edge = fminf(fminf(u, 1.0f - u), fminf(v, 1.0f - v));
    tint(board, 0.88f + 0.14f * noise(p, 4, 90, 501) + 0.12f * (cloud(p, 4, 511) - 0.5f), rgba);
    if (fabsf(u - 0.5f) < 0.055f && (v < 0.36f || v > 0.82f))
        tint(tape, 0.95f, rgba);
    if (u > 0.60f && u < 0.90f && v > 0.50f && v < 0.74f) {
        const bool text = v > 0.56f && v < 0.70f && u > 0.63f && u < 0.87f &&
                          (int) (40.0f * v) % 2 &&
                          hash_unit((int) (70.0f * u), (int) (20.0f * v), 521) > 0.4f;
        tint(text ? ink : paper, 1.0f, rgba);
    }
    tint((const float[3]){ rgba[0], rgba[1], rgba[2] },
         0.6f + 0.4f * step_smooth(0.0f, 0.02f, edge), rgba);
}

void paint_concrete(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static const float grey[3] = { 0.35f, 0.34f, 0.32f }, stain[3] = { 0.20f, 0.185f, 0.165f };
    const float edge = fminf(fminf(u, 1.0f - u), fminf(v, 1.0f - v));
    const float a = cloud(p, 5, 531), b = cloud(p, 3, 541), fine = noise(p, 120, 120, 551);
    tint(grey, 0.86f + 0.40f * (a - 0.5f) + 0.12f * (fine - 0.5f), rgba);
    blend(rgba, stain, 0.7f * step_smooth(0.54f, 0.72f, b));
    blend(rgba, stain, 0.8f * (1.0f - step_smooth(0.002f, 0.005f, edge)));
}

void paint_belt(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static const float rubber[3] = { 0.085f, 0.088f, 0.094f }, mark[3] = { 0.62f, 0.40f, 0.05f };
    const float x = fabsf(u - 0.5f), chevron = v + 0.6f * x;
    tint(rubber, 0.85f + 0.3f * noise(p, 64, 64, 561), rgba);
    const float phase = 2.0f * chevron - (float) (int) (2.0f * chevron);
    if (x < 0.36f && phase > 0.42f && phase < 0.62f)
        tint(mark, 0.85f + 0.3f * noise(p, 32, 32, 571), rgba);
    if (x > 0.46f)
        tint(rubber, 1.6f, rgba);
}

void paint_sheet(brush *p, float rgba[4])
{
    const float u = p->u;
    static const float steel[3] = { 0.40f, 0.43f, 0.45f };
    const float rib = 5.0f * u - (float) (int) (5.0f * u);
    const float slope = step_smooth(0.10f, 0.22f, rib) * (1.0f - step_smooth(0.60f, 0.72f, rib));
    const float shade = rib < 0.22f && rib > 0.10f   ? 1.15f
                        : rib > 0.60f && rib < 0.72f ? 0.68f
                                                     : 0.92f;
    tint(steel, shade * (0.85f + 0.10f * slope) + 0.14f * (cloud(p, 4, 581) - 0.5f), rgba);
}

void paint_hazard(brush *p, float rgba[4])
{
    const float u = p->u, v = p->v;
    static const float yellow[3] = { 0.66f, 0.45f, 0.03f }, black[3] = { 0.05f, 0.05f, 0.05f };
    const float d = 2.0f * (u + v);
    const bool on = d - (float) (int) d < 0.5f;
    tint(on ? yellow : black, 0.8f + 0.4f * cloud(p, 6, 591), rgba);
}
