// SPDX-License-Identifier: MIT
#include "shapes.h"

#include <math.h>

static const float pi = 3.14159265f;

// A corner of the arcade's lower edge, with the normals of the soffit before and after it.
typedef struct edge_point {
    float x, y;
    float before[2], after[2];
} edge_point;

enum { ARC_MAX = 64 };

// The lower edge of one bay: impost, arch from left to right, impost. Returns the corners.
static int bay_edge(const shape_arcade_desc *d, float centre, edge_point out[ARC_MAX + 3])
{
    const int n = d->segments > ARC_MAX ? ARC_MAX : d->segments;
    const float half = 0.5f * d->bay;
    int count = 0;
    out[count++] = (edge_point){ centre - half, d->spring, { 0, -1 }, { 0, -1 } };
    for (int i = 0; i <= n; ++i) {
        const float angle = pi * (1.0f - (float) i / (float) n);
        const float c = i == 0 ? -1.0f : i == n ? 1.0f : cosf(angle);
        const float q = i == 0 || i == n ? 0.0f : sinf(angle);
        edge_point p = { centre + d->radius * c, d->spring + d->rise * q, { 0, -1 }, { 0, -1 } };
        // Into the opening, across the ellipse's tangent.
        const float normal[2] = { -d->rise * c, -d->radius * q };
        for (int k = 0; k < 2; ++k) {
            p.before[k] = i > 0 ? normal[k] : p.before[k];
            p.after[k] = i < n ? normal[k] : p.after[k];
        }
        out[count++] = p;
    }
    out[count++] = (edge_point){ centre + half, d->spring, { 0, -1 }, { 0, -1 } };
    return count;
}

// Two points joined into a quad across the wall's thickness.
static void across_wall(shape *s, const float a[2], const float b[2], const float normals[2][2],
                        float half, float u)
{
    const uint32_t first = (uint32_t) s->vertex_count;
    const float length = hypotf(b[0] - a[0], b[1] - a[1]);
    for (int i = 0; i < 4; ++i) {
        const float *at = i & 1 ? b : a, *n = normals[i & 1];
        const float z = i & 2 ? half : -half;
        const float p[3] = { at[0], at[1], z }, normal[3] = { n[0], n[1], 0.0f };
        shape_vertex(s, p, normal, u + (i & 1 ? length : 0.0f), z);
    }
    if (!s->failed)
        shape_lattice(s, first, 1, 1);
}

// The wall's face over one bay: a strip between the lower edge and the top.
static void bay_face(shape *s, const shape_arcade_desc *d, const edge_point *edge, int count,
                     float z)
{
    const uint32_t first = (uint32_t) s->vertex_count;
    const float normal[3] = { 0, 0, z };
    for (int row = 0; row < 2; ++row) {
        for (int i = 0; i < count; ++i) {
            const float p[3] = { edge[i].x, row ? d->top : edge[i].y, z };
            shape_vertex(s, p, normal, p[0], -p[1]);
        }
    }
    if (!s->failed)
        shape_lattice(s, first, count - 1, 1);
}

static void arcade_bay(shape *s, const shape_arcade_desc *d, float centre)
{
    edge_point edge[ARC_MAX + 3];
    const int count = bay_edge(d, centre, edge);
    const float half = 0.5f * d->thickness;
    float along = edge[0].x;
    bay_face(s, d, edge, count, -half);
    bay_face(s, d, edge, count, half);
    for (int i = 0; i + 1 < count && !s->failed; ++i) {
        const float a[2] = { edge[i].x, edge[i].y }, b[2] = { edge[i + 1].x, edge[i + 1].y };
        const float soffit[2][2] = { { edge[i].after[0], edge[i].after[1] },
                                     { edge[i + 1].before[0], edge[i + 1].before[1] } };
        across_wall(s, a, b, soffit, half, along);
        along += hypotf(b[0] - a[0], b[1] - a[1]);
        const float top_a[2] = { a[0], d->top }, top_b[2] = { b[0], d->top };
        const float up[2][2] = { { 0, 1 }, { 0, 1 } };
        across_wall(s, top_a, top_b, up, half, a[0]);
    }
}

void shape_arcade(shape *s, const shape_arcade_desc *desc)
{
    const float end = 0.5f * (float) desc->bays * desc->bay;
    for (int i = 0; i < desc->bays; ++i)
        arcade_bay(s, desc, ((float) i + 0.5f) * desc->bay - end);
    for (int i = 0; i < 2; ++i) {
        const float x = i ? end : -end;
        const float a[2] = { x, desc->spring }, b[2] = { x, desc->top };
        const float normals[2][2] = { { x, 0 }, { x, 0 } };
        across_wall(s, a, b, normals, 0.5f * desc->thickness, 0.0f);
    }
}

// One stone of the ring, between two radial cuts of directions (c, q).
static void ring_stone(shape *s, const shape_archivolt_desc *d, const float c[2], const float q[2],
                       float u)
{
    const float half = 0.5f * d->thickness;
    for (int k = 0; k < 2; ++k) { // soffit, then the back
        const float r = k ? d->outer : d->inner, out = k ? 1.0f : -1.0f;
        const float a[2] = { r * c[0], d->spring + r * q[0] };
        const float b[2] = { r * c[1], d->spring + r * q[1] };
        const float normals[2][2] = { { out * c[0], out * q[0] }, { out * c[1], out * q[1] } };
        across_wall(s, a, b, normals, half, r * u);
    }
    for (int k = 0; k < 2; ++k) { // the two faces
        const uint32_t first = (uint32_t) s->vertex_count;
        const float z = k ? half : -half, normal[3] = { 0, 0, z };
        for (int j = 0; j < 4; ++j) {
            const float r = j & 2 ? d->outer : d->inner;
            const float p[3] = { r * c[j & 1], d->spring + r * q[j & 1], z };
            shape_vertex(s, p, normal, p[0], -p[1]);
        }
        if (!s->failed)
            shape_lattice(s, first, 1, 1);
    }
}

void shape_archivolt(shape *s, const shape_archivolt_desc *desc)
{
    const int n = desc->segments;
    for (int i = 0; i < n && !s->failed; ++i) {
        const float from = pi * (float) i / (float) n, to = pi * (float) (i + 1) / (float) n;
        const float c[2] = { cosf(from), cosf(to) };
        const float q[2] = { i == 0 ? 0.0f : sinf(from), i + 1 == n ? 0.0f : sinf(to) };
        ring_stone(s, desc, c, q, from);
    }
    for (int k = 0; k < 2; ++k) { // its two feet
        const float x = k ? -1.0f : 1.0f, y = desc->spring;
        const float a[2] = { x * desc->inner, y }, b[2] = { x * desc->outer, y };
        const float down[2][2] = { { 0, -1 }, { 0, -1 } };
        across_wall(s, a, b, down, 0.5f * desc->thickness, 0.0f);
    }
}

// A side of the profile: from corner `a` to `b`, `v` metres along its outline.
typedef struct frame_edge {
    const float *a, *b;
    float v, length;
    float out, up; // normal
} frame_edge;

// One profile side along one of the rectangle's four.
static void frame_piece(shape *s, const shape_frame_desc *d, const frame_edge *e, int side)
{
    const bool along_z = side % 2;
    const float sign = side < 2 ? 1.0f : -1.0f;
    const float normal[3] = { along_z ? sign * e->out : 0.0f, e->up,
                              along_z ? 0.0f : sign * e->out };
    const uint32_t first = (uint32_t) s->vertex_count;
    for (int i = 0; i < 4; ++i) {
        const float *at = i & 2 ? e->b : e->a;
        const float end = (i & 1 ? 1.0f : -1.0f) * ((along_z ? d->half_z : d->half_x) + at[0]);
        const float away = sign * ((along_z ? d->half_x : d->half_z) + at[0]);
        const float p[3] = { along_z ? away : end, at[1], along_z ? end : away };
        shape_vertex(s, p, normal, end, i & 2 ? e->v - e->length : e->v);
    }
    if (!s->failed)
        shape_lattice(s, first, 1, 1);
}

void shape_frame(shape *s, const shape_frame_desc *desc)
{
    float area = 0.0f; // signed: which way round the profile runs
    for (int i = 0; i < desc->count; ++i) {
        const float *a = desc->profile[i], *b = desc->profile[(i + 1) % desc->count];
        area += a[0] * b[1] - b[0] * a[1];
    }
    float v = 0.0f;
    for (int i = 0; i < desc->count; ++i) {
        const float *a = desc->profile[i], *b = desc->profile[(i + 1) % desc->count];
        const float turn = area > 0.0f ? 1.0f : -1.0f;
        const frame_edge edge = {
            a, b, v, hypotf(b[0] - a[0], b[1] - a[1]), turn * (b[1] - a[1]), turn * (a[0] - b[0])
        };
        for (int side = 0; side < 4 && !s->failed; ++side)
            frame_piece(s, desc, &edge, side);
        v -= edge.length;
    }
}

// One of the four webs: the part of a barrel that is nearer to the bay's side than to its
// diagonals. Across the barrel in x, rulings along z; `quarter` turns it around.
static void vault_web(shape *s, const shape_vault_desc *d, int quarter)
{
    const bool swap = quarter % 2;
    const float sign = quarter < 2 ? 1.0f : -1.0f;
    const float a = swap ? d->half_z : d->half_x, b = swap ? d->half_x : d->half_z;
    const uint32_t first = (uint32_t) s->vertex_count;
    for (int row = 0; row < 2; ++row) {
        for (int i = 0; i <= d->segments; ++i) {
            const float angle = pi * ((float) i / (float) d->segments - 0.5f);
            const bool edge = i == 0 || i == d->segments;
            const float q = sinf(angle), c = edge ? 0.0f : cosf(angle);
            const float x = a * (edge ? (i ? 1.0f : -1.0f) : q);
            const float z = sign * b * (row || edge ? 1.0f : fabsf(q));
            const float y = d->spring + d->rise * c;
            const float p[3] = { swap ? z : x, y, swap ? x : z };
            const float n = -d->rise * q;
            const float normal[3] = { swap ? 0.0f : n, -a * c, swap ? n : 0.0f };
            shape_vertex(s, p, normal, a * angle, z);
        }
    }
    if (!s->failed)
        shape_lattice(s, first, d->segments, 1);
}

void shape_vault(shape *s, const shape_vault_desc *desc)
{
    for (int quarter = 0; quarter < 4; ++quarter)
        vault_web(s, desc, quarter);
}
