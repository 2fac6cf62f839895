// SPDX-License-Identifier: MIT
#include "garden_priv.h"

#include <math.h>

// Grass, ferns, flowers and reeds: few primitives, shown many times.

static const float tau = 6.28318531f;
static const float period = 24.0f; // s

// A tuft's worth of blades around the origin, `spread` metres wide.
static void add_tufts(shape *s, int count, float spread, float height, uint32_t seed)
{
    for (int i = 0; i < count; ++i) {
        const float angle = tau * shape_draw(&seed), out = spread * sqrtf(shape_draw(&seed));
        const float tall = height * (0.7f + 0.6f * shape_draw(&seed));
        const float yaw = tau * shape_draw(&seed);
        for (int k = 0; k < 2; ++k)
            shape_frond(
                s, &(shape_frond_desc){ .foot = { out * cosf(angle), -0.02f, out * sinf(angle) },
                                        .yaw = yaw + 1.7f * (float) k,
                                        .width = 1.5f * tall,
                                        .length = tall,
                                        .rise = 1.42f,
                                        .droop = 0.25f,
                                        .pieces = 1 });
    }
}

static bool is_lawn(float x, float z)
{
    return garden_from_path(x, z) > 0.75f &&
           hypotf(x - garden_pond[0], z - garden_pond[1]) > garden_pond[2] + 0.45f &&
           hypotf(x - garden_pavilion[0], z - garden_pavilion[1]) > garden_pavilion[2] + 0.4f &&
           fabsf(x) < garden_half_x - 0.7f && fabsf(z) < garden_half_z - 0.6f;
}

static place on_ground(float x, float z, float yaw)
{
    return (place){ (double) x, (double) garden_ground(x, z), (double) z, (double) yaw };
}

static void add_grass(garden *g)
{
    int parts[3];
    for (int i = 0; i < 3; ++i) {
        shape s = { 0 };
        add_tufts(&s, 26, 0.62f, i == 2 ? 0.20f : 0.13f, 11u + (uint32_t) i);
        parts[i] = kit_part(&g->k, "grass", &s, g->material[GARDEN_GRASS]);
    }
    uint32_t seed = 23u;
    for (int i = 0; i < 20 * 15; ++i) {
        const int row = i / 20;
        const float x = (float) (i % 20) - 9.5f + 0.7f * (shape_draw(&seed) - 0.5f);
        const float z = (float) row - 7.0f + 0.7f * (shape_draw(&seed) - 0.5f);
        const float yaw = tau * shape_draw(&seed), pick = shape_draw(&seed);
        if (is_lawn(x, z))
            kit_show(&g->k, "grass",
                     parts[pick < 0.4f    ? 0
                           : pick < 0.85f ? 1
                                          : 2],
                     -1, on_ground(x, z, yaw));
    }
}

// Sways around its foot; returns the node to show things at.
static int add_swaying(garden *g, place at, float amplitude, int i)
{
    const int foot = kit_node(&g->k, "foot", -1, at);
    const int node = kit_node(&g->k, "sway", foot, (place){ 0 });
    const kit_swing_desc sway = { .axis = i % 2 ? 2 : 0,
                                  .amplitude = amplitude,
                                  .phase = 0.13f * (float) i,
                                  .seconds = period,
                                  .count = 8 };
    kit_swing(&g->k, node, &sway);
    return node;
}

static void add_ferns(garden *g)
{
    static const float where[][2] = {
        { -9.3f, -6.6f }, { -7.2f, -6.8f }, { -9.2f, -3.6f }, { -8.9f, -1.2f }, { -9.3f, 1.2f },
        { -7.9f, 3.9f },  { -6.2f, 2.2f },  { -8.9f, 5.7f },  { 6.6f, -6.6f },  { 8.7f, -6.2f },
        { 8.8f, -4.2f },  { 6.6f, 2.4f },   { 8.3f, 3.7f },   { 4.2f, 6.6f },   { 6.1f, 6.6f },
        { 1.0f, -3.7f },  { 4.7f, -3.2f },  { 5.3f, -0.4f },  { -3.4f, 6.7f },  { -5.3f, 6.7f },
    };
    uint32_t seed = 31u;
    shape s = { 0 };
    for (int i = 0; i < 15; ++i) {
        const float turn = shape_draw(&seed), length = shape_draw(&seed), rise = shape_draw(&seed);
        shape_frond(&s, &(shape_frond_desc){ .yaw = tau * (float) i / 15.0f + 0.3f * turn,
                                             .width = 0.26f,
                                             .length = 0.62f + 0.25f * length,
                                             .rise = 1.15f + 0.25f * rise,
                                             .droop = 1.5f,
                                             .pieces = 6 });
    }
    const int part = kit_part(&g->k, "fern", &s, g->material[GARDEN_FERN]);
    for (int i = 0; i < FG_COUNT(where); ++i)
        kit_show(&g->k, "fern", part, -1, on_ground(where[i][0], where[i][1], 1.7f * (float) i));
}

// Stalks with leaves at the foot and a flower each; the heads are another material.
static void add_flower_parts(garden *g, garden_material colour, uint32_t seed, int parts[2])
{
    shape leaves = { 0 }, heads = { 0 };
    for (int i = 0; i < 26; ++i) {
        const float angle = tau * shape_draw(&seed), out = 0.42f * sqrtf(shape_draw(&seed));
        const float x = out * cosf(angle), z = out * sinf(angle);
        const float high = 0.24f + 0.26f * shape_draw(&seed);
        const float top[3] = { x, high, z };
        shape_frond(&leaves, &(shape_frond_desc){ .foot = { x, 0, z },
                                                  .yaw = angle,
                                                  .width = 0.02f,
                                                  .length = high,
                                                  .rise = 1.57f,
                                                  .pieces = 1 });
        for (int k = 0; k < 2; ++k)
            shape_frond(&leaves, &(shape_frond_desc){ .foot = { x, 0, z },
                                                      .yaw = tau * shape_draw(&seed),
                                                      .width = 0.09f,
                                                      .length = 0.6f * high,
                                                      .rise = 1.1f,
                                                      .droop = 0.9f,
                                                      .pieces = 2 });
        shape_card(&heads, top, (float[3]){ 0.3f * x, 1.0f, 0.3f * z + 0.02f }, 0.105f, &seed);
    }
    parts[0] = kit_part(&g->k, "stalks", &leaves, g->material[GARDEN_FERN]);
    parts[1] = kit_part(&g->k, "heads", &heads, g->material[colour]);
}

static void add_flowers(garden *g)
{
    static const garden_material colours[3] = { GARDEN_ROSE, GARDEN_BLUE, GARDEN_WHITE };
    int parts[3][2];
    for (int i = 0; i < 3; ++i)
        add_flower_parts(g, colours[i], 41u + (uint32_t) i, parts[i]);
    uint32_t seed = 43u;
    for (int i = 0; i < 64; ++i) {
        float x, z;
        if (i < 30) { // along the northern wall
            x = -6.2f + 0.42f * (float) i;
            z = -garden_half_z + 0.75f + 0.55f * shape_draw(&seed);
        } else if (i < 46) { // around the pavilion, but for its steps
            const float angle = 1.35f + 4.6f * (float) (i - 30) / 15.0f;
            x = garden_pavilion[0] + 2.85f * cosf(angle);
            z = garden_pavilion[1] + 2.85f * sinf(angle);
        } else { // by the path
            const float t = (float) (i - 46) / 17.0f;
            x = 1.9f - 3.4f * t + (i % 2 ? 1.15f : -1.05f);
            z = 6.3f - 6.0f * t;
        }
        const int node = add_swaying(g, on_ground(x, z, tau * shape_draw(&seed)), 0.05f, i);
        const int which = (i / 3) % 3;
        kit_show(&g->k, "stalks", parts[which][0], node, (place){ 0 });
        kit_show(&g->k, "heads", parts[which][1], node, (place){ 0 });
    }
}

static void add_reeds(garden *g)
{
    shape s = { 0 };
    add_tufts(&s, 16, 0.30f, 0.75f, 61u);
    const int part = kit_part(&g->k, "reeds", &s, g->material[GARDEN_GRASS]);
    for (int i = 0; i < 11; ++i) {
        const float angle = -2.7f + 0.24f * (float) i;
        const float x = garden_pond[0] + 2.0f * cosf(angle),
                    z = garden_pond[1] + 2.0f * sinf(angle);
        const place at = { (double) x, (double) garden_water - 0.12, (double) z, 0.9 * i };
        kit_show(&g->k, "reeds", part, add_swaying(g, at, 0.04f, i), (place){ 0 });
    }
}

void garden_add_flowers(garden *g)
{
    add_grass(g);
    add_ferns(g);
    add_flowers(g);
    add_reeds(g);
}
