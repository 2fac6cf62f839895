// SPDX-License-Identifier: MIT
#include "garden_priv.h"

#include <math.h>

// Hedges, ivy and trees.

static const float tau = 6.28318531f;
static const float period = 24.0f; // s

// ---- hedges ------------------------------------------------------------------------------

// Cards all over a box around the origin that stands on y = 0.
static int add_hedge_part(garden *g, const float half[3], int count, float card, uint32_t seed)
{
    shape s = { 0 };
    for (int i = 0; i < count; ++i) {
        // A point of the surface but its foot, by area; the top a little uneven.
        const float sides[3] = { 4.0f * half[1] * half[2], 4.0f * half[0] * half[2],
                                 4.0f * half[0] * half[1] };
        const float pick = shape_draw(&seed) * (2.0f * sides[0] + sides[1] + 2.0f * sides[2]);
        const int axis = pick < 2.0f * sides[0] ? 0 : pick < 2.0f * sides[0] + sides[1] ? 1 : 2;
        const float sign = axis == 1 || shape_draw(&seed) < 0.5f ? 1.0f : -1.0f;
        float at[3], normal[3] = { 0, 0.2f, 0 };
        for (int k = 0; k < 3; ++k)
            at[k] = half[k] * (2.0f * shape_draw(&seed) - 1.0f);
        at[axis] = sign * (half[axis] - 0.04f + 0.08f * shape_draw(&seed));
        normal[axis] = sign;
        normal[0] += 0.01f;
        at[1] += half[1];
        shape_card(&s, at, normal, card, &seed);
    }
    return kit_part(&g->k, "hedge", &s, g->material[GARDEN_BOX]);
}

static int add_core_part(garden *g, const float half[3])
{
    const float in = 0.07f;
    shape s = { 0 };
    shape_box(&s, (float[3]){ -half[0] + in, -0.2f, -half[2] + in },
              (float[3]){ half[0] - in, 2.0f * half[1] - in, half[2] - in });
    return kit_part(&g->k, "hedge core", &s, g->material[GARDEN_SHADE]);
}

static void show_hedge(garden *g, const int parts[2], place at)
{
    const int node = kit_show(&g->k, "hedge", parts[0], -1, at);
    kit_show(&g->k, "hedge core", parts[1], node, (place){ 0 });
}

void garden_add_hedges(garden *g)
{
    static const float tall[3] = { 1.3f, 1.15f, 0.42f }, low[3] = { 0.95f, 0.30f, 0.22f };
    static const place beds[] = {
        { 2.5, 0, 6.4, 1.9 },  { 2.0, 0, 5.2, 2.3 },   { -0.2, 0, 6.6, 1.35 },
        { -1.2, 0, 4.7, 1.1 }, { 6.9, 0, -3.3, 1.57 }, { 6.9, 0, -1.3, 1.57 },
    };
    const int high[2] = { add_hedge_part(g, tall, 700, 0.34f, 3u), add_core_part(g, tall) };
    const int edge[2] = { add_hedge_part(g, low, 360, 0.17f, 4u), add_core_part(g, low) };
    for (int i = 0; i < 6; ++i) // the east
        show_hedge(g, high, (place){ (double) garden_half_x, 0, -6.2 + 2.5 * i, 1.57079633 });
    for (int i = 0; i < 8; ++i) { // the south, but for the gate
        const double x = -8.7 + 2.5 * i;
        if (i != 4)
            show_hedge(g, high, (place){ x, 0, (double) garden_half_z, 3.14159265 * (i % 2) });
    }
    for (int i = 0; i < FG_COUNT(beds); ++i)
        show_hedge(g, edge, beds[i]);

    // Ivy over the northern wall, in three cascades; it hangs over the coping.
    uint32_t state = 71u;
    shape s = { 0 };
    for (int i = 0; i < 2600; ++i) {
        static const float middles[3] = { -8.2f, -0.4f, 6.6f };
        const int which = (int) (3.0f * shape_draw(&state));
        const float high_up = 1.0f - shape_draw(&state) * shape_draw(&state);
        const float wide =
            (shape_draw(&state) + shape_draw(&state) - 1.0f) * (1.1f + 2.2f * high_up);
        const float at[3] = { middles[which] + wide, 2.95f * high_up,
                              -garden_half_z + 0.10f + 0.10f * shape_draw(&state) };
        if (at[0] > -garden_half_x + 0.15f && at[0] < garden_half_x - 0.6f)
            shape_card(&s, at, (float[3]){ 0, 0.25f, 1 }, 0.27f, &state);
    }
    kit_show(&g->k, "ivy", kit_part(&g->k, "ivy", &s, g->material[GARDEN_IVY]), -1, (place){ 0 });
}

// ---- trees -------------------------------------------------------------------------------

// A trunk that forks into five boughs, on roots; bough 0 is nearly level and bears the swing.
static const float boughs[5][2][3] = {
    { { 0.02f, 1.95f, 0.0f }, { 1.75f, 2.85f, 0.25f } },
    { { 0.0f, 2.0f, 0.05f }, { 0.55f, 3.5f, 1.0f } },
    { { -0.03f, 1.9f, 0.05f }, { -1.05f, 3.1f, 0.75f } },
    { { -0.03f, 2.0f, -0.03f }, { -0.75f, 3.6f, -0.85f } },
    { { 0.03f, 2.1f, -0.05f }, { 0.6f, 3.3f, -1.1f } },
};

static float trunk(const void *user, const float p[3])
{
    static const float foot[3] = { 0, -0.2f, 0 }, fork[3] = { 0.03f, 2.0f, 0.02f };
    (void) user;
    const float grooves = 0.012f * sinf(9.0f * atan2f(p[2], p[0]) + 1.5f * p[1]);
    float d = field_bar(p, foot, fork, 0.23f, 0.165f) + grooves;
    for (int i = 0; i < 5; ++i)
        d = field_join(d, field_bar(p, boughs[i][0], boughs[i][1], 0.115f, 0.045f), 0.14f);
    for (int i = 0; i < 5 && p[1] < 0.6f; ++i) {
        const float angle = tau * (float) i / 5.0f + 0.4f;
        const float a[3] = { 0.1f * cosf(angle), 0.12f, 0.1f * sinf(angle) };
        const float b[3] = { 0.62f * cosf(angle), -0.08f, 0.62f * sinf(angle) };
        d = field_join(d, field_bar(p, a, b, 0.12f, 0.05f), 0.14f);
    }
    return d;
}

static int add_trunk_part(garden *g)
{
    const shape_field_desc wood = { .field = trunk,
                                    .lo = { -1.3f, -0.35f, -1.35f },
                                    .hi = { 1.95f, 3.85f, 1.3f },
                                    .cell = 0.085f,
                                    .steepest = 1.4f };
    shape s = { .tiling = 0.6f };
    shape_field(&s, &wood);
    return kit_part(&g->k, "trunk", &s, g->material[GARDEN_BARK]);
}

// The leaves around the ends of boughs `from` to `to` - 1, and above the middle.
static int add_crown_part(garden *g, int from, int to, bool top, uint32_t seed)
{
    shape s = { 0 };
    for (int i = from; i < to; ++i) {
        const float *end = boughs[i][1];
        shape_crown(&s, &(shape_crown_desc){ { 0.92f * end[0], end[1] + 0.35f, 0.92f * end[2] },
                                             { 0.95f, 0.70f, 0.95f },
                                             0.42f,
                                             420,
                                             seed + 10u * (uint32_t) i });
    }
    if (top)
        shape_crown(
            &s, &(shape_crown_desc){ { 0, 4.1f, 0 }, { 1.05f, 0.75f, 1.05f }, 0.42f, 480, seed });
    return kit_part(&g->k, "crown", &s, g->material[GARDEN_LEAVES]);
}

// A tree that nobody comes near, of few large cards: its boughs, or its leaves.
static int add_far_part(garden *g, bool wood)
{
    shape s = { .tiling = 0.6f };
    for (int i = 0; i < 5; ++i) {
        const float path[3][3] = { { 0, -0.6f, 0 },
                                   { boughs[i][0][0], boughs[i][0][1], boughs[i][0][2] },
                                   { boughs[i][1][0], boughs[i][1][1], boughs[i][1][2] } };
        if (wood)
            shape_tube(&s, &(shape_tube_desc){ path, 3, 0.11f, 8 });
        else
            shape_crown(&s, &(shape_crown_desc){ { path[2][0], path[2][1] + 0.4f, path[2][2] },
                                                 { 1.05f, 0.80f, 1.05f },
                                                 0.62f,
                                                 130,
                                                 50u + (uint32_t) i });
    }
    return kit_part(&g->k, "far tree", &s, g->material[wood ? GARDEN_BARK : GARDEN_LEAVES]);
}

static void add_swing(garden *g, int tree)
{
    static const float ropes[2][2][3] = { { { 0, 0.03f, -0.24f }, { 0, -2.15f, -0.24f } },
                                          { { 0, 0.03f, 0.24f }, { 0, -2.15f, 0.24f } } };
    shape rope = { 0 }, seat = { .tiling = 1.0f };
    for (int i = 0; i < 2; ++i) {
        const shape_tube_desc tube = {
            .path = ropes[i], .count = 2, .radius = 0.014f, .segments = 8
        };
        shape_tube(&rope, &tube);
    }
    shape_box(&seat, (float[3]){ -0.13f, -2.18f, -0.32f }, (float[3]){ 0.13f, -2.14f, 0.32f });
    const int node = kit_node(&g->k, "bough", tree, (place){ 1.25, 2.56, 0.18, 0.1 });
    const int ropes_node =
        kit_show(&g->k, "ropes", kit_part(&g->k, "ropes", &rope, g->material[GARDEN_BRASS]), node,
                 (place){ 0 });
    kit_show(&g->k, "seat", kit_part(&g->k, "seat", &seat, g->material[GARDEN_WOOD]), ropes_node,
             (place){ 0 });
    const kit_swing_desc swing = { .axis = 2, .amplitude = 0.30f, .seconds = period, .count = 8 };
    kit_swing(&g->k, ropes_node, &swing);
}

// All crowns are half at rest and half swaying, so that what is kept for surfaces at rest has
// leaves to deal with.
void garden_add_trees(garden *g)
{
    static const place where[] = {
        { -8.0, 0, -5.3, 0.4 }, { -7.0, 0, 3.0, -0.9 }, { 7.6, 0, -5.4, 2.2 },
        { 7.4, 0, 2.9, 2.9 },   { 5.0, 0, 6.1, 1.2 },   { -4.2, 0, 6.0, 4.4 },
    };
    // Outside, over the walls and hedges.
    static const place beyond[] = {
        { -8.6, 0.3, -10.2, 5.1 }, { -5.2, 0.9, -11.0, 1.9 }, { -1.4, 0.6, -10.4, 0.2 },
        { 2.4, 1.1, -10.9, 3.3 },  { 5.9, 0.5, -10.3, 4.0 },  { 9.6, 0.8, -9.8, 2.6 },
        { -12.9, 0.6, -2.6, 0.9 }, { -12.6, 0.2, 1.6, 3.7 },  { -12.9, 0.7, 6.4, 5.6 },
        { 12.6, 0.4, -2.0, 1.3 },  { 12.9, 0.8, 2.2, 4.9 },   { 12.4, 0.3, 6.6, 2.3 },
    };
    const int wood = add_trunk_part(g);
    const int still = add_crown_part(g, 0, 3, false, 7u), loose = add_crown_part(g, 3, 5, true, 8u);
    for (int i = 0; i < FG_COUNT(where); ++i) {
        place at = where[i];
        at.y = (double) garden_ground((float) at.x, (float) at.z);
        const int tree = kit_show(&g->k, "tree", wood, -1, at);
        kit_show(&g->k, "crown", still, tree, (place){ 0 });
        const int fork = kit_node(&g->k, "fork", tree, (place){ 0, 1.9, 0, 0.9 * i });
        const int moved = kit_node(&g->k, "sway", fork, (place){ 0 });
        kit_show(&g->k, "loose crown", loose, moved, (place){ 0, -1.9, 0, -0.9 * i });
        const kit_swing_desc sway = { .axis = i % 2 ? 2 : 0,
                                      .amplitude = 0.022f,
                                      .phase = 0.17f * (float) i,
                                      .seconds = period,
                                      .count = 6 };
        kit_swing(&g->k, moved, &sway);
        if (i == 1)
            add_swing(g, tree);
    }
    const int trunks = add_far_part(g, true), crowns = add_far_part(g, false);
    for (int i = 0; i < FG_COUNT(beyond); ++i) {
        const int tree = kit_show(&g->k, "far tree", trunks, -1, beyond[i]);
        kit_show(&g->k, "far crown", crowns, tree, (place){ 0 });
    }
}
