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
    // Points are unit to rounding only, which at their least distance moves the plane a little off
    // the middle. Taking that into account keeps the areas' sum.
    b.tangents[0] = 0.5 * (length - off) / (1 + fmax(0, dot(p, b.middle)));
    b.tangents[1] = 0.5 * (length + off) / (1 + fmax(0, dot(q, b.middle)));
    return b;
}

// The area between the way from a point to the middle, the bisector from there on to a corner at an
// angle in [-pi, pi], and the way back: a triangle with a right angle between legs a and b, for
// which tan(area / 2) = tan(a / 2) tan(b / 2).
static double area_up_to(double tangent, double angle)
{
    return 2 * atan2(tangent * sin(0.5 * angle), cos(0.5 * angle));
}

// The edge from the corner `right` of the way from p to q to the one to its left.
typedef struct arc {
    bisector b;
    double angles[2];
    bool around; // by the place opposite to the middle
} arc;

static arc arc_between(const double *p, const double *q, const double *right, const double *left)
{
    arc a = { .b = bisector_of(p, q) };
    const double *corners[2] = { right, left };
    for (int k = 0; k < 2; ++k)
        a.angles[k] = atan2(dot(corners[k], a.b.way), dot(corners[k], a.b.middle));
    // The length of the edge is in [0, pi]: the difference is within rounding of that, or of that
    // less 2 pi.
    a.around = a.angles[1] - a.angles[0] < -0.5 * M_PI;
    return a;
}

// Corners before and after each edge of a ring of three or more.
typedef struct sphere_walk {
    const iir_domain *d;
    int id, size, next;
    vec right, left;
} sphere_walk;

static sphere_walk walk_begin(const iir_domain *d, int id, int size)
{
    sphere_walk w = { .d = d, .id = id, .size = size };
    corner_of(d, id, d->ring[size - 1], d->ring[0], w.left);
    return w;
}

static bool walk_next(sphere_walk *w, arc *edge, int *with, int *after)
{
    if (w->next == w->size)
        return false;
    const int i = w->next++;
    *with = w->d->ring[i];
    *after = w->d->ring[(i + 1) % w->size];
    memcpy(w->right, w->left, sizeof w->right);
    corner_of(w->d, w->id, *with, *after, w->left);
    const double *p = w->d->points[w->id], *q = w->d->points[*with];
    // From the point with the smaller id: the same bits from both sides.
    *edge =
        w->id < *with ? arc_between(p, q, w->right, w->left) : arc_between(q, p, w->left, w->right);
    return true;
}

static void offer_opposite(const iir_domain *d, int p, int q, const double *middle,
                           domain_cell *cell)
{
    const vec at = { -middle[0], -middle[1], -middle[2] };
    domain_cell_offer(cell, at,
                      fmin(domain_distance2(at, d->points[p]), domain_distance2(at, d->points[q])));
}

void domain_sphere_rank(const iir_domain *d, int id, int size, domain_cell *cell)
{
    const double *p = d->points[id];
    if (size == 0) {
        domain_cell_offer(cell, (vec){ -p[0], -p[1], -p[2] }, 4);
        return;
    }
    if (size == 1) {
        const double *q = d->points[d->ring[0]];
        const bisector b = id < d->ring[0] ? bisector_of(p, q) : bisector_of(q, p);
        offer_opposite(d, id, d->ring[0], b.middle, cell);
        return;
    }
    arc edge;
    int with, after;
    sphere_walk w = walk_begin(d, id, size);
    while (walk_next(&w, &edge, &with, &after)) {
        domain_cell_offer(cell, w.left, corner_radius2(d, id, with, after, w.left));
        if (edge.around)
            offer_opposite(d, id, with, edge.b.middle, cell);
    }
}

double domain_sphere_area(const iir_domain *d, int id, int size)
{
    if (size < 2)
        return size == 0 ? 4 * M_PI : 2 * M_PI;
    arc edge;
    int with, after;
    double area = 0;
    sphere_walk w = walk_begin(d, id, size);
    while (walk_next(&w, &edge, &with, &after)) {
        const double tangent = edge.b.tangents[id < with ? 0 : 1];
        area += area_up_to(tangent, edge.angles[1]) - area_up_to(tangent, edge.angles[0]) +
                (edge.around ? 2 * M_PI : 0);
    }
    return area;
}
