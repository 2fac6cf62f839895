// SPDX-License-Identifier: MIT
#include "living_room_priv.h"

#include "builtin.h"

// Base colours multiply the texture, linear. The floor, the porcelain and the brass are glossy.
static const kit_look looks[ROOM_MATERIALS] = {
    [ROOM_PARQUET] = { "parquet", PATTERN_PARQUET, { 1, 1, 1 }, .roughness = 0.18f, .size = 512 },
    [ROOM_WALL] = { "wall", -1, { 0.70f, 0.65f, 0.56f } },
    [ROOM_ACCENT] = { "accent wall", -1, { 0.13f, 0.26f, 0.27f } },
    [ROOM_CEILING] = { "ceiling", -1, { 0.76f, 0.75f, 0.72f } },
    [ROOM_WHITE] = { "white paint", -1, { 0.74f, 0.73f, 0.70f }, .roughness = 0.4f },
    [ROOM_EVENING] = { "evening",
                       PATTERN_EVENING,
                       { 0.1f, 0.1f, 0.1f },
                       .emissive = { 0.95f, 0.95f, 0.95f } },
    [ROOM_CURTAIN] = { "curtain", PATTERN_FABRIC, { 0.74f, 0.60f, 0.40f } },
    [ROOM_OAK] = { "oak", PATTERN_WOOD, { 1.0f, 0.95f, 0.85f }, .roughness = 0.5f },
    [ROOM_DARK_WOOD] = { "walnut", PATTERN_WOOD, { 0.55f, 0.45f, 0.40f }, .roughness = 0.35f },
    [ROOM_SOFA] = { "sofa", PATTERN_FABRIC, { 0.50f, 0.53f, 0.55f } },
    [ROOM_ARMCHAIR] = { "armchair", PATTERN_FABRIC, { 0.62f, 0.27f, 0.08f } },
    [ROOM_PILLOW] = { "pillow", PATTERN_FABRIC, { 0.80f, 0.52f, 0.14f } },
    [ROOM_RUG] = { "rug", PATTERN_RUG, { 1, 1, 1 } },
    [ROOM_BOOKS] = { "books", -1, { 0.79f, 0.79f, 0.79f } },
    [ROOM_PICTURES] = { "pictures", PATTERN_PICTURES, { 1, 1, 1 } },
    [ROOM_BRASS] = { "brass", -1, { 0.62f, 0.42f, 0.16f }, .roughness = 0.3f, .metallic = 0.5f },
    [ROOM_BLACK] = { "black", -1, { 0.09f, 0.09f, 0.095f }, .roughness = 0.3f },
    [ROOM_SCREEN] = { "screen",
                      PATTERN_TELEVISION,
                      { 0.09f, 0.09f, 0.09f },
                      .roughness = 0.1f,
                      .emissive = { 2, 2, 2 },
                      .size = 512 },
    [ROOM_SHADE] = { "lamp shade", -1, { 0.75f, 0.68f, 0.55f }, .emissive = { 3.2f, 2.2f, 1.15f } },
    [ROOM_CLAY] = { "clay", PATTERN_CLAY, { 1, 1, 1 }, .size = 128 },
    [ROOM_LEAF] = { "leaf", -1, { 0.075f, 0.20f, 0.055f }, .roughness = 0.4f },
    [ROOM_PORCELAIN] = { "porcelain", -1, { 0.72f, 0.74f, 0.76f }, .roughness = 0.1f },
    [ROOM_TOY] = { "toy", -1, { 0.79f, 0.79f, 0.79f }, .roughness = 0.3f },
};

int room_put(living_room *r, const char *name, shape *s, room_material material, place at)
{
    return kit_show(&r->k, name, kit_part(&r->k, name, s, r->material[material]), -1, at);
}

// From the door around the seats, past the window, along the shelves and back.
static const kit_stop stops[] = {
    { { -2.75, 1.55, 1.75 }, { 0.6, 0.95, -0.9 } }, { { -2.45, 1.50, 0.7 }, { 0.8, 0.9, -1.2 } },
    { { -2.1, 1.45, -0.5 }, { 1.0, 0.9, -0.6 } },   { { -1.2, 1.40, -1.4 }, { 1.6, 0.9, 0.2 } },
    { { 0.1, 1.35, -1.55 }, { 1.8, 0.9, 1.0 } },    { { 1.5, 1.35, -1.5 }, { 0.6, 0.7, 1.4 } },
    { { 2.45, 1.45, -0.9 }, { -0.4, 0.7, 0.8 } },   { { 2.55, 1.50, 0.4 }, { -0.8, 0.9, -0.6 } },
    { { 2.3, 1.60, 1.6 }, { -0.4, 0.9, -1.4 } },    { { 1.0, 1.65, 2.05 }, { 0.3, 0.8, -1.8 } },
    { { -0.6, 1.62, 2.05 }, { 0.5, 0.85, -1.6 } },  { { -1.9, 1.58, 2.0 }, { 0.6, 0.9, -1.2 } },
};

static void add_cameras(living_room *r)
{
    const kit_walk_desc walk = { .name = "path",
                                 .stops = stops,
                                 .count = FG_COUNT(stops),
                                 .seconds = room_period,
                                 .yfov = 1.0f };
    kit *k = &r->k;
    kit_camera(k, "room", (double[]){ -2.7, 1.55, 1.8 }, (double[]){ 0.75, 0.85, -0.95 }, 1.0f);
    kit_camera(k, "sofa", (double[]){ 0.5, 1.12, 1.15 }, (double[]){ 0.5, 0.9, -2.0 }, 1.0f);
    kit_camera(k, "window", (double[]){ -1.9, 1.3, -1.7 }, (double[]){ 2.2, 0.85, 0.8 }, 1.0f);
    kit_camera(k, "floor", (double[]){ -1.1, 0.22, 0.85 }, (double[]){ 1.2, 0.32, -0.9 }, 0.95f);
    kit_walk(k, &walk);
}

fg_status living_room_build(const fg_log *log, ag_scene **out)
{
    living_room r;
    *out = NULL;
    if (!kit_begin(&r.k, log, "living-room"))
        return FG_ERR_MEMORY;
    kit_materials(&r.k, looks, ROOM_MATERIALS, r.material);
    room_add_shell(&r);
    room_add_seats(&r);
    room_add_furniture(&r);
    room_add_life(&r);
    add_cameras(&r);
    return kit_end(&r.k, out);
}
