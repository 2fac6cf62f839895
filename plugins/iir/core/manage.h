// SPDX-License-Identifier: MIT
#ifndef IIR_MANAGE_H
#define IIR_MANAGE_H

#include "emitter.h"

#include <pass/rays.h>

FG_BEGIN

// VPL management: what a frame keeps, removes, creates and how strong it is (sec. 3, steps 1 to 4).
//
//     iir_manager *m;
//     iir_manager_create(&(iir_manager_desc){ .log = log, .scene = scene, .max_lights = 256 }, &m);
//     each frame:
//         iir_lights lights = ...;                       // a copy: the scene may move on
//         iir_manager_step(m, &lights, &budget, &result);   // 1 to 4; `result` is m's own
//         ... draw shadow maps of result->vpls[i].fresh, upload, gather ...
//     iir_manager_destroy(m);
//
// A sampling point whose ray leaves the scene makes no VPL but stays, at infinity, as long as
// nothing comes before it: its share of the power goes into the sky. Where the paper scales the
// intensities of what is there to all of the power, `rescale` does so.
//
// Positions are of the world. Moving instances neither make VPLs nor hide them (sec. 4.4).
// Deterministic.
// Thread: one at a time.
enum { IIR_MAX_VPLS = 4096, IIR_MAX_TILES = 8 };

typedef enum iir_mode {
    IIR_INCREMENTAL = 0,
    IIR_ANEW, // the comparison method of sec. 6: all points and VPLs again each step
} iir_mode;

typedef enum iir_deal {
    IIR_DEAL_CURVE = 0, // along a space-filling curve of the domain, round robin
    IIR_DEAL_CREATION,  // in the order in which they were made, as in the paper
} iir_deal;

typedef struct iir_budget {
    iir_mode mode;
    int max_lights;  // points of all lights together, [1, IIR_MAX_VPLS]: shared by power
    int recalc_min;  // points that a step frees at least, by the deletion rule; above recalc_max
                     // it counts as that
    int recalc_max;  // points that a step creates at most; both are shared by power, too
    bool fill_first; // a step that finds no points creates up to max_lights
    bool settle;     // of a light that has not moved leave a point where it is if what its removal
                     // opens would be the largest empty circle again; without it VPLs never rest
    bool rescale;    // the paper's: what leaves the scene is given to the VPLs
    double rim; // how far within the disc's rim a new point is at least, over the radius of its
                // empty circle, [0, 1]; the paper's is 0
    iir_deal deal;
    int tiles; // n: subsets for n x n pixels, [1, IIR_MAX_TILES]
} iir_budget;

// What of a scene a step needs that changes with time.
typedef struct iir_lights {
    const ag_light *lights; // borrowed during the step
    int count;
} iir_lights;

typedef struct iir_vpl {
    double position[3];
    float normal[3];   // unit, of the triangle, on the side that the light sees
    float albedo[3];   // blurred (sec. 4.6)
    float flux[3];     // reflected, rho Phi, W
    float area;        // m^2 of the patch that it stands for
    float edges[2][3]; // of that patch, m: a parallelogram about the position in its plane
    int slot;          // of its shadow map, [0, max_lights): the same as long as it lives
    int light;         // of iir_lights
    uint64_t birth;    // 0, 1, 2, ... over all steps
    bool fresh;        // made in this step: its map is to be drawn
} iir_vpl;

typedef struct iir_point { // a sampling point, to look at
    double place[3];       // in the domain
    iir_space space;
    int light, vpl; // of iir_lights; of the result's list, -1: at infinity
    bool fresh;
} iir_point;

typedef struct iir_result {
    const iir_vpl *vpls;     // by tile of the interleaved pattern: tile t of T has
    int count;               // count / T of them, one more where t < count % T, tile after tile
    const iir_point *points; // all, those of a light after each other
    int point_count;
    int escaped;       // points at infinity
    int created;       // points made in this step, VPLs or not
    int fresh;         // VPLs made in this step
    int invalid;       // points removed: occluded, out of the cone, of a light that is gone
    int deleted;       // points removed by the deletion rule
    int rays;          // cast in this step
    double dispersion; // largest of all domains, over that of as many points in a hexagonal lattice
    double power;      // of all lights, W, mean of r, g and b
    double lost;       // of that, into the sky
    double ms;         // that the step took, by the thread's CPU clock
    double ray_ms;     // of that, in ray casts
} iir_result;

typedef struct iir_manager iir_manager;

typedef struct iir_manager_desc {
    const fg_log *log;     // Optional. Borrowed, as is the scene.
    const ag_scene *scene; // its static surfaces; may be moved to other times meanwhile, on another
                           // thread too
    int max_lights;        // that budgets may ask for, [1, IIR_MAX_VPLS]
    int blur; // texels along the longer edge of the textures that give a VPL its colour, > 0
    iir_triangulation triangulation;
} iir_manager_desc;

// Errors: FG_ERR_INVALID, a number out of its range; FG_ERR_MEMORY; FG_ERR_UNSUPPORTED as
// ag_rays_create().
FG_NODISCARD fg_status iir_manager_create(const iir_manager_desc *desc, iir_manager **out);
void iir_manager_destroy(iir_manager *m); // accepts NULL
// Forgets all VPLs: the scene's static part has changed, or the camera cut to another light.
void iir_manager_clear(iir_manager *m);

// `*out` is valid until the next step, and what it held until the one after. Says once in the log
// when no VPL comes of lights that have power. Errors: FG_ERR_INVALID, a budget out of its ranges;
// FG_ERR_MEMORY, all points are then forgotten.
FG_NODISCARD fg_status iir_manager_step(iir_manager *m, const iir_lights *lights,
                                        const iir_budget *budget, const iir_result **out);

// ---- on a thread of its own (sec. 6) ---------------------------------------------------------

// Runs steps beside the frame: what iir_worker_frame() gives was made from the lights of the call
// before (delay 1), or of this one (delay 0, on the calling thread; and the first of all).
//
// The result does not depend on which thread is faster.
typedef struct iir_worker iir_worker;

FG_NODISCARD fg_status iir_worker_create(const iir_manager_desc *desc, iir_worker **out);
void iir_worker_destroy(iir_worker *w); // accepts NULL; waits for a step under way

// Lights are copied. `*out` is valid until the next call.
FG_NODISCARD fg_status iir_worker_frame(iir_worker *w, const iir_lights *lights,
                                        const iir_budget *budget, int delay,
                                        const iir_result **out);

FG_END

#endif // IIR_MANAGE_H
