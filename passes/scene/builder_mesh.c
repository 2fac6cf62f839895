// SPDX-License-Identifier: MIT
// A builder's primitives: checks, repairs, normals.
#include "scene_priv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct work {
    const ag_primitive_desc *desc;
    size_t corner_count; // of all triangles
    uint32_t *corners;   // vertices of the triangles that stay
    size_t kept;         // corners that stay
    uint32_t *renumber;  // old vertex to new, UINT32_MAX: unused
    size_t used;         // vertices that are used
    size_t repaired;
    bool flat;
} work;

static uint32_t corner(const ag_primitive_desc *d, size_t i)
{
    return d->indices ? d->indices[i] : (uint32_t) i;
}

static bool finite3(const float v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

// The normal of a triangle by winding, twice its area long; false if it has no area.
static bool face_normal(const float *a, const float *b, const float *c, double n[3])
{
    double e[3], f[3];
    for (int i = 0; i < 3; i++) {
        e[i] = (double) b[i] - (double) a[i];
        f[i] = (double) c[i] - (double) a[i];
    }
    n[0] = e[1] * f[2] - e[2] * f[1];
    n[1] = e[2] * f[0] - e[0] * f[2];
    n[2] = e[0] * f[1] - e[1] * f[0];
    return n[0] != 0 || n[1] != 0 || n[2] != 0;
}

// A float unit vector along `n`; false if there is none.
static bool unit(const double n[3], float out[3])
{
    double largest = fmax(fabs(n[0]), fmax(fabs(n[1]), fabs(n[2])));
    if (!(largest > 0) || !isfinite(largest))
        return false;
    double s[3] = { n[0] / largest, n[1] / largest, n[2] / largest };
    double length = sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    for (int i = 0; i < 3; i++)
        out[i] = (float) (s[i] / length);
    return true;
}

static bool has_normal(const ag_vertex *v)
{
    return finite3(v->normal) && (v->normal[0] != 0 || v->normal[1] != 0 || v->normal[2] != 0);
}

// ---- which triangles stay ---------------------------------------------------------

// 0, or -1 after a refusal; so the other functions here that return int.
static int check(ag_builder *b, const ag_primitive_desc *d, size_t corner_count)
{
    const char *name = d->name ? d->name : "";
    size_t number = b->p->primitives.count;
    if (!d->vertices || d->vertex_count == 0 || d->vertex_count > AG_MAX_SCENE_VERTICES ||
        corner_count > AG_MAX_SCENE_INDICES)
        return ag_builder_refuse(b, FG_ERR_INVALID,
                                 "primitive %zu '%s': %zu vertices and %zu indices; there must be "
                                 "some and at most %d and %d",
                                 number, name, d->vertex_count, corner_count, AG_MAX_SCENE_VERTICES,
                                 AG_MAX_SCENE_INDICES);
    if (corner_count % 3 != 0)
        return ag_builder_refuse(b, FG_ERR_INVALID,
                                 "primitive %zu '%s': %zu indices, must be a multiple of 3", number,
                                 name, corner_count);
    if (d->material < -1 || d->material >= (int) b->p->materials.count)
        return ag_builder_refuse(b, FG_ERR_INVALID,
                                 "primitive %zu '%s': material %d does not exist (materials: %zu)",
                                 number, name, d->material, b->p->materials.count);
    if (!d->joints != !d->weights)
        return ag_builder_refuse(b, FG_ERR_INVALID,
                                 "primitive %zu '%s': joints and weights must come together",
                                 number, name);
    for (size_t i = 0; d->indices && i < corner_count; i++)
        if (d->indices[i] >= d->vertex_count)
            return ag_builder_refuse(b, FG_ERR_INVALID,
                                     "primitive %zu '%s': index %zu is %u, there are %zu vertices",
                                     number, name, i, d->indices[i], d->vertex_count);
    return 0;
}

static void keep_triangles(ag_builder *b, work *w)
{
    const ag_primitive_desc *d = w->desc;
    size_t no_area = 0, not_finite = 0;
    for (size_t i = 0; i + 2 < w->corner_count; i += 3) {
        uint32_t v[3] = { corner(d, i), corner(d, i + 1), corner(d, i + 2) };
        const float *p[3];
        bool finite = true;
        for (int k = 0; k < 3; k++) {
            p[k] = d->vertices[v[k]].position;
            finite = finite && finite3(p[k]);
        }
        double n[3];
        bool area = finite && face_normal(p[0], p[1], p[2], n);
        not_finite += !finite;
        no_area += finite && !area;
        if (!area)
            continue;
        memcpy(w->corners + w->kept, v, sizeof v);
        w->kept += 3;
    }
    size_t number = b->p->primitives.count;
    if (no_area > 0)
        ag_builder_warn(b, "primitive %zu '%s': %zu triangles without area are dropped", number,
                        d->name ? d->name : "", no_area);
    if (not_finite > 0)
        ag_builder_warn(b, "primitive %zu '%s': %zu triangles with non-finite vertices are dropped",
                        number, d->name ? d->name : "", not_finite);
}

// Numbers the vertices that stay: each corner its own where normals are flat.
static void number_vertices(work *w)
{
    const ag_primitive_desc *d = w->desc;
    w->flat = true;
    for (size_t i = 0; i < w->kept && w->flat; i++)
        w->flat = !has_normal(&d->vertices[w->corners[i]]);
    if (w->flat) {
        w->used = w->kept;
        return;
    }
    memset(w->renumber, 0xff, d->vertex_count * sizeof *w->renumber);
    for (size_t i = 0; i < w->kept; i++)
        w->renumber[w->corners[i]] = 0;
    for (size_t i = 0; i < d->vertex_count; i++)
        if (w->renumber[i] == 0)
            w->renumber[i] = (uint32_t) w->used++;
}

// ---- vertices ---------------------------------------------------------------------

static size_t repair(float *v, int n, float otherwise)
{
    size_t repaired = 0;
    for (int i = 0; i < n; i++)
        if (!isfinite(v[i])) {
            v[i] = otherwise;
            repaired = 1;
        }
    return repaired;
}

static size_t copy_vertex(const ag_vertex *from, ag_vertex *to)
{
    *to = *from;
    memset(to->pad, 0, sizeof to->pad);
    size_t repaired = repair(to->uv[0], 2, 0) | repair(to->uv[1], 2, 0) | repair(to->color, 4, 1);
    for (int i = 0; i < 4; i++)
        if (to->color[i] < 0) {
            to->color[i] = 0;
            repaired = 1;
        }
    double n[3] = { (double) from->normal[0], (double) from->normal[1], (double) from->normal[2] };
    if (!unit(n, to->normal))
        memset(to->normal, 0, sizeof to->normal);
    return repaired;
}

static void copy_vertices(work *w, ag_vertex *vertices, uint32_t *indices)
{
    const ag_vertex *from = w->desc->vertices;
    for (size_t i = 0; i < w->kept; i++)
        indices[i] = w->flat ? (uint32_t) i : w->renumber[w->corners[i]];
    if (w->flat) {
        for (size_t i = 0; i < w->kept; i++)
            w->repaired += copy_vertex(&from[w->corners[i]], &vertices[i]);
        return;
    }
    for (size_t i = 0; i < w->desc->vertex_count; i++)
        if (w->renumber[i] != UINT32_MAX)
            w->repaired += copy_vertex(&from[i], &vertices[w->renumber[i]]);
}

static void flat_normals(ag_vertex *v, size_t count)
{
    for (size_t i = 0; i + 2 < count; i += 3) {
        double n[3];
        face_normal(v[i].position, v[i + 1].position, v[i + 2].position, n);
        unit(n, v[i].normal);
        memcpy(v[i + 1].normal, v[i].normal, sizeof v[i].normal);
        memcpy(v[i + 2].normal, v[i].normal, sizeof v[i].normal);
    }
}

// The mean by area of the faces around, at the vertices that lack a normal; one face's
// where they cancel. `sum` is zeroed scratch, one a vertex.
static void mean_normals(ag_vertex *v, const uint32_t *indices, size_t count, double (*sum)[3])
{
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < count; i++) {
            size_t t = i - i % 3;
            uint32_t at = indices[i];
            double n[3];
            if (has_normal(&v[at]))
                continue;
            face_normal(v[indices[t]].position, v[indices[t + 1]].position,
                        v[indices[t + 2]].position, n);
            if (pass == 1 && !unit(sum[at], v[at].normal))
                unit(n, v[at].normal);
            for (int k = 0; k < 3 && pass == 0; k++)
                sum[at][k] += n[k];
        }
    }
}

static bool fill_normals(ag_builder *b, work *w, ag_vertex *vertices, const uint32_t *indices)
{
    if (w->flat) {
        flat_normals(vertices, w->kept);
        return true;
    }
    size_t missing = 0;
    for (size_t i = 0; i < w->used; i++)
        missing += !has_normal(&vertices[i]);
    if (missing == 0)
        return true;
    double(*sum)[3] = calloc(w->used, sizeof *sum);
    if (!sum)
        return false;
    mean_normals(vertices, indices, w->kept, sum);
    free(sum);
    ag_builder_warn(b, "primitive %zu '%s': %zu of %zu normals have no length and are computed",
                    b->p->primitives.count, w->desc->name ? w->desc->name : "", missing, w->used);
    return true;
}

// ---- joints -----------------------------------------------------------------------

// False if a weight is negative or not finite.
static bool copy_influence(const work *w, uint32_t from, ag_influence *to, size_t *unweighted)
{
    const float *weight = w->desc->weights[from];
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        if (!isfinite(weight[i]) || weight[i] < 0)
            return false;
        sum += (double) weight[i];
    }
    for (int i = 0; i < 4; i++) {
        to->weight[i] = sum > 0 ? (float) ((double) weight[i] / sum) : (float) (i == 0);
        to->joint[i] = to->weight[i] > 0 ? w->desc->joints[from][i] : 0;
    }
    *unweighted += !(sum > 0);
    return true;
}

static int copy_influences(ag_builder *b, const work *w, ag_staged_skin *staged)
{
    const ag_primitive_desc *d = w->desc;
    if (!d->joints)
        return 0;
    const char *name = d->name ? d->name : "";
    size_t number = b->p->primitives.count, unweighted = 0;
    staged->first_influence = b->p->influences.count;
    staged->has_influences = true;
    ag_influence *to = ag_array_push(&b->p->influences, w->used, sizeof *to);
    if (!to)
        return ag_builder_refuse(b, FG_ERR_MEMORY, "primitives: out of memory");
    for (size_t i = 0; i < w->kept; i++) {
        size_t at = w->flat ? i : w->renumber[w->corners[i]];
        if (!copy_influence(w, w->corners[i], &to[at], &unweighted))
            return ag_builder_refuse(b, FG_ERR_INVALID,
                                     "primitive %zu '%s': a weight of vertex %u is negative or not "
                                     "finite",
                                     number, name, w->corners[i]);
        for (int k = 0; k < 4; k++)
            if (to[at].joint[k] > staged->highest_joint)
                staged->highest_joint = to[at].joint[k];
    }
    if (unweighted > 0)
        ag_builder_warn(b, "primitive %zu '%s': vertices without weights follow their first joint",
                        number, name);
    return 0;
}

// ---- the whole --------------------------------------------------------------------

static int append(ag_builder *b, work *w, ag_primitive *out, ag_staged_skin *staged)
{
    ag_scene_private *p = b->p;
    if (p->vertices.count + w->used > AG_MAX_SCENE_VERTICES ||
        p->indices.count + w->kept > AG_MAX_SCENE_INDICES)
        return ag_builder_refuse(b, FG_ERR_INVALID,
                                 "primitive %zu: more than %d vertices or %d indices in all",
                                 p->primitives.count, AG_MAX_SCENE_VERTICES, AG_MAX_SCENE_INDICES);
    out->first_vertex = (uint32_t) p->vertices.count;
    out->vertex_count = (uint32_t) w->used;
    out->first_index = (uint32_t) p->indices.count;
    out->index_count = (uint32_t) w->kept;
    ag_vertex *vertices = ag_array_push(&p->vertices, w->used, sizeof *vertices);
    uint32_t *indices = ag_array_push(&p->indices, w->kept, sizeof *indices);
    if (vertices && indices)
        copy_vertices(w, vertices, indices);
    if (!vertices || !indices || !fill_normals(b, w, vertices, indices))
        return ag_builder_refuse(b, FG_ERR_MEMORY, "primitives: out of memory");
    if (w->repaired > 0)
        ag_builder_warn(b, "primitive %zu '%s': bad UVs or colours of %zu vertices are repaired",
                        p->primitives.count, w->desc->name ? w->desc->name : "", w->repaired);
    return copy_influences(b, w, staged);
}

int ag_builder_primitive(ag_builder *b, const ag_primitive_desc *desc)
{
    if (!ag_builder_open(b))
        return -1;
    size_t corner_count = desc->indices ? desc->index_count : desc->vertex_count;
    if (check(b, desc, corner_count) != 0)
        return -1;
    ag_primitive primitive = { .material = desc->material };
    ag_staged_skin staged = { .skin = -2 };
    int result = -1;
    work w = { .desc = desc, .corner_count = corner_count };
    w.corners = malloc((corner_count + 1) * sizeof *w.corners);
    w.renumber = malloc(desc->vertex_count * sizeof *w.renumber);
    if (!w.corners || !w.renumber) {
        ag_builder_refuse(b, FG_ERR_MEMORY, "primitives: out of memory");
        goto done;
    }
    keep_triangles(b, &w);
    number_vertices(&w);
    if (append(b, &w, &primitive, &staged) != 0)
        goto done;
    ag_primitive_bounds(b->p, &primitive);
    ag_primitive *to = ag_builder_push(b, &b->p->primitives, sizeof *to, "primitives");
    ag_staged_skin *kept =
        to ? ag_builder_push(b, &b->p->staged, sizeof *kept, "primitives") : NULL;
    if (!kept)
        goto done;
    *to = primitive;
    *kept = staged;
    result = (int) b->p->primitives.count - 1;

done:
    free(w.corners);
    free(w.renumber);
    return result;
}
