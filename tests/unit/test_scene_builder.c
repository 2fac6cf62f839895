// SPDX-License-Identifier: MIT
#include "scene_log.h"

#include <math.h>
#include <stdlib.h>

static ag_builder *new_builder(lines *l)
{
    fg_log log = log_to(l);
    ag_builder *b = ag_builder_create(&log, "made");
    assert_non_null(b);
    return b;
}

// Expects one error line with `part` in it and the status to stick.
static void assert_refused(ag_builder *b, const lines *l, const char *part)
{
    ag_scene *scene;
    assert_int_equal(l->errors, 1);
    assert_has(l->error, "made: ");
    assert_has(l->error, part);
    assert_int_equal(ag_builder_texture(b, &(ag_texture){ 0 }), -1);
    assert_int_equal(ag_scene_build(b, &scene), FG_ERR_INVALID);
    assert_null(scene);
    assert_int_equal(l->errors, 1);
    ag_builder_destroy(b);
}

// ---- refusals ---------------------------------------------------------------------

static void indices_beyond_the_vertices_are_refused(void **state)
{
    (void) state;
    lines l;
    ag_builder *b = new_builder(&l);
    ag_vertex v[3] = { vertex(0, 0, 0), vertex(1, 0, 0), vertex(0, 1, 0) };
    const uint32_t indices[3] = { 0, 1, 7 };
    assert_int_equal(ag_builder_primitive(b, &(ag_primitive_desc){ .name = "roof",
                                                                   .vertices = v,
                                                                   .vertex_count = 3,
                                                                   .indices = indices,
                                                                   .index_count = 3,
                                                                   .material = -1 }),
                     -1);
    assert_refused(b, &l, "primitive 0 'roof': index 2 is 7, there are 3 vertices");
}

static void primitives_of_a_wrong_shape_are_refused(void **state)
{
    (void) state;
    ag_vertex v[4] = { vertex(0, 0, 0), vertex(1, 0, 0), vertex(0, 1, 0), vertex(0, 0, 1) };
    const uint16_t joints[4][4] = { { 0 } };
    const float bad[4][4] = { { -1, 1, 0, 0 } };
    const struct {
        ag_primitive_desc desc;
        const char *part;
    } cases[] = {
        { { .vertices = v, .vertex_count = 4, .material = -1 }, "4 indices, must be a multiple" },
        { { .vertices = v, .vertex_count = 0, .material = -1 }, "0 vertices" },
        { { .vertices = v, .vertex_count = 3, .material = 2 }, "material 2 does not exist" },
        { { .vertices = v, .vertex_count = 3, .material = -1, .joints = joints },
          "joints and weights must come together" },
        { { .vertices = v, .vertex_count = 3, .material = -1, .joints = joints, .weights = bad },
          "a weight of vertex 0 is negative or not finite" },
    };
    for (int i = 0; i < FG_COUNT(cases); i++) {
        lines l;
        ag_builder *b = new_builder(&l);
        assert_int_equal(ag_builder_primitive(b, &cases[i].desc), -1);
        assert_refused(b, &l, cases[i].part);
    }
}

static void nodes_name_only_earlier_parents(void **state)
{
    (void) state;
    lines l;
    ag_builder *b = new_builder(&l);
    assert_int_equal(add_node(b, 0, 0, 0, 0), -1);
    assert_refused(b, &l, "node 0 '': parent 0 is neither -1 nor an earlier node");
    b = new_builder(&l);
    assert_int_equal(add_node(b, -1, (double) NAN, 0, 0), -1);
    assert_refused(b, &l, "its transform is not finite");
}

static void a_hierarchy_that_overflows_is_refused(void **state)
{
    (void) state;
    lines l;
    ag_builder *b = new_builder(&l);
    int node = -1;
    for (int i = 0; i < 5; i++)
        node = ag_builder_node(b, &(ag_node_desc){ .parent = node, .scale = { 1e100, 1, 1 } });
    ag_scene *scene;
    assert_int_equal(ag_scene_build(b, &scene), FG_ERR_INVALID);
    assert_has(l.error, "world transform is not finite");
    ag_builder_destroy(b);
}

static void shows_skins_and_channels_must_refer_to_what_is_there(void **state)
{
    (void) state;
    const int joint = 9;
    const float time = 0, value[3] = { 0 };
    for (int i = 0; i < 5; i++) {
        const char *const parts[] = { "node 3 does not exist", "primitive 4 does not exist",
                                      "skin 5 does not exist", "skin: node 9 does not exist",
                                      "node 6 or path 0 does not exist" };
        lines l;
        ag_builder *b = new_builder(&l);
        add_node(b, -1, 0, 0, 0);
        add_triangle(b, -1);
        if (i == 3)
            ag_builder_skin(b, &joint, 1, NULL);
        else if (i == 4)
            ag_builder_channel(b,
                               &(ag_channel_desc){ 6, AG_PATH_TRANSLATION, 0, 1, &time, value, 0 });
        else
            ag_builder_show(b, i == 0 ? 3 : 0, i == 1 ? 4 : 0, i == 2 ? 5 : -1);
        assert_refused(b, &l, parts[i]);
    }
}

static void a_channel_needs_increasing_finite_keys(void **state)
{
    (void) state;
    const float good[2] = { 0, 1 }, equal[2] = { 1, 1 }, early[2] = { -1, 1 };
    const float values[6] = { 0 }, bad[6] = { 0, 0, NAN };
    const double matrix[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    const struct {
        const float *times, *values;
        bool matrix;
        const char *part;
    } cases[] = {
        { equal, values, false, "times do not increase" },
        { early, values, false, "time is negative or not finite" },
        { good, bad, false, "a value is not finite" },
        { good, values, true, "the node has a matrix" },
    };
    for (int i = 0; i < FG_COUNT(cases); i++) {
        lines l;
        ag_builder *b = new_builder(&l);
        ag_node_desc node = { .name = "door", .parent = -1 };
        if (cases[i].matrix)
            node.matrix = matrix;
        ag_builder_node(b, &node);
        ag_builder_channel(b, &(ag_channel_desc){ 0, AG_PATH_TRANSLATION, 0, 2, cases[i].times,
                                                  cases[i].values, 0 });
        assert_has(l.error, "translation of node 0 'door'");
        assert_refused(b, &l, cases[i].part);
    }
}

static void textures_lights_cameras_and_materials_have_ranges(void **state)
{
    (void) state;
    for (int i = 0; i < 8; i++) {
        const char *const parts[] = {
            "size is 0x4, must be 1 to 16384",
            "it has no pixels",
            "emission is -1",
            "base colour texture 3 does not exist",
            "intensity is negative",
            "-1 <= cos_outer <= cos_inner <= 1",
            "field of view must be in (0, pi)",
            "zfar must be beyond znear",
        };
        const uint8_t pixel[4] = { 0 };
        lines l;
        ag_builder *b = new_builder(&l);
        ag_texture t = { .width = i == 0 ? 0 : 4, .height = 4, .rgba = i == 0 ? pixel : NULL };
        ag_material m = ag_default_material();
        ag_light light = ag_default_light();
        ag_camera camera = ag_default_camera();
        if (i == 2)
            m.emissive[1] = -1;
        if (i == 3)
            m.base_color_tex.texture = 3;
        if (i == 4)
            light.intensity[0] = -0.5f;
        if (i == 5) {
            light.kind = AG_LIGHT_SPOT;
            light.cos_inner = 0.1f;
        }
        if (i == 6)
            camera.yfov = 3.2f;
        if (i == 7) {
            camera.orthographic = true;
            camera.zfar = camera.znear;
        }
        int made = i < 2   ? ag_builder_texture(b, &t)
                   : i < 4 ? ag_builder_material(b, &m)
                   : i < 6 ? ag_builder_light(b, -1, &light)
                           : ag_builder_camera(b, -1, &camera);
        assert_int_equal(made, -1);
        assert_refused(b, &l, parts[i]);
    }
}

static void a_builder_builds_once(void **state)
{
    (void) state;
    lines l;
    ag_builder *b = new_builder(&l);
    ag_scene *first, *second;
    assert_int_equal(ag_scene_build(b, &first), FG_OK);
    assert_int_equal(ag_scene_build(b, &second), FG_ERR_INVALID);
    assert_null(second);
    assert_has(l.error, "nothing can be added after the build");
    ag_builder_destroy(b);
    ag_scene_destroy(first);
    ag_scene_destroy(NULL);
    ag_builder_destroy(NULL);
}

// ---- repairs ----------------------------------------------------------------------

static void triangles_without_area_or_with_nan_are_dropped_and_counted(void **state)
{
    (void) state;
    lines l;
    ag_builder *b = new_builder(&l);
    ag_vertex v[6] = { vertex(0, 0, 0), vertex(1, 0, 0),   vertex(0, 1, 0),
                       vertex(2, 0, 0), vertex(NAN, 0, 0), vertex(5, 5, 5) };
    const uint32_t indices[] = { 0, 1, 2, 0, 1, 3, 1, 1, 2, 0, 1, 4 };
    ag_builder_primitive(b, &(ag_primitive_desc){ .vertices = v,
                                                  .vertex_count = 6,
                                                  .indices = indices,
                                                  .index_count = 12,
                                                  .material = -1 });
    assert_int_equal(l.warnings, 2);
    assert_has(l.warning, "1 triangles with non-finite vertices are dropped");
    ag_scene *s = build(b);
    assert_int_equal(s->index_count, 3);
    assert_int_equal(s->vertex_count, 3); // the NaN and the unused one are gone
    assert_int_equal(s->warning_count, 2);
    assert_true(s->primitives[0].box_max[0] == 1);
    ag_scene_destroy(s);
}

static void a_sliver_of_a_million_to_one_stays_with_a_unit_normal(void **state)
{
    (void) state;
    ag_builder *b = ag_builder_create(NULL, NULL);
    ag_vertex v[3] = { vertex(0, 0, 0), vertex(1, 0, 0), vertex(0.5f, 1e-6f, 0) };
    ag_builder_primitive(b,
                         &(ag_primitive_desc){ .vertices = v, .vertex_count = 3, .material = -1 });
    ag_scene *s = build(b);
    assert_int_equal(s->index_count, 3);
    assert_true(s->vertices[0].normal[2] == 1);
    ag_scene_destroy(s);
}

static void absent_normals_are_flat_and_split_the_vertices(void **state)
{
    (void) state;
    lines l;
    ag_builder *b = new_builder(&l);
    // Two faces of a roof that share an edge.
    ag_vertex v[4] = { vertex(0, 1, 0), vertex(0, 1, 1), vertex(-1, 0, 0), vertex(1, 0, 0) };
    const uint32_t indices[] = { 0, 2, 1, 0, 1, 3 };
    ag_builder_primitive(b, &(ag_primitive_desc){ .vertices = v,
                                                  .vertex_count = 4,
                                                  .indices = indices,
                                                  .index_count = 6,
                                                  .material = -1 });
    ag_scene *s = build(b);
    assert_int_equal(l.warnings, 0);
    assert_int_equal(s->vertex_count, 6);
    const double r = sqrt(0.5);
    for (int i = 0; i < 6; i++) {
        const ag_vertex *at = &s->vertices[s->indices[i]];
        assert_near(at->normal[0], i < 3 ? -r : r, 1e-7);
        assert_near(at->normal[1], r, 1e-7);
    }
    ag_scene_destroy(s);
}

static void a_few_missing_normals_are_the_mean_by_area(void **state)
{
    (void) state;
    lines l;
    ag_builder *b = new_builder(&l);
    // At vertex 0 meet a face in z = 0 of area 1/2 and one in x = 0 of area 1.
    ag_vertex v[4] = { vertex(0, 0, 0), vertex(1, 0, 0), vertex(0, 1, 0), vertex(0, 0, 2) };
    for (int i = 1; i < 4; i++)
        v[i].normal[1] = 2; // not unit
    const uint32_t indices[] = { 0, 1, 2, 0, 2, 3 };
    ag_builder_primitive(b, &(ag_primitive_desc){ .vertices = v,
                                                  .vertex_count = 4,
                                                  .indices = indices,
                                                  .index_count = 6,
                                                  .material = -1 });
    assert_has(l.warning, "1 of 4 normals have no length");
    ag_scene *s = build(b);
    const float *n = s->vertices[s->indices[0]].normal;
    assert_near(n[0], 2 / sqrt(5), 1e-7);
    assert_near(n[2], 1 / sqrt(5), 1e-7);
    assert_true(s->vertices[s->indices[1]].normal[1] == 1);
    ag_scene_destroy(s);
}

static void factors_out_of_range_are_clamped_with_a_warning(void **state)
{
    (void) state;
    lines l;
    ag_builder *b = new_builder(&l);
    ag_material m = ag_default_material();
    m.base_color[0] = 1.5f;
    m.roughness = -1;
    ag_builder_material(b, &m);
    assert_has(l.warning, "2 factors outside of [0, 1] are clamped");
    ag_scene *s = build(b);
    assert_true(s->materials[0].base_color[0] == 1 && s->materials[0].roughness == 0);
    ag_scene_destroy(s);
}

static void thousands_of_repairs_do_not_flood_the_log(void **state)
{
    (void) state;
    lines l;
    ag_builder *b = new_builder(&l);
    ag_material m = ag_default_material();
    m.roughness = 2;
    for (int i = 0; i < 1000; i++)
        ag_builder_material(b, &m);
    ag_scene *s = build(b);
    assert_int_equal(s->warning_count, 1000);
    assert_true(l.warnings < 100);
    assert_has(l.warning, "970 more repairs are not listed");
    ag_scene_destroy(s);
}

static void instances_scaled_to_nothing_are_left_out(void **state)
{
    (void) state;
    lines l;
    ag_builder *b = new_builder(&l);
    const double nothing[16] = { [15] = 1 };
    int triangle = add_triangle(b, -1);
    ag_builder_node(b, &(ag_node_desc){ .parent = -1, .matrix = nothing });
    ag_builder_show(b, 0, triangle, -1);
    ag_builder_show(b, add_node(b, -1, 0, 0, 0), triangle, -1);
    ag_scene *s = build(b);
    assert_int_equal(s->instance_count, 1);
    assert_int_equal(s->instances[0].node, 1);
    assert_has(l.warning, "1 instances are scaled to nothing");
    ag_scene_destroy(s);
}

// ---- what comes out ---------------------------------------------------------------

static void an_empty_scene_is_a_scene(void **state)
{
    (void) state;
    ag_scene *s = build(ag_builder_create(NULL, "nothing"));
    assert_true(s->features == 0 && s->instance_count == 0 && s->box_min[0] > s->box_max[0]);
    ag_camera camera = ag_scene_framing_camera(s);
    assert_true(camera.world[12] == 0 && camera.znear > 0);
    ag_scene_set_time(s, 3);
    ag_scene_destroy(s);
}

static void worlds_multiply_down_the_hierarchy(void **state)
{
    (void) state;
    ag_builder *b = ag_builder_create(NULL, "tree");
    const double r = sqrt(0.5);
    // A parent at (1, 2, 3), turned by 90 degrees about Y and doubled; a child at (0, 0, 1).
    int parent = ag_builder_node(b, &(ag_node_desc){ .parent = -1,
                                                     .translation = { 1, 2, 3 },
                                                     .rotation = { 0, 2 * r, 0, 2 * r },
                                                     .scale = { 2, 2, -2 } });
    int child = add_node(b, parent, 0, 0, 1);
    ag_builder_show(b, child, add_triangle(b, -1), -1);
    ag_scene *s = build(b);
    const double *w = s->instances[0].world;
    assert_near(w[12], 1 - 2, 1e-12); // -Z doubled, turned to -X
    assert_near(w[13], 2, 1e-12);
    assert_near(w[14], 3, 1e-12);
    assert_true(s->instances[0].mirrored);
    assert_near(s->box_min[1], 2, 1e-12);
    assert_near(s->box_max[1], 4, 1e-12);
    ag_scene_destroy(s);
}

static void the_framing_camera_sees_every_corner(void **state)
{
    (void) state;
    ag_builder *b = ag_builder_create(NULL, "box");
    int node = ag_builder_node(
        b, &(ag_node_desc){ .parent = -1, .translation = { 1e4, -50, 7 }, .scale = { 30, 2, 8 } });
    ag_builder_show(b, node, add_triangle(b, -1), -1);
    ag_scene *s = build(b);
    ag_camera c = ag_scene_framing_camera(s);
    for (int i = 0; i < 8; i++) {
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = (i >> k & 1 ? s->box_max : s->box_min)[k] - c.world[12 + k];
        double reach = -p[2] * tan((double) c.yfov / 2);
        assert_true(-p[2] > (double) c.znear && fabs(p[0]) < reach && fabs(p[1]) < reach);
    }
    ag_scene_destroy(s);
}

static void features_name_what_is_shown(void **state)
{
    (void) state;
    const uint8_t pixel[4] = { 255, 255, 255, 255 };
    ag_builder *b = ag_builder_create(NULL, "features");
    int texture = ag_builder_texture(b, &(ag_texture){ .width = 1, .height = 1, .rgba = pixel });
    ag_material plain = ag_default_material(), rich = plain, unseen = plain;
    rich.base_color_tex = (ag_texture_ref){ texture, 1, { 2, 0, 0, 0, 2, 0 } };
    rich.alpha = AG_ALPHA_MASK;
    rich.roughness = 0.5f;
    rich.emissive[0] = 1;
    unseen.metallic = 1;
    int materials[] = { ag_builder_material(b, &plain), ag_builder_material(b, &rich),
                        ag_builder_material(b, &unseen) };
    add_triangle(b, materials[2]); // never shown
    ag_builder_show(b, add_node(b, -1, 0, 0, 0), add_triangle(b, materials[0]), -1);
    ag_scene *s = build(b);
    assert_int_equal(s->features, AG_FEATURE_GEOMETRY);
    ag_scene_destroy(s);

    b = ag_builder_create(NULL, "features");
    ag_builder_texture(b, &(ag_texture){ .width = 1, .height = 1, .rgba = pixel });
    ag_builder_material(b, &rich);
    ag_builder_show(b, add_node(b, -1, 0, 0, 0), add_triangle(b, 0), -1);
    s = build(b);
    assert_int_equal(s->features, AG_FEATURE_GEOMETRY | AG_FEATURE_TEXTURES | AG_FEATURE_SECOND_UV |
                                      AG_FEATURE_TEXTURE_TRANSFORM | AG_FEATURE_ALPHA_MASK |
                                      AG_FEATURE_GLOSSY | AG_FEATURE_EMISSIVE |
                                      AG_FEATURE_AREA_LIGHT);
    // Beside a point light of 4 pi kW the triangle's pi/2 W no longer count as a light.
    ag_light light = ag_default_light();
    light.intensity[0] = 1000;
    assert_int_equal(ag_scene_add_light(s, &light), FG_OK);
    assert_false(s->features & AG_FEATURE_AREA_LIGHT);
    assert_true(s->features & AG_FEATURE_POINT_LIGHT && s->features & AG_FEATURE_LIGHT);
    light.kind = AG_LIGHT_DIRECTIONAL;
    assert_int_equal(ag_scene_add_light(s, &light), FG_OK);
    assert_true(s->features & AG_FEATURE_SEVERAL_LIGHTS &&
                s->features & AG_FEATURE_DIRECTIONAL_LIGHT);
    ag_scene_destroy(s);
}

static void feature_names_are_all_there(void **state)
{
    (void) state;
    for (int i = 0; i < AG_FEATURE_COUNT; i++)
        assert_true(ag_feature_names[i] && ag_feature_names[i][0]);
}

static void lights_and_cameras_from_outside_replace_their_namesakes(void **state)
{
    (void) state;
    lines l;
    ag_scene *s = build(new_builder(&l));
    ag_light light = ag_default_light();
    light.kind = AG_LIGHT_SPOT;
    light.direction[2] = -4;
    snprintf(light.name, sizeof light.name, "lamp");
    uint64_t revision = s->light_revision;
    assert_int_equal(ag_scene_add_light(s, &light), FG_OK);
    light.intensity[0] = 7;
    assert_int_equal(ag_scene_add_light(s, &light), FG_OK);
    assert_int_equal(s->light_count, 1);
    assert_true(s->lights[0].intensity[0] == 7 && s->lights[0].direction[2] == -1);
    assert_true(s->light_revision > revision);
    light.direction[2] = 0;
    assert_int_equal(ag_scene_add_light(s, &light), FG_ERR_INVALID);
    assert_has(l.error, "light 'lamp': direction has no length");

    ag_camera camera = ag_default_camera();
    snprintf(camera.name, sizeof camera.name, "eye");
    assert_int_equal(ag_scene_add_camera(s, &camera), FG_OK);
    assert_int_equal(ag_scene_add_camera(s, &camera), FG_OK);
    assert_int_equal(s->camera_count, 1);
    assert_int_equal(ag_scene_find_camera(s, "eye"), 0);
    assert_int_equal(ag_scene_find_camera(s, "ear"), -1);
    camera.znear = 0;
    assert_int_equal(ag_scene_add_camera(s, &camera), FG_ERR_INVALID);
    assert_has(l.error, "camera 'eye': znear must be above 0");
    ag_scene_destroy(s);
}

static void ten_thousand_instances_of_one_primitive_share_it(void **state)
{
    (void) state;
    ag_builder *b = ag_builder_create(NULL, "many");
    int triangle = add_triangle(b, -1);
    for (int i = 0; i < 10000; i++)
        ag_builder_show(b, add_node(b, -1, i, 0, 0), triangle, -1);
    ag_scene *s = build(b);
    assert_int_equal(s->instance_count, 10000);
    assert_int_equal(s->primitive_count, 1);
    assert_true(s->box_max[0] == 10000);
    ag_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(indices_beyond_the_vertices_are_refused),
        cmocka_unit_test(primitives_of_a_wrong_shape_are_refused),
        cmocka_unit_test(nodes_name_only_earlier_parents),
        cmocka_unit_test(a_hierarchy_that_overflows_is_refused),
        cmocka_unit_test(shows_skins_and_channels_must_refer_to_what_is_there),
        cmocka_unit_test(a_channel_needs_increasing_finite_keys),
        cmocka_unit_test(textures_lights_cameras_and_materials_have_ranges),
        cmocka_unit_test(a_builder_builds_once),
        cmocka_unit_test(triangles_without_area_or_with_nan_are_dropped_and_counted),
        cmocka_unit_test(a_sliver_of_a_million_to_one_stays_with_a_unit_normal),
        cmocka_unit_test(absent_normals_are_flat_and_split_the_vertices),
        cmocka_unit_test(a_few_missing_normals_are_the_mean_by_area),
        cmocka_unit_test(factors_out_of_range_are_clamped_with_a_warning),
        cmocka_unit_test(thousands_of_repairs_do_not_flood_the_log),
        cmocka_unit_test(instances_scaled_to_nothing_are_left_out),
        cmocka_unit_test(an_empty_scene_is_a_scene),
        cmocka_unit_test(worlds_multiply_down_the_hierarchy),
        cmocka_unit_test(the_framing_camera_sees_every_corner),
        cmocka_unit_test(features_name_what_is_shown),
        cmocka_unit_test(feature_names_are_all_there),
        cmocka_unit_test(lights_and_cameras_from_outside_replace_their_namesakes),
        cmocka_unit_test(ten_thousand_instances_of_one_primitive_share_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
