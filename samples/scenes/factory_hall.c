// SPDX-License-Identifier: MIT
// The hall itself.
#include "factory_priv.h"

#include <math.h>

static const float thick = 0.4f;

static void add_floor_and_roof(factory *f)
{
    const float x = hall_half_x + thick, z = hall_half_z + thick, h = hall_height;
    shape s = { .tiling = 0.25f };
    shape_box(&s, (float[3]){ -x, -0.3f, -z }, (float[3]){ x + 8.0f, 0.0f, z });
    factory_put(f, "floor", &s, FACTORY_FLOOR, (place){ 0 });
    s.tiling = 0.5f;
    shape_box(&s, (float[3]){ -x, h, -z }, (float[3]){ x, h + 0.3f, z });
    factory_put(f, "roof", &s, FACTORY_ROOF, (place){ 0 });
}

// A plinth of concrete that stands 5 cm before the sheet above it.
static void add_walls(factory *f)
{
    const float x = hall_half_x, z = hall_half_z, h = hall_height, foot = 1.3f, out = 0.05f;
    const float *gate = hall_gate, top = hall_gate_height;
    shape sheet = { .tiling = 0.5f }, stone = { .tiling = 0.25f };
    for (int i = 0; i < 2; ++i) {
        const float a = i ? z : -z - thick, b = i ? z + thick : -z, o = i ? -out : out;
        shape_box(&sheet, (float[3]){ -x, foot, a }, (float[3]){ x, h, b });
        shape_box(&stone, (float[3]){ -x, 0, a + fminf(o, 0) },
                  (float[3]){ x, foot, b + fmaxf(o, 0) });
    }
    shape_box(&sheet, (float[3]){ -x - thick, foot, -z - thick }, (float[3]){ -x, h, z + thick });
    shape_box(&stone, (float[3]){ -x - thick, 0, -z - thick },
              (float[3]){ -x + out, foot, z + thick });
    // Around the gate.
    shape_box(&sheet, (float[3]){ x, foot, -z - thick }, (float[3]){ x + thick, h, gate[0] });
    shape_box(&stone, (float[3]){ x - out, 0, -z - thick }, (float[3]){ x + thick, foot, gate[0] });
    shape_box(&sheet, (float[3]){ x, foot, gate[1] }, (float[3]){ x + thick, h, z + thick });
    shape_box(&stone, (float[3]){ x - out, 0, gate[1] }, (float[3]){ x + thick, foot, z + thick });
    shape_box(&sheet, (float[3]){ x, top, gate[0] }, (float[3]){ x + thick, h, gate[1] });
    factory_put(f, "walls", &sheet, FACTORY_SHEET, (place){ 0 });
    factory_put(f, "plinth", &stone, FACTORY_CONCRETE, (place){ 0 });
}

static void add_gate(factory *f)
{
    const float x = hall_half_x, y = hall_gate_height, *z = hall_gate;
    const float day[4][3] = { { x + 8, -0.3f, z[0] - 6 },
                              { x + 8, -0.3f, z[1] + 6 },
                              { x + 8, 9, z[1] + 6 },
                              { x + 8, 9, z[0] - 6 } };
    shape s = { .tiling = 2.0f };
    for (int i = 0; i < 2; ++i) {
        const float at = i ? z[1] : z[0] - 0.25f;
        shape_box(&s, (float[3]){ x - 0.08f, 0, at },
                  (float[3]){ x + 0.1f, y + 0.25f, at + 0.25f });
    }
    shape_box(&s, (float[3]){ x - 0.08f, y, z[0] }, (float[3]){ x + 0.1f, y + 0.25f, z[1] });
    factory_put(f, "gate", &s, FACTORY_HAZARD, (place){ 0 });
    // The door, rolled up.
    const float roll[2][3] = { { x - 0.45f, y + 0.55f, z[0] - 0.1f },
                               { x - 0.45f, y + 0.55f, z[1] + 0.1f } };
    shape_tube(&s, &(shape_tube_desc){ roll, 2, 0.32f, 24 });
    factory_put(f, "door", &s, FACTORY_FRAME, (place){ 0 });
    shape_quad(&s, day);
    factory_put(f, "daylight", &s, FACTORY_DAY, (place){ 0 });
}

static void bar(shape *s, const float from[3], const float to[3], float radius)
{
    const float path[2][3] = { { from[0], from[1], from[2] }, { to[0], to[1], to[2] } };
    shape_tube(s, &(shape_tube_desc){ path, 2, radius, 6 });
}

// Across the hall in the plane x = 0: two chords, posts and struts between them.
static int truss_part(factory *f)
{
    enum { PANELS = 12 };
    const float low = 7.65f, high = 8.80f, end = hall_half_z;
    shape s = { 0 };
    bar(&s, (float[3]){ 0, low, -end }, (float[3]){ 0, low, end }, 0.07f);
    bar(&s, (float[3]){ 0, high, -end }, (float[3]){ 0, high, end }, 0.07f);
    for (int i = 0; i < PANELS; ++i) {
        const float a = -end + 2.0f * end * (float) i / PANELS, b = a + 2.0f * end / PANELS;
        const bool up = i % 2 == 0;
        bar(&s, (float[3]){ 0, up ? low : high, a }, (float[3]){ 0, up ? high : low, b }, 0.04f);
        if (i > 0)
            bar(&s, (float[3]){ 0, low, a }, (float[3]){ 0, high, a }, 0.035f);
    }
    return factory_part(f, "truss", &s, FACTORY_STEEL);
}

// An I-beam that stands before a wall at z = 0.
static int column_part(factory *f)
{
    shape s = { 0 };
    shape_box(&s, (float[3]){ -0.15f, 0, -0.02f }, (float[3]){ 0.15f, hall_height, 0.0f });
    shape_box(&s, (float[3]){ -0.012f, 0, -0.30f }, (float[3]){ 0.012f, hall_height, -0.02f });
    shape_box(&s, (float[3]){ -0.15f, 0, -0.32f }, (float[3]){ 0.15f, hall_height, -0.30f });
    shape_box(&s, (float[3]){ -0.22f, 0, -0.40f }, (float[3]){ 0.22f, 0.03f, -0.0f });
    // Carries the crane's rail.
    shape_box(&s, (float[3]){ -0.10f, 6.30f, -0.75f }, (float[3]){ 0.10f, 6.55f, -0.32f });
    return factory_part(f, "column", &s, FACTORY_STEEL);
}

static void add_frames(factory *f)
{
    const int truss = truss_part(f), column = column_part(f);
    const double z = (double) hall_half_z - 0.055, pi = 3.14159265358979;
    for (int i = 0; i < 8; ++i) {
        const double x = (double) hall_bay * (i - 3.5);
        kit_show(&f->k, "truss", truss, -1, (place){ x, 0, 0, 0 });
        kit_show(&f->k, "column", column, -1, (place){ x, 0, z, 0 });
        kit_show(&f->k, "column", column, -1, (place){ x, 0, -z, pi });
    }
    shape s = { 0 };
    for (int i = -3; i <= 3; ++i) {
        const float at = 3.4f * (float) i;
        shape_box(&s, (float[3]){ -hall_half_x, 8.86f, at - 0.06f },
                  (float[3]){ hall_half_x, 9.0f, at + 0.06f });
    }
    for (int i = -1; i <= 1; i += 2) {
        const float at = (float) i * (hall_half_z - 0.62f);
        shape_box(&s, (float[3]){ -hall_half_x, 6.55f, at - 0.10f },
                  (float[3]){ hall_half_x, 6.85f, at + 0.10f });
    }
    factory_put(f, "purlins", &s, FACTORY_STEEL, (place){ 0 });
}

// Walkways along the lines and around their ends.
static void add_markings(factory *f)
{
    const float y = 0.004f, w = 0.06f, x = 15.2f;
    shape s = { 0 };
    for (int i = 0; i < 4; ++i) {
        const float z = (i % 2 ? 6.9f : 5.1f) * (i / 2 ? 1.0f : -1.0f);
        const float strip[4][3] = {
            { -x, y, z + w }, { x, y, z + w }, { x, y, z - w }, { -x, y, z - w }
        };
        shape_quad(&s, strip);
    }
    for (int i = 0; i < 2; ++i) {
        const float at = i ? x : -x;
        const float strip[4][3] = {
            { at - w, y, 5.04f }, { at + w, y, 5.04f }, { at + w, y, -5.04f }, { at - w, y, -5.04f }
        };
        shape_quad(&s, strip);
    }
    factory_put(f, "markings", &s, FACTORY_LINES, (place){ 0 });
}

void factory_add_hall(factory *f)
{
    add_floor_and_roof(f);
    add_walls(f);
    add_gate(f);
    add_frames(f);
    add_markings(f);
}
