// SPDX-License-Identifier: MIT
#include "garden_priv.h"

#include <math.h>

// The pavilion, its lantern, the bench by the pond, and the moon.

#define PROFILE(array) .profile = (const float(*)[2]) array, .count = FG_COUNT(array)

static const float tau = 6.28318531f;
static const float period = 24.0f, day = 48.0f; // s

static int add_turned(garden *g, const char *name, garden_material material, shape_lathe_desc desc)
{
    shape s = { .tiling = 1.0f };
    shape_lathe(&s, &desc);
    return kit_part(&g->k, name, &s, g->material[material]);
}

void garden_add_pavilion(garden *g)
{
    static const float steps[][2] = { { 0, -0.4f },     { 2.3f, -0.4f },  { 2.3f, 0.14f },
                                      { 2.02f, 0.15f }, { 2.02f, 0.29f }, { 0, 0.30f } };
    static const float column[][2] = {
        { 0, 0.28f },      { 0.21f, 0.28f }, { 0.21f, 0.36f }, { 0.19f, 0.38f },  { 0.20f, 0.42f },
        { 0.17f, 0.45f },  { 0.14f, 0.48f }, { 0.14f, 1.40f }, { 0.118f, 2.55f }, { 0.135f, 2.57f },
        { 0.135f, 2.60f }, { 0.20f, 2.68f }, { 0.20f, 2.76f }, { 0, 2.76f },
    };
    static const float ring[][2] = {
        { 1.56f, 2.74f }, { 1.98f, 2.74f }, { 1.98f, 2.95f }, { 2.02f, 2.98f },
        { 2.14f, 3.08f }, { 2.14f, 3.14f }, { 1.56f, 3.14f }, { 1.56f, 2.74f },
    };
    static const float dome[][2] = {
        { 0, 4.10f },     { 0.55f, 4.04f }, { 1.05f, 3.82f }, { 1.42f, 3.48f }, { 1.56f, 3.10f },
        { 1.98f, 3.10f }, { 1.90f, 3.40f }, { 1.62f, 3.80f }, { 1.20f, 4.12f }, { 0.66f, 4.32f },
        { 0.16f, 4.40f }, { 0.12f, 4.48f }, { 0.15f, 4.55f }, { 0.10f, 4.64f }, { 0, 4.68f },
    };
    const place at = { (double) garden_pavilion[0], 0, (double) garden_pavilion[1], 0 };
    const int root = kit_show(
        &g->k, "steps",
        add_turned(g, "steps", GARDEN_LIMESTONE, (shape_lathe_desc){ PROFILE(steps), 48 }), -1, at);
    const int shaft = add_turned(g, "column", GARDEN_LIMESTONE,
                                 (shape_lathe_desc){ PROFILE(column), 60, 20, 0.05f });
    for (int i = 0; i < 8; ++i) {
        const float angle = tau * ((float) i + 0.5f) / 8.0f;
        kit_show(
            &g->k, "column", shaft, root,
            (place){ (double) (1.77f * cosf(angle)), 0, (double) (1.77f * sinf(angle)), 0.3 * i });
    }
    kit_show(&g->k, "ring",
             add_turned(g, "ring", GARDEN_LIMESTONE, (shape_lathe_desc){ PROFILE(ring), 64 }), root,
             (place){ 0 });
    kit_show(&g->k, "dome",
             add_turned(g, "dome", GARDEN_CLAY, (shape_lathe_desc){ PROFILE(dome), 64 }), root,
             (place){ 0 });

    shape s = { .tiling = 1.0f };
    shape_box(&s, (float[3]){ -0.85f, 0.40f, -0.21f }, (float[3]){ 0.85f, 0.48f, 0.21f });
    for (int i = 0; i < 2; ++i) {
        const float x = i ? 0.50f : -0.68f;
        shape_box(&s, (float[3]){ x, -0.15f, -0.17f }, (float[3]){ x + 0.18f, 0.41f, 0.17f });
    }
    kit_show(&g->k, "bench", kit_part(&g->k, "bench", &s, g->material[GARDEN_LIMESTONE]), -1,
             (place){ 5.05, 0, 2.05, -0.75 });
}

// ---- light -------------------------------------------------------------------------------

// From the dome's middle on a chain; the light goes down out of it.
static void add_lantern(garden *g)
{
    static const float body[][2] = {
        { 0.10f, -1.20f }, { 0.16f, -1.20f }, { 0.17f, -1.18f },
        { 0.15f, -0.92f }, { 0.19f, -0.90f }, { 0.19f, -0.88f },
        { 0.10f, -0.78f }, { 0.04f, -0.72f }, { 0, -0.70f },
    };
    static const float links[2][3] = { { 0, -0.72f, 0 }, { 0, 0.02f, 0 } };
    const shape_tube_desc chain = { .path = links, .count = 2, .radius = 0.01f, .segments = 6 };
    const shape_lathe_desc lathe = { PROFILE(body), 24 };
    shape s = { .tiling = 1.0f };
    shape_lathe(&s, &lathe);
    shape_tube(&s, &chain);
    const int hook =
        kit_node(&g->k, "lantern hook", -1,
                 (place){ (double) garden_pavilion[0], 4.1, (double) garden_pavilion[1], 0 });
    const int node =
        kit_show(&g->k, "lantern", kit_part(&g->k, "lantern", &s, g->material[GARDEN_BRASS]), hook,
                 (place){ 0 });
    const kit_swing_desc swing = { .axis = 0, .amplitude = 0.10f, .seconds = period, .count = 11 };
    kit_swing(&g->k, node, &swing);
    ag_node_desc flame = { .name = "lantern light",
                           .parent = node,
                           .translation = { 0, -1.15, 0 } };
    kit_turn(0, -1.57079632679489661923, flame.rotation); // -Z down
    const ag_light spot = {
        .name = "lantern",
        .kind = AG_LIGHT_SPOT,
        .intensity = { 66.0f, 39.0f, 16.0f }, // W/sr
        .cos_inner = cosf(0.50f),
        .cos_outer = cosf(0.77f),
    };
    ag_builder_light(g->k.builder, ag_builder_node(g->k.builder, &flame), &spot);
}

// An hour or two to and fro, while the moon is high.
static void moon_turn(const void *user, float t, float out[4])
{
    (void) user;
    const double around = 0.55 + 0.30 * (double) sinf(tau * t),
                 height = 0.72 + 0.08 * (double) cosf(tau * t);
    const double direction[3] = { sin(around) * cos(height), -sin(height),
                                  -cos(around) * cos(height) };
    kit_aim_curve(direction, out);
}

// Nothing shines from the sky, which therefore is a night's. A moon as bright as this one is an
// exposure that is long.
static void add_moon(garden *g)
{
    const int node = kit_node(&g->k, "moon", -1, (place){ 0, 8, 0, 0 });
    const kit_motion m = {
        .node = node, .path = AG_PATH_ROTATION, .keys = 65, .seconds = day, .curve = moon_turn
    };
    const ag_light moon = {
        .name = "moon", .kind = AG_LIGHT_DIRECTIONAL, .intensity = { 4.0f, 4.9f, 6.4f }, // W/m^2
    };
    kit_move(&g->k, &m);
    ag_builder_light(g->k.builder, node, &moon);
}

void garden_add_light(garden *g)
{
    add_moon(g);
    add_lantern(g);
}
