// SPDX-License-Identifier: MIT
#include "last_log.h"
#include "metrics.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const fg_log logger = { .fn = remember, .level = FG_LOG_WARN };

// Sums of a few numbers in double: what is left is rounding.
static const double tiny = 1e-12;

static image picture(int width, int height)
{
    image img;
    assert_int_equal(image_create(&logger, width, height, &img), FG_OK);
    return img;
}

static void near_by(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not %.17g", a, b);
}

static void equal_pictures_have_no_error(void **state)
{
    (void) state;
    metrics m;
    image a = picture(5, 3);
    for (int i = 0; i < 45; ++i)
        a.rgb[i] = (float) i * 0.25f;
    assert_int_equal(metrics_compare(&logger, &a, &a, &m), FG_OK);
    assert_true(m.rmse == 0 && m.rmse_rms == 0 && m.rmse_max == 0 && m.relmse == 0);
    assert_true(m.smape == 0 && m.bias == 0 && m.p99 == 0 && m.nonfinite == 0);
    assert_true(m.energy_ratio == 1);
    image_finish(&a);
}

// a = 2 1 0, b = 1 1 2: d = 1 0 -2.
static void values_are_those_by_hand(void **state)
{
    (void) state;
    metrics m;
    image a = picture(1, 1), b = picture(1, 1);
    memcpy(a.rgb, (const float[]){ 2, 1, 0 }, 3 * sizeof(float));
    memcpy(b.rgb, (const float[]){ 1, 1, 2 }, 3 * sizeof(float));
    assert_int_equal(metrics_compare(&logger, &a, &b, &m), FG_OK);
    near_by(m.rmse, sqrt(5.0 / 3), tiny);
    near_by(m.rmse_rms, sqrt(5.0 / 6), tiny);
    near_by(m.rmse_max, sqrt(5.0 / 3) / 2, tiny);
    const double e = 0.01 * 16 / 9; // 0.01 mean(b)^2
    near_by(m.relmse, (1 / (1 + e) + 4 / (4 + e)) / 3, tiny);
    near_by(m.smape, (2.0 / 3 + 0 + 2) / 3, tiny);
    near_by(m.bias, -1.0 / 3, tiny);
    near_by(m.energy_ratio, 3.0 / 4, tiny);
    near_by(m.p99, 2, tiny);
    assert_int_equal(m.nonfinite, 0);
    image_finish(&a);
    image_finish(&b);
}

static void nonfinite_pixels_are_counted_and_left_out(void **state)
{
    (void) state;
    metrics m;
    image a = picture(4, 1), b = picture(4, 1);
    for (int i = 0; i < 12; ++i)
        a.rgb[i] = b.rgb[i] = 1;
    a.rgb[0] = NAN;
    a.rgb[1] = INFINITY; // the same pixel
    b.rgb[5] = -INFINITY;
    a.rgb[9] = 3;
    assert_int_equal(metrics_compare(&logger, &a, &b, &m), FG_OK);
    assert_int_equal(m.nonfinite, 2);
    near_by(m.rmse, sqrt(4.0 / 6), tiny);
    near_by(m.bias, 2.0 / 6, tiny);
    for (int i = 0; i < 12; ++i)
        a.rgb[i] = NAN;
    assert_int_equal(metrics_compare(&logger, &a, &b, &m), FG_OK);
    assert_int_equal(m.nonfinite, 4);
    assert_true(isnan(m.rmse) && isnan(m.rmse_rms) && isnan(m.rmse_max) && isnan(m.relmse));
    assert_true(isnan(m.smape) && isnan(m.bias) && isnan(m.energy_ratio) && isnan(m.p99));
    image_finish(&a);
    image_finish(&b);
}

static void a_black_reference_gives_no_nan(void **state)
{
    (void) state;
    metrics m;
    image a = picture(2, 2), b = picture(2, 2);
    assert_int_equal(metrics_compare(&logger, &a, &b, &m), FG_OK);
    assert_true(m.rmse_rms == 0 && m.rmse_max == 0 && m.relmse == 0 && m.smape == 0);
    assert_true(m.energy_ratio == 1);
    a.rgb[4] = 1;
    assert_int_equal(metrics_compare(&logger, &a, &b, &m), FG_OK);
    assert_true(isinf(m.energy_ratio) && isinf(m.rmse_rms) && isinf(m.rmse_max));
    assert_int_equal(metrics_compare(&logger, &b, &a, &m), FG_OK);
    assert_true(m.energy_ratio == 0);
    image_finish(&a);
    image_finish(&b);
}

// 3000 channels: |d| is 1 .. 3000 in a scrambled order (7 is coprime to 3000).
static void p99_and_the_trimmed_mean_are_order_statistics(void **state)
{
    (void) state;
    metrics m;
    image a = picture(50, 20), b = picture(50, 20);
    double sum = 0;
    for (int i = 0; i < 3000; ++i) {
        b.rgb[i] = 1000;
        a.rgb[i] = 1000 + (float) ((i * 7) % 3000 + 1) * (i % 2 ? 1.0f : -1.0f);
    }
    for (int d = 1; d <= 2997; ++d) // the three worst of 3000 are trimmed
        sum += (double) d * d / (1e6 + 1e4);
    assert_int_equal(metrics_compare(&logger, &a, &b, &m), FG_OK);
    near_by(m.p99, 2970, tiny);
    near_by(m.relmse, sum / 2997, 1e-9);
    image_finish(&a);
    image_finish(&b);
}

static void extreme_values_do_not_overflow(void **state)
{
    (void) state;
    metrics m;
    image a = picture(1, 1), b = picture(1, 1);
    a.rgb[0] = 3e38f;
    b.rgb[0] = -3e38f;
    a.rgb[1] = b.rgb[1] = 1e-40f;
    assert_int_equal(metrics_compare(&logger, &a, &b, &m), FG_OK);
    near_by(m.rmse / (6e38 / sqrt(3)), 1, 1e-6);
    assert_true(isfinite(m.relmse) && isfinite(m.smape));
    image_finish(&a);
    image_finish(&b);
}

// 5^2 - 3^2 = 4^2, over and under the line.
static void noise_is_taken_out_of_error_and_reference(void **state)
{
    (void) state;
    const metrics m = { .rmse = 5 };
    near_by(metrics_without_noise(&m, 5, 3), 1, tiny);
    near_by(metrics_without_noise(&m, 10, 0), 0.5, tiny);
    assert_true(isnan(metrics_without_noise(&m, 10, 5)));
    assert_true(isnan(metrics_without_noise(&m, 3, 3)));
}

static void different_sizes_are_refused(void **state)
{
    (void) state;
    metrics m;
    image a = picture(4, 2), b = picture(2, 4), map;
    assert_int_equal(metrics_compare(&logger, &a, &b, &m), FG_ERR_INVALID);
    assert_string_equal(last, "compare: sizes differ: 4 x 2 and 2 x 4");
    assert_int_equal(metrics_error_map(&logger, &a, &b, 1, &map), FG_ERR_INVALID);
    assert_null(map.rgb);
    image_finish(&a);
    image_finish(&b);
}

static void the_error_map_shows_sign_size_and_holes(void **state)
{
    (void) state;
    image a = picture(5, 1), b = picture(5, 1), map;
    a.rgb[3] = 1;  // half of the scale too bright, in one channel
    a.rgb[7] = -5; // beyond the scale, too dark
    a.rgb[9] = NAN;
    b.rgb[12] = 1, a.rgb[14] = 1.5f; // both ways: the larger counts
    const float expected[] = { 1, 1, 1, 1, 0.5f, 0.5f, 0, 0, 1, 0, 1, 0, 1, 0.25f, 0.25f };
    assert_int_equal(metrics_error_map(&logger, &a, &b, 2, &map), FG_OK);
    assert_memory_equal(map.rgb, expected, sizeof expected);
    image_finish(&map);
    const double bad[] = { 0, -1, nan(""), HUGE_VAL };
    for (int i = 0; i < FG_COUNT(bad); ++i) {
        assert_int_equal(metrics_error_map(&logger, &a, &b, bad[i], &map), FG_ERR_INVALID);
        assert_non_null(strstr(last, "must be above 0"));
    }
    image_finish(&a);
    image_finish(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures_have_no_error),
        cmocka_unit_test(values_are_those_by_hand),
        cmocka_unit_test(nonfinite_pixels_are_counted_and_left_out),
        cmocka_unit_test(a_black_reference_gives_no_nan),
        cmocka_unit_test(p99_and_the_trimmed_mean_are_order_statistics),
        cmocka_unit_test(extreme_values_do_not_overflow),
        cmocka_unit_test(noise_is_taken_out_of_error_and_reference),
        cmocka_unit_test(different_sizes_are_refused),
        cmocka_unit_test(the_error_map_shows_sign_size_and_holes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
