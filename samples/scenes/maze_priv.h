// SPDX-License-Identifier: MIT
#ifndef MAZE_PRIV_H
#define MAZE_PRIV_H

#include "kit.h"

// The maze: one corridor that winds through 16 x 13.4 m and comes back to where it began, under a
// roof that is open over its first leg alone. +X and +Z along the plan, +Y up, the origin at the
// plan's corner on the floor. Metres.

typedef enum maze_material {
    MAZE_ASHLAR = 0,
    MAZE_LIMESTONE,
    MAZE_PAVING,
    MAZE_WHITEWASH,
    MAZE_WOOD,
    MAZE_CLAY,
    MAZE_BRASS,
    MAZE_MARBLE,
    MAZE_RED, // the legs' colours, in the order of maze_legs
    MAZE_OCHRE,
    MAZE_BLUE,
    MAZE_GREEN,
    MAZE_VIOLET,
    MAZE_IVORY,
    MAZE_MATERIALS,
} maze_material;

typedef struct maze {
    kit k;
    int material[MAZE_MATERIALS];
} maze;

enum { MAZE_NX = 13, MAZE_NZ = 11 }; // of the plan: walls on even lines, cells on odd ones
static const float maze_cell = 2.2f, maze_wall = 0.4f, maze_height = 3.2f;

// Where line `i` of the plan begins.
static inline float maze_line(int i)
{
    const int walls = (i + 1) / 2;
    return maze_wall * (float) walls + maze_cell * (float) (i - walls);
}

// The middle of cell `c` (0, 1, ...) along either axis.
static inline float maze_middle(int c)
{
    return 0.5f * (maze_line(2 * c + 1) + maze_line(2 * c + 2));
}

void maze_add_walls(maze *m);
void maze_add_arches(maze *m);
void maze_add_statue(maze *m);
void maze_add_furnishing(maze *m);
void maze_add_life(maze *m);

#endif // MAZE_PRIV_H
