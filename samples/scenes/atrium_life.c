// SPDX-License-Identifier: MIT
#include "atrium_priv.h"

#include <math.h>

// What moves: four lamps swing on their chains, and the light sweeps along the court. All of it
// repeats after one period.

enum { LIGHT_KEYS = 49 };
static const float period = 24.0f; // s; ten swings of a lamp
static const float tau = 6.28318531f;

#define PROFILE(array) (const float(*)[2]) array, FG_COUNT(array)

static int add_lamp_part(atrium *a)
{
    // From the hook at the origin downwards.
    static const float body[][2] = {
        { 0, -1.28f },     { 0.05f, -1.26f }, { 0.06f, -1.22f }, { 0.04f, -1.19f },
        { 0.15f, -1.13f }, { 0.17f, -1.10f }, { 0.14f, -1.08f }, { 0.19f, -0.86f },
        { 0.22f, -0.84f }, { 0.22f, -0.81f }, { 0.17f, -0.79f }, { 0.10f, -0.70f },
        { 0.05f, -0.66f }, { 0.05f, -0.62f }, { 0, -0.60f },
    };
    static const float chain[2][3] = { { 0, -0.62f, 0 }, { 0, 0.02f, 0 } };
    const shape_lathe_desc lantern = { PROFILE(body), 24, 8, 0.12f };
    const shape_tube_desc rod = { .path = chain, .count = 2, .radius = 0.012f, .segments = 6 };
    shape s = { 0 };
    shape_lathe(&s, &lantern);
    shape_tube(&s, &rod);
    return kit_part(&a->k, "lamp", &s, a->material[ATRIUM_BRASS]);
}

static void add_lamps(atrium *a)
{
    static const struct {
        int side, bay;
    } where[] = { { 0, 2 }, { 0, 5 }, { 2, 3 }, { 1, 1 } };
    const int part = add_lamp_part(a);
    for (int i = 0; i < FG_COUNT(where); ++i) {
        const place hook = { atrium_bay_centre(where[i].side, where[i].bay), 4.1,
                             atrium_distance(where[i].side), 0 };
        const int fixed = kit_node(&a->k, "lamp hook", a->side[where[i].side], hook);
        const int node = kit_show(&a->k, "lamp", part, fixed, (place){ 0 });
        const kit_swing_desc swing = { .amplitude = 0.16f + 0.03f * (float) i,
                                       .phase = 0.15f + 0.21f * (float) i,
                                       .seconds = period,
                                       .count = 10 };
        kit_swing(&a->k, node, &swing);
    }
}

// The pivot runs to and fro along the court, the light turns around it.
static void sun_along(const void *user, float t, float out[4])
{
    (void) user;
    out[0] = 0.5f + 3.0f * sinf(tau * t);
    out[1] = 0.0f;
    out[2] = 1.2f;
}

static void sun_around(const void *user, float t, float out[4])
{
    double q[4];
    (void) user;
    kit_turn(1, (double) (0.30f + 0.35f * sinf(tau * t)), q);
    for (int k = 0; k < 4; ++k)
        out[k] = (float) q[k];
}

static void sweep(atrium *a, int pivot)
{
    kit_motion m = { .node = pivot,
                     .path = AG_PATH_TRANSLATION,
                     .keys = LIGHT_KEYS,
                     .seconds = period,
                     .curve = sun_along };
    kit_move(&a->k, &m);
    m.path = AG_PATH_ROTATION;
    m.curve = sun_around;
    kit_move(&a->k, &m);
}

// A spot high above the north side's roof: about 6 W/m^2 on the court's floor.
static void add_light(atrium *a)
{
    const double from[3] = { 0, 19.0, -7.6 };
    const int pivot = kit_node(&a->k, "sun pivot", -1, (place){ 0.5, 0, 1.2, 0 });
    ag_node_desc arm = { .name = "sun",
                         .parent = pivot,
                         .translation = { from[0], from[1], from[2] } };
    kit_aim((const double[3]){ -from[0], 2.2 - from[1], -from[2] }, arm.rotation);
    const int node = ag_builder_node(a->k.builder, &arm);
    const ag_light spot = {
        .name = "sun",
        .kind = AG_LIGHT_SPOT,
        .intensity = { 2600.0f, 2410.0f, 2080.0f }, // W/sr
        .cos_inner = cosf(0.36f),
        .cos_outer = cosf(0.44f),
    };
    ag_builder_light(a->k.builder, node, &spot);
    sweep(a, pivot);
}

void atrium_add_life(atrium *a)
{
    add_lamps(a);
    add_light(a);
}
