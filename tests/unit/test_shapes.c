// SPDX-License-Identifier: MIT
// The mesh generators and the painted textures of the built-in scenes.
#include "test_mesh.h"

#include <patterns.h>
#include <shapes.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define PROFILE(array) (const float(*)[2]) array, FG_COUNT(array)

static mesh view(const shape *s)
{
    assert_false(s->failed);
    assert_true(s->index_count > 0);
    return (mesh){ s->vertices, s->vertex_count, s->indices, s->index_count };
}

// Closed, wound outwards, its normals on the side of its faces; the volume within `tolerance` of
// what is known, a fraction of it.
static void check_solid(const shape *s, double volume, double tolerance)
{
    const mesh m = view(s);
    assert_int_equal(mesh_open_edges(&m), 0);
    assert_int_equal(mesh_faces_against_normals(&m), 0);
    assert_true(mesh_worst_normal(&m) < 1e-5); // three roundings of 2^-24 and a square root
    const double measured = mesh_volume(&m);
    if (fabs(measured - volume) > tolerance * volume)
        fail_msg("volume is %g, not %g", measured, volume);
}

static void box_is_a_solid_of_its_size(void **state)
{
    (void) state;
    shape s = { 0 };
    shape_box(&s, (float[3]){ -1, 2, 0.5f }, (float[3]){ 2, 3, 1 });
    check_solid(&s, 1.5, 1e-6);
    assert_int_equal(s.index_count, 36);
    shape_finish(&s);
}

static void box_texture_repeats_by_the_metre(void **state)
{
    (void) state;
    shape s = { .tiling = 0.5f };
    shape_box(&s, (float[3]){ 0, 0, 0 }, (float[3]){ 4, 4, 4 });
    float lo = 1e9f, hi = -1e9f;
    for (size_t i = 0; i < s.vertex_count; ++i) {
        lo = fminf(lo, s.vertices[i].uv[0][0]);
        hi = fmaxf(hi, s.vertices[i].uv[0][0]);
    }
    assert_float_equal(hi - lo, 2.0f, 1e-6f);
    shape_finish(&s);
}

// The polygon inscribed in a circle has sin(2 pi / n) / (2 pi / n) of its area.
static double inscribed(int segments)
{
    const double angle = 2.0 * 3.14159265358979 / segments;
    return sin(angle) / angle;
}

static void lathe_from_axis_to_axis_is_a_solid(void **state)
{
    (void) state;
    static const float cylinder[][2] = { { 0, -1 }, { 0.5f, -1 }, { 0.5f, 2 }, { 0, 2 } };
    const shape_lathe_desc d = { PROFILE(cylinder), 16, 0, 0.0f };
    shape s = { 0 };
    shape_lathe(&s, &d);
    check_solid(&s, 3.0 * 3.14159265358979 * 0.25 * inscribed(16), 1e-5);
    shape_finish(&s);
}

static void lathe_with_an_inside_loses_the_hollow(void **state)
{
    (void) state;
    static const float cup[][2] = { { 0, 0 },    { 1, 0 },       { 1, 1 },
                                    { 0.5f, 1 }, { 0.5f, 0.5f }, { 0, 0.5f } };
    const shape_lathe_desc d = { PROFILE(cup), 32, 0, 0.0f };
    shape s = { 0 };
    shape_lathe(&s, &d);
    check_solid(&s, 3.14159265358979 * (1.0 - 0.125) * inscribed(32), 1e-5);
    shape_finish(&s);
}

static void fluted_lathe_is_thinner_and_its_normals_follow_the_flutes(void **state)
{
    (void) state;
    static const float shaft[][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    const shape_lathe_desc d = { PROFILE(shaft), 256, 8, 0.2f };
    shape s = { 0 };
    shape_lathe(&s, &d);
    // The mean of f^2 = (1 - a (1 - cos))^2 with a = 0.1 is 1 - 2 a + 1.5 a^2; 256 chords lose
    // less than 1e-3 of it.
    check_solid(&s, 3.14159265358979 * (1.0 - 0.2 + 0.015), 1e-3);
    const mesh m = view(&s);
    // A face turns by at most the curvature over its width: 2 pi / 256 x (1 + a 8^2), half each
    // way.
    assert_true(mesh_worst_agreement(&m) > cos(0.5 * 0.0246 * 7.4 + 0.02));
    shape_finish(&s);
}

static void sphere_and_tube_are_solids(void **state)
{
    (void) state;
    shape s = { 0 };
    shape_sphere(&s, (float[3]){ 1, 2, 3 }, 0.5f, 48);
    // Inscribed: each cross section and the outline lose (2 pi / 48)^2 / 6 or so.
    check_solid(&s, 4.0 / 3.0 * 3.14159265358979 * 0.125, 0.01);
    shape_finish(&s);

    static const float path[][3] = { { 0, 0, 0 }, { 0, 1, 0 }, { 0, 3, 0 } };
    const shape_tube_desc bar = { .path = path, .count = 3, .radius = 0.1f, .segments = 12 };
    shape_tube(&s, &bar);
    check_solid(&s, 3.0 * 3.14159265358979 * 0.01 * inscribed(12), 1e-4);
    shape_finish(&s);

    static const float bent[][3] = {
        { 0, 0, 0 }, { 0.1f, 1, 0 }, { 0.5f, 1.5f, 0.5f }, { 1.5f, 1.6f, 0.7f }
    };
    const shape_tube_desc branch = { .path = bent, .count = 4, .radius = 0.05f, .segments = 8 };
    shape_tube(&s, &branch);
    const mesh m = view(&s);
    assert_int_equal(mesh_open_edges(&m), 0);
    assert_true(mesh_volume(&m) > 0.0);
    shape_finish(&s);
}

// Two balls that touch, the upper one with a sharp rim cut into it: concave, convex and creased.
static float pawn(const void *user, const float p[3])
{
    static const float low[3] = { 0, 0.3f, 0 }, high[3] = { 0, 0.85f, 0 };
    (void) user;
    const float foot = field_ball(p, low, (float[3]){ 0.3f, 0.3f, 0.3f });
    const float head = field_ball(p, high, (float[3]){ 0.3f, 0.25f, 0.3f });
    return fmaxf(field_join(foot, head, 0.05f), p[1] - 0.95f);
}

static float ball(const void *user, const float p[3])
{
    static const float centre[3] = { 0.11f, 0.213f, 0.307f };
    (void) user;
    return field_ball(p, centre, (float[3]){ 0.5f, 0.5f, 0.5f });
}

static void field_becomes_a_solid(void **state)
{
    (void) state;
    shape s = { 0 };
    const shape_field_desc round = {
        .field = ball, .lo = { -1, -1, -1 }, .hi = { 1, 1, 1 }, .cell = 0.05f, .steepest = 1.0f
    };
    shape_field(&s, &round);
    // Points of the sphere up to half a cell's diagonal from their mean, 43 mm, put that 43^2 / (2
    // R) = 1.9 mm of 500 too far in at most, and the faces another (cell^2 / 8 R) = 0.6 mm: 3 x 0.5
    // %.
    check_solid(&s, 4.0 / 3.0 * 3.14159265358979 * 0.125, 0.015);
    shape_finish(&s);

    const shape_field_desc creased = { .field = pawn,
                                       .lo = { -0.5f, -0.5f, -0.5f },
                                       .hi = { 0.5f, 1.5f, 0.5f },
                                       .cell = 0.02f,
                                       .steepest = 1.5f };
    shape_field(&s, &creased);
    const mesh m = view(&s);
    float lo[3], hi[3];
    assert_int_equal(mesh_open_edges(&m), 0);
    assert_int_equal(mesh_faces_against_normals(&m), 0);
    assert_true(mesh_worst_normal(&m) < 1e-5);
    mesh_bounds(&m, lo, hi);
    assert_true(fabsf(lo[1]) < 0.02f && fabsf(hi[1] - 0.95f) < 0.02f);
    shape_finish(&s);
}

static void arcade_is_a_wall_without_its_arches(void **state)
{
    (void) state;
    const shape_arcade_desc d = { .bays = 3,
                                  .bay = 3,
                                  .radius = 1.2f,
                                  .rise = 1.0f,
                                  .spring = 2,
                                  .top = 4,
                                  .thickness = 0.5f,
                                  .segments = 32 };
    shape s = { 0 };
    shape_arcade(&s, &d);
    // Half an ellipse by 32 chords.
    const double arch = 0.5 * 3.14159265358979 * 1.2 * 1.0 * inscribed(64);
    check_solid(&s, 0.5 * 3.0 * (3.0 * 2.0 - arch), 1e-5);
    shape_finish(&s);
}

static void archivolt_is_half_a_ring(void **state)
{
    (void) state;
    const shape_archivolt_desc d = {
        .inner = 1.0f, .outer = 1.2f, .spring = 3.0f, .thickness = 0.6f, .segments = 24
    };
    shape s = { 0 };
    shape_archivolt(&s, &d);
    check_solid(&s, 0.6 * 0.5 * 3.14159265358979 * (1.44 - 1.0) * inscribed(48), 1e-4);
    shape_finish(&s);
}

static void frame_is_a_mitred_ring_whichever_way_its_profile_runs(void **state)
{
    (void) state;
    static const float forwards[][2] = { { 0, 0 }, { 1, 0 }, { 1, 0.5f }, { 0, 0.5f } };
    static const float backwards[][2] = { { 0, 0.5f }, { 1, 0.5f }, { 1, 0 }, { 0, 0 } };
    const float(*profiles[2])[2] = { forwards, backwards };
    for (int i = 0; i < 2; ++i) {
        const shape_frame_desc d = {
            .half_x = 3, .half_z = 2, .profile = (const float(*)[2]) profiles[i], .count = 4
        };
        shape s = { 0 };
        shape_frame(&s, &d);
        check_solid(&s, 0.5 * (8.0 * 6.0 - 6.0 * 4.0), 1e-5);
        shape_finish(&s);
    }
}

static void frame_around_a_point_is_a_pier(void **state)
{
    (void) state;
    static const float pier[][2] = { { 0, 0 }, { 0.5f, 0 }, { 0.5f, 3 }, { 0, 3 } };
    const shape_frame_desc d = { .profile = pier, .count = 4 };
    shape s = { 0 };
    shape_frame(&s, &d);
    check_solid(&s, 3.0, 1e-5);
    shape_finish(&s);
}

static void vault_looks_down_and_spans_its_bay(void **state)
{
    (void) state;
    const shape_vault_desc d = {
        .half_x = 1.5f, .half_z = 1, .spring = 3, .rise = 1, .segments = 16
    };
    shape s = { 0 };
    shape_vault(&s, &d);
    const mesh m = view(&s);
    assert_int_equal(mesh_faces_against_normals(&m), 0);
    float lo[3], hi[3];
    mesh_bounds(&m, lo, hi);
    const float want_lo[3] = { -1.5f, 3, -1 }, want_hi[3] = { 1.5f, 4, 1 };
    for (int k = 0; k < 3; ++k) {
        assert_float_equal(lo[k], want_lo[k], 1e-5f);
        assert_float_equal(hi[k], want_hi[k], 1e-5f);
    }
    for (size_t i = 0; i < s.vertex_count; ++i)
        assert_true(s.vertices[i].normal[1] < 1e-6f);
    // Seen from below it covers the bay once: the projected faces add up to its area.
    assert_true(fabs(mesh_area_from_below(&m) - 6.0) < 1e-4);
    shape_finish(&s);
}

static void cloth_hangs_within_its_size(void **state)
{
    (void) state;
    const shape_cloth_desc d = {
        .width = 2, .height = 3, .folds = 4, .depth = 0.1f, .gather = 0.3f, .nu = 32, .nv = 8
    };
    shape s = { 0 };
    shape_cloth(&s, &d);
    const mesh m = view(&s);
    float lo[3], hi[3];
    mesh_bounds(&m, lo, hi);
    assert_float_equal(hi[1], 0.0f, 1e-6f);
    assert_float_equal(lo[1], -3.0f, 1e-6f);
    assert_true(hi[0] - lo[0] < 2.05f && hi[0] - lo[0] > 1.3f); // gathered, never wider
    assert_true(hi[2] < 0.14f && lo[2] > -0.14f && hi[2] - lo[2] > 0.1f);
    assert_int_equal(mesh_faces_against_normals(&m), 0);
    assert_int_equal(s.index_count, 3 * 2 * 32 * 8);
    shape_finish(&s);
}

static void moved_shape_keeps_what_was_there(void **state)
{
    (void) state;
    shape s = { 0 };
    shape_box(&s, (float[3]){ 0, 0, 0 }, (float[3]){ 1, 1, 1 });
    const size_t first = s.vertex_count;
    shape_box(&s, (float[3]){ 0, 0, 0 }, (float[3]){ 1, 1, 2 });
    // A quarter turn around +Y takes +z to +x and +x to -z.
    shape_move(&s, first, (float[3]){ 10, 0, 0 }, 1.57079633f);
    const mesh before = { s.vertices, first, s.indices, 36 };
    const mesh after = { s.vertices, s.vertex_count, s.indices + 36, 36 };
    float lo[3], hi[3];
    mesh_bounds(&before, lo, hi);
    assert_float_equal(hi[0], 1.0f, 0.0f);
    const mesh tail = { s.vertices + first, s.vertex_count - first, NULL, 0 };
    mesh_bounds(&tail, lo, hi);
    assert_float_equal(lo[0], 10.0f, 1e-5f);
    assert_float_equal(hi[0], 12.0f, 1e-5f);
    assert_float_equal(lo[2], -1.0f, 1e-5f);
    assert_int_equal(mesh_faces_against_normals(&after), 0);
    shape_finish(&s);
}

static void triangle_without_area_is_left_out(void **state)
{
    (void) state;
    shape s = { 0 };
    const float up[3] = { 0, 1, 0 };
    for (int i = 0; i < 3; ++i)
        shape_vertex(&s, (float[3]){ (float) i, 0, 0 }, up, 0, 0);
    shape_triangle(&s, 0, 1, 2);
    assert_int_equal(s.index_count, 0);
    shape_finish(&s);
}

static uint8_t *painted(pattern what, int size)
{
    uint8_t *rgba = malloc((size_t) size * (size_t) size * 4);
    assert_non_null(rgba);
    pattern_paint(what, size, rgba);
    return rgba;
}

static void pattern_is_the_same_each_time(void **state)
{
    (void) state;
    for (int what = 0; what < PATTERN_COUNT; ++what) {
        uint8_t *a = painted((pattern) what, 64), *b = painted((pattern) what, 64);
        assert_memory_equal(a, b, (size_t) 64 * 64 * 4);
        free(a);
        free(b);
    }
}

// Mean absolute step between columns a and b.
static double column_step(const uint8_t *rgba, size_t size, size_t a, size_t b)
{
    double sum = 0.0;
    for (size_t y = 0; y < size; ++y) {
        const uint8_t *row = rgba + 4 * size * y;
        for (size_t k = 0; k < 3; ++k)
            sum += abs(row[4 * a + k] - row[4 * b + k]);
    }
    return sum / (3.0 * (double) size);
}

static void pattern_has_no_seam_at_its_edge(void **state)
{
    (void) state;
    // The step over the edge is like the largest of the steps inside, which joints and threads
    // make: a cut through the noise would be larger than any where there are no joints.
    static const pattern smooth[] = { PATTERN_LIMESTONE, PATTERN_PLASTER, PATTERN_CLAY };
    for (int i = 0; i < FG_COUNT(smooth); ++i) {
        uint8_t *rgba = painted(smooth[i], 256);
        double largest = 0.0;
        for (size_t x = 0; x + 1 < 256; ++x)
            largest = fmax(largest, column_step(rgba, 256, x, x + 1));
        assert_true(column_step(rgba, 256, 255, 0) <= largest);
        free(rgba);
    }
}

static void leaves_are_cut_out_and_all_else_is_whole(void **state)
{
    (void) state;
    for (int what = 0; what < PATTERN_COUNT; ++what) {
        uint8_t *rgba = painted((pattern) what, 128);
        int present = 0;
        for (int i = 0; i < 128 * 128; ++i) {
            assert_true(rgba[4 * i + 3] == 0 || rgba[4 * i + 3] == 255);
            present += rgba[4 * i + 3] == 255;
        }
        if (pattern_is_masked((pattern) what))
            assert_in_range(present, 128 * 128 / 5, 128 * 128 * 4 / 5);
        else
            assert_int_equal(present, 128 * 128);
        free(rgba);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(box_is_a_solid_of_its_size),
        cmocka_unit_test(box_texture_repeats_by_the_metre),
        cmocka_unit_test(lathe_from_axis_to_axis_is_a_solid),
        cmocka_unit_test(lathe_with_an_inside_loses_the_hollow),
        cmocka_unit_test(fluted_lathe_is_thinner_and_its_normals_follow_the_flutes),
        cmocka_unit_test(sphere_and_tube_are_solids),
        cmocka_unit_test(field_becomes_a_solid),
        cmocka_unit_test(arcade_is_a_wall_without_its_arches),
        cmocka_unit_test(archivolt_is_half_a_ring),
        cmocka_unit_test(frame_is_a_mitred_ring_whichever_way_its_profile_runs),
        cmocka_unit_test(frame_around_a_point_is_a_pier),
        cmocka_unit_test(vault_looks_down_and_spans_its_bay),
        cmocka_unit_test(cloth_hangs_within_its_size),
        cmocka_unit_test(moved_shape_keeps_what_was_there),
        cmocka_unit_test(triangle_without_area_is_left_out),
        cmocka_unit_test(pattern_is_the_same_each_time),
        cmocka_unit_test(pattern_has_no_seam_at_its_edge),
        cmocka_unit_test(leaves_are_cut_out_and_all_else_is_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
