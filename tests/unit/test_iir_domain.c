// SPDX-License-Identifier: MIT
// Thousands of point sets, ordinary and contrived, against brute force.
#include "iir_points.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>

static double points[POINTS_MAX][3];
static double areas[POINTS_MAX];
static int ids[POINTS_MAX];
static points_corners corners;

static const struct {
    iir_space space;
    iir_triangulation triangulation;
    const char *name;
} backs[] = {
    { IIR_DISC, IIR_TRIANGULATION_DEFAULT, "disc" },
    { IIR_SPHERE, IIR_TRIANGULATION_DEFAULT, "sphere" },
    { IIR_SPHERE, IIR_TRIANGULATION_TETRA, "tetra" },
};

static double whole(iir_space space)
{
    return space == IIR_DISC ? M_PI : 4 * M_PI;
}

static iir_domain *domain_of(int back, int capacity)
{
    const iir_domain_desc desc = { .space = backs[back].space,
                                   .triangulation = backs[back].triangulation,
                                   .capacity = capacity };
    iir_domain *d = iir_domain_create(&desc);
    assert_non_null(d);
    return d;
}

static void set_points(iir_domain *d, int count)
{
    for (int i = 0; i < count; ++i)
        ids[i] = i;
    assert_int_equal(iir_domain_set(d, (const double(*)[3]) points, ids, count), FG_OK);
}

static void areas_hold(iir_domain *d, int back, int capacity, const char *what)
{
    double sum = 0;
    iir_domain_areas(d, areas);
    for (int id = 0; id < capacity; ++id) {
        const bool corner = iir_domain_has(d, id) && iir_domain_duplicate_of(d, id) < 0;
        if (corner ? !(areas[id] > 0) : areas[id] != 0)
            fail_msg("%s, %s: the cell of %d is %g", backs[back].name, what, id, areas[id]);
        sum += areas[id];
    }
    const double all = iir_domain_count(d) > 0 ? whole(backs[back].space) : 0;
    if (!(fabs(sum - all) <= 1e-9))
        fail_msg("%s, %s, %d points: areas sum to %.17g, off by %g", backs[back].name, what,
                 iir_domain_count(d), sum, sum - all);
}

// The circle is empty, and none of `probes` places is farther from all points.
static void circle_holds(iir_domain *d, int back, uint64_t *state, int probes, const char *what)
{
    int which = -1;
    double centre[3], place[3];
    const double radius = iir_domain_largest_empty_circle(d, centre);
    if (corners.count == 0)
        return;
    const double norm = sqrt(centre[0] * centre[0] + centre[1] * centre[1] + centre[2] * centre[2]);
    assert_true(norm <= 1 + 1e-15 && (backs[back].space == IIR_DISC || norm >= 1 - 1e-15));
    // Corners of thin triangles are known to 1e-9 at points IIR_DUPLICATE apart, see domain_disc.c.
    const double slack = 1e-8;
    const double true_radius = points_nearest(&corners, centre, &which);
    if (!(fabs(true_radius - radius) <= slack))
        fail_msg("%s, %s, %d: the circle has radius %.17g, its next point is at %.17g",
                 backs[back].name, what, corners.count, radius, true_radius);
    for (int i = 0; i < probes; ++i) {
        points_random_place(state, backs[back].space, place);
        if (points_nearest(&corners, place, &which) > radius + slack)
            fail_msg("%s, %s, %d: %g at (%g %g %g) beats %g", backs[back].name, what, corners.count,
                     points_nearest(&corners, place, &which), place[0], place[1], place[2], radius);
    }
}

static void deletion_holds(iir_domain *d, int back, int capacity, const char *what)
{
    int same = -1;
    const int id = iir_domain_redundant(d);
    if (iir_domain_count(d) < 2) {
        assert_int_equal(id, -1);
        return;
    }
    for (int i = 0; i < capacity; ++i)
        if (iir_domain_duplicate_of(d, i) >= 0)
            same = i;
    if (same >= 0) {
        assert_int_equal(id, same);
        return;
    }
    const double least = iir_domain_least_distance(d);
    assert_true(least == points_least_distance(&corners));
    if (!points_redundant(&corners, backs[back].space, id))
        fail_msg("%s, %s, %d points: %d is not the one to take", backs[back].name, what,
                 corners.count, id);
}

static void all_holds(iir_domain *d, int back, int capacity, uint64_t *state, const char *what)
{
    points_corners_of(d, capacity, &corners);
    areas_hold(d, back, capacity, what);
    circle_holds(d, back, state, 200, what);
    deletion_holds(d, back, capacity, what);
}

static const int sizes[] = { 0, 1, 2, 3, 4, 5, 6, 7, 9, 12, 16, 25, 48 };

static void sets_of_all_kinds_hold(void **state)
{
    (void) state;
    uint64_t random = 1;
    char what[64];
    for (int back = 0; back < FG_COUNT(backs); ++back)
        for (int kind = 0; kind < POINTS_KINDS; ++kind)
            for (int i = 0; i < FG_COUNT(sizes); ++i) {
                const int n = sizes[i];
                iir_domain *d = domain_of(back, n + 1);
                for (int round = 0; round < 4; ++round) {
                    snprintf(what, sizeof what, "kind %d round %d", kind, round);
                    points_make((points_kind) kind, backs[back].space, &random, n, points);
                    set_points(d, n);
                    all_holds(d, back, n + 1, &random, what);
                }
                iir_domain_destroy(d);
            }
}

// Insertion at the centre never makes the circle larger, deletion never brings points together.
static void steps_hold(void **state)
{
    (void) state;
    char what[64];
    uint64_t random = 2;
    for (int back = 0; back < FG_COUNT(backs); ++back)
        for (int kind = 0; kind < POINTS_KINDS; ++kind) {
            const int n = 24;
            iir_domain *d = domain_of(back, n + 8);
            points_make((points_kind) kind, backs[back].space, &random, n, points);
            set_points(d, n);
            for (int step = 0; step < 16; ++step) {
                double centre[3];
                const double before = iir_domain_largest_empty_circle(d, centre);
                int id = 0;
                while (iir_domain_has(d, id))
                    ++id;
                assert_int_equal(iir_domain_insert(d, id, centre), FG_OK);
                const double after = iir_domain_largest_empty_circle(d, centre);
                assert_true(after <= before + 1e-8);
                points_corners_of(d, n + 8, &corners);
                snprintf(what, sizeof what, "kind %d after insertion", kind);
                all_holds(d, back, n + 8, &random, what);

                const double least = iir_domain_least_distance(d);
                iir_domain_remove(d, iir_domain_redundant(d));
                assert_true(iir_domain_least_distance(d) >= least);
                snprintf(what, sizeof what, "kind %d after deletion", kind);
                all_holds(d, back, n + 8, &random, what);
            }
            iir_domain_destroy(d);
        }
}

// Down to none and up again, by every way there is.
static void few_points_come_and_go(void **state)
{
    (void) state;
    uint64_t random = 3;
    char what[64];
    for (int run = 0; run < FG_COUNT(backs) * 5 * 60; ++run) {
        const int back = run % FG_COUNT(backs), n = 2 + run / FG_COUNT(backs) % 5;
        iir_domain *d = domain_of(back, n);
        for (int step = 0; step < 30; ++step) {
            double place[3];
            const int id = (int) (points_random(&random) * n);
            points_random_place(&random, backs[back].space, place);
            if (iir_domain_has(d, id))
                iir_domain_remove(d, id);
            else
                assert_int_equal(iir_domain_insert(d, id, place), FG_OK);
            points_corners_of(d, n, &corners);
            snprintf(what, sizeof what, "run %d step %d", run, step);
            areas_hold(d, back, n, what);
        }
        iir_domain_destroy(d);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sets_of_all_kinds_hold),
        cmocka_unit_test(steps_hold),
        cmocka_unit_test(few_points_come_and_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
