// SPDX-License-Identifier: MIT
// From a builder to a scene.
#include "scene_priv.h"

#include <math.h>
#include <pass/math.h>
#include <stdlib.h>
#include <string.h>

// Primitives without a material get the default one, made only where it is needed.
static void resolve_materials(ag_builder *b)
{
    int fallback = -1;
    for (size_t i = 0; i < b->p->primitives.count; i++) {
        ag_primitive *primitive = (ag_primitive *) b->p->primitives.data + i;
        if (primitive->material >= 0)
            continue;
        if (fallback < 0) {
            ag_material m = ag_default_material();
            ag_name_copy(m.name, "default");
            fallback = ag_builder_material(b, &m);
        }
        primitive->material = fallback;
    }
}

// ---- skins ------------------------------------------------------------------------

// A copy of a primitive with vertices of its own; the indices serve both.
static int copy_primitive(ag_builder *b, int primitive)
{
    ag_scene_private *p = b->p;
    ag_primitive *to = ag_builder_push(b, &p->primitives, sizeof *to, "primitives");
    ag_staged_skin *staged =
        to ? ag_builder_push(b, &p->staged, sizeof *staged, "primitives") : NULL;
    if (!staged)
        return -1;
    *to = ((ag_primitive *) p->primitives.data)[primitive];
    *staged = ((ag_staged_skin *) p->staged.data)[primitive];
    to->skinned = false;
    size_t count = to->vertex_count, first = to->first_vertex;
    if (p->vertices.count + count > AG_MAX_SCENE_VERTICES)
        return ag_builder_refuse(b, FG_ERR_INVALID, "primitives: more than %d vertices in all",
                                 AG_MAX_SCENE_VERTICES);
    to->first_vertex = (uint32_t) p->vertices.count;
    ag_vertex *vertices = ag_array_push(&p->vertices, count, sizeof *vertices);
    if (!vertices)
        return ag_builder_refuse(b, FG_ERR_MEMORY, "primitives: out of memory");
    memcpy(vertices, (ag_vertex *) p->vertices.data + first, count * sizeof *vertices);
    return (int) p->primitives.count - 1;
}

// Sets the vertices of a primitive aside as those at rest.
static int rest_primitive(ag_builder *b, int primitive, int skin)
{
    ag_scene_private *p = b->p;
    ag_primitive *of = (ag_primitive *) p->primitives.data + primitive;
    const ag_influence *influence = (const ag_influence *) p->influences.data +
                                    ((ag_staged_skin *) p->staged.data)[primitive].first_influence;
    const ag_vertex *vertices = (const ag_vertex *) p->vertices.data + of->first_vertex;
    ag_skinned *skinned = ag_builder_push(b, &p->skinned, sizeof *skinned, "skinned primitives");
    if (!skinned)
        return -1;
    *skinned = (ag_skinned){ .primitive = primitive, .skin = skin, .first_rest = p->rest.count };
    ag_rest_vertex *rest = ag_array_push(&p->rest, of->vertex_count, sizeof *rest);
    if (!rest)
        return ag_builder_refuse(b, FG_ERR_MEMORY, "skins: out of memory");
    for (uint32_t i = 0; i < of->vertex_count; i++) {
        memcpy(rest[i].position, vertices[i].position, sizeof rest[i].position);
        memcpy(rest[i].normal, vertices[i].normal, sizeof rest[i].normal);
        rest[i].influence = influence[i];
    }
    of->skinned = true;
    return 0;
}

// The copy of `primitive` that goes with `skin`, found through `next` (the next copy, -1: none).
static int primitive_with_skin(ag_builder *b, int primitive, int skin, ag_array *next)
{
    for (;;) {
        ag_staged_skin *staged = (ag_staged_skin *) b->p->staged.data + primitive;
        if (staged->skin == skin)
            return primitive;
        int *after = (int *) next->data + primitive;
        if (staged->skin == -2) {
            staged->skin = skin;
            return skin < 0 || rest_primitive(b, primitive, skin) == 0 ? primitive : -1;
        }
        if (*after < 0) {
            int copy = copy_primitive(b, primitive);
            int *last = copy < 0 ? NULL : ag_builder_push(b, next, sizeof *last, "primitives");
            if (!last)
                return -1;
            *last = -1;
            ((int *) next->data)[primitive] = copy;
            ((ag_staged_skin *) b->p->staged.data)[copy].skin = -2;
            primitive = copy;
            continue;
        }
        primitive = *after;
    }
}

// Copies are made of vertices at rest: nothing is skinned before the build ends.
static void resolve_skins(ag_builder *b)
{
    ag_scene_private *p = b->p;
    const int *skins = p->instance_skins.data;
    ag_array next = { 0 };
    int *none = ag_array_push(&next, p->primitives.count, sizeof *none);
    if (!none && p->primitives.count > 0) {
        ag_builder_refuse(b, FG_ERR_MEMORY, "skins: out of memory");
        return;
    }
    if (none)
        memset(none, 0xff, p->primitives.count * sizeof *none);
    for (size_t i = 0; i < p->instances.count && b->status == FG_OK; i++) {
        ag_instance *instance = (ag_instance *) p->instances.data + i;
        instance->primitive = primitive_with_skin(b, instance->primitive, skins[i], &next);
    }
    ag_array_finish(&next);
    int joints = 1;
    for (size_t i = 0; i < p->skins.count; i++) {
        int count = ((ag_skin *) p->skins.data)[i].count;
        joints = count > joints ? count : joints;
    }
    p->joint_worlds = malloc((size_t) joints * 25 * sizeof *p->joint_worlds);
    if (!p->joint_worlds)
        ag_builder_refuse(b, FG_ERR_MEMORY, "skins: out of memory");
}

// ---- what moves -------------------------------------------------------------------

static bool skin_moves(const ag_scene_private *p, int skin)
{
    const ag_skin *s = (const ag_skin *) p->skins.data + skin;
    const ag_node *nodes = p->nodes.data;
    for (int i = 0; i < s->count; i++)
        if (nodes[s->joints[i]].moving)
            return true;
    return false;
}

static bool mask_moves(const ag_scene_private *p, int primitive)
{
    const int material = ((const ag_primitive *) p->primitives.data)[primitive].material;
    const ag_material *m = (const ag_material *) p->materials.data + material;
    return m->alpha == AG_ALPHA_MASK && m->base_color_tex.texture >= 0 &&
           ((const ag_material_drive *) p->drives.data)[material].uv_moves;
}

static void find_moving(ag_scene_private *p)
{
    ag_node *nodes = p->nodes.data;
    for (size_t i = 0; i < p->nodes.count; i++)
        if (nodes[i].parent >= 0 && nodes[nodes[i].parent].moving)
            nodes[i].moving = true;
    const int *skins = p->instance_skins.data;
    ag_instance *instances = p->instances.data;
    for (size_t i = 0; i < p->instances.count; i++)
        instances[i].moving =
            (skins[i] >= 0 ? skin_moves(p, skins[i]) : nodes[instances[i].node].moving) ||
            mask_moves(p, instances[i].primitive);
    ag_skinned *skinned = p->skinned.data;
    for (size_t i = 0; i < p->skinned.count; i++)
        skinned[i].moving = skin_moves(p, skinned[i].skin);
    const int *at = p->light_nodes.data;
    for (size_t i = 0; i < p->lights.count; i++)
        ((ag_light *) p->lights.data)[i].moving = at[i] >= 0 && nodes[at[i]].moving;
    at = p->camera_nodes.data;
    for (size_t i = 0; i < p->cameras.count; i++)
        ((ag_camera *) p->cameras.data)[i].moving = at[i] >= 0 && nodes[at[i]].moving;
}

static void first_worlds(ag_builder *b)
{
    ag_animate(b->p, 0);
    ag_worlds_update(b->p, true);
    ag_node *nodes = b->p->nodes.data;
    for (size_t i = 0; i < b->p->nodes.count; i++) {
        if (!ag_mat_finite(nodes[i].world)) {
            ag_builder_refuse(b, FG_ERR_INVALID, "node %zu '%s': its world transform is not finite",
                              i, nodes[i].name);
            return;
        }
        memcpy(nodes[i].first_world, nodes[i].world, sizeof nodes[i].world);
    }
}

// Files hide things by a scale of 0. What has no area at all would have no normals either.
static void drop_hidden(ag_builder *b)
{
    ag_scene_private *p = b->p;
    ag_instance *instances = p->instances.data;
    int *skins = p->instance_skins.data;
    const ag_node *nodes = p->nodes.data;
    size_t kept = 0;
    for (size_t i = 0; i < p->instances.count; i++) {
        double normal[9], largest = 0;
        ag_mat_normal(nodes[instances[i].node].world, normal);
        for (int k = 0; k < 9; k++)
            largest = fmax(largest, fabs(normal[k]));
        if (largest == 0 && skins[i] < 0 && !nodes[instances[i].node].moving)
            continue;
        instances[kept] = instances[i];
        skins[kept++] = skins[i];
    }
    if (kept < p->instances.count)
        ag_builder_warn(b, "%zu instances are scaled to nothing and left out",
                        p->instances.count - kept);
    p->instances.count = p->instance_skins.count = kept;
}

static void say_how_many_warnings(const ag_builder *b)
{
    if (b->warnings > AG_MAX_SCENE_WARNINGS)
        fg_logf(&b->p->log, FG_LOG_WARN, "%s: %d more repairs are not listed", b->p->label,
                b->warnings - AG_MAX_SCENE_WARNINGS);
}

fg_status ag_scene_build(ag_builder *b, ag_scene **out)
{
    *out = NULL;
    if (!b)
        return FG_ERR_MEMORY;
    if (!ag_builder_open(b))
        return b->status;
    resolve_materials(b);
    resolve_skins(b);
    if (b->status != FG_OK)
        return b->status;
    find_moving(b->p);
    ag_scene *scene = calloc(1, sizeof *scene);
    ag_scene_private *spare = calloc(1, sizeof *spare);
    char *label = strdup(b->p->label);
    if (!scene || !spare || !label) {
        ag_builder_refuse(b, FG_ERR_MEMORY, "scene: out of memory");
        goto fail;
    }
    first_worlds(b);
    if (b->status != FG_OK)
        goto fail;
    drop_hidden(b);
    say_how_many_warnings(b);
    spare->log = b->p->log;
    spare->label = label;
    ag_name_copy(scene->name, b->name);
    scene->priv = b->p;
    scene->warning_count = b->warnings;
    b->p = spare;
    b->built = true;
    ag_scene_publish(scene);
    ag_scene_follow(scene, true);
    scene->features = ag_scene_features(scene);
    *out = scene;
    return FG_OK;

fail:
    free(scene);
    free(spare);
    free(label);
    return b->status;
}
