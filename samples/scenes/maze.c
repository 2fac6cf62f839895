// SPDX-License-Identifier: MIT
#include "maze_priv.h"

#include "builtin.h"

enum { TEXTURE_SIZE = 512 };

// Everything is diffuse, so that a technique for diffuse light can be held against the whole truth.
static const kit_look looks[MAZE_MATERIALS] = {
    [MAZE_ASHLAR] = { "ashlar", PATTERN_ASHLAR, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [MAZE_LIMESTONE] = { "limestone", PATTERN_LIMESTONE, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [MAZE_PAVING] = { "paving", PATTERN_PAVING, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [MAZE_WHITEWASH] = { "whitewash",
                         PATTERN_FRESCO,
                         { 0.78f, 0.74f, 0.66f },
                         .size = TEXTURE_SIZE },
    [MAZE_WOOD] = { "wood", PATTERN_WOOD, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [MAZE_CLAY] = { "clay", PATTERN_CLAY, { 1, 1, 1 }, .size = TEXTURE_SIZE },
    [MAZE_BRASS] = { "brass", -1, { 0.48f, 0.32f, 0.12f } },
    [MAZE_MARBLE] = { "marble", -1, { 0.74f, 0.71f, 0.65f } },
    [MAZE_RED] = { "red wall", PATTERN_FRESCO, { 0.70f, 0.13f, 0.08f }, .size = TEXTURE_SIZE },
    [MAZE_OCHRE] = { "ochre wall", PATTERN_FRESCO, { 0.76f, 0.52f, 0.17f }, .size = TEXTURE_SIZE },
    [MAZE_BLUE] = { "blue wall", PATTERN_FRESCO, { 0.14f, 0.30f, 0.62f }, .size = TEXTURE_SIZE },
    [MAZE_GREEN] = { "green wall", PATTERN_FRESCO, { 0.22f, 0.50f, 0.20f }, .size = TEXTURE_SIZE },
    [MAZE_VIOLET] = { "violet wall",
                      PATTERN_FRESCO,
                      { 0.42f, 0.22f, 0.46f },
                      .size = TEXTURE_SIZE },
    [MAZE_IVORY] = { "ivory wall", PATTERN_FRESCO, { 0.76f, 0.70f, 0.56f }, .size = TEXTURE_SIZE },
};

// Along the first leg, past the statue, through the door, a look into the second leg, and back.
static const kit_stop stops[] = {
    { { 1.5, 1.6, 11.7 }, { 6.0, 1.6, 11.9 } },   { { 4.4, 1.6, 12.2 }, { 9.0, 1.5, 11.7 } },
    { { 7.6, 1.6, 12.1 }, { 12.5, 1.7, 11.4 } },  { { 10.2, 1.6, 12.2 }, { 12.8, 1.8, 11.4 } },
    { { 11.3, 1.6, 10.6 }, { 13.4, 1.8, 10.8 } }, { { 11.4, 1.6, 9.3 }, { 12.4, 1.5, 7.2 } },
    { { 11.6, 1.6, 7.9 }, { 13.2, 1.5, 6.2 } },   { { 12.6, 1.6, 6.8 }, { 14.4, 1.5, 5.9 } },
    { { 13.5, 1.6, 6.5 }, { 12.6, 1.5, 4.8 } },   { { 13.3, 1.6, 6.2 }, { 10.4, 1.5, 6.7 } },
    { { 12.2, 1.6, 6.7 }, { 11.3, 1.5, 9.0 } },   { { 11.6, 1.6, 8.0 }, { 12.2, 1.6, 11.0 } },
    { { 11.3, 1.6, 9.8 }, { 11.2, 1.4, 12.6 } },  { { 10.6, 1.6, 11.3 }, { 8.0, 1.4, 12.0 } },
    { { 8.0, 1.6, 11.5 }, { 3.0, 1.5, 11.9 } },   { { 4.4, 1.6, 11.4 }, { 1.0, 1.5, 11.2 } },
    { { 2.1, 1.6, 11.3 }, { 1.5, 1.6, 8.5 } },    { { 1.3, 1.6, 11.4 }, { 3.6, 1.6, 10.6 } },
};

static void add_cameras(maze *m)
{
    const kit_walk_desc walk = {
        .name = "path", .stops = stops, .count = FG_COUNT(stops), .seconds = 36.0f, .yfov = 1.1f
    };
    kit_camera(&m->k, "entry", (double[]){ 5.2, 1.6, 12.4 }, (double[]){ 12.4, 1.35, 11.5 }, 0.9f);
    kit_camera(&m->k, "statue", (double[]){ 9.8, 1.6, 12.5 }, (double[]){ 12.9, 1.6, 11.4 }, 1.0f);
    kit_camera(&m->k, "door", (double[]){ 11.3, 1.65, 12.5 }, (double[]){ 12.5, 1.3, 8.0 }, 1.05f);
    kit_camera(&m->k, "hall", (double[]){ 11.2, 1.7, 9.7 }, (double[]){ 14.2, 1.2, 12.2 }, 1.15f);
    kit_camera(&m->k, "light", (double[]){ 14.9, 1.7, 9.6 }, (double[]){ 9.0, 0.9, 12.2 }, 1.0f);
    kit_walk(&m->k, &walk);
}

fg_status maze_build(const fg_log *log, ag_scene **out)
{
    maze m;
    *out = NULL;
    if (!kit_begin(&m.k, log, "maze"))
        return FG_ERR_MEMORY;
    kit_materials(&m.k, looks, MAZE_MATERIALS, m.material);
    maze_add_walls(&m);
    maze_add_arches(&m);
    maze_add_statue(&m);
    maze_add_furnishing(&m);
    maze_add_life(&m);
    add_cameras(&m);
    return kit_end(&m.k, out);
}
