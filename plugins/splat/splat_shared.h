// SPDX-License-Identifier: MIT
// A VPL as a splat's vertices see it; read by C and GLSL (std430, 48 bytes).
#ifndef SPLAT_SHARED_H
#define SPLAT_SHARED_H

#include "passes/include/pass/shared_types.h"

struct splat_light {
    ag_vec4 position_area; // xyz render space; w: area A_j. Both times the view's scale
    ag_vec4 normal_bound;  // xyz unit; w: least cos_j / (pi d^2 + A_j) that it reaches, >= 0
    ag_vec4 flux;          // rgb: reflected flux rho_j Phi_j times scale^2 / pi
};

#ifndef GL_core_profile
typedef struct splat_light splat_light;
#endif

#endif // SPLAT_SHARED_H
