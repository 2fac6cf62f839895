// SPDX-License-Identifier: MIT
// Domains that live long: points come and go, memory runs out.
#include "iir_points.h"
#include "starve_bridge.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { POOL = 64 };

static double points[POINTS_MAX][3];
static double areas[POINTS_MAX], fresh_areas[POINTS_MAX];

static points_case case_of(int back, int capacity, uint64_t *random, const char *what)
{
    return (points_case){ .d = points_domain(&points_backs[back], capacity),
                          .back = &points_backs[back],
                          .capacity = capacity,
                          .random = random,
                          .what = what };
}

// The same points, set at once, say the same. To the bit where the triangulation is the same one:
// on the sphere's surface always; elsewhere four points on a circle may be joined in two ways.
static void equals_a_fresh_one(const points_case *c, iir_domain *fresh, bool exactly)
{
    int ids[POOL], count = 0;
    double at[POOL][3], centre[3], fresh_centre[3];
    for (int id = 0; id < c->capacity; ++id) {
        if (!iir_domain_has(c->d, id))
            continue;
        if (iir_domain_duplicate_of(c->d, id) >= 0)
            return; // which of them is the duplicate depends on the past
        ids[count] = id;
        iir_domain_point(c->d, id, at[count++]);
    }
    assert_int_equal(iir_domain_set(fresh, (const double(*)[3]) at, ids, count), FG_OK);
    iir_domain_areas(c->d, areas);
    iir_domain_areas(fresh, fresh_areas);
    for (int id = 0; id < c->capacity; ++id)
        if (exactly ? areas[id] != fresh_areas[id] : !(fabs(areas[id] - fresh_areas[id]) <= 1e-9))
            fail_msg("%s, %s: the cell of %d is %.17g, was %.17g", c->back->name, c->what, id,
                     fresh_areas[id], areas[id]);
    const double radius = iir_domain_largest_empty_circle(c->d, centre);
    const double fresh_radius = iir_domain_largest_empty_circle(fresh, fresh_centre);
    assert_true(iir_domain_least_distance(c->d) == iir_domain_least_distance(fresh));
    assert_true(fabs(radius - fresh_radius) <= (exactly ? 0 : POINTS_SLACK));
    if (!exactly)
        return;
    assert_memory_equal(centre, fresh_centre, sizeof centre);
    assert_int_equal(iir_domain_redundant(c->d), iir_domain_redundant(fresh));
}

static void cycle(int back, int kind, int steps)
{
    uint64_t random = 5;
    char what[64];
    const bool generic = kind == POINTS_UNIFORM || kind == POINTS_CLUSTER;
    const points_case c = case_of(back, POOL, &random, what);
    iir_domain *fresh = points_domain(c.back, POOL);
    points_make((points_kind) kind, c.back->space, &random, POOL, points);
    for (int step = 0; step < steps; ++step) {
        const int id = (int) (points_random(&random) * POOL);
        snprintf(what, sizeof what, "kind %d step %d", kind, step);
        if (iir_domain_has(c.d, id))
            iir_domain_remove(c.d, id);
        else
            assert_int_equal(iir_domain_insert(c.d, id, points[id]), FG_OK);
        if (step % 3 == 0)
            (void) iir_domain_redundant(c.d);
        if (step % 256 != 255)
            continue;
        points_areas_hold(&c);
        points_circle_holds(&c, 20);
        points_deletion_holds(&c);
        equals_a_fresh_one(&c, fresh, generic || back == POINTS_SPHERE);
    }
    iir_domain_destroy(fresh);
    iir_domain_destroy(c.d);
}

static void a_hundred_thousand_cycles_leave_no_trace(void **state)
{
    (void) state;
    for (int back = 0; back < POINTS_BACKS; ++back)
        for (int kind = 0; kind < POINTS_KINDS; ++kind)
            cycle(back, kind, back == POINTS_TETRA ? 700 : 7000);
}

// Down to none and up again, by every way there is.
static void few_points_come_and_go(void **state)
{
    (void) state;
    uint64_t random = 3;
    char what[64];
    for (int run = 0; run < POINTS_BACKS * 5 * 60; ++run) {
        const int n = 2 + run / POINTS_BACKS % 5;
        const points_case c = case_of(run % POINTS_BACKS, n, &random, what);
        for (int step = 0; step < 30; ++step) {
            double place[3];
            const int id = (int) (points_random(&random) * n);
            points_random_place(&random, c.back->space, place);
            if (iir_domain_has(c.d, id))
                iir_domain_remove(c.d, id);
            else
                assert_int_equal(iir_domain_insert(c.d, id, place), FG_OK);
            snprintf(what, sizeof what, "run %d step %d", run, step);
            points_areas_hold(&c);
            points_circle_holds(&c, 10);
            points_deletion_holds(&c);
        }
        iir_domain_destroy(c.d);
    }
}

// Where points went, after a number of sets of the same points.
static void run_of(int back, int sets, double (*centres)[3], int count)
{
    iir_domain *d = points_domain(&points_backs[back], 60);
    uint64_t random = 9;
    points_make(POINTS_UNIFORM, points_backs[back].space, &random, 50, points);
    for (int set = 0; set < sets; ++set)
        points_set(d, points, 50);
    for (int i = 0; i < count; ++i) {
        iir_domain_largest_empty_circle(d, centres[i]);
        assert_int_equal(iir_domain_insert(d, points_free_id(d), centres[i]), FG_OK);
        iir_domain_remove(d, iir_domain_redundant(d));
    }
    iir_domain_destroy(d);
}

static void equal_calls_give_equal_bits(void **state)
{
    (void) state;
    for (int back = 0; back < POINTS_BACKS; ++back) {
        double centres[3][40][3];
        for (int run = 0; run < 3; ++run) // the past does not matter either
            run_of(back, run < 2 ? 1 : 2, centres[run], 40);
        assert_memory_equal(centres[0], centres[1], sizeof centres[0]);
        assert_memory_equal(centres[0], centres[2], sizeof centres[0]);
    }
}

// One step with so many allocations of the triangulation granted; whether they sufficed.
static bool starved_step(const points_case *c, int granted, int step)
{
    double centre[3];
    fg_status status = FG_OK;
    const int before = iir_domain_count(c->d);
    starve_after(granted);
    switch (step) {
    case 0: status = iir_domain_insert(c->d, 20, (double[]){ 0.48, 0.64, 0.6 }); break;
    case 1: iir_domain_remove(c->d, 7); break;
    case 2: (void) iir_domain_redundant(c->d); break;
    default: (void) iir_domain_largest_empty_circle(c->d, centre); break;
    }
    iir_domain_areas(c->d, areas);
    starve_after(-1);
    const int after = iir_domain_count(c->d);
    assert_true(status == FG_OK || (status == FG_ERR_MEMORY && after == 0));
    assert_true(after == 0 || after == before + (step == 0) - (step == 1));
    points_areas_hold(c);
    return after > 0;
}

// Not of the tetrahedra: see delaunay_bridge.h.
static void without_memory_a_domain_is_empty(void **state)
{
    (void) state;
    uint64_t random = 8;
    for (int back = 0; back <= POINTS_SPHERE; ++back) {
        const points_case c = case_of(back, 24, &random, "starved");
        points_make(POINTS_UNIFORM, c.back->space, &random, 20, points);
        for (int step = 0; step < 4; ++step)
            for (int granted = 0;; ++granted) {
                points_set(c.d, points, 20);
                if (starved_step(&c, granted, step))
                    break;
            }
        iir_domain_destroy(c.d);
    }
}

static void without_memory_there_is_no_domain(void **state)
{
    (void) state;
    const iir_domain_desc desc = { .space = IIR_SPHERE, .capacity = 24 };
    starve_after(0);
    iir_domain *d = iir_domain_create(&desc);
    starve_after(-1);
    assert_null(d);
}

static void a_set_that_fails_leaves_nothing(void **state)
{
    (void) state;
    uint64_t random = 8;
    int ids[20];
    for (int i = 0; i < 20; ++i)
        ids[i] = i;
    for (int back = 0; back <= POINTS_SPHERE; ++back) {
        fg_status status = FG_ERR_MEMORY;
        points_make(POINTS_UNIFORM, points_backs[back].space, &random, 20, points);
        for (int granted = 0; status == FG_ERR_MEMORY; ++granted) {
            const points_case c = case_of(back, 24, &random, "starved");
            starve_after(granted);
            status = iir_domain_set(c.d, (const double(*)[3]) points, ids, 20);
            starve_after(-1);
            assert_int_equal(iir_domain_count(c.d), status == FG_OK ? 20 : 0);
            points_areas_hold(&c);
            points_set(c.d, points, 20);
            points_areas_hold(&c);
            points_deletion_holds(&c);
            iir_domain_destroy(c.d);
        }
        assert_int_equal(status, FG_OK);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hundred_thousand_cycles_leave_no_trace),
        cmocka_unit_test(few_points_come_and_go),
        cmocka_unit_test(equal_calls_give_equal_bits),
        cmocka_unit_test(without_memory_a_domain_is_empty),
        cmocka_unit_test(without_memory_there_is_no_domain),
        cmocka_unit_test(a_set_that_fails_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
