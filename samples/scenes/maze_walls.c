// SPDX-License-Identifier: MIT
#include "maze_priv.h"

#include <string.h>

// '#' is solid, a letter a leg of the corridor: a hall lit from above, h the statue's, then b, c,
// d, e around three corners more and back. Walls take their colour from the leg that they face.
static const char *const plan[MAZE_NZ] = {
    "#############", //
    "#ddddddddddd#", //
    "#e#######c###", //
    "#e#ccccccccc#", //
    "#e#b#########", //
    "#e#bbbbbbbbb#", //
    "#e#######h###", //
    "#e#######hhh#", //
    "#e#######hhh#", //
    "#aaaaaaaahhh#", //
    "#############",
};

static const char legs[] = "ahbcde";
enum { LEGS = FG_COUNT(legs) - 1 };

// Walls from the floor up: a dado of stone, the colour, a white frieze.
static const float bands[4] = { 0.0f, 0.85f, 2.75f, 3.2f };
static const float roof = 3.6f; // the top of its slab

static char at(int x, int z)
{
    if (x < 0 || z < 0 || x >= MAZE_NX || z >= MAZE_NZ)
        return ' ';
    return plan[z][x];
}

static bool is_free(int x, int z)
{
    return at(x, z) >= 'a';
}

// Holes in the roof, over the first leg's cells.
static bool is_open(int x, int z)
{
    return z == MAZE_NZ - 2 && x <= 7 && x % 2;
}

// The plan's square as a box between two heights.
static void square(int x, int z, float lo[3], float hi[3])
{
    lo[0] = maze_line(x);
    lo[2] = maze_line(z);
    hi[0] = maze_line(x + 1);
    hi[2] = maze_line(z + 1);
}

// ---- walls -----------------------------------------------------------------------------

typedef struct surfaces {
    shape dado, frieze, floor, ceiling, outside;
    shape colour[LEGS];
} surfaces;

// What of a solid square faces the free one beyond `face`, and of the outer ones the outside.
static void add_wall(surfaces *s, int x, int z, int face)
{
    static const int step[6][2] = { { -1, 0 }, { 1, 0 }, { 0, 0 }, { 0, 0 }, { 0, -1 }, { 0, 1 } };
    const char beyond = at(x + step[face][0], z + step[face][1]);
    float lo[3], hi[3];
    square(x, z, lo, hi);
    if (beyond == ' ') {
        lo[1] = -0.3f;
        hi[1] = roof;
        shape_box_face(&s->outside, lo, hi, face);
        return;
    }
    const char *leg = strchr(legs, beyond);
    if (!leg)
        return;
    shape *const shapes[3] = { &s->dado, &s->colour[leg - legs], &s->frieze };
    for (int i = 0; i < 3; ++i) {
        lo[1] = bands[i];
        hi[1] = bands[i + 1];
        shape_box_face(shapes[i], lo, hi, face);
    }
}

// The roof over a square: above it the outside, below it the ceiling where the corridor is, and in
// an opening the slab's thickness.
static void add_roof(surfaces *s, int x, int z)
{
    float lo[3], hi[3];
    square(x, z, lo, hi);
    lo[1] = bands[3];
    hi[1] = roof;
    if (!is_open(x, z)) {
        shape_box_face(&s->outside, lo, hi, 3);
        if (is_free(x, z))
            shape_box_face(&s->ceiling, lo, hi, 2);
        return;
    }
    const float xs[4] = { lo[0], lo[0] + 0.1f, hi[0] - 0.1f, hi[0] };
    const float zs[4] = { lo[2], lo[2] + 0.25f, hi[2] - 0.25f, hi[2] };
    for (int i = 0; i < 9; ++i) {
        const int c = i % 3, r = i / 3;
        const float a[3] = { xs[c], lo[1], zs[r] }, b[3] = { xs[c + 1], hi[1], zs[r + 1] };
        if (c == 1 && r == 1)
            continue;
        shape_box_face(&s->ceiling, a, b, 2);
        shape_box_face(&s->outside, a, b, 3);
        if (r == 1)
            shape_box_face(&s->frieze, a, b, c == 0 ? 1 : 0);
        if (c == 1)
            shape_box_face(&s->frieze, a, b, r == 0 ? 5 : 4);
    }
}

static void add_square(surfaces *s, int x, int z)
{
    static const int sides[4] = { 0, 1, 4, 5 };
    float lo[3], hi[3];
    square(x, z, lo, hi);
    lo[1] = -0.3f;
    hi[1] = 0.0f;
    if (is_free(x, z))
        shape_box_face(&s->floor, lo, hi, 3);
    for (int i = 0; i < 4 && !is_free(x, z); ++i)
        add_wall(s, x, z, sides[i]);
    add_roof(s, x, z);
}

static void show(maze *m, const char *name, shape *s, int material)
{
    kit_show(&m->k, name, kit_part(&m->k, name, s, m->material[material]), -1, (place){ 0 });
}

void maze_add_walls(maze *m)
{
    surfaces s = { 0 };
    s.dado.tiling = s.outside.tiling = 0.5f;
    s.floor.tiling = 1.0f / 1.2f;
    for (int i = 0; i < LEGS; ++i)
        s.colour[i].tiling = 1.0f / 3.0f;
    for (int z = 0; z < MAZE_NZ; ++z)
        for (int x = 0; x < MAZE_NX; ++x)
            add_square(&s, x, z);
    show(m, "dado", &s.dado, MAZE_ASHLAR);
    show(m, "frieze", &s.frieze, MAZE_WHITEWASH);
    show(m, "ceiling", &s.ceiling, MAZE_WHITEWASH);
    show(m, "floor", &s.floor, MAZE_PAVING);
    show(m, "outside", &s.outside, MAZE_ASHLAR);
    for (int i = 0; i < LEGS; ++i)
        show(m, "wall", &s.colour[i], MAZE_RED + i);
}

// ---- mouldings and arches ----------------------------------------------------------------

// A moulding along the wall beyond `face` of a free square, between two heights, `out` thick.
static void add_strip(shape *s, const int xz[2], int face, const float heights[2], float out)
{
    float lo[3], hi[3];
    square(xz[0], xz[1], lo, hi);
    const int axis = face / 2;
    if (face % 2)
        lo[axis] = hi[axis] - out;
    else
        hi[axis] = lo[axis] + out;
    // Into the wall, so that no back is seen where strips end.
    lo[axis] -= face % 2 ? 0.0f : 0.02f;
    hi[axis] += face % 2 ? 0.02f : 0.0f;
    lo[1] = heights[0];
    hi[1] = heights[1];
    shape_box(s, lo, hi);
}

static void add_mouldings(maze *m)
{
    static const struct {
        float heights[2], out;
    } strips[] = { { { -0.02f, 0.16f }, 0.04f },
                   { { 0.82f, 0.90f }, 0.035f },
                   { { 2.70f, 2.78f }, 0.05f } };
    static const int steps[6][2] = { { -1, 0 }, { 1, 0 }, { 0, 0 }, { 0, 0 }, { 0, -1 }, { 0, 1 } };
    shape s = { .tiling = 1.0f };
    for (int z = 0; z < MAZE_NZ; ++z)
        for (int x = 0; x < MAZE_NX; ++x)
            for (int face = 0; face < 6 && is_free(x, z); ++face) {
                if (face / 2 == 1 || is_free(x + steps[face][0], z + steps[face][1]))
                    continue;
                for (int i = 0; i < FG_COUNT(strips); ++i)
                    add_strip(&s, (int[2]){ x, z }, face, strips[i].heights, strips[i].out);
            }
    show(m, "mouldings", &s, MAZE_LIMESTONE);
}

// An arch across the corridor, in the middle of a wall's line; along x until it is turned.
static int add_arch_part(maze *m)
{
    const shape_arcade_desc arch = { .bays = 1,
                                     .bay = maze_cell + 0.02f,
                                     .radius = 0.84f,
                                     .rise = 0.80f,
                                     .spring = 2.05f,
                                     .top = maze_height + 0.02f,
                                     .thickness = 0.36f,
                                     .segments = 24 };
    shape s = { .tiling = 1.0f };
    shape_arcade(&s, &arch);
    for (int i = 0; i < 2; ++i) {
        const float out = i ? 1.11f : -0.84f, in = i ? 0.84f : -1.11f;
        shape_box(&s, (float[3]){ in, -0.02f, -0.18f }, (float[3]){ out, 2.05f, 0.18f });
        shape_box(&s, (float[3]){ in - (i ? 0.04f : 0.0f), 1.97f, -0.21f },
                  (float[3]){ out + (i ? 0.0f : 0.04f), 2.09f, 0.21f });
    }
    return kit_part(&m->k, "arch", &s, m->material[MAZE_LIMESTONE]);
}

void maze_add_arches(maze *m)
{
    static const struct {
        int x, z;
        bool along_z; // the corridor goes along z there
    } where[] = { { 9, 6, true }, { 3, 4, true }, { 9, 2, true }, { 1, 2, true } };
    const int part = add_arch_part(m);
    for (int i = 0; i < FG_COUNT(where); ++i) {
        const place at = { 0.5 * (double) (maze_line(where[i].x) + maze_line(where[i].x + 1)), 0,
                           0.5 * (double) (maze_line(where[i].z) + maze_line(where[i].z + 1)),
                           where[i].along_z ? 0.0 : 1.57079632679489661923 };
        kit_show(&m->k, "arch", part, -1, at);
    }
    add_mouldings(m);
}
