// SPDX-License-Identifier: MIT
#include "reference_priv.h"

#include <pass/surface.h>

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double largest(const double a[3])
{
    return fmax(fmax(a[0], a[1]), a[2]);
}

static void add_product(double sum[3], const double a[3], const double b[3])
{
    for (int k = 0; k < 3; ++k)
        sum[k] += a[k] * b[k];
}

// ---- points -------------------------------------------------------------------------

void point_of(const tracer *t, const ag_hit *hit, point *out)
{
    const ag_scene *scene = t->scene;
    const ag_primitive *primitive = scene->primitives + scene->instances[hit->instance].primitive;
    const ag_material *material = scene->materials + primitive->material;
    const double side = hit->front ? 1 : -1;
    const bool emits = hit->front || material->double_sided;
    ag_surface surface;
    ag_surface_eval(scene, material, hit->uv, hit->color, &surface);
    for (int k = 0; k < 3; ++k) {
        out->position[k] = hit->position[k];
        out->face[k] = side * (double) hit->face_normal[k];
        out->normal[k] = side * (double) hit->normal[k];
        out->albedo[k] = (double) surface.albedo[k];
        out->emission[k] = emits ? (double) surface.emission[k] : 0;
    }
}

// A start of a ray that leaves the point towards `direction`.
static void leave(const point *p, const double direction[3], float from[3])
{
    const float side = dot(p->face, direction) > 0 ? 1 : -1;
    const float face[3] = { side * (float) p->face[0], side * (float) p->face[1],
                            side * (float) p->face[2] };
    ag_rays_offset(p->position, face, from);
}

// Whether something stands between the point and the light, which lies towards `to_light`.
static bool shadowed(const tracer *t, const point *p, const ag_light *light,
                     const double to_light[3])
{
    float from[3], direction[3], reach = INFINITY;
    leave(p, to_light, from);
    for (int k = 0; k < 3; ++k)
        direction[k] = (float) to_light[k];
    if (light->kind != AG_LIGHT_DIRECTIONAL) {
        // From the start itself, so that the ray's end is the light; short of what the light
        // may lie on.
        for (int k = 0; k < 3; ++k)
            direction[k] = (float) (light->position[k] - t->origin[k] - (double) from[k]);
        reach = 1 - 1e-5f;
    }
    return ag_rays_blocked(t->rays, from, direction, 0, reach);
}

// Irradiance of punctual lights. What lies behind the face or behind the shading normal is
// dark: the one is in the shadow of its own triangle, the other has no cosine.
static void irradiance(const tracer *t, const point *p, double out[3])
{
    const double world[3] = { t->origin[0] + (double) p->position[0],
                              t->origin[1] + (double) p->position[1],
                              t->origin[2] + (double) p->position[2] };
    out[0] = out[1] = out[2] = 0;
    for (int i = 0; i < t->scene->light_count; ++i) {
        const ag_light *light = t->scene->lights + i;
        float e[3], towards[3];
        double distance;
        ag_light_eval(light, world, e, towards, &distance);
        const double to_light[3] = { (double) towards[0], (double) towards[1],
                                     (double) towards[2] };
        const double cosine = dot(p->normal, to_light);
        if (cosine <= 0 || dot(p->face, to_light) <= 0 || !(e[0] > 0 || e[1] > 0 || e[2] > 0) ||
            shadowed(t, p, light, to_light))
            continue;
        for (int k = 0; k < 3; ++k)
            out[k] += (double) e[k] * cosine;
    }
}

void point_direct(const tracer *t, const point *p, double out[3])
{
    double e[3] = { 0 };
    if (largest(p->albedo) > 0)
        irradiance(t, p, e);
    for (int k = 0; k < 3; ++k)
        out[k] = p->emission[k] + p->albedo[k] / pi * e[k];
}

// ---- bounces ------------------------------------------------------------------------

// Density cos / pi around `normal`, by the disc below it.
static void cosine_direction(const double normal[3], const double u[2], double out[3])
{
    const double radius = sqrt(u[0]), height = sqrt(fmax(0, 1 - u[0])), angle = 2 * pi * u[1];
    const double x = radius * cos(angle), y = radius * sin(angle);
    double a[3] = { 0 }, b[3];
    // The axis that the normal is farthest from, made perpendicular to it.
    int axis = fabs(normal[0]) < fabs(normal[1]) ? 0 : 1;
    axis = fabs(normal[2]) < fabs(normal[axis]) ? 2 : axis;
    for (int k = 0; k < 3; ++k)
        a[k] = (k == axis) - normal[axis] * normal[k];
    const double length = sqrt(dot(a, a));
    for (int k = 0; k < 3; ++k)
        a[k] /= length;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        b[k] = normal[i] * a[j] - normal[j] * a[i];
    }
    for (int k = 0; k < 3; ++k)
        out[k] = x * a[k] + y * b[k] + height * normal[k];
}

typedef struct ray {
    float from[3], direction[3];
} ray;

// The nearest surface, and its direct light into `sum`. False: the path ends.
static bool meet_nearest(const tracer *t, const ray *r, const double throughput[3], point *at,
                         double sum[3])
{
    ag_hit hit;
    double direct[3];
    if (!ag_rays_nearest(t->rays, r->from, r->direction, 0, INFINITY, &hit))
        return false;
    point_of(t, &hit, at);
    point_direct(t, at, direct);
    add_product(sum, throughput, direct);
    return true;
}

// All hits of the ray, into `list`; -1: out of memory.
static int find_all(const tracer *t, const ray *r, hit_list *list)
{
    int count =
        ag_rays_all(t->rays, r->from, r->direction, 0, INFINITY, list->hits, list->capacity);
    if (count <= list->capacity)
        return count;
    ag_hit *grown = realloc(list->hits, (size_t) count * 2 * sizeof *grown);
    if (!grown)
        return -1;
    list->hits = grown;
    list->capacity = count * 2;
    return ag_rays_all(t->rays, r->from, r->direction, 0, INFINITY, list->hits, list->capacity);
}

// Every surface along the ray, as if none hid another. A lit side that is turned away shows its
// other side here, which that light does not reach: it adds nothing. Of all, the one that `u`
// picks goes on and stands for the rest.
static int meet_all(const tracer *t, const ray *r, hit_list *list, const double throughput[3],
                    double sum[3])
{
    const int count = find_all(t, r, list);
    for (int i = 0; i < count; ++i) {
        point at;
        double direct[3];
        point_of(t, list->hits + i, &at);
        point_direct(t, &at, direct);
        add_product(sum, throughput, direct);
    }
    return count;
}

// Whether a path of so much weight goes on after bounce 4; if so, for those that do not.
static bool survives(int bounce, double throughput[3], double u)
{
    const double chance = fmin(1, largest(throughput));
    if (bounce <= 4)
        return true;
    if (!(u < chance))
        return false;
    for (int k = 0; k < 3; ++k)
        throughput[k] /= chance;
    return true;
}

bool point_indirect(const tracer *t, const point *p, sampler s, uint32_t index, hit_list *list,
                    double out[3])
{
    point at = *p;
    double throughput[3] = { at.albedo[0], at.albedo[1], at.albedo[2] };
    out[0] = out[1] = out[2] = 0;
    for (int bounce = 1; bounce <= t->bounces && largest(throughput) > 0; ++bounce) {
        double turn[2], choice[2] = { 0 }, direction[3];
        ray r;
        sampler_pair(s, index, 2 * (uint32_t) bounce - 1, turn);
        if (bounce > 4 || t->unshadowed)
            sampler_pair(s, index, 2 * (uint32_t) bounce, choice);
        if (!survives(bounce, throughput, choice[0]))
            break;
        cosine_direction(at.normal, turn, direction);
        if (!t->unshadowed && dot(direction, at.face) <= 0)
            break; // into its own surface
        leave(&at, direction, r.from);
        for (int k = 0; k < 3; ++k)
            r.direction[k] = (float) direction[k];
        if (t->unshadowed) {
            const int count = meet_all(t, &r, list, throughput, out);
            if (count < 0)
                return false;
            if (count == 0)
                break;
            point_of(t, list->hits + (int) (choice[1] * count), &at);
            for (int k = 0; k < 3; ++k)
                throughput[k] *= count;
        } else if (!meet_nearest(t, &r, throughput, &at, out)) {
            break;
        }
        for (int k = 0; k < 3; ++k)
            throughput[k] *= at.albedo[k];
    }
    return true;
}
