// SPDX-License-Identifier: MIT
#include "reference_priv.h"

#include <math.h>
#include <stdlib.h>

// Rays from punctual lights, and the density of the points that they reach. A light is picked by
// its power; the choice changes the noise, never the mean.

static const double pi = 3.14159265358979323846;

// The directions that a light sends rays to: [sr]; 0 where they are too few to aim at.
static double solid_angle(const ag_light *light)
{
    const double angle = 2 * pi * (1 - fmax(-1, (double) light->cos_outer));
    if (light->kind == AG_LIGHT_POINT)
        return 4 * pi;
    if (light->cosine)
        return pi; // weighted by the cosine
    return angle > 1e-6 ? angle : 0;
}

static double power(const tracer *t, const ag_light *light)
{
    const double intensity =
        (double) light->intensity[0] + (double) light->intensity[1] + (double) light->intensity[2];
    const double spread =
        light->kind == AG_LIGHT_DIRECTIONAL ? pi * t->radius * t->radius : solid_angle(light);
    const double watts = intensity * spread;
    return isfinite(watts) && watts > 0 ? watts : 0;
}

bool lights_prepare(tracer *t)
{
    const int count = t->scene->light_count;
    double total = 0, squared = 0;
    t->shares = calloc((size_t) count + 1, sizeof *t->shares);
    if (!t->shares)
        return false;
    for (int k = 0; k < 3; ++k) {
        const double half = (t->scene->box_max[k] - t->scene->box_min[k]) / 2;
        t->middle[k] = t->scene->box_min[k] + half - t->origin[k];
        squared += half * half;
    }
    t->radius = sqrt(squared);
    for (int i = 0; i < count; ++i)
        total += t->shares[i] = power(t, t->scene->lights + i);
    for (int i = 0; i < count; ++i)
        t->shares[i] = total > 0 && isfinite(total) ? t->shares[i] / total : 0;
    return true;
}

void lights_finish(tracer *t)
{
    free(t->shares);
    t->shares = NULL;
}

double light_density(const tracer *t, int number, const point *p, const double to_light[3],
                     double distance)
{
    const ag_light *light = t->scene->lights + number;
    const double facing = fabs(vec_dot(p->face, to_light));
    double cosine = 0;
    if (t->shares[number] == 0)
        return 0;
    if (light->kind == AG_LIGHT_DIRECTIONAL)
        return t->shares[number] * facing / (pi * t->radius * t->radius);
    for (int k = 0; k < 3; ++k)
        cosine -= to_light[k] * (double) light->direction[k];
    if (light->kind == AG_LIGHT_SPOT && cosine < (light->cosine ? 0 : (double) light->cos_outer))
        return 0;
    const bool weighted = light->kind == AG_LIGHT_SPOT && light->cosine;
    return t->shares[number] * (weighted ? cosine : 1) / solid_angle(light) * facing /
           (distance * distance);
}

// A ray parallel to the light through the disc that the scene's shadow fits in.
static void directional_ray(const tracer *t, const double axis[3], const double u[2], ray *out)
{
    double across[3];
    // At a right angle to the axis.
    vec_around(axis, 0, 2 * pi * u[1], across);
    for (int k = 0; k < 3; ++k) {
        out->from[k] =
            (float) (t->middle[k] + t->radius * (sqrt(u[0]) * across[k] - 1.01 * axis[k]));
        out->direction[k] = (float) axis[k];
    }
}

int light_ray(const tracer *t, double pick, const double u[2], ray *out)
{
    int number = -1;
    for (int i = 0; i < t->scene->light_count && pick >= 0; ++i)
        if (t->shares[i] > 0) {
            number = i;
            pick -= t->shares[i];
        }
    if (number < 0)
        return -1;
    const ag_light *light = t->scene->lights + number;
    const double axis[3] = { (double) light->direction[0], (double) light->direction[1],
                             (double) light->direction[2] };
    double direction[3], cosine = 1 - 2 * u[0];
    if (light->kind == AG_LIGHT_DIRECTIONAL) {
        directional_ray(t, axis, u, out);
        return number;
    }
    if (light->kind == AG_LIGHT_SPOT)
        cosine =
            light->cosine ? sqrt(1 - u[0]) : 1 - u[0] * (1 - fmax(-1, (double) light->cos_outer));
    // A point light has no axis that means something.
    vec_around(light->kind == AG_LIGHT_SPOT ? axis : (const double[3]){ 0, 1, 0 }, cosine,
               2 * pi * u[1], direction);
    for (int k = 0; k < 3; ++k) {
        out->from[k] = (float) (light->position[k] - t->origin[k]);
        out->direction[k] = (float) direction[k];
    }
    return number;
}
