// SPDX-License-Identifier: MIT
// Nodes with their lights and cameras, animations, and what meshes are shown.
#include "gltf_load.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

// ---- lights and cameras -----------------------------------------------------------

static void cone(gltf_loader *l, int i, const gltf_light *from, ag_light *to)
{
    double inner = from->inner, outer = from->outer;
    if (!(outer >= 0 && outer <= pi / 2 + 1e-6 && inner >= 0 && inner <= outer))
        ag_builder_warn(l->b, "light %d: cone angles %g and %g are brought into 0 to pi/2", i,
                        inner, outer);
    outer = isnan(outer) ? pi / 4 : fmin(fmax(outer, 0), pi / 2);
    inner = isnan(inner) ? 0 : fmin(fmax(inner, 0), outer);
    to->cos_inner = (float) cos(inner);
    to->cos_outer = (float) fmax(cos(outer), 0);
}

static bool load_light(gltf_loader *l, int node, int i)
{
    static const char *const kinds[] = { "point", "spot", "directional" };
    const gltf_light *from = &l->m->lights[i];
    ag_light light = ag_default_light();
    int kind = 0;
    while (kind < FG_COUNT(kinds) && strcmp(from->type, kinds[kind]) != 0)
        kind++;
    if (kind == FG_COUNT(kinds)) {
        ag_builder_refuse(l->b, FG_ERR_INPUT, "light %d: type '%.30s' does not exist", i,
                          from->type);
        return false;
    }
    ag_name_copy(light.name, from->name);
    light.kind = (ag_light_kind) kind;
    light.cosine = kind == AG_LIGHT_SPOT && strcmp(from->profile, "cosine") == 0;
    for (int k = 0; k < 3; k++)
        light.intensity[k] =
            (float) ((k < from->color.count ? from->color.v[k] : 1) * from->intensity);
    if (kind == AG_LIGHT_SPOT)
        cone(l, i, from, &light);
    l->ranges += from->range > 0;
    return ag_builder_light(l->b, node, &light) >= 0;
}

static bool load_camera(gltf_loader *l, int node, int i)
{
    const gltf_camera *from = &l->m->cameras[i];
    ag_camera camera = ag_default_camera();
    ag_name_copy(camera.name, from->name);
    camera.orthographic = strcmp(from->type, "orthographic") == 0;
    if (!camera.orthographic && strcmp(from->type, "perspective") != 0) {
        ag_builder_refuse(l->b, FG_ERR_INPUT, "camera %d: type '%.30s' does not exist", i,
                          from->type);
        return false;
    }
    if (camera.orthographic) {
        camera.half_height = (float) fabs(from->ymag);
        camera.znear = (float) from->ortho_near;
        camera.zfar = (float) from->ortho_far;
    } else {
        camera.yfov = (float) from->yfov;
        camera.znear = (float) from->znear;
    }
    return ag_builder_camera(l->b, node, &camera) >= 0;
}

// ---- nodes ------------------------------------------------------------------------

static void copy_numbers(gltf_numbers from, double *to)
{
    for (int i = 0; i < from.count; i++)
        to[i] = from.v[i];
}

static bool add_node(gltf_loader *l, int i)
{
    const gltf_node *n = &l->m->nodes[i];
    int parent = l->parents[i];
    ag_node_desc desc = {
        .name = n->name,
        .parent = parent >= 0 ? l->nodes[parent] : -1,
        .matrix = n->matrix.count > 0 ? n->matrix.v : NULL,
    };
    copy_numbers(n->translation, desc.translation);
    copy_numbers(n->rotation, desc.rotation);
    copy_numbers(n->scale, desc.scale);
    l->nodes[i] = ag_builder_node(l->b, &desc);
    if (l->nodes[i] < 0)
        return false;
    ag_node *node = (ag_node *) l->b->p->nodes.data + l->nodes[i];
    if (n->scale.count > 0) {
        // A file's scale of 0 hides the node; the builder's means that none is given.
        copy_numbers(n->scale, node->rest.scale);
        node->pose = node->rest;
    }
    l->in_scene[i] = l->in_scene[i] || (parent >= 0 && l->in_scene[parent]);
    if (!l->in_scene[i])
        return true;
    return (n->camera < 0 || load_camera(l, l->nodes[i], n->camera)) &&
           (n->light < 0 || load_light(l, l->nodes[i], n->light));
}

static bool load_skins(gltf_loader *l)
{
    for (int i = 0; i < l->m->skins_count; i++) {
        const gltf_skin *skin = &l->m->skins[i];
        size_t count = (size_t) skin->joints.count;
        if (!gltf_spend(l, 16 * count, "skin", i))
            return false;
        int *joints = malloc(count * sizeof *joints);
        float *inverse = malloc(count * 16 * sizeof *inverse);
        bool ok = joints && inverse;
        for (size_t k = 0; ok && k < count; k++)
            joints[k] = l->nodes[skin->joints.v[k]];
        if (ok && skin->inverse_bind >= 0) {
            gltf_reader r = gltf_reader_open(l->m, skin->inverse_bind);
            for (size_t k = 0; k < count; k++)
                gltf_read_floats(&r, k, inverse + 16 * k);
        }
        if (ok)
            l->skins[i] = ag_builder_skin(l->b, joints, (int) count,
                                          skin->inverse_bind >= 0 ? inverse : NULL);
        else
            gltf_no_memory(l);
        free(joints);
        free(inverse);
        if (!ok || l->skins[i] < 0)
            return false;
    }
    return true;
}

// Parents before their children, whatever the order in the file.
bool gltf_load_nodes(gltf_loader *l)
{
    const gltf_model *m = l->m;
    int *queue = malloc(((size_t) m->nodes_count + 1) * sizeof *queue);
    if (!queue)
        return gltf_no_memory(l);
    int end = 0;
    bool ok = true;
    for (int i = 0; i < m->nodes_count; i++)
        if (l->parents[i] < 0)
            queue[end++] = i;
    for (int at = 0; at < end && ok; at++) {
        const gltf_node *n = &m->nodes[queue[at]];
        ok = add_node(l, queue[at]);
        for (int k = 0; k < n->children.count; k++)
            queue[end++] = n->children.v[k];
    }
    free(queue);
    return ok && load_skins(l);
}

// ---- what is shown ----------------------------------------------------------------

typedef struct converted {
    bool done;
    int first, count; // the builder's primitives
} converted;

static bool show(gltf_loader *l, int i, converted *meshes)
{
    const gltf_node *n = &l->m->nodes[i];
    converted own = { 0 }, *mesh = &meshes[n->mesh];
    // Weights of the node's own make other shapes of the same mesh.
    if (n->weights.count > 0)
        mesh = &own;
    if (!mesh->done)
        mesh->first = gltf_load_mesh(l, n->mesh, n->weights, &mesh->count);
    mesh->done = true;
    if (mesh->first < 0)
        return false;
    for (int k = 0; k < mesh->count; k++)
        ag_builder_show(l->b, l->nodes[i], mesh->first + k, n->skin >= 0 ? l->skins[n->skin] : -1);
    return l->b->status == FG_OK;
}

bool gltf_load_shows(gltf_loader *l)
{
    size_t count = (size_t) l->m->meshes_count;
    converted *meshes = calloc(count + 1, sizeof *meshes);
    if (!meshes)
        return gltf_no_memory(l);
    bool ok = true;
    for (int i = 0; i < l->m->nodes_count && ok; i++)
        if (l->in_scene[i] && l->m->nodes[i].mesh >= 0)
            ok = show(l, i, meshes);
    free(meshes);
    return ok;
}

// ---- animations -------------------------------------------------------------------

static float *read_all(gltf_loader *l, int accessor, int values)
{
    gltf_reader r = gltf_reader_open(l->m, accessor);
    float *all = malloc((r.count * (size_t) values + 1) * sizeof *all);
    for (size_t i = 0; all && i < r.count; i++)
        gltf_read_floats(&r, i, all + i * (size_t) values);
    return all;
}

static bool load_channel(gltf_loader *l, int animation, const gltf_channel *c)
{
    static const char *const paths[] = { "translation", "rotation", "scale" };
    int path = 0;
    while (path < 3 && strcmp(c->path, paths[path]) != 0)
        path++;
    const ag_node *nodes = l->b->p->nodes.data;
    if (c->node < 0 || path == 3 || nodes[l->nodes[c->node]].driven_paths & (1 << path)) {
        l->unplayed++;
        return true;
    }
    const gltf_curve *curve = &l->m->animations[animation].curves[c->sampler];
    size_t keys = l->m->accessors[curve->input].count;
    if (!gltf_spend(l, keys * 13, "animation", animation))
        return false;
    ag_channel_desc desc = {
        .node = l->nodes[c->node],
        .path = (ag_path) path,
        .interpolation = strcmp(curve->interpolation, "STEP") == 0     ? AG_INTERPOLATE_STEP
                         : strcmp(curve->interpolation, "LINEAR") == 0 ? AG_INTERPOLATE_LINEAR
                                                                       : AG_INTERPOLATE_CUBIC,
        .key_count = keys < AG_MAX_SCENE_ITEMS ? (int) keys : AG_MAX_SCENE_ITEMS + 1,
        .animation = animation,
    };
    float *times = read_all(l, curve->input, 1);
    float *values = read_all(l, curve->output, path == AG_PATH_ROTATION ? 4 : 3);
    desc.times = times;
    desc.values = values;
    if (times && values)
        ag_builder_channel(l->b, &desc);
    else
        gltf_no_memory(l);
    free(times);
    free(values);
    return l->b->status == FG_OK;
}

bool gltf_load_animations(gltf_loader *l)
{
    for (int i = 0; i < l->m->animations_count; i++)
        for (int k = 0; k < l->m->animations[i].channel_count; k++)
            if (!load_channel(l, i, &l->m->animations[i].channels[k]))
                return false;
    return true;
}
