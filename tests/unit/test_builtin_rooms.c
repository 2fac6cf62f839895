// SPDX-License-Identifier: MIT
// What the living room and the factory promise.
#include "test_builtin.h"

#include <pass/surface.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static int material_named(const ag_scene *s, const char *name)
{
    for (int i = 0; i < s->material_count; ++i)
        if (!strcmp(s->materials[i].name, name))
            return i;
    fail_msg("%s has no material %s", s->name, name);
    return -1;
}

static int light_named(const ag_scene *s, const char *name)
{
    for (int i = 0; i < s->light_count; ++i)
        if (!strcmp(s->lights[i].name, name))
            return i;
    fail_msg("%s has no light %s", s->name, name);
    return -1;
}

// A point that is to be inside the walls, and how far rays may go from there.
typedef struct inside {
    double from[3];
    double to[3]; // the box that no ray leaves but through the hole
    int hole;     // the axis on which there is one, upwards
    double hole_min[3], hole_max[3];
} inside;

// Fails where a ray of length `t` leaves the box otherwise than through the hole.
static void check_ray(const ag_scene *s, const inside *w, const double way[3], double t)
{
    double at[3];
    bool out = false, through;
    for (int k = 0; k < 3; ++k)
        out = out || fabs(w->from[k] + t * way[k]) > w->to[k];
    const double wall = (w->to[w->hole] - w->from[w->hole]) / way[w->hole];
    through = wall > 0;
    for (int k = 0; k < 3; ++k) {
        at[k] = w->from[k] + wall * way[k];
        through = through && at[k] > w->hole_min[k] && at[k] < w->hole_max[k];
    }
    if (out && !through)
        fail_msg("%s: a ray leaves at %.2f %.2f %.2f", s->name, at[0], at[1], at[2]);
}

// Rays all around: each ends within the box, or goes through the hole.
static void check_closed(const ag_scene *s, const inside *w)
{
    enum { RAYS = 800 };
    const soup all = soup_of(s);
    for (int i = 0; i < RAYS; ++i) {
        const double y = 1 - 2 * (i + 0.5) / RAYS, angle = 2.399963229728653 * i;
        const double flat = sqrt(1 - y * y);
        const double way[3] = { flat * cos(angle), y, flat * sin(angle) };
        check_ray(s, w, way, soup_nearest(&all, w->from, way, 1e9));
    }
    free(all.corners);
}

static double apart(const double a[16], const double b[16])
{
    double off = 0;
    for (int k = 0; k < 16; ++k)
        off = fmax(off, fabs(a[k] - b[k]));
    return off;
}

static void check_round(const char *name)
{
    ag_scene *s = open_scene(name);
    const size_t size = (size_t) s->instance_count * sizeof *s->instances;
    ag_instance *before = malloc(size);
    assert_non_null(before);
    memcpy(before, s->instances, size);
    int moving = 0;
    ag_scene_set_time(s, s->duration - 0.002);
    for (int i = 0; i < s->instance_count; ++i) {
        const double off = apart(s->instances[i].world, before[i].world);
        // What rides on a belt of 24 m is at its end; nothing is faster than 4 m/s or 4 radians a
        // second.
        if (off > 0.01 && fabs(off - 24) > 0.01)
            fail_msg("%s: instance %d is off by %g after a round", name, i, off);
        moving += s->instances[i].moving;
    }
    assert_true(moving >= 8);
    free(before);
    ag_scene_destroy(s);
}

static void what_moves_is_back_after_a_round(void **state)
{
    (void) state;
    check_round("living-room");
    check_round("factory");
}

// ---- living room ---------------------------------------------------------------------

static void the_room_is_closed_but_for_its_window(void **state)
{
    (void) state;
    ag_scene *s = open_scene("living-room");
    const inside w = { .from = { -0.9, 1.2, 0.4 },
                       .to = { 3.36, 2.71, 2.41 },
                       .hole = 0,
                       .hole_min = { 3.3, 0.3, -1.35 },
                       .hole_max = { 3.4, 2.3, 1.15 } };
    check_closed(s, &w);
    ag_scene_destroy(s);
}

// Which of the sixteen pictures the middle of the screen is taken from, and what shines there.
static int picture_shown(const ag_scene *s, int material)
{
    const float *t = s->materials[material].emissive_tex.transform;
    return (int) (4 * ((double) t[2] + 0.125)) + 4 * (int) (4 * ((double) t[5] + 0.125));
}

static void the_television_shows_sixteen_pictures_a_half_second_each(void **state)
{
    (void) state;
    ag_scene *s = open_scene("living-room");
    const int screen = material_named(s, "screen");
    uint64_t revision = s->material_revision;
    assert_true(s->materials[screen].moving);
    for (int i = 0; i < 32; ++i) {
        ag_scene_set_time(s, 0.5 * i + 0.01);
        assert_int_equal(picture_shown(s, screen), i % 16);
        assert_true(i == 0 || s->material_revision > revision);
        revision = s->material_revision;
        ag_scene_set_time(s, 0.5 * i + 0.49);
        assert_int_equal(s->material_revision, revision);
    }
    ag_scene_destroy(s);
}

static void programmes_differ_in_brightness(void **state)
{
    (void) state;
    ag_scene *s = open_scene("living-room");
    const int screen = material_named(s, "screen");
    float least = 1e9f, most = 0;
    for (int i = 0; i < 16; ++i) {
        ag_scene_set_time(s, 0.5 * i);
        least = fminf(least, s->materials[screen].emissive[0]);
        most = fmaxf(most, s->materials[screen].emissive[0]);
    }
    assert_true(least > 1 && most > 2 * least && most < 6);
    ag_scene_destroy(s);
}

// A bulb lights the floor or the ceiling through its shade's opening, not the shade.
static void check_bulb(const ag_scene *s, const soup *all, const char *name)
{
    const ag_light *l = &s->lights[light_named(s, name)];
    for (int k = 0; k < 16; ++k) {
        // Just inside of the cone.
        const double angle = 0.39269908169872414 * k, c = (double) l->cos_outer + 0.01;
        const double way[3] = { sqrt(1 - c * c) * cos(angle), c * (double) l->direction[1],
                                sqrt(1 - c * c) * sin(angle) };
        const double t = soup_nearest(all, l->position, way, 1e9);
        if (t < 0.3)
            fail_msg("%s meets something after %.2f m", name, t);
    }
}

static void bulbs_shine_out_of_their_shades(void **state)
{
    (void) state;
    ag_scene *s = open_scene("living-room");
    const soup all = soup_of(s);
    check_bulb(s, &all, "lamp down");
    check_bulb(s, &all, "lamp up");
    check_bulb(s, &all, "table lamp down");
    check_bulb(s, &all, "table lamp up");
    free(all.corners);
    ag_scene_destroy(s);
}

static void the_sun_wanders_and_keeps_shining_in(void **state)
{
    (void) state;
    ag_scene *s = open_scene("living-room");
    const ag_light *sun = &s->lights[light_named(s, "sun")];
    double low = 1e9, high = -1e9;
    for (int i = 0; i < 24; ++i) {
        ag_scene_set_time(s, i);
        const double t = (3.2 - sun->position[0]) / (double) sun->direction[0];
        const double y = sun->position[1] + t * (double) sun->direction[1];
        const double z = sun->position[2] + t * (double) sun->direction[2];
        assert_true(t > 6 && y > 0.8 && y < 1.8 && z > -0.6 && z < 0.4); // the window's middle
        low = fmin(low, sun->position[2]);
        high = fmax(high, sun->position[2]);
    }
    assert_true(high - low > 2);
    ag_scene_destroy(s);
}

// ---- factory ---------------------------------------------------------------------------

static void the_factory_has_many_boxes_and_bounded_triangles(void **state)
{
    (void) state;
    ag_scene *s = open_scene("factory");
    assert_true(s->instance_count > 300);
    assert_in_range(scene_triangles(s), 40000, 150000);
    assert_true(s->light_count >= 6);
    ag_scene_destroy(s);
}

static void the_hall_is_closed_but_for_its_gate(void **state)
{
    (void) state;
    ag_scene *s = open_scene("factory");
    const inside w = { .from = { 16.4, 1.5, 6.0 },
                       .to = { 20.39, 9.01, 12.01 },
                       .hole = 0,
                       .hole_min = { 19.9, 0, 4.6 },
                       .hole_max = { 20.5, 4.6, 9.6 } };
    check_closed(s, &w);
    ag_scene_destroy(s);
}

// The goods of line -z: moving instances that stand on the belt.
static int goods(const ag_scene *s, int *out, int max)
{
    int count = 0;
    for (int i = 0; i < s->instance_count; ++i) {
        const double *w = s->instances[i].world;
        if (s->instances[i].moving && fabs(w[14] + 3) < 1e-6 && fabs(w[13] - 0.751) < 1e-3 &&
            count < max)
            out[count++] = i;
    }
    return count;
}

// One frame from `start` on. The belt's texture is a metre long along x: what it moves by is minus
// its offset.
static void check_step(ag_scene *s, double start, const int *box, int count)
{
    const double step = 1.0 / 60;
    const int belt = material_named(s, "belt");
    const float *transform = s->materials[belt].base_color_tex.transform;
    double before[64];
    ag_scene_set_time(s, start);
    for (int k = 0; k < count; ++k)
        before[k] = s->instances[box[k]].world[12];
    double offset = (double) transform[5];
    ag_scene_set_time(s, start + step);
    offset -= (double) transform[5];
    offset -= floor(offset); // the texture repeats
    assert_true(fabs(offset - step) < 1e-5);
    for (int k = 0; k < count; ++k) {
        const double moved = s->instances[box[k]].world[12] - before[k];
        // One that jumps does so within the machines, almost a metre behind their openings at 11 m.
        if (fabs(moved - step) > 1e-5 && (before[k] < 11.9 || moved > -23))
            fail_msg("a box at %g goes %g m in a frame", before[k], moved);
    }
}

static void boxes_go_as_fast_as_their_belt(void **state)
{
    (void) state;
    ag_scene *s = open_scene("factory");
    int box[64];
    const int count = goods(s, box, 64);
    assert_int_equal(count, 12);
    for (int i = 0; i < 40; ++i)
        check_step(s, 0.7 + 1.13 * i, box, count);
    ag_scene_destroy(s);
}

static void boxes_keep_their_distance(void **state)
{
    (void) state;
    ag_scene *s = open_scene("factory");
    int box[64];
    const int count = goods(s, box, 64);
    for (int i = 0; i < 48; ++i) {
        ag_scene_set_time(s, 0.5 * i + 0.25);
        for (int a = 0; a < count; ++a)
            for (int b = 0; b < a; ++b) {
                const double d =
                    fabs(s->instances[box[a]].world[12] - s->instances[box[b]].world[12]);
                assert_true(d > 1.99);
            }
    }
    ag_scene_destroy(s);
}

static void the_crane_carries_its_light(void **state)
{
    (void) state;
    ag_scene *s = open_scene("factory");
    const int light = light_named(s, "crane light");
    double low = 1e9, high = -1e9;
    for (int i = 0; i < 48; ++i) {
        ag_scene_set_time(s, i);
        low = fmin(low, s->lights[light].position[0]);
        high = fmax(high, s->lights[light].position[0]);
        assert_true((double) s->lights[light].direction[1] < -0.999);
    }
    assert_true(high - low > 15);
    ag_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_moves_is_back_after_a_round),
        cmocka_unit_test(the_room_is_closed_but_for_its_window),
        cmocka_unit_test(the_television_shows_sixteen_pictures_a_half_second_each),
        cmocka_unit_test(programmes_differ_in_brightness),
        cmocka_unit_test(bulbs_shine_out_of_their_shades),
        cmocka_unit_test(the_sun_wanders_and_keeps_shining_in),
        cmocka_unit_test(the_factory_has_many_boxes_and_bounded_triangles),
        cmocka_unit_test(the_hall_is_closed_but_for_its_gate),
        cmocka_unit_test(boxes_go_as_fast_as_their_belt),
        cmocka_unit_test(boxes_keep_their_distance),
        cmocka_unit_test(the_crane_carries_its_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
