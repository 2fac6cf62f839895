// SPDX-License-Identifier: MIT
// Techniques that change between two frames, and two side by side.
#include "frames.h"

#include <epoxy/gl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- side by side ----------------------------------------------------------------------------

static void two_techniques_share_one_frame(void **state)
{
    (void) state;
    static const renderer_layer layers[] = { LAYER_FINAL, LAYER_RADIANCE, LAYER_INDIRECT };
    ag_scene *scene = lit_room();
    const gi_plugin *isr = plugin_named("isr");
    renderer *r = make(scene, plugin_rsm(), NULL);
    const renderer_side second = { .plugin = isr, .layers = ALL_LAYERS };
    assert_int_equal(renderer_set_split(r, &second), FG_OK);
    run(r, 0);
    for (int i = 0; i < FG_COUNT(layers); i++) {
        same(read_first(r, layers[i]), fresh(scene, layers[i], plugin_rsm(), NULL));
        same(read_second(r, layers[i]), fresh(scene, layers[i], isr, NULL));
    }
    // What is before the plugins stands once, and both sides show it.
    assert_int_equal(renderer_texture(r, LAYER_ALBEDO), renderer_second_texture(r, LAYER_ALBEDO));
    assert_int_equal(renderer_texture(r, LAYER_DIRECT), renderer_second_texture(r, LAYER_DIRECT));
    assert_int_not_equal(renderer_texture(r, LAYER_FINAL), renderer_second_texture(r, LAYER_FINAL));
    int draws = 0;
    const char *name;
    for (int i = 0; (name = fg_graph_pass(renderer_graph(r), i)); i++)
        draws +=
            strstr(name, "gbuffer.draw") || strstr(name, "shadow.") || strstr(name, "direct.light");
    assert_int_equal(draws, 3);
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void one_technique_with_two_settings_shares_one_frame(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    gi_value few[MAX_VALUES];
    set(plugin_rsm(), few, "vpls=16");
    renderer *r = make(scene, plugin_rsm(), NULL);
    const renderer_side second = { .plugin = plugin_rsm(), .values = few, .layers = ALL_LAYERS };
    assert_int_equal(renderer_set_split(r, &second), FG_OK);
    run(r, 0);
    same(read_first(r, LAYER_RADIANCE), fresh(scene, LAYER_RADIANCE, plugin_rsm(), NULL));
    same(read_second(r, LAYER_RADIANCE), fresh(scene, LAYER_RADIANCE, plugin_rsm(), few));
    // Asked for again: nothing is compiled anew.
    const int compiles = fg_graph_get_stats(renderer_graph(r)).compiles;
    assert_int_equal(renderer_set_split(r, &second), FG_OK);
    run(r, 0);
    assert_int_equal(fg_graph_get_stats(renderer_graph(r)).compiles, compiles);
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void second_side_is_direct_light_without_a_plugin(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    renderer *r = make(scene, plugin_rsm(), NULL);
    assert_int_equal(renderer_set_split(r, &(renderer_side){ .layers = ALL_LAYERS }), FG_OK);
    run(r, 0);
    same(read_second(r, LAYER_RADIANCE), fresh(scene, LAYER_RADIANCE, NULL, NULL));
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void a_split_that_ends_frees_its_half(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    renderer *r = make(scene, plugin_rsm(), NULL);
    run(r, 0);
    const uint64_t before = fg_graph_get_stats(renderer_graph(r)).pool_bytes;
    const renderer_side second = { .plugin = plugin_named("hisr"),
                                   .layers = 1u << LAYER_FINAL | 1u << LAYER_PLUGIN };
    assert_int_equal(renderer_set_split(r, &second), FG_OK);
    assert_int_equal(renderer_second_texture(r, LAYER_FINAL), 0); // not before its first frame
    run(r, 0);
    assert_int_not_equal(renderer_second_texture(r, LAYER_PLUGIN), 0);
    assert_int_equal(renderer_second_texture(r, LAYER_DIRECT), 0); // not asked for
    assert_true(fg_graph_get_stats(renderer_graph(r)).pool_bytes > before);
    assert_int_equal(renderer_set_split(r, NULL), FG_OK);
    run(r, 0);
    assert_int_equal(renderer_second_texture(r, LAYER_FINAL), 0);
    assert_int_equal(fg_graph_get_stats(renderer_graph(r)).pool_bytes, before);
    same(read_first(r, LAYER_RADIANCE), fresh(scene, LAYER_RADIANCE, plugin_rsm(), NULL));
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void other_values_free_what_they_do_not_need(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    gi_value few[MAX_VALUES];
    set(plugin_rsm(), few, "rsm_size=32");
    renderer *r = make(scene, plugin_rsm(), NULL);
    run(r, 0);
    assert_int_equal(renderer_set_plugin(r, plugin_rsm(), few), FG_OK);
    run(r, 0);
    const fg_graph_stats stats = fg_graph_get_stats(renderer_graph(r));
    assert_int_equal(stats.pool_bytes, stats.transient_bytes + stats.persistent_bytes);
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void exposure_changes_without_a_compile(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    renderer *r = make(scene, NULL, NULL);
    run(r, 0);
    image before = read_first(r, LAYER_FINAL);
    const int compiles = fg_graph_get_stats(renderer_graph(r)).compiles;
    assert_int_equal(renderer_set_exposure(r, 4), FG_OK);
    run(r, 0);
    image after = read_first(r, LAYER_FINAL);
    assert_true(image_mean(&after) > 1.1 * image_mean(&before));
    assert_int_equal(fg_graph_get_stats(renderer_graph(r)).compiles, compiles);
    assert_int_equal(renderer_set_exposure(r, 0), FG_OK); // the default
    run(r, 0);
    same(read_first(r, LAYER_FINAL), before);
    assert_int_equal(renderer_set_exposure(r, -1), FG_ERR_INVALID);
    assert_int_equal(renderer_set_exposure(r, NAN), FG_ERR_INVALID);
    image_finish(&after);
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

// ---- what a switch keeps ---------------------------------------------------------------------

enum { MAX_KEPT = 16 };
static const char *const techniques[] = { "rsm", "isr", "hisr", "iir", "splat" };

// Textures of passes before the plugin. OpenGL gives the name of a texture that was deleted to the
// next: a label tells whether it is the same still.
typedef struct kept {
    char name[MAX_KEPT][32];
    uint32_t object[MAX_KEPT];
    int count;
} kept;

static void note_kept(void *user, const fg_written *written)
{
    kept *k = user;
    char label[64] = "";
    for (int i = 0; i < k->count; i++)
        if (!strcmp(k->name[i], written->resource)) {
            assert_int_equal(k->object[i], written->object);
            glGetObjectLabel(GL_TEXTURE, written->object, sizeof label, NULL, label);
            assert_string_equal(label, "kept");
            return;
        }
    if (strncmp(written->pass, "gbuffer.", 8) != 0 && strncmp(written->pass, "shadow.", 7) != 0 &&
        strncmp(written->pass, "direct.", 7) != 0)
        return;
    assert_true(k->count < MAX_KEPT);
    snprintf(k->name[k->count], sizeof k->name[0], "%s", written->resource);
    k->object[k->count++] = written->object;
    glObjectLabel(GL_TEXTURE, written->object, -1, "kept");
}

static void passes_before_the_plugin_keep_their_textures(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    kept k = { .count = 0 };
    renderer *r = make_with((renderer_desc){
        .scene = scene, .strict = true, .inspect = note_kept, .inspect_user = &k });
    for (int i = 0; i < FG_COUNT(techniques); i++) {
        gi_value few[MAX_VALUES];
        const char *const next = techniques[(i + 2) % FG_COUNT(techniques)];
        set(plugin_named("iir"), few, "max_lights=16");
        const renderer_side second = { .plugin = plugin_named("iir"), .values = few };
        if (strcmp(techniques[i], "iir") != 0)
            assert_int_equal(renderer_set_plugin(r, plugin_named(techniques[i]), NULL), FG_OK);
        else
            assert_int_equal(renderer_set_plugin(r, plugin_named("iir"), few), FG_OK);
        run(r, 0);
        assert_int_equal(renderer_set_plugin(r, i % 2 ? NULL : plugin_named(next), NULL), FG_OK);
        run(r, 0);
        // Split and joined: the second side comes after both.
        assert_int_equal(renderer_set_split(r, &second), FG_OK);
        run(r, 0);
        assert_int_equal(renderer_set_split(r, NULL), FG_OK);
        run(r, 0);
    }
    assert_true(k.count >= 7); // five of the G-buffer, shadow maps, direct light
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

// ---- histories -------------------------------------------------------------------------------

// Adds 1 to what the last frame left, and says whether that was there.
typedef struct rememberer {
    fg_res now, before;
} rememberer;
static bool history_was_valid;

static fg_status remember_create(const gi_env *env, const gi_value *values, void **self)
{
    (void) env;
    (void) values;
    *self = calloc(1, sizeof(rememberer));
    return *self ? FG_OK : FG_ERR_MEMORY;
}

static fg_status remember_run(const fg_run *run, void *user)
{
    const rememberer *m = user;
    float texel[4] = { 0 };
    history_was_valid = fg_run_history_valid(run, m->before);
    glGetTextureSubImage(fg_run_object(run, m->before), 0, 0, 0, 0, 1, 1, 1, GL_RGBA, GL_FLOAT,
                         sizeof texel, texel);
    for (int i = 0; i < 4; i++)
        texel[i] += 1;
    glClearTexImage(fg_run_object(run, m->now), 0, GL_RGBA, GL_FLOAT, texel);
    return FG_OK;
}

static void remember_declare(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    rememberer *m = self;
    (void) in;
    m->now = fg_texture(g, "memory.sum",
                        &(fg_tex_desc){ .format = FG_RGBA32F, .history = FG_HISTORY_CLEAR });
    m->before = fg_last_frame(g, m->now);
    const fg_pass_desc add = {
        .name = "memory.add",
        .kind = FG_KIND_COMPUTE,
        .reads = { { m->before, FG_USE_COPY } },
        .writes = { { m->now, FG_USE_COPY, FG_LOAD_DISCARD } },
        .run = remember_run,
        .user = m,
    };
    fg_passes(g, &add, 1);
    out->layers[0] = m->now;
}

static float remembered(renderer *r, bool second)
{
    run(r, 0);
    assert_null(renderer_fault(r));
    image img = second ? read_second(r, LAYER_PLUGIN) : read_first(r, LAYER_PLUGIN);
    const float sum = img.rgb[0];
    image_finish(&img);
    return sum;
}

static void histories_begin_anew_after_each_switch(void **state)
{
    (void) state;
    static const gi_param none[] = { { .name = NULL } };
    static const gi_layer layers[] = { { "sum", "for tests" }, { NULL } };
    static const gi_plugin memory = { .abi = GI_PLUGIN_ABI,
                                      .name = "memory",
                                      .params = none,
                                      .layers = layers,
                                      .create = remember_create,
                                      .declare = remember_declare,
                                      .destroy = free };
    const renderer_side second = { .plugin = &memory, .layers = 1u << LAYER_PLUGIN };
    ag_scene *scene = lit_room();
    renderer *r = make(scene, &memory, NULL);
    assert_int_equal(renderer_set_layers(r, 1u << LAYER_PLUGIN), FG_OK);
    for (int i = 0; i < 4; i++) {
        for (int k = 1; k <= 3; k++) {
            assert_true(remembered(r, false) == (float) k);
            assert_int_equal(history_was_valid, k > 1);
        }
        // The second side has a history of its own, and the first goes on with it.
        assert_int_equal(renderer_set_split(r, &second), FG_OK);
        assert_true(remembered(r, true) == 1);
        assert_true(remembered(r, true) == 2);
        assert_true(remembered(r, false) == 6);
        assert_int_equal(renderer_set_split(r, NULL), FG_OK);
        // Another technique and back; away and back without a frame; made again.
        if (i == 0) {
            assert_int_equal(renderer_set_plugin(r, plugin_rsm(), NULL), FG_OK);
            run(r, 0);
        } else if (i == 1) {
            assert_int_equal(renderer_set_plugin(r, NULL, NULL), FG_OK);
        }
        assert_int_equal(renderer_set_plugin(r, &memory, NULL), FG_OK);
    }
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_techniques_share_one_frame),
        cmocka_unit_test(one_technique_with_two_settings_shares_one_frame),
        cmocka_unit_test(second_side_is_direct_light_without_a_plugin),
        cmocka_unit_test(a_split_that_ends_frees_its_half),
        cmocka_unit_test(other_values_free_what_they_do_not_need),
        cmocka_unit_test(exposure_changes_without_a_compile),
        cmocka_unit_test(passes_before_the_plugin_keep_their_textures),
        cmocka_unit_test(histories_begin_anew_after_each_switch),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
