// SPDX-License-Identifier: MIT
// What moves, shows and lights. All of it repeats after room_period.
//
// Two things give light twice: the lamp by its shade, which is seen and shines as a surface, and by
// two spots that stand for the bulb in it; the window by the evening painted behind it, and by the
// spot that is the sun. Punctual lights are what direct light is made of; what a technique makes of
// surfaces that shine, television and shade and sky, comes on top.
#include "living_room_priv.h"

#include <math.h>
#include <string.h>

static const float tau = 6.28318531f;

static void drive(living_room *r, int node, ag_path path, int keys,
                  void (*curve)(const void *, float, float[4]))
{
    const kit_motion m = {
        .node = node, .path = path, .keys = keys, .seconds = room_period, .curve = curve
    };
    kit_move(&r->k, &m);
}

// ---- television ---------------------------------------------------------------------

enum { FRAMES = 16 };
static const float frame_seconds = 0.5f; // three rounds a period

// The screen shows a sixteenth of the film: the offset steps from picture to picture, and each
// programme is as bright as it is.
static void show_film(living_room *r)
{
    float times[FRAMES + 1], offsets[2 * (FRAMES + 1)], glow[3 * (FRAMES + 1)];
    static const float bright[4] = { 1.1f, 1.3f, 2.6f, 1.1f };
    for (int i = 0; i <= FRAMES; ++i) {
        const int frame = i % FRAMES;
        times[i] = frame_seconds * (float) i;
        const int row = frame / 4;
        float *offset = offsets + 2 * (ptrdiff_t) i, *light = glow + 3 * (ptrdiff_t) i;
        offset[0] = 0.25f * (float) (frame % 4);
        offset[1] = 0.25f * (float) row;
        for (int k = 0; k < 3; ++k)
            light[k] = bright[row] * (frame % 2 ? 0.94f : 1.0f);
    }
    ag_channel_desc channel = { .path = AG_PATH_UV_OFFSET,
                                .interpolation = AG_INTERPOLATE_STEP,
                                .key_count = FRAMES + 1,
                                .times = times,
                                .values = offsets,
                                .animation = r->k.motions++,
                                .material = r->material[ROOM_SCREEN] };
    ag_builder_channel(r->k.builder, &channel);
    channel.path = AG_PATH_EMISSIVE;
    channel.values = glow;
    ag_builder_channel(r->k.builder, &channel);
}

static void add_television(living_room *r)
{
    const float x = 0.62f, y0 = 0.09f, y1 = 0.79f, z = 0.031f;
    const float screen[4][3] = { { -x, y0, z }, { x, y0, z }, { x, y1, z }, { -x, y1, z } };
    shape s = { 0 };
    shape_round_box(&s, (float[3]){ -x - 0.02f, y0 - 0.02f, -0.03f },
                    (float[3]){ x + 0.02f, y1 + 0.02f, 0.03f }, 0.008f, 2);
    shape_box(&s, (float[3]){ -0.05f, 0.01f, -0.04f }, (float[3]){ 0.05f, 0.2f, -0.02f });
    shape_box(&s, (float[3]){ -0.26f, 0, -0.11f }, (float[3]){ 0.26f, 0.012f, 0.11f });
    const int node = room_put(r, "television", &s, ROOM_BLACK, (place){ 0.6, 0.50, -2.16, 0 });
    shape_quad(&s, screen);
    for (size_t i = 0; i < s.vertex_count; ++i) {
        const float inset = 0.5f / 512.0f; // filtering stays within the picture
        s.vertices[i].uv[0][0] = i == 1 || i == 2 ? 0.25f - inset : inset;
        s.vertices[i].uv[0][1] = i < 2 ? 0.25f - inset : inset;
    }
    kit_show(&r->k, "screen", kit_part(&r->k, "screen", &s, r->material[ROOM_SCREEN]), node,
             (place){ 0 });
    show_film(r);
}

// ---- lights -------------------------------------------------------------------------

// A light at `node` that goes straight up or down; -Z turned to it.
static void add_bulb(living_room *r, int node, const char *name, double height, float watts)
{
    const double half = 0.70710678118654752;
    const ag_node_desc aim = { .name = name,
                               .parent = node,
                               .translation = { 0, height, 0 },
                               .rotation = { watts > 0.0f ? half : -half, 0, 0, half } };
    ag_light bulb = ag_default_light();
    bulb.kind = AG_LIGHT_SPOT;
    bulb.intensity[0] = fabsf(watts);
    bulb.intensity[1] = 0.76f * fabsf(watts);
    bulb.intensity[2] = 0.50f * fabsf(watts);
    bulb.cos_inner = cosf(0.50f);
    bulb.cos_outer = cosf(0.82f); // the shade's openings
    memcpy(bulb.name, name, strlen(name) + 1);
    ag_builder_light(r->k.builder, ag_builder_node(r->k.builder, &aim), &bulb);
}

static int add_turned(living_room *r, const char *name, const float (*profile)[2], int count,
                      room_material material)
{
    shape s = { 0 };
    shape_lathe(&s, &(shape_lathe_desc){ profile, count, 36, 0, 0 });
    return kit_part(&r->k, name, &s, r->material[material]);
}

#define PROFILE(array) (const float(*)[2]) array, FG_COUNT(array)

// One that stands on the floor and one on the sideboard.
static void add_lamps(living_room *r)
{
    static const float pole[][2] = { { 0, 0 },          { 0.15f, 0 },      { 0.155f, 0.015f },
                                     { 0.14f, 0.03f },  { 0.03f, 0.045f }, { 0.014f, 0.07f },
                                     { 0.012f, 1.42f }, { 0.02f, 1.43f },  { 0.02f, 1.50f },
                                     { 0, 1.51f } };
    static const float belly[][2] = { { 0, 0 },          { 0.07f, 0 },      { 0.075f, 0.01f },
                                      { 0.115f, 0.10f }, { 0.11f, 0.17f },  { 0.05f, 0.25f },
                                      { 0.02f, 0.28f },  { 0.015f, 0.36f }, { 0, 0.37f } };
    static const float shade[][2] = { { 0.235f, -0.14f },
                                      { 0.175f, 0.16f },
                                      { 0.171f, 0.16f },
                                      { 0.231f, -0.14f },
                                      { 0.235f, -0.14f } };
    const int shaded = add_turned(r, "shade", PROFILE(shade), ROOM_SHADE);
    const int tall = add_turned(r, "pole", PROFILE(pole), ROOM_BRASS);
    const int low = add_turned(r, "belly", PROFILE(belly), ROOM_PORCELAIN);
    const int floor = kit_show(&r->k, "lamp", tall, -1, (place){ -0.62, 0, -1.95, 0 });
    const int table = kit_show(&r->k, "table lamp", low, -1, (place){ -1.75, 0.50, 2.16, 0 });
    kit_show(&r->k, "shade", shaded, floor, (place){ 0, 1.54, 0, 0 });
    kit_show(&r->k, "shade", shaded, table, (place){ 0, 0.42, 0, 0 });
    add_bulb(r, floor, "lamp down", 1.52, -16.0f);
    add_bulb(r, floor, "lamp up", 1.55, 8.0f);
    add_bulb(r, table, "table lamp down", 0.40, -10.0f);
    add_bulb(r, table, "table lamp up", 0.43, 14.0f);
}

static void sun_moves(const void *user, float t, float out[4])
{
    (void) user;
    out[0] = 10.2f;
    out[1] = 4.15f + 0.55f * cosf(tau * t);
    out[2] = 1.3f + 1.3f * sinf(tau * t);
}

// It keeps looking at the window's middle.
static void sun_aims(const void *user, float t, float out[4])
{
    float at[4] = { 0 };
    sun_moves(user, t, at);
    kit_aim_curve(
        (const double[3]){ 3.2 - (double) at[0], 1.3 - (double) at[1], -0.1 - (double) at[2] },
        out);
}

static void add_sun(living_room *r)
{
    const int node = kit_node(&r->k, "sun", -1, (place){ 0 });
    const ag_light spot = { .name = "sun",
                            .kind = AG_LIGHT_SPOT,
                            .intensity = { 1150.0f, 820.0f,
                                           470.0f }, // W/sr, 22 W/m^2 at the window
                            .cos_inner = cosf(0.20f),
                            .cos_outer = cosf(0.26f) };
    drive(r, node, AG_PATH_TRANSLATION, 49, sun_moves);
    drive(r, node, AG_PATH_ROTATION, 49, sun_aims);
    ag_builder_light(r->k.builder, node, &spot);
}

// In the middle of the window, looking in and a little down: what the sky gives.
static void add_sky(living_room *r)
{
    ag_node_desc aim = { .name = "sky", .parent = -1, .translation = { 3.42, 1.45, -0.1 } };
    const ag_light spot = { .name = "sky",
                            .kind = AG_LIGHT_SPOT,
                            .intensity = { 6.0f, 6.6f, 7.5f }, // W/sr
                            .cos_inner = cosf(0.5f),
                            .cos_outer = cosf(1.04f) };
    kit_aim((const double[3]){ -1.0, -0.12, 0.0 }, aim.rotation);
    ag_builder_light(r->k.builder, ag_builder_node(r->k.builder, &aim), &spot);
}

// ---- the ceiling fan ----------------------------------------------------------------

static void fan_turns(const void *user, float t, float out[4])
{
    double q[4];
    (void) user;
    kit_turn(1, 8.0 * (double) (tau * t), q);
    for (int k = 0; k < 4; ++k)
        out[k] = (float) q[k];
}

static void add_fan(living_room *r)
{
    static const float hub[][2] = { { 0, -0.42f },      { 0.05f, -0.41f }, { 0.10f, -0.38f },
                                    { 0.105f, -0.32f }, { 0.08f, -0.29f }, { 0.015f, -0.28f },
                                    { 0.015f, -0.04f }, { 0.06f, -0.03f }, { 0.065f, 0.0f },
                                    { 0, 0.005f } };
    const shape_lathe_desc turned = { hub, FG_COUNT(hub), 24, 0, 0 };
    shape s = { .tiling = 1 };
    shape_lathe(&s, &turned);
    const int node =
        room_put(r, "fan hub", &s, ROOM_BRASS, (place){ 0.4, (double) room_height, 0.0, 0 });
    for (int i = 0; i < 4; ++i) {
        const size_t first = s.vertex_count;
        shape_round_box(&s, (float[3]){ 0.09f, -0.355f, -0.065f },
                        (float[3]){ 0.66f, -0.345f, 0.065f }, 0.005f, 2);
        shape_move(&s, first, (float[3]){ 0, 0, 0 }, 0.25f * tau * (float) i);
    }
    const int blades = kit_show(&r->k, "fan", kit_part(&r->k, "fan", &s, r->material[ROOM_OAK]),
                                node, (place){ 0 });
    drive(r, blades, AG_PATH_ROTATION, 8 * 8 + 1, fan_turns);
}

// ---- the clock ----------------------------------------------------------------------

static void add_clock(living_room *r)
{
    shape s = { .tiling = 1 };
    // A case open in front, with its head; the back stands at z = 0.
    shape_box(&s, (float[3]){ -0.17f, 0, 0 }, (float[3]){ 0.17f, 0.30f, 0.20f });
    shape_box(&s, (float[3]){ -0.14f, 0.30f, 0 }, (float[3]){ 0.14f, 1.35f, 0.02f });
    shape_box(&s, (float[3]){ -0.14f, 0.30f, 0.02f }, (float[3]){ -0.115f, 1.35f, 0.17f });
    shape_box(&s, (float[3]){ 0.115f, 0.30f, 0.02f }, (float[3]){ 0.14f, 1.35f, 0.17f });
    shape_box(&s, (float[3]){ -0.18f, 1.35f, 0 }, (float[3]){ 0.18f, 1.78f, 0.20f });
    shape_box(&s, (float[3]){ -0.20f, 1.78f, 0 }, (float[3]){ 0.20f, 1.82f, 0.22f });
    const int node = room_put(r, "clock", &s, ROOM_DARK_WOOD, (place){ 1.98, 0, -2.395, 0 });
    static const float dial[][2] = { { 0, 0 }, { 0.13f, 0 }, { 0.14f, 0.008f }, { 0, 0.012f } };
    const shape_lathe_desc turned = { dial, FG_COUNT(dial), 32, 0, 0 };
    const double quarter[4] = { 0.70710678118654752, 0, 0, 0.70710678118654752 };
    shape_lathe(&s, &turned);
    ag_node_desc facing = { .name = "dial", .parent = node, .translation = { 0, 1.57, 0.198 } };
    memcpy(facing.rotation, quarter, sizeof quarter);
    ag_builder_show(r->k.builder, ag_builder_node(r->k.builder, &facing),
                    kit_part(&r->k, "dial", &s, r->material[ROOM_PORCELAIN]), -1);
    shape_box(&s, (float[3]){ -0.005f, 0, 0.212f }, (float[3]){ 0.005f, 0.10f, 0.216f });
    shape_box(&s, (float[3]){ 0, -0.006f, 0.212f }, (float[3]){ 0.07f, 0.006f, 0.217f });
    kit_show(&r->k, "hands", kit_part(&r->k, "hands", &s, r->material[ROOM_BLACK]), node,
             (place){ 0, 1.57, 0, 0 });
    shape_box(&s, (float[3]){ -0.006f, -0.78f, 0.085f }, (float[3]){ 0.006f, 0, 0.091f });
    shape_sphere(&s, (float[3]){ 0, -0.78f, 0.088f }, 0.05f, 24);
    const int pendulum =
        kit_show(&r->k, "pendulum", kit_part(&r->k, "pendulum", &s, r->material[ROOM_BRASS]), node,
                 (place){ 0, 1.33, 0, 0 });
    const kit_swing_desc swing = {
        .axis = 2, .amplitude = 0.05f, .phase = 0.1f, .seconds = room_period, .count = 12
    };
    kit_swing(&r->k, pendulum, &swing);
}

// ---- the toy train ------------------------------------------------------------------

static const float track_half = 0.62f, track_radius = 0.62f; // two straights and two half rings

static float track_at(float way, float *x, float *z)
{
    return kit_oval(track_half, track_radius, way, (float *[2]){ x, z });
}

static float wagon_way(const void *user, float t)
{
    const float length = tau * track_radius + 4.0f * track_half;
    return 4.0f * length * t - 0.19f * (float) *(const int *) user; // four rounds a period
}

static void wagon_place(const void *user, float t, float out[4])
{
    (void) track_at(wagon_way(user, t), &out[0], &out[2]);
}

static void wagon_heading(const void *user, float t, float out[4])
{
    float x, z;
    double q[4];
    kit_turn(1, (double) track_at(wagon_way(user, t), &x, &z), q);
    for (int k = 0; k < 4; ++k)
        out[k] = (float) q[k];
}

static void add_wagon(living_room *r, int parent, int number)
{
    static const float paints[4][3] = { { 0.60f, 0.05f, 0.04f },
                                        { 0.08f, 0.25f, 0.55f },
                                        { 0.70f, 0.50f, 0.05f },
                                        { 0.10f, 0.38f, 0.12f } };
    static const float iron[3] = { 0.12f, 0.12f, 0.12f };
    shape s = { 0 };
    shape_box(&s, (float[3]){ -0.038f, 0.022f, -0.075f }, (float[3]){ 0.038f, 0.034f, 0.075f });
    for (int i = 0; i < 4; ++i) {
        const float x = i % 2 ? 0.040f : -0.040f, z = i / 2 ? 0.045f : -0.045f;
        const float axle[2][3] = { { x - 0.006f, 0.022f, z }, { x + 0.006f, 0.022f, z } };
        shape_tube(&s, &(shape_tube_desc){ axle, 2, 0.020f, 14 });
    }
    shape_paint(&s, 0, iron);
    const size_t body = s.vertex_count;
    if (number == 0) { // the engine
        const float boiler[2][3] = { { 0, 0.068f, -0.072f }, { 0, 0.068f, 0.02f } };
        const float funnel[2][3] = { { 0, 0.09f, -0.05f }, { 0, 0.135f, -0.05f } };
        shape_tube(&s, &(shape_tube_desc){ boiler, 2, 0.033f, 20 });
        shape_tube(&s, &(shape_tube_desc){ funnel, 2, 0.011f, 14 });
        shape_box(&s, (float[3]){ -0.036f, 0.034f, 0.02f }, (float[3]){ 0.036f, 0.125f, 0.073f });
        shape_box(&s, (float[3]){ -0.042f, 0.125f, 0.012f }, (float[3]){ 0.042f, 0.132f, 0.08f });
    } else {
        shape_round_box(&s, (float[3]){ -0.037f, 0.034f, -0.072f },
                        (float[3]){ 0.037f, 0.095f, 0.072f }, 0.006f, 2);
    }
    shape_paint(&s, body, paints[number]);
    const int node = kit_show(&r->k, "wagon", kit_part(&r->k, "wagon", &s, r->material[ROOM_TOY]),
                              parent, (place){ 0 });
    kit_motion m = { .node = node,
                     .path = AG_PATH_TRANSLATION,
                     .keys = 481,
                     .seconds = room_period,
                     .curve = wagon_place,
                     .user = &number };
    kit_move(&r->k, &m);
    m.path = AG_PATH_ROTATION;
    m.curve = wagon_heading;
    kit_move(&r->k, &m);
}

static void add_train(living_room *r)
{
    enum { TIES = 56 };
    const float length = tau * track_radius + 4.0f * track_half;
    shape s = { .tiling = 1 };
    for (int i = 0; i < TIES; ++i) {
        float x, z;
        const float heading = track_at(length * (float) i / TIES, &x, &z);
        const size_t first = s.vertex_count;
        shape_box(&s, (float[3]){ -0.045f, 0, -0.008f }, (float[3]){ 0.045f, 0.005f, 0.008f });
        shape_move(&s, first, (float[3]){ x, 0, z }, heading);
    }
    const int node = room_put(r, "track", &s, ROOM_OAK, (place){ 0.5, 0.012, -0.02, 0 });
    float rail[2][TIES + 1][3];
    for (int i = 0; i <= TIES; ++i) {
        float x, z;
        const float heading = track_at(length * (float) (i % TIES) / TIES, &x, &z);
        for (int side = 0; side < 2; ++side) {
            const float off = side ? 0.030f : -0.030f;
            rail[side][i][0] = x + off * cosf(heading);
            rail[side][i][1] = 0.007f;
            rail[side][i][2] = z - off * sinf(heading);
        }
    }
    for (int side = 0; side < 2; ++side)
        shape_tube(&s, &(shape_tube_desc){ (const float(*)[3]) rail[side], TIES + 1, 0.003f, 6 });
    kit_show(&r->k, "rails", kit_part(&r->k, "rails", &s, r->material[ROOM_BRASS]), node,
             (place){ 0 });
    for (int i = 0; i < 4; ++i)
        add_wagon(r, node, i);
}

void room_add_life(living_room *r)
{
    add_sun(r);
    add_sky(r);
    add_lamps(r);
    add_television(r);
    add_fan(r);
    add_clock(r);
    add_train(r);
}
