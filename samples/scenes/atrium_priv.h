// SPDX-License-Identifier: MIT
#ifndef ATRIUM_PRIV_H
#define ATRIUM_PRIV_H

#include "kit.h"

// The atrium: a court of 18 x 9 m open to the sky, galleries 3 m deep on two storeys around it, in
// bays of 3 m. +X along the court, +Y up, the origin in the middle of the court's floor. Metres.
//
// The four sides are nodes turned so that on each of them x runs along the arcade and z outwards.

static const float atrium_bay = 3.0f;
static const float atrium_half_x = 9.0f, atrium_half_z = 4.5f; // of the arcades' axes
static const float atrium_gallery = 3.0f;                      // arcade axis to back wall
static const double atrium_floor[2] = { 0.15, 4.5 };           // of the storeys
static const float atrium_spring[2] = { 2.9f, 6.95f };         // of their arches
static const float atrium_eaves = 9.0f;

typedef enum atrium_material {
    ATRIUM_ASHLAR = 0,
    ATRIUM_LIMESTONE,
    ATRIUM_PLASTER,
    ATRIUM_WHITEWASH,
    ATRIUM_BRICK,
    ATRIUM_PAVING,
    ATRIUM_TERRACOTTA,
    ATRIUM_CLAY,
    ATRIUM_WOOD,
    ATRIUM_RED,
    ATRIUM_GREEN,
    ATRIUM_BLUE,
    ATRIUM_LEAVES,
    ATRIUM_BRASS,
    ATRIUM_WATER,
    ATRIUM_MATERIALS,
} atrium_material;

typedef struct atrium {
    kit k;
    int material[ATRIUM_MATERIALS];
    int side[4]; // nodes: +z, +x, -z, -x
} atrium;

// Of side `i`: how many bays it has and how far its arcade stands from the origin.
static inline int atrium_bays(int side)
{
    return side % 2 ? 3 : 6;
}

static inline double atrium_distance(int side)
{
    return side % 2 ? (double) atrium_half_x : (double) atrium_half_z;
}

// The middle of bay `k` along side `side`.
static inline double atrium_bay_centre(int side, int k)
{
    return (double) atrium_bay * (k + 0.5 - 0.5 * atrium_bays(side));
}

void atrium_add_structure(atrium *a);  // atrium_structure.c: walls, columns, arches, roof
void atrium_add_furnishing(atrium *a); // atrium_furnishing.c: what hangs, stands and grows in it
void atrium_add_life(atrium *a);       // atrium_life.c: the moving lamps and the light

#endif // ATRIUM_PRIV_H
