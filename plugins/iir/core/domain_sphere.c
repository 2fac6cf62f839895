// SPDX-License-Identifier: MIT
// Voronoi cells of the sphere.
//
// An edge of the diagram is an arc of the great circle between two points, given by angles along it
// from the middle of the two. With a third point anywhere an edge is half of its circle at most.
//
// Sec. 4.6 says that the largest empty circle is always about a corner. It is not where all points
// are in one hemisphere: what is left is then the outside of the smallest circle about them, and
// that may touch only two. Its centre is opposite to the middle of these.
#include "domain_priv.h"

#include <math.h>
#include <string.h>

typedef double vec[3];

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double *out)
{
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

// False, and +z, if there is no direction in it.
static bool normalize(double *a)
{
    const double length = sqrt(dot(a, a));
    for (int k = 0; k < 3; ++k)
        a[k] = length > 0 ? a[k] / length : k == 2;
    return length > 0;
}

// Some direction across `a`, unit.
static void perpendicular(const double *a, double *out)
{
    vec axis = { 0 };
    int least = 0;
    for (int k = 1; k < 3; ++k)
        if (fabs(a[k]) < fabs(a[least]))
            least = k;
    axis[least] = 1;
    cross(a, axis, out);
    normalize(out);
}

// The corner of three cells, of points counter-clockwise as seen from outside: the normal of their
// plane. It is on the empty side of them even where that is the larger part of the sphere.
static void corner_of(const iir_domain *d, int a, int b, int c, double out[3])
{
    vec u, v;
    domain_rotate3(&a, &b, &c);
    for (int k = 0; k < 3; ++k) {
        u[k] = d->points[b][k] - d->points[a][k];
        v[k] = d->points[c][k] - d->points[a][k];
    }
    cross(u, v, out);
    normalize(out); // never 0: of points that far apart no three are on a line
}

static double corner_radius2(const iir_domain *d, int a, int b, int c, const double at[3])
{
    return fmin(domain_distance2(at, d->points[a]),
                fmin(domain_distance2(at, d->points[b]), domain_distance2(at, d->points[c])));
}

// The great circle between two points.
typedef struct bisector {
    vec middle, way;
    double tangents[2]; // of half the angles between it and the points: equal but for rounding
} bisector;

static bisector bisector_of(const double *p, const double *q)
{
    bisector b;
    vec u;
    for (int k = 0; k < 3; ++k) {
        u[k] = q[k] - p[k];
        b.middle[k] = p[k] + q[k];
    }
    const double length = sqrt(dot(u, u));
    normalize(u);
    const double off = dot(b.middle, u);
    for (int k = 0; k < 3; ++k)
        b.middle[k] -= off * u[k];
    // Antipodal points have all of the circle between them.
    if (dot(b.middle, b.middle) < 0x1p-94)
        perpendicular(u, b.middle);
    normalize(b.middle);
    cross(b.middle, u, b.way); // to the left as one goes from p to q
    // Points are unit to rounding only, so the plane is a little nearer to one of them: 1e-11 at
    // their least distance, which is 1e-6 of it.
    b.tangents[0] = 0.5 * (length - off) / (1 + fmax(0, dot(p, b.middle)));
    b.tangents[1] = 0.5 * (length + off) / (1 + fmax(0, dot(q, b.middle)));
    return b;
}

// Where a corner lies on a bisector: cosine and sine of an angle from the middle, times a length.
typedef struct place {
    double along[2];
} place;

static place place_of(const bisector *b, const double *corner)
{
    return (place){ { dot(corner, b->middle), dot(corner, b->way) } };
}

// Whether the edge from one place to another goes by the one opposite to the middle.
static bool goes_around(place right, place left)
{
    if (right.along[0] > 0 && left.along[0] > 0)
        return false;
    // The length of the edge is in [0, pi]: the difference is within rounding of that, or of that
    // less 2 pi.
    return atan2(left.along[1], left.along[0]) - atan2(right.along[1], right.along[0]) <
           -0.5 * M_PI;
}

// Between the way from a point to the middle, the bisector from there on to a corner, and the way
// back is a triangle with a right angle between its legs a and b: its area is e where
// tan(e / 2) = tan(a / 2) tan(b / 2). This is a vector at the angle e / 2, in [-pi / 2, pi / 2].
static place half_area(double tangent, place corner)
{
    const double x = corner.along[0], y = corner.along[1], length = sqrt(x * x + y * y);
    if (x >= 0)
        return (place){ { length + x, tangent * y } };
    return (place){ { fabs(y), tangent * copysign(length - x, y) } };
}

static double area_between(double tangent, place right, place left)
{
    const place a = half_area(tangent, right), b = half_area(tangent, left);
    return 2 * atan2(a.along[0] * b.along[1] - a.along[1] * b.along[0],
                     a.along[0] * b.along[0] + a.along[1] * b.along[1]);
}

// The same for corners that are well within the hemisphere about p: the triangle p, right, left by
// van Oosterom and Strackee's formula.
static double near_area(const double *p, const double *right, const double *left)
{
    vec a, b, normal;
    for (int k = 0; k < 3; ++k) { // differences: the triangle may be small
        a[k] = right[k] - p[k];
        b[k] = left[k] - p[k];
    }
    cross(a, b, normal);
    return 2 * atan2(dot(p, normal), 1 + dot(p, right) + dot(right, left) + dot(left, p));
}

// Corners before and after each edge of a ring of three or more.
typedef struct sphere_walk {
    const iir_domain *d;
    int id, size, next;
    int with, after; // the edge's other point, and the one that follows
    vec right, left;
} sphere_walk;

static sphere_walk walk_begin(const iir_domain *d, int id, int size)
{
    sphere_walk w = { .d = d, .id = id, .size = size, .after = d->ring[0] };
    corner_of(d, id, d->ring[size - 1], w.after, w.left);
    return w;
}

static bool walk_next(sphere_walk *w)
{
    if (w->next == w->size)
        return false;
    ++w->next;
    w->with = w->after;
    w->after = w->d->ring[w->next < w->size ? w->next : 0];
    memcpy(w->right, w->left, sizeof w->right);
    corner_of(w->d, w->id, w->with, w->after, w->left);
    return true;
}

static void offer_opposite(const iir_domain *d, int p, int q, const bisector *b, domain_cell *cell)
{
    const vec at = { -b->middle[0], -b->middle[1], -b->middle[2] };
    domain_cell_offer(cell, at,
                      fmin(domain_distance2(at, d->points[p]), domain_distance2(at, d->points[q])));
}

static void add_edge(const sphere_walk *w, int wanted, domain_cell *cell)
{
    const double *p = w->d->points[w->id], *q = w->d->points[w->with];
    if (dot(w->right, p) > 0.25 && dot(w->left, p) > 0.25) { // as most are
        if (wanted & DOMAIN_STALE_AREA)
            cell->area += near_area(p, w->right, w->left);
        return;
    }
    // From the point with the smaller id: the same bits from both sides.
    const int side = w->id < w->with ? 0 : 1;
    const bisector b = side ? bisector_of(q, p) : bisector_of(p, q);
    const place right = place_of(&b, side ? w->left : w->right);
    const place left = place_of(&b, side ? w->right : w->left);
    const bool around = goes_around(right, left);
    if (around && wanted & DOMAIN_STALE_RANK)
        offer_opposite(w->d, w->id, w->with, &b, cell);
    if (wanted & DOMAIN_STALE_AREA)
        cell->area += area_between(b.tangents[side], right, left) + (around ? 2 * M_PI : 0);
}

// One or two points.
static void fill_alone(const iir_domain *d, int id, int size, domain_cell *cell)
{
    const double *p = d->points[id];
    cell->area = size == 0 ? 4 * M_PI : 2 * M_PI;
    if (size == 0) {
        domain_cell_offer(cell, (vec){ -p[0], -p[1], -p[2] }, 4);
        return;
    }
    const int other = d->ring[0];
    const double *q = d->points[other];
    const bisector b = id < other ? bisector_of(p, q) : bisector_of(q, p);
    offer_opposite(d, id, other, &b, cell);
}

void domain_sphere_fill(const iir_domain *d, int id, int size, int wanted, domain_cell *cell)
{
    if (size < 2) {
        fill_alone(d, id, size, cell);
        return;
    }
    sphere_walk w = walk_begin(d, id, size);
    while (walk_next(&w)) {
        if (wanted & DOMAIN_STALE_RANK)
            domain_cell_offer(cell, w.left, corner_radius2(d, id, w.with, w.after, w.left));
        add_edge(&w, wanted, cell);
    }
}
