// SPDX-License-Identifier: MIT
#ifndef IIR_MANAGE_PRIV_H
#define IIR_MANAGE_PRIV_H

#include "manage.h"

#include <pass/surface.h>

FG_BEGIN

// A sampling point: a VPL, or one at infinity. It stands in the manager's table under an id that is
// also the slot of its shadow map, and in its light's domain under a smaller one, so that a domain
// is only as large as the light's share.
typedef struct point {
    int light; // -1: free
    int local; // id in the domain
    bool escaped, fresh;
    double at[3];    // in the domain
    double cell;     // of the domain's area
    double place[3]; // world; escaped: the unit direction, of a directional light's ray where it
                     // leaves the scene
    float normal[3], albedo[3];
    uint64_t birth;
} point;

typedef struct light_state {
    bool lit;    // has power
    bool moved;  // since the last step, or new: `emitter` is another one but for its power
    bool turned; // into a directional light, or from one
    iir_emitter emitter;
    iir_domain *domain;
    iir_space space; // of the domain, as is
    int capacity;
    int *points;     // [capacity], by id in the domain, -1: free
    int first_free;  // none below
    int count;       // points
    bool dirty;      // the domain's points have changed since cells were measured
    double wide;     // dispersion over that of a hexagonal lattice
    int share;       // points that it may have
    int spare;       // of them that a step frees at least
    int allowed;     // points that this step may make
    double carry[2]; // what spare, allowed fell short of by rounding
    bool rested;     // the deletion rule has nothing to gain on these very points
    double least;    // largest empty circle that the light has come down to since it moved
    int tries;       // points taken away since then
} light_state;

typedef struct sort_entry {
    uint64_t key, birth;
    int point;
} sort_entry;

struct iir_manager {
    const fg_log *log;
    const ag_scene *scene;
    ag_rays *rays;
    int capacity; // max_lights
    ag_blur *blur;
    iir_triangulation triangulation;
    double box_min[3], box_max[3]; // of what does not move
    double origin[3];              // of the rays
    point *points;                 // [capacity]
    int first_free;                // none below
    int count;
    light_state *lights;
    int light_count, light_capacity;
    struct share *shares; // [light_capacity], as the following
    sort_entry *ranks;
    int *first;      // [light_capacity + 1], of a light's points in `order`
    int *order;      // [capacity] points by light, then id
    double (*at)[3]; // [capacity]
    int *ids;
    double *areas;
    ag_ray *probes; // [capacity], of validity
    int *probed;    // whose
    bool *blocked;
    sort_entry *sorted; // [capacity]
    iir_vpl *vpls[2];   // this result's, and the one's before
    iir_point *shown[2];
    iir_result result; // in the making
    iir_result results[2];
    int turn;
    uint64_t births;
    bool unseen; // nobody got the last result
    bool said;   // that no VPL comes of the lights
};

// ---- manage_points.c: the points of one light
// ----------------------------------------------------

// Their places are known; the domain follows.
fg_status iir_points_place(iir_manager *m, int light);
fg_status iir_points_delete(iir_manager *m, int light, bool settle);
fg_status iir_points_create(iir_manager *m, int light, double rim); // rim as of iir_budget
void iir_points_measure(iir_manager *m, int light);
void iir_point_free(iir_manager *m, int id); // the domain is the caller's business

// ---- manage_rays.c ------------------------------------------------------------------------------

// Marks and frees the invalid among the points of lights that moved (sec. 4.4); the domains are
// then to be placed anew.
void iir_rays_validate(iir_manager *m);
// What the ray through p->at meets becomes the rest of `p`.
void iir_rays_hit(iir_manager *m, const iir_emitter *e, point *p);
// Area and edges of the patch that a VPL stands for.
void iir_rays_patch(const iir_manager *m, const iir_emitter *e, const point *p, iir_vpl *out);

// ---- manage_share.c -----------------------------------------------------------------------------

// Splits `total` in proportion to the weights, within low <= part <= high; of what is left after
// rounding down, the largest remainders get one more. Where `low` alone is too much, the heaviest
// get theirs; where `high` is too little, the rest is left. Of equals the first.
typedef struct share {
    double weight; // >= 0; without any: `low`
    int low, high;
    double *carry; // optional: what the part fell short of, added the next time
    int part;      // the outcome
    double rest;   // used within
} share;
void iir_share(share *shares, int count, int total, sort_entry *scratch); // scratch: [count]

// ---- manage_deal.c ------------------------------------------------------------------------------

// Ids of the VPLs, in the order that the result has, into m->order; returns how many.
int iir_order(iir_manager *m, iir_deal deal, int tiles);
// By key, then by birth.
void iir_sort(sort_entry *entries, int count);

// For a worker that drops a result: what was fresh in it is so in the next one, too.
void iir_manager_unseen(iir_manager *m);

// Seconds that the calling thread has run.
double iir_cpu_time(void);

FG_END

#endif // IIR_MANAGE_PRIV_H
