// SPDX-License-Identifier: MIT
#ifndef HISR_H
#define HISR_H

#include <pass/gather.h>
#include <pass/multires.h>

// The VPL tree of all reflective shadow maps, and the gather that takes a cut of it for each texel
// of the multiresolution buffer: passes "hisr.tree" and "PREFIX.gather".
//
// Shapes: nodes: hisr_node[] (hisr_shared.h), all levels; total: hisr_total.
//         out: RGBA32F, E / pi, at the texels of a multiresolution buffer (pass/multires.h).
//         visited: uvec4, xy nodes that all receivers took, low and high word; z receivers.
// Errors: a tree larger than a storage block of the device fails the graph.
// Source: Nichols, Shopf, Wyman 2009, sec. 3.5.

enum { HISR_MAX_LEVELS = 7 }; // 16 to 1024 texels along an edge

typedef struct hisr_tree {
    fg_res position, normal, flux, faces;
    fg_res nodes, total;
    int roots;  // of all faces
    int levels; // the last one is the map's texels
    int face_count;
    fg_res eyes, count; // for imperfect shadow maps
    int eye_level, eye_count;
} hisr_tree;

void hisr_tree_declare(hisr_tree *tree, fg_graph *g, const ag_rsm_pass *rsm);

// Adds to the tree ag_vpl[eye_count] and their count, uvec4, from where imperfect shadow maps are
// seen, one for each node of the level `eye_level`: pass "hisr.eyes".
void hisr_eyes_declare(hisr_tree *tree, fg_graph *g);

// How many nodes the tree has on levels 0 .. level.
int hisr_tree_nodes(const hisr_tree *tree, int level);

typedef enum hisr_bound {
    HISR_BOUND_PATCH = 0, // what a patch errs by, from its spread in space and of its normals
    HISR_BOUND_PAPER,     // eq. 7: what it contributes at most
} hisr_bound;

typedef struct hisr_gather_desc {
    const char *prefix; // of pass and resources
    float tau;          // >= 0; 0: all nodes of level `finest`
    int finest;         // level, [0, tree->levels)
    int block;          // receivers of one invocation: 1, 4 or 16; 0: what suits the device
    ag_clamp clamp;
    float clamp_d2; // m^2, CONSTANT only
    hisr_bound bound;
    const ag_ism_pass *visibility; // maps of tree->eyes. NULL: nothing shadows a node
    bool cut; // not light but the number of nodes that a texel took, 64 to 16384 from blue to red
} hisr_gather_desc;

typedef struct hisr_gather {
    const hisr_tree *tree;
    const ag_multires_pass *multires;
    hisr_gather_desc desc;
    fg_res progress, visited;
    fg_res out;
} hisr_gather;

void hisr_gather_declare(hisr_gather *gather, fg_graph *g, const hisr_tree *tree,
                         const ag_multires_pass *multires, const hisr_gather_desc *desc);

#endif // HISR_H
