// SPDX-License-Identifier: MIT
#include "gpu_scene_priv.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// As passes/shading/lights.glsl has it, for an intensity of 1 W/sr; `c` is the cosine of the angle
// from the light's axis.
static double intensity_at(const ag_light *light, double c)
{
    if (light->kind == AG_LIGHT_POINT)
        return 1;
    if (light->cosine)
        return fmax(c, 0);
    const double ramp = (double) light->cos_inner - (double) light->cos_outer;
    const double fade = (c - (double) light->cos_outer) / fmax(ramp, 1e-3);
    return fade <= 0 ? 0 : fade >= 1 ? 1 : fade * fade;
}

// Of the circle of directions whose angle from a 90-degree face's axis has cosine `c`, the part
// that meets the face.
static double share_of_face(double c)
{
    if (c <= 1 / sqrt(3))
        return 0;
    return c >= 1 / sqrt(2) ? 1 : 1 - 4 / pi * acos(c / sqrt(1 - c * c));
}

typedef enum part {
    PART_WHOLE,
    PART_FRONT,
    PART_SIDE,
    PART_BACK,
} part;

static double share_of_part(part what, double c)
{
    switch (what) {
    case PART_WHOLE: return 1;
    case PART_FRONT: return share_of_face(c);
    case PART_BACK: return share_of_face(-c);
    default: // four alike share what front and back leave
        return 0.25 * (1 - share_of_face(c) - share_of_face(-c));
    }
}

// Midpoint rule over where the part and the cone overlap, so that a part that any light meets has
// power. Off by less than 1e-3: the share begins as a square root does.
static double integrate(const ag_light *light, part what, double from, double to)
{
    enum { STEPS = 256 };
    const double cone = light->kind == AG_LIGHT_POINT ? -1
                        : light->cosine               ? 0
                                                      : (double) light->cos_outer;
    const double lo = fmax(from, cone);
    double sum = 0;
    for (int i = 0; lo < to && i < STEPS; i++) {
        const double c = lo + (to - lo) * (i + 0.5) / STEPS;
        sum += intensity_at(light, c) * share_of_part(what, c) * (to - lo) / STEPS;
    }
    return 2 * pi * sum;
}

// W for 1 W/sr. Faces in the order of perspective_face().
static double unit_power(const ag_light *light, int face)
{
    if (light_face_count(light) == 1)
        return integrate(light, PART_WHOLE, -1, 1);
    if (face == 0)
        return integrate(light, PART_FRONT, 1 / sqrt(3), 1);
    if (face == 5)
        return integrate(light, PART_BACK, -1, -1 / sqrt(3));
    return integrate(light, PART_SIDE, -1 / sqrt(2), 1 / sqrt(2));
}

static double face_power(const ag_scene *scene, const ag_light *light, int face)
{
    double mean = 0;
    for (int i = 0; i < 3; i++)
        mean += (double) light->intensity[i] / 3;
    if (!(mean > 0))
        return 0;
    if (light->kind != AG_LIGHT_DIRECTIONAL)
        return mean * unit_power(light, face);
    double half[2];
    light_cross_section(scene, light, half);
    return mean * 4 * half[0] * half[1];
}

void lights_to_power(const ag_scene *scene, double *power)
{
    for (int l = 0; l < scene->light_count; l++)
        for (int i = 0; i < light_face_count(&scene->lights[l]); i++)
            *power++ = face_power(scene, &scene->lights[l], i);
}

double ag_gpu_scene_face_power(const ag_gpu_scene *s, int face)
{
    return s->face_power[face];
}
