// SPDX-License-Identifier: MIT
// What stands and hangs along the walls.
#include "living_room_priv.h"

#include <math.h>

// Books side by side on a board of `width`, as tall as `height` allows.
static void fill_board(shape *s, float x, float y, float width, float height, uint32_t *state)
{
    static const float cloths[8][3] = { { 0.42f, 0.07f, 0.06f }, { 0.08f, 0.17f, 0.33f },
                                        { 0.10f, 0.26f, 0.14f }, { 0.60f, 0.48f, 0.28f },
                                        { 0.24f, 0.11f, 0.20f }, { 0.70f, 0.66f, 0.58f },
                                        { 0.55f, 0.30f, 0.07f }, { 0.12f, 0.12f, 0.13f } };
    const float end = x + width * (0.72f + 0.26f * shape_draw(state));
    while (x < end) {
        const float thickness = 0.018f + 0.034f * shape_draw(state);
        const float tall = height * (0.62f + 0.30f * shape_draw(state)),
                    deep = 0.17f + 0.06f * shape_draw(state);
        const size_t first = s->vertex_count;
        shape_box(s, (float[3]){ x, y, -0.135f },
                  (float[3]){ x + thickness - 0.002f, y + tall, -0.135f + deep });
        shape_paint(s, first, cloths[(int) (8.0f * shape_draw(state))]);
        x += thickness;
    }
}

// A metre wide, two metres high, open to +z; the back stands at z = -0.15.
static void add_bookcase(living_room *r, place at, uint32_t seed)
{
    enum { BOARDS = 6 };
    shape wood = { .tiling = 1 }, books = { 0 };
    shape_box(&wood, (float[3]){ -0.5f, 0, -0.15f }, (float[3]){ -0.475f, 2.0f, 0.15f });
    shape_box(&wood, (float[3]){ 0.475f, 0, -0.15f }, (float[3]){ 0.5f, 2.0f, 0.15f });
    shape_box(&wood, (float[3]){ -0.475f, 0.01f, -0.15f }, (float[3]){ 0.475f, 1.99f, -0.138f });
    for (int i = 0; i < BOARDS; ++i) {
        const float y = 0.06f + 0.384f * (float) i;
        shape_box(&wood, (float[3]){ -0.475f, y, -0.138f },
                  (float[3]){ 0.475f, y + 0.022f, 0.145f });
        if (i + 1 < BOARDS)
            fill_board(&books, -0.47f, y + 0.022f, 0.92f, 0.36f, &seed);
    }
    shape_box(&wood, (float[3]){ -0.475f, 0, 0.12f }, (float[3]){ 0.475f, 0.06f, 0.135f });
    const int node = room_put(r, "bookcase", &wood, ROOM_OAK, at);
    kit_show(&r->k, "books", kit_part(&r->k, "books", &books, r->material[ROOM_BOOKS]), node,
             (place){ 0 });
}

static void add_low_board(living_room *r, const char *name, room_material wood, float half,
                          place at)
{
    shape s = { .tiling = 1 };
    shape_box(&s, (float[3]){ -half, 0.10f, -0.20f }, (float[3]){ half, 0.13f, 0.20f });
    shape_box(&s, (float[3]){ -half, 0.47f, -0.20f }, (float[3]){ half, 0.50f, 0.22f });
    shape_box(&s, (float[3]){ -half, 0.13f, -0.20f }, (float[3]){ -half + 0.03f, 0.47f, 0.20f });
    shape_box(&s, (float[3]){ half - 0.03f, 0.13f, -0.20f }, (float[3]){ half, 0.47f, 0.20f });
    shape_box(&s, (float[3]){ -half + 0.03f, 0.13f, -0.20f },
              (float[3]){ half - 0.03f, 0.47f, -0.18f });
    for (int i = 0; i < 3; ++i) {
        const float wide = (2.0f * half - 0.06f) / 3.0f, x = -half + 0.03f + wide * (float) i;
        if (i != 1)
            shape_box(&s, (float[3]){ x + 0.004f, 0.135f, 0.18f },
                      (float[3]){ x + wide - 0.004f, 0.465f, 0.205f });
    }
    for (int i = 0; i < 4; ++i) {
        const float x = i % 2 ? half - 0.12f : -half + 0.07f, z = i / 2 ? 0.12f : -0.17f;
        shape_box(&s, (float[3]){ x, 0, z }, (float[3]){ x + 0.05f, 0.105f, z + 0.05f });
    }
    room_put(r, name, &s, wood, at);
}

// A quarter of the painted sheet in a frame; it hangs on a wall behind z = 0.
static void add_picture(living_room *r, int which, float wide, float high, place at)
{
    const float x = 0.5f * wide, y = 0.5f * high, z = 0.018f;
    const float canvas[4][3] = { { -x, -y, z }, { x, -y, z }, { x, y, z }, { -x, y, z } };
    shape s = { 0 };
    shape_quad(&s, canvas);
    for (size_t i = 0; i < s.vertex_count; ++i) {
        const float inset = 0.004f, u = i == 1 || i == 2 ? 0.5f - inset : inset;
        const float v = i < 2 ? 0.5f - inset : inset;
        s.vertices[i].uv[0][0] = u + (which % 2 ? 0.5f : 0.0f);
        s.vertices[i].uv[0][1] = v + (which >= 2 ? 0.5f : 0.0f);
    }
    const int node = room_put(r, "picture", &s, ROOM_PICTURES, at);
    const float rim = 0.035f;
    s.tiling = 1;
    shape_box(&s, (float[3]){ -x - rim, -y - rim, -0.01f }, (float[3]){ x + rim, -y, 0.03f });
    shape_box(&s, (float[3]){ -x - rim, y, -0.01f }, (float[3]){ x + rim, y + rim, 0.03f });
    shape_box(&s, (float[3]){ -x - rim, -y, -0.01f }, (float[3]){ -x, y, 0.03f });
    shape_box(&s, (float[3]){ x, -y, -0.01f }, (float[3]){ x + rim, y, 0.03f });
    shape_box(&s, (float[3]){ -x, -y, -0.01f }, (float[3]){ x, y, z - 0.002f });
    kit_show(&r->k, "frame", kit_part(&r->k, "frame", &s, r->material[ROOM_DARK_WOOD]), node,
             (place){ 0 });
}

// ---- plants -------------------------------------------------------------------------

typedef struct leaf {
    float foot[3], way[2]; // where it grows from and to which side
    float length, width, droop;
} leaf;

// From the foot upwards and out, bending over; u across, v along.
static void leaf_point(const void *user, float u, float v, float p[3], float uv[2])
{
    const leaf *l = user;
    const float out = l->length * v * (0.25f + l->droop * v),
                up = l->length * v * (1.0f - 0.62f * l->droop * v * v);
    const float half = l->width * sinf(3.0f * fminf(fmaxf(v, 0.0f), 1.0f) + 0.1f) * (u - 0.5f);
    const float fold = 0.35f * fabsf(half);
    p[0] = l->foot[0] + out * l->way[0] - half * l->way[1];
    p[1] = l->foot[1] + up + fold;
    p[2] = l->foot[2] + out * l->way[1] + half * l->way[0];
    uv[0] = u * l->width;
    uv[1] = v * l->length;
}

static void add_plant(living_room *r, int leaves, float tall, place at, uint32_t seed)
{
    static const float pot[][2] = { { 0, 0 },           { 0.13f, 0 },       { 0.14f, 0.015f },
                                    { 0.185f, 0.27f },  { 0.205f, 0.275f }, { 0.21f, 0.32f },
                                    { 0.195f, 0.325f }, { 0.18f, 0.31f },   { 0.175f, 0.28f },
                                    { 0, 0.28f } };
    const shape_lathe_desc turned = { pot, FG_COUNT(pot), 28, 0, 0 };
    shape s = { .tiling = 1 };
    shape_lathe(&s, &turned);
    const int node = room_put(r, "pot", &s, ROOM_CLAY, at);
    for (int i = 0; i < leaves; ++i) {
        const float angle = 2.399963f * (float) i + 0.5f * shape_draw(&seed),
                    out = 0.02f + 0.05f * shape_draw(&seed);
        const float length = tall * (0.65f + 0.35f * shape_draw(&seed));
        const float width = 0.10f + 0.05f * shape_draw(&seed);
        const float droop = 0.15f + 0.55f * shape_draw(&seed);
        const leaf l = { .foot = { out * cosf(angle), 0.27f, out * sinf(angle) },
                         .way = { cosf(angle), sinf(angle) },
                         .length = length,
                         .width = width,
                         .droop = droop };
        const shape_sheet_desc sheet = { .point = leaf_point, .user = &l, .nu = 4, .nv = 12 };
        shape_sheet(&s, &sheet);
    }
    kit_show(&r->k, "leaves", kit_part(&r->k, "leaves", &s, r->material[ROOM_LEAF]), node,
             (place){ 0 });
}

static void add_vases(living_room *r)
{
    static const float vase[][2] = { { 0, 0 },          { 0.05f, 0 },      { 0.055f, 0.01f },
                                     { 0.09f, 0.09f },  { 0.095f, 0.14f }, { 0.07f, 0.22f },
                                     { 0.035f, 0.28f }, { 0.032f, 0.33f }, { 0.045f, 0.36f },
                                     { 0.04f, 0.36f },  { 0.027f, 0.33f }, { 0.03f, 0.28f },
                                     { 0, 0.10f } };
    const shape_lathe_desc turned = { vase, FG_COUNT(vase), 32, 0, 0 };
    shape s = { 0 };
    shape_lathe(&s, &turned);
    const int part = kit_part(&r->k, "vase", &s, r->material[ROOM_PORCELAIN]);
    const place where[] = { { -2.62, 2.0, -2.24, 0 },
                            { -2.40, 2.0, -2.26, 0 },
                            { -1.2, 2.0, -2.24, 0 },
                            { -0.95, 0.50, 2.16, 0 } };
    for (int i = 0; i < FG_COUNT(where); ++i)
        kit_show(&r->k, "vase", part, -1, where[i]);
}

void room_add_furniture(living_room *r)
{
    const double x = (double) room_half_x, z = (double) room_half_z, pi = 3.14159265358979;
    add_bookcase(r, (place){ -2.5, 0, -z + 0.155, 0 }, 3u);
    add_bookcase(r, (place){ -1.45, 0, -z + 0.155, 0 }, 5u);
    add_low_board(r, "television board", ROOM_DARK_WOOD, 0.95f, (place){ 0.6, 0, -z + 0.24, 0 });
    add_low_board(r, "sideboard", ROOM_OAK, 0.8f, (place){ -1.3, 0, z - 0.24, pi });
    add_picture(r, 0, 0.95f, 0.62f, (place){ -1.3, 1.55, z, pi });
    add_picture(r, 1, 0.55f, 0.62f, (place){ 0.2, 1.62, z, pi });
    add_picture(r, 2, 0.45f, 0.60f, (place){ 1.0, 1.62, z, pi });
    add_picture(r, 3, 0.62f, 0.46f, (place){ -x, 1.60, -0.35, 0.5 * pi });
    add_plant(r, 22, 1.25f, (place){ 2.72, 0, -1.98, 0 }, 11u);
    add_plant(r, 14, 0.75f, (place){ 2.80, 0, 1.95, 0 }, 17u);
    add_vases(r);
}
