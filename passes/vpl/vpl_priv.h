// SPDX-License-Identifier: MIT
#ifndef VPL_PRIV_H
#define VPL_PRIV_H

#include <pass/vpl.h>

enum {
    VPL_GROUP = 256, // VPLs or texels of one work group, all shaders
};

// Texels along the edge of a block from which on a work group sums it, and not an invocation. On a
// CPU barriers cost more than sums; Mesa's software renderer ends a loop after 65535 rounds.
static inline int vpl_wide_block(bool software)
{
    return software ? 256 : 16;
}

// Fills in `total` and `rows` as the lights are now. Returns how many rows follow the first.
// `wide`: vpl_wide_block().
int vpl_plan(ag_vpl_pass *pass, int wide);

#endif // VPL_PRIV_H
