// SPDX-License-Identifier: MIT
#include "garden_priv.h"

#include <math.h>

static const float tau = 6.28318531f;

static float smooth(float lo, float hi, float x)
{
    const float t = fminf(fmaxf((x - lo) / (hi - lo), 0.0f), 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

// ---- lie of the land ---------------------------------------------------------------------

float garden_ground(float x, float z)
{
    const float pond = hypotf(x - garden_pond[0], z - garden_pond[1]);
    const float house = hypotf(x - garden_pavilion[0], z - garden_pavilion[1]);
    const float level = smooth(2.2f, 4.0f, house) * smooth(2.4f, 4.0f, pond);
    const float swell = 0.05f * sinf(0.55f * x + 0.8f) * sinf(0.7f * z - 0.4f) +
                        0.012f * sinf(2.7f * x) * sinf(2.3f * z + 1.0f);
    return swell * level - 0.6f * (1.0f - smooth(1.2f, 2.25f, pond));
}

// From the gate in the south to the pavilion, and off it to the bench by the pond.
static const float ways[][2][2] = {
    { { 1.3f, 7.5f }, { 0.6f, 5.2f } },     { { 0.6f, 5.2f }, { -0.6f, 3.2f } },
    { { -0.6f, 3.2f }, { -1.6f, 1.4f } },   { { -1.6f, 1.4f }, { -2.2f, -0.4f } },
    { { -2.2f, -0.4f }, { -3.2f, -1.6f } }, { { 0.6f, 5.2f }, { 2.6f, 4.0f } },
    { { 2.6f, 4.0f }, { 4.4f, 2.4f } },
};

float garden_from_path(float x, float z)
{
    const float p[3] = { x, z, 0 };
    float nearest = 1e9f;
    for (int i = 0; i < FG_COUNT(ways); ++i) {
        const float a[3] = { ways[i][0][0], ways[i][0][1], 0 };
        const float b[3] = { ways[i][1][0], ways[i][1][1], 0 };
        nearest = fminf(nearest, field_bar(p, a, b, 0.0f, 0.0f));
    }
    return nearest;
}

static void ground_point(const void *user, float u, float v, float p[3], float uv[2])
{
    (void) user;
    p[0] = (2.0f * u - 1.0f) * (garden_half_x + 0.8f);
    p[2] = (1.0f - 2.0f * v) * (garden_half_z + 0.8f);
    p[1] = garden_ground(p[0], p[2]);
    uv[0] = p[0];
    uv[1] = p[2];
}

static void add_lawn(garden *g)
{
    const shape_sheet_desc sheet = { .point = ground_point, .nu = 72, .nv = 56 };
    shape s = { .tiling = 0.5f };
    shape_sheet(&s, &sheet);
    kit_show(&g->k, "lawn", kit_part(&g->k, "lawn", &s, g->material[GARDEN_LAWN]), -1,
             (place){ 0 });
}

// ---- path --------------------------------------------------------------------------------

// A flag of some 55 cm with a broken outline, its top at 0.
static int add_flag_part(garden *g, uint32_t seed)
{
    enum { CORNERS = 9 };
    float rim[CORNERS + 1][2];
    shape s = { .tiling = 1.0f };
    for (int i = 0; i <= CORNERS; ++i) {
        const float angle = tau * (float) (i % CORNERS) / CORNERS;
        if (i < CORNERS) {
            const float r = 0.25f + 0.09f * shape_draw(&seed);
            rim[i][0] = r * cosf(angle);
            rim[i][1] = -r * sinf(angle);
        } else {
            rim[i][0] = rim[0][0];
            rim[i][1] = rim[0][1];
        }
    }
    const uint32_t middle = shape_vertex(&s, (float[3]){ 0 }, (float[3]){ 0, 1, 0 }, 0, 0);
    for (int i = 0; i <= CORNERS; ++i) {
        const float p[3] = { rim[i][0], 0.0f, rim[i][1] };
        const uint32_t v = shape_vertex(&s, p, (float[3]){ 0, 1, 0 }, p[0], p[2]);
        if (i > 0 && !s.failed)
            shape_triangle(&s, middle, v - 1, v);
    }
    for (int i = 0; i < CORNERS; ++i) {
        const float *a = rim[i], *b = rim[i + 1];
        const float side[4][3] = { { a[0], -0.12f, a[1] },
                                   { b[0], -0.12f, b[1] },
                                   { b[0], 0.0f, b[1] },
                                   { a[0], 0.0f, a[1] } };
        shape_quad(&s, side);
    }
    return kit_part(&g->k, "flag", &s, g->material[GARDEN_STONE]);
}

static void add_path(garden *g)
{
    const int parts[3] = { add_flag_part(g, 3u), add_flag_part(g, 11u), add_flag_part(g, 29u) };
    uint32_t seed = 5u;
    int laid = 0;
    for (int i = 0; i < FG_COUNT(ways); ++i) {
        const float *a = ways[i][0], *b = ways[i][1];
        const float length = hypotf(b[0] - a[0], b[1] - a[1]);
        const int rows = (int) (length / 0.56f + 0.5f);
        for (int k = 0; k < 2 * rows; ++k) {
            const int row = k / 2;
            const float t = ((float) row + 0.25f + 0.5f * (float) (k % 2)) / (float) rows;
            const float aside = (k % 2 ? 0.31f : -0.31f) + 0.06f * (shape_draw(&seed) - 0.5f);
            const float x = a[0] + t * (b[0] - a[0]) - aside * (b[1] - a[1]) / length;
            const float z = a[1] + t * (b[1] - a[1]) + aside * (b[0] - a[0]) / length;
            const place at = { (double) x, (double) garden_ground(x, z) + 0.022, (double) z,
                               (double) (tau * shape_draw(&seed)) };
            kit_show(&g->k, "flag", parts[laid++ % 3], -1, at);
        }
    }
}

// ---- pond --------------------------------------------------------------------------------

static void add_pond(garden *g)
{
    static const float pool[][2] = { { 2.4f, 0.0f }, { 0, 0.0f } };
    const shape_lathe_desc water = { .profile = pool, .count = 2, .segments = 40 };
    shape s = { .tiling = 1.0f };
    shape_lathe(&s, &water);
    const double x = (double) garden_pond[0], z = (double) garden_pond[1];
    kit_show(&g->k, "water", kit_part(&g->k, "water", &s, g->material[GARDEN_WATER]), -1,
             (place){ x, (double) garden_water, z, 0 });

    // A ring of rounded stones.
    const int stones = 44;
    shape r = { .tiling = 1.0f };
    shape_sphere(&r, (float[3]){ 0, 0, 0 }, 0.19f, 10);
    for (size_t i = 0; i < r.vertex_count; ++i) {
        float *p = r.vertices[i].position;
        const float lump = 1.0f + 0.10f * sinf(13.0f * p[0] + 4.0f * p[1]) * cosf(11.0f * p[2]);
        p[0] *= lump * 1.15f;
        p[1] *= lump * 0.62f;
        p[2] *= lump;
    }
    shape_smooth(&r, 0, 0);
    const int part = kit_part(&g->k, "stone", &r, g->material[GARDEN_STONE]);
    uint32_t seed = 91u;
    for (int i = 0; i < stones; ++i) {
        const float angle = tau * ((float) i + 0.3f * shape_draw(&seed)) / (float) stones;
        const float out = garden_pond[2] + 0.10f * shape_draw(&seed);
        const float high = 0.05f * shape_draw(&seed) - 0.02f, turn = 0.4f * shape_draw(&seed);
        kit_show(&g->k, "stone", part, -1,
                 (place){ x + (double) (out * cosf(angle)), (double) high,
                          z + (double) (out * sinf(angle)), (double) (1.57f - angle + turn) });
    }
}

// Leaves flat on the water, each with its notch.
static void add_lilies(garden *g)
{
    enum { RIM = 14 };
    shape s = { 0 };
    const uint32_t middle = shape_vertex(&s, (float[3]){ 0 }, (float[3]){ 0, 1, 0 }, 0, 0);
    for (int i = 0; i <= RIM; ++i) {
        const float angle = 0.25f + (tau - 0.5f) * (float) i / RIM;
        const float p[3] = { 0.19f * cosf(angle), 0.012f, 0.19f * sinf(angle) };
        const uint32_t v = shape_vertex(&s, p, (float[3]){ 0, 1, 0 }, p[0], p[2]);
        if (i > 0 && !s.failed)
            shape_triangle(&s, middle, v - 1, v);
    }
    const int part = kit_part(&g->k, "lily", &s, g->material[GARDEN_SHADE]);
    uint32_t seed = 17u;
    for (int i = 0; i < 26; ++i) {
        const float angle = 1.9f + 2.2f * shape_draw(&seed), out = 0.5f + 1.5f * shape_draw(&seed);
        kit_show(&g->k, "lily", part, -1,
                 (place){ (double) (garden_pond[0] + out * cosf(angle)),
                          (double) garden_water + 0.004 + 0.0015 * i,
                          (double) (garden_pond[1] + out * sinf(angle)), 1.3 * i });
    }
}

// ---- walls -------------------------------------------------------------------------------

static void add_walls(garden *g)
{
    const float x = garden_half_x, z = garden_half_z;
    shape s = { .tiling = 1.0f }, coping = { .tiling = 1.0f };
    shape_box(&s, (float[3]){ -x - 0.4f, -0.4f, -z - 0.4f }, (float[3]){ x + 0.4f, 2.8f, -z });
    shape_box(&s, (float[3]){ -x - 0.4f, -0.4f, -z }, (float[3]){ -x, 2.8f, z + 0.4f });
    shape_box(&coping, (float[3]){ -x - 0.5f, 2.78f, -z - 0.5f },
              (float[3]){ x + 0.5f, 2.9f, -z + 0.1f });
    shape_box(&coping, (float[3]){ -x - 0.5f, 2.78f, -z + 0.1f },
              (float[3]){ -x + 0.1f, 2.9f, z + 0.5f });
    for (int i = 0; i < 6; ++i) {
        const float at = -x + 1.8f + 3.3f * (float) i;
        shape_box(&s, (float[3]){ at - 0.3f, -0.4f, -z - 0.02f },
                  (float[3]){ at + 0.3f, 2.8f, -z + 0.14f });
    }
    kit_show(&g->k, "wall", kit_part(&g->k, "wall", &s, g->material[GARDEN_BRICK]), -1,
             (place){ 0 });
    kit_show(&g->k, "coping", kit_part(&g->k, "coping", &coping, g->material[GARDEN_LIMESTONE]), -1,
             (place){ 0 });
}

void garden_add_ground(garden *g)
{
    add_lawn(g);
    add_path(g);
    add_pond(g);
    add_lilies(g);
    add_walls(g);
}
