// SPDX-License-Identifier: MIT
#include "scene_log.h"

#include <math.h>
#include <stdlib.h>

// Keys are floats, sampling is in doubles.
#define TIGHT 1e-6

static const double pi = 3.14159265358979323846;

// A triangle at a node that one channel drives.
static ag_scene *driven(const ag_channel_desc *channel)
{
    ag_builder *b = ag_builder_create(NULL, "driven");
    int node = add_node(b, -1, 0, 0, 0);
    ag_builder_show(b, node, add_triangle(b, -1), -1);
    ag_builder_channel(b, channel);
    return build(b);
}

static void linear_translations_follow_the_line_and_loop(void **state)
{
    (void) state;
    const float times[] = { 1, 2, 4 }, values[] = { 0, 0, 0, 10, 0, 0, 10, 20, 0 };
    ag_scene *s = driven(
        &(ag_channel_desc){ 0, AG_PATH_TRANSLATION, AG_INTERPOLATE_LINEAR, 3, times, values, 0 });
    assert_true(s->duration == 4);
    assert_true(s->instances[0].moving && s->features & AG_FEATURE_MOVING_GEOMETRY);
    const double at[][3] = { { 0, 0, 0 },   { 0.9, 0, 0 },   { 1.25, 2.5, 0 }, { 2, 10, 0 },
                             { 3, 10, 10 }, { 3.5, 10, 15 }, { 4, 0, 0 },      { 9.25, 2.5, 0 } };
    for (int i = 0; i < FG_COUNT(at); i++) {
        ag_scene_set_time(s, at[i][0]);
        assert_near(s->instances[0].world[12], at[i][1], TIGHT);
        assert_near(s->instances[0].world[13], at[i][2], TIGHT);
    }
    assert_true(s->time == 9.25);
    assert_near(s->box_min[0], 2.5, TIGHT);
    ag_scene_destroy(s);
}

static void steps_hold_their_value(void **state)
{
    (void) state;
    const float times[] = { 0, 1, 2 }, values[] = { 1, 1, 1, 3, 3, 3, 5, 5, 5 };
    ag_scene *s =
        driven(&(ag_channel_desc){ 0, AG_PATH_SCALE, AG_INTERPOLATE_STEP, 3, times, values, 0 });
    ag_scene_set_time(s, 0.999);
    assert_true(s->instances[0].world[0] == 1);
    ag_scene_set_time(s, 1);
    assert_true(s->instances[0].world[0] == 3);
    ag_scene_set_time(s, 1.999);
    assert_true(s->instances[0].world[5] == 3);
    ag_scene_destroy(s);
}

// With the tangents of t^3 - t the spline is that polynomial, in keys 2 s apart too.
static void cubic_splines_are_exact_for_cubics(void **state)
{
    (void) state;
    const float times[] = { 0, 2 };
    float values[18] = { 0 };
    values[6] = -1;     // out-tangent of key 0: 3 t^2 - 1
    values[9] = 11;     // in-tangent of key 1
    values[12] = 8 - 2; // value of key 1
    ag_scene *s = driven(
        &(ag_channel_desc){ 0, AG_PATH_TRANSLATION, AG_INTERPOLATE_CUBIC, 2, times, values, 0 });
    for (int i = 0; i < 20; i++) {
        double t = i / 10.0;
        ag_scene_set_time(s, t);
        assert_near(s->instances[0].world[12], t * t * t - t, TIGHT);
    }
    ag_scene_destroy(s);
}

static void rotations_slerp_the_shorter_way(void **state)
{
    (void) state;
    const float times[] = { 0, 1 };
    const float h = (float) (pi / 4); // 90 degrees about Z, given as the negative quaternion
    const float values[] = { 0, 0, 0, 1, 0, 0, -sinf(h), -cosf(h) };
    ag_scene *s = driven(
        &(ag_channel_desc){ 0, AG_PATH_ROTATION, AG_INTERPOLATE_LINEAR, 2, times, values, 0 });
    ag_scene_set_time(s, 1 / 3.0);
    assert_near(s->instances[0].world[0], cos(pi / 6), TIGHT);
    assert_near(s->instances[0].world[1], sin(pi / 6), TIGHT);
    ag_scene_destroy(s);
}

static void every_animation_loops_over_its_own_length(void **state)
{
    (void) state;
    const float fast[] = { 0, 1 }, slow[] = { 0, 3 }, values[] = { 0, 0, 0, 1, 0, 0 };
    ag_builder *b = ag_builder_create(NULL, "two");
    int triangle = add_triangle(b, -1);
    for (int i = 0; i < 2; i++)
        ag_builder_show(b, add_node(b, -1, 0, 0, 0), triangle, -1);
    ag_builder_channel(b, &(ag_channel_desc){ 0, AG_PATH_TRANSLATION, 0, 2, fast, values, 0 });
    ag_builder_channel(b, &(ag_channel_desc){ 1, AG_PATH_TRANSLATION, 0, 2, slow, values, 1 });
    ag_scene *s = build(b);
    ag_scene_set_time(s, 2.5);
    assert_near(s->instances[0].world[12], 0.5, TIGHT);
    assert_near(s->instances[1].world[12], 2.5 / 3, TIGHT);
    assert_true(s->duration == 3);
    ag_scene_destroy(s);
}

static void a_path_driven_twice_keeps_its_first_channel(void **state)
{
    (void) state;
    const float times[] = { 0, 1 }, first[] = { 0, 0, 0, 1, 0, 0 }, second[] = { 0, 0, 0, 9, 0, 0 };
    lines l;
    fg_log log = log_to(&l);
    ag_builder *b = ag_builder_create(&log, "twice");
    ag_builder_show(b, add_node(b, -1, 0, 0, 0), add_triangle(b, -1), -1);
    ag_builder_channel(b, &(ag_channel_desc){ 0, AG_PATH_TRANSLATION, 0, 2, times, first, 0 });
    ag_builder_channel(b, &(ag_channel_desc){ 0, AG_PATH_TRANSLATION, 0, 2, times, second, 1 });
    assert_has(l.warning, "translation of node 0 '' is driven already");
    ag_scene *s = build(b);
    ag_scene_set_time(s, 0.5);
    assert_near(s->instances[0].world[12], 0.5, TIGHT);
    ag_scene_destroy(s);
}

static void equal_times_give_equal_bits_whatever_came_before(void **state)
{
    (void) state;
    const float times[] = { 0, 0.7f, 1.3f };
    const float values[] = { 0.1f, 0.2f, 0.3f, 0.4f, 0.9f, 0, 0, 0.1f, 0.3f, -0.3f, 0.1f, 0.8f };
    ag_scene *s = driven(
        &(ag_channel_desc){ 0, AG_PATH_ROTATION, AG_INTERPOLATE_LINEAR, 3, times, values, 0 });
    double once[16];
    ag_scene_set_time(s, 0.9);
    memcpy(once, s->instances[0].world, sizeof once);
    for (int i = 0; i < 50; i++)
        ag_scene_set_time(s, i * 0.37);
    ag_scene_set_time(s, 0.9);
    assert_memory_equal(once, s->instances[0].world, sizeof once);
    ag_scene_destroy(s);
}

static void revisions_count_what_moved_and_nothing_else(void **state)
{
    (void) state;
    const float times[] = { 0, 1, 2 }, values[] = { 0, 0, 0, 5, 0, 0, 5, 0, 0 };
    for (int with_light = 0; with_light < 2; with_light++) {
        ag_builder *b = ag_builder_create(NULL, "revisions");
        int moving = add_node(b, -1, 0, 0, 0), still = add_node(b, -1, 0, 0, 0);
        ag_light light = ag_default_light();
        ag_builder_show(b, with_light ? still : moving, add_triangle(b, -1), -1);
        ag_builder_light(b, with_light ? moving : still, &light);
        ag_builder_channel(b, &(ag_channel_desc){ 0, AG_PATH_TRANSLATION, 0, 3, times, values, 0 });
        ag_scene *s = build(b);
        uint64_t geometry = s->geometry_revision, lights = s->light_revision;
        ag_scene_set_time(s, 0.5);
        assert_int_equal(s->geometry_revision != geometry, !with_light);
        assert_int_equal(s->light_revision != lights, with_light);
        geometry = s->geometry_revision;
        lights = s->light_revision;
        ag_scene_set_time(s, 1.2);
        ag_scene_set_time(s, 1.7); // held at 5 by both keys
        assert_true(s->geometry_revision + s->light_revision == geometry + lights + 1);
        assert_int_equal(!!(s->features & AG_FEATURE_MOVING_LIGHT), with_light);
        assert_int_equal(!!(s->features & AG_FEATURE_MOVING_GEOMETRY), !with_light);
        ag_scene_destroy(s);
    }
}

static void a_constant_channel_moves_nothing_but_counts(void **state)
{
    (void) state;
    const float times[] = { 0, 1 }, values[] = { 4, 0, 0, 4, 0, 0 };
    ag_scene *s = driven(
        &(ag_channel_desc){ 0, AG_PATH_TRANSLATION, AG_INTERPOLATE_LINEAR, 2, times, values, 0 });
    assert_true(s->instances[0].world[12] == 4 && !s->instances[0].moving);
    assert_false(s->features & AG_FEATURE_MOVING_GEOMETRY);
    ag_scene_destroy(s);
}

static void lights_and_cameras_ride_on_their_nodes(void **state)
{
    (void) state;
    const float times[] = { 0, 1 }, h = (float) (pi / 4);
    const float values[] = { 0, 0, 0, 1, 0, sinf(h), 0, cosf(h) }; // 90 degrees about Y
    ag_builder *b = ag_builder_create(NULL, "ride");
    int node = ag_builder_node(b, &(ag_node_desc){ .parent = -1, .scale = { 3, 3, 3 } });
    int arm = add_node(b, node, 1, 0, 0);
    ag_light light = ag_default_light();
    ag_camera camera = ag_default_camera();
    light.kind = AG_LIGHT_SPOT;
    ag_builder_light(b, arm, &light);
    ag_builder_camera(b, arm, &camera);
    ag_builder_channel(b, &(ag_channel_desc){ node, AG_PATH_ROTATION, 0, 2, times, values, 0 });
    ag_scene *s = build(b);
    assert_true(s->lights[0].moving && s->cameras[0].moving);
    assert_true(s->lights[0].position[0] == 3 && s->lights[0].direction[2] == -1);
    ag_scene_set_time(s, 1 - 1e-9);
    assert_near(s->lights[0].position[2], -3, 1e-5); // +X went to -Z
    assert_near(s->lights[0].direction[0], -1, 1e-5);
    assert_near(s->cameras[0].world[8], 1, 1e-5); // its +Z axis: unit, the scale is gone
    ag_scene_destroy(s);
}

static void absurd_times_are_time_zero(void **state)
{
    (void) state;
    const float times[] = { 0, 1 }, values[] = { 2, 0, 0, 3, 0, 0 };
    ag_scene *s = driven(&(ag_channel_desc){ 0, AG_PATH_TRANSLATION, 0, 2, times, values, 0 });
    const double absurd[] = { -1, (double) NAN, (double) INFINITY };
    for (int i = 0; i < 3; i++) {
        ag_scene_set_time(s, absurd[i]);
        assert_true(s->time == 0 && s->instances[0].world[12] == 2);
    }
    ag_scene_destroy(s);
}

// ---- skins ------------------------------------------------------------------------

// A strip up the Y axis: lower vertices follow joint 0, upper ones joint 1 at y = 1, the middle
// both. Joint 1 turns by 90 degrees about Z within a second.
static ag_builder *arm_builder(const fg_log *log, int *arm, int joints[2])
{
    ag_vertex v[6] = { vertex(0, 0, 0), vertex(1, 0, 0), vertex(0, 1, 0),
                       vertex(1, 1, 0), vertex(0, 2, 0), vertex(1, 2, 0) };
    const uint32_t indices[] = { 0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5 };
    const uint16_t joint[6][4] = { { 0 }, { 0 }, { 0, 1 }, { 0, 1 }, { 1 }, { 1 } };
    const float weight[6][4] = { { 1 }, { 1 }, { 2, 2 }, { 2, 2 }, { 1 }, { 0 } };
    const float times[] = { 0, 1 }, h = (float) (pi / 4);
    const float values[] = { 0, 0, 0, 1, 0, 0, sinf(h), cosf(h) };
    for (int i = 0; i < 6; i++)
        v[i].normal[0] = 1;
    ag_builder *b = ag_builder_create(log, "arm");
    joints[0] = add_node(b, -1, 10, 0, 0);
    joints[1] = add_node(b, joints[0], 0, 1, 0);
    *arm = ag_builder_primitive(b, &(ag_primitive_desc){ .vertices = v,
                                                         .vertex_count = 6,
                                                         .indices = indices,
                                                         .index_count = 12,
                                                         .material = -1,
                                                         .joints = joint,
                                                         .weights = weight });
    ag_builder_channel(b,
                       &(ag_channel_desc){ joints[1], AG_PATH_ROTATION, 0, 2, times, values, 0 });
    return b;
}

static const float inverse_bind[32] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1 };

static void assert_vertex(const ag_scene *s, int i, double x, double y)
{
    assert_near(s->vertices[i].position[0], x, 1e-5);
    assert_near(s->vertices[i].position[1], y, 1e-5);
}

static void skinned_vertices_follow_their_joints_into_the_world(void **state)
{
    (void) state;
    int arm, joints[2];
    ag_builder *b = arm_builder(NULL, &arm, joints);
    int skin = ag_builder_skin(b, joints, 2, inverse_bind);
    // The node that shows a skinned primitive has no say in where it is.
    ag_builder_show(b, add_node(b, -1, 99, 99, 99), arm, skin);
    ag_scene *s = build(b);
    assert_true(s->primitives[0].skinned && s->instances[0].moving);
    assert_true(s->features & AG_FEATURE_SKINS && s->instances[0].world[12] == 0);
    assert_vertex(s, 0, 10, 0);
    assert_vertex(s, 4, 10, 2);
    ag_scene_set_time(s, 1 - 1e-9);
    assert_vertex(s, 1, 11, 0);
    // About (10, 1): (0, 1) off goes to (-1, 0) off.
    assert_vertex(s, 4, 9, 1);
    assert_near(s->vertices[4].normal[1], 1, 1e-5);
    // The middle one is the mean of staying at (1, 0) off and going to (0, 1) off.
    assert_vertex(s, 3, 10.5, 1.5);
    assert_near(s->vertices[3].normal[0], sqrt(0.5), 1e-5);
    // No weights at all: the first joint named, here the second of the skin.
    assert_vertex(s, 5, 9, 2);
    assert_near(s->primitives[0].box_min[0], 9, 1e-5);
    assert_near(s->box_min[0], 9, 1e-5);
    ag_scene_destroy(s);
}

static void one_primitive_with_two_skins_becomes_two(void **state)
{
    (void) state;
    int arm, joints[2];
    ag_builder *b = arm_builder(NULL, &arm, joints);
    int away[2] = { add_node(b, -1, -5, 0, 0), add_node(b, -1, -5, 1, 0) };
    int skins[2] = { ag_builder_skin(b, joints, 2, inverse_bind),
                     ag_builder_skin(b, away, 2, inverse_bind) };
    int node = add_node(b, -1, 0, 0, 50);
    for (int i = 0; i < 2; i++)
        ag_builder_show(b, node, arm, skins[i]);
    ag_builder_show(b, node, arm, -1);
    ag_builder_show(b, node, arm, skins[1]);
    ag_scene *s = build(b);
    assert_int_equal(s->primitive_count, 3);
    assert_int_equal(s->index_count, 12); // shared
    assert_int_equal(s->instances[1].primitive, s->instances[3].primitive);
    const double x[] = { 10, -5, 0 };
    for (int i = 0; i < 3; i++) {
        const ag_primitive *p = &s->primitives[s->instances[i].primitive];
        assert_near(s->vertices[p->first_vertex].position[0], x[i], 1e-6);
        assert_int_equal(p->skinned, i < 2);
    }
    assert_true(s->instances[2].world[14] == 50);
    assert_false(s->instances[1].moving);
    ag_scene_destroy(s);
}

// Marks that are still there were not written over: another thread may read there.
static void what_does_not_move_is_not_even_written(void **state)
{
    (void) state;
    int arm, joints[2];
    ag_builder *b = arm_builder(NULL, &arm, joints);
    int away[2] = { add_node(b, -1, -5, 0, 0), add_node(b, -1, -5, 1, 0) };
    int skins[2] = { ag_builder_skin(b, joints, 2, inverse_bind),
                     ag_builder_skin(b, away, 2, inverse_bind) };
    int node = add_node(b, -1, 0, 0, 50);
    for (int i = 0; i < 2; i++)
        ag_builder_show(b, node, arm, skins[i]);
    ag_builder_show(b, node, arm, -1);
    ag_scene *s = build(b);
    for (int i = 0; i < 3; i++) {
        const ag_primitive *p = &s->primitives[s->instances[i].primitive];
        assert_int_equal(s->instances[i].moving, i == 0);
        ((ag_instance *) s->instances)[i].world[0] = 42;
        ((ag_vertex *) s->vertices)[p->first_vertex + 4].position[0] = 43;
    }
    const ag_scene before = *s;
    ag_scene_set_time(s, 0.5);
    for (int i = 0; i < 3; i++) {
        const ag_primitive *p = &s->primitives[s->instances[i].primitive];
        assert_int_equal(s->instances[i].world[0] == 42, i > 0);
        assert_int_equal(s->vertices[p->first_vertex + 4].position[0] == 43, i > 0);
    }
    assert_ptr_equal(s->instances, before.instances);
    assert_ptr_equal(s->primitives, before.primitives);
    assert_ptr_equal(s->vertices, before.vertices);
    ag_scene_destroy(s);
}

static void a_joint_that_the_skin_has_not_is_refused(void **state)
{
    (void) state;
    int arm, joints[2];
    lines l;
    fg_log log = log_to(&l);
    ag_builder *b = arm_builder(&log, &arm, joints);
    int skin = ag_builder_skin(b, joints, 1, NULL);
    ag_builder_show(b, 0, arm, skin);
    ag_scene *s;
    assert_int_equal(ag_scene_build(b, &s), FG_ERR_INVALID);
    assert_has(l.error, "arm: show: primitive 0 uses joint 1, its skin has only 1");
    ag_builder_destroy(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_translations_follow_the_line_and_loop),
        cmocka_unit_test(steps_hold_their_value),
        cmocka_unit_test(cubic_splines_are_exact_for_cubics),
        cmocka_unit_test(rotations_slerp_the_shorter_way),
        cmocka_unit_test(every_animation_loops_over_its_own_length),
        cmocka_unit_test(a_path_driven_twice_keeps_its_first_channel),
        cmocka_unit_test(equal_times_give_equal_bits_whatever_came_before),
        cmocka_unit_test(revisions_count_what_moved_and_nothing_else),
        cmocka_unit_test(a_constant_channel_moves_nothing_but_counts),
        cmocka_unit_test(lights_and_cameras_ride_on_their_nodes),
        cmocka_unit_test(absurd_times_are_time_zero),
        cmocka_unit_test(skinned_vertices_follow_their_joints_into_the_world),
        cmocka_unit_test(one_primitive_with_two_skins_becomes_two),
        cmocka_unit_test(what_does_not_move_is_not_even_written),
        cmocka_unit_test(a_joint_that_the_skin_has_not_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
