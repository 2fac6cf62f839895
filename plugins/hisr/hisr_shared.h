// SPDX-License-Identifier: MIT
// A node of the VPL tree; read by C and GLSL (std430, 64 bytes).
//
// The tree is a forest: each coarsest patch of a reflective shadow map is the root of a quadtree
// down to the map's texels. It lies in one buffer like the coefficients of a Haar transform: all
// roots, then all of the next finer level, and so on; within a level face by face, each in Morton
// order, so that the four children of node i of a level are 4 i .. 4 i + 3 of the next.
#ifndef HISR_SHARED_H
#define HISR_SHARED_H

#include "passes/include/pass/vpl_shared.h"

#define HISR_ROOTS 16 // coarsest patches along an edge of a face, or its texels if fewer

struct hisr_node {
    ag_vpl vpl;     // sums of flux and area; flux-weighted means of position and normal
    ag_vec4 spread; // x: variance of position, m^2; y: omega_j max ||V_j||^2, m^2; z, w: half
                    // floats: how far the patch reaches from its position and from its plane, over
                    // the root of x; root mean square and most of how far normals depart
};

struct hisr_total {
    ag_vec4 flux_area; // rgb: flux of all nodes of a level, W; w: their area, m^2
};

// Nodes on the levels before `level`, with so many `roots`: roots (4^level - 1) / 3.
#define HISR_LEVEL_START(roots, level) (((1 << 2 * (level)) - 1) / 3 * (roots))

#ifndef GL_core_profile
typedef struct hisr_node hisr_node;
typedef struct hisr_total hisr_total;
#endif

#endif // HISR_SHARED_H
