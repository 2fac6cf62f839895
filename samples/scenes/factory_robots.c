// SPDX-License-Identifier: MIT
// What moves by itself: robots at the lines, the crane, carts that carry pallets.
#include "factory_priv.h"

#include <math.h>

static const float tau = 6.28318531f;

#define PROFILE(array) (const float(*)[2]) array, FG_COUNT(array)

// ---- robots -------------------------------------------------------------------------

typedef struct robot_parts {
    int base, turret, upper, fore, hand;
} robot_parts;

// Each hangs by its joint at the origin; arms go along +y, the hand too.
static void make_robot(factory *f, robot_parts *p)
{
    static const float foot[][2] = { { 0, 0 },         { 0.46f, 0 },     { 0.46f, 0.06f },
                                     { 0.36f, 0.09f }, { 0.33f, 0.42f }, { 0, 0.42f } };
    static const float elbow[2][3] = { { 0, 1.05f, -0.17f }, { 0, 1.05f, 0.17f } };
    static const float shoulder[2][3] = { { 0, 0, -0.24f }, { 0, 0, 0.24f } };
    static const float wrist[2][3] = { { 0, 0.88f, 0 }, { 0, 1.02f, 0 } };
    shape s = { 0 };
    shape_lathe(&s, &(shape_lathe_desc){ PROFILE(foot), 32, 0, 0 });
    p->base = factory_part(f, "robot foot", &s, FACTORY_FRAME);
    shape_round_box(&s, (float[3]){ -0.34f, 0, -0.28f }, (float[3]){ 0.30f, 0.26f, 0.28f }, 0.08f,
                    3);
    shape_round_box(&s, (float[3]){ -0.22f, 0.15f, -0.15f }, (float[3]){ 0.22f, 0.58f, 0.15f },
                    0.08f, 3);
    p->turret = factory_part(f, "turret", &s, FACTORY_ROBOT);
    shape_tube(&s, &(shape_tube_desc){ shoulder, 2, 0.16f, 24 });
    shape_round_box(&s, (float[3]){ -0.11f, -0.05f, -0.12f }, (float[3]){ 0.11f, 1.10f, 0.12f },
                    0.06f, 3);
    shape_tube(&s, &(shape_tube_desc){ elbow, 2, 0.13f, 24 });
    p->upper = factory_part(f, "upper arm", &s, FACTORY_ROBOT);
    shape_round_box(&s, (float[3]){ -0.14f, -0.16f, -0.11f }, (float[3]){ 0.12f, 0.18f, 0.11f },
                    0.05f, 3);
    shape_round_box(&s, (float[3]){ -0.075f, 0.1f, -0.075f }, (float[3]){ 0.075f, 0.92f, 0.075f },
                    0.04f, 3);
    p->fore = factory_part(f, "forearm", &s, FACTORY_ROBOT);
    shape_tube(&s, &(shape_tube_desc){ wrist, 2, 0.06f, 16 });
    for (int i = 0; i < 2; ++i) {
        const float z = i ? 0.10f : -0.13f;
        shape_box(&s, (float[3]){ -0.03f, 1.02f, z }, (float[3]){ 0.03f, 1.26f, z + 0.03f });
    }
    shape_box(&s, (float[3]){ -0.04f, 1.0f, -0.14f }, (float[3]){ 0.04f, 1.04f, 0.14f });
    p->hand = factory_part(f, "hand", &s, FACTORY_RUBBER);
}

// A node turned by `angle` around z at `at`, on another that swings about that.
static int add_joint(factory *f, int parent, const double at[3], double angle,
                     const kit_swing_desc *swing)
{
    ag_node_desc bent = { .name = "joint",
                          .parent = parent,
                          .translation = { at[0], at[1], at[2] } };
    kit_turn(2, angle, bent.rotation);
    const int node = kit_node(&f->k, "joint", ag_builder_node(f->k.builder, &bent), (place){ 0 });
    kit_swing(&f->k, node, swing);
    return node;
}

static void add_robot(factory *f, const robot_parts *p, int number, place at)
{
    const float phase = 0.31f * (float) number;
    const kit_swing_desc yaw = { 1, 0.55f, phase, factory_period, 8 };
    const kit_swing_desc upper = { 2, 0.20f, phase + 0.2f, factory_period, 16 };
    const kit_swing_desc fore = { 2, 0.28f, phase + 0.45f, factory_period, 16 };
    const kit_swing_desc hand = { 1, 1.2f, phase, factory_period, 8 };
    const int foot = kit_show(&f->k, "robot", p->base, -1, at);
    const int turret = kit_show(&f->k, "turret", p->turret, foot, (place){ 0, 0.42, 0, 0 });
    kit_swing(&f->k, turret, &yaw);
    // Leaning towards +x, the forearm bent down to what is on the belt.
    const int arm = add_joint(f, turret, (const double[3]){ 0.05, 0.45, 0 }, -0.40, &upper);
    ag_builder_show(f->k.builder, arm, p->upper, -1);
    const int elbow = add_joint(f, arm, (const double[3]){ 0, 1.05, 0 }, -1.55, &fore);
    ag_builder_show(f->k.builder, elbow, p->fore, -1);
    const int wrist = kit_show(&f->k, "hand", p->hand, elbow, (place){ 0 });
    kit_swing(&f->k, wrist, &hand);
}

static void add_robots(factory *f)
{
    // Between the lines, turned to one or the other.
    static const double x[4] = { -4.6, 1.4, 4.6, -3.2 };
    robot_parts p;
    make_robot(f, &p);
    for (int i = 0; i < 4; ++i) {
        const bool far = i % 2;
        add_robot(f, &p, i, (place){ x[i], 0, far ? 0.95 : -0.95, far ? -1.5707963 : 1.5707963 });
    }
}

// ---- crane --------------------------------------------------------------------------

static void bridge_moves(const void *user, float t, float out[4])
{
    (void) user;
    out[0] = 9.0f * sinf(tau * t);
}

static void trolley_moves(const void *user, float t, float out[4])
{
    (void) user;
    out[2] = 2.2f * sinf(2.0f * tau * t + 0.6f);
}

static void drive(factory *f, int node, void (*curve)(const void *, float, float[4]))
{
    const kit_motion m = { .node = node,
                           .path = AG_PATH_TRANSLATION,
                           .keys = 97,
                           .seconds = factory_period,
                           .curve = curve };
    kit_move(&f->k, &m);
}

// What hangs from the trolley swings a little.
static void add_load(factory *f, int trolley)
{
    const float cables[2][2][3] = { { { -0.10f, 0, 0 }, { -0.10f, -1.75f, 0 } },
                                    { { 0.10f, 0, 0 }, { 0.10f, -1.75f, 0 } } };
    const float slings[2][2][3] = { { { 0, -1.95f, 0 }, { -0.75f, -2.45f, 0 } },
                                    { { 0, -1.95f, 0 }, { 0.75f, -2.45f, 0 } } };
    const kit_swing_desc swing = { 0, 0.02f, 0.1f, factory_period, 16 };
    shape s = { 0 };
    for (int i = 0; i < 2; ++i) {
        shape_tube(&s, &(shape_tube_desc){ cables[i], 2, 0.012f, 6 });
        shape_tube(&s, &(shape_tube_desc){ slings[i], 2, 0.015f, 6 });
    }
    shape_round_box(&s, (float[3]){ -0.18f, -1.98f, -0.10f }, (float[3]){ 0.18f, -1.70f, 0.10f },
                    0.05f, 2);
    const int node =
        kit_show(&f->k, "hook", factory_part(f, "hook", &s, FACTORY_RUBBER), trolley, (place){ 0 });
    kit_swing(&f->k, node, &swing);
    s.tiling = 0.5f;
    shape_box(&s, (float[3]){ -0.9f, -3.05f, -0.6f }, (float[3]){ 0.9f, -2.45f, 0.6f });
    for (int i = 0; i < 2; ++i)
        shape_box(&s, (float[3]){ i ? 0.55f : -0.63f, -3.10f, -0.62f },
                  (float[3]){ i ? 0.63f : -0.55f, -2.43f, 0.62f });
    kit_show(&f->k, "load", factory_part(f, "load", &s, FACTORY_PALLET), node, (place){ 0 });
}

// A bridge on the rails along the walls, a trolley on the bridge; its light is the crane's.
static void add_crane(factory *f)
{
    const float z = hall_half_z - 0.42f;
    const int root = kit_node(&f->k, "crane", -1, (place){ 0, 6.87, 0, 0 });
    const int bridge = kit_node(&f->k, "bridge", root, (place){ 0 });
    shape s = { 0 };
    for (int i = 0; i < 2; ++i) {
        const float x = i ? 0.35f : -0.60f;
        shape_box(&s, (float[3]){ x, 0, -z }, (float[3]){ x + 0.25f, 0.48f, z });
    }
    for (int i = 0; i < 2; ++i) {
        const float a = i ? z - 0.4f : -z;
        shape_box(&s, (float[3]){ -1.3f, -0.01f, a }, (float[3]){ 1.3f, 0.24f, a + 0.4f });
    }
    ag_builder_show(f->k.builder, bridge, factory_part(f, "bridge", &s, FACTORY_CRANE), -1);
    drive(f, bridge, bridge_moves);
    shape_round_box(&s, (float[3]){ -0.7f, 0.48f, -0.5f }, (float[3]){ 0.7f, 0.70f, 0.5f }, 0.04f,
                    2);
    shape_round_box(&s, (float[3]){ -0.32f, -0.05f, -0.4f }, (float[3]){ 0.32f, 0.50f, 0.4f },
                    0.04f, 2);
    const int trolley = kit_show(&f->k, "trolley", factory_part(f, "trolley", &s, FACTORY_MACHINE),
                                 bridge, (place){ 0 });
    drive(f, trolley, trolley_moves);
    add_load(f, trolley);
    // Beside the load, straight down: -Z to -Y.
    const ag_node_desc aim = { .name = "crane light",
                               .parent = trolley,
                               .translation = { -1.0, -0.12, 0 },
                               .rotation = { -0.70710678118654752, 0, 0, 0.70710678118654752 } };
    const ag_light spot = { .name = "crane light",
                            .kind = AG_LIGHT_SPOT,
                            .intensity = { 110.0f, 119.0f, 125.0f }, // W/sr
                            .cos_inner = cosf(0.35f),
                            .cos_outer = cosf(0.75f) };
    ag_builder_light(f->k.builder, ag_builder_node(f->k.builder, &aim), &spot);
    shape_box(&s, (float[3]){ -1.12f, -0.09f, -0.12f }, (float[3]){ -0.88f, 0.0f, 0.12f });
    kit_show(&f->k, "crane lamp", factory_part(f, "crane lamp", &s, FACTORY_LAMP), trolley,
             (place){ 0 });
}

// ---- carts --------------------------------------------------------------------------

static const float cart_half = 9.6f, cart_radius = 8.1f;

static float cart_way(const void *user, float t)
{
    const float length = 4.0f * cart_half + tau * cart_radius;
    return length * (t + *(const float *) user);
}

static void cart_place(const void *user, float t, float out[4])
{
    (void) kit_oval(cart_half, cart_radius, cart_way(user, t), (float *[2]){ &out[0], &out[2] });
}

static void cart_heading(const void *user, float t, float out[4])
{
    float x, z;
    double q[4];
    kit_turn(
        1, (double) kit_oval(cart_half, cart_radius, cart_way(user, t), (float *[2]){ &x, &z }), q);
    for (int k = 0; k < 4; ++k)
        out[k] = (float) q[k];
}

static void add_carts(factory *f)
{
    static const float where[3] = { 0.08f, 0.45f, 0.73f };
    shape s = { 0 }, dark = { 0 };
    shape_round_box(&s, (float[3]){ -0.45f, 0.07f, -0.80f }, (float[3]){ 0.45f, 0.30f, 0.75f },
                    0.06f, 3);
    shape_round_box(&s, (float[3]){ -0.40f, 0.25f, -0.78f }, (float[3]){ 0.40f, 0.62f, -0.60f },
                    0.05f, 3);
    for (int i = 0; i < 4; ++i) {
        const float x = i % 2 ? 0.36f : -0.46f, z = i / 2 ? 0.5f : -0.5f;
        const float axle[2][3] = { { x, 0.09f, z }, { x + 0.10f, 0.09f, z } };
        shape_tube(&dark, &(shape_tube_desc){ axle, 2, 0.09f, 20 });
    }
    const int body = factory_part(f, "cart", &s, FACTORY_CART),
              wheels = factory_part(f, "wheels", &dark, FACTORY_RUBBER);
    for (int i = 0; i < FG_COUNT(where); ++i) {
        const int node = kit_show(&f->k, "cart", body, -1, (place){ 0 });
        kit_show(&f->k, "wheels", wheels, node, (place){ 0 });
        const int pallet =
            kit_show(&f->k, "pallet", f->goods.pallet, node, (place){ 0, 0.30, 0.08, 1.5707963 });
        kit_show(&f->k, "stack", f->goods.stacks[i], pallet, (place){ 0, 0.14, 0, 0 });
        kit_motion m = { .node = node,
                         .path = AG_PATH_TRANSLATION,
                         .keys = 289,
                         .seconds = factory_period,
                         .curve = cart_place,
                         .user = &where[i] };
        kit_move(&f->k, &m);
        m.path = AG_PATH_ROTATION;
        m.curve = cart_heading;
        kit_move(&f->k, &m);
    }
}

void factory_add_robots(factory *f)
{
    add_robots(f);
    add_crane(f);
    add_carts(f);
}
