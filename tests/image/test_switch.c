// SPDX-License-Identifier: MIT
// Techniques that change between two frames, two side by side, and techniques that fail.
#include "fixture.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { W = 40, H = 24, MAX_VALUES = 64 };
static const unsigned all_layers = (1u << LAYER_COUNT) - 1;

static ag_scene *lit_room(void)
{
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    return room_scene(&room, &light);
}

static renderer *make(ag_scene *scene, const gi_plugin *plugin, const gi_value *values)
{
    const renderer_desc desc = {
        .log = test_log(),
        .device = device(),
        .scene = scene,
        .width = W,
        .height = H,
        .plugin = plugin,
        .values = values,
        .layers = all_layers,
    };
    renderer *r = NULL;
    log_clear();
    if (renderer_create(&desc, &r))
        fail_msg("%s", log_text());
    return r;
}

static void run(renderer *r, double time)
{
    if (renderer_frame(r, time))
        fail_msg("%s", log_text());
}

static image read_first(renderer *r, renderer_layer layer)
{
    image img = { 0 };
    if (renderer_read(r, layer, &img) || !img.rgb)
        fail_msg("%s", log_text());
    return img;
}

static image read_second(renderer *r, renderer_layer layer)
{
    image img = { 0 };
    if (renderer_second_read(r, layer, &img) || !img.rgb)
        fail_msg("%s", log_text());
    return img;
}

// What a renderer that begins with the plugin shows first.
static image fresh(ag_scene *scene, renderer_layer layer, const gi_plugin *plugin,
                   const gi_value *values)
{
    renderer *r = make(scene, plugin, values);
    run(r, 0);
    assert_null(renderer_fault(r));
    image img = read_first(r, layer);
    renderer_destroy(r);
    return img;
}

static void same(image a, image b) // frees both
{
    assert_int_equal(a.width, b.width);
    assert_int_equal(a.height, b.height);
    assert_true(same_bits(a.rgb, b.rgb, sizeof(float) * 3 * (size_t) a.width * (size_t) a.height));
    image_finish(&a);
    image_finish(&b);
}

static void set(const gi_plugin *p, gi_value *values, const char *assignment)
{
    assert_true(gi_params_count(p) <= MAX_VALUES);
    gi_params_default(p, values);
    assert_int_equal(gi_params_set(test_log(), p, values, assignment), FG_OK);
}

// ---- side by side ----------------------------------------------------------------------------

static void two_techniques_share_one_frame(void **state)
{
    (void) state;
    static const renderer_layer layers[] = { LAYER_FINAL, LAYER_RADIANCE, LAYER_INDIRECT };
    ag_scene *scene = lit_room();
    const gi_plugin *isr = plugin_named("isr");
    renderer *r = make(scene, plugin_rsm(), NULL);
    const renderer_side second = { .plugin = isr, .layers = all_layers };
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
    const renderer_side second = { .plugin = plugin_rsm(), .values = few, .layers = all_layers };
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
    assert_int_equal(renderer_set_split(r, &(renderer_side){ .layers = all_layers }), FG_OK);
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
    const renderer_desc desc = { .log = test_log(),
                                 .device = device(),
                                 .scene = scene,
                                 .width = W,
                                 .height = H,
                                 .strict = true,
                                 .inspect = note_kept,
                                 .inspect_user = &k };
    renderer *r = NULL;
    log_clear();
    assert_int_equal(renderer_create(&desc, &r), FG_OK);
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

// ---- techniques that fail --------------------------------------------------------------------

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
    assert_int_equal(renderer_set_layers(r, all_layers), FG_OK);
    run(r, 0);
    assert_null(renderer_fault(r));
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

static void what_fails_without_the_plugin_too_is_not_its_fault(void **state)
{
    (void) state;
    ag_scene *scene = lit_room();
    next_fault = SOUND;
    const renderer_desc desc = { .log = test_log(),
                                 .device = device(),
                                 .scene = scene,
                                 .width = W,
                                 .height = H,
                                 .plugin = &plugin_faulty,
                                 .shadow_taps = 5 }; // direct light's mistake
    renderer *r = NULL;
    log_clear();
    assert_int_equal(renderer_create(&desc, &r), FG_OK);
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
        const renderer_desc desc = { .log = test_log(),
                                     .device = device(),
                                     .scene = scene,
                                     .width = W,
                                     .height = H,
                                     .plugin = &plugin_faulty,
                                     .strict = true };
        renderer *r = NULL;
        log_clear();
        assert_int_equal(renderer_create(&desc, &r), FG_OK);
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
                                       .layers = all_layers };
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
        cmocka_unit_test(two_techniques_share_one_frame),
        cmocka_unit_test(one_technique_with_two_settings_shares_one_frame),
        cmocka_unit_test(second_side_is_direct_light_without_a_plugin),
        cmocka_unit_test(a_split_that_ends_frees_its_half),
        cmocka_unit_test(exposure_changes_without_a_compile),
        cmocka_unit_test(passes_before_the_plugin_keep_their_textures),
        cmocka_unit_test(histories_begin_anew_after_each_switch),
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
