// SPDX-License-Identifier: MIT
// Checks of nodes, scenes, skins and animations.
#include "gltf_load.h"

#include <stdlib.h>
#include <string.h>

static bool refuse(gltf_loader *l, const char *what, int i, const char *why)
{
    ag_builder_refuse(l->b, FG_ERR_INPUT, "%s %d: %s", what, i, why);
    return false;
}

static bool sized(gltf_loader *l, int i, const char *field, gltf_numbers n, int size)
{
    if (n.count == 0 || n.count == size)
        return true;
    ag_builder_refuse(l->b, FG_ERR_INPUT, "node %d: %s has %d numbers, must have %d", i, field,
                      n.count, size);
    return false;
}

static bool check_node(gltf_loader *l, int i)
{
    const gltf_model *m = l->m;
    const gltf_node *n = &m->nodes[i];
    return gltf_refers(l, "node", i, "mesh", n->mesh, m->meshes_count) &&
           gltf_refers(l, "node", i, "camera", n->camera, m->cameras_count) &&
           gltf_refers(l, "node", i, "skin", n->skin, m->skins_count) &&
           gltf_refers(l, "node", i, "light", n->light, m->lights_count) &&
           sized(l, i, "translation", n->translation, 3) &&
           sized(l, i, "rotation", n->rotation, 4) && sized(l, i, "scale", n->scale, 3) &&
           sized(l, i, "matrix", n->matrix, 16);
}

static bool find_parents(gltf_loader *l)
{
    const gltf_model *m = l->m;
    for (int i = 0; i < m->nodes_count; i++)
        l->parents[i] = -1;
    for (int i = 0; i < m->nodes_count; i++)
        for (int k = 0; k < m->nodes[i].children.count; k++) {
            int child = m->nodes[i].children.v[k];
            if (child < 0)
                return refuse(l, "node", i, "a child's index is negative");
            if (!gltf_refers(l, "node", i, "child", child, m->nodes_count))
                return false;
            if (l->parents[child] >= 0)
                return refuse(l, "node", child, "it is a child twice; nodes must form trees");
            l->parents[child] = i;
        }
    return true;
}

// With one parent each, what no root leads to goes round in a circle.
static bool find_loops(gltf_loader *l)
{
    const gltf_model *m = l->m;
    int *stack = malloc(((size_t) m->nodes_count + 1) * sizeof *stack);
    if (!stack)
        return gltf_no_memory(l);
    int top = 0, reached = 0;
    for (int i = 0; i < m->nodes_count; i++)
        if (l->parents[i] < 0)
            stack[top++] = i;
    while (top > 0) {
        const gltf_node *n = &m->nodes[stack[--top]];
        reached++;
        for (int k = 0; k < n->children.count; k++)
            stack[top++] = n->children.v[k];
    }
    free(stack);
    if (reached == m->nodes_count)
        return true;
    ag_builder_refuse(l->b, FG_ERR_INPUT, "nodes: %d of %d are their own ancestors",
                      m->nodes_count - reached, m->nodes_count);
    return false;
}

// ---- the scene that is shown ------------------------------------------------------

// Everything below the roots of the default scene, of the first one where none is named, or
// every node where there is no scene at all.
static bool find_scene(gltf_loader *l)
{
    const gltf_model *m = l->m;
    for (int s = 0; s < m->scenes_count; s++)
        for (int k = 0; k < m->scenes[s].nodes.count; k++) {
            int node = m->scenes[s].nodes.v[k];
            if (node < 0)
                return refuse(l, "scene", s, "a node's index is negative");
            if (!gltf_refers(l, "scene", s, "node", node, m->nodes_count))
                return false;
        }
    if (m->default_scene < -1 || m->default_scene >= m->scenes_count) {
        ag_builder_refuse(l->b, FG_ERR_INPUT, "scene: %d does not exist (there are %d)",
                          m->default_scene, m->scenes_count);
        return false;
    }
    if (m->scenes_count == 0) {
        memset(l->in_scene, 1, (size_t) m->nodes_count * sizeof *l->in_scene);
        return true;
    }
    int shown = m->default_scene >= 0 ? m->default_scene : 0;
    if (m->scenes_count > 1)
        ag_builder_info(l->b, "scene %d '%.60s' of %d is shown", shown, m->scenes[shown].name,
                        m->scenes_count);
    for (int k = 0; k < m->scenes[shown].nodes.count; k++) {
        int node = m->scenes[shown].nodes.v[k];
        l->in_scene[node] = true;
        if (l->parents[node] >= 0)
            ag_builder_warn(l->b, "scene %d: node %d is no root; it keeps its parent's transform",
                            shown, node);
    }
    return true;
}

static bool check_skins(gltf_loader *l)
{
    const gltf_model *m = l->m;
    for (int i = 0; i < m->skins_count; i++) {
        const gltf_skin *skin = &m->skins[i];
        if (skin->joints.count == 0)
            return refuse(l, "skin", i, "it has no joints");
        for (int k = 0; k < skin->joints.count; k++)
            if (skin->joints.v[k] < 0)
                return refuse(l, "skin", i, "a joint's index is negative");
            else if (!gltf_refers(l, "skin", i, "joint", skin->joints.v[k], m->nodes_count))
                return false;
        if (!gltf_refers(l, "skin", i, "inverseBindMatrices", skin->inverse_bind,
                         m->accessors_count))
            return false;
        if (skin->inverse_bind < 0)
            continue;
        const gltf_accessor *a = &m->accessors[skin->inverse_bind];
        if (a->columns != 4 || a->component_type != 5126 || a->count < (size_t) skin->joints.count)
            return refuse(l, "skin", i, "inverseBindMatrices must be float MAT4, one a joint");
    }
    return true;
}

bool gltf_check_nodes(gltf_loader *l)
{
    for (int i = 0; i < l->m->nodes_count; i++)
        if (!check_node(l, i))
            return false;
    return find_parents(l) && find_loops(l) && find_scene(l) && check_skins(l);
}

// ---- animations -------------------------------------------------------------------

static bool check_curve(gltf_loader *l, int animation, const gltf_curve *c)
{
    static const char *const kinds[] = { "LINEAR", "STEP", "CUBICSPLINE" };
    const gltf_model *m = l->m;
    if (c->input < 0 || c->output < 0)
        return refuse(l, "animation", animation, "a sampler lacks input or output");
    if (!gltf_refers(l, "animation", animation, "input accessor", c->input, m->accessors_count) ||
        !gltf_refers(l, "animation", animation, "output accessor", c->output, m->accessors_count))
        return false;
    const gltf_accessor *in = &m->accessors[c->input];
    if (in->columns != 1 || in->rows != 1 || in->component_type != 5126)
        return refuse(l, "animation", animation, "a sampler's input must be float SCALAR");
    for (int k = 0; k < FG_COUNT(kinds); k++)
        if (strcmp(c->interpolation, kinds[k]) == 0)
            return true;
    ag_builder_refuse(l->b, FG_ERR_INPUT, "animation %d: interpolation '%.30s' does not exist",
                      animation, c->interpolation);
    return false;
}

// Whether the sampler's output has what the path takes, as often as its input has keys.
static bool check_channel(gltf_loader *l, int animation, const gltf_channel *c)
{
    const gltf_model *m = l->m;
    const gltf_animation *a = &m->animations[animation];
    if (c->sampler < 0)
        return refuse(l, "animation", animation, "a channel has no sampler");
    if (!gltf_refers(l, "animation", animation, "sampler", c->sampler, a->curve_count) ||
        !gltf_refers(l, "animation", animation, "target node", c->node, m->nodes_count))
        return false;
    bool rotation = strcmp(c->path, "rotation") == 0;
    bool vector = strcmp(c->path, "translation") == 0 || strcmp(c->path, "scale") == 0;
    if (c->node < 0 || (!rotation && !vector))
        return true; // not ours to play: gltf_load_animations() says so
    const gltf_curve *curve = &a->curves[c->sampler];
    const gltf_accessor *in = &m->accessors[curve->input], *out = &m->accessors[curve->output];
    bool cubic = strcmp(curve->interpolation, "CUBICSPLINE") == 0;
    if (out->columns != 1 || out->rows != (rotation ? 4 : 3) || out->component_type == 5125)
        return refuse(l, "animation", animation, "an output's type is not that of its path");
    if (out->count / (cubic ? 3 : 1) != in->count || out->count % (cubic ? 3 : 1) != 0)
        return refuse(l, "animation", animation, "a sampler's output has not one value a key");
    return true;
}

bool gltf_check_animations(gltf_loader *l)
{
    for (int i = 0; i < l->m->animations_count; i++) {
        const gltf_animation *a = &l->m->animations[i];
        for (int k = 0; k < a->curve_count; k++)
            if (!check_curve(l, i, &a->curves[k]))
                return false;
        for (int k = 0; k < a->channel_count; k++)
            if (!check_channel(l, i, &a->channels[k]))
                return false;
    }
    return true;
}
