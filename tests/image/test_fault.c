// SPDX-License-Identifier: MIT
// Techniques that fail: direct light goes on in the same frame.
#include "frames.h"

#include <stdlib.h>
#include <string.h>

// One fault at a time, from frame `fault_from` on.
typedef enum fault { SOUND, CREATE, UPDATE, DECLARE, PASS, TOUCH, PREFIX } fault;
typedef struct faulty {
    fault kind;
    uint64_t from, index;
    fg_res out, stranger;
    const gi_env *env;
} faulty;
static fault next_fault;
static uint64_t fault_from;
static int alive;

static fg_status faulty_create(const gi_env *env, const gi_value *values, void **self)
{
    (void) values;
    *self = NULL;
    if (next_fault == CREATE) {
        fg_logf(env->log, FG_LOG_ERROR, "faulty: no luck");
        return FG_ERR_UNSUPPORTED;
    }
    faulty *f = calloc(1, sizeof *f);
    if (!f)
        return FG_ERR_MEMORY;
    *f = (faulty){ .kind = next_fault, .from = fault_from, .env = env };
    *self = f;
    alive++;
    return FG_OK;
}

static void faulty_destroy(void *self)
{
    alive -= self != NULL;
    free(self);
}

static fg_status faulty_update(void *self, const gi_frame *frame)
{
    faulty *f = self;
    f->index = frame->index;
    return f->kind == UPDATE && f->index >= f->from ? FG_ERR_DEVICE : FG_OK;
}

static fg_status faulty_run(const fg_run *run, void *user)
{
    const faulty *f = user;
    if (f->kind == PASS && f->index >= f->from)
        return FG_ERR_SHADER;
    if (f->kind == TOUCH && f->index >= f->from)
        fg_run_object(run, f->stranger);
    return FG_OK;
}

static void faulty_declare(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    faulty *f = self;
    if (f->kind == PREFIX)
        fg_prefix(g, "own:");
    f->out = fg_texture(g, "faulty.light", &(fg_tex_desc){ .format = FG_RGBA16F });
    f->stranger = in->gbuffer.normal;
    const fg_res never = fg_texture(g, "faulty.never", &(fg_tex_desc){ .format = FG_RGBA16F });
    const fg_pass_desc light = {
        .name = "faulty.light",
        .reads = { { f->kind == DECLARE ? never : in->gbuffer.position } },
        .writes = { { f->out, .load = FG_LOAD_CLEAR, .clear = { 1, 1, 1, 1 } } },
        .run = faulty_run,
        .user = f,
    };
    fg_passes(g, &light, 1);
    out->indirect = f->out;
    out->layers[0] = f->out;
}

static const gi_param no_params[] = { { .name = NULL } };
static const gi_layer faulty_layers[] = { { "light", "for tests" }, { NULL } };
static const gi_plugin plugin_faulty = {
    .abi = GI_PLUGIN_ABI,
    .name = "faulty",
    .params = no_params,
    .layers = faulty_layers,
    .create = faulty_create,
    .update = faulty_update,
    .declare = faulty_declare,
    .destroy = faulty_destroy,
};

static const struct {
    fault kind;
    const char *why;
} faults[] = {
    { UPDATE, "plugin 'faulty' failed in update: " },
    { DECLARE, "plugin 'faulty' failed in its frame: pass 'faulty.light' reads version 1 of "
               "'faulty.never', which no pass writes" },
    { PASS, "plugin 'faulty' failed in its frame: pass 'faulty.light' failed: " },
    { TOUCH, "plugin 'faulty' failed in its frame: pass 'faulty.light' asks for version 1 of "
             "'gbuffer.normal', which it did not declare" },
};

static void must_say(const char *text, const char *part)
{
    if (!text || !strstr(text, part))
        fail_msg("expected: %s\nbut heard: %s", part, text ? text : "nothing");
}

static void a_plugin_that_fails_leaves_direct_light_in_the_same_frame(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    for (int i = 0; i < 2 * FG_COUNT(faults); i++) {
        const int kind = i / 2;
        next_fault = faults[kind].kind;
        fault_from = i % 2 ? 2 : 0;
        renderer *r = make(scene, &plugin_faulty, NULL);
        for (uint64_t k = 0; k < fault_from && next_fault != DECLARE; k++) {
            run(r, 0);
            assert_null(renderer_fault(r));
        }
        assert_int_equal(alive, 1);
        run(r, 0);
        must_say(renderer_fault(r), faults[kind].why);
        must_say(warnings_text(), faults[kind].why);
        assert_string_equal(log_text(), ""); // nothing is an error
        assert_int_equal(alive, 0);
        for (int k = 0; k < 3; k++) {
            same(read_first(r, LAYER_RADIANCE), fresh(scene, LAYER_RADIANCE, NULL, NULL));
            run(r, 0);
        }
        assert_int_equal(renderer_set_plugin(r, plugin_rsm(), NULL), FG_OK);
        assert_null(renderer_fault(r));
        run(r, 0);
        same(read_first(r, LAYER_RADIANCE), fresh(scene, LAYER_RADIANCE, plugin_rsm(), NULL));
        renderer_destroy(r);
    }
    ag_scene_destroy(scene);
}

static void a_plugin_that_does_not_start_is_told_of(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    renderer *r = make(scene, plugin_rsm(), NULL);
    next_fault = CREATE;
    assert_int_equal(renderer_set_plugin(r, &plugin_faulty, NULL), FG_ERR_UNSUPPORTED);
    assert_string_equal(renderer_fault(r), "plugin 'faulty' failed to start: faulty: no luck");
    run(r, 0);
    same(read_first(r, LAYER_RADIANCE), fresh(scene, LAYER_RADIANCE, NULL, NULL));
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void layers_of_a_dropped_plugin_are_missed_by_nobody(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    for (int i = 0; i < 2; i++) {
        next_fault = PASS;
        fault_from = 1;
        renderer *r = make(scene, &plugin_faulty, NULL);
        // With others, and alone.
        const unsigned layers = 1u << LAYER_PLUGIN | (i ? 0 : 1u << LAYER_FINAL);
        assert_int_equal(renderer_set_layers(r, layers), FG_OK);
        run(r, 0);
        assert_int_not_equal(renderer_texture(r, LAYER_PLUGIN), 0);
        run(r, 0);
        assert_non_null(renderer_fault(r));
        run(r, 0);
        assert_int_equal(renderer_texture(r, LAYER_PLUGIN), 0);
        image img = { 0 };
        assert_int_equal(renderer_read(r, LAYER_PLUGIN, &img), FG_ERR_INVALID);
        must_say(log_text(), "is not there to be read");
        renderer_destroy(r);
    }
    ag_scene_destroy(scene);
}

static void a_layer_that_is_not_there_is_no_fault_of_the_plugin(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    next_fault = SOUND;
    renderer *r = make(scene, &plugin_faulty, NULL);
    assert_int_equal(renderer_set_layers(r, 1u << (LAYER_PLUGIN + 1)), FG_OK);
    assert_int_equal(renderer_frame(r, 0), FG_ERR_INVALID);
    must_say(log_text(), "layer 1 of faulty: is not there");
    assert_null(renderer_fault(r));
    assert_int_equal(alive, 1);
    assert_int_equal(renderer_set_layers(r, ALL_LAYERS), FG_OK);
    run(r, 0);
    assert_null(renderer_fault(r));
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

// Direct light makes a mistake: it knows 4 or 16 taps.
static void what_fails_without_the_plugin_too_is_not_its_fault(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    next_fault = SOUND;
    renderer *r =
        make_with((renderer_desc){ .scene = scene, .plugin = &plugin_faulty, .shadow_taps = 5 });
    for (int i = 0; i < 2; i++) {
        assert_int_equal(renderer_frame(r, 0), FG_ERR_INVALID);
        must_say(log_text(), "direct: taps is 5");
        assert_null(renderer_fault(r));
        assert_int_equal(alive, 1);
    }
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void a_strict_renderer_fails(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    for (int i = 0; i < FG_COUNT(faults); i++) {
        next_fault = faults[i].kind;
        fault_from = 0;
        renderer *r =
            make_with((renderer_desc){ .scene = scene, .plugin = &plugin_faulty, .strict = true });
        assert_int_not_equal(renderer_frame(r, 0), FG_OK);
        assert_null(renderer_fault(r));
        assert_int_equal(alive, 1);
        renderer_destroy(r);
    }
    ag_scene_destroy(scene);
}

static void of_two_sides_the_sound_one_stays(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    for (int i = 0; i < 3 * FG_COUNT(faults); i++) {
        const bool bad[2] = { i % 3 != 1, i % 3 != 0 }; // the first, the second, both
        next_fault = faults[i / 3].kind;
        fault_from = 0;
        renderer *r = make(scene, bad[0] ? &plugin_faulty : plugin_rsm(), NULL);
        const renderer_side second = { .plugin = bad[1] ? &plugin_faulty : plugin_rsm(),
                                       .layers = ALL_LAYERS };
        assert_int_equal(renderer_set_split(r, &second), FG_OK);
        run(r, 0);
        // Of the two faults the last is told; the second side's names have a prefix.
        must_say(renderer_fault(r), "plugin 'faulty' failed in ");
        if (bad[1] && faults[i / 3].kind != UPDATE)
            must_say(renderer_fault(r), "pass 'b:faulty.light'");
        assert_int_equal(alive, 0);
        same(read_first(r, LAYER_RADIANCE),
             fresh(scene, LAYER_RADIANCE, bad[0] ? NULL : plugin_rsm(), NULL));
        same(read_second(r, LAYER_RADIANCE),
             fresh(scene, LAYER_RADIANCE, bad[1] ? NULL : plugin_rsm(), NULL));
        assert_string_equal(log_text(), "");
        renderer_destroy(r);
    }
    ag_scene_destroy(scene);
}

static void a_prefix_of_the_plugins_own_ends_with_it(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    next_fault = PREFIX;
    renderer *r = make(scene, &plugin_faulty, NULL);
    run(r, 0);
    char *text = fg_graph_dump(renderer_graph(r), FG_DUMP_TEXT);
    assert_non_null(strstr(text, "own:faulty.light"));
    assert_null(strstr(text, "own:frame"));
    fg_dump_free(renderer_graph(r), text);
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plugin_that_fails_leaves_direct_light_in_the_same_frame),
        cmocka_unit_test(a_plugin_that_does_not_start_is_told_of),
        cmocka_unit_test(layers_of_a_dropped_plugin_are_missed_by_nobody),
        cmocka_unit_test(a_layer_that_is_not_there_is_no_fault_of_the_plugin),
        cmocka_unit_test(what_fails_without_the_plugin_too_is_not_its_fault),
        cmocka_unit_test(a_strict_renderer_fails),
        cmocka_unit_test(a_prefix_of_the_plugins_own_ends_with_it),
        cmocka_unit_test(of_two_sides_the_sound_one_stays),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
