// SPDX-License-Identifier: MIT
#include "shapes.h"

#include <math.h>

static const float pi = 3.14159265f;

float shape_draw(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float) (*state >> 8) * (1.0f / 16777216.0f);
}

void shape_card(shape *s, const float centre[3], const float normal[3], float size, uint32_t *state)
{
    float n[3], across[3], up[3], corners[4][3];
    for (int i = 0; i < 3; ++i)
        n[i] = normal[i] + 0.9f * (shape_draw(state) - 0.5f);
    const float turn = 2.0f * pi * shape_draw(state);
    const float half = 0.5f * size * (0.7f + 0.6f * shape_draw(state));
    const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const float flat = hypotf(n[0], n[2]);
    const float right[3] = { n[2] / flat, 0, -n[0] / flat };
    const float upright[3] = { -n[1] * n[0] / (flat * length), flat / length,
                               -n[1] * n[2] / (flat * length) };
    for (int i = 0; i < 3; ++i) {
        across[i] = cosf(turn) * right[i] + sinf(turn) * upright[i];
        up[i] = cosf(turn) * upright[i] - sinf(turn) * right[i];
    }
    for (int k = 0; k < 4; ++k) {
        const float x = k == 1 || k == 2 ? half : -half, y = k >= 2 ? half : -half;
        for (int i = 0; i < 3; ++i)
            corners[k][i] = centre[i] + x * across[i] + y * up[i];
    }
    s->tiling = 0.5f / half; // one picture a card
    shape_quad(s, (const float(*)[3]) corners);
}

void shape_crown(shape *s, const shape_crown_desc *desc)
{
    uint32_t seed = desc->seed;
    for (int i = 0; i < desc->count; ++i) {
        const float y = 1.0f - 2.0f * ((float) i + 0.5f) / (float) desc->count;
        const float angle = 2.39996323f * (float) i; // the golden angle spreads them evenly
        const float flat = sqrtf(1.0f - y * y), deep = 0.65f + 0.35f * shape_draw(&seed);
        const float n[3] = { flat * cosf(angle), y, flat * sinf(angle) };
        float at[3];
        for (int k = 0; k < 3; ++k)
            at[k] = desc->centre[k] + deep * desc->radius[k] * n[k];
        shape_card(s, at, n, desc->size, &seed);
    }
}

void shape_frond(shape *s, const shape_frond_desc *desc)
{
    const float side[3] = { cosf(desc->yaw), 0.0f, -sinf(desc->yaw) };
    const float step = desc->length / (float) desc->pieces, tiling = s->tiling;
    float out = 0.0f, up = 0.0f; // of the foot
    const uint32_t first = (uint32_t) s->vertex_count;
    s->tiling = 1.0f;
    for (int j = 0; j <= desc->pieces; ++j) {
        const float t = (float) j / (float) desc->pieces;
        const float slope = desc->rise - desc->droop * t;
        // Up from the strip, and as far up again.
        const float lean = -sinf(slope), normal_y = cosf(slope) + 1.0f;
        const float normal[3] = { lean * sinf(desc->yaw), normal_y, lean * cosf(desc->yaw) };
        for (int i = 0; i < 2; ++i) {
            const float x = desc->width * ((float) i - 0.5f);
            const float p[3] = { desc->foot[0] + out * sinf(desc->yaw) + x * side[0],
                                 desc->foot[1] + up,
                                 desc->foot[2] + out * cosf(desc->yaw) + x * side[2] };
            shape_vertex(s, p, normal, (float) i, 1.0f - t);
        }
        out += step * cosf(slope);
        up += step * sinf(slope);
    }
    if (!s->failed)
        shape_lattice(s, first, 1, desc->pieces);
    s->tiling = tiling;
}
