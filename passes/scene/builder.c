// SPDX-License-Identifier: MIT
#include "scene_priv.h"

#include <math.h>
#include <pass/math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *ag_array_push(ag_array *a, size_t more, size_t item_size)
{
    if (more > SIZE_MAX / 4 / item_size - a->count)
        return NULL;
    if (!a->data || a->count + more > a->capacity) {
        size_t capacity = a->capacity * 2 > a->count + more ? a->capacity * 2 : a->count + more;
        if (capacity < 4)
            capacity = 4;
        void *data = realloc(a->data, capacity * item_size);
        if (!data)
            return NULL;
        a->data = data;
        a->capacity = capacity;
    }
    char *room = (char *) a->data + a->count * item_size;
    memset(room, 0, more * item_size);
    a->count += more;
    return room;
}

void ag_array_finish(ag_array *a)
{
    free(a->data);
    *a = (ag_array){ 0 };
}

void ag_name_copy(char out[64], const char *name)
{
    size_t n = name ? strlen(name) : 0;
    if (n > 63)
        for (n = 63; n > 0 && ((unsigned char) name[n] & 0xc0) == 0x80;)
            n--;
    for (size_t i = 0; i < 64; i++)
        if (i < n)
            out[i] = name[i];
        else
            out[i] = '\0';
}

// One line, whatever names the file has: control characters become spaces.
static void say(const ag_builder *b, fg_log_level level, const char *fmt, va_list args)
{
    char text[512];
    vsnprintf(text, sizeof text, fmt, args);
    for (char *c = text; *c; c++)
        if ((unsigned char) *c < 32 || *c == 127)
            *c = ' ';
    fg_logf(&b->p->log, level, "%s: %s", b->p->label, text);
}

int ag_builder_refuse(ag_builder *b, fg_status status, const char *fmt, ...)
{
    if (!b || b->status != FG_OK)
        return -1;
    va_list args;
    va_start(args, fmt);
    say(b, FG_LOG_ERROR, fmt, args);
    va_end(args);
    b->status = status;
    return -1;
}

void ag_builder_warn(ag_builder *b, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    if (b->warnings++ < AG_MAX_SCENE_WARNINGS)
        say(b, FG_LOG_WARN, fmt, args);
    va_end(args);
}

void ag_builder_info(ag_builder *b, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    say(b, FG_LOG_INFO, fmt, args);
    va_end(args);
}

bool ag_builder_open(ag_builder *b)
{
    if (b && b->built)
        ag_builder_refuse(b, FG_ERR_INVALID, "builder: nothing can be added after the build");
    return b && b->status == FG_OK;
}

void *ag_builder_push(ag_builder *b, ag_array *a, size_t item_size, const char *what)
{
    if (a->count >= AG_MAX_SCENE_ITEMS) {
        ag_builder_refuse(b, FG_ERR_INVALID, "%s: more than %d", what, AG_MAX_SCENE_ITEMS);
        return NULL;
    }
    void *item = ag_array_push(a, 1, item_size);
    if (!item)
        ag_builder_refuse(b, FG_ERR_MEMORY, "%s: out of memory", what);
    return item;
}

fg_status ag_builder_set_label(ag_builder *b, const char *label)
{
    char *copy = strdup(label);
    if (!copy)
        return FG_ERR_MEMORY;
    free(b->p->label);
    b->p->label = copy;
    return FG_OK;
}

ag_builder *ag_builder_create(const fg_log *log, const char *name)
{
    ag_builder *b = calloc(1, sizeof *b);
    if (!b)
        return NULL;
    ag_name_copy(b->name, name);
    b->p = calloc(1, sizeof *b->p);
    if (!b->p)
        goto fail;
    if (log)
        b->p->log = *log;
    if (ag_builder_set_label(b, name ? name : "scene") != FG_OK)
        goto fail;
    return b;

fail:
    ag_builder_destroy(b);
    return NULL;
}

void ag_builder_destroy(ag_builder *b)
{
    if (!b)
        return;
    ag_scene_private_destroy(b->p);
    free(b);
}

ag_light ag_default_light(void)
{
    return (ag_light){
        .direction = { 0, 0, -1 },
        .intensity = { 1, 1, 1 },
        .cos_inner = 1,
        .cos_outer = 0.70710678f,
    };
}

ag_camera ag_default_camera(void)
{
    ag_camera camera = { .yfov = 0.78539816f, .half_height = 1, .znear = 0.05f, .zfar = 1000 };
    ag_mat_identity(camera.world);
    return camera;
}

// ---- nodes ------------------------------------------------------------------------

static bool all_zero(const double *v, int n)
{
    for (int i = 0; i < n; i++)
        if (v[i] != 0)
            return false;
    return true;
}

static bool all_finite(const double *v, int n)
{
    for (int i = 0; i < n; i++)
        if (!isfinite(v[i]))
            return false;
    return true;
}

static bool node_trs(const ag_node_desc *desc, ag_trs *out)
{
    memcpy(out->translation, desc->translation, sizeof out->translation);
    for (int i = 0; i < 3; i++)
        out->scale[i] = all_zero(desc->scale, 3) ? 1 : desc->scale[i];
    double length =
        sqrt(desc->rotation[0] * desc->rotation[0] + desc->rotation[1] * desc->rotation[1] +
             desc->rotation[2] * desc->rotation[2] + desc->rotation[3] * desc->rotation[3]);
    for (int i = 0; i < 4; i++)
        out->rotation[i] = length > 0 ? desc->rotation[i] / length : i == 3;
    return all_finite(out->translation, 3) && all_finite(out->rotation, 4) &&
           all_finite(out->scale, 3);
}

int ag_builder_node(ag_builder *b, const ag_node_desc *desc)
{
    if (!ag_builder_open(b))
        return -1;
    ag_array *nodes = &b->p->nodes;
    const char *name = desc->name ? desc->name : "";
    if (desc->parent < -1 || desc->parent >= (int) nodes->count)
        return ag_builder_refuse(b, FG_ERR_INVALID,
                                 "node %zu '%s': parent %d is neither -1 nor an earlier node",
                                 nodes->count, name, desc->parent);
    ag_node *node = ag_builder_push(b, nodes, sizeof *node, "nodes");
    if (!node)
        return -1;
    ag_name_copy(node->name, name);
    node->parent = desc->parent;
    node->has_matrix = desc->matrix != NULL;
    if (node->has_matrix)
        memcpy(node->matrix, desc->matrix, sizeof node->matrix);
    if (!node_trs(desc, &node->rest) || !all_finite(node->matrix, 16))
        return ag_builder_refuse(b, FG_ERR_INVALID, "node %zu '%s': its transform is not finite",
                                 nodes->count - 1, name);
    node->pose = node->rest;
    return (int) nodes->count - 1;
}

static bool node_exists(ag_builder *b, const char *what, int node)
{
    if (node >= 0 && node < (int) b->p->nodes.count)
        return true;
    ag_builder_refuse(b, FG_ERR_INVALID, "%s: node %d does not exist (nodes: %zu)", what, node,
                      b->p->nodes.count);
    return false;
}

void ag_builder_show(ag_builder *b, int node, int primitive, int skin)
{
    if (!ag_builder_open(b) || !node_exists(b, "show", node))
        return;
    ag_scene_private *p = b->p;
    if (primitive < 0 || primitive >= (int) p->primitives.count) {
        ag_builder_refuse(b, FG_ERR_INVALID, "show: primitive %d does not exist (primitives: %zu)",
                          primitive, p->primitives.count);
        return;
    }
    if (skin < -1 || skin >= (int) p->skins.count) {
        ag_builder_refuse(b, FG_ERR_INVALID, "show: skin %d does not exist (skins: %zu)", skin,
                          p->skins.count);
        return;
    }
    const ag_staged_skin *staged = (const ag_staged_skin *) p->staged.data + primitive;
    const ag_skin *skins = p->skins.data;
    if (skin >= 0 && !staged->has_influences) {
        ag_builder_warn(b, "show: primitive %d has no joints; its skin is left out", primitive);
        skin = -1;
    }
    if (skin >= 0 && staged->highest_joint >= skins[skin].count) {
        ag_builder_refuse(b, FG_ERR_INVALID,
                          "show: primitive %d uses joint %d, its skin has only %d", primitive,
                          staged->highest_joint, skins[skin].count);
        return;
    }
    ag_instance *instance = ag_builder_push(b, &p->instances, sizeof *instance, "instances");
    int *with = instance ? ag_builder_push(b, &p->instance_skins, sizeof *with, "instances") : NULL;
    if (!with)
        return;
    instance->primitive = primitive;
    instance->node = node;
    *with = skin;
}

int ag_builder_skin(ag_builder *b, const int *joints, int count, const float *inverse_bind)
{
    if (!ag_builder_open(b))
        return -1;
    ag_scene_private *p = b->p;
    if (count < 1 || count > 65536)
        return ag_builder_refuse(b, FG_ERR_INVALID, "skin %zu: %d joints, must be 1 to 65536",
                                 p->skins.count, count);
    for (int i = 0; i < count; i++)
        if (!node_exists(b, "skin", joints[i]))
            return -1;
    for (size_t i = 0; inverse_bind && i < 16 * (size_t) count; i++)
        if (!isfinite(inverse_bind[i]))
            return ag_builder_refuse(b, FG_ERR_INVALID,
                                     "skin %zu: inverse bind matrix %zu is not finite",
                                     p->skins.count, i / 16);
    ag_skin *skin = ag_builder_push(b, &p->skins, sizeof *skin, "skins");
    if (!skin)
        return -1;
    skin->joints = malloc((size_t) count * sizeof *skin->joints);
    skin->inverse_bind = malloc((size_t) count * 16 * sizeof *skin->inverse_bind);
    if (!skin->joints || !skin->inverse_bind)
        return ag_builder_refuse(b, FG_ERR_MEMORY, "skins: out of memory");
    skin->count = count;
    for (size_t i = 0; i < (size_t) count; i++) {
        skin->joints[i] = joints[i];
        if (inverse_bind)
            ag_mat_from_float(inverse_bind + 16 * i, skin->inverse_bind + 16 * i);
        else
            ag_mat_identity(skin->inverse_bind + 16 * i);
    }
    return (int) p->skins.count - 1;
}

// ---- lights and cameras -----------------------------------------------------------

const char *ag_light_fault(const ag_light *light, bool placed)
{
    const float *in = light->intensity, *d = light->direction;
    if (light->kind < AG_LIGHT_POINT || light->kind > AG_LIGHT_DIRECTIONAL)
        return "kind is none of point, spot, directional";
    for (int i = 0; i < 3; i++)
        if (!isfinite(in[i]) || in[i] < 0)
            return "intensity is negative or not finite";
    if (light->kind == AG_LIGHT_SPOT && !light->cosine &&
        !(light->cos_outer >= -1 && light->cos_inner >= light->cos_outer && light->cos_inner <= 1))
        return "cone: must be -1 <= cos_outer <= cos_inner <= 1";
    if (!placed)
        return NULL;
    if (!all_finite(light->position, 3))
        return "position is not finite";
    double length2 = (double) d[0] * (double) d[0] + (double) d[1] * (double) d[1] +
                     (double) d[2] * (double) d[2];
    if (light->kind != AG_LIGHT_POINT && !(length2 > 0 && isfinite(length2)))
        return "direction has no length or is not finite";
    return NULL;
}

const char *ag_camera_fault(const ag_camera *camera, bool placed)
{
    if (camera->orthographic) {
        if (!(camera->half_height > 0) || !isfinite(camera->half_height))
            return "half height must be above 0";
        if (!isfinite(camera->znear) || !isfinite(camera->zfar) || camera->zfar <= camera->znear)
            return "zfar must be beyond znear, both finite";
    } else {
        if (!(camera->yfov > 0 && (double) camera->yfov < 3.14159265358979))
            return "field of view must be in (0, pi)";
        if (!(camera->znear > 0) || !isfinite(camera->znear))
            return "znear must be above 0";
    }
    return placed && !ag_mat_finite(camera->world) ? "world is not finite" : NULL;
}

void ag_light_normalize(ag_light *light)
{
    double d[3], length2 = 0;
    for (int i = 0; i < 3; i++) {
        d[i] = (double) light->direction[i];
        length2 += d[i] * d[i];
    }
    for (int i = 0; i < 3; i++)
        light->direction[i] =
            length2 > 0 && isfinite(length2) ? (float) (d[i] / sqrt(length2)) : -(float) (i == 2);
}

int ag_builder_light(ag_builder *b, int node, const ag_light *light)
{
    if (!ag_builder_open(b) || (node != -1 && !node_exists(b, "light", node)))
        return -1;
    ag_scene_private *p = b->p;
    const char *fault = ag_light_fault(light, node == -1);
    if (fault)
        return ag_builder_refuse(b, FG_ERR_INVALID, "light %zu '%.63s': %s", p->lights.count,
                                 light->name, fault);
    ag_light *copy = ag_builder_push(b, &p->lights, sizeof *copy, "lights");
    int *at = copy ? ag_builder_push(b, &p->light_nodes, sizeof *at, "lights") : NULL;
    if (!at)
        return -1;
    *copy = *light;
    copy->moving = false;
    ag_light_normalize(copy);
    *at = node;
    return (int) p->lights.count - 1;
}

int ag_builder_camera(ag_builder *b, int node, const ag_camera *camera)
{
    if (!ag_builder_open(b) || (node != -1 && !node_exists(b, "camera", node)))
        return -1;
    ag_scene_private *p = b->p;
    const char *fault = ag_camera_fault(camera, node == -1);
    if (fault)
        return ag_builder_refuse(b, FG_ERR_INVALID, "camera %zu '%.63s': %s", p->cameras.count,
                                 camera->name, fault);
    ag_camera *copy = ag_builder_push(b, &p->cameras, sizeof *copy, "cameras");
    int *at = copy ? ag_builder_push(b, &p->camera_nodes, sizeof *at, "cameras") : NULL;
    if (!at)
        return -1;
    *copy = *camera;
    copy->moving = false;
    if (node == -1)
        ag_mat_rigid(camera->world, copy->world);
    *at = node;
    return (int) p->cameras.count - 1;
}
