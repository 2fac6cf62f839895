// SPDX-License-Identifier: MIT
#include "scene_priv.h"

#include <math.h>
#include <pass/math.h>
#include <stdlib.h>
#include <string.h>

void ag_scene_private_destroy(ag_scene_private *p)
{
    if (!p)
        return;
    const ag_texture *textures = p->textures.data;
    for (size_t i = 0; i < p->textures.count; i++)
        free((void *) textures[i].rgba);
    const ag_channel *channels = p->channels.data;
    for (size_t i = 0; i < p->channels.count; i++)
        free(channels[i].times);
    const ag_skin *skins = p->skins.data;
    for (size_t i = 0; i < p->skins.count; i++) {
        free(skins[i].joints);
        free(skins[i].inverse_bind);
    }
    ag_array *arrays[] = {
        &p->vertices,   &p->indices,     &p->primitives,     &p->staged,
        &p->influences, &p->instances,   &p->materials,      &p->textures,
        &p->lights,     &p->light_nodes, &p->cameras,        &p->nodes,
        &p->channels,   &p->lengths,     &p->skins,          &p->camera_nodes,
        &p->skinned,    &p->rest,        &p->instance_skins, &p->drives,
        NULL,
    };
    for (int i = 0; arrays[i]; i++)
        ag_array_finish(arrays[i]);
    free(p->joint_worlds);
    free(p->label);
    free(p);
}

void ag_scene_destroy(ag_scene *scene)
{
    if (!scene)
        return;
    ag_scene_private_destroy(scene->priv);
    free(scene);
}

void ag_scene_publish(ag_scene *s)
{
    const ag_scene_private *p = s->priv;
    s->vertices = p->vertices.data;
    s->vertex_count = p->vertices.count;
    s->indices = p->indices.data;
    s->index_count = p->indices.count;
    s->primitives = p->primitives.data;
    s->primitive_count = (int) p->primitives.count;
    s->instances = p->instances.data;
    s->instance_count = (int) p->instances.count;
    s->materials = p->materials.data;
    s->material_count = (int) p->materials.count;
    s->textures = p->textures.data;
    s->texture_count = (int) p->textures.count;
    s->lights = p->lights.data;
    s->light_count = (int) p->lights.count;
    s->cameras = p->cameras.data;
    s->camera_count = (int) p->cameras.count;
    s->duration = 0;
    for (size_t i = 0; i < p->lengths.count; i++)
        s->duration = fmax(s->duration, ((double *) p->lengths.data)[i]);
}

// ---- time -------------------------------------------------------------------------

void ag_worlds_update(ag_scene_private *p, bool first)
{
    ag_node *nodes = p->nodes.data;
    for (size_t i = 0; i < p->nodes.count; i++) {
        ag_node *n = &nodes[i];
        if (!first && !n->moving)
            continue;
        double local[16];
        if (n->has_matrix)
            memcpy(local, n->matrix, sizeof local);
        else
            ag_mat_from_trs(n->pose.translation, n->pose.rotation, n->pose.scale, local);
        if (n->parent >= 0)
            ag_mat_mul(nodes[n->parent].world, local, n->world);
        else
            memcpy(n->world, local, sizeof local);
        if (!first && !ag_mat_finite(n->world))
            memcpy(n->world, n->first_world, sizeof n->world);
    }
}

// Sets a world; true if it is another one than before.
static bool move(double world[16], const double to[16])
{
    bool changed = false;
    for (int i = 0; i < 16; i++) {
        changed = changed || world[i] != to[i];
        world[i] = to[i];
    }
    return changed;
}

static bool follow_instances(ag_scene_private *p, bool first)
{
    bool changed = false;
    const ag_node *nodes = p->nodes.data;
    const int *skins = p->instance_skins.data;
    ag_instance *instances = p->instances.data;
    double identity[16], joint[16];
    ag_mat_identity(identity);
    for (size_t i = 0; i < p->instances.count; i++) {
        ag_instance *instance = &instances[i];
        const double *world = nodes[instance->node].world, *winding = world;
        if (!first && !instance->moving)
            continue;
        if (skins[i] >= 0) {
            const ag_skin *skin = (const ag_skin *) p->skins.data + skins[i];
            ag_mat_mul(nodes[skin->joints[0]].world, skin->inverse_bind, joint);
            world = identity;
            winding = joint;
        }
        instance->mirrored = ag_mat_determinant3(winding) < 0;
        changed = move(instance->world, world) || changed;
    }
    return changed;
}

static bool follow_lights(ag_scene_private *p, bool first)
{
    static const double forward[3] = { 0, 0, -1 };
    bool changed = false;
    const int *at = p->light_nodes.data;
    ag_light *lights = p->lights.data;
    for (size_t i = 0; i < p->lights.count; i++) {
        ag_light *light = &lights[i];
        if (at[i] < 0 || (!first && !light->moving))
            continue;
        double rigid[16], direction[3];
        ag_mat_rigid(((const ag_node *) p->nodes.data)[at[i]].world, rigid);
        ag_mat_vector(rigid, forward, direction);
        for (int k = 0; k < 3; k++) {
            changed = changed || light->position[k] != rigid[12 + k] ||
                      light->direction[k] != (float) direction[k];
            light->position[k] = rigid[12 + k];
            light->direction[k] = (float) direction[k];
        }
    }
    return changed;
}

static void follow_cameras(ag_scene_private *p, bool first)
{
    const int *at = p->camera_nodes.data;
    ag_camera *cameras = p->cameras.data;
    for (size_t i = 0; i < p->cameras.count; i++)
        if (at[i] >= 0 && (first || cameras[i].moving))
            ag_mat_rigid(((const ag_node *) p->nodes.data)[at[i]].world, cameras[i].world);
}

void ag_primitive_bounds(const ag_scene_private *p, ag_primitive *primitive)
{
    const ag_vertex *v = (const ag_vertex *) p->vertices.data + primitive->first_vertex;
    for (int k = 0; k < 3; k++) {
        primitive->box_min[k] = primitive->vertex_count > 0 ? v[0].position[k] : 0;
        primitive->box_max[k] = primitive->box_min[k];
    }
    for (uint32_t i = 1; i < primitive->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            primitive->box_min[k] = fminf(primitive->box_min[k], v[i].position[k]);
            primitive->box_max[k] = fmaxf(primitive->box_max[k], v[i].position[k]);
        }
}

// Widens the scene's box by the corners of an instance's.
static void add_bounds(ag_scene *s, const ag_instance *instance)
{
    const ag_primitive *primitive = &s->primitives[instance->primitive];
    if (primitive->index_count == 0)
        return;
    for (int corner = 0; corner < 8; corner++) {
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = (double) (corner >> k & 1 ? primitive->box_max : primitive->box_min)[k];
        ag_mat_point(instance->world, p, p);
        for (int k = 0; k < 3; k++) {
            s->box_min[k] = fmin(s->box_min[k], p[k]);
            s->box_max[k] = fmax(s->box_max[k], p[k]);
        }
    }
}

static void scene_bounds(ag_scene *s)
{
    for (int k = 0; k < 3; k++) {
        s->box_min[k] = (double) INFINITY;
        s->box_max[k] = -(double) INFINITY;
    }
    for (int i = 0; i < s->instance_count; i++)
        add_bounds(s, &s->instances[i]);
}

void ag_scene_follow(ag_scene *s, bool first)
{
    bool moved = follow_instances(s->priv, first);
    moved = ag_skin_all(s->priv, first) || moved;
    bool lit = follow_lights(s->priv, first);
    follow_cameras(s->priv, first);
    bool changed = ag_materials_follow(s->priv, first);
    if (moved || first)
        scene_bounds(s);
    s->geometry_revision += moved || first;
    s->light_revision += lit || first;
    s->material_revision += changed || first;
}

void ag_scene_set_time(ag_scene *s, double seconds)
{
    s->time = isfinite(seconds) && seconds > 0 ? seconds : 0;
    if (s->priv->channels.count == 0)
        return;
    ag_animate(s->priv, s->time);
    ag_worlds_update(s->priv, false);
    ag_scene_follow(s, false);
}

// ---- cameras and lights from outside ----------------------------------------------

int ag_scene_find_camera(const ag_scene *s, const char *name)
{
    for (int i = 0; i < s->camera_count; i++)
        if (strcmp(s->cameras[i].name, name) == 0)
            return i;
    return -1;
}

ag_camera ag_scene_framing_camera(const ag_scene *s)
{
    ag_camera camera = ag_default_camera();
    ag_name_copy(camera.name, "framing");
    if (s->box_min[0] > s->box_max[0])
        return camera;
    double radius2 = 0;
    for (int k = 0; k < 3; k++) {
        double half = s->box_max[k] / 2 - s->box_min[k] / 2;
        camera.world[12 + k] = s->box_min[k] + half;
        radius2 += half * half;
    }
    double radius = fmax(sqrt(radius2), 1e-6);
    // The sphere around the box touches the view's edges, and 5 % more.
    double distance = 1.05 * radius / sin((double) camera.yfov / 2);
    camera.world[14] += distance;
    camera.znear = (float) fmin(fmax((distance - radius) / 2, 1e-30), 1e30);
    return camera;
}

// The place of an item called `name`, or a new one at the end.
static int place(ag_array *items, ag_array *nodes, size_t item_size, const char *name)
{
    for (size_t i = 0; i < items->count && name[0] != '\0'; i++)
        if (strcmp((const char *) items->data + i * item_size, name) == 0)
            return (int) i;
    if (!ag_array_push(items, 1, item_size))
        return -1;
    if (ag_array_push(nodes, 1, sizeof(int)))
        return (int) items->count - 1;
    items->count--;
    return -1;
}

fg_status ag_scene_add_light(ag_scene *s, const ag_light *light)
{
    _Static_assert(offsetof(ag_light, name) == 0, "place() reads the name there");
    ag_scene_private *p = s->priv;
    const char *fault = ag_light_fault(light, true);
    if (fault) {
        fg_logf(&p->log, FG_LOG_ERROR, "%s: light '%.63s': %s", p->label, light->name, fault);
        return FG_ERR_INVALID;
    }
    int i = place(&p->lights, &p->light_nodes, sizeof *light, light->name);
    if (i < 0)
        return FG_ERR_MEMORY;
    ag_light *to = (ag_light *) p->lights.data + i;
    *to = *light;
    to->moving = false;
    ((int *) p->light_nodes.data)[i] = -1;
    ag_light_normalize(to);
    ag_scene_publish(s);
    s->features = ag_scene_features(s);
    s->light_revision++;
    return FG_OK;
}

fg_status ag_scene_add_camera(ag_scene *s, const ag_camera *camera)
{
    _Static_assert(offsetof(ag_camera, name) == 0, "place() reads the name there");
    ag_scene_private *p = s->priv;
    const char *fault = ag_camera_fault(camera, true);
    if (fault) {
        fg_logf(&p->log, FG_LOG_ERROR, "%s: camera '%.63s': %s", p->label, camera->name, fault);
        return FG_ERR_INVALID;
    }
    int i = place(&p->cameras, &p->camera_nodes, sizeof *camera, camera->name);
    if (i < 0)
        return FG_ERR_MEMORY;
    ag_camera *to = (ag_camera *) p->cameras.data + i;
    *to = *camera;
    to->moving = false;
    ((int *) p->camera_nodes.data)[i] = -1;
    ag_mat_rigid(camera->world, to->world);
    ag_scene_publish(s);
    return FG_OK;
}
