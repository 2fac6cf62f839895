// SPDX-License-Identifier: MIT
#include "maze_priv.h"

#include <math.h>

// A draped woman of 1.78 m after the Greek manner, weight on her left leg, a bowl in her right
// hand: a field of balls and bars joined, cloth folded by waves around the body. She looks along
// +Z.

typedef float v3[3];

static float lerp(float a, float b, float t)
{
    return a + (b - a) * t;
}

static float ramp(float lo, float hi, float x)
{
    const float t = fminf(fmaxf((x - lo) / (hi - lo), 0.0f), 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

// Radii of cloth along the height, read off between the knots.
typedef struct girth {
    float y, x, z;
} girth;

static girth girth_at(const girth *knots, int count, float y)
{
    int i = 0;
    while (i + 2 < count && y > knots[i + 1].y)
        ++i;
    const float t = ramp(knots[i].y, knots[i + 1].y, y);
    return (girth){ y, lerp(knots[i].x, knots[i + 1].x, t), lerp(knots[i].z, knots[i + 1].z, t) };
}

// A hollow-less garment: an ellipse at every height, cut off flat at both ends, moved out by
// `fold`.
static float garment(const v3 p, const girth *knots, int count, float fold)
{
    const girth g = girth_at(knots, count, p[1]);
    const float x = p[0] / g.x, z = p[2] / g.z;
    const float side = (sqrtf(x * x + z * z) - 1.0f) * fminf(g.x, g.z) - fold;
    const float low = knots[0].y - p[1], high = p[1] - knots[count - 1].y;
    return fmaxf(side, fmaxf(low, high));
}

// Ridges of cloth, round outside and sharp in the valleys, [0, 1].
static float ridge(float angle)
{
    return 1.0f - fabsf(sinf(angle));
}

static float skirt(const v3 p)
{
    static const girth knots[] = {
        { 0.03f, 0.265f, 0.215f }, { 0.30f, 0.220f, 0.175f }, { 0.60f, 0.200f, 0.155f },
        { 0.92f, 0.185f, 0.140f }, { 1.06f, 0.140f, 0.105f },
    };
    const float around = atan2f(p[0], p[2]), down = ramp(1.0f, 0.1f, p[1]);
    const float wander = 0.5f * sinf(2.3f * p[1] + 1.0f) + 0.35f * sinf(3.0f * around);
    const float wide = ridge(5.0f * around + wander), fine = ridge(11.5f * around - 2.0f * wander);
    // Where the free knee pushes forward the cloth lies smooth.
    const float knee =
        expf(-12.0f * ((p[0] + 0.10f) * (p[0] + 0.10f) + 0.3f * (p[1] - 0.5f) * (p[1] - 0.5f))) *
        (p[2] > 0.0f ? 1.0f : 0.0f);
    const float fold = (0.006f + 0.034f * down) * (wide - 0.7f) + 0.012f * down * (fine - 0.5f);
    return garment(p, knots, FG_COUNT(knots), fold * (1.0f - 0.85f * knee));
}

// What falls from the shoulders over the belt, with a waved hem.
static float overfold(const v3 p)
{
    static const girth knots[] = {
        { 0.80f, 0.225f, 0.175f }, { 0.95f, 0.205f, 0.160f }, { 1.07f, 0.168f, 0.126f },
        { 1.24f, 0.178f, 0.132f }, { 1.36f, 0.185f, 0.115f }, { 1.44f, 0.150f, 0.075f },
    };
    const float around = atan2f(p[0], p[2]);
    const float wander = 0.6f * sinf(3.1f * p[1]) + 0.4f * sinf(2.0f * around);
    const float depth = 0.010f + 0.022f * ramp(1.15f, 0.80f, p[1]);
    const float fold = depth * (ridge(6.0f * around + wander) - 0.6f);
    const v3 q = { p[0], p[1] - 0.035f * sinf(6.0f * around) - 0.02f * sinf(11.0f * around), p[2] };
    return garment(q, knots, FG_COUNT(knots), fold);
}

// A cloak over the left shoulder, down the back and over the forearm.
static float cloak(const v3 p)
{
    const float waves = 0.018f * sinf(46.0f * p[0] + 5.0f * p[1]) + 0.008f * sinf(90.0f * p[0]);
    const v3 q = { p[0], p[1], p[2] - waves };
    static const v3 top = { 0.13f, 1.43f, -0.05f }, foot = { 0.10f, 0.42f, -0.17f };
    static const v3 front = { 0.17f, 1.24f, 0.105f };
    const float drop[3] = { 0.62f, 1.0f, 1.35f }; // flattened: wide across, thin through
    const v3 flat = { q[0] * drop[0], q[1], q[2] * drop[2] };
    const v3 a = { top[0] * drop[0], top[1], top[2] * drop[2] };
    const v3 b = { foot[0] * drop[0], foot[1], foot[2] * drop[2] };
    const v3 c = { front[0] * drop[0], front[1], front[2] * drop[2] };
    const float back = field_bar(flat, a, b, 0.070f, 0.105f);
    const float breast = field_bar(flat, a, c, 0.062f, 0.050f);
    return field_join(fmaxf(back, 0.45f - p[1]), breast, 0.05f);
}

static float body(const v3 p)
{
    float d = field_ball(p, (v3){ 0.01f, 1.24f, 0.0f }, (v3){ 0.160f, 0.215f, 0.112f });
    d = field_join(d,
                   field_bar(p, (v3){ -0.155f, 1.415f, -0.01f }, (v3){ 0.165f, 1.43f, -0.01f },
                             0.060f, 0.060f),
                   0.07f);
    d = field_join(
        d, field_ball(p, (v3){ -0.075f, 1.275f, 0.082f }, (v3){ 0.066f, 0.066f, 0.060f }), 0.04f);
    d = field_join(d, field_ball(p, (v3){ 0.085f, 1.280f, 0.082f }, (v3){ 0.066f, 0.066f, 0.060f }),
                   0.04f);
    d = field_join(
        d,
        field_bar(p, (v3){ 0.005f, 1.42f, -0.01f }, (v3){ 0.005f, 1.56f, 0.012f }, 0.056f, 0.049f),
        0.05f);
    // The free leg shows through the cloth.
    const float thigh =
        field_bar(p, (v3){ -0.085f, 0.93f, 0.02f }, (v3){ -0.10f, 0.52f, 0.135f }, 0.10f, 0.072f);
    const float shin =
        field_bar(p, (v3){ -0.10f, 0.52f, 0.135f }, (v3){ -0.13f, 0.10f, 0.03f }, 0.072f, 0.05f);
    return field_join(d, field_join(thigh, shin, 0.04f), 0.03f);
}

static float arms(const v3 p)
{
    // Her right, held out with the bowl; then her left, which gathers the dress.
    static const v3 joints[2][4] = {
        { { -0.185f, 1.405f, -0.01f },
          { -0.255f, 1.175f, 0.02f },
          { -0.225f, 1.225f, 0.27f },
          { -0.215f, 1.235f, 0.325f } },
        { { 0.195f, 1.415f, -0.01f },
          { 0.275f, 1.165f, -0.03f },
          { 0.250f, 0.945f, 0.095f },
          { 0.243f, 0.895f, 0.115f } },
    };
    float d = 1.0f;
    for (int i = 0; i < 2; ++i) {
        const v3 *j = joints[i];
        float arm = field_bar(p, j[0], j[1], 0.056f, 0.043f);
        arm = field_join(arm, field_bar(p, j[1], j[2], 0.043f, 0.030f), 0.03f);
        arm = field_join(arm, field_ball(p, j[3], (v3){ 0.042f, 0.034f, 0.052f }), 0.03f);
        d = fminf(d, arm);
    }
    const v3 bowl = { -0.205f, 1.315f, 0.335f };
    const float round = field_ball(p, bowl, (v3){ 0.085f, 0.055f, 0.085f });
    const float hollow =
        field_ball(p, (v3){ bowl[0], bowl[1] + 0.025f, bowl[2] }, (v3){ 0.072f, 0.05f, 0.072f });
    const float dish = fmaxf(fmaxf(round, p[1] - bowl[1] - 0.012f), -hollow);
    return fminf(d, dish);
}

static float head(const v3 world)
{
    // Turned a little towards the bowl and bent down: in the head's own axes from the neck.
    const float c = cosf(0.30f), q = sinf(0.30f), x = world[0] - 0.005f, z = world[2] - 0.012f;
    const v3 p = { c * x + q * z, world[1] - 1.655f + 0.10f * z, c * z - q * x };
    float d = field_ball(p, (v3){ 0, 0.010f, 0.0f }, (v3){ 0.074f, 0.104f, 0.092f });
    d = field_join(d, field_ball(p, (v3){ 0, -0.062f, 0.038f }, (v3){ 0.045f, 0.045f, 0.048f }),
                   0.05f);
    // Brow, nose, lips, chin; hollows for the eyes.
    d = field_join(d,
                   field_bar(p, (v3){ -0.032f, 0.026f, 0.079f }, (v3){ 0.032f, 0.026f, 0.079f },
                             0.011f, 0.011f),
                   0.02f);
    d = field_join(
        d, field_bar(p, (v3){ 0, 0.024f, 0.086f }, (v3){ 0, -0.020f, 0.104f }, 0.008f, 0.013f),
        0.012f);
    d = field_join(d, field_ball(p, (v3){ 0, -0.052f, 0.084f }, (v3){ 0.021f, 0.010f, 0.010f }),
                   0.010f);
    d = field_join(d, field_ball(p, (v3){ 0, -0.088f, 0.070f }, (v3){ 0.019f, 0.016f, 0.017f }),
                   0.020f);
    for (int i = -1; i <= 1; i += 2) {
        const v3 eye = { 0.032f * (float) i, 0.002f, 0.092f };
        const float socket = field_ball(p, eye, (v3){ 0.019f, 0.013f, 0.014f });
        d = -field_join(-d, socket, 0.012f);
        d = fminf(d, field_ball(p, (v3){ eye[0], eye[1], 0.074f }, (v3){ 0.013f, 0.010f, 0.011f }));
    }
    // Waved hair from the parting to a knot, bound by a band.
    const float around = atan2f(p[0], -p[2]);
    const float waves = 0.006f * sinf(70.0f * p[1] + 9.0f * fabsf(around));
    float hair = field_ball(p, (v3){ 0, 0.030f, -0.022f }, (v3){ 0.092f, 0.098f, 0.100f }) - waves;
    hair = field_join(
        hair, field_ball(p, (v3){ 0, 0.005f, -0.135f }, (v3){ 0.050f, 0.048f, 0.045f }), 0.03f);
    return field_join(d, hair, 0.008f);
}

static float feet(const v3 p)
{
    const float a = field_ball(p, (v3){ 0.085f, 0.035f, 0.175f }, (v3){ 0.046f, 0.040f, 0.085f });
    const float b = field_ball(p, (v3){ -0.125f, 0.035f, 0.185f }, (v3){ 0.046f, 0.040f, 0.085f });
    const float slab =
        fmaxf(fmaxf(fabsf(p[0]) - 0.34f, fabsf(p[2] - 0.02f) - 0.31f), fabsf(p[1] + 0.03f) - 0.05f);
    return fminf(fminf(a, b), slab);
}

// Parts are left out where they cannot matter: further than the net skips at once (0.2 m).
static float figure(const void *user, const float p[3])
{
    (void) user;
    float d = body(p);
    if (p[1] < 1.3f)
        d = field_join(d, skirt(p), 0.02f);
    if (p[1] > 0.5f && p[1] < 1.7f) {
        d = field_join(d, overfold(p), 0.010f);
        d = field_join(d, arms(p), 0.012f);
    }
    if (p[0] > -0.2f)
        d = field_join(d, cloak(p), 0.010f);
    if (p[1] > 1.3f)
        d = field_join(d, head(p), 0.012f);
    return p[1] < 0.4f ? field_join(d, feet(p), 0.012f) : d;
}

void maze_add_statue(maze *m)
{
    static const float plinth[][2] = {
        { 0, -0.02f },    { 0.62f, -0.02f }, { 0.62f, 0.12f }, { 0.60f, 0.14f }, { 0.56f, 0.18f },
        { 0.52f, 0.20f }, { 0.50f, 0.24f },  { 0.48f, 0.28f }, { 0.48f, 0.62f }, { 0.50f, 0.66f },
        { 0.54f, 0.70f }, { 0.58f, 0.71f },  { 0.58f, 0.80f }, { 0, 0.80f },
    };
    const shape_field_desc woman = { .field = figure,
                                     .lo = { -0.40f, -0.10f, -0.36f },
                                     .hi = { 0.40f, 1.85f, 0.46f },
                                     .cell = 0.013f,
                                     .steepest = 1.6f };
    const shape_lathe_desc foot = { .profile = plinth, .count = FG_COUNT(plinth), .segments = 48 };
    shape s = { 0 }, stone = { .tiling = 1.0f };
    shape_field(&s, &woman);
    shape_lathe(&stone, &foot);
    const place at = { (double) maze_middle(4) + 0.9, 0, (double) maze_middle(4) - 0.35, -1.2 };
    const int node = kit_show(
        &m->k, "plinth", kit_part(&m->k, "plinth", &stone, m->material[MAZE_LIMESTONE]), -1, at);
    const int part = kit_part(&m->k, "statue", &s, m->material[MAZE_MARBLE]);
    kit_show(&m->k, "statue", part, node, (place){ 0, 0.87, 0, 0 });
}
