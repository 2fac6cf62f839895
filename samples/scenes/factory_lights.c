// SPDX-License-Identifier: MIT
// What lights the hall. Each lamp gives light twice: by a punctual light, and a little by its
// glass, which shines as a surface. So does the gate: a spot is the sun outside, a card the sky.
#include "factory_priv.h"

#include <math.h>

#define PROFILE(array) (const float(*)[2]) array, FG_COUNT(array)

static const float tau = 6.28318531f;

// Two rows of bells under the roof, in every second bay.
static void add_roof_lamps(factory *f)
{
    static const float bell[][2] = {
        { 0.30f, 0 }, { 0.26f, 0.16f }, { 0.12f, 0.26f }, { 0.10f, 0.42f }, { 0, 0.43f }
    };
    static const float glass[][2] = {
        { 0, 0.035f }, { 0.285f, 0.035f }, { 0.275f, 0.05f }, { 0, 0.055f }
    };
    shape s = { 0 };
    shape_lathe(&s, &(shape_lathe_desc){ PROFILE(bell), 24, 0, 0 });
    const float stem[2][3] = { { 0, 0.40f, 0 }, { 0, 0.80f, 0 } };
    shape_tube(&s, &(shape_tube_desc){ stem, 2, 0.02f, 8 });
    const int cover = factory_part(f, "bell", &s, FACTORY_FRAME);
    shape_lathe(&s, &(shape_lathe_desc){ PROFILE(glass), 24, 0, 0 });
    const int disc = factory_part(f, "glass", &s, FACTORY_LAMP);
    for (int i = 0; i < 6; ++i) {
        const double x = 2.0 * (double) hall_bay * (i % 3 - 1);
        const int node =
            kit_show(&f->k, "roof lamp", cover, -1, (place){ x, 8.25, i < 3 ? -4.2 : 4.2, 0 });
        kit_show(&f->k, "glass", disc, node, (place){ 0 });
        const ag_node_desc aim = { .name = "roof lamp",
                                   .parent = node,
                                   .rotation = { -0.70710678118654752, 0, 0,
                                                 0.70710678118654752 } };
        ag_light spot = { .name = "roof lamp 0",
                          .kind = AG_LIGHT_SPOT,
                          .intensity = { 360.0f, 347.0f, 318.0f }, // W/sr
                          .cos_inner = cosf(0.45f),
                          .cos_outer = cosf(1.045f) };
        spot.name[10] = (char) ('1' + i);
        ag_builder_light(f->k.builder, ag_builder_node(f->k.builder, &aim), &spot);
    }
}

// A bare bulb on a cord under a tin hat, between the machines that are far from the gate.
static void add_bulb(factory *f)
{
    static const float hat[][2] = {
        { 0.32f, 0.42f }, { 0.30f, 0.46f }, { 0.05f, 0.56f }, { 0, 0.57f }
    };
    shape s = { 0 };
    shape_lathe(&s, &(shape_lathe_desc){ PROFILE(hat), 24, 0, 0 });
    const float cord[2][3] = { { 0, 0.56f, 0 }, { 0, 5.8f, 0 } };
    shape_tube(&s, &(shape_tube_desc){ cord, 2, 0.012f, 6 });
    const int node = factory_put(f, "hat", &s, FACTORY_FRAME, (place){ -13.6, 3.2, 0, 0 });
    const ag_light point = { .name = "bulb", .intensity = { 30.0f, 21.6f, 12.6f } }; // W/sr
    ag_builder_light(f->k.builder, node, &point);
}

static void sun_moves(const void *user, float t, float out[4])
{
    (void) user;
    out[0] = 27.0f;
    out[1] = 6.4f + 0.5f * cosf(tau * t);
    out[2] = 7.6f + 1.2f * sinf(tau * t);
}

static void sun_aims(const void *user, float t, float out[4])
{
    float at[4] = { 0 };
    sun_moves(user, t, at);
    kit_aim_curve(
        (const double[3]){ 20.0 - (double) at[0], 2.0 - (double) at[1], 7.1 - (double) at[2] },
        out);
}

static void add_sun(factory *f)
{
    const int node = kit_node(&f->k, "sun", -1, (place){ 0 });
    kit_motion m = { .node = node,
                     .path = AG_PATH_TRANSLATION,
                     .keys = 49,
                     .seconds = factory_period,
                     .curve = sun_moves };
    const ag_light spot = { .name = "sun",
                            .kind = AG_LIGHT_SPOT,
                            .intensity = { 1500.0f, 1380.0f,
                                           1150.0f }, // W/sr, 22 W/m^2 at the gate
                            .cos_inner = cosf(0.34f),
                            .cos_outer = cosf(0.42f) };
    kit_move(&f->k, &m);
    m.path = AG_PATH_ROTATION;
    m.curve = sun_aims;
    kit_move(&f->k, &m);
    ag_builder_light(f->k.builder, node, &spot);
}

// The beacons on the machines: half a second bright, half a second dark.
static void blink(factory *f)
{
    static const float times[3] = { 0, 0.5f, 1 },
                       glow[9] = { 7, 2.4f, 0.2f, 0.3f, 0.1f, 0.01f, 7, 2.4f, 0.2f };
    const ag_channel_desc channel = { .path = AG_PATH_EMISSIVE,
                                      .interpolation = AG_INTERPOLATE_STEP,
                                      .key_count = 3,
                                      .times = times,
                                      .values = glow,
                                      .animation = f->k.motions++,
                                      .material = f->material[FACTORY_BEACON] };
    ag_builder_channel(f->k.builder, &channel);
}

void factory_add_lights(factory *f)
{
    add_roof_lamps(f);
    add_bulb(f);
    add_sun(f);
    blink(f);
}
