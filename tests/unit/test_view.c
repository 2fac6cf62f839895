// SPDX-License-Identifier: MIT
// What the viewer is made of beside its window: camera, clock, messages, parameter sets.
#include "last_log.h"
#include "view_camera.h"
#include "view_keys.h"
#include "view_params.h"
#include "view_state.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

// ---- camera ----------------------------------------------------------------------------------

static void near_to(double a, double b)
{
    if (!(fabs(a - b) < 1e-9)) // a dozen operations of numbers about 1, in double
        fail_msg("%.17g is not %.17g", a, b);
}

static view_camera at_origin(void)
{
    view_camera c = { .speed = 2, .distance = 1 };
    const ag_camera still = ag_default_camera();
    view_camera_take(&c, &still);
    return c;
}

static void a_camera_that_is_taken_stands_and_looks_as_before(void **state)
{
    (void) state;
    view_camera c = at_origin(), again = at_origin();
    c.eye[0] = 3;
    c.eye[1] = -2;
    view_camera_turn(&c, 2.5, 0.7);
    const ag_camera first = view_camera_get(&c);
    view_camera_take(&again, &first);
    const ag_camera second = view_camera_get(&again);
    for (int i = 0; i < 16; ++i)
        near_to(first.world[i], second.world[i]);
    near_to(again.yaw, 2.5);
    near_to(again.pitch, 0.7);
}

static void its_axes_are_unit_and_at_right_angles(void **state)
{
    (void) state;
    view_camera c = at_origin();
    view_camera_turn(&c, -1.1, -0.4);
    const ag_camera camera = view_camera_get(&c);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            double dot = 0;
            for (int j = 0; j < 3; ++j)
                dot += camera.world[4 * i + j] * camera.world[4 * k + j];
            near_to(dot, i == k ? 1 : 0);
        }
    near_to(camera.world[1], 0); // the horizon is level
    assert_true(camera.world[5] > 0);
}

static void keys_move_along_the_view_at_its_speed(void **state)
{
    (void) state;
    view_camera c = at_origin();
    assert_true(view_camera_move(&c, VIEW_MOVE_FORWARD, 0.5));
    near_to(c.eye[2], -1); // 2 m/s along -Z
    view_camera_turn(&c, pi / 2, 0);
    view_camera_move(&c, VIEW_MOVE_FORWARD | VIEW_MOVE_FAST, 0.5);
    near_to(c.eye[0], -4); // a quarter to the left: along -X
    near_to(c.eye[2], -1);
    view_camera_move(&c, VIEW_MOVE_UP | VIEW_MOVE_RIGHT, 0.5); // no faster across
    near_to(c.eye[1], sqrt(0.5));
    near_to(c.eye[2], -1 - sqrt(0.5));
    assert_false(view_camera_move(&c, VIEW_MOVE_LEFT | VIEW_MOVE_RIGHT | VIEW_MOVE_FAST, 1));
}

static void it_never_looks_straight_up(void **state)
{
    (void) state;
    view_camera c = at_origin();
    view_camera_turn(&c, 0, 100);
    assert_true(c.pitch < pi / 2);
    view_camera_turn(&c, 0, -200);
    assert_true(c.pitch > -pi / 2);
    ag_camera down = ag_default_camera();
    const double world[16] = { 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 5, 6, 7, 1 };
    memcpy(down.world, world, sizeof world); // down along -Y, the top of the picture is -Z
    view_camera_take(&c, &down);
    near_to(c.yaw, 0);
    assert_true(c.pitch < -1.5);
    near_to(c.eye[1], 6);
}

static void orbit_keeps_its_point_and_distance(void **state)
{
    (void) state;
    view_camera c = at_origin();
    double before[3], after[3];
    view_camera_orbit(&c, 3);
    view_camera_point(&c, before);
    near_to(before[2], -3);
    view_camera_turn(&c, 1, 0.5);
    view_camera_wheel(&c, 2);
    view_camera_point(&c, after);
    double distance = 0;
    for (int i = 0; i < 3; ++i) {
        near_to(after[i], before[i]);
        distance += (c.eye[i] - after[i]) * (c.eye[i] - after[i]);
    }
    near_to(sqrt(distance), 3 / 1.21);
    c.orbiting = false;
    view_camera_wheel(&c, 1);
    near_to(c.speed, 2.2);
}

// A square of 2 m at z = -5 under a node that is moved by -1 and stretched by 2 along z.
static ag_scene *square(void)
{
    ag_scene *scene = NULL;
    ag_builder *b = ag_builder_create(NULL, "square");
    ag_vertex v[4];
    const float at[4][3] = { { -1, -1, -2 }, { 1, -1, -2 }, { 1, 1, -2 }, { -1, 1, -2 } };
    const uint32_t indices[] = { 0, 1, 2, 0, 2, 3 };
    memset(v, 0, sizeof v);
    for (int i = 0; i < 4; ++i) {
        memcpy(v[i].position, at[i], sizeof at[i]);
        v[i].normal[2] = 1;
    }
    const ag_primitive_desc part = {
        .vertices = v, .vertex_count = 4, .indices = indices, .index_count = 6, .material = -1
    };
    const ag_node_desc node = { .parent = -1, .translation = { 0, 0, -1 }, .scale = { 1, 1, 2 } };
    const int primitive = ag_builder_primitive(b, &part);
    ag_builder_show(b, ag_builder_node(b, &node), primitive, -1);
    assert_int_equal(ag_scene_build(b, &scene), FG_OK);
    ag_builder_destroy(b);
    return scene;
}

static void the_middle_of_the_view_is_picked(void **state)
{
    (void) state;
    ag_scene *scene = square();
    view_camera c = at_origin();
    ag_camera camera = view_camera_get(&c);
    near_to(view_camera_pick(scene, &camera), 5);
    view_camera_turn(&c, pi / 4, 0); // past its edge: 5 m to the side at that depth
    camera = view_camera_get(&c);
    near_to(view_camera_pick(scene, &camera), 0);
    c.eye[0] = 5;
    camera = view_camera_get(&c);
    near_to(view_camera_pick(scene, &camera), 5 * sqrt(2));
    view_camera_turn(&c, pi, 0);
    camera = view_camera_get(&c);
    near_to(view_camera_pick(scene, &camera), 0); // behind
    ag_scene_destroy(scene);
}

// ---- clock and messages ----------------------------------------------------------------------

static void the_clock_goes_in_sixtieths(void **state)
{
    (void) state;
    view_clock c = { 0 };
    view_clock_advance(&c, 0.1);
    assert_int_equal(c.tick, 6);
    for (int i = 0; i < 100; ++i)
        view_clock_advance(&c, 0.001); // steps are owed, not lost
    assert_in_range(c.tick, 11, 12);
    view_clock_advance(&c, 3600);
    assert_in_range(c.tick, 26, 27); // a quarter of a second
    view_clock_step(&c);
    const int64_t stopped = c.tick;
    view_clock_advance(&c, 1);
    assert_int_equal(c.tick, stopped);
    view_clock_reset(&c);
    assert_int_equal(c.tick, 0);
    assert_true(c.paused);
    view_clock stepped = { .stepped = true, .tick = 5 };
    view_clock_advance(&stepped, 7);
    near_to(view_clock_seconds(&stepped), 0.1);
}

static void a_history_forgets_the_oldest(void **state)
{
    (void) state;
    view_history h = { 0 };
    near_to(view_history_mean(&h, 10), 0);
    for (int i = 1; i <= VIEW_HISTORY + 2; ++i)
        view_history_add(&h, i);
    assert_int_equal(h.count, VIEW_HISTORY);
    near_to(view_history_max(&h), VIEW_HISTORY + 2);
    near_to(view_history_mean(&h, 2), VIEW_HISTORY + 1.5);
    near_to((double) h.ms[h.next], 3); // the oldest
}

static void messages_age_and_do_not_repeat(void **state)
{
    (void) state;
    view_messages m = { 0 };
    view_messages_add(&m, FG_LOG_ERROR, 0, "bad");
    view_messages_add(&m, FG_LOG_INFO, 1, "news");
    view_messages_add(&m, FG_LOG_INFO, 5, "news");
    assert_int_equal(m.count, 2);
    view_messages_age(&m, 12);
    assert_int_equal(m.count, 2);
    view_messages_age(&m, 14);
    assert_int_equal(m.count, 1);
    assert_string_equal(m.list[0].text, "bad");
    view_messages_age(&m, 61);
    assert_int_equal(m.count, 0);
    for (int i = 0; i < 20; ++i)
        view_messages_add(&m, FG_LOG_INFO, i, i % 2 ? "tick" : "tock");
    assert_int_equal(m.count, VIEW_MESSAGES);
}

// ---- parameter sets --------------------------------------------------------------------------

static const char *const colors[] = { "red", "green", NULL };
static const gi_param params[] = {
    { .name = "size", .type = GI_INT, .min = 1, .max = 64, .def = 16, .power_of_two = true },
    { .name = "reach", .type = GI_FLOAT, .min = 0, .max = 10, .def = 0.1 },
    { .name = "soft", .type = GI_BOOL, .def = 1 },
    { .name = "color", .type = GI_ENUM, .choices = colors, .def = 0 },
    { .name = NULL },
};
static const gi_plugin plugin = { .abi = GI_PLUGIN_ABI, .name = "toy", .params = params };

static const fg_log log_last = { .fn = remember, .level = FG_LOG_ERROR };

static void a_set_comes_back_as_it_was_written(void **state)
{
    (void) state;
    gi_value values[4] = { { .i = 32 }, { .f = 1.0 / 3 }, { .i = 0 }, { .i = 1 } };
    gi_value back[4];
    view_set s = { .exposure = 0.1,
                   .divider = 0.25,
                   .has_pose = true,
                   .eye = { 1e-3, -2, 1.0 / 7 },
                   .yaw = 33.3,
                   .pitch = -89,
                   .yfov = 45 };
    view_set t;
    snprintf(s.sides[0].plugin, VIEW_NAME, "toy");
    snprintf(s.sides[1].plugin, VIEW_NAME, "none");
    snprintf(s.layer, VIEW_NAME, "toy.inner");
    snprintf(s.scene, VIEW_NAME, "a \"scene\"\n");
    s.sides[0].params = view_set_params(&plugin, values);
    char *text = view_set_print(&s);
    assert_int_equal(view_set_parse(&log_last, "file", text, &t), FG_OK);
    char *again = view_set_print(&t);
    assert_string_equal(text, again);
    assert_string_equal(t.scene, s.scene);
    assert_memory_equal(t.eye, s.eye, sizeof t.eye);
    assert_int_equal(view_set_values(&log_last, "file", t.sides[0].params, &plugin, back), FG_OK);
    assert_int_equal(back[0].i, 32);
    assert_memory_equal(&back[1].f, &values[1].f, sizeof(double));
    assert_int_equal(back[2].i, 0);
    assert_int_equal(back[3].i, 1);
    free(text);
    free(again);
    view_set_finish(&s);
    view_set_finish(&t);
}

static void what_is_not_said_is_the_default(void **state)
{
    (void) state;
    view_set s;
    gi_value values[4];
    assert_int_equal(view_set_parse(&log_last, "file", "{\"afterglow\": \"view\"}", &s), FG_OK);
    assert_true(!s.layer[0] && !s.sides[0].plugin[0] && !s.has_pose);
    assert_int_equal(view_set_values(&log_last, "file", NULL, &plugin, values), FG_OK);
    assert_int_equal(values[0].i, 16);
    view_set_finish(&s);
}

static void broken_sets_are_refused_with_the_key(void **state)
{
    static const char *const cases[][2] = {
        { "", "JSON" },
        { "{\"afterglow\": \"view\"} x", "JSON" },
        { "{\"afterglow\": \"report\"}", "parameter set" },
        { "{\"afterglow\": \"view\", \"exposure\": \"1\"}", "exposure" },
        { "{\"afterglow\": \"view\", \"exposure\": -1}", "exposure" },
        { "{\"afterglow\": \"view\", \"divider\": 1}", "divider" },
        { "{\"afterglow\": \"view\", \"plugin\": 3}", "plugin" },
        { "{\"afterglow\": \"view\", \"plugin\": \"\"}", "plugin" },
        { "{\"afterglow\": \"view\", \"params\": {}}", "plugin" },
        { "{\"afterglow\": \"view\", \"plugin\": \"a\", \"params\": []}", "params" },
        { "{\"afterglow\": \"view\", \"second\": {}}", "second" },
        { "{\"afterglow\": \"view\", \"second\": {\"plugin\": \"a\", \"x\": 1}}", "'x'" },
        { "{\"afterglow\": \"view\", \"camera\": {}}", "camera" },
        { "{\"afterglow\": \"view\", \"camera\": {\"name\": \"a\", \"yaw\": 1}}", "camera" },
        { "{\"afterglow\": \"view\", \"camera\": {\"eye\": [1, 2, \"3\"]}}", "eye" },
        { "{\"afterglow\": \"view\", \"camera\": {\"pitch\": 91}}", "pitch" },
        { "{\"afterglow\": \"view\", \"shutter\": 1}", "shutter" },
    };
    (void) state;
    for (int i = 0; i < FG_COUNT(cases); ++i) {
        view_set s;
        last[0] = 0;
        if (view_set_parse(&log_last, "file", cases[i][0], &s) != FG_ERR_INPUT ||
            !strstr(last, cases[i][1]) || !strstr(last, "file"))
            fail_msg("%s gives '%s'", cases[i][0], last);
        assert_null(s.sides[0].params);
    }
}

static void refused_values_change_nothing(void **state)
{
    static const char *const cases[] = {
        "{\"size\": 48}",     "{\"size\": 128}",  "{\"size\": 1.5}",
        "{\"reach\": \"x\"}", "{\"reach\": [1]}", "{\"soft\": null}",
        "{\"color\": 7}",     "{\"other\": 1}",   "{\"reach\": 1, \"color\": \"blue\"}",
    };
    (void) state;
    for (int i = 0; i < FG_COUNT(cases); ++i) {
        gi_value values[4] = { { .i = 1 }, { .f = 2 }, { .i = 0 }, { .i = 1 } };
        gi_value before[4];
        memcpy(before, values, sizeof before);
        cJSON *object = cJSON_Parse(cases[i]);
        assert_non_null(object);
        if (view_set_values(&log_last, "file", object, &plugin, values) != FG_ERR_INPUT)
            fail_msg("%s is taken", cases[i]);
        assert_memory_equal(before, values, sizeof before);
        cJSON_Delete(object);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_camera_that_is_taken_stands_and_looks_as_before),
        cmocka_unit_test(its_axes_are_unit_and_at_right_angles),
        cmocka_unit_test(keys_move_along_the_view_at_its_speed),
        cmocka_unit_test(it_never_looks_straight_up),
        cmocka_unit_test(orbit_keeps_its_point_and_distance),
        cmocka_unit_test(the_middle_of_the_view_is_picked),
        cmocka_unit_test(the_clock_goes_in_sixtieths),
        cmocka_unit_test(a_history_forgets_the_oldest),
        cmocka_unit_test(messages_age_and_do_not_repeat),
        cmocka_unit_test(a_set_comes_back_as_it_was_written),
        cmocka_unit_test(what_is_not_said_is_the_default),
        cmocka_unit_test(broken_sets_are_refused_with_the_key),
        cmocka_unit_test(refused_values_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
