// SPDX-License-Identifier: MIT
#include <pass/math.h>
#include <pass/vpl.h>
#include <pass/vpl_shared.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

// IEEE 754 binary16, straight from its definition.
static double from_half(uint32_t h)
{
    const int exponent = (int) (h >> 10 & 31);
    const double mantissa = h & 0x3ff;
    const double size = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return h & 0x8000 ? -size : size;
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

// vpl_frame() and what the gather does with an edge, times sqrt(A_j).
static void edge_of(const struct ag_vpl *v, int which, double out[3])
{
    const float *m = v->normal;
    const float s = m[2] < 0 ? -1.0f : 1.0f, a = -1.0f / (s + m[2]), c = m[0] * m[1] * a;
    const float t[3] = { 1.0f + s * m[0] * m[0] * a, s * c, -s * m[0] };
    const float b[3] = { c, s + m[1] * m[1] * a, -m[1] };
    const uint32_t bits = bits_of(which ? v->flux[3] : v->normal[3]);
    for (int k = 0; k < 3; k++)
        out[k] =
            (from_half(bits & 0xffff) * (double) t[k] + from_half(bits >> 16) * (double) b[k]) *
            sqrt((double) v->position_area[3]);
}

// Its plane is that of the normal 0 0 1, in which the frame is 1 0 0 and 0 1 0.
static ag_vpl_patch flat(float x, float y)
{
    return (ag_vpl_patch){ .normal = { 0, 0, 1 }, .area = 1, .edges = { { x, y, 0 } } };
}

static uint32_t packed(float x, float y)
{
    struct ag_vpl v;
    const ag_vpl_patch patch = flat(x, y);
    ag_vpl_from_host(&patch, &v);
    return bits_of(v.normal[3]);
}

static void every_half_float_below_1000_keeps_its_bits(void **state)
{
    (void) state;
    for (uint32_t h = 0; from_half(h) <= 1e3; h++) {
        const float value = (float) from_half(h);
        assert_int_equal(packed(value, 0) & 0xffff, h);
        assert_int_equal(packed(0, value) >> 16, h);
        if (h > 0)
            assert_int_equal(packed(-value, -value), (h | 0x8000) * 0x10001u);
    }
}

static void values_between_go_to_the_nearest_and_ties_to_even(void **state)
{
    (void) state;
    for (uint32_t h = 0; from_half(h + 1) <= 1e3; h++) {
        const float middle = (float) (0.5 * (from_half(h) + from_half(h + 1)));
        assert_int_equal(packed(middle, 0) & 0xffff, h + (h & 1));
        assert_int_equal(packed(nextafterf(middle, 0), 0) & 0xffff, h);
        assert_int_equal(packed(nextafterf(middle, 1e4f), 0) & 0xffff, h + 1);
    }
}

static void long_edges_are_cut_off_and_broken_ones_finite(void **state)
{
    (void) state;
    const float broken[] = { 1e30f, INFINITY, -1e30f, -INFINITY, NAN };
    for (int i = 0; i < 5; i++) {
        const ag_vpl_patch patch = flat(broken[i], 1);
        struct ag_vpl v;
        ag_vpl_from_host(&patch, &v);
        assert_true(isfinite(v.normal[3]));
        assert_true(fabs(from_half(bits_of(v.normal[3]) & 0xffff)) == 1e3);
    }
    struct ag_vpl v;
    ag_vpl_patch none = flat(1, 1);
    none.area = 0;
    ag_vpl_from_host(&none, &v);
    assert_true(v.position_area[3] == 0 && v.normal[3] == 0 && v.flux[3] == 0);
}

static void edges_come_back_in_metres(void **state)
{
    (void) state;
    for (int i = 0; i < 1000; i++) {
        const double z = 2 * ((i * 37) % 1000 + 0.5) / 1000 - 1, phi = 2.4 * i;
        const double r = sqrt(1 - z * z), n[3] = { r * cos(phi), r * sin(phi), z };
        const double scale = pow(10, i % 9 - 4), turn = 0.7 * i;
        double t[3], b[3];
        ag_frame_about(n, t, b);
        ag_vpl_patch patch = { .position = { 1, 2, 3 }, .flux = { 4, 5, 6 } };
        for (int k = 0; k < 3; k++) { // 2 by 0.5, not along the frame
            patch.normal[k] = (float) n[k];
            patch.edges[0][k] = (float) (2 * scale * (cos(turn) * t[k] + sin(turn) * b[k]));
            patch.edges[1][k] = (float) (0.5 * scale * (cos(turn) * b[k] - sin(turn) * t[k]));
        }
        patch.area = (float) (scale * scale);
        struct ag_vpl v;
        ag_vpl_from_host(&patch, &v);
        assert_memory_equal(v.position_area, patch.position, sizeof patch.position);
        assert_memory_equal(v.normal, patch.normal, sizeof patch.normal);
        assert_memory_equal(v.flux, patch.flux, sizeof patch.flux);
        assert_true(v.position_area[3] == patch.area);
        for (int e = 0; e < 2; e++) {
            double back[3];
            edge_of(&v, e, back);
            for (int k = 0; k < 3; k++) // two halves: 2^-11 of the edge each, and floats
                assert_true(fabs(back[k] - (double) patch.edges[e][k]) <=
                            1.01 * 0x1p-11 * (e ? 0.5 : 2) * scale * sqrt(2));
        }
    }
}

static void a_frame_is_orthonormal_and_right_handed(void **state)
{
    (void) state;
    for (int i = 0; i < 1000; i++) {
        const double z = i == 0 ? 1 : i == 1 ? -1 : i == 2 ? -0.0 : sin(i), phi = 2.4 * i;
        const double r = sqrt(1 - z * z), n[3] = { r * cos(phi), r * sin(phi), z };
        double t[3], b[3];
        ag_frame_about(n, t, b);
        double tt = 0, bb = 0, tb = 0;
        for (int k = 0; k < 3; k++) {
            const int p = (k + 1) % 3, q = (k + 2) % 3;
            assert_true(fabs(t[p] * b[q] - t[q] * b[p] - n[k]) < 1e-15);
            tt += t[k] * t[k];
            bb += b[k] * b[k];
            tb += t[k] * b[k];
        }
        assert_true(fabs(tt - 1) < 1e-15 && fabs(bb - 1) < 1e-15 && fabs(tb) < 1e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_half_float_below_1000_keeps_its_bits),
        cmocka_unit_test(values_between_go_to_the_nearest_and_ties_to_even),
        cmocka_unit_test(long_edges_are_cut_off_and_broken_ones_finite),
        cmocka_unit_test(edges_come_back_in_metres),
        cmocka_unit_test(a_frame_is_orthonormal_and_right_handed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
