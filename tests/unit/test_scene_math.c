// SPDX-License-Identifier: MIT
#include "scene_log.h"

#include <math.h>
#include <pass/math.h>

// Doubles: results of a dozen operations on numbers around 1 to 100.
#define TIGHT 1e-12

static void assert_vector(const double *is, double x, double y, double z, double tolerance)
{
    const double want[3] = { x, y, z };
    for (int i = 0; i < 3; i++)
        if (!(fabs(is[i] - want[i]) <= tolerance))
            fail_msg("[%d] is %.17g, should be %.17g", i, is[i], want[i]);
}

static void a_matrix_times_its_inverse_is_the_identity(void **state)
{
    (void) state;
    const double t[3] = { 1, -2, 3 }, q[4] = { 0.5, 0.5, -0.5, 0.5 }, s[3] = { 2, 3, -4 };
    double m[16], inverse[16], product[16];
    ag_mat_from_trs(t, q, s, m);
    assert_true(ag_mat_inverse(m, inverse));
    ag_mat_mul(m, inverse, product);
    for (int i = 0; i < 16; i++)
        assert_true(fabs(product[i] - (i % 5 == 0)) <= TIGHT);
    assert_true(fabs(ag_mat_determinant3(m) + 24) <= TIGHT * 24);
}

static void a_singular_matrix_has_no_inverse(void **state)
{
    (void) state;
    double m[16] = { 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 }, inverse[16];
    assert_false(ag_mat_inverse(m, inverse));
    assert_true(inverse[0] == 1 && inverse[5] == 1);
}

static void outputs_may_be_inputs(void **state)
{
    (void) state;
    const double t[3] = { 1, 2, 3 }, q[4] = { 0, 0, 0, 1 }, s[3] = { 2, 2, 2 };
    double m[16], p[3] = { 1, 1, 1 };
    ag_mat_from_trs(t, q, s, m);
    ag_mat_mul(m, m, m);
    ag_mat_point(m, p, p);
    assert_vector(p, 2 * (2 + 1) + 1, 2 * (2 + 2) + 2, 2 * (2 + 3) + 3, TIGHT);
}

// A plane's normal stays at right angles to the plane under any scale, and on its side.
static void normals_stay_normal_under_uneven_and_mirrored_scale(void **state)
{
    (void) state;
    const double t[3] = { 0 }, q[4] = { 0, 0, 0, 1 }, scales[2][3] = { { 1, 4, 1 }, { -1, 4, 1 } };
    for (int i = 0; i < 2; i++) {
        double m[16], n[9], along[3] = { 1, -1, 0 };
        ag_mat_from_trs(t, q, scales[i], m);
        ag_mat_normal(m, n);
        // The normal (1, 1, 0) of the plane that holds (1, -1, 0).
        double normal[3] = { n[0] + n[3], n[1] + n[4], n[2] + n[5] };
        ag_mat_vector(m, along, along);
        assert_true(fabs(normal[0] * along[0] + normal[1] * along[1]) <= TIGHT);
        // A mirrored normal is the mirror image: x turns with the scale's sign, y does not.
        assert_true(normal[0] * scales[i][0] > 0 && normal[1] > 0);
    }
}

static void perspective_depth_is_one_near_and_zero_far(void **state)
{
    (void) state;
    double m[16], p[3] = { 0, 0, -0.5 }, q[3];
    for (int finite = 0; finite < 2; finite++) {
        ag_mat_perspective(1.2, 2.0, 0.5, finite ? 100 : (double) INFINITY, m);
        p[2] = -0.5;
        ag_mat_project(m, p, q);
        assert_vector(q, 0, 0, 1, TIGHT);
        p[2] = finite ? -100 : -1e12;
        ag_mat_project(m, p, q);
        assert_vector(q, 0, 0, 0, TIGHT);
    }
    // The upper right corner of the view at distance 3.
    double corner[3] = { 2.0 * 3 * tan(0.6), 3 * tan(0.6), -3 };
    ag_mat_project(m, corner, q);
    assert_true(fabs(q[0] - 1) <= TIGHT && fabs(q[1] - 1) <= TIGHT);
}

static void orthographic_depth_is_one_near_and_zero_far(void **state)
{
    (void) state;
    double m[16], q[3], near[3] = { 4, 3, 2 }, far[3] = { -4, -3, -10 };
    ag_mat_orthographic(4, 3, -2, 10, m);
    ag_mat_project(m, near, q);
    assert_vector(q, 1, 1, 1, TIGHT);
    ag_mat_project(m, far, q);
    assert_vector(q, -1, -1, 0, TIGHT);
}

static void look_to_puts_the_target_on_the_negative_z_axis(void **state)
{
    (void) state;
    const double eye[3] = { 1e6, 5, -3 }, up[3] = { 0, 1, 0 };
    const double forwards[3][3] = { { 0, 0, 2 }, { 3, 4, 0 }, { 0, -7, 0 } }; // the last along up
    for (int i = 0; i < 3; i++) {
        double m[16], target[3];
        const double *f = forwards[i];
        ag_mat_look_to(eye, f, up, m);
        double length = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
        for (int k = 0; k < 3; k++)
            target[k] = eye[k] + f[k];
        ag_mat_point(m, target, target);
        // The translation is around 1e6: its last bits are 1e-10.
        assert_vector(target, 0, 0, -length, 1e-9);
        assert_true(fabs(ag_mat_determinant3(m) - 1) <= TIGHT);
    }
}

static void rigid_drops_scale_and_mirroring(void **state)
{
    (void) state;
    const double t[3] = { 7, 8, 9 }, q[4] = { 0, 0.6, 0, 0.8 }, s[3] = { -3, 1e-9, 20 };
    double m[16], r[16];
    ag_mat_from_trs(t, q, s, m);
    ag_mat_rigid(m, r);
    assert_true(fabs(ag_mat_determinant3(r) - 1) <= TIGHT);
    assert_vector(r + 12, 7, 8, 9, 0);
    assert_vector(r + 8, m[8] / 20, m[9] / 20, m[10] / 20, TIGHT);
}

static void slerp_turns_evenly_along_the_shorter_arc(void **state)
{
    (void) state;
    // 0 and 80 degrees about Y, the second given as its negative: a quarter is 20 degrees.
    const double half = 40 * 3.14159265358979323846 / 180;
    const double a[4] = { 0, 0, 0, 1 }, b[4] = { 0, -sin(half), 0, -cos(half) };
    double q[4];
    ag_quat_slerp(a, b, 0.25, q);
    assert_true(fabs(fabs(q[1]) - sin(half / 4)) <= TIGHT);
    assert_true(fabs(fabs(q[3]) - cos(half / 4)) <= TIGHT && q[1] * q[3] > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_matrix_times_its_inverse_is_the_identity),
        cmocka_unit_test(a_singular_matrix_has_no_inverse),
        cmocka_unit_test(outputs_may_be_inputs),
        cmocka_unit_test(normals_stay_normal_under_uneven_and_mirrored_scale),
        cmocka_unit_test(perspective_depth_is_one_near_and_zero_far),
        cmocka_unit_test(orthographic_depth_is_one_near_and_zero_far),
        cmocka_unit_test(look_to_puts_the_target_on_the_negative_z_axis),
        cmocka_unit_test(rigid_drops_scale_and_mirroring),
        cmocka_unit_test(slerp_turns_evenly_along_the_shorter_arc),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
