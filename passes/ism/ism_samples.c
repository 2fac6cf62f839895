// SPDX-License-Identifier: MIT
#include "ism_priv.h"

#include <assert.h>
#include <epoxy/gl.h>
#include <math.h>
#include <pass/math.h>
#include <pass/surface.h>
#include <stdlib.h>
#include <string.h>

static_assert(sizeof(ag_ism_sample) == 32, "std430 layout of ag_ism_sample");
static_assert(sizeof(ag_ism_point) == 32, "std430 layout of ag_ism_point");
static_assert(sizeof(ag_ism_eye) == 64, "std430 layout of ag_ism_eye");

enum { DEFAULT_COUNT = 65536 };

// ---- triangles ------------------------------------------------------------------------------

// The triangles of all instances in a row, by the area that lies before each.
typedef struct triangle_list {
    const ag_scene *scene;
    size_t *first;  // [instance_count + 1] triangles of the instances before
    double *before; // [count + 1] m^2
    size_t count;
} triangle_list;

static const ag_primitive *primitive_of(const ag_scene *scene, int instance)
{
    return &scene->primitives[scene->instances[instance].primitive];
}

static void corner_indices(const ag_primitive *p, const uint32_t *indices, size_t triangle,
                           uint32_t out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = p->first_vertex + indices[p->first_index + 3 * triangle + (size_t) k];
}

// World space at the scene's time.
static void corner_places(const ag_scene *scene, int instance, const uint32_t corners[3],
                          double out[3][3])
{
    for (int k = 0; k < 3; k++) {
        const float *v = scene->vertices[corners[k]].position;
        const double local[3] = { (double) v[0], (double) v[1], (double) v[2] };
        if (primitive_of(scene, instance)->skinned)
            memcpy(out[k], local, sizeof local);
        else
            ag_mat_point(scene->instances[instance].world, local, out[k]);
    }
}

static double triangle_area(const double p[3][3])
{
    double u[3], v[3], sum = 0;
    for (int k = 0; k < 3; k++) {
        u[k] = p[1][k] - p[0][k];
        v[k] = p[2][k] - p[0][k];
    }
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double c = u[i] * v[j] - u[j] * v[i];
        sum += c * c;
    }
    return isfinite(sum) ? 0.5 * sqrt(sum) : 0;
}

static void list_finish(triangle_list *list)
{
    free(list->first);
    free(list->before);
}

static fg_status list_init(triangle_list *list, const ag_scene *scene)
{
    const int instances = scene->instance_count;
    *list = (triangle_list){ .scene = scene };
    list->first = calloc((size_t) instances + 1, sizeof *list->first);
    if (!list->first)
        return FG_ERR_MEMORY;
    for (int i = 0; i < instances; i++)
        list->first[i + 1] = list->first[i] + primitive_of(scene, i)->index_count / 3;
    list->count = list->first[instances];
    list->before = calloc(list->count + 1, sizeof *list->before);
    if (!list->before) {
        list_finish(list);
        return FG_ERR_MEMORY;
    }
    double *before = list->before;
    for (int i = 0; i < instances; i++)
        for (size_t t = list->first[i]; t < list->first[i + 1]; t++, before++) {
            uint32_t corners[3];
            double places[3][3];
            corner_indices(primitive_of(scene, i), scene->indices, t - list->first[i], corners);
            corner_places(scene, i, corners, places);
            before[1] = before[0] + triangle_area((const double(*)[3]) places);
        }
    return FG_OK;
}

// The triangle within which `area` falls. All the area is more than `area`, so that one has some.
static size_t find_triangle(const triangle_list *list, double area)
{
    size_t low = 0, high = list->count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (list->before[middle] <= area)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static int find_instance(const triangle_list *list, size_t triangle)
{
    int low = 0, high = list->scene->instance_count;
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        if (list->first[middle] <= triangle)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// ---- places ---------------------------------------------------------------------------------

static double distance2(const double p[3][3], const double a[3], const double b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double d =
            p[0][k] * (a[0] - b[0]) + p[1][k] * (a[1] - b[1]) + p[2][k] * (a[2] - b[2]);
        sum += d * d;
    }
    return sum;
}

// Puts the longest edge between corners 0 and 1. Of equally long ones, but for rounding, the first,
// so that a scene of another size has its samples at the same places.
static void turn_to_longest(const double p[3][3], double c[3][3], int names[3])
{
    int longest = 0;
    double most = 0;
    for (int k = 0; k < 3; k++) {
        const double d = distance2(p, c[k], c[(k + 1) % 3]);
        if (d > most * (1 + 1e-9)) {
            most = d;
            longest = k;
        }
    }
    double turned[3][3];
    int turned_names[3];
    for (int k = 0; k < 3; k++) {
        memcpy(turned[k], c[(longest + k) % 3], sizeof turned[k]);
        turned_names[k] = names[(longest + k) % 3];
    }
    memcpy(c, turned, sizeof turned);
    memcpy(names, turned_names, sizeof turned_names);
}

// The point at `u` in [0, 1) of a curve that fills the triangle from its first corner to its
// second, equal parts of u over equal areas: halved across the longest edge again and again, each
// half is entered where the last was left, and the point is the middle of the last part. It moves
// with the square root of u, so `levels` are no more than it takes: rounding of u shall not be
// seen.
static void curve_point(const double p[3][3], double u, int levels, double out[3])
{
    enum { BEGIN = 1, END = 2 };
    double c[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    int names[3] = { BEGIN, END, 0 };
    for (int level = 0; level < levels; level++) {
        turn_to_longest(p, c, names);
        // The half of corner 0 comes first, unless the curve ends there or begins at the other.
        const bool zero_first = names[0] == BEGIN || names[1] == END;
        u *= 2;
        const bool second = u >= 1;
        u -= second ? 1 : 0;
        const int gone = (second == zero_first) ? 0 : 1; // the corner that the middle replaces
        for (int k = 0; k < 3; k++)
            c[gone][k] = 0.5 * (c[0][k] + c[1][k]);
        // Of the curve's ends one stays, the other is the middle.
        const int stays = second ? END : BEGIN;
        names[gone] = BEGIN + END - stays;
        for (int k = 0; k < 3; k++)
            if (k != gone && names[k] != stays)
                names[k] = 0;
    }
    for (int k = 0; k < 3; k++)
        out[k] = (c[0][k] + c[1][k] + c[2][k]) / 3;
}

static bool is_masked(const ag_scene *scene, const ag_primitive *p, const uint32_t corners[3],
                      const double weights[3])
{
    float uv[2][2] = { { 0 } }, color[4] = { 0 };
    for (int k = 0; k < 3; k++) {
        const ag_vertex *v = &scene->vertices[corners[k]];
        const float w = (float) weights[k];
        for (int i = 0; i < 4; i++) {
            uv[i / 2][i % 2] += w * v->uv[i / 2][i % 2];
            color[i] += w * v->color[i];
        }
    }
    return ag_surface_masked(scene, &scene->materials[p->material], (const float(*)[2]) uv, color);
}

// The sample where `area` m^2 of all lie before, one of `count`.
static void take_sample(const triangle_list *list, double area, int count, ag_ism_sample *out)
{
    const ag_scene *scene = list->scene;
    const size_t triangle = find_triangle(list, area);
    const int instance = find_instance(list, triangle);
    const ag_primitive *p = primitive_of(scene, instance);
    const double begin = list->before[triangle], own = list->before[triangle + 1] - begin;
    uint32_t corners[3];
    double places[3][3], weights[3];
    corner_indices(p, scene->indices, triangle - list->first[instance], corners);
    corner_places(scene, instance, corners, places);
    const double parts =
        4 * count * own / list->before[list->count]; // a quarter of a sample's each
    const int levels = parts > 4 ? ilogb(parts) + 1 : 2;
    curve_point((const double(*)[3]) places, fmin((area - begin) / own, 1 - 1e-12), levels,
                weights);
    for (int k = 0; k < 3; k++) {
        out->corners[k] = (int32_t) corners[k];
        out->weights[k] = (float) weights[k];
    }
    out->corners[3] = is_masked(scene, p, corners, weights) ? -1 : instance;
    out->weights[3] = (float) (list->before[list->count] / count / own);
}

static uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

static uint32_t mix_bits(uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

fg_status ag_ism_sample_scene(const fg_log *log, const ag_scene *scene, uint32_t seed, int count,
                              ag_ism_sample *out)
{
    triangle_list list;
    if (count < 1 || count > AG_ISM_MAX_SAMPLES || (count & (count - 1)) != 0) {
        fg_logf(log, FG_LOG_ERROR, "ism: %d samples, must be a power of two in [1, %d]", count,
                AG_ISM_MAX_SAMPLES);
        return FG_ERR_INVALID;
    }
    if (list_init(&list, scene) != FG_OK) {
        fg_logf(log, FG_LOG_ERROR, "ism: out of memory for the triangles of %s", scene->name);
        return FG_ERR_MEMORY;
    }
    const double all = list.before[list.count];
    const uint32_t shift = mix_bits(seed);
    for (int i = 0; i < count; i++) {
        // Radical inverse: of 2^k that follow each other one falls into each 2^k-th of the area,
        // all at one place of it, which the next 2^k move.
        const uint32_t bits = reverse_bits((uint32_t) i) ^ shift;
        out[i] = (ag_ism_sample){ .corners = { 0, 0, 0, -1 } };
        if (all > 0)
            take_sample(&list, all * ((bits + 0.5) / 4294967296.0), count, &out[i]);
    }
    list_finish(&list);
    return FG_OK;
}

// ---- on the GPU -----------------------------------------------------------------------------

static fg_status upload(ag_ism_samples *s, const ag_ism_samples_desc *desc)
{
    ag_ism_sample *samples = calloc((size_t) s->count, sizeof *samples);
    if (!samples)
        return FG_ERR_MEMORY;
    const fg_status status =
        ag_ism_sample_scene(desc->log, desc->scene, desc->seed, s->count, samples);
    if (status == FG_OK) {
        glCreateBuffers(1, &s->buffer);
        glNamedBufferStorage(s->buffer, (GLsizeiptr) s->count * (GLsizeiptr) sizeof *samples,
                             samples, 0);
    }
    free(samples);
    return status == FG_OK && glGetError() == GL_OUT_OF_MEMORY ? FG_ERR_MEMORY : status;
}

fg_status ag_ism_samples_create(const ag_ism_samples_desc *desc, ag_ism_samples **out)
{
    const uint64_t bytes = (uint64_t) desc->scene->vertex_count * sizeof(ag_vertex);
    GLint64 most = 0;
    *out = NULL;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    if (bytes > (uint64_t) most) {
        fg_logf(desc->log, FG_LOG_ERROR,
                "ism: %s has %.0f MiB of vertices, a storage block of the device holds %.0f",
                desc->scene->name, (double) bytes / 1048576, (double) most / 1048576);
        return FG_ERR_UNSUPPORTED;
    }
    ag_ism_samples *s = calloc(1, sizeof *s);
    if (!s) {
        fg_logf(desc->log, FG_LOG_ERROR, "ism: out of memory");
        return FG_ERR_MEMORY;
    }
    s->count = desc->count ? desc->count : DEFAULT_COUNT;
    // The count is checked before anything is allocated for it.
    const fg_status status = s->count > 0 && s->count <= AG_ISM_MAX_SAMPLES
                                 ? upload(s, desc)
                                 : ag_ism_sample_scene(desc->log, desc->scene, 0, s->count, NULL);
    if (status) {
        if (status == FG_ERR_MEMORY)
            fg_logf(desc->log, FG_LOG_ERROR, "ism: out of memory for %d samples", s->count);
        ag_ism_samples_destroy(s);
        return status;
    }
    *out = s;
    return FG_OK;
}

void ag_ism_samples_destroy(ag_ism_samples *s)
{
    if (!s)
        return;
    glDeleteBuffers(1, &s->buffer);
    free(s);
}
