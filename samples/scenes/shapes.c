// SPDX-License-Identifier: MIT
#include "shapes.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const float pi = 3.14159265f;

// Neighbouring faces of a profile share a normal if they turn by less than this: cos 40 degrees.
static const float crease_cos = 0.766f;

static void sub(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = a[i] - b[i];
}

static void cross(const float a[3], const float b[3], float out[3])
{
    const float c[3] = { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0] };
    memcpy(out, c, sizeof c);
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static float distance(const float a[3], const float b[3])
{
    float d[3];
    sub(a, b, d);
    return sqrtf(dot(d, d));
}

static void normalize(float v[3])
{
    const float length = sqrtf(dot(v, v));
    for (int i = 0; i < 3 && length > 0.0f; ++i)
        v[i] /= length;
}

void shape_finish(shape *s)
{
    free(s->vertices);
    free(s->indices);
    memset(s, 0, sizeof *s);
}

// Room for `more` elements of `size` bytes. Sets `failed`.
static bool reserve(shape *s, void **array, size_t *capacity, size_t count, size_t size)
{
    if (s->failed)
        return false;
    if (count <= *capacity)
        return true;
    const size_t wanted = *capacity ? 2 * *capacity : 256;
    void *grown = realloc(*array, wanted * size);
    if (!grown) {
        s->failed = true;
        return false;
    }
    *array = grown;
    *capacity = wanted;
    return true;
}

uint32_t shape_vertex(shape *s, const float position[3], const float normal[3], float u, float v)
{
    if (!reserve(s, (void **) &s->vertices, &s->vertex_capacity, s->vertex_count + 1,
                 sizeof *s->vertices))
        return 0;
    const float tiling = s->tiling > 0.0f ? s->tiling : 1.0f;
    ag_vertex *out = &s->vertices[s->vertex_count];
    memset(out, 0, sizeof *out);
    memcpy(out->position, position, sizeof out->position);
    memcpy(out->normal, normal, sizeof out->normal);
    normalize(out->normal);
    out->uv[0][0] = u * tiling;
    out->uv[0][1] = v * tiling;
    for (int i = 0; i < 4; ++i)
        out->color[i] = 1.0f;
    return (uint32_t) s->vertex_count++;
}

void shape_triangle(shape *s, uint32_t a, uint32_t b, uint32_t c)
{
    if (!reserve(s, (void **) &s->indices, &s->index_capacity, s->index_count + 3,
                 sizeof *s->indices))
        return;
    const ag_vertex *v = s->vertices;
    float ab[3], ac[3], face[3];
    sub(v[b].position, v[a].position, ab);
    sub(v[c].position, v[a].position, ac);
    cross(ab, ac, face);
    if (dot(face, face) < 1e-16f) // twice the area, squared: below 0.5e-8 m^2 there is nothing
        return;
    const float side = dot(face, v[a].normal) + dot(face, v[b].normal) + dot(face, v[c].normal);
    const uint32_t triangle[3] = { a, side < 0.0f ? c : b, side < 0.0f ? b : c };
    memcpy(s->indices + s->index_count, triangle, sizeof triangle);
    s->index_count += 3;
}

void shape_lattice(shape *s, uint32_t first, int nu, int nv)
{
    for (int j = 0; j < nv && !s->failed; ++j) {
        for (int i = 0; i < nu && !s->failed; ++i) {
            const uint32_t a = first + (uint32_t) (j * (nu + 1) + i);
            const uint32_t b = a + (uint32_t) nu + 1;
            shape_triangle(s, a, a + 1, b + 1);
            shape_triangle(s, a, b + 1, b);
        }
    }
}

void shape_quad(shape *s, const float corners[4][3])
{
    float e1[3], e3[3], normal[3];
    sub(corners[1], corners[0], e1);
    sub(corners[3], corners[0], e3);
    cross(e1, e3, normal);
    const float u = distance(corners[1], corners[0]), v = distance(corners[3], corners[0]);
    const float uv[4][2] = { { 0, 0 }, { u, 0 }, { u, v }, { 0, v } };
    uint32_t index[4];
    for (int i = 0; i < 4; ++i)
        index[i] = shape_vertex(s, corners[i], normal, uv[i][0], uv[i][1]);
    if (s->failed)
        return;
    shape_triangle(s, index[0], index[1], index[2]);
    shape_triangle(s, index[0], index[2], index[3]);
}

void shape_box_face(shape *s, const float lo[3], const float hi[3], int face)
{
    // The axis the face looks along, then the face's own two: u horizontal where it can be.
    const int n = face / 2, a = n == 0 ? 2 : 0, b = n == 1 ? 2 : 1;
    float normal[3] = { 0, 0, 0 };
    normal[n] = face % 2 ? 1.0f : -1.0f;
    const uint32_t first = (uint32_t) s->vertex_count;
    for (int i = 0; i < 4; ++i) {
        float p[3];
        p[n] = face % 2 ? hi[n] : lo[n];
        p[a] = i & 1 ? hi[a] : lo[a];
        p[b] = i & 2 ? hi[b] : lo[b];
        shape_vertex(s, p, normal, p[a], -p[b]);
    }
    shape_lattice(s, first, 1, 1);
}

void shape_box(shape *s, const float lo[3], const float hi[3])
{
    for (int face = 0; face < 6; ++face)
        shape_box_face(s, lo, hi, face);
}

// The profile's outward normal (radial, up) on segment `i`; false where it has no length.
static bool segment_normal(const shape_lathe_desc *d, int i, float out[2])
{
    if (i < 0 || i + 1 >= d->count)
        return false;
    const float r = d->profile[i + 1][0] - d->profile[i][0];
    const float y = d->profile[i + 1][1] - d->profile[i][1];
    const float length = sqrtf(r * r + y * y);
    if (length <= 0.0f)
        return false;
    out[0] = y / length;
    out[1] = -r / length;
    return true;
}

// The normal of segment `i` at its end `end` (0 or 1), smoothed with the neighbour where the
// profile bends gently.
static void profile_normal(const shape_lathe_desc *d, int i, int end, float out[2])
{
    float other[2];
    if (!segment_normal(d, i, out) || !segment_normal(d, end ? i + 1 : i - 1, other))
        return;
    if (out[0] * other[0] + out[1] * other[1] < crease_cos)
        return;
    out[0] += other[0];
    out[1] += other[1];
}

// One ring of vertices of segment `i`.
static void lathe_ring(shape *s, const shape_lathe_desc *d, int i, int end, float v)
{
    const float radius = d->profile[i + end][0], y = d->profile[i + end][1];
    float n[2] = { 1.0f, 0.0f };
    profile_normal(d, i, end, n);
    const float widest = fmaxf(d->profile[i][0], d->profile[i + 1][0]);
    for (int k = 0; k <= d->segments; ++k) {
        const float turn = 2.0f * pi * (float) (k % d->segments) / (float) d->segments;
        const float angle = 2.0f * pi * (float) k / (float) d->segments;
        const float lobes = (float) d->lobes;
        // r = radius f(angle), f = 1 - depth (1 - cos(lobes angle)) / 2; the normal of that
        // surface is n_r f e_r - n_r f' e_t + n_y f^2 e_y.
        const float f = 1.0f - 0.5f * d->lobe_depth * (1.0f - cosf(lobes * turn));
        const float df = -0.5f * d->lobe_depth * lobes * sinf(lobes * turn);
        const float c = cosf(turn), q = sinf(turn);
        const float p[3] = { radius * f * c, y, radius * f * q };
        const float normal[3] = { n[0] * (f * c + df * q), n[1] * f * f, n[0] * (f * q - df * c) };
        shape_vertex(s, p, normal, angle * widest, v);
    }
}

void shape_lathe(shape *s, const shape_lathe_desc *desc)
{
    float v = 0.0f;
    assert(desc->segments >= 3);
    for (int i = 0; i + 1 < desc->count && !s->failed; ++i) {
        float unused[2];
        if (!segment_normal(desc, i, unused))
            continue;
        const uint32_t first = (uint32_t) s->vertex_count;
        lathe_ring(s, desc, i, 0, -v);
        v += hypotf(desc->profile[i + 1][0] - desc->profile[i][0],
                    desc->profile[i + 1][1] - desc->profile[i][1]);
        lathe_ring(s, desc, i, 1, -v);
        shape_lattice(s, first, desc->segments, 1);
    }
}

void shape_sphere(shape *s, const float centre[3], float radius, int segments)
{
    enum { RINGS_MAX = 64 };
    float profile[RINGS_MAX + 1][2];
    const int rings = segments / 2 < 2 ? 2 : segments / 2 > RINGS_MAX ? RINGS_MAX : segments / 2;
    for (int i = 0; i <= rings; ++i) {
        const float angle = pi * ((float) i / (float) rings - 0.5f);
        profile[i][0] = i == 0 || i == rings ? 0.0f : radius * cosf(angle);
        profile[i][1] = radius * sinf(angle);
    }
    const size_t first = s->vertex_count;
    const shape_lathe_desc lathe = { .profile = (const float(*)[2]) profile,
                                     .count = rings + 1,
                                     .segments = segments };
    shape_lathe(s, &lathe);
    shape_move(s, first, centre, 0.0f);
}

// Any unit vector across `direction`.
static void across(const float direction[3], float out[3])
{
    const float x[3] = { 1, 0, 0 }, y[3] = { 0, 1, 0 };
    cross(direction, fabsf(direction[1]) < 0.9f ? y : x, out);
    normalize(out);
}

// The tube's direction at point `i`: between the neighbours.
static void tube_direction(const shape_tube_desc *d, int i, float out[3])
{
    const int before = i > 0 ? i - 1 : 0, after = i + 1 < d->count ? i + 1 : i;
    sub(d->path[after], d->path[before], out);
    normalize(out);
}

static void tube_ring(shape *s, const shape_tube_desc *d, int i, const float side[3], float v)
{
    float direction[3], up[3];
    tube_direction(d, i, direction);
    cross(direction, side, up);
    for (int k = 0; k <= d->segments; ++k) {
        const float angle = 2.0f * pi * (float) (k % d->segments) / (float) d->segments;
        float normal[3], p[3];
        for (int j = 0; j < 3; ++j) {
            normal[j] = cosf(angle) * side[j] + sinf(angle) * up[j];
            p[j] = d->path[i][j] + d->radius * normal[j];
        }
        shape_vertex(s, p, normal, 2.0f * pi * d->radius * (float) k / (float) d->segments, v);
    }
}

// A flat end over the ring that starts at vertex `ring`.
static void tube_end(shape *s, const shape_tube_desc *d, uint32_t ring, int i)
{
    float normal[3];
    tube_direction(d, i, normal);
    for (int j = 0; j < 3 && i == 0; ++j)
        normal[j] = -normal[j];
    const uint32_t centre = shape_vertex(s, d->path[i], normal, 0.0f, 0.0f);
    for (int k = 0; k <= d->segments && !s->failed; ++k) {
        const ag_vertex rim = s->vertices[ring + (uint32_t) k];
        shape_vertex(s, rim.position, normal, d->radius, 0.0f);
        if (k > 0 && !s->failed)
            shape_triangle(s, centre, centre + (uint32_t) k, centre + (uint32_t) k + 1);
    }
}

void shape_tube(shape *s, const shape_tube_desc *desc)
{
    float side[3], direction[3], v = 0.0f;
    const uint32_t first = (uint32_t) s->vertex_count;
    tube_direction(desc, 0, direction);
    across(direction, side);
    for (int i = 0; i < desc->count; ++i) {
        // Carried along: the part of the last side that is across the new direction.
        tube_direction(desc, i, direction);
        const float along = dot(side, direction);
        for (int j = 0; j < 3; ++j)
            side[j] -= along * direction[j];
        normalize(side);
        v += i > 0 ? distance(desc->path[i], desc->path[i - 1]) : 0.0f;
        tube_ring(s, desc, i, side, v);
    }
    if (s->failed)
        return;
    shape_lattice(s, first, desc->segments, desc->count - 1);
    tube_end(s, desc, first, 0);
    const uint32_t ring = (uint32_t) (desc->segments + 1);
    tube_end(s, desc, first + ring * (uint32_t) (desc->count - 1), desc->count - 1);
}

void shape_sheet(shape *s, const shape_sheet_desc *desc)
{
    const uint32_t first = (uint32_t) s->vertex_count;
    const float h = 1e-3f; // of the unit square, for the derivatives
    for (int j = 0; j <= desc->nv; ++j) {
        for (int i = 0; i <= desc->nu; ++i) {
            const float u = (float) i / (float) desc->nu, v = (float) j / (float) desc->nv;
            float p[3], uv[2], unused[2], a[3], b[3], du[3], dv[3], normal[3];
            desc->point(desc->user, u, v, p, uv);
            desc->point(desc->user, u - h, v, a, unused);
            desc->point(desc->user, u + h, v, b, unused);
            sub(b, a, du);
            desc->point(desc->user, u, v - h, a, unused);
            desc->point(desc->user, u, v + h, b, unused);
            sub(b, a, dv);
            cross(du, dv, normal);
            shape_vertex(s, p, normal, uv[0], uv[1]);
        }
    }
    if (!s->failed)
        shape_lattice(s, first, desc->nu, desc->nv);
}

static void cloth_point(const void *user, float u, float v, float p[3], float uv[2])
{
    const shape_cloth_desc *d = user;
    // Gathered by a band at two thirds of the way down, smoothly.
    const float t = (v - 0.66f) / 0.3f;
    const float waist = 1.0f - d->gather / (1.0f + t * t);
    const float angle = 2.0f * pi * (float) d->folds * u + d->phase;
    const float depth = d->depth * (0.34f + 0.66f * v);
    p[0] = (u - 0.5f) * d->width * waist + 0.1f * depth * sinf(2.0f * angle);
    p[1] = -v * d->height;
    p[2] = depth * (sinf(angle) + 0.35f * sinf(0.43f * angle + 1.7f + 2.0f * v));
    uv[0] = u * d->width * 1.5f; // the folds take up cloth
    uv[1] = v * d->height;
}

void shape_cloth(shape *s, const shape_cloth_desc *desc)
{
    const shape_sheet_desc sheet = {
        .point = cloth_point, .user = desc, .nu = desc->nu, .nv = desc->nv
    };
    shape_sheet(s, &sheet);
}

void shape_move(shape *s, size_t first_vertex, const float offset[3], float yaw)
{
    const float c = cosf(yaw), q = sinf(yaw);
    for (size_t i = first_vertex; i < s->vertex_count; ++i) {
        float *vectors[2] = { s->vertices[i].position, s->vertices[i].normal };
        for (int k = 0; k < 2; ++k) {
            const float x = vectors[k][0], z = vectors[k][2];
            vectors[k][0] = c * x + q * z + (k == 0 ? offset[0] : 0.0f);
            vectors[k][1] += k == 0 ? offset[1] : 0.0f;
            vectors[k][2] = c * z - q * x + (k == 0 ? offset[2] : 0.0f);
        }
    }
}
