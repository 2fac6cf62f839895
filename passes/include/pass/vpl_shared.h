// SPDX-License-Identifier: MIT
// A virtual point light as the VPL buffers hold it; read by C and GLSL (std430, 48 bytes).
//
// It stands for a patch of a surface, a parallelogram about its position. The patch's edges lie in
// the plane of the normal; in the frame of vpl_frame() and over sqrt(A_j) they are two pairs of
// half floats, packed into the w of normal and flux, below 1e3 so that the bits are never a NaN's.
#ifndef PASS_VPL_SHARED_H
#define PASS_VPL_SHARED_H

#include "shared_types.h"

struct ag_vpl {
    ag_vec4 position_area; // xyz render space; w: area A_j of the patch that it stands for, m^2
    ag_vec4 normal;        // xyz unit, of the face, on the lit side; w: first edge
    ag_vec4 flux;          // rgb: reflected flux rho_j Phi_j, W, never negative; w: second edge
};

#ifndef GL_core_profile
typedef struct ag_vpl ag_vpl;
#else
// Two unit vectors that make an orthonormal frame with unit `n`. The sign keeps the denominator
// away from 0.
void vpl_frame(vec3 n, out vec3 t, out vec3 b)
{
    float s = n.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (s + n.z);
    float c = n.x * n.y * a;
    t = vec3(1.0 + s * n.x * n.x * a, s * c, -s * n.x);
    b = vec3(c, s + n.y * n.y * a, -n.y);
}
#endif

#endif // PASS_VPL_SHARED_H
