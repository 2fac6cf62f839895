// SPDX-License-Identifier: MIT
#ifndef PASS_GATHER_H
#define PASS_GATHER_H

#include <pass/interleave.h>
#include <pass/ism.h>
#include <pass/multires.h>
#include <pass/paraboloid.h>
#include <pass/vpl.h>

FG_BEGIN

// What keeps a VPL's light finite near it.
typedef enum ag_clamp {
    AG_CLAMP_FOOTPRINT = 0, // DISC from 2 sqrt(A_j) on; nearer the exact form factor of the VPL's
                            // patch, so that corners stay lit up to the edge
    AG_CLAMP_DISC,          // pi d^2 + A_j: the VPL is a disc of its own area. No length is tuned.
    AG_CLAMP_NONE,          // pi d^2
    AG_CLAMP_CONSTANT,      // pi max(d^2, clamp_d2)
    AG_CLAMP_IRRADIANCE, // NONE, but what a VPL adds to E is scaled until none of r, g, b is above
                         // clamp_e: Laine et al. 2007, sec. 5.1
    AG_CLAMP_GEOMETRY,   // NONE, but cos_i cos_j / (pi d^2) is at most clamp_g
} ag_clamp;

// Sums all VPLs at every pixel: pass "PREFIX.gather".
//
//     E_i = sum_j V_ij rho_j Phi_j cos_i cos_j / (pi d^2 + A_j)
//
// V_ij is 1 for all, or what imperfect or paraboloid shadow maps say.
//
// With `split` each of its n x n tiles is lit by the VPLs of its own alone, times n^2: tile (i, j)
// has the run j n + i of the list, each count / n^2 VPLs long, one more where j n + i < count %
// n^2. What bounds a VPL acts on it before it is multiplied.
//
// Shapes: out RGBA32F of the frame's size; a 1. With `multires`: at its valid texels alone, of the
//         size of its pyramid; with `split`: of the split's size. Left out where there is no light
//         or no geometry.
// Units:  E / pi, W/(m^2 sr).
// Source: Nichols, Shopf, Wyman 2009, eq. 1 and 5. Departs from it: see gather.comp.
typedef struct ag_gather_pass {
    ag_scene_res scene;
    fg_res position, normal, vpls, count;
    fg_res out;
    ag_clamp clamp;
    float bound;  // clamp_d2, clamp_e or clamp_g
    int block;    // receivers of one invocation: 1, 4 or 16
    int capacity; // of `vpls`
    bool on_surface, far_only;
    const ag_ism_pass *visibility;
    const ag_multires_pass *multires;
    const ag_paraboloid_pass *paraboloid;
    const ag_split_pass *split; // NULL with one tile
} ag_gather_pass;

typedef struct ag_gather_desc {
    const char *prefix;
    ag_clamp clamp;
    float clamp_d2;                // m^2, > 0; CONSTANT only
    float clamp_e;                 // W/m^2, > 0; IRRADIANCE only
    float clamp_g;                 // 1/m^2, > 0; GEOMETRY only
    bool on_surface;               // VPLs are not texels of a map, which belong to two surfaces
                                   // where these meet: FOOTPRINT takes their planes as they are,
                                   // and NONE from 2 sqrt(A_j) on
    int block;                     // 1, 4 or 16; 0: what suits the device (16 on a CPU, else 4)
    const ag_ism_pass *visibility; // maps of these VPLs, declared before; borrowed while the graph
                                   // runs. NULL: nothing shadows them
    const ag_multires_pass *multires; // NULL: every pixel. Borrowed while the graph runs.
    // Neither goes with multires or visibility, nor do IRRADIANCE and GEOMETRY. Borrowed likewise.
    const ag_split_pass *split;           // NULL: the frame in one
    const ag_paraboloid_pass *paraboloid; // maps of these VPLs. NULL: nothing shadows them
    bool far_only; // with a split frame and FOOTPRINT: ag_near_declare() adds what is near
} ag_gather_desc;

FG_API void ag_gather_declare(ag_gather_pass *pass, fg_graph *g, const ag_scene_res *scene,
                              const ag_gbuffer *gbuffer, const ag_vpl_pass *vpls,
                              const ag_gather_desc *desc);

// The light of near VPLs, those within 2 sqrt(A_j), at every pixel: pass "PREFIX.near". What a
// gather over a split frame left out with `far_only`, to be added when the rest has been combined
// and filtered. VPLs stand on their surfaces.
//
// Shapes: in, out RGBA32F of the frame's size.
// Units:  E / pi, W/(m^2 sr).
typedef struct ag_near_pass {
    ag_scene_res scene;
    fg_res position, normal, vpls, count;
    fg_res in, out;
    const ag_paraboloid_pass *paraboloid;
} ag_near_pass;

typedef struct ag_near_desc {
    const char *prefix;
    fg_res in;                            // E / pi
    const ag_paraboloid_pass *paraboloid; // maps of these VPLs, borrowed while the graph runs.
                                          // NULL: nothing shadows them
} ag_near_desc;

FG_API void ag_near_declare(ag_near_pass *pass, fg_graph *g, const ag_scene_res *scene,
                            const ag_gbuffer *gbuffer, const ag_vpl_pass *vpls,
                            const ag_near_desc *desc);

FG_END

#endif // PASS_GATHER_H
