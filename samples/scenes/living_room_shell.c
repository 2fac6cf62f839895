// SPDX-License-Identifier: MIT
// Floor, walls, window and what hangs before it.
#include "living_room_priv.h"

#include <math.h>

// Walls are as thick as walls are: no light comes through where two of them meet.
static const float thick = 0.3f;

static void add_floor_and_ceiling(living_room *r)
{
    const float x = room_half_x + thick, z = room_half_z + thick;
    shape s = { .tiling = 1.0f / 1.2f };
    shape_box(&s, (float[3]){ -x, -0.2f, -z }, (float[3]){ x, 0.0f, z });
    room_put(r, "floor", &s, ROOM_PARQUET, (place){ 0 });
    shape_box(&s, (float[3]){ -x, room_height, -z }, (float[3]){ x, room_height + 0.2f, z });
    room_put(r, "ceiling", &s, ROOM_CEILING, (place){ 0 });
}

static void add_walls(living_room *r)
{
    const float x = room_half_x, z = room_half_z, h = room_height;
    const float *across = room_window[0], *up = room_window[1];
    shape s = { 0 };
    shape_box(&s, (float[3]){ -x - thick, 0, z }, (float[3]){ x + thick, h, z + thick });
    shape_box(&s, (float[3]){ -x - thick, 0, -z }, (float[3]){ -x, h, z });
    // Around the window.
    shape_box(&s, (float[3]){ x, 0, -z }, (float[3]){ x + thick, h, across[0] });
    shape_box(&s, (float[3]){ x, 0, across[1] }, (float[3]){ x + thick, h, z });
    shape_box(&s, (float[3]){ x, 0, across[0] }, (float[3]){ x + thick, up[0], across[1] });
    shape_box(&s, (float[3]){ x, up[1], across[0] }, (float[3]){ x + thick, h, across[1] });
    room_put(r, "walls", &s, ROOM_WALL, (place){ 0 });
    shape_box(&s, (float[3]){ -x - thick, 0, -z - thick }, (float[3]){ x + thick, h, -z });
    room_put(r, "accent wall", &s, ROOM_ACCENT, (place){ 0 });
}

// Skirting, cornice, a door in the wall at -X and the window's frame.
static void add_trim(living_room *r)
{
    const float x = room_half_x, z = room_half_z, y0 = room_window[1][0], y1 = room_window[1][1];
    const float z0 = room_window[0][0], z1 = room_window[0][1];
    static const float skirting[][2] = { { 0.01f, -0.01f },
                                         { 0.01f, 0.11f },
                                         { -0.012f, 0.11f },
                                         { -0.018f, 0.09f },
                                         { -0.018f, -0.01f } };
    static const float cornice[][2] = { { 0.01f, 2.60f },   { 0.01f, 2.71f },  { -0.10f, 2.71f },
                                        { -0.10f, 2.685f }, { -0.05f, 2.66f }, { -0.02f, 2.60f } };
    shape s = { 0 };
    shape_frame(&s, &(shape_frame_desc){ x, z, skirting, FG_COUNT(skirting) });
    shape_frame(&s, &(shape_frame_desc){ x, z, cornice, FG_COUNT(cornice) });
    const float mid = x + 0.16f, bar = 0.035f;
    shape_box(&s, (float[3]){ mid - 0.03f, y0, z0 }, (float[3]){ mid + 0.03f, y0 + 0.07f, z1 });
    shape_box(&s, (float[3]){ mid - 0.03f, y1 - 0.07f, z0 }, (float[3]){ mid + 0.03f, y1, z1 });
    for (int i = 0; i <= 3; ++i) {
        const float at = z0 + 0.035f + (z1 - z0 - 0.07f) * (float) i / 3.0f;
        shape_box(&s, (float[3]){ mid - 0.025f, y0 + 0.07f, at - bar },
                  (float[3]){ mid + 0.025f, y1 - 0.07f, at + bar });
    }
    shape_box(&s, (float[3]){ mid - 0.02f, 1.62f, z0 + 0.07f },
              (float[3]){ mid + 0.02f, 1.66f, z1 - 0.07f });
    shape_box(&s, (float[3]){ x - 0.12f, y0 - 0.04f, z0 - 0.08f },
              (float[3]){ x + 0.14f, y0 + 0.005f, z1 + 0.08f }); // sill
    room_put(r, "trim", &s, ROOM_WHITE, (place){ 0 });
    s.tiling = 1.0f;
    shape_box(&s, (float[3]){ -x - 0.02f, 0, 0.55f }, (float[3]){ -x + 0.03f, 2.05f, 1.45f });
    for (int i = 0; i < 4; ++i) {
        const float at = i % 2 ? 1.03f : 0.63f, low = i / 2 ? 1.10f : 0.16f;
        shape_box(&s, (float[3]){ -x, low, at },
                  (float[3]){ -x + 0.042f, low + (i / 2 ? 0.82f : 0.8f), at + 0.34f });
    }
    room_put(r, "door", &s, ROOM_OAK, (place){ 0 });
    shape_box(&s, (float[3]){ -x - 0.02f, 0, 0.46f }, (float[3]){ -x + 0.05f, 2.13f, 0.55f });
    shape_box(&s, (float[3]){ -x - 0.02f, 0, 1.45f }, (float[3]){ -x + 0.05f, 2.13f, 1.54f });
    shape_box(&s, (float[3]){ -x - 0.02f, 2.05f, 0.55f }, (float[3]){ -x + 0.05f, 2.13f, 1.45f });
    room_put(r, "door frame", &s, ROOM_WHITE, (place){ 0 });
    shape_sphere(&s, (float[3]){ -x + 0.085f, 1.02f, 0.62f }, 0.032f, 16);
    shape_box(&s, (float[3]){ -x + 0.02f, 1.01f, 0.61f }, (float[3]){ -x + 0.07f, 1.03f, 0.63f });
    room_put(r, "knob", &s, ROOM_BRASS, (place){ 0 });
}

// A card with the evening painted on it, far enough that the sun stands before it.
static void add_view(living_room *r)
{
    const float x = 11.0f,
                corners[4][3] = { { x, -4.5f, 9 }, { x, -4.5f, -9 }, { x, 8, -9 }, { x, 8, 9 } };
    shape s = { 0 };
    const uint32_t first = 0;
    const float normal[3] = { -1, 0, 0 };
    for (int i = 0; i < 4; ++i)
        shape_vertex(&s, corners[i], normal, i == 0 || i == 3 ? 1.0f : 0.0f, i < 2 ? 1.0f : 0.0f);
    if (!s.failed) {
        shape_triangle(&s, first, 2, 1);
        shape_triangle(&s, first, 3, 2);
    }
    room_put(r, "evening", &s, ROOM_EVENING, (place){ 0 });
}

// Drawn aside on a rod, stirred by the open window.
static void add_curtains(living_room *r)
{
    const double x = (double) room_half_x - 0.10, y = 2.50;
    const float rod[2][3] = { { 0, 0.0f, -1.85f }, { 0, 0.0f, 1.65f } };
    const shape_tube_desc bar = { .path = rod, .count = 2, .radius = 0.014f, .segments = 10 };
    const shape_cloth_desc cloth = { .width = 0.62f,
                                     .height = 2.42f,
                                     .folds = 5,
                                     .depth = 0.03f,
                                     .gather = 0.0f,
                                     .nu = 44,
                                     .nv = 8 };
    shape s = { 0 };
    shape_tube(&s, &bar);
    shape_sphere(&s, rod[0], 0.03f, 12);
    shape_sphere(&s, rod[1], 0.03f, 12);
    room_put(r, "rod", &s, ROOM_BRASS, (place){ x, y, 0, 0 });
    s.tiling = 1.0f / 0.6f;
    shape_cloth(&s, &cloth);
    const int part = kit_part(&r->k, "curtain", &s, r->material[ROOM_CURTAIN]);
    for (int i = 0; i < 2; ++i) {
        const place at = { x, y - 0.015, i ? 1.33 : -1.53, 1.57079632679 };
        const int fixed = kit_node(&r->k, "curtain rod", -1, at);
        const int node = kit_show(&r->k, "curtain", part, fixed, (place){ 0 });
        const kit_swing_desc swing = { .axis = 0,
                                       .amplitude = 0.012f,
                                       .phase = 0.3f * (float) i,
                                       .seconds = room_period,
                                       .count = 5 + i };
        kit_swing(&r->k, node, &swing);
    }
}

void room_add_shell(living_room *r)
{
    add_floor_and_ceiling(r);
    add_walls(r);
    add_trim(r);
    add_view(r);
    add_curtains(r);
}
