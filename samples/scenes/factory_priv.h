// SPDX-License-Identifier: MIT
#ifndef FACTORY_PRIV_H
#define FACTORY_PRIV_H

#include "kit.h"

// A hall of 40 x 24 m, 9 m to the roof, the origin in the middle of its floor: +X along the lines
// to the gate, +Y up. Two belts run along it, at z = -3 to +X and at z = 3 back. Metres.

static const float hall_half_x = 20.0f, hall_half_z = 12.0f, hall_height = 9.0f;
static const float hall_bay = 5.0f;               // from truss to truss
static const float hall_gate[2] = { 4.6f, 9.6f }; // z, in the wall at +X
static const float hall_gate_height = 4.6f;
static const float line_z = 3.0f, line_half = 12.0f, line_height = 0.75f; // of the belts
static const float factory_period = 48.0f; // s: all that moves repeats after it

typedef enum factory_material {
    FACTORY_FLOOR = 0,
    FACTORY_SHEET,
    FACTORY_CONCRETE,
    FACTORY_ROOF,
    FACTORY_STEEL, // trusses, columns
    FACTORY_LINES, // painted on the floor
    FACTORY_RACK,
    FACTORY_BEAM,
    FACTORY_PALLET,
    FACTORY_CARTON,
    FACTORY_WHITE_CARTON,
    FACTORY_CRATE,
    FACTORY_BELT, // runs
    FACTORY_FRAME,
    FACTORY_MACHINE,
    FACTORY_RUBBER,
    FACTORY_HAZARD,
    FACTORY_ROBOT,
    FACTORY_CRANE,
    FACTORY_CART,
    FACTORY_LAMP,
    FACTORY_BEACON, // turns on and off
    FACTORY_DAY,    // beyond the gate
    FACTORY_MATERIALS,
} factory_material;

// What is carried about: parts that many instances show.
typedef struct factory_goods {
    int carton, white_carton, crate; // stand on y = 0 around the origin
    int pallet;                      // 1.2 x 0.8 m, 0.14 m high
    int stacks[4];                   // of cartons, to stand on a pallet
} factory_goods;

typedef struct factory {
    kit k;
    int material[FACTORY_MATERIALS];
    factory_goods goods;
} factory;

int factory_part(factory *f, const char *name, shape *s, factory_material material);
// A part of its own shown once under the root. Returns the node.
int factory_put(factory *f, const char *name, shape *s, factory_material material, place at);

void factory_add_hall(factory *f);   // factory_hall.c: floor, walls, roof, trusses, gate
void factory_add_store(factory *f);  // factory_store.c: the goods, racks full of them
void factory_add_lines(factory *f);  // factory_lines.c: belts and what runs on them
void factory_add_robots(factory *f); // factory_robots.c: robots, crane, carts
void factory_add_lights(factory *f); // factory_lights.c

#endif // FACTORY_PRIV_H
