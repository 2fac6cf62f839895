// SPDX-License-Identifier: MIT
// A sampling point as the picture of its domain shows it; read by C and GLSL (std430, 32 bytes).
#ifndef IIR_DOMAIN_SHARED_H
#define IIR_DOMAIN_SHARED_H

#include "passes/include/pass/shared_types.h"

#ifndef GL_core_profile
typedef struct iir_dot iir_dot;
#endif

struct iir_dot {
    ag_vec4 place;  // xyz: in the unit disc, z 0, or on the unit sphere; w 1: new in this frame
    ag_vec4 colour; // rgb: of its cell, [0, 1]; a unused
};

#endif // IIR_DOMAIN_SHARED_H
