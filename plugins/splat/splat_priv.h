// SPDX-License-Identifier: MIT
#ifndef SPLAT_PRIV_H
#define SPLAT_PRIV_H

#include <pass/multires.h>
#include <pass/vpl.h>

enum { SPLAT_ROW = 4096 }; // receivers in a row: plugins/splat/receiver_row.glsl

// Refines a list of patches level by level, from all texels of the coarsest one on: passes
// "splat.refineL", L the level that its patches are of. A last one may skip levels, see `share` of
// ag_multires_desc.
//
// Shapes: positions, normals RGBA32F, SPLAT_ROW texels wide: the receivers of the patches in turn,
//         see splat.vert; patches: uint, how many those are. In no particular order.
typedef struct splat_round {
    const struct splat_refine_pass *pass;
    int level, along; // of the texels looked at; log2 of how many of them along a parent's edge
    bool first;
    fg_res parents, refined; // uvec4: dispatch xyz, how many w
    fg_res queue, positions, normals, patches;
} splat_round;

typedef struct splat_refine_pass {
    const ag_multires_pass *multires;
    fg_res positions, normals, patches; // after the last round
    int rounds;
    splat_round round[AG_MAX_LEVELS + 1];
} splat_refine_pass;

void splat_refine_declare(splat_refine_pass *pass, fg_graph *g, const ag_multires_pass *multires);

// Adds up the light of one VPL after the other at all patches: passes "splat.vpl_splats",
// "splat.splat".
//
// Shapes: out RGBA32F, the pyramid's size; 0 but at the patches.
// Units:  E / pi, W/(m^2 sr).
typedef struct splat_light_pass {
    ag_scene_res scene;
    const splat_refine_pass *refine;
    fg_res vpls, count, lights, draw;
    fg_res out;
    float reach;
    uint32_t vertex_array;
} splat_light_pass;

void splat_light_init(splat_light_pass *pass);
void splat_light_finish(splat_light_pass *pass); // accepts a zeroed one
void splat_light_declare(splat_light_pass *pass, fg_graph *g, const splat_refine_pass *refine,
                         const ag_vpl_pass *vpls, float reach);

#endif // SPLAT_PRIV_H
