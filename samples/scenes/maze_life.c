// SPDX-License-Identifier: MIT
#include "maze_priv.h"

#include <math.h>

// What stands and hangs about, and what moves: a door, two censers on chains, the sun over the
// roof.

#define PROFILE(array) .profile = (const float(*)[2]) array, .count = FG_COUNT(array)

static const float tau = 6.28318531f;
static const double quarter = 1.57079632679489661923;
static const float period = 24.0f, round_time = 36.0f; // s; the second is the camera's

static int add_turned(maze *m, const char *name, maze_material material, shape_lathe_desc desc)
{
    shape s = { .tiling = 1.0f };
    shape_lathe(&s, &desc);
    return kit_part(&m->k, name, &s, m->material[material]);
}

// ---- what stands -------------------------------------------------------------------------

// Across a corridor, from wall to wall, on brackets.
static int add_beam_part(maze *m, float half)
{
    shape s = { .tiling = 1.0f };
    shape_box(&s, (float[3]){ -0.08f, 2.98f, -half - 0.02f },
              (float[3]){ 0.08f, 3.22f, half + 0.02f });
    for (int i = 0; i < 2; ++i) {
        const float z = i ? half - 0.12f : -half - 0.02f;
        shape_box(&s, (float[3]){ -0.11f, 2.80f, z }, (float[3]){ 0.11f, 3.0f, z + 0.14f });
    }
    return kit_part(&m->k, "beam", &s, m->material[MAZE_WOOD]);
}

static void add_beams(maze *m)
{
    // Legs along x, then along z: the other axis' cell, and from where to where.
    static const struct {
        int cell, from, to; // cells
        bool along_z;
    } legs[] = { { 0, 0, 5, false }, { 1, 1, 5, false }, { 2, 1, 5, false },
                 { 3, 4, 5, false }, { 4, 4, 5, false }, { 0, 1, 3, true } };
    const int part = add_beam_part(m, 0.5f * maze_cell);
    for (int i = 0; i < FG_COUNT(legs); ++i) {
        const double across = (double) maze_middle(legs[i].cell);
        for (int c = legs[i].from; c <= legs[i].to; ++c)
            for (int k = -1; k <= 1; k += 2) {
                const double along = (double) maze_middle(c) + 0.55 * k;
                const place x = { along, 0, across, 0 }, z = { across, 0, along, quarter };
                kit_show(&m->k, "beam", part, -1, legs[i].along_z ? z : x);
            }
    }
    // Through the whole of the statue's hall.
    const int wide = add_beam_part(m, maze_cell + 0.5f * maze_wall);
    for (int i = 0; i < 4; ++i)
        kit_show(&m->k, "beam", wide, -1,
                 (place){ (double) maze_line(9) + 0.6 + 1.2 * i, 0, (double) maze_line(8) + 0.2 });
}

static void add_jars(maze *m)
{
    static const float pithos[][2] = {
        { 0, 0 },         { 0.19f, 0 },      { 0.21f, 0.03f }, { 0.26f, 0.20f }, { 0.36f, 0.50f },
        { 0.40f, 0.78f }, { 0.385f, 0.98f }, { 0.31f, 1.14f }, { 0.25f, 1.19f }, { 0.27f, 1.23f },
        { 0.31f, 1.25f }, { 0.31f, 1.29f },  { 0.27f, 1.30f }, { 0.23f, 1.24f }, { 0.23f, 1.19f },
        { 0.28f, 1.12f }, { 0.35f, 0.95f },  { 0.33f, 0.60f }, { 0, 0.12f },
    };
    static const float krater[][2] = {
        { 0, 0 },         { 0.16f, 0 },      { 0.17f, 0.03f },  { 0.08f, 0.08f }, { 0.07f, 0.12f },
        { 0.16f, 0.20f }, { 0.24f, 0.34f },  { 0.25f, 0.46f },  { 0.22f, 0.56f }, { 0.21f, 0.62f },
        { 0.27f, 0.68f }, { 0.275f, 0.70f }, { 0.255f, 0.70f }, { 0.19f, 0.62f }, { 0, 0.30f },
    };
    static const struct {
        double x, z;
        int krater;
    } where[] = {
        { 15.2, 6.1, 0 },   { 13.6, 8.6, 1 },  { 15.1, 8.4, 0 }, { 15.2, 12.5, 0 },
        { 14.55, 12.6, 1 }, { 3.5, 7.15, 0 },  { 8.7, 5.85, 1 }, { 15.1, 3.4, 0 },
        { 15.2, 4.3, 0 },   { 14.4, 4.55, 1 }, { 15.1, 0.9, 0 }, { 14.9, 1.9, 1 },
        { 0.85, 0.85, 0 },  { 0.75, 6.4, 1 },  { 2.25, 3.3, 0 },
    };
    const int jar = add_turned(m, "pithos", MAZE_CLAY, (shape_lathe_desc){ PROFILE(pithos), 32 });
    const int bowl = add_turned(m, "krater", MAZE_CLAY, (shape_lathe_desc){ PROFILE(krater), 28 });
    for (int i = 0; i < FG_COUNT(where); ++i)
        kit_show(&m->k, "jar", where[i].krater ? bowl : jar, -1,
                 (place){ where[i].x, 0, where[i].z, 0.7 * i });
}

static void add_benches(maze *m)
{
    static const struct {
        double x, z, yaw;
    } where[] = {
        { 9.6, 7.05, 0 }, { 5.0, 5.95, 3.14159265 }, { 11.2, 2.28, 0 }, { 6.1, 2.28, 0 }
    };
    shape s = { .tiling = 1.0f };
    shape_box(&s, (float[3]){ -0.75f, 0.38f, 0.05f }, (float[3]){ 0.75f, 0.47f, 0.47f });
    for (int i = 0; i < 2; ++i) {
        const float x = i ? 0.42f : -0.60f;
        shape_box(&s, (float[3]){ x, -0.02f, 0.09f }, (float[3]){ x + 0.18f, 0.39f, 0.43f });
    }
    const int part = kit_part(&m->k, "bench", &s, m->material[MAZE_LIMESTONE]);
    for (int i = 0; i < FG_COUNT(where); ++i)
        kit_show(&m->k, "bench", part, -1,
                 (place){ where[i].x, 0, where[i].z, where[i].yaw + 3.14159265358979 });
}

// Rugs on the walls, a few centimetres off them, on rods.
static void add_hangings(maze *m)
{
    static const struct {
        double x, z, yaw;
        maze_material cloth;
    } where[] = { { 5.4, 0.50, 0, MAZE_OCHRE },
                  { 9.4, 0.50, 0, MAZE_RED },
                  { 7.0, 3.06, 0, MAZE_VIOLET },
                  { 8.0, 5.66, 0, MAZE_IVORY },
                  { 0.50, 4.6, 1.57079633, MAZE_BLUE } };
    static const float rod[2][3] = { { -0.75f, 0, 0 }, { 0.75f, 0, 0 } };
    const shape_tube_desc bar = { .path = rod, .count = 2, .radius = 0.02f, .segments = 10 };
    const shape_cloth_desc cloth = {
        .width = 1.3f, .height = 1.5f, .folds = 5, .depth = 0.03f, .phase = 0.6f, .nu = 50, .nv = 8
    };
    shape s = { .tiling = 1.0f };
    shape_tube(&s, &bar);
    const int brass = kit_part(&m->k, "rod", &s, m->material[MAZE_BRASS]);
    for (int i = 0; i < FG_COUNT(where); ++i) {
        shape c = { .tiling = 1.0f / 3.0f };
        shape_cloth(&c, &cloth);
        const int part = kit_part(&m->k, "hanging", &c, m->material[where[i].cloth]);
        const int node = kit_show(&m->k, "rod", brass, -1,
                                  (place){ where[i].x, 2.45, where[i].z, where[i].yaw });
        kit_show(&m->k, "hanging", part, node, (place){ 0 });
    }
}

void maze_add_furnishing(maze *m)
{
    add_beams(m);
    add_jars(m);
    add_benches(m);
    add_hangings(m);
}

// ---- what moves --------------------------------------------------------------------------

// Planks and bands, hinged at x = 0.
static int add_leaf_part(maze *m, maze_material material)
{
    shape s = { .tiling = 1.0f };
    if (material == MAZE_WOOD) {
        for (int i = 0; i < 6; ++i) {
            const float x = 0.03f + 0.265f * (float) i;
            shape_box(&s, (float[3]){ x, 0.03f, -0.03f }, (float[3]){ x + 0.255f, 1.95f, 0.03f });
        }
    } else {
        for (int i = 0; i < 3; ++i) {
            const float y = 0.25f + 0.68f * (float) i;
            shape_box(&s, (float[3]){ 0.0f, y, -0.042f }, (float[3]){ 1.58f, y + 0.09f, 0.042f });
        }
    }
    return kit_part(&m->k, "door", &s, m->material[material]);
}

// Between the statue's hall and the second leg: it lets more and less of the light through.
static void add_door(maze *m)
{
    const double x = (double) maze_middle(4) + 0.82, z = (double) maze_line(6) + 0.2;
    const int hinge = kit_node(&m->k, "hinge", -1, (place){ x, 0, z, -2.0 });
    const int leaf = kit_show(&m->k, "door", add_leaf_part(m, MAZE_WOOD), hinge, (place){ 0 });
    kit_show(&m->k, "bands", add_leaf_part(m, MAZE_BRASS), leaf, (place){ 0 });
    // Wide open whenever the camera "path" goes by: three swings to its round.
    const kit_swing_desc swing = {
        .axis = 1, .amplitude = 0.55f, .phase = 0.5f, .seconds = period, .count = 2
    };
    kit_swing(&m->k, leaf, &swing);
}

static void add_censers(maze *m)
{
    static const float body[][2] = {
        { 0, -1.02f },     { 0.05f, -1.00f }, { 0.10f, -0.95f }, { 0.135f, -0.88f },
        { 0.14f, -0.84f }, { 0.15f, -0.83f }, { 0.15f, -0.81f }, { 0.13f, -0.80f },
        { 0.11f, -0.73f }, { 0.06f, -0.66f }, { 0.03f, -0.62f }, { 0.035f, -0.59f },
        { 0, -0.56f },
    };
    static const float links[2][3] = { { 0, -0.58f, 0 }, { 0, 0.02f, 0 } };
    static const double where[][2] = { { 11.9, 9.6 }, { 9.4, 6.7 }, { 4.2, 1.5 } };
    const shape_lathe_desc vessel = { PROFILE(body), 32, 8, 0.10f };
    const shape_tube_desc chain = { .path = links, .count = 2, .radius = 0.01f, .segments = 6 };
    shape s = { .tiling = 1.0f };
    shape_lathe(&s, &vessel);
    shape_tube(&s, &chain);
    const int part = kit_part(&m->k, "censer", &s, m->material[MAZE_BRASS]);
    for (int i = 0; i < FG_COUNT(where); ++i) {
        const int hook =
            kit_node(&m->k, "hook", -1, (place){ where[i][0], 3.2, where[i][1], 0.8 * i });
        const int node = kit_show(&m->k, "censer", part, hook, (place){ 0 });
        const kit_swing_desc swing = {
            .axis = 2, .amplitude = 0.22f, .phase = 0.3f * (float) i, .seconds = period, .count = 12
        };
        kit_swing(&m->k, node, &swing);
    }
}

// At the statue's end of the first leg, to and fro, while the camera "path" is in its hall and
// beyond; along the whole leg and back while the camera returns.
static void sun_along(const void *user, float t, float out[4])
{
    static const float turn = 0.62f;
    (void) user;
    out[0] = t < turn ? 0.5f * (cosf(tau * t / turn) - 1.0f)
                      : 3.2f * (cosf(tau * (t - turn) / (1.0f - turn)) - 1.0f);
    out[1] = out[2] = 0.0f;
}

// High above the roof to the south, as far as the sun's shadows ask for: they fall on the north
// wall and the floor of the first leg, and nowhere else is light let in.
static void add_sun(maze *m)
{
    const double over = (double) maze_middle(3) + 0.4, aisle = (double) maze_middle(4);
    const double from[3] = { -5.0, 17.0, 5.0 };
    const int rail = kit_node(&m->k, "sun rail", -1, (place){ over, 0, aisle, 0 });
    const int runner = kit_node(&m->k, "sun runner", rail, (place){ 0 });
    ag_node_desc arm = { .name = "sun",
                         .parent = runner,
                         .translation = { from[0], from[1], from[2] } };
    kit_aim((const double[3]){ -from[0], 1.5 - from[1], -from[2] }, arm.rotation);
    const ag_light spot = {
        .name = "sun",
        .kind = AG_LIGHT_SPOT,
        .intensity = { 16000.0f, 14600.0f, 12400.0f }, // W/sr
        .cos_inner = cosf(0.13f),
        .cos_outer = cosf(0.16f),
    };
    const kit_motion motion = { .node = runner,
                                .path = AG_PATH_TRANSLATION,
                                .keys = 97,
                                .seconds = round_time,
                                .curve = sun_along };
    kit_move(&m->k, &motion);
    ag_builder_light(m->k.builder, ag_builder_node(m->k.builder, &arm), &spot);
}

void maze_add_life(maze *m)
{
    add_door(m);
    add_censers(m);
    add_sun(m);
}
