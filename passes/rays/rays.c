// SPDX-License-Identifier: MIT
#include <pass/math.h>
#include <pass/rays.h>
#include <pass/surface.h>

#if AG_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// An instance as Embree sees it: triangles in the space of the casts. Buffers are Embree's.
typedef struct target {
    const ag_scene *scene;
    const ag_instance *instance;
    const ag_primitive *primitive;
    const ag_material *material;
    const float *positions;  // [3 * vertex_count]
    const uint32_t *indices; // [index_count]
    double normals[9];       // object to world
} target;

struct ag_rays {
    const fg_log *log;
    RTCDevice device;
    RTCScene scene;
    target *targets;  // by instance
    fg_status status; // of the first Embree error
};

#if RTC_VERSION_MAJOR >= 4
typedef struct RTCRayQueryContext embree_context;
#else
typedef struct RTCIntersectContext embree_context;
#endif

// What the filter finds behind Embree's context.
typedef struct query {
    embree_context context; // first: Embree hands its address around
    bool all;               // note every hit and go on
    ag_hit *hits;
    int max, count;
} query;

// ---- geometry of a hit --------------------------------------------------------------

typedef struct triangle {
    uint32_t index[3];
    double corner[3][3];
    double cross[3]; // twice the area long, by winding
} triangle;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static triangle fetch(const target *t, uint32_t number)
{
    triangle out;
    double e[2][3];
    for (int i = 0; i < 3; ++i) {
        out.index[i] = t->indices[3 * number + (uint32_t) i];
        for (int k = 0; k < 3; ++k)
            out.corner[i][k] = (double) t->positions[3 * out.index[i] + (uint32_t) k];
    }
    for (int k = 0; k < 3; ++k) {
        e[0][k] = out.corner[1][k] - out.corner[0][k];
        e[1][k] = out.corner[2][k] - out.corner[0][k];
    }
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        out.cross[k] = e[0][i] * e[1][j] - e[0][j] * e[1][i];
    }
    return out;
}

static void interpolate_attributes(const target *t, const triangle *tri, const double weight[3],
                                   ag_hit *hit)
{
    double normal[3] = { 0 };
    memset(hit->uv, 0, sizeof hit->uv);
    memset(hit->color, 0, sizeof hit->color);
    for (int i = 0; i < 3; ++i) {
        const ag_vertex *v =
            t->scene->vertices + t->primitive->first_vertex + (size_t) tri->index[i];
        for (int k = 0; k < 3; ++k)
            normal[k] += weight[i] * (t->normals[k] * (double) v->normal[0] +
                                      t->normals[3 + k] * (double) v->normal[1] +
                                      t->normals[6 + k] * (double) v->normal[2]);
        for (int k = 0; k < 4; ++k) {
            hit->uv[k / 2][k % 2] += (float) weight[i] * v->uv[k / 2][k % 2];
            hit->color[k] += (float) weight[i] * v->color[k];
        }
    }
    const double length = sqrt(dot(normal, normal));
    for (int k = 0; k < 3; ++k)
        hit->normal[k] = length > 0 ? (float) (normal[k] / length) : hit->face_normal[k];
}

// From distance, instance, triangle and barycentrics, the rest.
static void complete(const ag_rays *rays, const float direction[3], ag_hit *hit)
{
    const target *t = rays->targets + hit->instance;
    const triangle tri = fetch(t, hit->triangle);
    const double u = (double) hit->barycentric[0], v = (double) hit->barycentric[1];
    const double weight[3] = { 1 - u - v, u, v };
    const double side = t->instance->mirrored ? -1 : 1;
    const double length = sqrt(dot(tri.cross, tri.cross));
    double facing = 0;
    for (int k = 0; k < 3; ++k) {
        hit->position[k] = (float) (weight[0] * tri.corner[0][k] + weight[1] * tri.corner[1][k] +
                                    weight[2] * tri.corner[2][k]);
        hit->face_normal[k] = (float) (side * tri.cross[k] / length);
        facing += side * tri.cross[k] * (double) direction[k];
    }
    hit->front = facing < 0;
    interpolate_attributes(t, &tri, weight, hit);
}

// ---- what Embree asks ---------------------------------------------------------------

// Embree's distance carries the rounding of the whole triangle. This one, in double, tells on
// which side of the plane a ray starts that left it by a few units in the last place.
static bool lies_ahead(const target *t, const struct RTCRay *ray, uint32_t number)
{
    const triangle tri = fetch(t, number);
    const double to[3] = { tri.corner[0][0] - (double) ray->org_x,
                           tri.corner[0][1] - (double) ray->org_y,
                           tri.corner[0][2] - (double) ray->org_z };
    const double direction[3] = { (double) ray->dir_x, (double) ray->dir_y, (double) ray->dir_z };
    return dot(to, tri.cross) / dot(direction, tri.cross) > (double) ray->tnear;
}

static bool masked(const target *t, const struct RTCHit *at)
{
    if (t->material->alpha != AG_ALPHA_MASK)
        return false;
    ag_hit hit = { 0 };
    const ag_hit *seen = &hit;
    const triangle tri = fetch(t, at->primID);
    const double u = (double) at->u, v = (double) at->v;
    const double weight[3] = { 1 - u - v, u, v };
    interpolate_attributes(t, &tri, weight, &hit);
    return ag_surface_masked(t->scene, t->material, seen->uv, seen->color);
}

// Keeps the `max` nearest, in order. Equal distances stand in the order of instance and
// triangle, whatever order Embree finds them in.
static void note_hit(query *q, const ag_hit *hit)
{
    int at = q->count < q->max ? q->count : q->max;
    ++q->count;
    for (; at > 0; --at) {
        const ag_hit *before = q->hits + at - 1;
        if (before->distance < hit->distance ||
            (before->distance == hit->distance &&
             (before->instance < hit->instance ||
              (before->instance == hit->instance && before->triangle < hit->triangle))))
            break;
        if (at < q->max)
            q->hits[at] = *before;
    }
    if (at < q->max)
        q->hits[at] = *hit;
}

// Whether a ray passes through what it has met; notes the hit where all are wanted.
static bool lets_pass(query *q, const target *t, const struct RTCRay *ray, const struct RTCHit *hit)
{
    if (!lies_ahead(t, ray, hit->primID) || masked(t, hit))
        return true;
    if (!q->all)
        return false;
    const ag_hit found = { .distance = ray->tfar,
                           .instance = (int) (t->instance - t->scene->instances),
                           .triangle = hit->primID,
                           .barycentric = { hit->u, hit->v } };
    note_hit(q, &found);
    return true;
}

// The `i`th of N rays or hits, which lie member by member. Embree's own accessors are C++.
static void pick(const void *of_n, unsigned n, unsigned i, void *out, size_t size)
{
    for (size_t at = 0; at < size; at += sizeof(float))
        memcpy((char *) out + at, (const char *) of_n + at * n + i * sizeof(float), sizeof(float));
}

// A stream of rays comes in packets, of which not all are active.
static void filter(const struct RTCFilterFunctionNArguments *args)
{
    for (unsigned i = 0; i < args->N; ++i) {
        struct RTCRay ray;
        struct RTCHit hit;
        if (args->valid[i] != -1)
            continue;
        pick(args->ray, args->N, i, &ray, offsetof(struct RTCRay, flags));
        pick(args->hit, args->N, i, &hit, offsetof(struct RTCHit, instID));
        if (lets_pass((query *) args->context, args->geometryUserPtr, &ray, &hit))
            args->valid[i] = 0;
    }
}

// ---- building -----------------------------------------------------------------------

static void on_error(void *user, enum RTCError code, const char *msg)
{
    ag_rays *rays = user;
    if (rays->status != FG_OK)
        return;
    rays->status = code == RTC_ERROR_OUT_OF_MEMORY ? FG_ERR_MEMORY : FG_ERR_UNSUPPORTED;
    fg_logf(rays->log, FG_LOG_ERROR, "rays: Embree: %s (error %d)", msg ? msg : "failed",
            (int) code);
}

static void fill(const ag_rays_desc *desc, target *t, float *positions, uint32_t *indices)
{
    const ag_scene *scene = desc->scene;
    for (size_t i = 0; i < t->primitive->vertex_count; ++i) {
        const ag_vertex *v = scene->vertices + t->primitive->first_vertex + i;
        const double local[3] = { (double) v->position[0], (double) v->position[1],
                                  (double) v->position[2] };
        double world[3];
        ag_mat_point(t->instance->world, local, world);
        for (int k = 0; k < 3; ++k)
            positions[3 * i + (size_t) k] = (float) (world[k] - desc->origin[k]);
    }
    memcpy(indices, scene->indices + t->primitive->first_index,
           t->primitive->index_count * sizeof *indices);
    ag_mat_normal(t->instance->world, t->normals);
    t->positions = positions;
    t->indices = indices;
}

static bool add_target(ag_rays *rays, const ag_rays_desc *desc, int number)
{
    target *t = rays->targets + number;
    t->scene = desc->scene;
    t->instance = desc->scene->instances + number;
    t->primitive = desc->scene->primitives + t->instance->primitive;
    t->material = desc->scene->materials + t->primitive->material;
    if (t->primitive->index_count == 0 || (desc->static_only && t->instance->moving))
        return true;
    RTCGeometry geometry = rtcNewGeometry(rays->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!geometry)
        return false;
    float *positions =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), t->primitive->vertex_count);
    uint32_t *indices =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(uint32_t), t->primitive->index_count / 3);
    if (positions && indices) {
        fill(desc, t, positions, indices);
        rtcSetGeometryUserData(geometry, t);
        rtcSetGeometryIntersectFilterFunction(geometry, filter);
        rtcSetGeometryOccludedFilterFunction(geometry, filter);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(rays->scene, geometry, (unsigned) number);
    }
    rtcReleaseGeometry(geometry); // the scene holds it
    return positions && indices && rays->status == FG_OK;
}

static bool build(ag_rays *rays, const ag_rays_desc *desc)
{
    char config[64];
    snprintf(config, sizeof config, "threads=%d,set_affinity=0", desc->threads);
    rays->device = rtcNewDevice(config);
    if (!rays->device) {
        on_error(rays, rtcGetDeviceError(NULL), "no device");
        return false;
    }
    rtcSetDeviceErrorFunction(rays->device, on_error, rays);
    rays->scene = rtcNewScene(rays->device);
    if (!rays->scene)
        return false;
    rtcSetSceneFlags(rays->scene, RTC_SCENE_FLAG_ROBUST);
    for (int i = 0; i < desc->scene->instance_count; ++i)
        if (!add_target(rays, desc, i))
            return false;
    rtcCommitScene(rays->scene);
    return rays->status == FG_OK;
}

fg_status ag_rays_create(const ag_rays_desc *desc, ag_rays **out)
{
    *out = NULL;
    if (!desc->scene || desc->threads < 0) {
        fg_logf(desc->log, FG_LOG_ERROR, "rays: %s",
                desc->scene ? "threads must not be negative" : "there is no scene");
        return FG_ERR_INVALID;
    }
    ag_rays *rays = calloc(1, sizeof *rays);
    if (rays)
        rays->targets = calloc((size_t) desc->scene->instance_count + 1, sizeof *rays->targets);
    if (!rays || !rays->targets) {
        fg_logf(desc->log, FG_LOG_ERROR, "rays: out of memory");
        ag_rays_destroy(rays);
        return FG_ERR_MEMORY;
    }
    rays->log = desc->log;
    if (!build(rays, desc)) {
        const fg_status status = rays->status != FG_OK ? rays->status : FG_ERR_MEMORY;
        ag_rays_destroy(rays);
        return status;
    }
    *out = rays;
    return FG_OK;
}

void ag_rays_destroy(ag_rays *rays)
{
    if (!rays)
        return;
    if (rays->scene)
        rtcReleaseScene(rays->scene);
    if (rays->device)
        rtcReleaseDevice(rays->device);
    free(rays->targets);
    free(rays);
}

// ---- casts --------------------------------------------------------------------------

static struct RTCRay ray_of(const float from[3], const float direction[3], float tnear, float tfar)
{
    return (struct RTCRay){ .org_x = from[0],
                            .org_y = from[1],
                            .org_z = from[2],
                            .tnear = tnear,
                            .dir_x = direction[0],
                            .dir_y = direction[1],
                            .dir_z = direction[2],
                            .tfar = tfar,
                            .mask = 0xffffffffu };
}

static void intersect(const ag_rays *rays, query *q, struct RTCRayHit *ray)
{
    ray->hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    struct RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    rtcInitRayQueryContext(&q->context);
    args.context = &q->context;
    rtcIntersect1(rays->scene, ray, &args);
#else
    rtcInitIntersectContext(&q->context);
    rtcIntersect1(rays->scene, &q->context, ray);
#endif
}

bool ag_rays_nearest(const ag_rays *rays, const float from[3], const float direction[3],
                     float tnear, float tfar, ag_hit *hit)
{
    query q = { .all = false };
    struct RTCRayHit ray = { .ray = ray_of(from, direction, tnear, tfar) };
    intersect(rays, &q, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    *hit = (ag_hit){ .distance = ray.ray.tfar,
                     .instance = (int) ray.hit.geomID,
                     .triangle = ray.hit.primID,
                     .barycentric = { ray.hit.u, ray.hit.v } };
    complete(rays, direction, hit);
    return true;
}

bool ag_rays_blocked(const ag_rays *rays, const float from[3], const float direction[3],
                     float tnear, float tfar)
{
    query q = { .all = false };
    struct RTCRay ray = ray_of(from, direction, tnear, tfar);
#if RTC_VERSION_MAJOR >= 4
    struct RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    rtcInitRayQueryContext(&q.context);
    args.context = &q.context;
    rtcOccluded1(rays->scene, &ray, &args);
#else
    rtcInitIntersectContext(&q.context);
    rtcOccluded1(rays->scene, &q.context, &ray);
#endif
    return ray.tfar < 0;
}

void ag_rays_blocked_many(const ag_rays *rays, const ag_ray *cast, int count, bool *blocked)
{
#if RTC_VERSION_MAJOR >= 4 // has no streams
    for (int i = 0; i < count; ++i)
        blocked[i] =
            ag_rays_blocked(rays, cast[i].from, cast[i].direction, cast[i].tnear, cast[i].tfar);
#else
    enum { STREAM = 128 };
    struct RTCRay stream[STREAM];
    query q = { .all = false };
    rtcInitIntersectContext(&q.context);
    for (int first = 0; first < count; first += STREAM) {
        const int here = count - first < STREAM ? count - first : STREAM;
        for (int i = 0; i < here; ++i) {
            const ag_ray *ray = cast + first + i;
            stream[i] = ray_of(ray->from, ray->direction, ray->tnear, ray->tfar);
        }
        rtcOccluded1M(rays->scene, &q.context, stream, (unsigned) here, sizeof *stream);
        for (int i = 0; i < here; ++i)
            blocked[first + i] = stream[i].tfar < 0;
    }
#endif
}

int ag_rays_all(const ag_rays *rays, const float from[3], const float direction[3], float tfar,
                ag_hit *hits, int max)
{
    query q = { .all = true, .hits = hits, .max = max };
    struct RTCRayHit ray = { .ray = ray_of(from, direction, 0, tfar) };
    intersect(rays, &q, &ray);
    for (int i = 0; i < q.count && i < max; ++i)
        complete(rays, direction, hits + i);
    return q.count;
}

void ag_rays_offset(const float position[3], const float side_normal[3], float out[3])
{
    // Rounding put the position off its plane by at most half a unit in the last place along
    // each axis, and will move the result as far again: sqrt(3) units together.
    const float size = fmaxf(fmaxf(fabsf(position[0]), fabsf(position[1])), fabsf(position[2]));
    const float step = 4 * 0x1p-23f * size + 1e-12f;
    for (int k = 0; k < 3; ++k)
        out[k] = position[k] + step * side_normal[k];
}
