// SPDX-License-Identifier: MIT
#include "iir_points.h"

#include <math.h>
#include <string.h>

double points_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double) (*state >> 11) * 0x1p-53;
}

static double distance2(const double a[3], const double b[3])
{
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

static void spherical(double azimuth, double z, double out[3])
{
    const double radius = sqrt(fmax(0, 1 - z * z));
    out[0] = radius * cos(azimuth);
    out[1] = radius * sin(azimuth);
    out[2] = z;
}

void points_random_place(uint64_t *state, iir_space space, double out[3])
{
    const double azimuth = 2 * M_PI * points_random(state), share = points_random(state);
    if (space == IIR_SPHERE) {
        spherical(azimuth, 2 * share - 1, out);
        return;
    }
    out[0] = sqrt(share) * cos(azimuth);
    out[1] = sqrt(share) * sin(azimuth);
    out[2] = 0;
}

// About a place, within `width`.
static void scatter(uint64_t *state, iir_space space, const double about[3], double width,
                    double out[3])
{
    double length = 0;
    for (int k = 0; k < 3; ++k) {
        out[k] = about[k] + width * (points_random(state) - 0.5);
        if (space == IIR_DISC && k == 2)
            out[k] = 0;
        length += out[k] * out[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3 && (space == IIR_SPHERE || length > 1); ++k)
        out[k] /= length;
}

static void on_line(uint64_t *state, iir_space space, double off, double out[3])
{
    const double share = points_random(state);
    if (space == IIR_SPHERE) {
        spherical(2 * M_PI * share, off, out);
        return;
    }
    out[0] = sqrt(1 - off * off) * (2 * share - 1);
    out[1] = off;
    out[2] = 0;
}

static void on_circle(iir_space space, double share, double radius, double out[3])
{
    spherical(2 * M_PI * share, space == IIR_SPHERE ? sqrt(1 - radius * radius) : 0, out);
    for (int k = 0; k < 2 && space == IIR_DISC; ++k)
        out[k] *= radius;
}

static void on_lattice(iir_space space, int i, int count, double out[3])
{
    const int side = (int) ceil(sqrt((double) count));
    const double u = (i % side + 0.5) / side, v = (i / side + 0.5) / side;
    if (space == IIR_SPHERE) {
        spherical(2 * M_PI * u, 2 * v - 1, out);
        return;
    }
    out[0] = (2 * u - 1) * M_SQRT1_2;
    out[1] = (2 * v - 1) * M_SQRT1_2;
    out[2] = 0;
}

static void one_point(points_kind kind, iir_space space, uint64_t *state, int i, int count,
                      double out[3])
{
    static const double here[] = { 0.36, -0.48, 0.8 }, there[] = { -0.36, 0.48, -0.8 };
    static const double along[] = { 1e-9, 1.01 * IIR_DUPLICATE, 0 };
    switch (kind) {
    case POINTS_CLUSTER: scatter(state, space, here, 1e-3, out); break;
    case POINTS_TIGHT: scatter(state, space, here, 6 * IIR_DUPLICATE, out); break;
    case POINTS_TWO_CLUSTERS: scatter(state, space, i % 2 ? here : there, 1e-4, out); break;
    case POINTS_LATTICE: on_lattice(space, i, count, out); break;
    case POINTS_LINE: on_line(state, space, 0, out); break;
    case POINTS_CHORD: on_line(state, space, 0.625, out); break;
    case POINTS_LINE_AND_ONE: on_line(state, space, i == count / 2 ? 0.5 : 0, out); break;
    case POINTS_CIRCLE: on_circle(space, (double) i / count, 0.6, out); break;
    case POINTS_RIM: on_circle(space, points_random(state), 1, out); break;
    case POINTS_RIM_AND_INSIDE:
        points_random_place(state, space, out);
        out[2] = fabs(out[2]);
        if (i % 2)
            on_circle(space, points_random(state), 1, out);
        break;
    case POINTS_CHAIN:
        for (int k = 0; k < 3; ++k)
            out[k] = here[k] + i * along[k];
        break;
    case POINTS_SAME: memcpy(out, here, 3 * sizeof *out); break;
    default: points_random_place(state, space, out); break;
    }
}

void points_make(points_kind kind, iir_space space, uint64_t *state, int count, double (*out)[3])
{
    for (int i = 0; i < count; ++i) {
        one_point(kind, space, state, i, count, out[i]);
        for (int k = 0; k < 3 && i % 2 && kind == POINTS_ANTIPODAL; ++k)
            out[i][k] = -out[i - 1][k];
        if (i % 2 && kind == POINTS_TWINS)
            scatter(state, space, out[i - 1], 1e-12, out[i]);
    }
}

// ---- by brute force --------------------------------------------------------------------------

void points_corners_of(const iir_domain *d, int capacity, points_corners *out)
{
    out->count = 0;
    for (int id = 0; id < capacity; ++id) {
        if (!iir_domain_has(d, id) || iir_domain_duplicate_of(d, id) >= 0)
            continue;
        out->ids[out->count] = id;
        iir_domain_point(d, id, out->at[out->count++]);
    }
}

double points_nearest(const points_corners *c, const double place[3], int *which)
{
    double least = INFINITY;
    for (int i = 0; i < c->count; ++i) {
        const double distance = distance2(c->at[i], place);
        if (distance < least) {
            least = distance;
            *which = i;
        }
    }
    return sqrt(least);
}

double points_least_distance(const points_corners *c)
{
    double least = INFINITY;
    for (int i = 0; i < c->count; ++i)
        for (int k = 0; k < i; ++k)
            least = fmin(least, distance2(c->at[i], c->at[k]));
    return sqrt(least);
}

// How much of the bisector of p and q is as near to them as to all others: the length of the edge
// between them, negative by how much it is missed.
//
// The bisector is middle + s way, s real, in the plane. On the sphere, seen from its centre, it is
// the circle cos(s) middle + sin(s) way; each third point leaves half of it.
static double disc_edge(const points_corners *c, int p, int q)
{
    const double *a = c->at[p], *b = c->at[q];
    const double middle[] = { (a[0] + b[0]) / 2, (a[1] + b[1]) / 2 };
    const double length = sqrt(distance2(a, b));
    const double way[] = { (a[1] - b[1]) / length, (b[0] - a[0]) / length };
    double from = -INFINITY, to = INFINITY;
    for (int i = 0; i < c->count; ++i) {
        if (i == p || i == q)
            continue;
        const double r[] = { c->at[i][0] - middle[0], c->at[i][1] - middle[1] };
        // |s way - r|^2 >= length^2 / 4 + s^2
        const double along = r[0] * way[0] + r[1] * way[1];
        const double rest = (r[0] * r[0] + r[1] * r[1] - length * length / 4) / 2;
        if (along > 0)
            to = fmin(to, rest / along);
        else if (along < 0)
            from = fmax(from, rest / along);
        else if (rest < 0)
            return -1;
    }
    return to - from;
}

static double sphere_edge(const points_corners *c, int p, int q)
{
    const double *a = c->at[p], *b = c->at[q];
    double u[3], middle[3], way[3], norm = 0;
    for (int k = 0; k < 3; ++k)
        u[k] = b[k] - a[k];
    const int axis = fabs(u[0]) < fabs(u[1]) ? 0 : 1; // not along u
    const double uu = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    for (int k = 0; k < 3; ++k) {
        middle[k] = (k == axis) - u[axis] * u[k] / uu;
        norm += middle[k] * middle[k];
    }
    for (int k = 0; k < 3; ++k)
        middle[k] /= sqrt(norm);
    for (int k = 0; k < 3; ++k)
        way[k] = (u[(k + 1) % 3] * middle[(k + 2) % 3] - u[(k + 2) % 3] * middle[(k + 1) % 3]) /
                 sqrt(uu);
    // Half circles about angles: what is common to all is an interval about the first, or nothing.
    double first = 0, from = -M_PI, to = M_PI;
    bool any = false;
    for (int i = 0; i < c->count; ++i) {
        if (i == p || i == q)
            continue;
        const double *r = c->at[i];
        double x = 0, y = 0;
        for (int k = 0; k < 3; ++k) {
            x += (a[k] - r[k]) * middle[k];
            y += (a[k] - r[k]) * way[k];
        }
        const double angle = atan2(y, x);
        if (!any) {
            first = angle;
            from = -M_PI / 2;
            to = M_PI / 2;
            any = true;
            continue;
        }
        const double turned = remainder(angle - first, 2 * M_PI);
        from = fmax(from, turned - M_PI / 2);
        to = fmin(to, turned + M_PI / 2);
    }
    return to - from;
}

// Squared distance to the second closest neighbour; edges shorter than `least` count as none.
static double second_distance(const points_corners *c, iir_space space, int p, double least)
{
    double near[2] = { INFINITY, INFINITY };
    for (int q = 0; q < c->count; ++q) {
        if (q == p)
            continue;
        const double distance = distance2(c->at[p], c->at[q]);
        if (distance >= near[1] ||
            (space == IIR_DISC ? disc_edge(c, p, q) : sphere_edge(c, p, q)) < least)
            continue;
        near[1] = fmax(near[0], distance);
        near[0] = fmin(near[0], distance);
    }
    return near[1];
}

static double nearest_distance2(const points_corners *c, int p)
{
    double least = INFINITY;
    for (int i = 0; i < c->count; ++i)
        if (i != p)
            least = fmin(least, distance2(c->at[i], c->at[p]));
    return least;
}

bool points_redundant(const points_corners *c, iir_space space, int id)
{
    double least = INFINITY, best = INFINITY, lowest = INFINITY;
    int first = -1, who = -1;
    for (int i = 0; i < c->count; ++i)
        least = fmin(least, nearest_distance2(c, i));
    for (int i = 0; i < c->count; ++i) {
        if (nearest_distance2(c, i) > least)
            continue;
        // Edges that are not longer than rounding may be there or not.
        const double sure = second_distance(c, space, i, 1e-9);
        if (sure < best || (sure == best && c->ids[i] > first)) {
            best = sure;
            first = c->ids[i];
        }
        if (c->ids[i] == id) {
            who = i;
            lowest = second_distance(c, space, i, -1e-9);
        }
    }
    return who >= 0 && (first == id || lowest < best);
}
