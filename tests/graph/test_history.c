// SPDX-License-Identifier: MIT
// Last frame's contents.
#include "rig.h"

#include <stdio.h>

typedef struct seen {
    fg_res now, before;
    uint32_t written, read;
    bool valid;
} seen;

static fg_status look(const fg_run *run, void *user)
{
    seen *s = user;
    s->read = fg_run_object(run, s->before);
    s->written = fg_run_object(run, s->now);
    s->valid = fg_run_history_valid(run, s->before);
    return FG_OK;
}

// A pass that reads last frame's "h" and writes this frame's.
static void declare(rig *r, seen *s, const fg_tex_desc *desc)
{
    s->now = fg_texture(r->g, "h", desc);
    s->before = fg_last_frame(r->g, s->now);
    PASSES(r, { .name = "blend",
                SHOW,
                .reads = { { s->before } },
                .writes = { { s->now, .mips = 1, .load = FG_LOAD_DISCARD } },
                .run = look,
                .user = s });
    rig_must_compile(r);
}

static const fg_tex_desc clear_first = { .history = FG_HISTORY_CLEAR };
static const fg_tex_desc discard_first = { .history = FG_HISTORY_DISCARD };

static void first_frame_reads_zeros(void **state) // C70
{
    (void) state;
    rig *r = rig_open(0);
    seen s;
    rig_begin(r);
    declare(r, &s, &clear_first);
    rig_must_run(r);
    assert_false(s.valid);
    char line[64];
    snprintf(line, sizeof line, "clear %u mips 0+1 layers 0+1 to 0 0 0 0\nframe 0", s.read);
    assert_non_null(strstr(fg_null_log(r->dev), line));
    rig_must_run(r);
    assert_true(s.valid);
    assert_null(strstr(fg_null_log(r->dev), "clear"));
    rig_close(r);
}

static void discard_policy_clears_nothing(void **state) // C70
{
    (void) state;
    rig *r = rig_open(0);
    seen s;
    rig_begin(r);
    declare(r, &s, &discard_first);
    rig_must_run(r);
    assert_false(s.valid);
    assert_null(strstr(fg_null_log(r->dev), "clear"));
    rig_must_run(r);
    assert_true(s.valid);
    rig_close(r);
}

static void frame_reads_what_the_frame_before_wrote(void **state) // C71, C75
{
    (void) state;
    rig *r = rig_open(0);
    seen s;
    uint32_t before = 0;
    for (int i = 0; i < 5; i++) {
        rig_begin(r); // equal: handles are new, the plan is not
        declare(r, &s, &clear_first);
        rig_must_run(r);
        assert_int_not_equal(s.read, s.written);
        if (i)
            assert_int_equal(s.read, before);
        before = s.written;
    }
    assert_int_equal(fg_graph_get_stats(r->g).compiles, 1);
    rig_close(r);
}

static void reading_only_last_frame_keeps_the_writer(void **state) // C72
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res h = fg_texture(r->g, "h", &clear_first), x = rig_tex(r, "x");
    PASSES(r, PASS(r, "feed", .writes = { { x } }),
           PASS(r, "make", .reads = { { x } }, .writes = { { h } }),
           PASS(r, "show", SHOW, .reads = { { fg_last_frame(r->g, h) } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "feed make show ");
    rig_close(r);
}

static void history_that_only_its_writer_reads_is_left_out(void **state) // C25
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res h = fg_texture(r->g, "h", &clear_first);
    PASSES(r, PASS(r, "blend", .reads = { { fg_last_frame(r->g, h) } }, .writes = { { h } }),
           PASS(r, "show", SHOW));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "show ");
    assert_int_equal(fg_null_live_objects(r->dev), 0);
    rig_close(r);
}

static void history_survives_recompiles_and_other_graphs(void **state) // C73
{
    (void) state;
    rig *r = rig_open(0);
    seen s;
    rig_begin(r);
    declare(r, &s, &clear_first);
    rig_must_run(r);
    const uint32_t written = s.written;
    // A graph without it, twice; then one with more passes.
    for (int i = 0; i < 2; i++) {
        rig_begin(r);
        PASSES(r, PASS(r, i ? "one" : "two", SHOW));
        rig_must_compile(r);
        rig_must_run(r);
        rig_must_run(r);
    }
    rig_begin(r);
    PASSES(r, PASS(r, "more", SHOW));
    declare(r, &s, &clear_first);
    rig_must_run(r);
    assert_true(s.valid);
    assert_int_equal(s.read, written);
    assert_null(strstr(r->said, "reset"));
    rig_close(r);
}

static void history_survives_a_frame_that_leaves_its_writers_out(void **state) // C73
{
    (void) state;
    rig *r = rig_open(0);
    seen s;
    rig_begin(r);
    declare(r, &s, &clear_first);
    rig_must_run(r);
    const uint32_t written = s.written;
    rig_begin(r);
    const fg_res h = fg_texture(r->g, "h", &clear_first);
    PASSES(r, PASS(r, "make", .writes = { { h } }), PASS(r, "show", SHOW));
    rig_must_compile(r);
    rig_must_run(r);
    rig_begin(r);
    declare(r, &s, &clear_first);
    rig_must_run(r);
    assert_true(s.valid);
    assert_int_equal(s.read, written);
    rig_close(r);
}

static void new_size_or_format_resets_it_once_with_a_reason(void **state) // C74
{
    (void) state;
    static const fg_tex_desc descs[] = {
        { .history = FG_HISTORY_CLEAR, .width = 32, .height = 32 },
        { .history = FG_HISTORY_CLEAR, .width = 32, .height = 32, .format = FG_RG32F },
        { .history = FG_HISTORY_CLEAR, .width = 32, .height = 32, .format = FG_RG32F, .mips = 2 },
    };
    static const char *const words[] = {
        "history 'h': reset, it was RGBA16F 64x64x0, 0 layers, 1 mips, 1 samples and is now ",
        "and is now RG32F 32x32x0, 0 layers, 1 mips",
        "and is now RG32F 32x32x0, 0 layers, 2 mips",
    };
    rig *r = rig_open(0);
    seen s;
    rig_begin(r);
    declare(r, &s, &clear_first);
    rig_must_run(r);
    rig_must_run(r);
    assert_true(s.valid);
    for (int i = 0; i < FG_COUNT(descs); i++) {
        rig_begin(r);
        declare(r, &s, &descs[i]);
        rig_must_run(r);
        rig_must_have_said(r, words[i]);
        assert_false(s.valid);
        assert_int_equal(fg_null_live_objects(r->dev), 2);
        rig_must_run(r);
        assert_true(s.valid);
        assert_int_equal(rig_count(r->said, "reset"), 1);
    }
    rig_close(r);
}

static void texture_that_comes_back_as_a_buffer_is_reset(void **state) // C74
{
    (void) state;
    rig *r = rig_open(0);
    seen s;
    rig_begin(r);
    declare(r, &s, &clear_first);
    rig_must_run(r);
    rig_begin(r);
    const fg_res h = fg_buffer(r->g, "h", &(fg_buf_desc){ 32, FG_HISTORY_CLEAR });
    PASSES(r, PASS(r, "p", SHOW, .reads = { { fg_last_frame(r->g, h) } }, .writes = { { h } }));
    rig_must_compile(r);
    rig_must_run(r);
    rig_must_have_said(r, "and is now 32 bytes");
    assert_int_equal(fg_null_live_bytes(r->dev), 64);
    rig_close(r);
}

static void trim_frees_histories_that_are_not_in_use(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    seen s;
    rig_begin(r);
    declare(r, &s, &clear_first);
    rig_must_run(r);
    fg_graph_trim(r->g);
    rig_must_run(r);
    assert_true(s.valid); // in use: stays
    rig_begin(r);
    PASSES(r, PASS(r, "show", SHOW));
    rig_must_compile(r);
    fg_graph_trim(r->g);
    assert_int_equal(fg_null_live_objects(r->dev), 0);
    rig_must_run(r);
    rig_begin(r);
    declare(r, &s, &clear_first);
    rig_must_run(r);
    assert_false(s.valid);
    rig_close(r);
}

static fg_status fail_when(const fg_run *run, void *user)
{
    (void) run;
    return *(bool *) user ? FG_ERR_SHADER : FG_OK;
}

static void failed_frame_leaves_last_frame_as_it_was(void **state) // C121
{
    (void) state;
    rig *r = rig_open(0);
    seen s;
    bool failing = false;
    rig_begin(r);
    s.now = fg_texture(r->g, "h", &clear_first);
    s.before = fg_last_frame(r->g, s.now);
    PASSES(r,
           { .name = "blend",
             .reads = { { s.before } },
             .writes = { { s.now } },
             .run = look,
             .user = &s },
           { .name = "show", SHOW, .reads = { { s.now } }, .run = fail_when, .user = &failing });
    rig_must_compile(r);
    rig_must_run(r);
    const uint32_t written = s.written;
    failing = true;
    assert_int_equal(fg_graph_run(r->g), FG_ERR_SHADER);
    rig_must_have_said(r, "pass 'show' failed: shader does not build");
    failing = false;
    rig_must_run(r);
    assert_true(s.valid);
    assert_int_equal(s.read, written);
    rig_close(r);
}

static void reader_of_a_history_whose_writer_is_left_out_is_refused(void **state) // C31
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res h = fg_texture(r->g, "h", &clear_first);
    PASSES(r, PASS(r, "make", .needs = 1, .writes = { { h } }),
           PASS(r, "show", SHOW, .reads = { { fg_last_frame(r->g, h) } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'show' reads 'h', but its writer 'make' is left out");
    rig_close(r);
}

static void exported_history_is_this_frames(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    seen s;
    rig_begin(r);
    s.now = fg_texture(r->g, "h", &clear_first);
    s.before = fg_last_frame(r->g, s.now);
    fg_export(r->g, s.now);
    PASSES(r, { .name = "blend",
                .reads = { { s.before } },
                .writes = { { s.now } },
                .run = look,
                .user = &s });
    rig_must_compile(r);
    for (int i = 0; i < 3; i++) {
        rig_must_run(r);
        assert_int_equal(fg_graph_exported(r->g, s.now), s.written);
    }
    rig_close(r);
}

static void forgetting_begins_anew_by_the_policy(void **state)
{
    (void) state;
    static const char *const prefixes[] = { "h", "", NULL };
    rig *r = rig_open(0);
    seen s;
    rig_begin(r);
    declare(r, &s, &clear_first);
    for (int i = 0; i < FG_COUNT(prefixes); i++) {
        rig_must_run(r);
        rig_must_run(r);
        assert_true(s.valid);
        const int live = fg_null_live_objects(r->dev);
        fg_graph_forget(r->g, prefixes[i]);
        rig_must_run(r);
        assert_false(s.valid);
        assert_non_null(strstr(fg_null_log(r->dev), "to 0 0 0 0\nframe")); // zeros again
        assert_int_not_equal(s.read, s.written);
        rig_must_run(r);
        assert_true(s.valid);
        assert_int_equal(fg_null_live_objects(r->dev), live);
    }
    fg_graph_forget(r->g, "hist"); // no name begins so
    rig_must_run(r);
    assert_true(s.valid);
    assert_int_equal(fg_graph_get_stats(r->g).compiles, 1);
    rig_close(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_frame_reads_zeros),
        cmocka_unit_test(discard_policy_clears_nothing),
        cmocka_unit_test(frame_reads_what_the_frame_before_wrote),
        cmocka_unit_test(reading_only_last_frame_keeps_the_writer),
        cmocka_unit_test(history_that_only_its_writer_reads_is_left_out),
        cmocka_unit_test(history_survives_recompiles_and_other_graphs),
        cmocka_unit_test(history_survives_a_frame_that_leaves_its_writers_out),
        cmocka_unit_test(new_size_or_format_resets_it_once_with_a_reason),
        cmocka_unit_test(texture_that_comes_back_as_a_buffer_is_reset),
        cmocka_unit_test(trim_frees_histories_that_are_not_in_use),
        cmocka_unit_test(failed_frame_leaves_last_frame_as_it_was),
        cmocka_unit_test(reader_of_a_history_whose_writer_is_left_out_is_refused),
        cmocka_unit_test(exported_history_is_this_frames),
        cmocka_unit_test(forgetting_begins_anew_by_the_policy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
