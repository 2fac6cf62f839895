// SPDX-License-Identifier: MIT
#ifndef PASS_VPL_H
#define PASS_VPL_H

#include <pass/rsm.h>

FG_BEGIN

typedef enum ag_vpl_pattern {
    AG_VPL_ALL = 0,    // one VPL a texel
    AG_VPL_REGULAR,    // the middle texel of each block
    AG_VPL_STRATIFIED, // a random texel of each block, the same every frame
} ag_vpl_pattern;

// Turns reflective shadow maps into a list of VPLs: passes "PREFIX.build" and "PREFIX.pack".
//
// Each block of texels makes one VPL. It sits on the texel that the pattern picks (or on the lit
// one nearest to it) and carries the block's summed flux and area, so that the energy does not
// depend on how many there are. Blocks without a lit texel make none.
//
// Shapes: vpls: ag_vpl[capacity] (pass/vpl_shared.h), valid ones first, in the order of faces and
//         rows; count: uvec4, x valid ones, y blocks.
// Errors: more blocks than a storage block of the device holds, or than 65535 x 256, fail the
//         graph: OpenGL's least is 2.8 million.
typedef struct ag_vpl_pass {
    fg_res position, normal, flux, faces, blocks, groups;
    fg_res vpls, count;
    int capacity;
    int grid, block; // blocks along a face's edge; texels along a block's edge
    ag_vpl_pattern pattern;
    uint32_t seed;
} ag_vpl_pass;

typedef struct ag_vpl_desc {
    const char *prefix; // e.g. "rsm"
    ag_vpl_pattern pattern;
    int grid;      // blocks along a face's edge; a divisor of the RSM's size. Ignored by ALL.
    uint32_t seed; // of STRATIFIED
} ag_vpl_desc;

FG_API void ag_vpl_declare(ag_vpl_pass *pass, fg_graph *g, const ag_rsm_pass *rsm,
                           const ag_vpl_desc *desc);

FG_END

#endif // PASS_VPL_H
