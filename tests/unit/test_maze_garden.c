// SPDX-License-Identifier: MIT
// What the maze and the garden promise beyond what all built-in scenes do.
#include "test_mesh.h"

#include <scenes.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static ag_scene *open_scene(const char *name)
{
    ag_scene *scene = NULL;
    assert_int_equal(scenes_open(NULL, name, &scene), FG_OK);
    return scene;
}

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maze_light_falls_into_its_first_leg_alone),
        cmocka_unit_test(maze_statue_has_tens_of_thousands_of_triangles),
        cmocka_unit_test(maze_has_no_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
