// SPDX-License-Identifier: MIT
// Thousands of point sets, ordinary and contrived, against brute force.
#include "iir_points.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>

static double points[POINTS_MAX][3];
static double areas[POINTS_MAX], other_areas[POINTS_MAX];
static points_corners corners;

static uint64_t random_state;
static char what[64];

static points_case case_of(int back, int capacity)
{
    return (points_case){ .d = points_domain(&points_backs[back], capacity),
                          .back = &points_backs[back],
                          .capacity = capacity,
                          .random = &random_state,
                          .what = what };
}

static void set_kind(const points_case *c, int kind, int count)
{
    snprintf(what, sizeof what, "kind %d", kind);
    points_make((points_kind) kind, c->back->space, c->random, count, points);
    points_set(c->d, points, count);
}

// Calls for every back end and kind of set.
static void for_all(void (*check)(int back, int kind))
{
    random_state = 1;
    for (int back = 0; back < POINTS_BACKS; ++back)
        for (int kind = 0; kind < POINTS_KINDS; ++kind)
            check(back, kind);
}

static void check_sets(int back, int kind)
{
    static const int sizes[] = { 0, 1, 2, 3, 4, 5, 6, 7, 9, 12, 16, 25, 48 };
    for (int i = 0; i < FG_COUNT(sizes); ++i) {
        const points_case c = case_of(back, sizes[i] + 1);
        for (int round = 0; round < (back == POINTS_TETRA ? 4 : 12); ++round) {
            set_kind(&c, kind, sizes[i]);
            points_areas_hold(&c);
            points_circle_holds(&c, 100);
            points_deletion_holds(&c);
        }
        iir_domain_destroy(c.d);
    }
}

static void sets_of_all_kinds_hold(void **state)
{
    (void) state;
    for_all(check_sets);
}

static void check_probes(int back, int kind)
{
    const points_case c = case_of(back, 40);
    set_kind(&c, kind, 40);
    points_circle_holds(&c, 100000);
    iir_domain_destroy(c.d);
}

static void nothing_beats_the_largest_empty_circle(void **state)
{
    (void) state;
    for_all(check_probes);
}

// Insertion at the centre never makes the circle larger. Deletion never brings points together, and
// parts them if there is one closest pair.
static void check_steps(int back, int kind)
{
    const int capacity = 32;
    const points_case c = case_of(back, capacity);
    set_kind(&c, kind, 24);
    for (int step = 0; step < 16; ++step) {
        double centre[3];
        const double radius = iir_domain_largest_empty_circle(c.d, centre);
        assert_int_equal(iir_domain_insert(c.d, points_free_id(c.d), centre), FG_OK);
        assert_true(iir_domain_largest_empty_circle(c.d, centre) <= radius + POINTS_SLACK);
        points_areas_hold(&c);
        points_circle_holds(&c, 50);
        points_deletion_holds(&c);

        const double least = iir_domain_least_distance(c.d);
        const int gone = iir_domain_redundant(c.d);
        const bool corner = iir_domain_duplicate_of(c.d, gone) < 0;
        points_corners_of(c.d, capacity, &corners);
        iir_domain_remove(c.d, gone);
        assert_true(iir_domain_least_distance(c.d) >= least);
        if (corner && points_pairs_at(&corners, least) == 1)
            assert_true(iir_domain_least_distance(c.d) > least);
        points_areas_hold(&c);
        points_circle_holds(&c, 50);
        points_deletion_holds(&c);
    }
    iir_domain_destroy(c.d);
}

static void steps_hold(void **state)
{
    (void) state;
    for_all(check_steps);
}

// A cell is what is nearer to its point than to others: shares of random places.
static void check_shares(int back, int kind)
{
    static int hits[POINTS_MAX];
    const int count = 20, places = 40000;
    const points_case c = case_of(back, count);
    set_kind(&c, kind, count);
    points_corners_of(c.d, count, &corners);
    iir_domain_areas(c.d, areas);
    for (int i = 0; i < corners.count; ++i)
        hits[i] = 0;
    for (int i = 0; i < places; ++i) {
        int which = 0;
        double place[3];
        points_random_place(c.random, c.back->space, place);
        points_nearest(&corners, place, &which);
        ++hits[which];
    }
    for (int i = 0; i < corners.count; ++i) {
        const double share = areas[corners.ids[i]] / (c.back->space == IIR_DISC ? M_PI : 4 * M_PI);
        // Six standard deviations of a binomial distribution, two in a thousand million; and one
        // hit more, where its tail is longer than a normal one's.
        const double slack = 6 * sqrt(places * share * (1 - share)) + 1;
        if (!(fabs(hits[i] - places * share) <= slack))
            fail_msg("%s, kind %d: %d has %d of %d places, %g expected", c.back->name, kind,
                     corners.ids[i], hits[i], places, places * share);
    }
    iir_domain_destroy(c.d);
}

static void cells_are_what_is_nearest(void **state)
{
    (void) state;
    for_all(check_shares);
}

// The most points there may be, one short of that of the tetrahedra, which take long.
static void check_many(int back, int kind)
{
    const int count = back == POINTS_TETRA ? 256 : POINTS_MAX;
    const points_case c = case_of(back, count);
    set_kind(&c, kind, count);
    points_areas_hold(&c);
    points_circle_holds(&c, 100);
    iir_domain_destroy(c.d);
}

static void many_points_hold(void **state)
{
    (void) state;
    for_all(check_many);
}

static void sphere_and_tetrahedra_agree(void **state)
{
    (void) state;
    random_state = 4;
    double centres[2][3];
    for (int kind = 0; kind < POINTS_KINDS; ++kind)
        for (int count = 0; count < 120; count = count * 3 / 2 + 1) {
            const points_case a = case_of(POINTS_SPHERE, count + 1);
            const points_case b = case_of(POINTS_TETRA, count + 1);
            set_kind(&a, kind, count);
            points_set(b.d, points, count);
            iir_domain_areas(a.d, areas);
            iir_domain_areas(b.d, other_areas);
            for (int i = 0; i < count; ++i)
                if (!(fabs(areas[i] - other_areas[i]) <= 1e-9))
                    fail_msg("kind %d, %d points: the cell of %d is %g or %g", kind, count, i,
                             areas[i], other_areas[i]);
            assert_true(fabs(iir_domain_largest_empty_circle(a.d, centres[0]) -
                             iir_domain_largest_empty_circle(b.d, centres[1])) <= POINTS_SLACK);
            assert_true(iir_domain_least_distance(a.d) == iir_domain_least_distance(b.d));
            iir_domain_destroy(a.d);
            iir_domain_destroy(b.d);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sets_of_all_kinds_hold),
        cmocka_unit_test(nothing_beats_the_largest_empty_circle),
        cmocka_unit_test(steps_hold),
        cmocka_unit_test(cells_are_what_is_nearest),
        cmocka_unit_test(many_points_hold),
        cmocka_unit_test(sphere_and_tetrahedra_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
