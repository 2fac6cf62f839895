// SPDX-License-Identifier: MIT
#include "shapes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

float field_ball(const float p[3], const float centre[3], const float r[3])
{
    float in_radii = 0.0f, slope = 0.0f;
    for (int i = 0; i < 3; ++i) {
        const float x = (p[i] - centre[i]) / r[i];
        in_radii += x * x;
        slope += x * x / (r[i] * r[i]);
    }
    // The value over its gradient: exact to first order at the surface. In the very middle, far
    // inside.
    return slope > 0.0f ? (in_radii - sqrtf(in_radii)) / sqrtf(slope) : -r[0];
}

float field_bar(const float p[3], const float a[3], const float b[3], float ra, float rb)
{
    float along = 0.0f, length2 = 1e-12f, rest = 0.0f;
    for (int i = 0; i < 3; ++i) {
        along += (p[i] - a[i]) * (b[i] - a[i]);
        length2 += (b[i] - a[i]) * (b[i] - a[i]);
    }
    const float t = fminf(fmaxf(along / length2, 0.0f), 1.0f);
    for (int i = 0; i < 3; ++i) {
        const float d = p[i] - a[i] - t * (b[i] - a[i]);
        rest += d * d;
    }
    return sqrtf(rest) - ra - t * (rb - ra);
}

float field_join(float a, float b, float k)
{
    const float h = fmaxf(k - fabsf(a - b), 0.0f) / k;
    return fminf(a, b) - 0.25f * h * h * k;
}

// ---- surface nets ------------------------------------------------------------------------

enum { BLOCK = 4 }; // cells along an edge of what is skipped at once

typedef struct net {
    const shape_field_desc *d;
    int n[3];         // grid points
    float *value;     // [n0 * n1 * n2]
    uint32_t *vertex; // likewise, of the cell that begins there
} net;

static size_t slot(const net *w, const int i[3])
{
    return ((size_t) i[2] * (size_t) w->n[1] + (size_t) i[1]) * (size_t) w->n[0] + (size_t) i[0];
}

static float sample(const net *w, const float at[3])
{
    float p[3];
    for (int k = 0; k < 3; ++k)
        p[k] = w->d->lo[k] + at[k] * w->d->cell;
    const float value = w->d->field(w->d->user, p), least = 0.02f * w->d->cell;
    // Off the surface: cells that meet it in one point would give faces without area.
    return fabsf(value) >= least ? value : value < 0.0f ? -least : least;
}

// The points of one block: the value in its middle for all, where the surface cannot be near.
static void sample_block(const net *w, const int from[3])
{
    int to[3], i[3];
    float middle[3];
    for (int k = 0; k < 3; ++k) {
        to[k] = from[k] + BLOCK < w->n[k] ? from[k] + BLOCK : w->n[k];
        middle[k] = (float) from[k] + 0.5f * (BLOCK - 1);
    }
    const float whole = sample(w, middle);
    // Half the diagonal, and a cell more for the edges that lead out of the block.
    const float reach = (0.5f * BLOCK + 1.0f) * 1.7320508f * w->d->cell * w->d->steepest;
    const bool far = fabsf(whole) > reach;
    for (i[2] = from[2]; i[2] < to[2]; ++i[2])
        for (i[1] = from[1]; i[1] < to[1]; ++i[1])
            for (i[0] = from[0]; i[0] < to[0]; ++i[0]) {
                const float at[3] = { (float) i[0], (float) i[1], (float) i[2] };
                w->value[slot(w, i)] = far ? whole : sample(w, at);
            }
}

static void sample_all(const net *w)
{
    int from[3];
    for (from[2] = 0; from[2] < w->n[2]; from[2] += BLOCK)
        for (from[1] = 0; from[1] < w->n[1]; from[1] += BLOCK)
            for (from[0] = 0; from[0] < w->n[0]; from[0] += BLOCK)
                sample_block(w, from);
}

// Whether the corners of the cell at slot `s` are on both sides: of most cells they are not.
static bool is_crossed(const net *w, size_t s)
{
    const size_t row = (size_t) w->n[0], layer = row * (size_t) w->n[1];
    const size_t offsets[8] = {
        0, 1, row, row + 1, layer, layer + 1, layer + row, layer + row + 1
    };
    int inside = 0;
    for (int i = 0; i < 8; ++i)
        inside += w->value[s + offsets[i]] < 0.0f;
    return inside % 8 != 0;
}

// The mean of where the surface meets the cell's twelve edges, in cells from the grid's corner;
// false where it meets none.
static bool cell_middle(const net *w, const int cell[3], float out[3])
{
    int count = 0;
    float sum[3] = { 0, 0, 0 };
    if (!is_crossed(w, slot(w, cell)))
        return false;
    for (int e = 0; e < 12; ++e) {
        const int axis = e / 4, u = (axis + 1) % 3, v = (axis + 2) % 3;
        int a[3] = { cell[0], cell[1], cell[2] }, b[3];
        a[u] += e & 1;
        a[v] += e >> 1 & 1;
        memcpy(b, a, sizeof b);
        b[axis]++;
        const float fa = w->value[slot(w, a)], fb = w->value[slot(w, b)];
        if ((fa < 0.0f) == (fb < 0.0f))
            continue;
        for (int k = 0; k < 3; ++k)
            sum[k] += (float) a[k] + (k == axis ? fa / (fa - fb) : 0.0f);
        count++;
    }
    for (int k = 0; k < 3 && count; ++k)
        out[k] = sum[k] / (float) count;
    return count > 0;
}

static void add_vertices(const net *w, shape *s)
{
    static const float none[3]; // until shape_smooth(); triangles stay wound as they come
    int i[3];
    for (i[2] = 0; i[2] + 1 < w->n[2]; ++i[2])
        for (i[1] = 0; i[1] + 1 < w->n[1]; ++i[1])
            for (i[0] = 0; i[0] + 1 < w->n[0]; ++i[0]) {
                float p[3];
                if (!cell_middle(w, i, p))
                    continue;
                for (int k = 0; k < 3; ++k)
                    p[k] = w->d->lo[k] + p[k] * w->d->cell;
                w->vertex[slot(w, i)] = shape_vertex(s, p, none, p[0] + p[2], -p[1]);
            }
}

// Two triangles, wound as they come, the shorter diagonal between them.
static void add_quad(shape *s, const uint32_t q[4])
{
    float d[2] = { 0, 0 };
    for (int i = 0; i < 2 && !s->failed; ++i)
        for (int k = 0; k < 3; ++k) {
            const float x = s->vertices[q[i]].position[k] - s->vertices[q[i + 2]].position[k];
            d[i] += x * x;
        }
    const int o = d[0] <= d[1] ? 0 : 1;
    shape_triangle(s, q[o], q[o + 1], q[o + 2]);
    shape_triangle(s, q[o], q[o + 2], q[(o + 3) % 4]);
}

// The four cells around every edge that the surface crosses.
static void add_faces(const net *w, shape *s, int axis)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const size_t row = (size_t) w->n[0];
    const size_t step = axis == 0 ? 1 : axis == 1 ? row : row * (size_t) w->n[1];
    int i[3];
    for (i[2] = 1; i[2] + 1 < w->n[2]; ++i[2])
        for (i[1] = 1; i[1] + 1 < w->n[1]; ++i[1])
            for (i[0] = 1; i[0] + 1 < w->n[0]; ++i[0]) {
                const float *value = &w->value[slot(w, i)];
                const bool in = *value < 0.0f;
                if (in == (value[step] < 0.0f))
                    continue;
                uint32_t q[4];
                for (int k = 0; k < 4; ++k) {
                    int c[3] = { i[0], i[1], i[2] };
                    // Counter-clockwise seen from where the axis points to, if that is outside.
                    const int turn = in ? k : 3 - k;
                    c[u] -= turn == 0 || turn == 3;
                    c[v] -= turn < 2;
                    q[k] = w->vertex[slot(w, c)];
                }
                add_quad(s, q);
            }
}

void shape_field(shape *s, const shape_field_desc *desc)
{
    net w = { .d = desc };
    size_t points = 1;
    for (int k = 0; k < 3; ++k) {
        w.n[k] = (int) ceilf((desc->hi[k] - desc->lo[k]) / desc->cell) + 1;
        points *= (size_t) w.n[k];
    }
    const size_t first_vertex = s->vertex_count, first_index = s->index_count;
    w.value = malloc(points * sizeof *w.value);
    w.vertex = malloc(points * sizeof *w.vertex);
    s->failed = s->failed || !w.value || !w.vertex;
    if (!s->failed) {
        sample_all(&w);
        add_vertices(&w, s);
    }
    for (int axis = 0; axis < 3 && !s->failed; ++axis)
        add_faces(&w, s, axis);
    free(w.value);
    free(w.vertex);
    shape_smooth(s, first_vertex, first_index);
}

// ---- normals -------------------------------------------------------------------------------

static void face_normal(const shape *s, const uint32_t *t, float out[3])
{
    const float *p[3];
    float e[2][3];
    for (int i = 0; i < 3; ++i)
        p[i] = s->vertices[t[i]].position;
    for (int k = 0; k < 3; ++k) {
        e[0][k] = p[1][k] - p[0][k];
        e[1][k] = p[2][k] - p[0][k];
    }
    for (int k = 0; k < 3; ++k) {
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        out[k] = e[0][x] * e[1][y] - e[0][y] * e[1][x];
    }
}

static void set_length(float v[3], float to)
{
    const float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3 && length > 0.0f; ++k)
        v[k] *= to / length;
}

// Whether corner `i`'s normal is on the same side as its face, which is given.
static bool agrees(const shape *s, size_t i, size_t first_index, float face[3])
{
    const float *normal = s->vertices[s->indices[i]].normal;
    face_normal(s, s->indices + (i - (i - first_index) % 3), face);
    const float towards = face[0] * normal[0] + face[1] * normal[1] + face[2] * normal[2];
    const float area2 = face[0] * face[0] + face[1] * face[1] + face[2] * face[2];
    return towards > 0.0f && towards * towards > 4e-4f * area2;
}

// A vertex of its own, with the face's normal, for a corner that no mean does justice to.
static void part_corner(shape *s, size_t i, size_t first_index)
{
    float face[3];
    if (agrees(s, i, first_index, face))
        return;
    const ag_vertex old = s->vertices[s->indices[i]];
    const uint32_t own = shape_vertex(s, old.position, face, 0.0f, 0.0f);
    if (s->failed)
        return;
    memcpy(s->vertices[own].uv, old.uv, sizeof old.uv);
    s->indices[i] = own;
}

// Turns the normals that a face winds against towards it. Returns how many there were.
static size_t turn_normals(shape *s, size_t first_index)
{
    size_t turned = 0;
    for (size_t i = first_index; i < s->index_count; ++i) {
        float face[3], *normal = s->vertices[s->indices[i]].normal;
        if (agrees(s, i, first_index, face))
            continue;
        set_length(face, 1.0f);
        const float towards = face[0] * normal[0] + face[1] * normal[1] + face[2] * normal[2];
        for (int k = 0; k < 3; ++k)
            normal[k] += (0.05f - towards) * face[k];
        set_length(normal, 1.0f);
        ++turned;
    }
    return turned;
}

void shape_smooth(shape *s, size_t first_vertex, size_t first_index)
{
    if (s->failed)
        return;
    for (size_t v = first_vertex; v < s->vertex_count; ++v)
        memset(s->vertices[v].normal, 0, sizeof s->vertices[v].normal);
    for (size_t i = first_index; i < s->index_count; ++i) {
        float face[3];
        face_normal(s, s->indices + (i - (i - first_index) % 3), face);
        for (int k = 0; k < 3; ++k)
            s->vertices[s->indices[i]].normal[k] += face[k];
    }
    for (size_t v = first_vertex; v < s->vertex_count; ++v)
        set_length(s->vertices[v].normal, 1.0f);
    size_t wrong = 1;
    for (int round = 0; round < 8 && wrong; ++round)
        wrong = turn_normals(s, first_index);
    for (size_t i = first_index; i < s->index_count && wrong; ++i)
        part_corner(s, i, first_index);
}
