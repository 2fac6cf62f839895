// SPDX-License-Identifier: MIT
#include "atrium_priv.h"

#include "builtin.h"

enum { TEXTURE_SIZE = 512 };

// Everything is diffuse, so that a technique for
// diffuse light can be held against the whole truth here.
static const kit_look looks[ATRIUM_MATERIALS] = {
    [ATRIUM_ASHLAR] = { "ashlar", PATTERN_ASHLAR, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [ATRIUM_LIMESTONE] = { "limestone", PATTERN_LIMESTONE, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [ATRIUM_PLASTER] = { "plaster", PATTERN_PLASTER, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [ATRIUM_WHITEWASH] = { "whitewash", -1, { 0.72f, 0.69f, 0.63f } },
    [ATRIUM_BRICK] = { "brick", PATTERN_BRICK, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [ATRIUM_PAVING] = { "paving", PATTERN_PAVING, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [ATRIUM_TERRACOTTA] = { "terracotta", PATTERN_TERRACOTTA, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [ATRIUM_CLAY] = { "clay", PATTERN_CLAY, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [ATRIUM_WOOD] = { "wood", PATTERN_WOOD, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [ATRIUM_RED] = { "red cloth", PATTERN_FABRIC, { 0.72f, 0.06f, 0.045f }, .size = TEXTURE_SIZE },
    [ATRIUM_GREEN] = { "green cloth",
                       PATTERN_FABRIC,
                       { 0.10f, 0.42f, 0.11f },
                       .size = TEXTURE_SIZE },
    [ATRIUM_BLUE] = { "blue cloth", PATTERN_FABRIC, { 0.07f, 0.17f, 0.58f }, .size = TEXTURE_SIZE },
    [ATRIUM_LEAVES] = { "leaves", PATTERN_LEAVES, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [ATRIUM_BRASS] = { "brass", -1, { 0.48f, 0.32f, 0.12f } },
    [ATRIUM_WATER] = { "water", -1, { 0.10f, 0.20f, 0.20f } },
};

// From the west around the fountain, through an arch, along the southern aisle and back.
static const kit_stop stops[] = {
    { { -7.8, 1.75, -1.0 }, { 3.0, 2.6, 0.6 } },  { { -4.6, 1.75, -1.2 }, { 5.0, 2.6, 0.2 } },
    { { -2.0, 1.75, -2.1 }, { 6.0, 2.8, 1.0 } },  { { 0.8, 1.75, -2.5 }, { 7.0, 3.0, 1.6 } },
    { { 3.6, 1.75, -1.2 }, { 9.0, 3.0, 2.2 } },   { { 6.2, 1.75, 0.0 }, { 9.0, 2.8, 5.2 } },
    { { 6.9, 1.75, 2.4 }, { 5.6, 2.4, 7.4 } },    { { 6.7, 1.75, 4.5 }, { 1.0, 2.0, 6.4 } },
    { { 5.2, 1.80, 5.8 }, { -3.0, 2.0, 6.0 } },   { { 2.0, 1.80, 5.9 }, { -5.0, 2.0, 5.4 } },
    { { -0.4, 1.80, 5.5 }, { -6.0, 2.2, 2.4 } },  { { -1.5, 1.75, 4.4 }, { -5.5, 2.6, -1.6 } },
    { { -2.5, 1.75, 2.8 }, { -4.0, 2.8, -4.0 } }, { { -5.2, 1.75, 1.2 }, { 0.0, 2.8, -4.4 } },
    { { -7.4, 1.75, 0.6 }, { 4.0, 2.8, -2.0 } },
};

static void add_cameras(atrium *a)
{
    const kit_walk_desc walk = {
        .name = "path", .stops = stops, .count = FG_COUNT(stops), .seconds = 24.0f, .yfov = 1.1f
    };
    kit_camera(&a->k, "court", (double[]){ -8.35, 1.75, -1.2 }, (double[]){ 3.0, 2.95, 1.4 },
               1.12f);
    kit_camera(&a->k, "gallery", (double[]){ -5.3, 6.2, 6.75 }, (double[]){ 4.5, 5.5, 4.3 }, 1.10f);
    kit_camera(&a->k, "aisle", (double[]){ -6.3, 1.7, 6.5 }, (double[]){ 4.0, 2.2, 5.4 }, 1.05f);
    kit_camera(&a->k, "above", (double[]){ -8.6, 13.0, -3.2 }, (double[]){ 1.2, 1.2, 1.4 }, 1.0f);
    kit_walk(&a->k, &walk);
}

fg_status atrium_build(const fg_log *log, ag_scene **out)
{
    static const char *const names[4] = { "south side", "east side", "north side", "west side" };
    atrium a;
    *out = NULL;
    if (!kit_begin(&a.k, log, "atrium"))
        return FG_ERR_MEMORY;
    for (int i = 0; i < 4; ++i)
        a.side[i] = kit_node(&a.k, names[i], -1, (place){ .yaw = 1.57079632679489661923 * i });
    kit_materials(&a.k, looks, ATRIUM_MATERIALS, a.material);
    atrium_add_structure(&a);
    atrium_add_furnishing(&a);
    atrium_add_life(&a);
    add_cameras(&a);
    return kit_end(&a.k, out);
}
