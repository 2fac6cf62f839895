// SPDX-License-Identifier: MIT
#include "iir_points.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>

static double distance2(const double a[3], const double b[3])
{
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

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
    double least = HUGE_VAL;
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
    double least = HUGE_VAL;
    for (int i = 0; i < c->count; ++i)
        for (int k = 0; k < i; ++k)
            least = fmin(least, distance2(c->at[i], c->at[k]));
    return sqrt(least);
}

int points_pairs_at(const points_corners *c, double distance)
{
    int pairs = 0;
    for (int i = 0; i < c->count; ++i)
        for (int k = 0; k < i; ++k)
            pairs += sqrt(distance2(c->at[i], c->at[k])) == distance;
    return pairs;
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
    double from = -HUGE_VAL, to = HUGE_VAL;
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
    double near[2] = { HUGE_VAL, HUGE_VAL };
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
    double least = HUGE_VAL;
    for (int i = 0; i < c->count; ++i)
        if (i != p)
            least = fmin(least, distance2(c->at[i], c->at[p]));
    return least;
}

bool points_redundant(const points_corners *c, iir_space space, int id)
{
    double least = HUGE_VAL, best = HUGE_VAL, lowest = HUGE_VAL;
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

// ---- what holds of every domain --------------------------------------------------------------

static double areas[POINTS_MAX];
static points_corners corners;

void points_areas_hold(const points_case *c)
{
    double sum = 0;
    iir_domain_areas(c->d, areas);
    for (int id = 0; id < c->capacity; ++id) {
        const bool corner = iir_domain_has(c->d, id) && iir_domain_duplicate_of(c->d, id) < 0;
        if (corner ? !(areas[id] > 0) : areas[id] != 0)
            fail_msg("%s, %s: the cell of %d is %g", c->back->name, c->what, id, areas[id]);
        sum += areas[id];
    }
    const double whole = c->back->space == IIR_DISC ? M_PI : 4 * M_PI;
    const double all = iir_domain_count(c->d) > 0 ? whole : 0;
    if (!(fabs(sum - all) <= 1e-9))
        fail_msg("%s, %s, %d points: areas sum to %.17g, off by %g", c->back->name, c->what,
                 iir_domain_count(c->d), sum, sum - all);
}

void points_circle_holds(const points_case *c, int probes)
{
    int which = -1;
    double centre[3], place[3];
    const double radius = iir_domain_largest_empty_circle(c->d, centre);
    points_corners_of(c->d, c->capacity, &corners);
    if (corners.count == 0)
        return;
    const double norm = sqrt(centre[0] * centre[0] + centre[1] * centre[1] + centre[2] * centre[2]);
    assert_true(norm <= 1 + 1e-15 && (c->back->space == IIR_DISC || norm >= 1 - 1e-15));
    const double nearest = points_nearest(&corners, centre, &which);
    if (!(fabs(nearest - radius) <= POINTS_SLACK))
        fail_msg("%s, %s, %d: the circle has radius %.17g, its next point is at %.17g",
                 c->back->name, c->what, corners.count, radius, nearest);
    for (int i = 0; i < probes; ++i) {
        points_random_place(c->random, c->back->space, place);
        const double distance = points_nearest(&corners, place, &which);
        if (distance > radius + POINTS_SLACK)
            fail_msg("%s, %s, %d: %g at (%g %g %g) beats %g", c->back->name, c->what, corners.count,
                     distance, place[0], place[1], place[2], radius);
    }
}

void points_deletion_holds(const points_case *c)
{
    int same = -1;
    const int id = iir_domain_redundant(c->d);
    if (iir_domain_count(c->d) < 2) {
        assert_int_equal(id, -1);
        return;
    }
    for (int i = 0; i < c->capacity; ++i)
        if (iir_domain_duplicate_of(c->d, i) >= 0)
            same = i;
    if (same >= 0) {
        assert_int_equal(id, same);
        return;
    }
    points_corners_of(c->d, c->capacity, &corners);
    assert_true(iir_domain_least_distance(c->d) == points_least_distance(&corners));
    if (!points_redundant(&corners, c->back->space, id))
        fail_msg("%s, %s, %d points: %d is not the one to take", c->back->name, c->what,
                 corners.count, id);
}
