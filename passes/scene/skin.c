// SPDX-License-Identifier: MIT
// Skinning on the CPU, in double precision, into world space.
#include "scene_priv.h"

#include <math.h>
#include <pass/math.h>
#include <string.h>

// Worlds and normal matrices of a skin's joints, [16] and [9] each.
static void joint_matrices(const ag_scene_private *p, const ag_skin *skin)
{
    const ag_node *nodes = p->nodes.data;
    double *at = p->joint_worlds;
    for (size_t i = 0; i < (size_t) skin->count; i++, at += 25) {
        ag_mat_mul(nodes[skin->joints[i]].world, skin->inverse_bind + 16 * i, at);
        ag_mat_normal(at, at + 16);
    }
}

static void skin_vertex(const double *joints, const ag_rest_vertex *rest, ag_vertex *out)
{
    double position[3] = { 0 }, normal[3] = { 0 };
    for (int k = 0; k < 4; k++) {
        const double *m = joints + (size_t) rest->influence.joint[k] * 25, *n = m + 16;
        double w = (double) rest->influence.weight[k];
        if (w == 0)
            continue;
        for (int i = 0; i < 3; i++) {
            position[i] +=
                w * (m[i] * (double) rest->position[0] + m[4 + i] * (double) rest->position[1] +
                     m[8 + i] * (double) rest->position[2] + m[12 + i]);
            normal[i] +=
                w * (n[i] * (double) rest->normal[0] + n[3 + i] * (double) rest->normal[1] +
                     n[6 + i] * (double) rest->normal[2]);
        }
    }
    double length2 = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
    for (int i = 0; i < 3; i++) {
        out->position[i] = (float) position[i];
        out->normal[i] = length2 > 0 ? (float) (normal[i] / sqrt(length2)) : rest->normal[i];
        if (!isfinite(out->position[i]) || !isfinite(out->normal[i])) {
            memcpy(out->position, rest->position, sizeof out->position);
            memcpy(out->normal, rest->normal, sizeof out->normal);
            return;
        }
    }
}

static bool skin_primitive(ag_scene_private *p, const ag_skinned *skinned)
{
    ag_primitive *primitive = (ag_primitive *) p->primitives.data + skinned->primitive;
    const ag_rest_vertex *rest = (const ag_rest_vertex *) p->rest.data + skinned->first_rest;
    ag_vertex *vertices = (ag_vertex *) p->vertices.data + primitive->first_vertex;
    bool changed = false;
    joint_matrices(p, (const ag_skin *) p->skins.data + skinned->skin);
    for (uint32_t i = 0; i < primitive->vertex_count; i++) {
        ag_vertex was = vertices[i];
        skin_vertex(p->joint_worlds, &rest[i], &vertices[i]);
        for (int k = 0; k < 3; k++)
            changed = changed || was.position[k] != vertices[i].position[k] ||
                      was.normal[k] != vertices[i].normal[k];
    }
    if (changed)
        ag_primitive_bounds(p, primitive);
    return changed;
}

bool ag_skin_all(ag_scene_private *p, bool first)
{
    bool changed = false;
    const ag_skinned *skinned = p->skinned.data;
    for (size_t i = 0; i < p->skinned.count; i++)
        if (first || skinned[i].moving)
            changed = skin_primitive(p, &skinned[i]) || changed;
    return changed;
}
