// SPDX-License-Identifier: MIT
// What paraboloid shadow maps are looked up and drawn with; read by C and GLSL (std430).
#ifndef PASS_PARABOLOID_SHARED_H
#define PASS_PARABOLOID_SHARED_H

#include "shared_types.h"

#ifndef GL_core_profile
typedef struct ag_paraboloid_eye_block ag_paraboloid_eye_block;
#endif

// Where a map is seen from, and where it lies. Its texels are directions of the hemisphere about
// `normal`: (x, y) / (1 + z) of the unit direction, -1 .. 1 over the map.
struct ag_paraboloid_eye_block {
    ag_vec4 position;  // xyz: render space, m; w: the maps' unit of reciprocal distance, 1/m
    ag_vec4 tangent;   // xyz; w: the map's first column in its layer
    ag_vec4 bitangent; // xyz; w: its first row
    ag_vec4 normal;    // xyz: unit; w: its layer
};

#ifdef GL_core_profile
// Texels whose middle is beyond this, in (x, y) / (1 + z), have what is there beside it: so far
// inside of the horizon that nothing which lies on the eye's own plane rises to it.
const float paraboloid_horizon = 1.0 - 1.0 / 4096.0;
#endif

#endif // PASS_PARABOLOID_SHARED_H
