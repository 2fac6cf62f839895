// SPDX-License-Identifier: MIT
#include "reference_priv.h"

#include <pass/surface.h>

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

double vec_dot(const double a[3], const double b[3])
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
    const float side = vec_dot(p->face, direction) > 0 ? 1 : -1;
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

// What one light gives to the point when nothing stands between: irradiance, and where the light
// is. What lies behind the face or behind the shading normal is dark: the one is in the shadow of
// its own triangle, the other has no cosine.
static bool lit(const tracer *t, const point *p, const ag_light *light, double e[3],
                double to_light[3], double *distance)
{
    const double world[3] = { t->origin[0] + (double) p->position[0],
                              t->origin[1] + (double) p->position[1],
                              t->origin[2] + (double) p->position[2] };
    float across[3], towards[3];
    ag_light_eval(light, world, across, towards, distance);
    for (int k = 0; k < 3; ++k)
        to_light[k] = (double) towards[k];
    const double cosine = vec_dot(p->normal, to_light);
    for (int k = 0; k < 3; ++k)
        e[k] = (double) across[k] * cosine;
    return cosine > 0 && vec_dot(p->face, to_light) > 0 && largest(e) > 0;
}

// Weight of a point that was reached by density `own` where another way has density `other`:
// the balance heuristic (Veach and Guibas. Optimally Combining Sampling Techniques. 1995).
static double balance(double own, double other)
{
    return other > 0 ? 1 / (1 + other / own) : 1;
}

// Direct light of a point that a bounce reached with `density`, 1/m^2; infinite where light rays
// do not count.
static void reached_direct(const tracer *t, const point *p, double density, double out[3])
{
    for (int k = 0; k < 3; ++k)
        out[k] = p->emission[k];
    for (int i = 0; i < t->scene->light_count && largest(p->albedo) > 0; ++i) {
        const ag_light *light = t->scene->lights + i;
        double e[3], to_light[3], distance;
        if (!lit(t, p, light, e, to_light, &distance) || shadowed(t, p, light, to_light))
            continue;
        const double weight =
            balance(density, isinf(density) ? 0 : light_density(t, i, p, to_light, distance));
        for (int k = 0; k < 3; ++k)
            out[k] += p->albedo[k] / pi * e[k] * weight;
    }
}

void point_direct(const tracer *t, const point *p, double out[3])
{
    reached_direct(t, p, HUGE_VAL, out);
}

// ---- bounces ------------------------------------------------------------------------

void vec_around(const double axis[3], double cosine, double angle, double out[3])
{
    const double radius = sqrt(fmax(0, 1 - cosine * cosine));
    const double x = radius * cos(angle), y = radius * sin(angle);
    double a[3], b[3];
    // The coordinate axis that `axis` is farthest from, made perpendicular to it.
    int far = fabs(axis[0]) < fabs(axis[1]) ? 0 : 1;
    far = fabs(axis[2]) < fabs(axis[far]) ? 2 : far;
    for (int k = 0; k < 3; ++k)
        a[k] = (k == far) - axis[far] * axis[k];
    const double length = sqrt(vec_dot(a, a));
    for (int k = 0; k < 3; ++k)
        a[k] /= length;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        b[k] = axis[i] * a[j] - axis[j] * a[i];
    }
    for (int k = 0; k < 3; ++k)
        out[k] = x * a[k] + y * b[k] + cosine * axis[k];
}

// Of the point where a bounce from `p` along `direction` ends, per m^2: cos_i cos_j / (pi d^2).
static double bounce_density(const point *p, const double direction[3], const point *end,
                             double distance)
{
    return vec_dot(p->normal, direction) * fabs(vec_dot(end->face, direction)) /
           (pi * distance * distance);
}

// A path on its way: where it is and what a unit of radiance there is worth at its start.
typedef struct path {
    const tracer *tracer;
    hit_list *list;
    sampler sampler;
    uint32_t index;
    point at;
    double throughput[3];
    double sum[3];
} path;

// The numbers that a bounce draws, as pairs of the sampler: four a bounce from 1 on.
typedef enum draw {
    DRAW_TURN = 1, // direction of the bounce
    DRAW_CHOICE,   // survival; which of all hits goes on
    DRAW_PICK,     // which light
    DRAW_LIGHT,    // which of its rays
} draw;

static void draw_pair(const path *p, int bounce, draw what, double out[2])
{
    sampler_pair(p->sampler, p->index, 4 * ((uint32_t) bounce - 1) + (uint32_t) what, out);
}

// Light that a bounce along `direction` found at `end`.
static void gather(path *p, const double direction[3], const point *end, double distance)
{
    double direct[3];
    reached_direct(p->tracer, end, bounce_density(&p->at, direction, end, distance), direct);
    add_product(p->sum, p->throughput, direct);
}

// All hits of the ray, into the list; -1: out of memory.
static int find_all(const tracer *t, const ray *r, hit_list *list)
{
    int count = ag_rays_all(t->rays, r->from, r->direction, INFINITY, list->hits, list->capacity);
    if (count <= list->capacity)
        return count;
    ag_hit *grown = realloc(list->hits, (size_t) count * 2 * sizeof *grown);
    if (!grown)
        return -1;
    list->hits = grown;
    list->capacity = count * 2;
    return ag_rays_all(t->rays, r->from, r->direction, INFINITY, list->hits, list->capacity);
}

// Every surface along the ray, as if none hid another. A lit side that is turned away shows its
// other side here, which that light does not reach: it adds nothing. Of all, the one that `u`
// picks goes on and stands for the rest. Returns how many there are, -1: out of memory.
static int meet_all(path *p, const ray *r, const double direction[3], double u)
{
    const int count = find_all(p->tracer, r, p->list);
    for (int i = 0; i < count; ++i) {
        point end;
        point_of(p->tracer, p->list->hits + i, &end);
        gather(p, direction, &end, (double) p->list->hits[i].distance);
    }
    if (count > 0)
        point_of(p->tracer, p->list->hits + (int) (u * count), &p->at);
    for (int k = 0; k < 3; ++k)
        p->throughput[k] *= count;
    return count;
}

static int meet_nearest(path *p, const ray *r, const double direction[3])
{
    ag_hit hit;
    point end;
    if (!ag_rays_nearest(p->tracer->rays, r->from, r->direction, 0, INFINITY, &hit))
        return 0;
    point_of(p->tracer, &hit, &end);
    gather(p, direction, &end, (double) hit.distance);
    p->at = end;
    return 1;
}

// Whether something stands between two points. The ray ends short of the far one's surface by
// more than Embree's rounding.
static bool hidden(const tracer *t, const point *a, const point *b, const double direction[3])
{
    const double back[3] = { -direction[0], -direction[1], -direction[2] };
    float from[3], to[3], between[3];
    leave(a, direction, from);
    leave(b, back, to);
    for (int k = 0; k < 3; ++k)
        between[k] = to[k] - from[k];
    return ag_rays_blocked(t->rays, from, between, 0, 1 - 1e-4f);
}

// The other way to find the same light: a ray from a light, and the point where it ends joined
// to where the path is. Much less noise where light falls on little.
static void join_light(path *p, int bounce)
{
    const tracer *t = p->tracer;
    double pick[2], u[2], e[3], to_light[3], direction[3], distance, squared = 0;
    ray r;
    ag_hit hit;
    point end;
    draw_pair(p, bounce, DRAW_PICK, pick);
    draw_pair(p, bounce, DRAW_LIGHT, u);
    const int light = light_ray(t, pick[0], u, &r);
    if (light < 0 || !ag_rays_nearest(t->rays, r.from, r.direction, 0, INFINITY, &hit))
        return;
    point_of(t, &hit, &end);
    for (int k = 0; k < 3; ++k) {
        direction[k] = (double) end.position[k] - (double) p->at.position[k];
        squared += direction[k] * direction[k];
    }
    for (int k = 0; k < 3; ++k)
        direction[k] /= sqrt(squared);
    // The lit side must look at the path, which must look at it.
    if (!(squared > 0) || vec_dot(direction, end.face) >= 0 ||
        vec_dot(direction, p->at.normal) <= 0 ||
        (!t->unshadowed && vec_dot(direction, p->at.face) <= 0) ||
        !lit(t, &end, t->scene->lights + light, e, to_light, &distance) ||
        (!t->unshadowed && hidden(t, &p->at, &end, direction)))
        return;
    const double own = light_density(t, light, &end, to_light, distance);
    const double other = bounce_density(&p->at, direction, &end, sqrt(squared));
    for (int k = 0; k < 3 && own > 0; ++k)
        p->sum[k] += p->throughput[k] * end.albedo[k] / pi * e[k] / (1 + own / other);
}

// Whether a path of so much weight goes on after bounce 4; if so, for those that do not.
static bool survives(path *p, int bounce, double u)
{
    const double chance = fmin(1, largest(p->throughput));
    if (bounce <= 4)
        return true;
    if (!(u < chance))
        return false;
    for (int k = 0; k < 3; ++k)
        p->throughput[k] /= chance;
    return true;
}

// Returns how many surfaces the path met, -1: out of memory.
static int turn(path *p, int bounce, double choice)
{
    double u[2], direction[3];
    ray r;
    draw_pair(p, bounce, DRAW_TURN, u);
    // By the disc below the hemisphere: density cos / pi.
    vec_around(p->at.normal, sqrt(1 - u[0]), 2 * pi * u[1], direction);
    if (!p->tracer->unshadowed && vec_dot(direction, p->at.face) <= 0)
        return 0; // into its own surface
    leave(&p->at, direction, r.from);
    for (int k = 0; k < 3; ++k)
        r.direction[k] = (float) direction[k];
    return p->tracer->unshadowed ? meet_all(p, &r, direction, choice)
                                 : meet_nearest(p, &r, direction);
}

bool point_indirect(const tracer *t, const point *from, sampler s, uint32_t index, hit_list *list,
                    double out[3])
{
    int met = 1;
    path p = { .tracer = t, .list = list, .sampler = s, .index = index, .at = *from };
    for (int k = 0; k < 3; ++k)
        p.throughput[k] = from->albedo[k];
    for (int bounce = 1; bounce <= t->bounces && largest(p.throughput) > 0; ++bounce) {
        double choice[2] = { 0 };
        if (bounce > 4 || t->unshadowed)
            draw_pair(&p, bounce, DRAW_CHOICE, choice);
        if (!survives(&p, bounce, choice[0]))
            break;
        join_light(&p, bounce);
        met = turn(&p, bounce, choice[1]);
        if (met <= 0)
            break;
        for (int k = 0; k < 3; ++k)
            p.throughput[k] *= p.at.albedo[k];
    }
    for (int k = 0; k < 3; ++k)
        out[k] = p.sum[k];
    return met >= 0;
}
