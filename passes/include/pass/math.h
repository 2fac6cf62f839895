// SPDX-License-Identifier: MIT
#ifndef PASS_MATH_H
#define PASS_MATH_H

#include <fg/base.h>

FG_BEGIN

// Matrices and quaternions in double precision, for worlds and cameras:
//
//     double view[16], proj[16], clip[16];
//     ag_mat_look_to(eye, forward, up, view);
//     ag_mat_perspective(yfov, aspect, 0.1, INFINITY, proj);
//     ag_mat_mul(proj, view, clip);
//     ag_mat_to_float(clip, uniforms->view_proj);
//
// Matrices are column-major, vectors are columns, angles are radians, quaternions are x y z w.
// Eyes look along -Z with +Y up. Clip space is that of glClipControl(GL_LOWER_LEFT,
// GL_ZERO_TO_ONE), depth reversed: 1 at the near plane, 0 at the far one.
// An output may be one of the inputs.

FG_API void ag_mat_identity(double out[16]);
FG_API void ag_mat_mul(const double a[16], const double b[16], double out[16]); // a b
// False, and the identity, where `m` is singular or not finite.
FG_API bool ag_mat_inverse(const double m[16], double out[16]);
// Translation x rotation x scale. `rotation` is unit.
FG_API void ag_mat_from_trs(const double translation[3], const double rotation[4],
                            const double scale[3], double out[16]);
FG_API double ag_mat_determinant3(const double m[16]); // of the upper left 3x3
FG_API bool ag_mat_finite(const double m[16]);

FG_API void ag_mat_point(const double m[16], const double p[3], double out[3]);  // w taken as 1
FG_API void ag_mat_vector(const double m[16], const double v[3], double out[3]); // w taken as 0
// With the division by w; the result is not finite where w is 0.
FG_API void ag_mat_project(const double m[16], const double p[3], double out[3]);

// For normals: the inverse transpose of the upper left 3x3 times |determinant|, which needs
// no inverse and stays usable where a scale is 0. Results want normalising.
FG_API void ag_mat_normal(const double m[16], double out[9]);

// World to eye, for an eye that looks along `forward`. Neither vector need be unit; where `up`
// is parallel to `forward` another one is taken.
FG_API void ag_mat_look_to(const double eye[3], const double forward[3], const double up[3],
                           double out[16]);
// The rigid part of a node's world: the translation, and axes made orthonormal and
// right-handed with -Z kept.
FG_API void ag_mat_rigid(const double m[16], double out[16]);

// `yfov` in (0, pi), aspect = width / height, 0 < znear < zfar; zfar may be INFINITY.
FG_API void ag_mat_perspective(double yfov, double aspect, double znear, double zfar,
                               double out[16]);
// Half sizes in metres, znear < zfar (both may be negative).
FG_API void ag_mat_orthographic(double half_width, double half_height, double znear, double zfar,
                                double out[16]);

FG_API void ag_mat_to_float(const double m[16], float out[16]);
FG_API void ag_mat_from_float(const float m[16], double out[16]);

// Two vectors that make a right-handed orthonormal frame `t`, `b`, `n` with unit `n`, as
// vpl_frame() of pass/vpl_shared.h does.
// Source: Duff et al. Building an Orthonormal Basis, Revisited. JCGT 6(1), 2017.
FG_API void ag_frame_about(const double n[3], double t[3], double b[3]);

// Along the shorter arc. Both unit; so is the result.
FG_API void ag_quat_slerp(const double a[4], const double b[4], double t, double out[4]);

FG_END

#endif // PASS_MATH_H
