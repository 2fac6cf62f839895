// SPDX-License-Identifier: MIT
#include "test_mesh.h"

#include <pass/surface.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

typedef struct edge {
    float from[3], to[3];
} edge;

static int compare_points(const float a[3], const float b[3])
{
    for (int i = 0; i < 3; ++i) {
        if (a[i] != b[i])
            return a[i] < b[i] ? -1 : 1;
    }
    return 0;
}

static int compare_edges(const void *a, const void *b)
{
    const edge *x = a, *y = b;
    const int from = compare_points(x->from, y->from);
    return from ? from : compare_points(x->to, y->to);
}

int mesh_open_edges(const mesh *m)
{
    edge *there = calloc(m->index_count, sizeof *there),
         *back = calloc(m->index_count, sizeof *back);
    int open = there && back ? 0 : -1;
    for (size_t i = 0; i < m->index_count && open == 0; ++i) {
        const size_t next = i % 3 == 2 ? i - 2 : i + 1;
        const float *from = m->vertices[m->indices[i]].position;
        const float *to = m->vertices[m->indices[next]].position;
        memcpy(there[i].from, from, sizeof there[i].from);
        memcpy(there[i].to, to, sizeof there[i].to);
        memcpy(back[i].from, to, sizeof back[i].from);
        memcpy(back[i].to, from, sizeof back[i].to);
    }
    if (open == 0) {
        qsort(there, m->index_count, sizeof *there, compare_edges);
        qsort(back, m->index_count, sizeof *back, compare_edges);
        // The two sorted lists are equal where every edge has its opposite.
        for (size_t i = 0; i < m->index_count; ++i)
            open += compare_edges(&there[i], &back[i]) != 0;
    }
    free(there);
    free(back);
    return open;
}

static void corner(const mesh *m, size_t index, double out[3])
{
    for (int k = 0; k < 3; ++k)
        out[k] = (double) m->vertices[m->indices[index]].position[k];
}

// Twice the area times the normal.
static void face_vector(const mesh *m, size_t first, double out[3])
{
    double p[3][3], a[3], b[3];
    for (size_t i = 0; i < 3; ++i)
        corner(m, first + i, p[i]);
    for (int k = 0; k < 3; ++k) {
        a[k] = p[1][k] - p[0][k];
        b[k] = p[2][k] - p[0][k];
    }
    cross(a, b, out);
}

// The least cosine between face `first` and its vertices' normals.
static double agreement(const mesh *m, size_t first)
{
    double face[3], least = 1.0;
    face_vector(m, first, face);
    const double length = sqrt(face[0] * face[0] + face[1] * face[1] + face[2] * face[2]);
    for (size_t i = 0; i < 3; ++i) {
        const float *n = m->vertices[m->indices[first + i]].normal;
        double dot = 0.0;
        for (int k = 0; k < 3; ++k)
            dot += face[k] * (double) n[k] / length;
        least = fmin(least, dot);
    }
    return least;
}

int mesh_faces_against_normals(const mesh *m)
{
    int against = 0;
    for (size_t i = 0; i < m->index_count; i += 3)
        against += !(agreement(m, i) > 0.0);
    return against;
}

double mesh_worst_agreement(const mesh *m)
{
    double worst = 1.0;
    for (size_t i = 0; i < m->index_count; i += 3)
        worst = fmin(worst, agreement(m, i));
    return worst;
}

double mesh_worst_normal(const mesh *m)
{
    double worst = 0.0;
    for (size_t i = 0; i < m->vertex_count; ++i) {
        const float *n = m->vertices[i].normal;
        const double x = (double) n[0], y = (double) n[1], z = (double) n[2];
        worst = fmax(worst, fabs(sqrt(x * x + y * y + z * z) - 1.0));
    }
    return worst;
}

double mesh_volume(const mesh *m)
{
    double sum = 0.0;
    for (size_t i = 0; i < m->index_count; i += 3) {
        double face[3], p[3];
        face_vector(m, i, face);
        corner(m, i, p);
        sum += (face[0] * p[0] + face[1] * p[1] + face[2] * p[2]) / 6.0;
    }
    return sum;
}

double mesh_area_from_below(const mesh *m)
{
    double sum = 0.0;
    for (size_t i = 0; i < m->index_count; i += 3) {
        double face[3];
        face_vector(m, i, face);
        sum += fmax(0.0, -0.5 * face[1]);
    }
    return sum;
}

void mesh_bounds(const mesh *m, float lo[3], float hi[3])
{
    for (int k = 0; k < 3; ++k) {
        lo[k] = INFINITY;
        hi[k] = -INFINITY;
        for (size_t i = 0; i < m->vertex_count; ++i) {
            lo[k] = fminf(lo[k], m->vertices[i].position[k]);
            hi[k] = fmaxf(hi[k], m->vertices[i].position[k]);
        }
    }
}

size_t scene_triangles(const ag_scene *s)
{
    size_t sum = 0;
    for (int i = 0; i < s->instance_count; ++i)
        sum += s->primitives[s->instances[i].primitive].index_count / 3;
    return sum;
}

static void transform(const double m[16], const float v[3], double out[3])
{
    for (int r = 0; r < 3; ++r)
        out[r] =
            m[r] * (double) v[0] + m[4 + r] * (double) v[1] + m[8 + r] * (double) v[2] + m[12 + r];
}

soup soup_of(const ag_scene *s)
{
    soup out = { .corners = calloc(scene_triangles(s) + 1, sizeof *out.corners) };
    for (int i = 0; i < s->instance_count && out.corners; ++i) {
        const ag_primitive *p = &s->primitives[s->instances[i].primitive];
        for (uint32_t k = 0; k < p->index_count; ++k) {
            const uint32_t index = p->first_vertex + s->indices[p->first_index + k];
            transform(s->instances[i].world, s->vertices[index].position,
                      out.corners[out.count + k / 3][k % 3]);
        }
        out.count += p->index_count / 3;
    }
    return out;
}

// Distance along the ray, or infinity. By the determinants of Cramer's rule.
static double meet(double p[3][3], const double from[3], const double direction[3])
{
    double e1[3], e2[3], to[3], h[3], q[3];
    for (int k = 0; k < 3; ++k) {
        e1[k] = p[1][k] - p[0][k];
        e2[k] = p[2][k] - p[0][k];
        to[k] = from[k] - p[0][k];
    }
    cross(direction, e2, h);
    const double det = dot(e1, h);
    if (fabs(det) < 1e-18)
        return (double) INFINITY;
    const double u = dot(to, h) / det;
    cross(to, e1, q);
    const double v = dot(direction, q) / det, t = dot(e2, q) / det;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 1e-6 ? t : (double) INFINITY;
}

double soup_nearest(const soup *s, const double from[3], const double direction[3], double limit)
{
    double best = limit;
    for (size_t i = 0; i < s->count; ++i)
        best = fmin(best, meet(s->corners[i], from, direction));
    return best;
}

bool scene_lit(const ag_scene *s, const soup *w, const double at[3], float least)
{
    for (int i = 0; i < s->light_count; ++i) {
        double distance;
        float e[3], to_light[3];
        ag_light_eval(&s->lights[i], at, e, to_light, &distance);
        const double towards[3] = { (double) to_light[0], (double) to_light[1],
                                    (double) to_light[2] };
        if (e[0] > least && soup_nearest(w, at, towards, distance) >= distance)
            return true;
    }
    return false;
}
