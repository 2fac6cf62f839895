// SPDX-License-Identifier: MIT
// What the tests of VPL management share: rooms, lights, steps and what always holds.
#ifndef IIR_ROOMS_H
#define IIR_ROOMS_H

#include "../shapes.h"
#include "scene_log.h"

#include "manage.h"

static inline iir_budget default_budget(int max_lights)
{
    return (iir_budget){ .max_lights = max_lights,
                         .recalc_min = 4,
                         .recalc_max = 8,
                         .fill_first = true,
                         .settle = true,
                         .rim = 0.35,
                         .tiles = 4 };
}

// Two metres along each edge, white, with a wall of half its height across the middle.
static inline ag_scene *walled_room(const fg_log *log)
{
    shapes s = shapes_begin(log);
    const int white = shapes_diffuse(&s, 1, 0);
    shapes_room(&s, white, (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
    shapes_quad(&s, s.node, white, (float[]){ 0, -1, -1 }, (float[]){ 0, 1, 0 },
                (float[]){ 0, 0, 2 });
    return shapes_end(&s);
}

// A floor of two metres under the open sky.
static inline ag_scene *open_floor(const fg_log *log)
{
    shapes s = shapes_begin(log);
    shapes_quad(&s, s.node, shapes_diffuse(&s, 1, 0), (float[]){ -1, 0, -1 }, (float[]){ 0, 0, 2 },
                (float[]){ 2, 0, 0 });
    return shapes_end(&s);
}

static inline ag_light point_light(double x, double y, double z)
{
    ag_light light = ag_default_light();
    light.position[0] = x;
    light.position[1] = y;
    light.position[2] = z;
    return light;
}

static inline void aim(ag_light *light, double x, double y, double z)
{
    const double length = sqrt(x * x + y * y + z * z);
    light->direction[0] = (float) (x / length);
    light->direction[1] = (float) (y / length);
    light->direction[2] = (float) (z / length);
}

// Whole angle of the cone; no edge to its brightness.
static inline ag_light spot_light(double x, double y, double z, double degrees)
{
    ag_light light = point_light(x, y, z);
    light.kind = AG_LIGHT_SPOT;
    light.cos_outer = (float) cos(degrees / 2 * 3.14159265358979323846 / 180);
    light.cos_inner = 0.5f * (1 + light.cos_outer);
    aim(&light, 0, -1, 0);
    return light;
}

static inline ag_light cosine_light(double x, double y, double z)
{
    ag_light light = spot_light(x, y, z, 180);
    light.cosine = true;
    return light;
}

static inline ag_light directional_light(double x, double y, double z)
{
    ag_light light = ag_default_light();
    light.kind = AG_LIGHT_DIRECTIONAL;
    aim(&light, x, y, z);
    return light;
}

static inline iir_manager *manage(const fg_log *log, const ag_scene *scene, int max_lights)
{
    iir_manager *m = NULL;
    const iir_manager_desc desc = {
        .log = log, .scene = scene, .max_lights = max_lights, .blur = 16
    };
    assert_non_null(scene);
    assert_int_equal(iir_manager_create(&desc, &m), FG_OK);
    return m;
}

// Slots are in range and no two VPLs have one; numbers are finite; counts fit.
static inline void assert_sound(const iir_result *r, int max_lights)
{
    static bool taken[IIR_MAX_VPLS];
    int fresh = 0;
    memset(taken, 0, sizeof taken);
    assert_true(r->count >= 0 && r->count + r->escaped <= max_lights);
    for (int i = 0; i < r->count; i++) {
        const iir_vpl *v = &r->vpls[i];
        double normal = 0;
        assert_in_range(v->slot, 0, IIR_MAX_VPLS - 1);
        assert_false(taken[v->slot]);
        taken[v->slot] = true;
        fresh += v->fresh;
        for (int k = 0; k < 3; k++) {
            assert_true(isfinite(v->position[k]) && isfinite(v->edges[0][k]) &&
                        isfinite(v->edges[1][k]));
            assert_true(v->flux[k] >= 0 && isfinite(v->flux[k]));
            assert_true(v->albedo[k] >= 0 && v->albedo[k] <= 1);
            normal += (double) v->normal[k] * (double) v->normal[k];
        }
        assert_near(normal, 1, 1e-5);
        assert_true(v->area >= 0 && isfinite(v->area));
    }
    assert_int_equal(fresh, r->fresh);
    int vpls = 0;
    assert_int_equal(r->point_count, r->count + r->escaped);
    for (int i = 0; i < r->point_count; i++) {
        const iir_point *p = &r->points[i];
        vpls += p->vpl >= 0;
        assert_true(p->vpl < r->count);
        assert_true(p->vpl < 0 ||
                    (r->vpls[p->vpl].light == p->light && r->vpls[p->vpl].fresh == p->fresh));
    }
    assert_int_equal(vpls, r->count);
    assert_true(isfinite(r->dispersion) && r->power >= 0 && r->lost <= r->power * (1 + 1e-9));
}

static inline const iir_result *step_many(iir_manager *m, const ag_light *lights, int count,
                                          const iir_budget *budget)
{
    const iir_result *r = NULL;
    const iir_lights all = { .lights = lights, .count = count };
    assert_int_equal(iir_manager_step(m, &all, budget, &r), FG_OK);
    assert_sound(r, budget->max_lights);
    return r;
}

static inline const iir_result *step(iir_manager *m, const ag_light *light,
                                     const iir_budget *budget)
{
    return step_many(m, light, 1, budget);
}

// Of white surfaces: what the VPLs carry and what went into the sky is all that left the lights
// (features: to 1e-5).
static inline void assert_power_kept(const iir_result *r)
{
    double sum = r->lost;
    for (int i = 0; i < r->count; i++)
        for (int k = 0; k < 3; k++)
            sum += (double) r->vpls[i].flux[k] / 3;
    assert_near(sum, r->power, 1e-5 * r->power);
}

// To the bit, but for slots and births where they may differ.
static inline void assert_same_vpls(const iir_vpl *a, const iir_vpl *b, int count)
{
    for (int i = 0; i < count; i++) {
        assert_memory_equal(a[i].position, b[i].position, sizeof a->position);
        assert_memory_equal(a[i].normal, b[i].normal, sizeof a->normal);
        assert_memory_equal(a[i].albedo, b[i].albedo, sizeof a->albedo);
        assert_memory_equal(a[i].flux, b[i].flux, sizeof a->flux);
        assert_memory_equal(a[i].edges, b[i].edges, sizeof a->edges);
        assert_memory_equal(&a[i].area, &b[i].area, sizeof a->area);
        assert_int_equal(a[i].slot, b[i].slot);
        assert_int_equal(a[i].light, b[i].light);
    }
}

// A walk through the room that comes back after 500 steps, 1 to 2 cm each.
static inline void walk(ag_light *light, int n)
{
    const double t = n * 2 * 3.14159265358979323846 / 500;
    light->position[0] = 0.7 * sin(2 * t) + 0.05;
    light->position[1] = 0.2 + 0.5 * cos(3 * t);
    light->position[2] = 0.7 * cos(t);
    aim(light, sin(t), -1, 0.5 * cos(2 * t));
}

#endif // IIR_ROOMS_H
