// SPDX-License-Identifier: MIT
// What the maze and the garden promise beyond what all built-in scenes do.
#include "test_builtin.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// ---- maze ----------------------------------------------------------------------------

// Of a grid over a rectangle, 5 cm above the floor, how many points are lit.
static int lit_points(const ag_scene *s, const soup *w, const double lo[2], const double hi[2])
{
    int lit = 0;
    for (int i = 0; i < 64; ++i) {
        const int row = i / 8;
        const double at[3] = { lo[0] + (hi[0] - lo[0]) * (i % 8 + 0.5) / 8, 0.05,
                               lo[1] + (hi[1] - lo[1]) * (row + 0.5) / 8 };
        lit += scene_lit(s, w, at, 0.0f);
    }
    return lit;
}

// Along the first leg alone, wherever the light is on its way: the others, of which one lies behind
// another, get what comes around corners.
static void maze_light_falls_into_its_first_leg_alone(void **state)
{
    static const double lo[][2] = { { 3.0, 5.7 }, { 3.0, 3.1 }, { 0.5, 0.5 }, { 0.5, 3.1 } };
    static const double hi[][2] = { { 15.5, 7.7 }, { 15.5, 5.1 }, { 15.5, 2.5 }, { 2.5, 9.0 } };
    (void) state;
    ag_scene *s = open_scene("maze");
    for (int t = 0; t < 4; ++t) {
        ag_scene_set_time(s, 6.0 * t);
        const soup w = soup_of(s);
        // Through an opening of 2 m^2 of 26.
        const int first = lit_points(s, &w, (double[]){ 0.5, 10.9 }, (double[]){ 12.5, 12.9 });
        if (first < 3)
            fail_msg("maze: %d points of the first leg are lit at %d s", first, 6 * t);
        for (int i = 0; i < FG_COUNT(lo); ++i)
            assert_int_equal(lit_points(s, &w, lo[i], hi[i]), 0);
        free(w.corners);
    }
    ag_scene_destroy(s);
}

static void maze_statue_has_tens_of_thousands_of_triangles(void **state)
{
    (void) state;
    ag_scene *s = open_scene("maze");
    uint32_t most = 0;
    for (int i = 0; i < s->primitive_count; ++i)
        if (!strcmp(s->materials[s->primitives[i].material].name, "marble"))
            most = s->primitives[i].index_count / 3;
    assert_in_range(most, 20000, 60000);
    ag_scene_destroy(s);
}

// From the middle of every leg, rays in all directions but the openings' meet a wall: no gaps.
static void maze_has_no_leaks(void **state)
{
    static const double eyes[][3] = { { 9.0, 1.6, 6.7 },
                                      { 9.0, 1.6, 4.1 },
                                      { 8.0, 1.6, 1.5 },
                                      { 1.5, 1.6, 6.0 },
                                      { 13.5, 1.6, 9.5 } };
    (void) state;
    ag_scene *s = open_scene("maze");
    const soup w = soup_of(s);
    for (int i = 0; i < FG_COUNT(eyes); ++i)
        for (int k = 0; k < 100; ++k) {
            const double y = 1.0 - 2.0 * (k + 0.5) / 100, flat = sqrt(1.0 - y * y);
            const double way[3] = { flat * cos(2.39996323 * k), y, flat * sin(2.39996323 * k) };
            if (soup_nearest(&w, eyes[i], way, 1e9) > 20.0)
                fail_msg("maze: a ray from %g %g leaves it", eyes[i][0], eyes[i][2]);
        }
    free(w.corners);
    ag_scene_destroy(s);
}

// Metres to what is nearest in twelve directions at the same height, 1 at the most.
static double nearest_around(const ag_scene *s, const double at[3])
{
    const soup w = soup_of(s);
    double nearest = 1.0;
    for (int k = 0; k < 12; ++k) {
        const double way[3] = { cos(0.5236 * k), 0, sin(0.5236 * k) };
        nearest = soup_nearest(&w, at, way, nearest);
    }
    free(w.corners);
    return nearest;
}

// The path goes through a door that swings: as it is at each moment, nothing is near the camera.
static void maze_camera_never_meets_the_door(void **state)
{
    (void) state;
    ag_scene *s = open_scene("maze");
    const int path = ag_scene_find_camera(s, "path");
    for (int i = 0; i < 64; ++i) {
        ag_scene_set_time(s, 9.0 + 0.25 * i); // into the hall, through the door and back
        if (nearest_around(s, s->cameras[path].world + 12) < 0.15)
            fail_msg("maze: the camera is in something at %g s", 9.0 + 0.25 * i);
    }
    ag_scene_destroy(s);
}

// ---- garden --------------------------------------------------------------------------

static bool is_masked(const ag_scene *s, const ag_instance *i)
{
    return s->materials[s->primitives[i->primitive].material].alpha == AG_ALPHA_MASK;
}

static void garden_is_leaves_for_the_most_part(void **state)
{
    (void) state;
    ag_scene *s = open_scene("garden");
    size_t masked = 0;
    const size_t all = scene_triangles(s);
    assert_in_range(all, 150000, 300000);
    for (int i = 0; i < s->instance_count; ++i)
        if (is_masked(s, &s->instances[i]))
            masked += s->primitives[s->instances[i].primitive].index_count / 3;
    assert_true(masked > all / 2);
    ag_scene_destroy(s);
}

// How far the instance's point 2 m above its node has gone.
static double gone(const double before[16], const double now[16])
{
    double sum = 0.0;
    for (int k = 12; k < 15; ++k) {
        const double d = now[k] + 2.0 * now[k - 8] - before[k] - 2.0 * before[k - 8];
        sum += d * d;
    }
    return sqrt(sum);
}

static void garden_leaves_sway_a_little_and_some_rest(void **state)
{
    (void) state;
    ag_scene *s = open_scene("garden");
    double(*before)[16] = calloc((size_t) s->instance_count, sizeof *before);
    assert_non_null(before);
    for (int i = 0; i < s->instance_count; ++i)
        memcpy(before[i], s->instances[i].world, sizeof before[i]);
    ag_scene_set_time(s, 0.7);
    int swaying = 0, resting = 0;
    for (int i = 0; i < s->instance_count; ++i) {
        const double way = gone(before[i], s->instances[i].world);
        if (!is_masked(s, &s->instances[i]))
            continue;
        resting += !s->instances[i].moving;
        swaying += s->instances[i].moving && way > 1e-4;
        if (way > 0.3)
            fail_msg("garden: leaves go %.2f m in 0.7 s", way);
    }
    assert_true(swaying > 50 && resting > 50);
    free(before);
    ag_scene_destroy(s);
}

static void garden_sun_goes_slowly_and_stays_up(void **state)
{
    (void) state;
    ag_scene *s = open_scene("garden");
    assert_int_equal(s->lights[0].kind, AG_LIGHT_DIRECTIONAL);
    float before[3];
    for (int t = 0; t < 48; ++t) {
        ag_scene_set_time(s, t);
        const float *now = s->lights[0].direction;
        assert_true(now[1] < -0.4f);
        // 0.30 tau / 48 and 0.08 tau / 48 radians a second at most.
        for (int k = 0; k < 3 && t > 0; ++k)
            assert_true(fabsf(now[k] - before[k]) < 0.055f);
        memcpy(before, now, sizeof before);
    }
    ag_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maze_light_falls_into_its_first_leg_alone),
        cmocka_unit_test(maze_statue_has_tens_of_thousands_of_triangles),
        cmocka_unit_test(maze_has_no_leaks),
        cmocka_unit_test(maze_camera_never_meets_the_door),
        cmocka_unit_test(garden_is_leaves_for_the_most_part),
        cmocka_unit_test(garden_leaves_sway_a_little_and_some_rest),
        cmocka_unit_test(garden_sun_goes_slowly_and_stays_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
