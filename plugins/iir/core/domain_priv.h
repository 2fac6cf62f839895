// SPDX-License-Identifier: MIT
#ifndef IIR_DOMAIN_PRIV_H
#define IIR_DOMAIN_PRIV_H

#include "delaunay_bridge.h"
#include "domain.h"

// What is known of a point that is a corner of the triangulation, from its ring alone. Squared
// lengths. The sums over a ring start at its smallest entry and what belongs to an edge or triangle
// is computed from its corners in one order, so that equal triangulations give equal bits.
typedef struct domain_cell {
    double near[2];   // to the closest and second closest neighbour; INFINITY where there is none
    double empty;     // of the largest empty circle about a place of the cell's border
    double centre[3]; // that place
    double area;
} domain_cell;

enum { DOMAIN_ABSENT = -2, DOMAIN_CORNER = -1 };

enum {
    DOMAIN_STALE_RANK = 1, // near, empty, centre and both trees
    DOMAIN_STALE_AREA = 2,
};

typedef struct domain_stale {
    int *ids; // [capacity]
    int count;
} domain_stale;

// Which corner is first by some order: a knock-out tournament with a leaf for each id.
typedef struct domain_tree {
    int *nodes; // [2 leaves]; node n is played out by 2 n and 2 n + 1. -1: nobody
    int leaves; // power of two
} domain_tree;

// Corners by place, to find those near to a point.
typedef struct domain_grid {
    int *heads; // [mask + 1]
    int *next;  // [capacity]
    uint32_t mask;
} domain_grid;

struct iir_domain {
    iir_space space;
    int capacity;
    int count;
    int duplicates;
    bool broken; // the triangulation ran out of memory and is to be made again
    delaunay_kind kind;
    delaunay *net;       // NULL only if broken
    int *ring;           // [4 capacity], of the corner in work; the second half is scratch
    double (*points)[3]; // by id, as all below
    int *twin;           // DOMAIN_ABSENT, DOMAIN_CORNER, or the corner that it is a duplicate of
    uint64_t *birth;     // which of two came first
    uint64_t births;
    domain_cell *cells;
    uint8_t *stale;
    domain_stale rank, area;
    domain_tree near, empty; // whose near[] is least, whose `empty` is largest
    domain_grid grid;
};

// Fills what is wanted (DOMAIN_STALE_*) of a cell but `near`, from d->ring; `empty` is negative
// before and the area 0.
void domain_disc_fill(const iir_domain *d, int id, int size, int wanted, domain_cell *cell);
void domain_sphere_fill(const iir_domain *d, int id, int size, int wanted, domain_cell *cell);

// Whether a place is at least as near to a point as to all of its ring.
bool domain_cell_holds(const iir_domain *d, int id, int size, const double place[3]);
// Makes it the cell's candidate if its circle is larger.
void domain_cell_offer(domain_cell *cell, const double place[3], double radius2);

double domain_distance2(const double a[3], const double b[3]);
// Turns a triangle of ids until the smallest is the first.
void domain_rotate3(int *a, int *b, int *c);

fg_status domain_grid_create(domain_grid *g, int capacity);
void domain_grid_destroy(domain_grid *g);
void domain_grid_clear(domain_grid *g);
void domain_grid_add(domain_grid *g, const double point[3], int id);
void domain_grid_remove(domain_grid *g, const double point[3], int id);
// The eldest corner that a point is a duplicate of, -1: none.
int domain_grid_twin(const iir_domain *d, const double point[3]);

typedef bool domain_before(const domain_cell *cells, int a, int b);

fg_status domain_tree_create(domain_tree *t, int capacity);
void domain_tree_destroy(domain_tree *t);
void domain_tree_fill(domain_tree *t, const iir_domain *d, domain_before *before);
void domain_tree_update(domain_tree *t, const iir_domain *d, domain_before *before, int id);

#endif // IIR_DOMAIN_PRIV_H
