// SPDX-License-Identifier: MIT
#ifndef TESTS_IIR_POINTS_H
#define TESTS_IIR_POINTS_H

#include <domain.h>

// Point sets that are meant to break triangulations, and what is true of them by brute force.
typedef enum points_kind {
    POINTS_UNIFORM = 0,
    POINTS_CLUSTER,        // 1e-3 wide
    POINTS_TIGHT,          // a few IIR_DUPLICATE wide
    POINTS_TWO_CLUSTERS,   // 1e-4 wide, opposite to each other
    POINTS_LATTICE,        // square; parallels and meridians
    POINTS_LINE,           // through the centre; a great circle
    POINTS_CHORD,          // beside the centre; a small circle
    POINTS_LINE_AND_ONE,   // and a point off it
    POINTS_CIRCLE,         // about the centre, evenly; a parallel
    POINTS_RIM,            // at random; the equator
    POINTS_RIM_AND_INSIDE, // half of them; the equator and the northern half
    POINTS_ANTIPODAL,
    POINTS_TWINS, // each twice, 1e-12 apart
    POINTS_CHAIN, // on a line, a little more than IIR_DUPLICATE apart
    POINTS_SAME,
    POINTS_KINDS,
} points_kind;

enum { POINTS_MAX = 4096 };

double points_random(uint64_t *state); // [0, 1)
void points_random_place(uint64_t *state, iir_space space, double out[3]);
void points_make(points_kind kind, iir_space space, uint64_t *state, int count, double (*out)[3]);

typedef struct points_back {
    iir_space space;
    iir_triangulation triangulation;
    const char *name;
} points_back;

enum { POINTS_DISC, POINTS_SPHERE, POINTS_TETRA, POINTS_BACKS };

extern const points_back points_backs[POINTS_BACKS];
iir_domain *points_domain(const points_back *back, int capacity); // never NULL
// With ids 0, 1, 2, ...
void points_set(iir_domain *d, double (*points)[3], int count);
int points_free_id(const iir_domain *d);

// The domain's points that are no duplicates.
typedef struct points_corners {
    int count;
    int ids[POINTS_MAX];
    double at[POINTS_MAX][3];
} points_corners;

void points_corners_of(const iir_domain *d, int capacity, points_corners *out);
double points_nearest(const points_corners *c, const double place[3], int *which); // the distance
double points_least_distance(const points_corners *c);
int points_pairs_at(const points_corners *c, double distance); // exactly that far apart
// Whether `id` is what the deletion rule takes, or as good as that within rounding.
bool points_redundant(const points_corners *c, iir_space space, int id);

// Corners of the thinnest triangles there can be, of points IIR_DUPLICATE = d apart on a circle of
// radius 1, are known to 2^-53 d^2 / (d^3 / 8) = 6e-11 of their distance.
#define POINTS_SLACK 1e-9

typedef struct points_case {
    iir_domain *d;
    const points_back *back;
    int capacity;
    uint64_t *random;
    const char *what; // for messages
} points_case;

void points_areas_hold(const points_case *c); // positive but of duplicates; their sum
// The circle is empty, and none of so many random places is farther from all points.
void points_circle_holds(const points_case *c, int probes);
void points_deletion_holds(const points_case *c); // the rule, the least distance

#endif // TESTS_IIR_POINTS_H
