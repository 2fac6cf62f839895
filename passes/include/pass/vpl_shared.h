// SPDX-License-Identifier: MIT
// A virtual point light as the VPL buffers hold it; read by C and GLSL (std430, 48 bytes).
#ifndef PASS_VPL_SHARED_H
#define PASS_VPL_SHARED_H

#include "shared_types.h"

struct ag_vpl {
    ag_vec4 position_area; // xyz render space; w: area A_j of the patch that it stands for, m^2
    ag_vec4 normal;        // xyz unit, on the lit side; w unused
    ag_vec4 flux;          // rgb: reflected flux rho_j Phi_j, W, never negative; w unused
};

#ifndef GL_core_profile
typedef struct ag_vpl ag_vpl;
#endif

#endif // PASS_VPL_SHARED_H
