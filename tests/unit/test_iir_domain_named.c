// SPDX-License-Identifier: MIT
// Sets whose answers are known, and what a domain does with mistakes.
#include "iir_points.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>

static double areas[POINTS_MAX];

// Some dozen roundings of numbers of order 1.
static const double rounding = 1e-14;

static void near_by(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not %.17g", a, b);
}

static iir_domain *domain_with(int back, double (*points)[3], int count)
{
    iir_domain *d = points_domain(&points_backs[back], count + 4);
    points_set(d, points, count);
    iir_domain_areas(d, areas);
    return d;
}

static void circle_is(iir_domain *d, const double place[3], double radius)
{
    double centre[3];
    near_by(iir_domain_largest_empty_circle(d, centre), radius, rounding);
    for (int k = 0; k < 3; ++k)
        near_by(centre[k], place[k], rounding);
    iir_domain_destroy(d);
}

// ---- few points ------------------------------------------------------------------------------

static void nothing_is_all_empty(void **state)
{
    (void) state;
    for (int back = 0; back < POINTS_BACKS; ++back) {
        iir_domain *d = points_domain(&points_backs[back], 3);
        assert_int_equal(iir_domain_count(d), 0);
        assert_int_equal(iir_domain_redundant(d), -1);
        assert_true(isinf(iir_domain_least_distance(d)));
        iir_domain_areas(d, areas);
        for (int i = 0; i < 3; ++i)
            assert_true(areas[i] == 0);
        if (back == POINTS_DISC)
            circle_is(d, (double[]){ 0, 0, 0 }, 1);
        else
            circle_is(d, (double[]){ 0, 0, 1 }, 2);
    }
}

static void one_point_has_all_of_the_domain(void **state)
{
    (void) state;
    double p[][3] = { { 0.36, 0.48, 0.8 } };
    iir_domain *d = domain_with(POINTS_DISC, p, 1);
    near_by(areas[0], M_PI, 0);
    assert_int_equal(iir_domain_redundant(d), -1);
    circle_is(d, (double[]){ -0.6, -0.8, 0 }, 1.6); // the rim opposite to it
    for (int back = POINTS_SPHERE; back <= POINTS_TETRA; ++back) {
        d = domain_with(back, p, 1);
        near_by(areas[0], 4 * M_PI, 0);
        assert_true(isinf(iir_domain_least_distance(d)));
        circle_is(d, (double[]){ -0.36, -0.48, -0.8 }, 2);
    }
}

static void two_points_share(void **state)
{
    (void) state;
    double p[][3] = { { 0.6, 0, 0.8 }, { -0.6, 0, 0.8 } };
    iir_domain *d = domain_with(POINTS_DISC, p, 2);
    near_by(areas[0], M_PI / 2, rounding);
    near_by(areas[1], M_PI / 2, rounding);
    near_by(iir_domain_least_distance(d), 1.2, rounding);
    assert_int_equal(iir_domain_redundant(d), 1); // as good as the other: the larger id
    double centre[3];
    near_by(iir_domain_largest_empty_circle(d, centre), sqrt(1.36), rounding);
    near_by(centre[0], 0, rounding);
    near_by(fabs(centre[1]), 1, rounding); // either end of the bisector
    iir_domain_destroy(d);
    for (int back = POINTS_SPHERE; back <= POINTS_TETRA; ++back) {
        d = domain_with(back, p, 2);
        near_by(areas[0], 2 * M_PI, rounding);
        near_by(areas[1], 2 * M_PI, rounding);
        circle_is(d, (double[]){ 0, 0, -1 }, sqrt(3.6)); // opposite to the middle
    }
}

static void antipodal_points_leave_the_great_circle_between(void **state)
{
    (void) state;
    double p[][3] = { { 0.36, 0.48, 0.8 }, { -0.36, -0.48, -0.8 }, { 0.8, -0.6, 0 } };
    double centre[3];
    for (int back = POINTS_SPHERE; back <= POINTS_TETRA; ++back) {
        iir_domain *d = domain_with(back, p, 2);
        near_by(areas[0], 2 * M_PI, rounding);
        near_by(iir_domain_largest_empty_circle(d, centre), M_SQRT2, rounding);
        near_by(centre[0] * p[0][0] + centre[1] * p[0][1] + centre[2] * p[0][2], 0, rounding);
        iir_domain_destroy(d);
        // The third takes a lune of a quarter of the sphere.
        d = domain_with(back, p, 3);
        near_by(areas[2], 2 * M_PI, 0.5 * M_PI * 4 - M_PI);
        near_by(areas[0], areas[1], rounding);
        near_by(areas[0] + areas[1] + areas[2], 4 * M_PI, rounding);
        iir_domain_destroy(d);
    }
}

// Lunes: of points on a great circle, with all faces of the hull in one plane.
static void a_great_circle_is_cut_into_lunes(void **state)
{
    (void) state;
    static double p[64][3];
    for (int back = POINTS_SPHERE; back <= POINTS_TETRA; ++back)
        for (int count = 3; count <= 64; ++count) {
            for (int i = 0; i < count; ++i) { // every other one, so that steps are 1 and 3 wide
                const double angle = 2 * M_PI * (i + 0.25 * (i % 2)) / count;
                p[i][0] = cos(angle);
                p[i][1] = 0;
                p[i][2] = sin(angle);
            }
            iir_domain *d = domain_with(back, p, count);
            for (int i = 0; i < count; ++i) {
                const double to = (i + 1) % count + 0.25 * ((i + 1) % count % 2);
                const double from = (i + count - 1) % count + 0.25 * ((i + count - 1) % count % 2);
                double width = 2 * M_PI * (to - from) / count;
                width += width < 0 ? 2 * M_PI : 0;
                near_by(areas[i], width,
                        1e-13); // half of it to either side, two steradians a radian
            }
            iir_domain_destroy(d);
        }
}

// ---- regular sets ----------------------------------------------------------------------------

static void solids_are_cut_into_equal_parts(void **state)
{
    (void) state;
    double tetrahedron[4][3], octahedron[6][3] = { { 0 } }, cube[8][3];
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) {
            cube[i][k] = (i >> k & 1 ? 1 : -1) / sqrt(3);
            if (i < 6 && k == i / 2)
                octahedron[i][k] = i % 2 ? -1 : 1;
            if (i < 4) // every other corner of the cube
                tetrahedron[i][k] = ((k < 2 ? i >> k & 1 : (i ^ i >> 1) & 1) ? 1 : -1) / sqrt(3);
        }
    for (int back = POINTS_SPHERE; back <= POINTS_TETRA; ++back) {
        double centre[3];
        iir_domain *d = domain_with(back, tetrahedron, 4);
        for (int i = 0; i < 4; ++i)
            near_by(areas[i], M_PI, rounding);
        near_by(iir_domain_largest_empty_circle(d, centre), 2 * sqrt(1 / 3.0), rounding);
        iir_domain_destroy(d);
        d = domain_with(back, octahedron, 6);
        for (int i = 0; i < 6; ++i)
            near_by(areas[i], 4 * M_PI / 6, rounding);
        near_by(iir_domain_least_distance(d), M_SQRT2, rounding);
        iir_domain_destroy(d);
        d = domain_with(back, cube, 8); // four on a circle, six times
        for (int i = 0; i < 8; ++i)
            near_by(areas[i], M_PI / 2, rounding);
        near_by(iir_domain_least_distance(d), 2 / sqrt(3), rounding);
        near_by(iir_domain_largest_empty_circle(d, centre), sqrt(2 - 2 / sqrt(3)), rounding);
        iir_domain_destroy(d);
    }
}

// A point in the middle of a ring of n at radius r: its cell is a regular polygon, inside or cut.
static void a_point_in_a_ring_has_a_polygon(void **state)
{
    (void) state;
    static double p[40][3];
    for (int n = 3; n < 40; ++n)
        for (int tenth = 1; tenth <= 10; ++tenth) {
            const double r = 0.1 * tenth;
            p[n][0] = p[n][1] = p[n][2] = 0;
            for (int i = 0; i < n; ++i) {
                p[i][0] = r * cos(2 * M_PI * i / n);
                p[i][1] = r * sin(2 * M_PI * i / n);
                p[i][2] = 0;
            }
            iir_domain *d = domain_with(POINTS_DISC, p, n + 1);
            const double apothem = r / 2, corner = apothem / cos(M_PI / n);
            assert_true(corner < 1.0001); // r = 1, n = 3: the corners are on the rim
            near_by(areas[n], n * apothem * apothem * tan(M_PI / n), 1e-13);
            for (int i = 0; i < n; ++i)
                near_by(areas[i], (M_PI - areas[n]) / n, 1e-13);
            iir_domain_destroy(d);
        }
}

// Three points have their corner on the rim, within rounding of it on either side: the cell of the
// middle one has an arc of no length there, or of less.
static void a_corner_on_the_rim_costs_nothing(void **state)
{
    (void) state;
    for (int i = 0; i < 1000; ++i) {
        double p[3][3] = { { 0 } }, sum = 0;
        const double turn = 0.01 * i, radius = 0.3 + 4e-4 * i;
        for (int k = 0; k < 3; ++k) {
            const double angle = turn + M_PI + 0.7 * (k - 1);
            p[k][0] = cos(turn) + radius * cos(angle);
            p[k][1] = sin(turn) + radius * sin(angle);
        }
        iir_domain_destroy(domain_with(POINTS_DISC, p, 3));
        for (int k = 0; k < 3; ++k)
            sum += areas[k];
        near_by(sum, M_PI, rounding);
        near_by(areas[0], areas[2], rounding);
    }
}

// ---- the largest empty circle of the disc ----------------------------------------------------

static void case_1_is_a_corner(void **state)
{
    (void) state;
    static double p[13][3];
    for (int i = 0; i < 12; ++i) {
        p[i][0] = cos(M_PI * i / 6);
        p[i][1] = sin(M_PI * i / 6);
    }
    circle_is(domain_with(POINTS_DISC, p, 12), (double[]){ 0, 0, 0 }, 1);
}

static void case_2_is_where_an_edge_meets_the_rim(void **state)
{
    (void) state;
    double p[][3] = { { 0.5, 0.1, 0 }, { 0.5, -0.1, 0 }, { 0.7, 0, 0 } };
    circle_is(domain_with(POINTS_DISC, p, 3), (double[]){ -1, 0, 0 }, sqrt(2.26));
}

// The paper speaks of infinite edges only. Here the edge that ends the bisector of 1 and 2 in the
// disc is a finite one, to a corner outside of it: they are not neighbours on the hull.
static void case_2_has_finite_edges_too(void **state)
{
    (void) state;
    double p[][3] = { { 0.3, 0, 0 },    { 0.05, 0.03, 0 }, { -0.3, 0, 0 },   { 0.9, 0.3, 0 },
                      { -0.9, 0.3, 0 }, { 0.5, 0.8, 0 },   { -0.5, 0.8, 0 }, { 0, 0.5, 0 } };
    const int count = FG_COUNT(p);
    iir_domain *d = domain_with(POINTS_DISC, p, count);
    double centre[3], place[3] = { 0 }, best = 0;
    const double radius = iir_domain_largest_empty_circle(d, centre);
    points_corners c;
    points_corners_of(d, count, &c);
    for (int i = 0; i < 1000000; ++i) { // all of the rim
        int which;
        place[0] = cos(2e-6 * M_PI * i);
        place[1] = sin(2e-6 * M_PI * i);
        best = fmax(best, points_nearest(&c, place, &which));
    }
    near_by(radius, best, 7e-6); // a step along the rim
    near_by(hypot(centre[0], centre[1]), 1, rounding);
    assert_true(centre[1] < -0.9);
    // The two that it touches, and others on both sides of the line through them.
    for (int i = 1; i <= 2; ++i)
        near_by(hypot(centre[0] - p[i][0], centre[1] - p[i][1]), radius, rounding);
    iir_domain_destroy(d);
}

// The cell of 0 holds all of the way from it through the origin to the rim.
static void case_3_is_opposite_to_a_point(void **state)
{
    (void) state;
    double p[][3] = {
        { 0.3, 0.4, 0 }, { 0.42, 0.56, 0 }, { 0.2, 0.75, 0 }, { 0.65, 0.35, 0 }, { 0.6, 0.8, 0 }
    };
    circle_is(domain_with(POINTS_DISC, p, 5), (double[]){ -0.6, -0.8, 0 }, 1.5);
    double origin[][3] = { { 0, 0, 0 } }, centre[3];
    iir_domain *d = domain_with(POINTS_DISC, origin, 1);
    near_by(iir_domain_largest_empty_circle(d, centre), 1, rounding);
    near_by(hypot(centre[0], centre[1]), 1, rounding);
    iir_domain_destroy(d);
}

// ---- of the sphere ---------------------------------------------------------------------------

static void the_centre_is_on_the_empty_side(void **state)
{
    (void) state;
    double cap[][3] = { { 0.6, 0, 0.8 },
                        { -0.3, 0.3 * sqrt(3), 0.8 },
                        { -0.3, -0.3 * sqrt(3), 0.8 },
                        { 0, 0, 1 },
                        { 0.1, 0.1, sqrt(0.98) } };
    for (int back = POINTS_SPHERE; back <= POINTS_TETRA; ++back)
        circle_is(domain_with(back, cap, 5), (double[]){ 0, 0, -1 }, sqrt(0.36 + 1.8 * 1.8));
}

// Where the smallest circle about all points touches two only, the centre is on an edge and no
// corner, against sec. 4.6.
static void in_a_hemisphere_the_centre_may_be_opposite_to_a_middle(void **state)
{
    (void) state;
    double p[][3] = {
        { 0.6, 0, 0.8 }, { -0.6, 0, 0.8 }, { 0, 0, 1 }, { 0, 0.28, 0.96 }, { 0.1, 0.1, sqrt(0.98) }
    };
    for (int back = POINTS_SPHERE; back <= POINTS_TETRA; ++back)
        for (int count = 3; count <= 5; ++count)
            circle_is(domain_with(back, p, count), (double[]){ 0, 0, -1 }, sqrt(3.6));
}

// ---- the deletion rule -----------------------------------------------------------------------

static void of_the_closest_pair_the_more_crowded_goes(void **state)
{
    (void) state;
    double p[][3] = { { 0, 0, 0 }, { 0.1, 0, 0 }, { 0.3, 0, 0 }, { -0.5, 0, 0 }, { 0, 0.6, 0 } };
    iir_domain *d = domain_with(POINTS_DISC, p, 5);
    assert_int_equal(iir_domain_redundant(d), 1); // 0.2 to its second closest, 0 has 0.3
    near_by(iir_domain_least_distance(d), 0.1, rounding);
    iir_domain_remove(d, 1);
    near_by(iir_domain_least_distance(d), 0.3, rounding);
    iir_domain_destroy(d);
}

// Second closest neighbour, not second closest point: 2 hides behind 1.
static void only_neighbours_count(void **state)
{
    (void) state;
    double p[][3] = { { 0, 0, 0 },    { 0.1, 0, 0 }, { 0.22, 0, 0 },
                      { 0.15, 0, 0 }, { 0, 0.3, 0 }, { 0, -0.3, 0 } };
    iir_domain *d = domain_with(POINTS_DISC, p, 6);
    assert_int_equal(iir_domain_redundant(d), 3); // 0.05 from 1, then 0.07; 1 has 0.1 from 0
    iir_domain_remove(d, 3);
    assert_int_equal(iir_domain_redundant(d), 1); // 0.1 from 0, then 0.12; 0 has 0.3, past 0.22
    iir_domain_destroy(d);
}

// ---- duplicates ------------------------------------------------------------------------------

static void the_later_of_two_is_a_duplicate(void **state)
{
    (void) state;
    const double p[][3] = { { 0.36, 0.48, 0.8 }, { 0.36 + 1e-12, 0.48, 0.8 }, { -0.6, 0, 0.8 } };
    const int ids[] = { 5, 2, 7 };
    for (int back = 0; back < POINTS_BACKS; ++back) {
        iir_domain *d = points_domain(&points_backs[back], 8);
        assert_int_equal(iir_domain_set(d, p, ids, 3), FG_OK);
        assert_int_equal(iir_domain_count(d), 3);
        assert_int_equal(iir_domain_duplicate_of(d, 2), 5);
        assert_int_equal(iir_domain_duplicate_of(d, 5), -1);
        assert_int_equal(iir_domain_redundant(d), 2);
        iir_domain_areas(d, areas);
        assert_true(areas[2] == 0 && areas[5] > 0);
        const double area = areas[5];
        iir_domain_remove(d, 5);
        assert_int_equal(iir_domain_duplicate_of(d, 2), -1);
        iir_domain_areas(d, areas);
        assert_true(areas[5] == 0);
        near_by(areas[2], area, 1e-11); // 1e-12 along an edge not longer than pi
        assert_int_equal(iir_domain_insert(d, 5, p[0]), FG_OK);
        assert_int_equal(iir_domain_duplicate_of(d, 5), 2);
        iir_domain_remove(d, 5);
        assert_int_equal(iir_domain_count(d), 2);
        iir_domain_destroy(d);
    }
}

static void a_chain_of_near_points_is_told_apart(void **state)
{
    (void) state;
    double p[4][3] = { { 0 } };
    for (int i = 0; i < 4; ++i)
        p[i][0] = 0.7 * IIR_DUPLICATE * i;
    iir_domain *d = domain_with(POINTS_DISC, p, 4);
    assert_int_equal(iir_domain_duplicate_of(d, 1), 0);
    assert_int_equal(iir_domain_duplicate_of(d, 2), -1);
    assert_int_equal(iir_domain_duplicate_of(d, 3), 2);
    iir_domain_remove(d, 0);
    assert_int_equal(iir_domain_duplicate_of(d, 1), 2);
    iir_domain_remove(d, 2);
    assert_int_equal(iir_domain_duplicate_of(d, 1), -1);
    assert_int_equal(iir_domain_duplicate_of(d, 3), -1);
    iir_domain_destroy(d);
}

// ---- mistakes --------------------------------------------------------------------------------

static void what_is_no_point_is_refused(void **state)
{
    (void) state;
    const double good[3] = { 0.6, 0, 0.8 };
    const double bad[][3] = { { (double) NAN, 0, 0 }, { 0, HUGE_VAL, 0 } };
    for (int back = 0; back < POINTS_BACKS; ++back) {
        iir_domain *d = points_domain(&points_backs[back], 4);
        for (int i = 0; i < 2; ++i)
            assert_int_equal(iir_domain_insert(d, 0, bad[i]), FG_ERR_INVALID);
        assert_int_equal(iir_domain_insert(d, -1, good), FG_ERR_INVALID);
        assert_int_equal(iir_domain_insert(d, 4, good), FG_ERR_INVALID);
        assert_int_equal(iir_domain_insert(d, 0, good), FG_OK);
        assert_int_equal(iir_domain_insert(d, 0, good), FG_ERR_INVALID);
        assert_int_equal(iir_domain_insert(d, 1, (double[]){ 0, 0, 0 }),
                         back == POINTS_DISC ? FG_OK : FG_ERR_INVALID);
        iir_domain_remove(d, 3); // is not there
        iir_domain_remove(d, 77);
        assert_int_equal(iir_domain_count(d), back == POINTS_DISC ? 2 : 1);
        assert_int_equal(iir_domain_set(d, bad, (int[]){ 0, 1 }, 2), FG_ERR_INVALID);
        assert_int_equal(iir_domain_count(d), 0);
        assert_int_equal(iir_domain_insert(d, 0, good), FG_OK);
        iir_domain_destroy(d);
    }
}

static void what_is_off_is_brought_back(void **state)
{
    (void) state;
    double at[3];
    for (int back = 0; back < POINTS_BACKS; ++back) {
        iir_domain *d = points_domain(&points_backs[back], 3);
        assert_int_equal(iir_domain_insert(d, 0, (double[]){ 3, 4, 0 }), FG_OK);
        assert_int_equal(iir_domain_insert(d, 1, (double[]){ -1e300, 0, 0 }), FG_OK);
        assert_int_equal(iir_domain_insert(d, 2, (double[]){ 0, 1 + 1e-13, 0 }), FG_OK);
        iir_domain_point(d, 0, at);
        near_by(at[0], 0.6, rounding);
        near_by(at[1], 0.8, rounding);
        iir_domain_point(d, 1, at);
        near_by(at[0], -1, rounding);
        iir_domain_point(d, 2, at);
        near_by(at[1], 1, rounding);
        iir_domain_destroy(d);
    }
    iir_domain_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_all_empty),
        cmocka_unit_test(one_point_has_all_of_the_domain),
        cmocka_unit_test(two_points_share),
        cmocka_unit_test(antipodal_points_leave_the_great_circle_between),
        cmocka_unit_test(a_great_circle_is_cut_into_lunes),
        cmocka_unit_test(solids_are_cut_into_equal_parts),
        cmocka_unit_test(a_point_in_a_ring_has_a_polygon),
        cmocka_unit_test(a_corner_on_the_rim_costs_nothing),
        cmocka_unit_test(case_1_is_a_corner),
        cmocka_unit_test(case_2_is_where_an_edge_meets_the_rim),
        cmocka_unit_test(case_2_has_finite_edges_too),
        cmocka_unit_test(case_3_is_opposite_to_a_point),
        cmocka_unit_test(the_centre_is_on_the_empty_side),
        cmocka_unit_test(in_a_hemisphere_the_centre_may_be_opposite_to_a_middle),
        cmocka_unit_test(of_the_closest_pair_the_more_crowded_goes),
        cmocka_unit_test(only_neighbours_count),
        cmocka_unit_test(the_later_of_two_is_a_duplicate),
        cmocka_unit_test(a_chain_of_near_points_is_told_apart),
        cmocka_unit_test(what_is_no_point_is_refused),
        cmocka_unit_test(what_is_off_is_brought_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
