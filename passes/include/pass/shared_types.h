// SPDX-License-Identifier: MIT
// Types that C and GLSL share. Structs made of nothing but these have the same layout in C, in
// std140 and in std430, so that one definition serves all three.
#ifndef PASS_SHARED_TYPES_H
#define PASS_SHARED_TYPES_H

#ifdef GL_core_profile
#define ag_vec4 vec4
#define ag_ivec4 ivec4
#define ag_uvec4 uvec4
#define ag_mat4 mat4
#else
#include <stdint.h>
typedef float ag_vec4[4];
typedef int32_t ag_ivec4[4];
typedef uint32_t ag_uvec4[4];
typedef float ag_mat4[16]; // column-major
#endif

#endif // PASS_SHARED_TYPES_H
