// SPDX-License-Identifier: MIT
// What paraboloid shadow maps are drawn with; read by C and GLSL (std430). Lengths are in units
// that bring the static scene's diagonal to (1/2, 1], places are about the middle of its box.
#ifndef PARABOLOID_DRAW_SHARED_H
#define PARABOLOID_DRAW_SHARED_H

#include "passes/include/pass/shared_types.h"

#ifndef GL_core_profile
typedef struct shadow_eye shadow_eye;
typedef struct shadow_triangle shadow_triangle;
typedef struct shadow_corner shadow_corner;
#endif

// A map to be drawn. The bitangent is normal x tangent.
struct shadow_eye {
    ag_vec4 position; // xyz; w: the map's first column in its layer
    ag_vec4 tangent;  // xyz; w: its first row
    ag_vec4 normal;   // xyz: unit; w: its layer
};

struct shadow_triangle {
    ag_vec4 a, b, c; // xyz; w unused. Counter-clockwise from the front.
};

// What MASK needs of a triangle's corner.
struct shadow_corner {
    ag_vec4 uv; // xy; z: factor of the texture's alpha; w, of corner 0: its texture, -1: none; of
                // corner 1: least alpha of what is there
};

#endif // PARABOLOID_DRAW_SHARED_H
