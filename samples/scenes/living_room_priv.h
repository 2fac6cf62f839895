// SPDX-License-Identifier: MIT
#ifndef LIVING_ROOM_PRIV_H
#define LIVING_ROOM_PRIV_H

#include "kit.h"

// A living room of 6.4 x 4.8 m, 2.7 m high, the origin in the middle of its floor: +X to the
// window, +Z away from the television, +Y up. Metres.

static const float room_half_x = 3.2f, room_half_z = 2.4f, room_height = 2.7f;
// The window's opening in the wall at +X: z and y.
static const float room_window[2][2] = { { -1.35f, 1.15f }, { 0.30f, 2.30f } };
static const float room_period = 24.0f; // s: all that moves repeats after it

typedef enum room_material {
    ROOM_PARQUET = 0,
    ROOM_WALL,
    ROOM_ACCENT, // the wall behind the television
    ROOM_CEILING,
    ROOM_WHITE, // frames, skirting
    ROOM_EVENING,
    ROOM_CURTAIN,
    ROOM_OAK,
    ROOM_DARK_WOOD,
    ROOM_SOFA,
    ROOM_ARMCHAIR,
    ROOM_PILLOW,
    ROOM_RUG,
    ROOM_BOOKS, // coloured by vertices
    ROOM_PICTURES,
    ROOM_BRASS,
    ROOM_BLACK,
    ROOM_SCREEN,
    ROOM_SHADE,
    ROOM_CLAY,
    ROOM_LEAF,
    ROOM_PORCELAIN,
    ROOM_TOY, // coloured by vertices
    ROOM_MATERIALS,
} room_material;

typedef struct living_room {
    kit k;
    int material[ROOM_MATERIALS];
} living_room;

// A part of `material` shown at `at`, under the root. Returns the node. The shape is freed.
int room_put(living_room *r, const char *name, shape *s, room_material material, place at);

void room_add_shell(living_room *r);     // living_room_shell.c: floor, walls, window, curtains
void room_add_seats(living_room *r);     // living_room_seats.c: sofa, armchair, rug, tables
void room_add_furniture(living_room *r); // living_room_furniture.c: what stands along the walls
void room_add_life(living_room *r);      // living_room_life.c: what moves, shows and lights

#endif // LIVING_ROOM_PRIV_H
