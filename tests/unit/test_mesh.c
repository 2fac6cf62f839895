// SPDX-License-Identifier: MIT
#include "test_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
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
