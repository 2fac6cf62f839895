// SPDX-License-Identifier: MIT
#include "emitter.h"

#include <math.h>
#include <pass/math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

// Radians, or radii of a directional light's disc. What lies beyond the rim by less is brought
// back: places were rounded on their way here, and points on the rim are common (sec. 4.6).
static const double beyond_rim = 1e-6;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double iir_space_area(iir_space space)
{
    return space == IIR_SPHERE ? 4 * pi : pi;
}

// ---- the radial stretch -----------------------------------------------------------------------
//
// Angles are given by h = 1 - cosine, which is the solid angle within over 2 pi and keeps its
// digits near the axis. Within `flat` the intensity is 1, from there to `rim` it falls as ((rim -
// h) / ramp)^2. The power within h, over 2 pi, is h as far as it is flat; the falloff adds
// falloff(e) (1 - (1 - q)^3), q being how much of its width lies within h.

static double falloff(const iir_emitter *e)
{
    const double width = e->rim - e->flat;
    return width * (width / e->ramp) * (width / e->ramp) / 3;
}

// Radius in the disc of an angle.
static double radius_of(const iir_emitter *e, double h)
{
    if (e->cosine)
        return sqrt(h * (2 - h)); // the sine: fig. 3
    double within = h;
    if (h > e->flat) {
        const double q = fmin((h - e->flat) / (e->rim - e->flat), 1);
        within = e->flat + falloff(e) * q * (3 - q * (3 - q));
    }
    return sqrt(fmin(within / (e->flat + falloff(e)), 1));
}

// Its inverse; and the rest to the axis' other end, 2 - h, which keeps its digits there.
static double angle_of(const iir_emitter *e, double radius, double *rest)
{
    const double r = fmin(radius, 1), outside = (1 - r) * (1 + r);
    if (e->cosine) {
        const double cosine = sqrt(outside);
        *rest = 1 + cosine;
        return r * r / *rest;
    }
    const double all = e->flat + falloff(e), within = all * r * r;
    if (within <= e->flat) {
        *rest = 2 - within;
        return within;
    }
    const double width = e->rim - e->flat;
    const double left = width * cbrt(fmin(all * outside / falloff(e), 1)); // width (1 - q)
    *rest = 2 - e->rim + left;
    if (radius > 0.5)
        return e->rim - left;
    const double q = fmin(fmax((within - e->flat) / falloff(e), 0), 1); // 1 - (1 - q)^3
    return e->flat - width * expm1(log1p(-q) / 3);
}

// ---- what a light is --------------------------------------------------------------------------

static void set_axes(iir_emitter *e, const float direction[3])
{
    const double d[3] = { (double) direction[0], (double) direction[1], (double) direction[2] };
    const double length = sqrt(dot(d, d)), n[3] = { d[0] / length, d[1] / length, d[2] / length };
    ag_frame_about(n, e->axes[0], e->axes[1]);
    memcpy(e->axes[2], n, sizeof n);
}

// The disc across the scene's bounding sphere, far enough before it that no surface touches it.
static bool place_disc(iir_emitter *e, const double box_min[3], const double box_max[3])
{
    double half[3];
    for (int k = 0; k < 3; k++) {
        half[k] = 0.5 * (box_max[k] - box_min[k]);
        if (!(half[k] >= 0))
            return false;
    }
    e->radius = sqrt(dot(half, half));
    for (int k = 0; k < 3; k++)
        e->position[k] = box_min[k] + half[k] - 1.0625 * e->radius * e->axes[2][k];
    return e->radius > 0;
}

// Power for an intensity (of a directional light irradiance) of 1.
static double unit_power(const iir_emitter *e)
{
    if (e->kind == AG_LIGHT_DIRECTIONAL)
        return pi * e->radius * e->radius;
    if (e->kind == AG_LIGHT_POINT)
        return 4 * pi;
    return e->cosine ? pi : 2 * pi * (e->flat + falloff(e));
}

bool iir_emitter_from_light(const ag_light *light, const double box_min[3], const double box_max[3],
                            iir_emitter *out)
{
    static const iir_emitter world = { .axes = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    *out = world;
    out->kind = light->kind;
    out->space = light->kind == AG_LIGHT_POINT ? IIR_SPHERE : IIR_DISC;
    out->cosine = light->kind == AG_LIGHT_SPOT && light->cosine;
    memcpy(out->position, light->position, sizeof out->position);
    if (light->kind != AG_LIGHT_POINT)
        set_axes(out, light->direction);
    if (light->kind == AG_LIGHT_SPOT) {
        const double inner = (double) light->cos_inner, outer = (double) light->cos_outer;
        out->ramp = out->cosine ? 1 : fmax(1e-3, inner - outer);
        out->rim = out->cosine ? 1 : 1 - outer;
        out->flat =
            fmax(out->rim - out->ramp, 0); // 0 too where the least ramp is not all in the cone
        if (!(out->rim > 0))
            return false;
    }
    if (light->kind == AG_LIGHT_DIRECTIONAL && !place_disc(out, box_min, box_max))
        return false;
    for (int i = 0; i < 3; i++)
        out->power[i] = (double) light->intensity[i] * unit_power(out);
    return out->power[0] + out->power[1] + out->power[2] > 0;
}

static bool same(const double *a, const double *b, int count)
{
    int equal = 0;
    while (equal < count && a[equal] == b[equal])
        equal++;
    return equal == count;
}

bool iir_emitter_equal(const iir_emitter *a, const iir_emitter *b)
{
    return a->kind == b->kind && a->cosine == b->cosine && a->radius == b->radius &&
           a->flat == b->flat && a->rim == b->rim && a->ramp == b->ramp &&
           same(a->position, b->position, 3) && same(a->axes[0], b->axes[0], 3) &&
           same(a->axes[1], b->axes[1], 3) && same(a->axes[2], b->axes[2], 3) &&
           same(a->power, b->power, 3);
}

// ---- there and back ---------------------------------------------------------------------------

bool iir_emitter_direction_to_domain(const iir_emitter *e, const double direction[3],
                                     double point[3])
{
    if (e->kind == AG_LIGHT_DIRECTIONAL)
        return false;
    if (e->space == IIR_SPHERE) {
        memcpy(point, direction, 3 * sizeof *point);
        return true;
    }
    const double across[2] = { dot(direction, e->axes[0]), dot(direction, e->axes[1]) };
    const double sine = hypot(across[0], across[1]), cosine = dot(direction, e->axes[2]);
    const double h = cosine >= 0 ? sine * sine / (1 + cosine) : 2 - sine * sine / (1 - cosine);
    const double slack = beyond_rim * sqrt(e->rim * (2 - e->rim)) + 0.5 * beyond_rim * beyond_rim;
    if (h > e->rim + slack)
        return false;
    const double radius = radius_of(e, fmin(h, e->rim));
    // On the axis any way across will do; behind the light all of them meet.
    point[0] = sine > 0 ? radius * (across[0] / sine) : radius;
    point[1] = sine > 0 ? radius * (across[1] / sine) : 0;
    point[2] = 0;
    return true;
}

static bool shadow_of(const iir_emitter *e, const double to[3], double point[3])
{
    if (dot(to, e->axes[2]) < 0)
        return false;
    for (int i = 0; i < 2; i++)
        point[i] = dot(to, e->axes[i]) / e->radius;
    point[2] = 0;
    const double radius = hypot(point[0], point[1]);
    if (radius > 1 + beyond_rim)
        return false;
    for (int i = 0; i < 2; i++)
        point[i] /= fmax(radius, 1);
    return true;
}

bool iir_emitter_to_domain(const iir_emitter *e, const double place[3], double point[3])
{
    double to[3];
    for (int k = 0; k < 3; k++)
        to[k] = place[k] - e->position[k];
    if (e->kind == AG_LIGHT_DIRECTIONAL)
        return shadow_of(e, to, point);
    const double length = sqrt(dot(to, to));
    if (!(length > 0))
        return false;
    for (int k = 0; k < 3; k++)
        to[k] /= length;
    return iir_emitter_direction_to_domain(e, to, point);
}

void iir_emitter_ray(const iir_emitter *e, const double point[3], double origin[3],
                     double direction[3])
{
    memcpy(origin, e->position, 3 * sizeof *origin);
    if (e->space == IIR_SPHERE) {
        const double length = sqrt(dot(point, point));
        for (int k = 0; k < 3; k++)
            direction[k] = point[k] / length;
        return;
    }
    if (e->kind == AG_LIGHT_DIRECTIONAL) {
        for (int k = 0; k < 3; k++)
            origin[k] += e->radius * (point[0] * e->axes[0][k] + point[1] * e->axes[1][k]);
        memcpy(direction, e->axes[2], 3 * sizeof *direction);
        return;
    }
    double rest;
    const double radius = hypot(point[0], point[1]);
    const double h = angle_of(e, radius, &rest);
    const double sine = sqrt(fmax(h * rest, 0)), cosine = h < rest ? 1 - h : rest - 1;
    double across[2] = { 0, 0 };
    for (int i = 0; i < 2 && radius > 0; i++)
        across[i] = sine * (point[i] / radius);
    for (int k = 0; k < 3; k++)
        direction[k] =
            across[0] * e->axes[0][k] + across[1] * e->axes[1][k] + cosine * e->axes[2][k];
}

double iir_emitter_section(const iir_emitter *e, const double point[3], double area,
                           double distance)
{
    if (e->kind == AG_LIGHT_DIRECTIONAL)
        return fmin(area, pi) * e->radius * e->radius;
    if (e->space == IIR_SPHERE)
        return fmin(area, 4 * pi) * distance * distance;
    // Of the ring's part of the disc as much as of its solid angle. Not narrower than leaves
    // digits.
    const double reach = fmax(sqrt(fmin(area, pi) / pi), 1e-6);
    const double radius = hypot(point[0], point[1]);
    const double r[2] = { fmax(radius - reach, 0), fmin(radius + reach, 1) };
    double rest;
    const double h = angle_of(e, r[1], &rest) - angle_of(e, r[0], &rest);
    const double solid_angle = 2 * fmin(area, pi) * h / ((r[1] - r[0]) * (r[1] + r[0]));
    return fmin(solid_angle, 2 * pi * e->rim) * distance * distance;
}
