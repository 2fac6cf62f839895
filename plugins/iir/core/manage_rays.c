// SPDX-License-Identifier: MIT
#include "manage_priv.h"

#include <math.h>
#include <string.h>

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void to_rays(const iir_manager *m, const double world[3], float out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = (float) (world[k] - m->origin[k]);
}

// Length below which places in the rays' coordinates cannot be told apart: they were rounded to
// floats, by half a unit in the last place along each axis, on both ends.
static float blur_of(const float a[3], const float b[3])
{
    float size = 0;
    for (int k = 0; k < 3; k++)
        size = fmaxf(size, fmaxf(fabsf(a[k]), fabsf(b[k])));
    return 4 * 0x1p-23f * size + 1e-12f;
}

// ---- validity ---------------------------------------------------------------------------------

static bool map(const iir_emitter *e, point *p)
{
    if (p->escaped && e->kind != AG_LIGHT_DIRECTIONAL)
        return iir_emitter_direction_to_domain(e, p->place, p->at);
    return iir_emitter_to_domain(e, p->place, p->at);
}

// From the VPL to the light: a ray's start is the end that lies exactly on its side of the surface.
// False where the light is not in front of the surface, by more than rounding may be: on the VPL,
// edge-on, or on the other side of a thin wall.
static bool probe_vpl(const iir_manager *m, const iir_emitter *e, const point *p, ag_ray *out)
{
    double origin[3], direction[3], height = 0, length = 0;
    float place[3], start[3];
    iir_emitter_ray(e, p->at, origin, direction);
    to_rays(m, p->place, place);
    to_rays(m, origin, start);
    ag_rays_offset(place, p->normal, out->from);
    for (int k = 0; k < 3; k++) {
        out->direction[k] = start[k] - out->from[k];
        height += (double) p->normal[k] * (double) (start[k] - place[k]);
        length += (double) out->direction[k] * (double) out->direction[k];
    }
    length = sqrt(length);
    const double blur = (double) blur_of(place, start);
    if (height <= blur || length <= 2 * blur)
        return false;
    out->tnear = 0;
    out->tfar = (float) (1 - blur / length); // what the light touches does not hide it
    return true;
}

// All of the light's ray: it still meets nothing.
static void probe_escaped(const iir_manager *m, const iir_emitter *e, const point *p, ag_ray *out)
{
    double origin[3], direction[3];
    iir_emitter_ray(e, p->at, origin, direction);
    to_rays(m, origin, out->from);
    for (int k = 0; k < 3; k++)
        out->direction[k] = (float) direction[k];
    out->tnear = blur_of(out->from, out->from);
    out->tfar = INFINITY;
}

static void drop(iir_manager *m, int id)
{
    iir_point_free(m, id);
    m->result.invalid++;
}

static void cast(iir_manager *m, int count)
{
    const double start = iir_cpu_time();
    ag_rays_blocked_many(m->rays, m->probes, count, m->blocked);
    m->result.rays += count;
    m->result.ray_ms += 1e3 * (iir_cpu_time() - start);
}

void iir_rays_validate(iir_manager *m)
{
    int count = 0;
    for (int i = 0; i < m->capacity; i++) {
        point *p = &m->points[i];
        if (p->light < 0 || !m->lights[p->light].moved)
            continue;
        const light_state *l = &m->lights[p->light];
        ag_ray *r = &m->probes[count];
        bool valid = !(p->escaped && l->turned) && map(&l->emitter, p);
        if (valid && p->escaped)
            probe_escaped(m, &l->emitter, p, r);
        else if (valid)
            valid = probe_vpl(m, &l->emitter, p, r);
        if (valid)
            m->probed[count++] = i;
        else
            drop(m, i);
    }
    if (count > 0)
        cast(m, count);
    for (int i = 0; i < count; i++)
        if (m->blocked[i])
            drop(m, m->probed[i]);
}

// ---- hits -------------------------------------------------------------------------------------

// Where the ray of a directional light leaves the sphere about the scene, so that the place stays
// within the disc whichever way the light turns.
static void leave(const iir_manager *m, const iir_emitter *e, const double origin[3], point *p)
{
    const double across = fmin(p->at[0] * p->at[0] + p->at[1] * p->at[1], 1);
    double to[3];
    for (int k = 0; k < 3; k++)
        to[k] = 0.5 * (m->box_min[k] + m->box_max[k]) - origin[k];
    const double along = dot(to, e->axes[2]) + e->radius * sqrt(1 - across);
    for (int k = 0; k < 3; k++)
        p->place[k] = origin[k] + along * e->axes[2][k];
}

static void take_surface(const iir_manager *m, const ag_hit *hit, point *p)
{
    const ag_instance *instance = &m->scene->instances[hit->instance];
    const ag_primitive *primitive = &m->scene->primitives[instance->primitive];
    ag_blur_albedo(m->blur, primitive->material, hit->uv, hit->color, p->albedo); // sec. 4.6
    for (int k = 0; k < 3; k++) {
        p->place[k] = m->origin[k] + (double) hit->position[k];
        p->normal[k] = hit->front ? hit->face_normal[k] : -hit->face_normal[k];
    }
}

void iir_rays_hit(iir_manager *m, const iir_emitter *e, point *p)
{
    double origin[3], direction[3];
    float from[3], way[3];
    ag_hit hit;
    iir_emitter_ray(e, p->at, origin, direction);
    to_rays(m, origin, from);
    for (int k = 0; k < 3; k++)
        way[k] = (float) direction[k];
    m->result.rays++;
    p->escaped = !ag_rays_nearest(m->rays, from, way, blur_of(from, from), INFINITY, &hit);
    if (!p->escaped)
        take_surface(m, &hit, p);
    else if (e->kind == AG_LIGHT_DIRECTIONAL)
        leave(m, e, origin, p);
    else
        memcpy(p->place, direction, sizeof p->place);
}

// ---- the patch --------------------------------------------------------------------------------

// Two unit vectors in the plane: across the way the light comes, and along it.
static void axes_in_plane(const double normal[3], const double direction[3], double axes[2][3])
{
    double length = 0;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        axes[0][k] = normal[i] * direction[j] - normal[j] * direction[i];
    }
    length = sqrt(dot(axes[0], axes[0]));
    if (length < 1e-6) { // head-on: any will do
        const int least = fabs(normal[0]) < 0.6 ? 0 : 1;
        for (int k = 0; k < 3; k++)
            axes[0][k] = (k == least) - normal[least] * normal[k];
        length = sqrt(dot(axes[0], axes[0]));
    }
    for (int k = 0; k < 3; k++)
        axes[0][k] /= length;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        axes[1][k] = normal[i] * axes[0][j] - normal[j] * axes[0][i];
    }
}

void iir_rays_patch(const iir_manager *m, const iir_emitter *e, const point *p, iir_vpl *out)
{
    double origin[3], direction[3], normal[3], to[3], axes[2][3], diagonal = 0;
    iir_emitter_ray(e, p->at, origin, direction);
    for (int k = 0; k < 3; k++) {
        normal[k] = (double) p->normal[k];
        to[k] = p->place[k] - origin[k];
        diagonal += (m->box_max[k] - m->box_min[k]) * (m->box_max[k] - m->box_min[k]);
    }
    diagonal = sqrt(diagonal);
    const double distance = sqrt(dot(to, to));
    const double width = fmin(sqrt(iir_emitter_section(e, p->at, p->cell, distance)), diagonal);
    // Where the light comes grazing, the cell's far end may lie at infinity. The cosine is taken no
    // smaller than that at the end of a cell which just holds the horizon, and the patch is no
    // longer than the scene.
    double cosine = fmin(fabs(dot(normal, direction)), 1);
    if (e->kind != AG_LIGHT_DIRECTIONAL && distance > 0)
        cosine = fmax(cosine, fmin(0.5 * width / distance, 1));
    const double along = cosine * diagonal > width ? width / cosine : diagonal;
    axes_in_plane(normal, direction, axes);
    for (int k = 0; k < 3; k++) {
        out->edges[0][k] = (float) (width * axes[0][k]);
        out->edges[1][k] = (float) (along * axes[1][k]);
    }
    out->area = (float) (width * along);
}
