// SPDX-License-Identifier: MIT
#ifndef IIR_DOMAIN_H
#define IIR_DOMAIN_H

#include <fg/base.h>

FG_BEGIN

// A point set on the unit disc or the unit sphere, with the Delaunay triangulation that says which
// points are crowded, where there is most room, and how much of the domain each stands for:
//
//     iir_domain *d = iir_domain_create(&(iir_domain_desc){ .space = IIR_DISC, .capacity = 256 });
//     iir_domain_set(d, points, ids, count);                // all at once
//     int id = iir_domain_redundant(d);                     // the one to take away (sec. 4.5)
//     iir_domain_remove(d, id);
//     double centre[3], radius = iir_domain_largest_empty_circle(d, centre);
//     iir_domain_insert(d, id, centre);                     // the one to add (sec. 4.6)
//     iir_domain_areas(d, areas);                           // Voronoi cells (sec. 4.7)
//     iir_domain_destroy(d);
//
// Points of the disc have |p| <= 1 and p[2] 0, of the sphere |p| = 1; what is off by rounding is
// brought back. Distances are Euclidean, of the sphere through space. A point is known by an id of
// the caller's in [0, capacity).
//
// Two points nearer to each other than IIR_DUPLICATE are too near to tell apart. The later one, of
// points set at once the one with the larger index, is then a duplicate: it counts, can be removed,
// has no area, and takes over should the first be removed.
//
// Deterministic: equal calls in equal order give equal bits. Memory is that of the largest number
// of points so far; CGAL's transient lists apart, see delaunay_bridge.h.
//
// Source: Laine, Saransaari, Kontkanen, Lehtinen, Aila. Incremental Instant Radiosity for
//         Real-Time Indirect Illumination. EGSR 2007, sec. 4.1 to 4.7.
//         Departs from sec. 4.6: on the disc finite Voronoi edges meet the rim too; on the sphere,
//         if all points are in one hemisphere, the centre may be on an edge instead of a corner.
// Thread: one at a time on a domain; different domains on any.
#define IIR_DUPLICATE 0x1p-16

typedef enum iir_space {
    IIR_DISC = 0,
    IIR_SPHERE,
} iir_space;

typedef enum iir_triangulation {
    IIR_TRIANGULATION_DEFAULT = 0, // of the plane; of the sphere's surface
    IIR_TRIANGULATION_TETRA,       // SPHERE: the paper's, by a tetrahedralization; to compare
} iir_triangulation;

typedef struct iir_domain iir_domain;

typedef struct iir_domain_desc {
    iir_space space;
    iir_triangulation triangulation;
    int capacity; // points at most, > 0
} iir_domain_desc;

// NULL: out of memory.
iir_domain *iir_domain_create(const iir_domain_desc *desc);
void iir_domain_destroy(iir_domain *d); // accepts NULL

// Replaces all points; count 0 empties. Cheaper than one after the other.
//
// Errors of this and the next: FG_ERR_MEMORY; FG_ERR_INVALID for an id that is out of range or in
// use, a point that is not finite, and the origin as a point of the sphere. iir_domain_insert()
// then changes nothing where it is FG_ERR_INVALID, and in all other cases the domain is empty.
FG_NODISCARD fg_status iir_domain_set(iir_domain *d, const double (*points)[3], const int *ids,
                                      int count);
FG_NODISCARD fg_status iir_domain_insert(iir_domain *d, int id, const double point[3]);
// Nothing happens where there is no such point. Should memory run out the domain is empty.
void iir_domain_remove(iir_domain *d, int id);

int iir_domain_count(const iir_domain *d); // duplicates too
bool iir_domain_has(const iir_domain *d, int id);
void iir_domain_point(const iir_domain *d, int id, double out[3]);
int iir_domain_duplicate_of(const iir_domain *d, int id); // -1: it is none

// The point that the deletion rule takes: of the shortest Delaunay edge's two ends the one whose
// second closest neighbour is nearer; of equal ones the larger id. A duplicate before all others.
// -1: fewer than two points.
int iir_domain_redundant(iir_domain *d);

// Centre and radius of the largest circle that holds no point and whose centre is in the domain;
// the radius is the dispersion (eq. 1). Without points: the disc's centre or +z, and the radius of
// a circle that covers all: 1; of the sphere 2.
double iir_domain_largest_empty_circle(iir_domain *d, double centre[3]);

// Areas of the Voronoi cells, cut off at the disc's rim, by id; 0 for ids without a point and for
// duplicates. They sum to pi or 4 pi. Without points all are 0.
void iir_domain_areas(iir_domain *d, double *areas); // [capacity]

// Least distance between two points that are no duplicates; INFINITY with fewer than two.
double iir_domain_least_distance(iir_domain *d);

FG_END

#endif // IIR_DOMAIN_H
