// SPDX-License-Identifier: MIT
#include "kit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool kit_begin(kit *k, const fg_log *log, const char *name)
{
    memset(k, 0, sizeof *k);
    k->log = log;
    k->builder = ag_builder_create(log, name);
    if (!k->builder)
        fg_logf(log, FG_LOG_ERROR, "%s: out of memory", name);
    return k->builder != NULL;
}

fg_status kit_end(kit *k, ag_scene **out)
{
    fg_status status = FG_ERR_MEMORY;
    *out = NULL;
    if (k->failed)
        fg_logf(k->log, FG_LOG_ERROR, "built-in scene: out of memory for a mesh or a texture");
    else
        status = ag_scene_build(k->builder, out);
    ag_builder_destroy(k->builder);
    k->builder = NULL;
    return status;
}

int kit_node(kit *k, const char *name, int parent, place at)
{
    ag_node_desc desc = { .name = name, .parent = parent, .translation = { at.x, at.y, at.z } };
    kit_turn(1, at.yaw, desc.rotation);
    return ag_builder_node(k->builder, &desc);
}

int kit_part(kit *k, const char *name, shape *s, int material)
{
    int part = -1;
    if (s->failed) {
        k->failed = true;
    } else {
        const ag_primitive_desc desc = { .name = name,
                                         .vertices = s->vertices,
                                         .vertex_count = s->vertex_count,
                                         .indices = s->indices,
                                         .index_count = s->index_count,
                                         .material = material };
        part = ag_builder_primitive(k->builder, &desc);
    }
    shape_finish(s);
    return part;
}

int kit_show(kit *k, const char *name, int part, int parent, place at)
{
    const int node = kit_node(k, name, parent, at);
    if (!k->failed)
        ag_builder_show(k->builder, node, part, -1);
    return node;
}

int kit_texture(kit *k, const char *name, pattern what, int size)
{
    uint8_t *rgba = malloc((size_t) size * (size_t) size * 4);
    if (!rgba) {
        k->failed = true;
        return -1;
    }
    pattern_paint(what, size, rgba);
    ag_texture texture = { .width = size, .height = size, .rgba = rgba, .srgb = true };
    snprintf(texture.name, sizeof texture.name, "%s", name);
    const int index = ag_builder_texture(k->builder, &texture);
    free(rgba);
    return index;
}

// Columns right, up, back of a view along `direction`.
static void view_axes(const double direction[3], double axes[3][3])
{
    const double *d = direction;
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const double flat = hypot(d[0], d[2]);
    const double right[3] = { -d[2] / flat, 0.0, d[0] / flat };
    for (int i = 0; i < 3; ++i) {
        axes[0][i] = right[i];
        axes[2][i] = -d[i] / length;
    }
    const double *b = axes[2], *r = axes[0];
    axes[1][0] = b[1] * r[2] - b[2] * r[1];
    axes[1][1] = b[2] * r[0] - b[0] * r[2];
    axes[1][2] = b[0] * r[1] - b[1] * r[0];
}

void kit_camera(kit *k, const char *name, const double eye[3], const double target[3], float yfov)
{
    ag_camera camera = { .yfov = yfov, .znear = 0.05f };
    double direction[3], axes[3][3];
    for (int i = 0; i < 3; ++i)
        direction[i] = target[i] - eye[i];
    view_axes(direction, axes);
    for (int i = 0; i < 3; ++i) {
        for (int c = 0; c < 3; ++c)
            camera.world[4 * c + i] = axes[c][i];
        camera.world[12 + i] = eye[i];
    }
    camera.world[15] = 1.0;
    snprintf(camera.name, sizeof camera.name, "%s", name);
    ag_builder_camera(k->builder, -1, &camera);
}

void kit_aim(const double direction[3], double rotation[4])
{
    // A turn around +Y to the heading, after one around +X to the slope.
    const double yaw = 0.5 * atan2(-direction[0], -direction[2]);
    const double pitch = 0.5 * atan2(direction[1], hypot(direction[0], direction[2]));
    rotation[0] = cos(yaw) * sin(pitch);
    rotation[1] = sin(yaw) * cos(pitch);
    rotation[2] = -sin(yaw) * sin(pitch);
    rotation[3] = cos(yaw) * cos(pitch);
}

void kit_aim_curve(const double direction[3], float out[4])
{
    double q[4];
    kit_aim(direction, q);
    for (int k = 0; k < 4; ++k)
        out[k] = (float) q[k];
}

void kit_turn(int axis, double angle, double rotation[4])
{
    rotation[0] = rotation[1] = rotation[2] = 0.0;
    rotation[axis] = sin(0.5 * angle);
    rotation[3] = cos(0.5 * angle);
}
