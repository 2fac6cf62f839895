// SPDX-License-Identifier: MIT
// Meshes: checks, triangles of every mode, attributes, morph targets at rest.
#include "gltf_load.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MODE_TRIANGLES = 4, MODE_STRIP, MODE_FAN };
enum { BYTE = 5120, UBYTE, SHORT, USHORT, UINT = 5125, FLOAT };

// ---- checks -----------------------------------------------------------------------

static int find(const gltf_attributes *a, const char *name)
{
    for (int i = 0; i < a->count; i++)
        if (strcmp(a->v[i].name, name) == 0)
            return a->v[i].accessor;
    return -1;
}

static bool refuse(gltf_loader *l, int mesh, int primitive, const char *why)
{
    ag_builder_refuse(l->b, FG_ERR_INPUT, "mesh %d primitive %d: %s", mesh, primitive, why);
    return false;
}

// What the attributes that are read must be made of.
static bool right_type(const char *name, const gltf_accessor *a)
{
    int rows = a->rows, type = a->component_type;
    if (a->columns != 1)
        return false;
    if (strcmp(name, "POSITION") == 0 || strcmp(name, "NORMAL") == 0)
        return rows == 3 && type != UINT;
    if (strncmp(name, "TEXCOORD_", 9) == 0)
        return rows == 2 && type != UINT;
    if (strncmp(name, "COLOR_", 6) == 0)
        return (rows == 3 || rows == 4) && (type == UBYTE || type == USHORT || type == FLOAT);
    if (strncmp(name, "JOINTS_", 7) == 0)
        return rows == 4 && (type == UBYTE || type == USHORT);
    if (strncmp(name, "WEIGHTS_", 8) == 0)
        return rows == 4 && (type == UBYTE || type == USHORT || type == FLOAT);
    return true;
}

static bool check_attributes(gltf_loader *l, int mesh, int primitive, const gltf_attributes *a,
                             size_t *count)
{
    for (int i = 0; i < a->count; i++) {
        char why[128];
        int accessor = a->v[i].accessor;
        if (accessor < 0 || accessor >= l->m->accessors_count) {
            snprintf(why, sizeof why, "%.40s: accessor %d does not exist (there are %d)",
                     a->v[i].name, accessor, l->m->accessors_count);
            return refuse(l, mesh, primitive, why);
        }
        const gltf_accessor *of = &l->m->accessors[accessor];
        if (*count == 0)
            *count = of->count;
        if (of->count != *count) {
            snprintf(why, sizeof why, "%.40s has %zu elements, other attributes have %zu",
                     a->v[i].name, of->count, *count);
            return refuse(l, mesh, primitive, why);
        }
        if (!right_type(a->v[i].name, of)) {
            snprintf(why, sizeof why, "%.40s is of a type that it may not have", a->v[i].name);
            return refuse(l, mesh, primitive, why);
        }
    }
    return true;
}

static bool check_primitive(gltf_loader *l, int mesh, int i)
{
    const gltf_model *m = l->m;
    const gltf_primitive *p = &m->meshes[mesh].primitives[i];
    size_t count = 0;
    if (!gltf_refers(l, "mesh", mesh, "material", p->material, m->materials_count) ||
        !gltf_refers(l, "mesh", mesh, "indices' accessor", p->indices, m->accessors_count) ||
        !check_attributes(l, mesh, i, &p->attributes, &count))
        return false;
    if (p->mode < 0 || p->mode > MODE_FAN)
        return refuse(l, mesh, i, "its mode does not exist");
    for (int t = 0; t < p->target_count; t++)
        if (!check_attributes(l, mesh, i, &p->targets[t], &count))
            return false;
    if (p->indices < 0)
        return true;
    const gltf_accessor *a = &m->accessors[p->indices];
    if (a->columns != 1 || a->rows != 1 ||
        (a->component_type != UBYTE && a->component_type != USHORT && a->component_type != UINT))
        return refuse(l, mesh, i, "indices must be unsigned SCALAR");
    return true;
}

bool gltf_check_meshes(gltf_loader *l)
{
    for (int i = 0; i < l->m->meshes_count; i++) {
        const gltf_mesh *mesh = &l->m->meshes[i];
        for (int k = 0; k < mesh->primitive_count; k++)
            if (!check_primitive(l, i, k))
                return false;
    }
    return true;
}

// ---- triangles --------------------------------------------------------------------

typedef struct shape {
    const gltf_primitive *p;
    int mesh, number;
    gltf_numbers weights;
    uint32_t *corners; // of the triangles; first in the file's numbers, then in ours
    size_t corner_count;
    uint32_t *used; // our vertex to the file's
    size_t vertex_count;
    ag_vertex *vertices;
    uint16_t (*joints)[4];
    float (*joint_weights)[4];
} shape;

// Corner k of triangle t: glTF 2.0, 3.7.2.1.
static size_t corner_of(int mode, size_t t, size_t k)
{
    if (mode == MODE_STRIP)
        return t + (k == 0 ? 0 : k == 1 ? 1 + t % 2 : 2 - t % 2);
    if (mode == MODE_FAN)
        return k == 2 ? 0 : t + 1 + k;
    return 3 * t + k;
}

static bool read_corners(gltf_loader *l, shape *s, size_t vertices)
{
    const gltf_primitive *p = s->p;
    gltf_reader r = { .count = vertices };
    if (p->indices >= 0)
        r = gltf_reader_open(l->m, p->indices);
    size_t triangles = p->mode == MODE_TRIANGLES ? r.count / 3 : r.count < 3 ? 0 : r.count - 2;
    if (p->mode == MODE_TRIANGLES && r.count % 3 != 0)
        ag_builder_warn(l->b, "mesh %d primitive %d: %zu indices, the last %zu make no triangle",
                        s->mesh, s->number, r.count, r.count % 3);
    if (!gltf_spend(l, 3 * triangles, "mesh", s->mesh))
        return false;
    s->corners = malloc((3 * triangles + 1) * sizeof *s->corners);
    s->used = malloc((3 * triangles + 1) * sizeof *s->used);
    if (!s->corners || !s->used)
        return gltf_no_memory(l);
    for (size_t t = 0; t < triangles; t++)
        for (size_t k = 0; k < 3; k++) {
            size_t at = corner_of(p->mode, t, k);
            uint32_t index = p->indices >= 0 ? gltf_read_uint(&r, at) : (uint32_t) at;
            if (index >= vertices) {
                ag_builder_refuse(l->b, FG_ERR_INPUT,
                                  "mesh %d primitive %d: index %zu is %u, there are %zu vertices",
                                  s->mesh, s->number, at, index, vertices);
                return false;
            }
            s->corners[s->corner_count++] = index;
        }
    return true;
}

// Renumbers the corners by the vertices that they use, in order of first use: many primitives
// may share one large array. `stamps` tells this primitive's entries of `slots` from older ones,
// so that nothing is cleared between primitives.
static bool number_vertices(gltf_loader *l, shape *s, size_t vertices)
{
    size_t more = vertices > l->slots.count ? vertices - l->slots.count : 0;
    if (more > 0 && (!ag_array_push(&l->slots, more, sizeof(uint32_t)) ||
                     !ag_array_push(&l->stamps, more, sizeof(uint32_t))))
        return gltf_no_memory(l);
    uint32_t *slots = l->slots.data, *stamps = l->stamps.data, stamp = ++l->stamp;
    for (size_t i = 0; i < s->corner_count; i++) {
        uint32_t index = s->corners[i];
        if (stamps[index] != stamp) {
            stamps[index] = stamp;
            slots[index] = (uint32_t) s->vertex_count;
            s->used[s->vertex_count++] = index;
        }
        s->corners[i] = slots[index];
    }
    return true;
}

// ---- attributes -------------------------------------------------------------------

static bool open_attribute(gltf_loader *l, const shape *s, const char *name, gltf_reader *r)
{
    int accessor = find(&s->p->attributes, name);
    if (accessor < 0)
        return false;
    *r = gltf_reader_open(l->m, accessor);
    return true;
}

static void read_positions(gltf_loader *l, shape *s)
{
    gltf_reader r;
    if (open_attribute(l, s, "POSITION", &r))
        for (size_t i = 0; i < s->vertex_count; i++)
            gltf_read_floats(&r, s->used[i], s->vertices[i].position);
    if (open_attribute(l, s, "NORMAL", &r))
        for (size_t i = 0; i < s->vertex_count; i++)
            gltf_read_floats(&r, s->used[i], s->vertices[i].normal);
    for (int set = 0; set < 2; set++)
        if (open_attribute(l, s, set == 0 ? "TEXCOORD_0" : "TEXCOORD_1", &r))
            for (size_t i = 0; i < s->vertex_count; i++)
                gltf_read_floats(&r, s->used[i], s->vertices[i].uv[set]);
}

static void read_colors(gltf_loader *l, shape *s)
{
    gltf_reader r = { 0 };
    bool given = open_attribute(l, s, "COLOR_0", &r);
    r.normalized = true; // of integers nothing else makes a colour
    for (size_t i = 0; i < s->vertex_count; i++) {
        float *c = s->vertices[i].color;
        c[0] = c[1] = c[2] = c[3] = 1;
        if (given)
            gltf_read_floats(&r, s->used[i], c);
        for (int k = 0; k < 4 && given; k++)
            c[k] = isnan(c[k]) ? c[k] : fminf(fmaxf(c[k], 0), 1);
    }
}

static bool read_joints(gltf_loader *l, shape *s)
{
    gltf_reader joints, weights;
    bool has_joints = open_attribute(l, s, "JOINTS_0", &joints);
    if (has_joints != open_attribute(l, s, "WEIGHTS_0", &weights)) {
        ag_builder_warn(l->b,
                        "mesh %d primitive %d: joints and weights must come together; it is "
                        "not skinned",
                        s->mesh, s->number);
        return true;
    }
    if (!has_joints)
        return true;
    if (find(&s->p->attributes, "JOINTS_1") >= 0)
        ag_builder_warn(l->b, "mesh %d primitive %d: only the first four joints of a vertex count",
                        s->mesh, s->number);
    s->joints = malloc((s->vertex_count + 1) * sizeof *s->joints);
    s->joint_weights = malloc((s->vertex_count + 1) * sizeof *s->joint_weights);
    if (!s->joints || !s->joint_weights)
        return gltf_no_memory(l);
    joints.normalized = false;
    weights.normalized = true;
    for (size_t i = 0; i < s->vertex_count; i++) {
        float joint[4];
        gltf_read_floats(&joints, s->used[i], joint);
        for (int k = 0; k < 4; k++)
            s->joints[i][k] = (uint16_t) joint[k];
        gltf_read_floats(&weights, s->used[i], s->joint_weights[i]);
    }
    return true;
}

// Morph targets with the weights at rest. Normals are normalised by the builder.
static void add_targets(gltf_loader *l, shape *s)
{
    static const char *const names[] = { "POSITION", "NORMAL" };
    for (int t = 0; t < s->p->target_count && t < s->weights.count; t++)
        for (int a = 0; a < 2; a++) {
            int accessor = find(&s->p->targets[t], names[a]);
            double weight = s->weights.v[t];
            if (accessor < 0 || weight == 0 || find(&s->p->attributes, names[a]) < 0)
                continue;
            gltf_reader r = gltf_reader_open(l->m, accessor);
            for (size_t i = 0; i < s->vertex_count; i++) {
                float delta[3], *to = s->vertices[i].position;
                gltf_read_floats(&r, s->used[i], delta);
                if (a == 1)
                    to = s->vertices[i].normal;
                for (int k = 0; k < 3; k++)
                    to[k] += (float) (weight * (double) delta[k]);
            }
        }
}

// ---- the whole --------------------------------------------------------------------

static int material_of(gltf_loader *l, const gltf_primitive *p)
{
    if (p->material >= 0)
        return l->materials[p->material];
    if (l->metal < 0) {
        // glTF's default material is not the builder's: all factors are 1.
        ag_material m = ag_default_material();
        ag_name_copy(m.name, "default");
        m.metallic = 1;
        l->metal = ag_builder_material(l->b, &m);
        ag_builder_info(l->b, "primitives without a material get glTF's default, a white rough "
                              "metal");
    }
    return l->metal;
}

static bool fill(gltf_loader *l, shape *s)
{
    const gltf_accessor *a = &l->m->accessors[find(&s->p->attributes, "POSITION")];
    if (!read_corners(l, s, a->count) || !number_vertices(l, s, a->count) ||
        !gltf_spend(l, s->vertex_count * (1 + (size_t) s->p->target_count), "mesh", s->mesh))
        return false;
    s->vertices = calloc(s->vertex_count + 1, sizeof *s->vertices);
    if (!s->vertices)
        return gltf_no_memory(l);
    read_positions(l, s);
    read_colors(l, s);
    if (!read_joints(l, s))
        return false;
    add_targets(l, s);
    return true;
}

// 1: a primitive came of it, 0: it is left out, -1: refused.
static int load_primitive(gltf_loader *l, shape *s)
{
    const gltf_primitive *p = s->p;
    int result = -1;
    if (p->mode < MODE_TRIANGLES) {
        l->lines_skipped++;
        return 0;
    }
    if (find(&p->attributes, "POSITION") < 0) {
        ag_builder_warn(l->b, "mesh %d primitive %d: it has no POSITION and is left out", s->mesh,
                        s->number);
        return 0;
    }
    if (!fill(l, s))
        goto done;
    char name[96];
    snprintf(name, sizeof name, "mesh %d '%.40s' primitive %d", s->mesh, l->m->meshes[s->mesh].name,
             s->number);
    ag_primitive_desc desc = {
        .name = name,
        .vertices = s->vertices,
        .vertex_count = s->vertex_count,
        .indices = s->corners,
        .index_count = s->corner_count,
        .material = material_of(l, p),
        .joints = (const uint16_t(*)[4]) s->joints,
        .weights = (const float(*)[4]) s->joint_weights,
    };
    result = 0;
    if (s->corner_count == 0)
        ag_builder_warn(l->b, "mesh %d primitive %d: it has no triangle", s->mesh, s->number);
    else
        result = ag_builder_primitive(l->b, &desc) < 0 ? -1 : 1;

done:
    free(s->corners);
    free(s->used);
    free(s->vertices);
    free(s->joints);
    free(s->joint_weights);
    return result;
}

int gltf_load_mesh(gltf_loader *l, int mesh, gltf_numbers weights, int *count)
{
    const gltf_mesh *m = &l->m->meshes[mesh];
    int first = (int) l->b->p->primitives.count;
    *count = 0;
    for (int i = 0; i < m->primitive_count; i++) {
        shape s = { .p = &m->primitives[i], .mesh = mesh, .number = i };
        s.weights = weights.count > 0 ? weights : m->weights;
        int made = load_primitive(l, &s);
        if (made < 0)
            return -1;
        *count += made;
    }
    return first;
}
