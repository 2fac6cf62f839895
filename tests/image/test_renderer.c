// SPDX-License-Identifier: MIT
// The host's frame: layers, plugins that come and go, what is left out, and switches of the graph
// that may not change a picture.
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { W = 40, H = 24 };

static ag_scene *lit_room(void)
{
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    return room_scene(&room, &light);
}

static renderer_desc desc_for(ag_scene *scene, const gi_plugin *plugin)
{
    return (renderer_desc){
        .log = test_log(),
        .device = device(),
        .scene = scene,
        .width = W,
        .height = H,
        .plugin = plugin,
        .layers = (1u << LAYER_COUNT) - 1,
        .strict = true,
    };
}

static renderer *make(const renderer_desc *desc)
{
    renderer *r = NULL;
    log_clear();
    if (renderer_create(desc, &r))
        fail_msg("%s", log_text());
    return r;
}

static image frame(renderer *r, renderer_layer layer)
{
    image img = { 0 };
    if (renderer_frame(r, 0) || renderer_read(r, layer, &img))
        fail_msg("%s", log_text());
    if (!img.rgb)
        abort(); // fail_msg() does not return, which analysers cannot know
    return img;
}

static void expect_equal(const image *a, const image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_memory_equal(a->rgb, b->rgb, sizeof(float) * 3 * (size_t) a->width * a->height);
}

static void layers_add_up(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    const renderer_desc desc = desc_for(scene, plugin_rsm());
    renderer *r = make(&desc);
    image all = frame(r, LAYER_RADIANCE), direct = { 0 }, indirect = { 0 }, final = { 0 };
    assert_int_equal(renderer_read(r, LAYER_DIRECT, &direct), FG_OK);
    assert_int_equal(renderer_read(r, LAYER_INDIRECT, &indirect), FG_OK);
    assert_int_equal(renderer_read(r, LAYER_FINAL, &final), FG_OK);
    for (int i = 0; i < 3 * W * H; i++) {
        const float sum = direct.rgb[i] + indirect.rgb[i];
        assert_true(fabsf(all.rgb[i] - sum) <= 1e-6f * sum);
        assert_true(final.rgb[i] >= 0 && final.rgb[i] <= 1);
    }
    image_finish(&all);
    image_finish(&direct);
    image_finish(&indirect);
    image_finish(&final);
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void position_layer_is_world_and_top_row_first(void **state)
{
    (void) state;
    const room_desc room = { .centre = { 100, 200, 300 } };
    ag_scene *scene = room_scene(&room, NULL);
    image p = render_layer(scene, W, H, LAYER_POSITION, NULL, NULL);
    assert_true(p.rgb[1] > 200.2f);                                          // upper left is up
    assert_true(p.rgb[0] < 99.6f);                                           // and left
    assert_true(p.rgb[3 * (W * H - 1) + 1] < 199.8f);                        // lower right is down
    assert_true(fabsf(p.rgb[3 * (W * H / 2 + W / 2) + 2] - 299.5f) < 1e-3f); // the far wall
    image_finish(&p);
    ag_scene_destroy(scene);
}

static void technique_comes_and_goes_between_frames(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    const renderer_desc desc = desc_for(scene, NULL);
    renderer *r = make(&desc);
    image direct = frame(r, LAYER_RADIANCE);
    assert_int_equal(renderer_set_plugin(r, plugin_rsm(), NULL), FG_OK);
    image both = frame(r, LAYER_RADIANCE);
    assert_true(image_mean(&both) > 1.05 * image_mean(&direct));
    const uint64_t bytes = fg_graph_get_stats(renderer_graph(r)).pool_bytes;
    for (int i = 0; i < 20; i++) {
        assert_int_equal(renderer_set_plugin(r, i % 2 ? plugin_rsm() : NULL, NULL), FG_OK);
        image img = frame(r, LAYER_RADIANCE);
        expect_equal(&img, i % 2 ? &both : &direct);
        image_finish(&img);
    }
    assert_true(fg_graph_get_stats(renderer_graph(r)).pool_bytes <= bytes);
    image_finish(&direct);
    image_finish(&both);
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static fg_status fail_create(const gi_env *env, const gi_value *values, void **self)
{
    (void) values;
    fg_logf(env->log, FG_LOG_ERROR, "broken: no");
    *self = NULL;
    return FG_ERR_UNSUPPORTED;
}

static void technique_that_fails_leaves_direct_light(void **state)
{
    (void) state;
    static const gi_param none[] = { { .name = NULL } };
    static const gi_plugin broken = {
        .abi = GI_PLUGIN_ABI, .name = "broken", .params = none, .create = fail_create
    };
    ag_scene *scene = lit_room();
    const renderer_desc desc = desc_for(scene, plugin_rsm());
    renderer *r = make(&desc);
    image with = frame(r, LAYER_RADIANCE);
    assert_int_equal(renderer_set_plugin(r, &broken, NULL), FG_ERR_UNSUPPORTED);
    image without = frame(r, LAYER_RADIANCE);
    image direct = { 0 };
    assert_int_equal(renderer_read(r, LAYER_DIRECT, &direct), FG_OK);
    expect_equal(&without, &direct);
    assert_true(image_mean(&without) < image_mean(&with));
    image_finish(&with);
    image_finish(&without);
    image_finish(&direct);
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void new_size_and_back_gives_the_same_picture(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    const renderer_desc desc = desc_for(scene, plugin_rsm());
    renderer *r = make(&desc);
    image before = frame(r, LAYER_RADIANCE);
    assert_int_equal(renderer_resize(r, 7, 3), FG_OK);
    image small = frame(r, LAYER_RADIANCE);
    assert_int_equal(small.width, 7);
    assert_int_equal(renderer_resize(r, W, H), FG_OK);
    image after = frame(r, LAYER_RADIANCE);
    expect_equal(&before, &after);
    assert_int_equal(renderer_resize(r, 0, 3), FG_ERR_INVALID);
    image_finish(&before);
    image_finish(&small);
    image_finish(&after);
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void switches_of_the_graph_change_no_picture(void **state)
{
    (void) state;
    static const unsigned switches[] = {
        FG_DEBUG_POISON,
        FG_DEBUG_NO_SHARING,
        FG_DEBUG_RANDOM_ORDER,
        FG_DEBUG_KEEP_ALL,
        FG_DEBUG_POISON | FG_DEBUG_RANDOM_ORDER,
    };
    ag_scene *scene = lit_room();
    renderer_desc desc = desc_for(scene, plugin_rsm());
    renderer *r = make(&desc);
    image want = frame(r, LAYER_RADIANCE);
    renderer_destroy(r);
    for (int i = 0; i < FG_COUNT(switches); i++) {
        desc.debug = switches[i];
        desc.seed = (uint64_t) i;
        r = make(&desc);
        for (int k = 0; k < 2; k++) {
            image got = frame(r, LAYER_RADIANCE);
            expect_equal(&got, &want);
            image_finish(&got);
        }
        renderer_destroy(r);
    }
    desc.debug = 0;
    desc.needs_all = true; // permutations with all code in them
    r = make(&desc);
    image got = frame(r, LAYER_RADIANCE);
    for (int i = 0; i < 3 * W * H; i++)
        assert_true(fabsf(got.rgb[i] - want.rgb[i]) <= 1e-5f * want.rgb[i]);
    image_finish(&got);
    image_finish(&want);
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static const char *why_left_out(renderer *r, const char *pass)
{
    const char *why, *name;
    for (int i = 0; (name = fg_graph_left_out(renderer_graph(r), i, &why)); i++)
        if (!strcmp(name, pass))
            return why;
    return NULL;
}

static void what_a_dark_scene_does_not_need_is_left_out_and_said(void **state)
{
    (void) state;
    const room_desc room = { 0 };
    ag_scene *dark = room_scene(&room, NULL);
    const renderer_desc desc = desc_for(dark, plugin_rsm());
    renderer *r = make(&desc);
    image img = frame(r, LAYER_RADIANCE);
    assert_true(image_mean(&img) == 0);
    const char *shadow = why_left_out(r, "shadow.face0"), *gi = why_left_out(r, "rsm.technique");
    assert_non_null(shadow);
    assert_non_null(gi);
    assert_non_null(strstr(shadow, "light"));
    assert_non_null(strstr(gi, "light"));
    image_finish(&img);
    renderer_destroy(r);
    ag_scene_destroy(dark);
}

static bool draws(ag_scene *scene, bool needs_all, const char *texture)
{
    renderer_desc desc = desc_for(scene, NULL);
    desc.needs_all = needs_all;
    renderer *r = make(&desc);
    assert_int_equal(renderer_frame(r, 0), FG_OK);
    char *text = fg_graph_dump(renderer_graph(r), FG_DUMP_TEXT);
    assert_non_null(text);
    const bool there = strstr(text, texture) != NULL;
    fg_dump_free(renderer_graph(r), text);
    renderer_destroy(r);
    return there;
}

static void what_no_surface_has_is_not_drawn(void **state)
{
    (void) state;
    ag_scene *plain = lit_room(); // rough, dark surfaces
    assert_true(draws(plain, false, "gbuffer.albedo"));
    assert_false(draws(plain, false, "gbuffer.material"));
    assert_false(draws(plain, false, "gbuffer.emissive"));
    assert_true(draws(plain, true, "gbuffer.material"));
    assert_true(draws(plain, true, "gbuffer.emissive"));
    ag_scene_destroy(plain);
}

static void empty_scene_is_black(void **state)
{
    (void) state;
    ag_scene *empty = finish_scene(ag_builder_create(test_log(), "empty"));
    const renderer_desc desc = desc_for(empty, plugin_rsm());
    renderer *r = make(&desc);
    for (int layer = 0; layer < LAYER_COUNT; layer++) {
        image img = frame(r, (renderer_layer) layer);
        assert_true(image_mean(&img) == 0);
        image_finish(&img);
    }
    renderer_destroy(r);
    ag_scene_destroy(empty);
}

static void layer_not_asked_for_is_refused(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    renderer_desc desc = desc_for(scene, NULL);
    desc.layers = 1u << LAYER_ALBEDO;
    renderer *r = make(&desc);
    image img = { 0 };
    assert_int_equal(renderer_frame(r, 0), FG_OK);
    assert_int_equal(renderer_read(r, LAYER_DIRECT, &img), FG_ERR_INVALID);
    assert_non_null(strstr(log_text(), "layer direct is not there to be read"));
    assert_null(img.rgb);
    assert_non_null(why_left_out(r, "direct.light")); // nothing needs it
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void bad_descriptions_are_refused(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    renderer *r = NULL;
    renderer_desc desc = desc_for(scene, NULL);
    desc.width = 0;
    assert_int_equal(renderer_create(&desc, &r), FG_ERR_INVALID);
    desc = desc_for(scene, NULL);
    desc.camera_index = 7;
    assert_int_equal(renderer_create(&desc, &r), FG_ERR_INVALID);
    assert_non_null(strstr(log_text(), "there is no camera of that index"));
    desc = desc_for(scene, NULL);
    desc.exposure = -1;
    assert_int_equal(renderer_create(&desc, &r), FG_ERR_INVALID);
    assert_null(r);
    ag_camera wide = scene->cameras[0];
    wide.yfov = 3.2f;
    desc = desc_for(scene, NULL);
    desc.camera = &wide;
    r = make(&desc);
    assert_int_equal(renderer_frame(r, 0), FG_ERR_INVALID);
    assert_non_null(strstr(log_text(), "field of view must lie in (0, pi)"));
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void vpls_are_counted_some_frames_late(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    const renderer_desc desc = desc_for(scene, plugin_rsm());
    renderer *r = make(&desc);
    gi_counter counters[8];
    for (int i = 0; i < 6; i++)
        assert_int_equal(renderer_frame(r, 0), FG_OK);
    assert_int_equal(fg_gl_finish(device()), FG_OK);
    const int n = renderer_counters(r, counters, FG_COUNT(counters));
    double slots = 0, vpls = 0;
    for (int i = 0; i < n; i++) {
        slots = !strcmp(counters[i].name, "vpl_slots") ? counters[i].value : slots;
        vpls = !strcmp(counters[i].name, "vpls") ? counters[i].value : vpls;
    }
    assert_true(slots == 1024);
    assert_true(vpls > 0.7 * slots && vpls < 0.9 * slots); // pi / 4 of a square is the cone
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void several_lights_add_up(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true };
    ag_light lights[3] = { ceiling_spot(58), ceiling_spot(80), ceiling_spot(90) };
    lights[1].position[0] = -0.3;
    lights[2].kind = AG_LIGHT_POINT;
    lights[2].position[1] = 0.3;
    const char *const settings[] = { "rsm_size=32", "pattern=all", NULL };
    image sum = { 0 };
    assert_int_equal(image_create(test_log(), W, H, &sum), FG_OK);
    ag_builder *b = room_builder(&room);
    for (int i = 0; i < 3; i++) {
        ag_scene *one = room_scene(&room, &lights[i]);
        image img = render_layer(one, W, H, LAYER_RADIANCE, plugin_rsm(), settings);
        for (int k = 0; k < 3 * W * H; k++)
            sum.rgb[k] += img.rgb[k];
        image_finish(&img);
        ag_scene_destroy(one);
        ag_builder_light(b, -1, &lights[i]);
    }
    ag_scene *all = finish_scene(b);
    image img = render_layer(all, W, H, LAYER_RADIANCE, plugin_rsm(), settings);
    // Twelve faces make shadow maps of 1024 where one made 2048: edges may differ by pixels.
    int off = 0;
    for (int k = 0; k < 3 * W * H; k++)
        off += fabsf(img.rgb[k] - sum.rgb[k]) > 1e-4f * sum.rgb[k];
    assert_true(off < 3 * W * H / 50);
    assert_true(fabs(image_mean(&img) / image_mean(&sum) - 1) < 2e-3);
    image_finish(&img);
    image_finish(&sum);
    ag_scene_destroy(all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_add_up),
        cmocka_unit_test(position_layer_is_world_and_top_row_first),
        cmocka_unit_test(technique_comes_and_goes_between_frames),
        cmocka_unit_test(technique_that_fails_leaves_direct_light),
        cmocka_unit_test(new_size_and_back_gives_the_same_picture),
        cmocka_unit_test(switches_of_the_graph_change_no_picture),
        cmocka_unit_test(what_a_dark_scene_does_not_need_is_left_out_and_said),
        cmocka_unit_test(what_no_surface_has_is_not_drawn),
        cmocka_unit_test(empty_scene_is_black),
        cmocka_unit_test(layer_not_asked_for_is_refused),
        cmocka_unit_test(bad_descriptions_are_refused),
        cmocka_unit_test(vpls_are_counted_some_frames_late),
        cmocka_unit_test(several_lights_add_up),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
