// SPDX-License-Identifier: MIT
// Two belts, what runs on them, and the chain above.
#include "factory_priv.h"

#include <math.h>

enum { PER_LINE = 12 };
static const float line_seconds = 24.0f; // from end to end: 24 m at 1 m/s
static const float belt_half = 0.5f;     // its width

// ---- belts --------------------------------------------------------------------------

// The texture is a metre long and goes a metre a second towards its chevrons' point.
static void run_belt(factory *f)
{
    static const float times[2] = { 0, 1 }, offsets[4] = { 0, 0, 0, -1 };
    const ag_channel_desc channel = { .path = AG_PATH_UV_OFFSET,
                                      .key_count = 2,
                                      .times = times,
                                      .values = offsets,
                                      .animation = f->k.motions++,
                                      .material = f->material[FACTORY_BELT] };
    ag_builder_channel(f->k.builder, &channel);
}

// Runs to +x at the origin; what is on it stands at line_height.
static int belt_part(factory *f)
{
    const float x = line_half + 1.2f, z = belt_half, y = line_height;
    shape s = { 0 };
    for (int i = 0; i < 4; ++i) {
        const float at[3] = { i & 1 ? x : -x, y, i & 2 ? -z : z }, up[3] = { 0, 1, 0 };
        shape_vertex(&s, at, up, i & 2 ? 1.0f : 0.0f, at[0]);
    }
    if (!s.failed)
        shape_lattice(&s, 0, 1, 1);
    return factory_part(f, "belt", &s, FACTORY_BELT);
}

static int frame_part(factory *f)
{
    const float x = line_half + 1.2f, y = line_height, z = belt_half;
    shape s = { 0 };
    for (int i = 0; i < 2; ++i) {
        const float a = i ? z : -z - 0.06f;
        shape_box(&s, (float[3]){ -x, y - 0.16f, a }, (float[3]){ x, y + 0.05f, a + 0.06f });
    }
    shape_box(&s, (float[3]){ -x, y - 0.13f, -z }, (float[3]){ x, y - 0.02f, z });
    for (int i = 0; i < 11; ++i) {
        const float at = -10.0f + 2.0f * (float) i;
        for (int k = 0; k < 2; ++k) {
            const float a = k ? z - 0.02f : -z - 0.04f;
            shape_box(&s, (float[3]){ at - 0.03f, 0, a },
                      (float[3]){ at + 0.03f, y - 0.16f, a + 0.06f });
        }
        shape_box(&s, (float[3]){ at - 0.02f, 0.18f, -z }, (float[3]){ at + 0.02f, 0.22f, z });
    }
    return factory_part(f, "conveyor", &s, FACTORY_FRAME);
}

// What a line comes out of and goes into: a tunnel at the origin that is open to +x, its back at
// x = -3.1.
static void add_machine(factory *f, place at)
{
    const float back = -3.1f, y = 2.3f, in = 0.72f, out = 1.25f, door = 1.70f;
    shape s = { 0 };
    shape_round_box(&s, (float[3]){ back, 0, -out }, (float[3]){ 0, y, -in }, 0.05f, 2);
    shape_round_box(&s, (float[3]){ back, 0, in }, (float[3]){ 0, y, out }, 0.05f, 2);
    shape_box(&s, (float[3]){ back + 0.02f, door, -in - 0.02f },
              (float[3]){ -0.03f, y - 0.02f, in + 0.02f });
    shape_box(&s, (float[3]){ back + 0.02f, 0, -in - 0.02f },
              (float[3]){ back + 0.3f, door, in + 0.02f });
    shape_round_box(&s, (float[3]){ -2.4f, y - 0.03f, -0.7f }, (float[3]){ -0.9f, y + 0.55f, 0.7f },
                    0.06f, 2);
    const int node = factory_put(f, "machine", &s, FACTORY_MACHINE, at);
    // Strips hang before the opening.
    for (int i = 0; i < 7; ++i) {
        const float z = -in + 0.205f * (float) i;
        shape_box(&s,
                  (float[3]){ -0.14f - 0.012f * (float) (i % 2), line_height + 0.12f, z + 0.004f },
                  (float[3]){ -0.134f - 0.012f * (float) (i % 2), door, z + 0.205f });
    }
    kit_show(&f->k, "strips", factory_part(f, "strips", &s, FACTORY_RUBBER), node, (place){ 0 });
    s.tiling = 2.0f;
    shape_box(&s, (float[3]){ -0.02f, door, -in }, (float[3]){ 0.02f, door + 0.16f, in });
    kit_show(&f->k, "edge", factory_part(f, "edge", &s, FACTORY_HAZARD), node, (place){ 0 });
    // A pipe into the roof and a desk beside it.
    const float pipe[4][3] = {
        { -1.6f, y + 0.5f, 0 }, { -1.6f, 5.6f, 0 }, { -2.0f, 6.2f, 0 }, { -2.0f, hall_height, 0 }
    };
    shape_tube(&s, &(shape_tube_desc){ pipe, 4, 0.22f, 16 });
    shape_box(&s, (float[3]){ -1.3f, 0.0f, out + 0.25f }, (float[3]){ -0.7f, 0.95f, out + 0.65f });
    shape_box(&s, (float[3]){ -1.28f, 0.95f, out + 0.27f },
              (float[3]){ -0.72f, 1.35f, out + 0.35f });
    kit_show(&f->k, "pipe", factory_part(f, "pipe", &s, FACTORY_FRAME), node, (place){ 0 });
    // Doors with handles, and slits below.
    for (int i = 0; i < 4; ++i) {
        const float z = i % 2 ? out : -out - 0.015f, left = i / 2 ? -1.45f : -2.85f;
        shape_box(&s, (float[3]){ left, 0.75f, z }, (float[3]){ left + 1.2f, 2.0f, z + 0.015f });
        shape_box(&s, (float[3]){ left + 0.08f, 1.25f, z - 0.03f },
                  (float[3]){ left + 0.12f, 1.45f, z + 0.045f });
        for (int k = 0; k < 5; ++k) {
            const float y0 = 0.22f + 0.08f * (float) k;
            shape_box(&s, (float[3]){ left, y0, z },
                      (float[3]){ left + 1.2f, y0 + 0.04f, z + 0.015f });
        }
    }
    kit_show(&f->k, "doors", factory_part(f, "doors", &s, FACTORY_CART), node, (place){ 0 });
    const float post[2][3] = { { -0.2f, y - 0.1f, out - 0.2f }, { -0.2f, y + 0.35f, out - 0.2f } };
    shape_tube(&s, &(shape_tube_desc){ post, 2, 0.025f, 8 });
    kit_show(&f->k, "post", factory_part(f, "post", &s, FACTORY_RUBBER), node, (place){ 0 });
    shape_sphere(&s, (float[3]){ -0.2f, y + 0.42f, out - 0.2f }, 0.09f, 16);
    kit_show(&f->k, "beacon", factory_part(f, "beacon", &s, FACTORY_BEACON), node, (place){ 0 });
}

// ---- goods on them ------------------------------------------------------------------

// From one machine to the other in even time; then back at once, within both, unseen.
static void ride(factory *f, int node, float start)
{
    const float instant = 1e-3f, length = 2.0f * line_half,
                end = line_seconds * (1.0f - start / length);
    const float times[4] = { 0, end - instant, end, line_seconds };
    const float from = start - line_half, to = line_half;
    const float values[12] = { from, 0, 0, to - instant, 0, 0, -to, 0, 0, from, 0, 0 };
    const bool whole = start <= 0.0f; // one that starts at the beginning is back at the end
    const ag_channel_desc channel = { .node = node,
                                      .path = AG_PATH_TRANSLATION,
                                      .key_count = whole ? 3 : 4,
                                      .times = times,
                                      .values = values,
                                      .animation = f->k.motions++ };
    ag_builder_channel(f->k.builder, &channel);
}

static void add_line(factory *f, int line, int belt, int frame)
{
    const place at = { 0, 0, (double) (line ? line_z : -line_z), line ? 3.14159265358979 : 0 };
    const int root = kit_show(&f->k, "conveyor", frame, -1, at);
    kit_show(&f->k, "belt", belt, root, (place){ 0 });
    for (int i = 0; i < PER_LINE; ++i) {
        const int kind = (5 * i + line) % 3;
        const int part = kind == 0   ? f->goods.carton
                         : kind == 1 ? f->goods.crate
                                     : f->goods.white_carton;
        const int node = kit_node(&f->k, "goods", root, (place){ 0 });
        const double yaw = 0.12 * ((i * 7 + line) % 5 - 2);
        kit_show(&f->k, "goods", part, node, (place){ 0, (double) line_height + 0.001, 0, yaw });
        ride(f, node, 2.0f * line_half * (float) i / PER_LINE);
    }
}

// ---- the chain ----------------------------------------------------------------------

static const float chain_half = 8.0f, chain_radius = 6.0f, chain_y = 5.35f;
enum { CARRIERS = 18 };

static float chain_length(void)
{
    return 4.0f * chain_half + 6.28318531f * chain_radius;
}

static float carrier_way(const void *user, float t)
{
    const int number = *(const int *) user;
    return chain_length() * (t + ((float) number + 0.5f) / CARRIERS);
}

static void carrier_place(const void *user, float t, float out[4])
{
    (void) kit_oval(chain_half, chain_radius, carrier_way(user, t),
                    (float *[2]){ &out[0], &out[2] });
}

static void carrier_heading(const void *user, float t, float out[4])
{
    float x, z;
    double q[4];
    kit_turn(
        1,
        (double) kit_oval(chain_half, chain_radius, carrier_way(user, t), (float *[2]){ &x, &z }),
        q);
    for (int k = 0; k < 4; ++k)
        out[k] = (float) q[k];
}

// A hook with a rod and a painted panel.
static void carrier_parts(factory *f, int parts[2])
{
    const float rod[2][3] = { { 0, 0.05f, 0 }, { 0, -0.75f, 0 } };
    shape s = { 0 };
    shape_box(&s, (float[3]){ -0.05f, -0.02f, -0.12f }, (float[3]){ 0.05f, 0.12f, 0.12f });
    shape_tube(&s, &(shape_tube_desc){ rod, 2, 0.016f, 8 });
    shape_box(&s, (float[3]){ -0.03f, -0.78f, -0.5f }, (float[3]){ 0.03f, -0.74f, 0.5f });
    parts[0] = factory_part(f, "hook", &s, FACTORY_RUBBER);
    shape_round_box(&s, (float[3]){ -0.06f, -1.65f, -0.55f }, (float[3]){ 0.06f, -0.80f, 0.55f },
                    0.05f, 3);
    shape_round_box(&s, (float[3]){ -0.075f, -1.25f, -0.42f }, (float[3]){ 0.075f, -0.92f, 0.30f },
                    0.03f, 2);
    parts[1] = factory_part(f, "panel", &s, FACTORY_ROBOT);
}

static void add_chain(factory *f)
{
    enum { STEPS = 72 };
    float rail[STEPS + 1][3];
    int parts[2];
    shape s = { 0 };
    for (int i = 0; i <= STEPS; ++i) {
        rail[i][1] = chain_y + 0.16f;
        (void) kit_oval(chain_half, chain_radius, chain_length() * (float) (i % STEPS) / STEPS,
                        (float *[2]){ &rail[i][0], &rail[i][2] });
        const float hanger[2][3] = { { rail[i][0], chain_y + 0.16f, rail[i][2] },
                                     { rail[i][0], 7.66f, rail[i][2] } };
        if (i % 6 == 0 && i < STEPS)
            shape_tube(&s, &(shape_tube_desc){ hanger, 2, 0.02f, 6 });
    }
    shape_tube(&s, &(shape_tube_desc){ (const float(*)[3]) rail, STEPS + 1, 0.06f, 8 });
    factory_put(f, "chain", &s, FACTORY_CRANE, (place){ 0 });
    carrier_parts(f, parts);
    for (int i = 0; i < CARRIERS; ++i) {
        const int root = kit_node(&f->k, "carrier", -1, (place){ 0, (double) chain_y, 0, 0 });
        const int node = kit_show(&f->k, "carrier", parts[0], root, (place){ 0 });
        kit_show(&f->k, "panel", parts[1], node, (place){ 0 });
        kit_motion m = { .node = node,
                         .path = AG_PATH_TRANSLATION,
                         .keys = 289,
                         .seconds = factory_period,
                         .curve = carrier_place,
                         .user = &i };
        kit_move(&f->k, &m);
        m.path = AG_PATH_ROTATION;
        m.curve = carrier_heading;
        kit_move(&f->k, &m);
    }
}

void factory_add_lines(factory *f)
{
    const int belt = belt_part(f), frame = frame_part(f);
    run_belt(f);
    for (int line = 0; line < 2; ++line) {
        const double z = (double) (line ? line_z : -line_z), x = (double) line_half - 1.0;
        add_line(f, line, belt, frame);
        add_machine(f, (place){ -x, 0, z, 0 });
        add_machine(f, (place){ x, 0, z, 3.14159265358979 });
    }
    add_chain(f);
}
