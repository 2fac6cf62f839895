// SPDX-License-Identifier: MIT
#ifndef GARDEN_PRIV_H
#define GARDEN_PRIV_H

#include "kit.h"

// The garden: 20 x 15 m between a wall to the north and west and tall hedges, with a pond, a round
// pavilion and a path between them. +X east, +Y up, +Z south, the origin in the middle. Metres.

typedef enum garden_material {
    GARDEN_LAWN = 0,
    GARDEN_BRICK,
    GARDEN_LIMESTONE,
    GARDEN_STONE, // of the pond's rim and the path
    GARDEN_WOOD,
    GARDEN_BARK,
    GARDEN_CLAY,
    GARDEN_BRASS,
    GARDEN_WATER,
    GARDEN_LEAVES, // of trees
    GARDEN_BOX,
    GARDEN_IVY,
    GARDEN_SHADE, // what is inside a hedge
    GARDEN_GRASS,
    GARDEN_FERN,
    GARDEN_ROSE,
    GARDEN_BLUE,
    GARDEN_WHITE,
    GARDEN_MATERIALS,
} garden_material;

typedef struct garden {
    kit k;
    int material[GARDEN_MATERIALS];
} garden;

static const float garden_half_x = 10.0f, garden_half_z = 7.5f;
static const float garden_pond[3] = { 2.6f, -1.2f, 2.3f };      // x, z, radius to the rim
static const float garden_pavilion[3] = { -4.6f, -3.0f, 2.3f }; // x, z, radius of its steps
static const float garden_water = -0.10f;                       // height of the pond's surface

// Height of the ground; how far a point is from the middle of the path.
float garden_ground(float x, float z);
float garden_from_path(float x, float z);

void garden_add_ground(garden *g);  // ground, path, pond, walls
void garden_add_hedges(garden *g);  // hedges and ivy
void garden_add_trees(garden *g);   // with the swing
void garden_add_flowers(garden *g); // grass, ferns, flowers, reeds
void garden_add_pavilion(garden *g);
void garden_add_light(garden *g); // the moon and the pavilion's lantern

#endif // GARDEN_PRIV_H
