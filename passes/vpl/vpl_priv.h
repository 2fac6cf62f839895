// SPDX-License-Identifier: MIT
#ifndef VPL_PRIV_H
#define VPL_PRIV_H

#include <pass/vpl.h>

enum {
    VPL_GROUP = 256,     // VPLs or texels of one work group, all shaders
    VPL_WIDE_BLOCK = 16, // texels along the edge of a block from which on a work group sums it
};

// Fills in `total` and `rows` as the lights are now. Returns how many rows follow the first.
int vpl_plan(ag_vpl_pass *pass);

#endif // VPL_PRIV_H
