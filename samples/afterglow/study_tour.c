// SPDX-License-Identifier: MIT
#include "study.h"

#include <math.h>

enum { PERIOD = 8 };                                  // s
static const double most_pan = 0.15, most_turn = 0.2; // radians

tour tour_begin(host *h, bool on)
{
    const ag_scene *s = h->scene;
    tour t = { .h = h, .on = on, .camera = host_camera(h) };
    if (!on)
        return t;
    t.moves_camera = !t.camera.moving;
    if (s->light_count > 0)
        t.light = s->lights[0];
    // One without a name would be added, not moved.
    t.moves_light = t.light.name[0] && !(s->features & AG_FEATURE_MOVING_LIGHT);
    const double width = fmin(s->box_max[0] - s->box_min[0], s->box_max[2] - s->box_min[2]);
    t.radius = fmax(width, 0) / 8;
    return t;
}

// (x, z) about +Y, from z to x.
static void turn(double x, double z, double angle, double out[2])
{
    out[0] = cos(angle) * x + sin(angle) * z;
    out[1] = cos(angle) * z - sin(angle) * x;
}

static void pan_camera(const tour *t, renderer *r, double phase)
{
    ag_camera camera = t->camera;
    for (int i = 0; i < 12; i += 4) { // its axes; its place stays
        double out[2];
        turn(t->camera.world[i], t->camera.world[i + 2], most_pan * sin(phase), out);
        camera.world[i] = out[0];
        camera.world[i + 2] = out[1];
    }
    renderer_set_camera(r, &camera);
}

static fg_status move_light(const tour *t, double phase)
{
    ag_light light = t->light;
    if (light.kind == AG_LIGHT_DIRECTIONAL) {
        double out[2];
        turn((double) light.direction[0], (double) light.direction[2], most_turn * sin(phase), out);
        light.direction[0] = (float) out[0];
        light.direction[2] = (float) out[1];
    } else {
        light.position[0] += t->radius * (cos(phase) - 1);
        light.position[2] += t->radius * sin(phase);
    }
    return ag_scene_add_light(t->h->scene, &light);
}

fg_status tour_pose(const tour *t, renderer *r, double time)
{
    const double phase = 2 * M_PI * time / PERIOD;
    if (t->moves_camera)
        pan_camera(t, r, phase);
    return t->moves_light ? move_light(t, phase) : FG_OK;
}

fg_status tour_end(const tour *t)
{
    return t->moves_light ? ag_scene_add_light(t->h->scene, &t->light) : FG_OK;
}
