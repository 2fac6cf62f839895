// SPDX-License-Identifier: MIT
#include "garden_priv.h"

#include "builtin.h"

// Everything is diffuse, so that a technique for diffuse light can be held against the whole truth.
static const kit_look looks[GARDEN_MATERIALS] = {
    [GARDEN_LAWN] = { "lawn", PATTERN_LAWN, { 1, 1, 1 }, .size = 512 },
    [GARDEN_BRICK] = { "brick", PATTERN_BRICK, { 1, 1, 1 }, .size = 512 },
    [GARDEN_LIMESTONE] = { "limestone", PATTERN_LIMESTONE, { 1, 1, 1 } },
    [GARDEN_STONE] = { "stone", PATTERN_LIMESTONE, { 0.62f, 0.60f, 0.58f } },
    [GARDEN_WOOD] = { "wood", PATTERN_WOOD, { 1, 1, 1 } },
    [GARDEN_BARK] = { "bark", PATTERN_BARK, { 1, 1, 1 } },
    [GARDEN_CLAY] = { "clay", PATTERN_CLAY, { 1, 1, 1 } },
    [GARDEN_BRASS] = { "brass", -1, { 0.48f, 0.32f, 0.12f } },
    [GARDEN_WATER] = { "water", -1, { 0.05f, 0.095f, 0.10f } },
    [GARDEN_LEAVES] = { "leaves", PATTERN_LEAVES, { 1, 1, 0.8f } },
    [GARDEN_BOX] = { "box", PATTERN_LEAVES, { 0.62f, 0.72f, 0.7f } },
    [GARDEN_IVY] = { "ivy", PATTERN_LEAVES, { 0.75f, 0.8f, 1 } },
    [GARDEN_SHADE] = { "shade", -1, { 0.09f, 0.15f, 0.05f } },
    [GARDEN_GRASS] = { "grass", PATTERN_GRASS, { 1, 1, 1 } },
    [GARDEN_FERN] = { "fern", PATTERN_FERN, { 1, 1, 1 } },
    [GARDEN_ROSE] = { "rose", PATTERN_FLOWER, { 0.85f, 0.18f, 0.25f } },
    [GARDEN_BLUE] = { "bluebell", PATTERN_FLOWER, { 0.28f, 0.27f, 0.80f } },
    [GARDEN_WHITE] = { "daisy", PATTERN_FLOWER, { 0.85f, 0.85f, 0.80f } },
};

// Up the path, past the pavilion, along the ivy and around the pond.
static const kit_stop stops[] = {
    { { 1.0, 1.6, 5.4 }, { -2.5, 1.3, 0.0 } },    { { -0.5, 1.6, 3.0 }, { -4.0, 1.5, -2.0 } },
    { { -1.5, 1.6, 1.3 }, { -4.6, 1.6, -3.0 } },  { { -2.1, 1.6, -0.6 }, { -4.6, 1.6, -3.6 } },
    { { -1.5, 1.6, -2.6 }, { -2.5, 1.4, -6.5 } }, { { -0.4, 1.6, -4.6 }, { 3.0, 1.2, -7.0 } },
    { { 2.4, 1.6, -5.1 }, { 7.0, 1.4, -5.0 } },   { { 5.2, 1.6, -4.3 }, { 7.0, 1.2, -0.5 } },
    { { 5.9, 1.6, -1.9 }, { 3.0, 0.9, -0.4 } },   { { 5.7, 1.6, 0.6 }, { 1.0, 0.9, -1.8 } },
    { { 4.4, 1.6, 3.2 }, { -2.0, 1.1, -1.5 } },   { { 2.6, 1.6, 4.7 }, { -3.0, 1.2, 1.0 } },
};

static void add_cameras(garden *g)
{
    const kit_walk_desc walk = {
        .name = "path", .stops = stops, .count = FG_COUNT(stops), .seconds = 48.0f, .yfov = 1.0f
    };
    kit_camera(&g->k, "bench", (double[]){ 5.6, 1.75, 3.4 }, (double[]){ -3.6, 1.0, -3.4 }, 0.95f);
    kit_camera(&g->k, "pavilion", (double[]){ -5.5, 1.75, -4.0 }, (double[]){ 2.4, 0.5, 1.2 },
               1.1f);
    kit_camera(&g->k, "water", (double[]){ 4.6, 0.75, 1.5 }, (double[]){ 0.2, 0.5, -3.4 }, 0.95f);
    kit_camera(&g->k, "gate", (double[]){ 1.3, 1.65, 7.2 }, (double[]){ -1.8, 1.1, 0.0 }, 1.0f);
    kit_camera(&g->k, "swing", (double[]){ -2.6, 1.5, 2.4 }, (double[]){ -7.0, 1.4, 3.6 }, 1.0f);
    kit_walk(&g->k, &walk);
}

fg_status garden_build(const fg_log *log, ag_scene **out)
{
    garden g;
    *out = NULL;
    if (!kit_begin(&g.k, log, "garden"))
        return FG_ERR_MEMORY;
    kit_materials(&g.k, looks, GARDEN_MATERIALS, g.material);
    garden_add_ground(&g);
    garden_add_hedges(&g);
    garden_add_trees(&g);
    garden_add_flowers(&g);
    garden_add_pavilion(&g);
    garden_add_light(&g);
    add_cameras(&g);
    return kit_end(&g.k, out);
}
