// SPDX-License-Identifier: MIT
#include "reference_priv.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

enum { LOG_COUNT = 8, COUNT = 1 << LOG_COUNT };

// A (0,2)-sequence: of the first 2^m points, every box of 2^-a by 2^-(m-a) holds exactly one.
// Owen's scrambling keeps that.
static void every_elementary_box_holds_one_point(void **state)
{
    (void) state;
    const sampler s = sampler_of(7, 3, 5);
    for (uint32_t pair = 0; pair < 5; ++pair)
        for (int m = 0; m <= LOG_COUNT; ++m)
            for (int a = 0; a <= m; ++a) {
                bool taken[COUNT] = { false };
                for (uint32_t i = 0; i < 1u << m; ++i) {
                    double u[2];
                    sampler_pair(s, i, pair, u);
                    assert_true(u[0] >= 0 && u[0] < 1 && u[1] >= 0 && u[1] < 1);
                    const int box =
                        (int) (u[0] * (1 << a)) << (m - a) | (int) (u[1] * (1 << (m - a)));
                    assert_false(taken[box]);
                    taken[box] = true;
                }
            }
}

// Correlation of 256 independent numbers is 1 / 16 give or take; five of that is 0.31.
static void pairs_pixels_and_seeds_are_strangers(void **state)
{
    (void) state;
    const sampler s = sampler_of(7, 3, 5);
    const struct {
        sampler s;
        uint32_t pair;
    } others[] = { { s, 2 },
                   { sampler_of(7, 4, 5), 1 },
                   { sampler_of(7, 5, 3), 1 },
                   { sampler_of(8, 3, 5), 1 },
                   { sampler_of(7ull | 1ull << 40, 3, 5), 1 } };
    for (int k = 0; k < FG_COUNT(others); ++k)
        for (int a = 0; a < 2; ++a)
            for (int b = 0; b < 2; ++b) {
                double sum = 0;
                for (uint32_t i = 0; i < COUNT; ++i) {
                    double u[2], v[2];
                    sampler_pair(s, i, 1, u);
                    sampler_pair(others[k].s, i, others[k].pair, v);
                    sum += (u[a] - 0.5) * (v[b] - 0.5) * 12;
                }
                assert_true(fabs(sum / COUNT) < 5.0 / 16);
            }
}

static void a_sample_depends_on_its_numbers_alone(void **state)
{
    (void) state;
    double u[2], v[2];
    sampler_pair(sampler_of(1, 2, 3), 4, 5, u);
    sampler_pair(sampler_of(1, 2, 3), 9, 9, v);
    sampler_pair(sampler_of(1, 2, 3), 4, 5, v);
    assert_memory_equal(u, v, sizeof u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_elementary_box_holds_one_point),
        cmocka_unit_test(pairs_pixels_and_seeds_are_strangers),
        cmocka_unit_test(a_sample_depends_on_its_numbers_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
