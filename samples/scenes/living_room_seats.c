// SPDX-License-Identifier: MIT
// Where people sit: sofa, armchair, the rug and the tables between them.
#include "living_room_priv.h"

#include <math.h>

static void soft(shape *s, const float lo[3], const float hi[3], float radius)
{
    shape_round_box(s, lo, hi, radius, 5);
}

// A seat for `places` that looks along -z, its middle at the origin.
static void add_seat(living_room *r, const char *name, room_material cloth, int places, place at)
{
    const float wide = places > 1 ? 0.64f : 0.58f, half = 0.5f * wide * (float) places;
    const float arm = half + 0.20f;
    shape s = { .tiling = 1.0f / 0.6f }, feet = { .tiling = 1 };
    soft(&s, (float[3]){ -arm + 0.02f, 0.12f, -0.42f }, (float[3]){ arm - 0.02f, 0.32f, 0.45f },
         0.03f);
    soft(&s, (float[3]){ -arm + 0.03f, 0.25f, 0.26f }, (float[3]){ arm - 0.03f, 0.84f, 0.47f },
         0.07f);
    soft(&s, (float[3]){ -arm, 0.12f, -0.44f }, (float[3]){ -half, 0.62f, 0.46f }, 0.07f);
    soft(&s, (float[3]){ half, 0.12f, -0.44f }, (float[3]){ arm, 0.62f, 0.46f }, 0.07f);
    for (int i = 0; i < places; ++i) {
        const float x = -half + wide * (float) i + 0.006f, to = x + wide - 0.012f;
        soft(&s, (float[3]){ x, 0.31f, -0.46f }, (float[3]){ to, 0.47f, 0.27f }, 0.055f);
        soft(&s, (float[3]){ x + 0.02f, 0.44f, 0.12f }, (float[3]){ to - 0.02f, 0.90f, 0.30f },
             0.08f);
    }
    for (int i = 0; i < 4; ++i) {
        const float x = i % 2 ? arm - 0.12f : -arm + 0.06f, z = i / 2 ? 0.34f : -0.40f;
        shape_box(&feet, (float[3]){ x, 0, z }, (float[3]){ x + 0.06f, 0.13f, z + 0.06f });
    }
    const int node = room_put(r, name, &s, cloth, at);
    kit_show(&r->k, "feet", kit_part(&r->k, "feet", &feet, r->material[ROOM_DARK_WOOD]), node,
             (place){ 0 });
    // A cushion or two, thrown down.
    s.tiling = 1.0f / 0.4f;
    soft(&s, (float[3]){ -0.23f, -0.23f, -0.07f }, (float[3]){ 0.23f, 0.23f, 0.07f }, 0.07f);
    const int pillow = kit_part(&r->k, "pillow", &s, r->material[ROOM_PILLOW]);
    for (int i = 0; i < (places > 1 ? 2 : 1); ++i) {
        ag_node_desc lying = { .name = "pillow",
                               .parent = node,
                               .translation = { (i ? -1 : 1) * ((double) half - 0.28), 0.69,
                                                0.02 } };
        const double lean = 0.30, yaw = i ? 0.35 : -0.25;
        // Turned around +Y, leaning back.
        lying.rotation[0] = cos(0.5 * yaw) * sin(0.5 * lean);
        lying.rotation[1] = sin(0.5 * yaw) * cos(0.5 * lean);
        lying.rotation[2] = -sin(0.5 * yaw) * sin(0.5 * lean);
        lying.rotation[3] = cos(0.5 * yaw) * cos(0.5 * lean);
        ag_builder_show(r->k.builder, ag_builder_node(r->k.builder, &lying), pillow, -1);
    }
}

// One picture over its top.
static void add_rug(living_room *r)
{
    const float x = 1.45f, z = 1.0f, y = 0.012f;
    const float top[4][3] = { { -x, y, z }, { x, y, z }, { x, y, -z }, { -x, y, -z } };
    shape s = { 0 };
    shape_box(&s, (float[3]){ -x, -0.01f, -z }, (float[3]){ x, y - 0.001f, z });
    for (size_t i = 0; i < s.vertex_count; ++i)
        s.vertices[i].uv[0][0] = s.vertices[i].uv[0][1] = 0.01f;
    const size_t first = s.vertex_count;
    shape_quad(&s, top);
    for (size_t i = first; i < s.vertex_count; ++i) {
        s.vertices[i].uv[0][0] *= 0.5f / x;
        s.vertices[i].uv[0][1] *= 0.5f / z;
    }
    room_put(r, "rug", &s, ROOM_RUG, (place){ 0.5, 0, -0.02, 0 });
}

static void add_coffee_table(living_room *r)
{
    shape s = { .tiling = 1.0f };
    shape_round_box(&s, (float[3]){ -0.5f, 0.36f, -0.29f }, (float[3]){ 0.5f, 0.40f, 0.29f },
                    0.012f, 3);
    shape_box(&s, (float[3]){ -0.44f, 0.13f, -0.24f }, (float[3]){ 0.44f, 0.15f, 0.24f });
    for (int i = 0; i < 4; ++i) {
        const float x = i % 2 ? 0.40f : -0.45f, z = i / 2 ? 0.20f : -0.25f;
        shape_box(&s, (float[3]){ x, 0, z }, (float[3]){ x + 0.05f, 0.365f, z + 0.05f });
    }
    const place at = { 0.5, 0.012, -0.02, 0 };
    const int node = room_put(r, "coffee table", &s, ROOM_DARK_WOOD, at);
    static const float bowl[][2] = { { 0, 0 },           { 0.06f, 0 },       { 0.065f, 0.008f },
                                     { 0.11f, 0.035f },  { 0.14f, 0.075f },  { 0.143f, 0.08f },
                                     { 0.136f, 0.078f }, { 0.105f, 0.045f }, { 0.06f, 0.02f },
                                     { 0, 0.016f } };
    static const float mug[][2] = { { 0, 0 },          { 0.036f, 0 },      { 0.04f, 0.004f },
                                    { 0.04f, 0.09f },  { 0.038f, 0.092f }, { 0.036f, 0.09f },
                                    { 0.036f, 0.01f }, { 0, 0.008f } };
    const shape_lathe_desc turned[2] = { { bowl, FG_COUNT(bowl), 32, 0, 0 },
                                         { mug, FG_COUNT(mug), 24, 0, 0 } };
    shape_lathe(&s, &turned[0]);
    shape_move(&s, 0, (float[3]){ -0.18f, 0.4f, 0.05f }, 0);
    const size_t first = s.vertex_count;
    shape_lathe(&s, &turned[1]);
    shape_move(&s, first, (float[3]){ 0.28f, 0.4f, 0.14f }, 0);
    kit_show(&r->k, "bowl", kit_part(&r->k, "bowl", &s, r->material[ROOM_PORCELAIN]), node,
             (place){ 0 });
    static const float oranges[4][3] = { { -0.21f, 0.465f, 0.02f },
                                         { -0.13f, 0.465f, 0.06f },
                                         { -0.20f, 0.465f, 0.10f },
                                         { -0.175f, 0.52f, 0.06f } };
    static const float covers[3][3] = { { 0.55f, 0.10f, 0.07f },
                                        { 0.10f, 0.22f, 0.38f },
                                        { 0.70f, 0.62f, 0.42f } };
    for (int i = 0; i < 4; ++i)
        shape_sphere(&s, oranges[i], 0.042f, 20);
    shape_paint(&s, 0, (float[3]){ 0.85f, 0.33f, 0.04f });
    for (int i = 0; i < 3; ++i) {
        const size_t book = s.vertex_count;
        const float y = 0.4f + 0.028f * (float) i;
        shape_box(&s, (float[3]){ -0.13f + 0.01f * (float) i, y, -0.09f },
                  (float[3]){ 0.13f, y + 0.028f, 0.09f });
        shape_move(&s, book, (float[3]){ 0.22f, 0, -0.12f }, 0.25f * (float) i - 0.2f);
        shape_paint(&s, book, covers[i]);
    }
    kit_show(&r->k, "books", kit_part(&r->k, "books", &s, r->material[ROOM_BOOKS]), node,
             (place){ 0 });
}

void room_add_seats(living_room *r)
{
    add_seat(r, "sofa", ROOM_SOFA, 3, (place){ 0.5, 0, 1.42, 0 });
    // Turned to the table and the television.
    add_seat(r, "armchair", ROOM_ARMCHAIR, 1, (place){ 2.25, 0, -0.75, 2.0 });
    add_rug(r);
    add_coffee_table(r);
}
