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

static void add_quads(kit *k, const char *name, const quad *quads, int count, int material)
{
    static const int halves[2][3] = { { 0, 1, 2 }, { 0, 2, 3 } };
    shape s = { 0 };
    for (int i = 0; i < count; ++i) {
        add_triangle(&s, quads[i], halves[0]);
        add_triangle(&s, quads[i], halves[1]);
    }
    kit_show(k, name, kit_part(k, name, &s, material), -1, (place){ 0 });
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

// In place of the published lamp, a spot in the middle of its opening (213 to 343, 227 to 332),
// 1 mm below the ceiling.
static void add_light(kit *k)
{
    const double pi = 3.14159265358979323846;
    const ag_light spot = {
        .name = "lamp",
        .kind = AG_LIGHT_SPOT,
        .position = { 0.278, 0.5478, 0.2795 },
        .direction = { 0, -1, 0 },
        .intensity = { 1.0f, 0.85f, 0.6f }, // W/sr
        .cos_inner = (float) cos(40.0 * pi / 180.0),
        .cos_outer = (float) cos(55.0 * pi / 180.0),
    };
    ag_builder_light(k->builder, -1, &spot);
}

static void add_cameras(kit *k)
{
    // Published: at (278, 273, -800), along +z, focal length 35 mm, film 25 mm x 25 mm.
    const float published = 2.0f * atanf(0.5f * 0.025f / 0.035f);
    kit_camera(k, "front", (double[]){ 0.278, 0.273, -0.8 }, (double[]){ 0.278, 0.273, 0.0 },
               published);
    kit_camera(k, "corner", (double[]){ 0.05, 0.46, 0.03 }, (double[]){ 0.42, 0.12, 0.42 }, 0.95f);
    kit_camera(k, "floor", (double[]){ 0.42, 0.05, -0.12 }, (double[]){ 0.22, 0.17, 0.4 }, 0.9f);
    kit_camera(k, "between", (double[]){ 0.52, 0.2, 0.12 }, (double[]){ 0.16, 0.12, 0.34 }, 1.0f);
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
    add_light(&k);
    add_cameras(&k);
    return kit_end(&k, out);
}
