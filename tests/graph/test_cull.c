// SPDX-License-Identifier: MIT
// Which passes run, which do not, and why.
#include "rig.h"

#include <stdio.h>

static void dangling_leaf_and_tree_are_left_out(void **state) // C20, C21, C28
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = rig_tex(r, "c");
    PASSES(r, PASS(r, "used", .writes = { { a } }), PASS(r, "root", .writes = { { b } }),
           PASS(r, "leaf", .reads = { { b } }, .writes = { { c } }),
           PASS(r, "show", SHOW, .reads = { { a } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "used show ");
    assert_string_equal(rig_why(r, "leaf"), "nobody reads 'c'");
    assert_string_equal(rig_why(r, "root"),
                        "'b' is read only by passes that do not run, such as 'leaf'");
    // Nothing is allocated for them either.
    assert_int_equal(fg_null_live_objects(r->dev), 1);
    const fg_graph_stats s = fg_graph_get_stats(r->g);
    assert_int_equal(s.declared, 4);
    assert_int_equal(s.kept, 2);
    assert_int_equal(s.left_out, 2);
    rig_close(r);
}

static void one_read_output_keeps_all_outputs_of_a_pass(void **state) // C22
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
    PASSES(r, PASS(r, "make", .writes = { { a }, { b } }),
           PASS(r, "show", SHOW, .reads = { { b } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "make show ");
    assert_non_null(strstr(fg_null_log(r->dev), "pass make 64x64 color 1 color 2\n"));
    rig_close(r);
}

static void writing_an_import_keeps_the_pass(void **state) // C23
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res screen = fg_import_texture(r->g, "screen", &(fg_tex_desc){ 0 }, 77);
    PASSES(r, PASS(r, "draw", .writes = { { fg_next(screen) } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "draw ");
    assert_non_null(strstr(fg_null_log(r->dev), "color 77"));
    rig_close(r);
}

static void reading_an_import_keeps_nothing(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res in = fg_import_texture(r->g, "in", &(fg_tex_desc){ 0 }, 77);
    PASSES(r, PASS(r, "look", .reads = { { in } }));
    rig_must_fail(r, FG_ERR_EMPTY, "nothing to run");
    rig_close(r);
}

static void kept_reader_keeps_its_inputs_alive_while_it_runs(void **state) // C24
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
    PASSES(r, PASS(r, "make", .writes = { { a } }), PASS(r, "after", .writes = { { b } }),
           PASS(r, "save", SHOW, .reads = { { a } }), PASS(r, "show", SHOW, .reads = { { b } }));
    rig_must_compile(r);
    // Had "a" ended with its writer, "b" of the same shape would be in its memory.
    assert_int_equal(fg_graph_get_stats(r->g).transient_bytes, 2 * 32768);
    rig_close(r);
}

static void left_out_reader_releases_its_producers(void **state) // C25
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = rig_tex(r, "c");
    PASSES(r, PASS(r, "make", .writes = { { a } }),
           PASS(r, "unread", .reads = { { a } }, .writes = { { b } }),
           PASS(r, "other", .writes = { { c } }), PASS(r, "show", SHOW, .reads = { { c } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "other show ");
    rig_close(r);
}

static void keep_all_runs_everything(void **state) // C26
{
    (void) state;
    rig *r = rig_open(FG_DEBUG_KEEP_ALL);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = rig_tex(r, "c");
    PASSES(r, PASS(r, "make", .writes = { { a } }), PASS(r, "unread", .reads = { { a } }),
           PASS(r, "off", .needs = 1, .writes = { { b } }),
           PASS(r, "starved", .reads = { { b } }, .writes = { { c } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "make unread ");
    rig_close(r);
}

static void what_left_out_passes_do_has_no_effect(void **state) // C27
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
    PASSES(r, PASS(r, "make", .writes = { { a } }),
           PASS(r, "blur", .kind = FG_KIND_COMPUTE, .writes = { { b } }, .reads = { { a } }),
           PASS(r, "show", SHOW, .reads = { { a } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_null(strstr(fg_null_log(r->dev), "barrier"));
    rig_close(r);
}

static void graph_without_a_kept_pass_is_an_error_and_the_old_one_stays(void **state) // C29
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    PASSES(r, PASS(r, "show", SHOW));
    rig_must_compile(r);
    rig_begin(r);
    PASSES(r, PASS(r, "lost", .writes = { { rig_tex(r, "a") } }));
    rig_must_fail(r, FG_ERR_EMPTY, "of 1 passes none shows");
    rig_must_run(r);
    assert_string_equal(r->trace, "show ");
    rig_close(r);
}

// ---- features -----------------------------------------------------------------------------

static const char *const features[] = { "glossy", "emissive", "area light" };

static void begin_with(rig *r, uint64_t bits)
{
    const fg_frame_desc frame = { .width = 64,
                                  .height = 64,
                                  .features = bits,
                                  .feature_names = features,
                                  .feature_count = FG_COUNT(features) };
    rig_forget(r);
    fg_graph_begin(r->g, &frame);
}

static void pass_that_needs_what_the_scene_lacks_is_left_out(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    begin_with(r, 1);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = rig_tex(r, "c");
    PASSES(r, PASS(r, "voxels", .writes = { { a } }),
           PASS(r, "trace", .needs = 7, .reads = { { a } }, .writes = { { b } }),
           PASS(r, "gloss", .needs = 1, .writes = { { c } }), PASS(r, "far", .needs = 1u << 9),
           PASS(r, "show", SHOW, .reads = { { b, .optional = true }, { c } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "gloss show ");
    assert_string_equal(rig_why(r, "trace"), "scene has no 'emissive', 'area light'");
    assert_string_equal(rig_why(r, "far"), "scene has no feature 9");
    // What only it needed goes with it.
    assert_string_equal(rig_why(r, "voxels"),
                        "'a' is read only by passes that do not run, such as 'trace'");
    begin_with(r, 7);
    rig_close(r);
}

static fg_status ask_optional(const fg_run *run, void *user)
{
    *(int *) user = (int) fg_run_object(run, *((fg_res *) user + 1));
    return FG_OK;
}

static void optional_read_of_something_absent_gives_no_object(void **state) // C31, C40
{
    (void) state;
    fg_res seen[2] = { { 0 } }; // [0].id: the object asked for; [1]: the handle
    for (int has = 0; has < 2; has++) {
        rig *r = rig_open(0);
        begin_with(r, has ? 2 : 0);
        const fg_res a = rig_tex(r, "a");
        seen[1] = a;
        PASSES(r, PASS(r, "glow", .needs = 2, .writes = { { a } }),
               { .name = "show",
                 SHOW,
                 .reads = { { a, .optional = true } },
                 .run = ask_optional,
                 .user = seen });
        rig_must_compile(r);
        rig_must_run(r);
        assert_int_equal(seen[0].id, has);
        rig_close(r);
    }
    rig *r = rig_open(0);
    rig_begin(r);
    seen[0].id = 5;
    seen[1] = (fg_res){ 0 };
    PASSES(r, { .name = "show",
                SHOW,
                .reads = { { .optional = true },
                           { fg_import_buffer(r->g, "b", &(fg_buf_desc){ 4 }, 9) } },
                .run = ask_optional,
                .user = seen });
    rig_must_compile(r);
    rig_must_run(r);
    assert_int_equal(seen[0].id, 0);
    rig_close(r);
}

static void required_read_of_something_left_out_is_refused(void **state) // C31, C40
{
    (void) state;
    rig *r = rig_open(0);
    begin_with(r, 0);
    const fg_res a = rig_tex(r, "a");
    PASSES(r, PASS(r, "glow", .needs = 2, .writes = { { a } }),
           PASS(r, "show", SHOW, .reads = { { a } }));
    rig_must_fail(
        r, FG_ERR_INVALID,
        "pass 'show' reads 'a', but its writer 'glow' is left out: scene has no 'emissive'");
    rig_close(r);
}

static void left_out_change_leaves_the_version_before(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    begin_with(r, 0);
    const fg_res a = rig_tex(r, "a"), b = fg_next(a);
    PASSES(r, PASS(r, "make", .writes = { { a } }), PASS(r, "add", .needs = 2, .writes = { { b } }),
           PASS(r, "show", SHOW, .reads = { { b } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "make show ");
    rig_close(r);
}

static void reason_follows_the_names_of_the_features(void **state) // C101
{
    (void) state;
    static const char *const other[] = { "x", "glow", "y" };
    rig *r = rig_open(0);
    for (int i = 0; i < 2; i++) {
        fg_graph_begin(
            r->g, &(fg_frame_desc){ .feature_names = i ? other : features, .feature_count = 3 });
        PASSES(r, PASS(r, "p", .needs = 2), PASS(r, "show", SHOW));
        rig_must_compile(r);
        assert_string_equal(rig_why(r, "p"), i ? "scene has no 'glow'" : "scene has no 'emissive'");
    }
    rig_close(r);
}

// ---- effects ------------------------------------------------------------------------------

static void internal_effect_is_kept_while_its_group_is(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
    PASSES(r, PASS(r, "gi.age", .effect = FG_EFFECT_INTERNAL),
           PASS(r, "gi.gather", .writes = { { a } }),
           PASS(r, "gi2.age", .effect = FG_EFFECT_INTERNAL),
           PASS(r, "ao.age", .effect = FG_EFFECT_INTERNAL, .reads = { { b } }),
           PASS(r, "ao.make", .writes = { { b } }), PASS(r, "show", SHOW, .reads = { { a } }),
           PASS(r, "gi.late", .effect = FG_EFFECT_INTERNAL));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "gi.age gi.gather show gi.late ");
    assert_string_equal(rig_why(r, "gi2.age"), "no other pass of its group 'gi2' runs");
    assert_string_equal(rig_why(r, "ao.age"), "no other pass of its group 'ao' runs");
    rig_close(r);
}

static void internal_pass_keeps_its_inputs(void **state) // C24
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
    PASSES(r, PASS(r, "make", .writes = { { b } }), PASS(r, "gi.gather", .writes = { { a } }),
           PASS(r, "gi.age", .effect = FG_EFFECT_INTERNAL, .reads = { { b } }),
           PASS(r, "show", SHOW, .reads = { { a } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "make gi.gather gi.age show ");
    rig_close(r);
}

// Passes w0 to w39 write the layers of `a` in turn; with `lacking` the last one at layer 2, w38, is
// left out. Gives the last version.
static fg_res write_in_turn(rig *r, fg_res a, int lacking)
{
    for (int i = 0; i < 40; i++) {
        char name[16];
        snprintf(name, sizeof name, "w%d", i);
        const fg_io part = { a, .layer = (uint16_t) (i % 4), .layers = 1, .mips = 1 };
        PASSES(r, PASS(r, name, .needs = lacking && i == 38 ? 2 : 0, .writes = { part }));
        if (i < 39)
            a = fg_next(a);
    }
    return a;
}

static void last_writer_of_a_part_is_found_among_many_versions(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    for (int lacking = 0; lacking < 2; lacking++) {
        begin_with(r, 0);
        const fg_res screen = fg_import_texture(r->g, "screen", &(fg_tex_desc){ 0 }, 900);
        const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .layers = 4, .mips = 2 });
        const fg_res last = write_in_turn(r, a, lacking);
        const fg_io read = { last, .layer = 2, .layers = 1, .mips = 1 };
        PASSES(r, PASS(r, "show", .reads = { read }, .writes = { { fg_next(screen) } }));
        rig_must_compile(r);
        rig_must_run(r);
        // Partial writes keep what wrote the same texels before them.
        assert_string_equal(r->trace, lacking ? "w2 w6 w10 w14 w18 w22 w26 w30 w34 show "
                                              : "w2 w6 w10 w14 w18 w22 w26 w30 w34 w38 show ");
    }
    rig_close(r);
}

static void exported_version_is_kept_and_gives_its_object(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = rig_tex(r, "c");
    fg_export(r->g, a);
    PASSES(r, PASS(r, "make", .writes = { { a } }), PASS(r, "next", .writes = { { b } }),
           PASS(r, "more", .reads = { { b } }, .writes = { { c } }),
           PASS(r, "show", SHOW, .reads = { { c } }));
    rig_must_compile(r);
    assert_int_equal(fg_graph_exported(r->g, a), 0); // not made yet
    rig_must_run(r);
    assert_int_equal(fg_graph_exported(r->g, a), 1);
    assert_int_equal(fg_graph_exported(r->g, b), 0);
    // It shares no memory, though all three have one shape and it is last used first.
    const fg_graph_stats s = fg_graph_get_stats(r->g);
    assert_int_equal(s.persistent_bytes, 32768);
    assert_int_equal(s.transient_bytes, 2 * 32768);
    rig_close(r);
}

static void bad_exports_are_refused(void **state) // C42
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    fg_res a = rig_tex(r, "a");
    fg_export(r->g, a);
    PASSES(r, PASS(r, "show", SHOW));
    rig_must_fail(r, FG_ERR_INVALID, "export of version 1 of 'a', which no pass writes");
    rig_begin(r);
    a = rig_tex(r, "a");
    fg_export(r->g, a);
    PASSES(r, PASS(r, "make", .writes = { { a } }), PASS(r, "add", .writes = { { fg_next(a) } }));
    rig_must_fail(r, FG_ERR_INVALID,
                  "export of a stale handle: version 1 of 'a' is overwritten by pass 'add'");
    rig_begin(r);
    fg_export(r->g, (fg_res){ 0 });
    rig_must_fail(r, FG_ERR_INVALID, "fg_export(): the handle is null");
    begin_with(r, 0);
    a = rig_tex(r, "a");
    fg_export(r->g, a);
    PASSES(r, PASS(r, "glow", .needs = 2, .writes = { { a } }), PASS(r, "show", SHOW));
    rig_must_compile(r); // never made: its writer is left out
    rig_must_run(r);
    assert_int_equal(fg_graph_exported(r->g, a), 0);
    rig_close(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dangling_leaf_and_tree_are_left_out),
        cmocka_unit_test(one_read_output_keeps_all_outputs_of_a_pass),
        cmocka_unit_test(writing_an_import_keeps_the_pass),
        cmocka_unit_test(reading_an_import_keeps_nothing),
        cmocka_unit_test(kept_reader_keeps_its_inputs_alive_while_it_runs),
        cmocka_unit_test(left_out_reader_releases_its_producers),
        cmocka_unit_test(keep_all_runs_everything),
        cmocka_unit_test(what_left_out_passes_do_has_no_effect),
        cmocka_unit_test(graph_without_a_kept_pass_is_an_error_and_the_old_one_stays),
        cmocka_unit_test(pass_that_needs_what_the_scene_lacks_is_left_out),
        cmocka_unit_test(optional_read_of_something_absent_gives_no_object),
        cmocka_unit_test(required_read_of_something_left_out_is_refused),
        cmocka_unit_test(left_out_change_leaves_the_version_before),
        cmocka_unit_test(reason_follows_the_names_of_the_features),
        cmocka_unit_test(internal_effect_is_kept_while_its_group_is),
        cmocka_unit_test(internal_pass_keeps_its_inputs),
        cmocka_unit_test(last_writer_of_a_part_is_found_among_many_versions),
        cmocka_unit_test(exported_version_is_kept_and_gives_its_object),
        cmocka_unit_test(bad_exports_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
