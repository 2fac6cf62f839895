// SPDX-License-Identifier: MIT
#include "paraboloid_priv.h"

#include <math.h>
#include <pass/math.h>
#include <stdlib.h>
#include <string.h>

static const ag_primitive *primitive_of(const ag_scene *scene, const ag_instance *instance)
{
    return &scene->primitives[instance->primitive];
}

static bool is_masked(const ag_scene *scene, const ag_instance *instance)
{
    const ag_primitive *p = primitive_of(scene, instance);
    return scene->materials[p->material].alpha == AG_ALPHA_MASK;
}

static void world_place(const ag_scene *scene, const ag_instance *instance, const ag_vertex *v,
                        double out[3])
{
    const double local[3] = { (double) v->position[0], (double) v->position[1],
                              (double) v->position[2] };
    if (primitive_of(scene, instance)->skinned)
        memcpy(out, local, sizeof local);
    else
        ag_mat_point(instance->world, local, out);
}

// The power of two that brings the box's diagonal to (1/2, 1].
static double unit_of(const double low[3], const double high[3])
{
    double sum = 0;
    int exponent = 0;
    for (int k = 0; k < 3; k++)
        sum += (high[k] - low[k]) * (high[k] - low[k]);
    if (sum > 0 && isfinite(sum))
        frexp(sqrt(sum), &exponent);
    return ldexp(1, -exponent);
}

static void grow_box(const ag_scene *scene, const ag_instance *instance, double low[3],
                     double high[3])
{
    const ag_primitive *p = primitive_of(scene, instance);
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        double at[3];
        world_place(scene, instance, &scene->vertices[p->first_vertex + v], at);
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
}

static void find_box(paraboloid_triangles *t, const ag_scene *scene)
{
    double low[3] = { HUGE_VAL, HUGE_VAL, HUGE_VAL }, high[3] = { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };
    for (int i = 0; i < scene->instance_count; i++)
        if (!scene->instances[i].moving)
            grow_box(scene, &scene->instances[i], low, high);
    for (int k = 0; k < 3; k++) {
        if (!(low[k] <= high[k]))
            low[k] = high[k] = 0;
        t->centre[k] = 0.5 * (low[k] + high[k]);
    }
    t->unit = unit_of(low, high);
}

// ---- MASK ---------------------------------------------------------------------------------------

static size_t texels_of(const ag_texture *texture)
{
    return (size_t) texture->width * (size_t) texture->height;
}

// Marks in `used` the textures whose alpha is asked for, and sums their texels up.
static void find_textures(paraboloid_triangles *t, const ag_scene *scene, int *used)
{
    for (int i = 0; i < scene->texture_count; i++)
        used[i] = -1;
    for (int i = 0; i < scene->instance_count; i++) {
        const ag_instance *instance = &scene->instances[i];
        const ag_primitive *p = primitive_of(scene, instance);
        const int texture = scene->materials[p->material].base_color_tex.texture;
        if (instance->moving || !is_masked(scene, instance) || texture < 0 || used[texture] >= 0)
            continue;
        used[texture] = t->texture_count++;
        t->alpha_count += texels_of(&scene->textures[texture]);
    }
}

static fg_status copy_alphas(paraboloid_triangles *t, const fg_log *log, const ag_scene *scene,
                             int *used)
{
    find_textures(t, scene, used);
    if (t->alpha_count > INT32_MAX) {
        fg_logf(log, FG_LOG_ERROR, "paraboloid: %s has %zu texels in textures of MASK, at most %d",
                scene->name, t->alpha_count, INT32_MAX);
        return FG_ERR_UNSUPPORTED;
    }
    t->textures = calloc((size_t) t->texture_count + 1, sizeof *t->textures);
    t->alphas = calloc(t->alpha_count + 4, 1);
    if (!t->textures || !t->alphas)
        return FG_ERR_MEMORY;
    for (int i = 0, first = 0, next = 0; next < t->texture_count && i < scene->texture_count; i++) {
        const ag_texture *texture = &scene->textures[i];
        if (used[i] < 0)
            continue;
        const int32_t row[4] = { first, texture->width, texture->height,
                                 (int32_t) texture->wrap_u | (int32_t) texture->wrap_v << 2 |
                                     (texture->nearest ? 16 : 0) };
        memcpy(t->textures[used[i]], row, sizeof row);
        for (size_t k = 0; k < texels_of(texture); k++)
            t->alphas[(size_t) first + k] = texture->rgba[4 * k + 3];
        first += (int) texels_of(texture);
        next++;
    }
    return FG_OK;
}

static void fill_corner(const ag_scene *scene, const ag_material *m, const ag_vertex *v,
                        shadow_corner *out)
{
    const ag_texture_ref *ref = &m->base_color_tex;
    const float *f = ref->transform, *in = v->uv[ref->uv];
    *out = (shadow_corner){ { 0, 0, m->base_color[3] * v->color[3], 0 } };
    if (ref->texture >= 0 && ref->texture < scene->texture_count) {
        out->uv[0] = f[0] * in[0] + f[1] * in[1] + f[2];
        out->uv[1] = f[3] * in[0] + f[4] * in[1] + f[5];
    }
}

// ---- triangles ----------------------------------------------------------------------------------

static bool has_area(const shadow_triangle *t)
{
    double u[3], v[3], sum = 0;
    for (int k = 0; k < 3; k++) {
        u[k] = (double) t->b[k] - (double) t->a[k];
        v[k] = (double) t->c[k] - (double) t->a[k];
    }
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double n = u[i] * v[j] - u[j] * v[i];
        sum += n * n;
    }
    return sum > 0 && isfinite(sum);
}

static void add_triangle(paraboloid_triangles *t, const ag_scene *scene,
                         const ag_instance *instance, const uint32_t *indices, const int *used)
{
    const ag_primitive *p = primitive_of(scene, instance);
    const ag_material *material = &scene->materials[p->material];
    const bool masked = material->alpha == AG_ALPHA_MASK,
               turned = instance->mirrored && !p->skinned;
    shadow_triangle made = { 0 };
    shadow_corner corners[3];
    float *const to[3] = { made.a, made.b, made.c };
    for (int k = 0; k < 3; k++) {
        const uint32_t index = indices[turned && k > 0 ? 3 - k : k];
        const ag_vertex *v = &scene->vertices[p->first_vertex + index];
        double at[3];
        world_place(scene, instance, v, at);
        for (int i = 0; i < 3; i++)
            to[k][i] = (float) ((at[i] - t->centre[i]) * t->unit);
        fill_corner(scene, material, v, &corners[k]);
    }
    if (!has_area(&made))
        return;
    if (masked) {
        const int texture = material->base_color_tex.texture;
        corners[0].uv[3] = texture >= 0 ? (float) used[texture] : -1;
        corners[1].uv[3] = material->alpha_cutoff;
        memcpy(t->corners + 3 * (size_t) (t->count - t->opaque), corners, sizeof corners);
    }
    t->triangles[t->count++] = made;
}

static void add_all(paraboloid_triangles *t, const ag_scene *scene, bool masked, const int *used)
{
    for (int i = 0; i < scene->instance_count; i++) {
        const ag_instance *instance = &scene->instances[i];
        const ag_primitive *p = primitive_of(scene, instance);
        if (instance->moving || is_masked(scene, instance) != masked)
            continue;
        for (uint32_t k = 0; k + 2 < p->index_count; k += 3)
            add_triangle(t, scene, instance, scene->indices + p->first_index + k, used);
    }
}

// How many there may be, and of these how many with MASK.
static size_t count_all(const ag_scene *scene, size_t *masked)
{
    size_t all = 0;
    *masked = 0;
    for (int i = 0; i < scene->instance_count; i++) {
        const ag_instance *instance = &scene->instances[i];
        const size_t own = instance->moving ? 0 : primitive_of(scene, instance)->index_count / 3;
        all += own;
        *masked += is_masked(scene, instance) ? own : 0;
    }
    return all;
}

fg_status paraboloid_triangles_init(paraboloid_triangles *t, const fg_log *log,
                                    const ag_scene *scene)
{
    size_t masked;
    const size_t all = count_all(scene, &masked);
    *t = (paraboloid_triangles){ 0 };
    if (all > INT32_MAX) {
        fg_logf(log, FG_LOG_ERROR, "paraboloid: %s has %zu triangles, at most %d", scene->name, all,
                INT32_MAX);
        return FG_ERR_UNSUPPORTED;
    }
    find_box(t, scene);
    t->triangles = calloc(all + 1, sizeof *t->triangles);
    t->corners = calloc(3 * masked + 1, sizeof *t->corners);
    int *used = calloc((size_t) scene->texture_count + 1, sizeof *used);
    fg_status status =
        t->triangles && t->corners && used ? copy_alphas(t, log, scene, used) : FG_ERR_MEMORY;
    if (status == FG_OK) {
        add_all(t, scene, false, used);
        t->opaque = t->count;
        add_all(t, scene, true, used);
    }
    free(used);
    return status;
}

void paraboloid_triangles_finish(paraboloid_triangles *t)
{
    free(t->triangles);
    free(t->corners);
    free(t->textures);
    free(t->alphas);
}
