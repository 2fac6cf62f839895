// SPDX-License-Identifier: MIT
// Voronoi cells of the disc: where they end inside of it, where at its rim.
//
// An edge of the diagram is a part of the bisector of two points, given by distances along it from
// the middle between the two. Which way the edge runs is known from the triangulation, so nothing
// breaks where three points are almost on a line and the corner is far outside or at infinity.
// Points are IIR_DUPLICATE apart at least: a bisector meets the rim at two places that are 8e-3
// apart or more, so an edge that leaves the disc does so at a place that is well known.
#include "domain_priv.h"

#include <math.h>
#include <string.h>

typedef double vec[2];

typedef struct disc_corner {
    bool inside; // of the disc; all else is of no use otherwise
    double at[3];
    double radius2;
} disc_corner;

// As seen from one of the two points: counter-clockwise about it.
typedef struct disc_edge {
    bool there; // in the disc
    bool ends_at_rim[2];
    double ends[2][3];
    double radius2[2]; // of the circles about the ends, where these are at the rim
} disc_edge;

static double cross(const double *a, const double *b)
{
    return a[0] * b[1] - a[1] * b[0];
}

static double cross_from(const double *o, const double *a, const double *b)
{
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1];
}

static disc_corner corner_of(const iir_domain *d, int a, int b, int c)
{
    disc_corner out = { 0 };
    if (b < 0 || c < 0)
        return out;
    domain_rotate3(&a, &b, &c);
    const double *o = d->points[a];
    const vec u = { d->points[b][0] - o[0], d->points[b][1] - o[1] };
    const vec v = { d->points[c][0] - o[0], d->points[c][1] - o[1] };
    const double twice = 2 * cross(u, v), uu = dot(u, u), vv = dot(v, v);
    if (!(twice > 0)) // on a line but for rounding
        return out;
    out.at[0] = o[0] + (uu * v[1] - vv * u[1]) / twice;
    out.at[1] = o[1] + (vv * u[0] - uu * v[0]) / twice;
    out.inside = dot(out.at, out.at) < 1;
    out.radius2 = fmin(domain_distance2(out.at, o), fmin(domain_distance2(out.at, d->points[b]),
                                                         domain_distance2(out.at, d->points[c])));
    return out;
}

// Where on the bisector of p and q the corner with r on the given side (1: left) lies: half their
// distance times the cotangent of the angle at r.
static double corner_along(const iir_domain *d, int p, int q, int r, double side)
{
    if (r < 0)
        return side * (double) INFINITY;
    const double *a = d->points[p], *b = d->points[q], *c = d->points[r];
    const vec u = { a[0] - c[0], a[1] - c[1] }, v = { b[0] - c[0], b[1] - c[1] };
    const double turn = side * cross(u, v), cosine = dot(u, v);
    if (!(turn > 0))
        return copysign(HUGE_VAL, side * cosine);
    return side * 0.5 * sqrt(domain_distance2(a, b)) * cosine / turn;
}

// The bisector of p and q: the middle, and at which distances along `way` from it the rim is.
typedef struct bisector {
    double length; // from p to q
    vec middle, way;
    double centre; // the disc's, projected on it
    double half;   // of the chord
} bisector;

static bisector bisector_of(const double *p, const double *q)
{
    bisector b;
    b.length = sqrt(domain_distance2(p, q)); // > 0: no duplicates
    for (int k = 0; k < 2; ++k)
        b.middle[k] = 0.5 * (p[k] + q[k]);
    b.way[0] = -(q[1] - p[1]) / b.length;
    b.way[1] = (q[0] - p[0]) / b.length;
    b.centre = -dot(b.middle, b.way);
    const double off = cross(b.middle, b.way);
    b.half = sqrt(fmax(0, 1 - off * off));
    return b;
}

static void rim_end(const iir_domain *d, int p, int q, const bisector *b, disc_edge *edge, int end)
{
    double *at = edge->ends[end];
    const double along = end ? b->centre + b->half : b->centre - b->half;
    at[0] = b->middle[0] + along * b->way[0];
    at[1] = b->middle[1] + along * b->way[1];
    const double norm = hypot(at[0], at[1]); // 1 but for rounding
    at[0] /= norm;
    at[1] /= norm;
    at[2] = 0;
    edge->ends_at_rim[end] = true;
    edge->radius2[end] =
        fmin(domain_distance2(at, d->points[p]), domain_distance2(at, d->points[q]));
}

// The edge between p and q, from the corner on the right of the way from p to q to the one on its
// left, r[0] and r[1] being the third points; -1 beyond the hull.
static disc_edge edge_between(const iir_domain *d, int p, int q, const int r[2],
                              const disc_corner *corners[2])
{
    disc_edge edge = { 0 };
    const bisector b = bisector_of(d->points[p], d->points[q]);
    const bool in[2] = { corners[0]->inside, corners[1]->inside };
    edge.there =
        in[0] || in[1] ||
        (corner_along(d, p, q, r[0], -1) < b.centre && corner_along(d, p, q, r[1], 1) > b.centre);
    if (!edge.there)
        return edge;
    for (int k = 0; k < 2; ++k)
        if (in[k])
            memcpy(edge.ends[k], corners[k]->at, sizeof edge.ends[k]);
        else
            rim_end(d, p, q, &b, &edge, k);
    return edge;
}

static disc_edge edge_seen_from(const iir_domain *d, int p, int q, const int r[2],
                                const disc_corner *right, const disc_corner *left)
{
    disc_edge out = { .there = true };
    if (right->inside && left->inside) { // most are
        memcpy(out.ends[0], right->at, sizeof right->at);
        memcpy(out.ends[1], left->at, sizeof left->at);
        return out;
    }
    if (p < q)
        return edge_between(d, p, q, r, (const disc_corner *[]){ right, left });
    const disc_edge e =
        edge_between(d, q, p, (int[]){ r[1], r[0] }, (const disc_corner *[]){ left, right });
    out.there = e.there;
    for (int k = 0; k < 2; ++k) {
        out.ends_at_rim[k] = e.ends_at_rim[1 - k];
        out.radius2[k] = e.radius2[1 - k];
        memcpy(out.ends[k], e.ends[1 - k], sizeof out.ends[k]);
    }
    return out;
}

// Goes around a cell: the edges with the corners that they lead to.
typedef struct disc_walk {
    const iir_domain *d;
    int id, size, next;
    disc_corner right, left; // of the edge last given
} disc_walk;

static disc_walk walk_begin(const iir_domain *d, int id, int size)
{
    disc_walk w = { .d = d, .id = id, .size = size };
    if (size > 0)
        w.left = corner_of(d, id, d->ring[size - 1], d->ring[0]);
    return w;
}

static bool walk_next(disc_walk *w, disc_edge *edge)
{
    const int *ring = w->d->ring;
    if (w->next == w->size)
        return false;
    const int i = w->next++;
    const int before = ring[(i + w->size - 1) % w->size], after = ring[(i + 1) % w->size];
    w->right = w->left;
    *edge = (disc_edge){ 0 };
    if (ring[i] < 0) {
        w->left = (disc_corner){ 0 };
        return true;
    }
    w->left = corner_of(w->d, w->id, ring[i], after);
    *edge =
        edge_seen_from(w->d, w->id, ring[i], (const int[]){ before, after }, &w->right, &w->left);
    return true;
}

// Case 3 of sec. 4.6: the cell holds all of the segment from its point through the origin to the
// rim. It then holds the origin, so that none of its neighbours is nearer to that.
static void offer_far_rim(const iir_domain *d, int id, int size, domain_cell *cell)
{
    const double *p = d->points[id];
    const double norm = hypot(p[0], p[1]);
    double rim[3] = { 1, 0, 0 }; // any place serves for a point at the origin
    for (int i = 0; i < size; ++i)
        if (d->ring[i] >= 0 && dot(d->points[d->ring[i]], d->points[d->ring[i]]) < norm * norm)
            return;
    if (norm > 0) {
        rim[0] = -p[0] / norm;
        rim[1] = -p[1] / norm;
    }
    if (domain_cell_holds(d, id, size, rim))
        domain_cell_offer(cell, rim, domain_distance2(rim, p));
}

static void offer_edge(const disc_walk *w, const disc_edge *edge, domain_cell *cell)
{
    if (w->left.inside) // case 1
        domain_cell_offer(cell, w->left.at, w->left.radius2);
    for (int k = 0; k < 2; ++k) // case 2, of finite edges too
        if (edge->there && edge->ends_at_rim[k])
            domain_cell_offer(cell, edge->ends[k], edge->radius2[k]);
}

// x - sin x without cancellation.
static double less_sine(double x)
{
    const double xx = x * x;
    if (fabs(x) > 0.5)
        return x - sin(x);
    // The next term is x^13 / 13!: 2e-14 of the first at 0.5.
    return x * xx / 6 *
           (1 - xx / 20 * (1 - xx / 42 * (1 - xx / 72 * (1 - xx / 110 * (1 - xx / 156)))));
}

// Between a point and the rim from one place to another, counter-clockwise: a triangle and a
// segment of the circle.
static double fan_area(const double *p, const double *from, const double *to)
{
    double angle = atan2(cross(from, to), dot(from, to));
    // An arc that is there leaves 8e-3 of the rim at least to others; one of length 0 may be
    // negative by rounding.
    if (angle < -1e-3)
        angle += 2 * M_PI;
    return 0.5 * less_sine(angle) + 0.5 * cross_from(p, from, to);
}

// What a cell has of the disc, added up while going around it.
typedef struct disc_sum {
    double area;
    bool entered, outside; // came in by the rim before having left by it; has left by it last
    double entry[3], exit[3];
} disc_sum;

static void add_edge(disc_sum *sum, const double *p, const disc_edge *edge)
{
    if (!edge->there)
        return;
    sum->area += 0.5 * cross_from(p, edge->ends[0], edge->ends[1]);
    if (edge->ends_at_rim[0] && sum->outside) {
        sum->area += fan_area(p, sum->exit, edge->ends[0]);
        sum->outside = false;
    } else if (edge->ends_at_rim[0]) {
        memcpy(sum->entry, edge->ends[0], sizeof sum->entry);
        sum->entered = true;
    }
    if (edge->ends_at_rim[1]) {
        memcpy(sum->exit, edge->ends[1], sizeof sum->exit);
        sum->outside = true;
    }
}

void domain_disc_fill(const iir_domain *d, int id, int size, int wanted, domain_cell *cell)
{
    disc_edge edge;
    disc_sum sum = { 0 };
    disc_walk w = walk_begin(d, id, size);
    while (walk_next(&w, &edge)) {
        if (wanted & DOMAIN_STALE_RANK)
            offer_edge(&w, &edge, cell);
        if (wanted & DOMAIN_STALE_AREA)
            add_edge(&sum, d->points[id], &edge);
    }
    if (wanted & DOMAIN_STALE_RANK)
        offer_far_rim(d, id, size, cell);
    if (sum.entered && sum.outside)
        sum.area += fan_area(d->points[id], sum.exit, sum.entry);
    if (wanted & DOMAIN_STALE_AREA)
        cell->area = size > 0 ? sum.area : M_PI;
}
