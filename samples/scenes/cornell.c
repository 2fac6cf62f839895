// SPDX-License-Identifier: MIT
#include "builtin.h"
#include "kit.h"

#include <math.h>
#include <stdio.h>

// The Cornell box as measured: Cornell University Program of Computer Graphics, "Cornell Box
// Data", coordinates in millimetres. The room is not quite a box, and its front is open.
// The reflectances stand for the measured spectra by the linear RGB values in common use, those
// of "CornellBox-Original" in McGuire's Computer Graphics Archive.

typedef float quad[4][3];

// Corners in the published order, which winds every face towards the room.
static const quad floor_quad = {
    { 552.8f, 0, 0 }, { 0, 0, 0 }, { 0, 0, 559.2f }, { 549.6f, 0, 559.2f }
};
static const quad ceiling_quad = {
    { 556.0f, 548.8f, 0 }, { 556.0f, 548.8f, 559.2f }, { 0, 548.8f, 559.2f }, { 0, 548.8f, 0 }
};
static const quad back_quad = {
    { 549.6f, 0, 559.2f }, { 0, 0, 559.2f }, { 0, 548.8f, 559.2f }, { 556.0f, 548.8f, 559.2f }
};
static const quad green_quad = {
    { 0, 0, 559.2f }, { 0, 0, 0 }, { 0, 548.8f, 0 }, { 0, 548.8f, 559.2f }
};
static const quad red_quad = {
    { 552.8f, 0, 0 }, { 549.6f, 0, 559.2f }, { 556.0f, 548.8f, 559.2f }, { 556.0f, 548.8f, 0 }
};
static const quad short_block[5] = {
    { { 130, 165, 65 }, { 82, 165, 225 }, { 240, 165, 272 }, { 290, 165, 114 } },
    { { 290, 0, 114 }, { 290, 165, 114 }, { 240, 165, 272 }, { 240, 0, 272 } },
    { { 130, 0, 65 }, { 130, 165, 65 }, { 290, 165, 114 }, { 290, 0, 114 } },
    { { 82, 0, 225 }, { 82, 165, 225 }, { 130, 165, 65 }, { 130, 0, 65 } },
    { { 240, 0, 272 }, { 240, 165, 272 }, { 82, 165, 225 }, { 82, 0, 225 } },
};
static const quad tall_block[5] = {
    { { 423, 330, 247 }, { 265, 330, 296 }, { 314, 330, 456 }, { 472, 330, 406 } },
    { { 423, 0, 247 }, { 423, 330, 247 }, { 472, 330, 406 }, { 472, 0, 406 } },
    { { 472, 0, 406 }, { 472, 330, 406 }, { 314, 330, 456 }, { 314, 0, 456 } },
    { { 314, 0, 456 }, { 314, 330, 456 }, { 265, 330, 296 }, { 265, 0, 296 } },
    { { 265, 0, 296 }, { 265, 330, 296 }, { 423, 330, 247 }, { 423, 0, 247 } },
};

// One triangle with its own normal: the red wall's quad is not flat.
static void add_triangle(shape *s, const quad q, const int corner[3])
{
    float p[3][3], e[2][3];
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k)
            p[i][k] = q[corner[i]][k] / 1000.0f;
    }
    for (int k = 0; k < 3; ++k) {
        e[0][k] = p[1][k] - p[0][k];
        e[1][k] = p[2][k] - p[0][k];
    }
    const float normal[3] = { e[0][1] * e[1][2] - e[0][2] * e[1][1],
                              e[0][2] * e[1][0] - e[0][0] * e[1][2],
                              e[0][0] * e[1][1] - e[0][1] * e[1][0] };
    uint32_t index[3];
    for (int i = 0; i < 3; ++i) {
        const int c = corner[i];
        index[i] =
            shape_vertex(s, p[i], normal, c == 1 || c == 2 ? 1.0f : 0.0f, c / 2 ? 1.0f : 0.0f);
    }
    if (!s->failed)
        shape_triangle(s, index[0], index[1], index[2]);
}

static int add_part(kit *k, const char *name, const quad *quads, int count, int material)
{
    static const int halves[2][3] = { { 0, 1, 2 }, { 0, 2, 3 } };
    shape s = { 0 };
    for (int i = 0; i < count; ++i) {
        add_triangle(&s, quads[i], halves[0]);
        add_triangle(&s, quads[i], halves[1]);
    }
    return kit_part(k, name, &s, material);
}

static void add_quads(kit *k, const char *name, const quad *quads, int count, int material)
{
    kit_show(k, name, add_part(k, name, quads, count, material), -1, (place){ 0 });
}

static int paint(kit *k, const char *name, float r, float g, float b)
{
    ag_material m = ag_default_material();
    snprintf(m.name, sizeof m.name, "%s", name);
    m.base_color[0] = r;
    m.base_color[1] = g;
    m.base_color[2] = b;
    return ag_builder_material(k->builder, &m);
}

// ---- what moves ------------------------------------------------------------------------
//
// At time 0 the box is as published: the lamp rests in its opening, and what rises out of the tall
// block is inside of it, where nothing sees it. No published surface ever moves, so that what is
// kept for surfaces at rest (VPLs, ray casts beside the frame) has the whole box.

enum { LAMP_KEYS = 65, BLOCK_KEYS = 129 };
static const float lamp_period = 8.0f, block_period = 16.0f; // s
static const float tau = 6.28318531f;

static float smooth(float lo, float hi, float t)
{
    const float x = fminf(fmaxf((t - lo) / (hi - lo), 0.0f), 1.0f);
    return x * x * (3.0f - 2.0f * x);
}

// A block of 0.6 of the tall one's footprint, 95 mm high, its top 2 mm under the tall one's.
static void add_inner_block(kit *k, int node, int material)
{
    const float middle[3] = { 368.5f, 0, 351.25f };
    quad inner[5];
    for (int i = 0; i < FG_COUNT(inner); ++i) {
        for (int j = 0; j < 4; ++j) {
            const float *outer = tall_block[i][j];
            for (int c = 0; c < 3; ++c)
                inner[i][j][c] = middle[c] + 0.6f * (outer[c] - middle[c]);
            inner[i][j][1] = outer[1] > 0.0f ? 328.0f : 233.0f;
        }
    }
    const int part = add_part(k, "inner block", (const quad *) inner, 5, material);
    ag_builder_show(k->builder, node, part, -1);
}

static void rise(const void *user, float t, float out[4])
{
    (void) user;
    out[1] = 0.09f * (smooth(0.25f, 0.5f, t) - smooth(0.75f, 1.0f, t));
}

static void circle(const void *user, float t, float out[4])
{
    (void) user;
    out[0] = 0.0695f * (cosf(tau * t) - 1.0f);
    out[2] = 0.0695f * sinf(tau * t);
}

// In place of the published lamp, a spot in the middle of its opening (213 to 343, 227 to 332),
// 1 mm below the ceiling.
static void add_light(kit *k)
{
    const double pi = 3.14159265358979323846;
    // Straight down, -Z to -Y: an exact turn, which a quaternion would round.
    const double down[16] = { 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1 };
    const int rail = kit_node(k, "lamp rail", -1, (place){ 0.278, 0.5478, 0.2795, 0 });
    const int runner = kit_node(k, "lamp runner", rail, (place){ 0 });
    const ag_node_desc aim = { .name = "lamp", .parent = runner, .matrix = down };
    const kit_motion m = { .node = runner,
                           .path = AG_PATH_TRANSLATION,
                           .keys = LAMP_KEYS,
                           .seconds = lamp_period,
                           .curve = circle };
    const ag_light spot = {
        .name = "lamp",
        .kind = AG_LIGHT_SPOT,
        .intensity = { 1.0f, 0.85f, 0.6f }, // W/sr
        .cos_inner = (float) cos(40.0 * pi / 180.0),
        .cos_outer = (float) cos(55.0 * pi / 180.0),
    };
    kit_move(k, &m);
    ag_builder_light(k->builder, ag_builder_node(k->builder, &aim), &spot);
}

static void add_moving_parts(kit *k, int material)
{
    const int node = kit_node(k, "inner block", -1, (place){ 0 });
    const kit_motion m = { .node = node,
                           .path = AG_PATH_TRANSLATION,
                           .keys = BLOCK_KEYS,
                           .seconds = block_period,
                           .curve = rise };
    add_inner_block(k, node, material);
    kit_move(k, &m);
}

// From where the published camera stands into the room, around, and out again.
static const kit_stop stops[] = {
    { { 0.278, 0.273, -0.80 }, { 0.278, 0.27, 0.1 } },
    { { 0.38, 0.31, -0.42 }, { 0.25, 0.22, 0.3 } },
    { { 0.46, 0.38, -0.06 }, { 0.14, 0.12, 0.42 } },
    { { 0.38, 0.44, 0.04 }, { 0.22, 0.10, 0.46 } },
    { { 0.20, 0.44, 0.02 }, { 0.36, 0.12, 0.45 } },
    { { 0.09, 0.36, -0.06 }, { 0.44, 0.16, 0.40 } },
    { { 0.15, 0.26, -0.40 }, { 0.32, 0.24, 0.3 } },
};

static void add_cameras(kit *k)
{
    const kit_walk_desc walk = {
        .name = "path", .stops = stops, .count = FG_COUNT(stops), .seconds = 16.0f, .yfov = 0.8f
    };
    // Published: at (278, 273, -800), along +z, focal length 35 mm, film 25 mm x 25 mm.
    const float published = 2.0f * atanf(0.5f * 0.025f / 0.035f);
    kit_camera(k, "front", (double[]){ 0.278, 0.273, -0.8 }, (double[]){ 0.278, 0.273, 0.0 },
               published);
    kit_camera(k, "corner", (double[]){ 0.05, 0.46, 0.03 }, (double[]){ 0.42, 0.12, 0.42 }, 0.95f);
    kit_camera(k, "floor", (double[]){ 0.42, 0.05, -0.12 }, (double[]){ 0.22, 0.17, 0.4 }, 0.9f);
    kit_camera(k, "between", (double[]){ 0.52, 0.2, 0.12 }, (double[]){ 0.16, 0.12, 0.34 }, 1.0f);
    kit_walk(k, &walk);
}

fg_status cornell_build(const fg_log *log, ag_scene **out)
{
    kit k;
    *out = NULL;
    if (!kit_begin(&k, log, "cornell"))
        return FG_ERR_MEMORY;
    const int white = paint(&k, "white", 0.725f, 0.71f, 0.68f);
    const int red = paint(&k, "red", 0.63f, 0.065f, 0.05f);
    const int green = paint(&k, "green", 0.14f, 0.45f, 0.091f);
    add_quads(&k, "floor", &floor_quad, 1, white);
    add_quads(&k, "ceiling", &ceiling_quad, 1, white);
    add_quads(&k, "back wall", &back_quad, 1, white);
    add_quads(&k, "right wall", &green_quad, 1, green);
    add_quads(&k, "left wall", &red_quad, 1, red);
    add_quads(&k, "short block", short_block, 5, white);
    add_quads(&k, "tall block", tall_block, 5, white);
    add_moving_parts(&k, white);
    add_light(&k);
    add_cameras(&k);
    return kit_end(&k, out);
}
