// SPDX-License-Identifier: MIT
// C face of delaunay_bridge.cpp. Nothing else includes a CGAL header.
#ifndef IIR_DELAUNAY_BRIDGE_H
#define IIR_DELAUNAY_BRIDGE_H

#include <fg/base.h>

FG_BEGIN

// Who is whose neighbour in a Delaunay triangulation of points that carry ids; nothing metric.
//
//     delaunay *t = delaunay_create(DELAUNAY_SPHERE, 256);
//     delaunay_insert_all(t, points, ids, count);
//     int ring[2 * 256], size = delaunay_ring(t, id, ring);
//     delaunay_destroy(t);
//
// Points must lie 2^-16 apart at least. Those of the sphere must be unit to a few units in the last
// place: they are then the corners of their convex hull, whose facets are the triangles.
//
// Predicates are exact. Where four points lie on a circle, plane and sphere choose as if points
// were moved a little, the same way whatever the order in which they came.
//
// Memory: what removed points leave is used again, by delaunay_clear() too. CGAL makes a few lists
// while it removes a point, in space also while it inserts one or looks for a ring, and a list of
// the points on the hull of the plane that it inserts one beyond; they do not outlive the call.
typedef enum delaunay_kind {
    DELAUNAY_PLANE = 0, // points[2] is not looked at
    DELAUNAY_SPHERE,
    DELAUNAY_TETRA, // the same hull, as the boundary of a tetrahedralization
} delaunay_kind;

typedef struct delaunay delaunay;

// Ids are in [0, capacity). NULL: out of memory.
delaunay *delaunay_create(delaunay_kind kind, int capacity);
void delaunay_destroy(delaunay *t); // accepts NULL

// After an error of any of these only delaunay_destroy() may follow. (And CGAL 5.5 leaves a table
// of the thread's in disorder if memory runs out in space: no DELAUNAY_TETRA works there any more.)
//
// Errors: FG_ERR_MEMORY; FG_ERR_INVALID where points are nearer to each other than allowed.
FG_NODISCARD fg_status delaunay_clear(delaunay *t);
// `near`: a point that may lie near it, -1: none known. Changes no result.
FG_NODISCARD fg_status delaunay_insert(delaunay *t, int id, const double point[3], int near);
// points by id; in an order along a space-filling curve.
FG_NODISCARD fg_status delaunay_insert_all(delaunay *t, const double (*points)[3], const int *ids,
                                           int count);
FG_NODISCARD fg_status delaunay_remove(delaunay *t, int id);

// Neighbours of a point, counter-clockwise (on the sphere: seen from outside), and how many entries
// there are; `ring` must hold 2 capacity of them. Two that follow each other make a triangle with
// the point; the last is followed by the first. -1 stands for what lies beyond the hull of the
// plane, between any two neighbours if all points are on a line. On the sphere two points have each
// other and one has none; four in one plane or more may come twice from DELAUNAY_TETRA.
//
// -1: memory ran out; DELAUNAY_TETRA only.
int delaunay_ring(const delaunay *t, int id, int *ring);

FG_END

#endif // IIR_DELAUNAY_BRIDGE_H
