// SPDX-License-Identifier: MIT
#include "atrium_priv.h"

#include <math.h>

// What moves: four lamps swing on their chains, and the light sweeps along the court. All of it
// repeats after one period, on keys that a linear interpolation follows closely.

enum { LAMP_KEYS = 161, LIGHT_KEYS = 49 };
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

// Swings `node` across its arch, starting at `phase` of a swing of 2.4 s.
static void swing(atrium *a, int node, float amplitude, float phase)
{
    float times[LAMP_KEYS], values[4 * LAMP_KEYS];
    for (int i = 0; i < LAMP_KEYS; ++i) {
        const float t = (float) i / (float) (LAMP_KEYS - 1);
        double q[4];
        kit_turn(0, (double) (amplitude * sinf(tau * (10.0f * t + phase))), q);
        times[i] = period * t;
        for (int k = 0; k < 4; ++k)
            values[4 * i + k] = (float) q[k];
    }
    const ag_channel_desc channel = { .node = node,
                                      .path = AG_PATH_ROTATION,
                                      .interpolation = AG_INTERPOLATE_LINEAR,
                                      .key_count = LAMP_KEYS,
                                      .times = times,
                                      .values = values };
    ag_builder_channel(a->k.builder, &channel);
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
        swing(a, node, 0.16f + 0.03f * (float) i, 0.15f + 0.21f * (float) i);
    }
}

// The pivot runs to and fro along the court, the light turns around it.
static void sweep(atrium *a, int pivot)
{
    float times[LIGHT_KEYS], along[3 * LIGHT_KEYS], turn[4 * LIGHT_KEYS];
    for (int i = 0; i < LIGHT_KEYS; ++i) {
        const float t = (float) i / (float) (LIGHT_KEYS - 1);
        double q[4];
        times[i] = period * t;
        float *to = along + 3 * (ptrdiff_t) i;
        to[0] = 0.5f + 3.0f * sinf(tau * t);
        to[1] = 0.0f;
        to[2] = 1.2f;
        kit_turn(1, (double) (0.30f + 0.35f * sinf(tau * t)), q);
        for (int k = 0; k < 4; ++k)
            turn[4 * i + k] = (float) q[k];
    }
    ag_channel_desc channel = { .node = pivot,
                                .path = AG_PATH_TRANSLATION,
                                .interpolation = AG_INTERPOLATE_LINEAR,
                                .key_count = LIGHT_KEYS,
                                .times = times,
                                .values = along };
    ag_builder_channel(a->k.builder, &channel);
    channel.path = AG_PATH_ROTATION;
    channel.values = turn;
    ag_builder_channel(a->k.builder, &channel);
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
