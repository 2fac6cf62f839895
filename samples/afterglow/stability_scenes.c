// SPDX-License-Identifier: MIT
#include "stability.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Corners of a quad: p, p + u, p + u + v, p + v; its normal is u x v.
typedef struct quad {
    float p[3], u[3], v[3];
} quad;

static const quad walls[] = {
    { { -0.5f, -0.5f, 0.5f }, { 1, 0, 0 }, { 0, 0, -1 } }, // floor
    { { -0.5f, 0.5f, -0.5f }, { 1, 0, 0 }, { 0, 0, 1 } },  // ceiling
    { { -0.5f, -0.5f, -0.5f }, { 1, 0, 0 }, { 0, 1, 0 } }, // back
    { { -0.5f, -0.5f, 0.5f }, { 0, 0, -1 }, { 0, 1, 0 } }, // left
    { { 0.5f, -0.5f, -0.5f }, { 0, 0, 1 }, { 0, 1, 0 } },  // right
    { { 0.5f, -0.5f, 0.5f }, { -1, 0, 0 }, { 0, 1, 0 } },  // front
};

ag_light stability_lamp(void)
{
    return (ag_light){
        .name = "lamp",
        .kind = AG_LIGHT_SPOT,
        .position = { 0, 0.45, 0 },
        .direction = { 0, -1, 0 },
        .intensity = { 1, 1, 1 },
        .cos_inner = 0.8f,
        .cos_outer = 0.5f,
    };
}

static void show_quad(ag_builder *b, int node, int material, const quad *q, float scale)
{
    ag_vertex v[4] = { 0 };
    static const uint32_t order[] = { 0, 1, 2, 0, 2, 3 };
    for (int k = 0; k < 4; ++k)
        for (int c = 0; c < 3; ++c) {
            const float along_u = k == 1 || k == 2 ? q->u[c] : 0, along_v = k >= 2 ? q->v[c] : 0;
            v[k].position[c] = scale * (q->p[c] + along_u + along_v);
            v[k].color[c] = v[k].color[3] = 1;
        }
    ag_builder_show(b, node,
                    ag_builder_primitive(b, &(ag_primitive_desc){ .name = "wall",
                                                                  .vertices = v,
                                                                  .vertex_count = 4,
                                                                  .indices = order,
                                                                  .index_count = 6,
                                                                  .material = material }),
                    -1);
}

static void show_block(ag_builder *b, int node, int material, float scale)
{
    for (int i = 1; i < FG_COUNT(walls); ++i) { // all but the underside, turned outward
        quad q = walls[i];
        for (int c = 0; c < 3; ++c) {
            const float swap = q.u[c];
            q.u[c] = 0.3f * q.v[c];
            q.v[c] = 0.3f * swap;
            q.p[c] = 0.3f * q.p[c] - (c == 1 ? 0.349f : 0);
        }
        show_quad(b, node, material, &q, scale);
    }
}

// Three triangles of no use, and with `kind` 2 two that are odd and sound.
static void show_junk(ag_builder *b, int node, int material, int kind)
{
    static const float corners[5][3][3] = {
        { { 0, 0, 0 }, { 0.1f, 0, 0 }, { 0.2f, 0, 0 } },       // collinear
        { { 0.1f, 0.1f, 0 }, { 0.1f, 0.1f, 0 }, { 0, 0, 0 } }, // two corners in one
        { { 0, 0, 0 }, { 0.1f, NAN, 0 }, { 0, 0.1f, 0 } },
        { { -0.4f, -0.2f, 0 }, { 0.4f, -0.2f, 0 }, { 0, -0.2f + 8e-7f, 0 } }, // 1e6 to 1
        { { 0.1f, -0.3f, 0 }, { 0.1f, -0.1f, 0 }, { 0.3f, -0.3f, 0 } },       // from behind
    };
    for (int i = 0; i < (kind == 2 ? 5 : 3); ++i) {
        ag_vertex v[3] = { 0 };
        for (int k = 0; k < 3; ++k) {
            memcpy(v[k].position, corners[i][k], sizeof v[k].position);
            for (int c = 0; c < 4; ++c)
                v[k].color[c] = 1;
        }
        ag_builder_show(b, node,
                        ag_builder_primitive(b, &(ag_primitive_desc){ .name = "junk",
                                                                      .vertices = v,
                                                                      .vertex_count = 3,
                                                                      .material = material }),
                        -1);
    }
}

static void add_camera(ag_builder *b, const room *what, double scale)
{
    ag_camera camera = { .name = "front", .yfov = 1.4f, .znear = (float) (1e-3 * scale) };
    for (int i = 0; i < 4; ++i)
        camera.world[5 * (size_t) i] = 1;
    for (int c = 0; c < 3; ++c)
        camera.world[12 + c] = what->offset[c] + (c == 2 ? 0.49 * scale : 0);
    ag_builder_camera(b, -1, &camera);
}

// A light that travels hangs on a node of its own, turned so that its -Z is down.
static void add_moving(ag_builder *b, const room *what, double scale, const ag_light *light)
{
    float times[] = { 0, 0.5f, 1 }, values[9];
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c) {
            const double part = what->jump ? (k ? 1 : 0) : 0.5 * k;
            values[3 * k + c] = (float) (light->position[c] + part * scale * what->travel[c]);
        }
    const int node = ag_builder_node(
        b, &(ag_node_desc){
               .name = "carrier", .parent = -1, .rotation = { -M_SQRT1_2, 0, 0, M_SQRT1_2 } });
    ag_builder_light(b, node, light);
    ag_builder_channel(
        b, &(ag_channel_desc){
               .node = node,
               .interpolation = what->jump ? AG_INTERPOLATE_STEP : AG_INTERPOLATE_LINEAR,
               .key_count = 3,
               .times = times,
               .values = values,
           });
}

static void add_lights(ag_builder *b, const room *what, double scale)
{
    for (int i = 0; i < what->light_count; ++i) {
        ag_light light = what->lights[i];
        const bool local = light.kind != AG_LIGHT_DIRECTIONAL;
        for (int c = 0; c < 3; ++c) {
            light.position[c] = light.position[c] * scale + what->offset[c];
            light.intensity[c] *= local ? (float) (scale * scale) : 1;
        }
        if (i == 0 && (what->travel[0] != 0 || what->travel[1] != 0 || what->travel[2] != 0))
            add_moving(b, what, scale, &light);
        else
            ag_builder_light(b, -1, &light);
    }
}

static void show_walls(ag_builder *b, int node, int material, const room *what, float scale)
{
    static const quad partition = { { -0.5f, -0.5f, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
    for (int k = 0; k < (what->twice ? 2 : 1); ++k)
        for (int i = 0; i < (what->floor_alone ? 1 : FG_COUNT(walls)); ++i)
            show_quad(b, node, material, &walls[i], scale);
    if (what->partition)
        show_quad(b, node, material, &partition, scale);
}

// Three rooms down, in a step.
static void send_away(ag_builder *b, int node, double scale)
{
    static const float times[] = { 0, 0.5f, 1 };
    const float down = (float) (-3 * scale), values[9] = { 0, 0, 0, 0, down, 0, 0, down, 0 };
    ag_builder_channel(b, &(ag_channel_desc){
                              .node = node,
                              .interpolation = AG_INTERPOLATE_STEP,
                              .key_count = 3,
                              .times = times,
                              .values = values,
                          });
}

static void add_block(ag_builder *b, const room *what, int parent, int material, double scale)
{
    const int node = ag_builder_node(b, &(ag_node_desc){ .name = "block", .parent = parent });
    show_block(b, node, material, (float) scale);
    if (what->block_goes)
        send_away(b, node, scale);
}

static void fill_room(ag_builder *b, const room *what)
{
    const double scale = what->scale > 0 ? what->scale : 1;
    const float albedo = what->black ? 0 : what->albedo > 0 ? what->albedo : 0.6f;
    ag_material m = ag_default_material();
    ag_node_desc node = { .name = "room", .parent = -1 };
    for (int c = 0; c < 3; ++c) {
        m.base_color[c] = albedo;
        m.emissive[c] = what->emission;
        node.translation[c] = what->offset[c];
    }
    const int material = ag_builder_material(b, &m), at = ag_builder_node(b, &node);
    show_walls(b, at, material, what, (float) scale);
    if (what->block)
        add_block(b, what, at, material, scale);
    if (what->junk)
        show_junk(b, at, material, what->junk);
    add_lights(b, what, scale);
    add_camera(b, what, scale);
}

fg_status stability_room(const fg_log *log, const room *what, ag_scene **out)
{
    *out = NULL;
    ag_builder *b = ag_builder_create(log, "room");
    if (!b)
        return FG_ERR_MEMORY;
    fill_room(b, what);
    const fg_status status = ag_scene_build(b, out);
    ag_builder_destroy(b);
    return status;
}

fg_status stability_triangle(const fg_log *log, ag_scene **out)
{
    static const float corners[3][2] = { { -0.3f, -0.3f }, { 0.3f, -0.3f }, { 0, 0.3f } };
    ag_light lamp = stability_lamp();
    ag_vertex v[3] = { 0 };
    lamp.position[1] = 0;
    lamp.position[2] = 0.45;
    lamp.direction[1] = 0;
    lamp.direction[2] = -1;
    *out = NULL;
    ag_builder *b = ag_builder_create(log, "triangle");
    if (!b)
        return FG_ERR_MEMORY;
    for (int k = 0; k < 3; ++k) {
        for (int c = 0; c < 2; ++c)
            v[k].position[c] = corners[k][c];
        for (int c = 0; c < 4; ++c)
            v[k].color[c] = 1;
    }
    const ag_primitive_desc primitive = {
        .name = "triangle", .vertices = v, .vertex_count = 3, .material = -1
    };
    ag_builder_show(b, ag_builder_node(b, &(ag_node_desc){ .name = "triangle", .parent = -1 }),
                    ag_builder_primitive(b, &primitive), -1);
    ag_builder_light(b, -1, &lamp);
    add_camera(b, &(room){ 0 }, 1);
    const fg_status status = ag_scene_build(b, out);
    ag_builder_destroy(b);
    return status;
}

// A sheet of `cells` x `cells` squares over the unit square of the floor, rippled.
static int add_sheet(ag_builder *b, int cells)
{
    const int n = cells + 1;
    ag_vertex *v = calloc((size_t) n * (size_t) n, sizeof *v);
    uint32_t *index = calloc((size_t) cells * (size_t) cells * 6, sizeof *index);
    int primitive = -1;
    size_t count = 0;
    for (int i = 0; v && index && i < n * n; ++i) {
        const int column = i % n, row = i / n;
        const float x = (float) column / (float) cells, z = (float) row / (float) cells;
        const ag_vertex at = { .position = { x - 0.5f, 0.01f * sinf(40 * x) * sinf(40 * z) - 0.4f,
                                             0.5f - z },
                               .color = { 1, 1, 1, 1 } };
        v[i] = at;
    }
    for (int i = 0; v && index && i < cells * cells; ++i) {
        const uint32_t a = (uint32_t) (i / cells * n + i % cells), up = a + (uint32_t) n;
        const uint32_t corners[] = { a, a + 1, up + 1, a, up + 1, up };
        memcpy(index + count, corners, sizeof corners);
        count += 6;
    }
    if (v && index)
        primitive =
            ag_builder_primitive(b, &(ag_primitive_desc){ .name = "sheet",
                                                          .vertices = v,
                                                          .vertex_count = (size_t) n * (size_t) n,
                                                          .indices = index,
                                                          .index_count = count,
                                                          .material = -1 });
    free(v);
    free(index);
    return primitive;
}

fg_status stability_field(const fg_log *log, int count, int cells, ag_scene **out)
{
    const ag_light lamp = stability_lamp();
    *out = NULL;
    ag_builder *b = ag_builder_create(log, "field");
    if (!b)
        return FG_ERR_MEMORY;
    const int sheet = add_sheet(b, cells);
    for (int i = 0; i < count; ++i) {
        const int edge = (int) ceil(sqrt(count)), column = i % edge, row = i / edge;
        const double size = 1.0 / edge;
        const ag_node_desc node = {
            .name = "object",
            .parent = -1,
            .translation = { (column + 0.5) * size - 0.5, 0, (row + 0.5) * size - 0.5 },
            .scale = { size, 1, size },
        };
        ag_builder_show(b, ag_builder_node(b, &node), sheet, -1);
    }
    ag_builder_light(b, -1, &lamp);
    add_camera(b, &(room){ 0 }, 1);
    const fg_status status = sheet < 0 ? FG_ERR_MEMORY : ag_scene_build(b, out);
    ag_builder_destroy(b);
    return status;
}
