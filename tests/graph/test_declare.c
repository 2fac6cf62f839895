// SPDX-License-Identifier: MIT
// Declaring: what is refused at once, and the versions of resources.
#include "rig.h"

// ---- declarations -----------------------------------------------------------------------

static void empty_declaration_compiles_to_nothing(void **state) // C01
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    rig_must_fail(r, FG_ERR_EMPTY, "nothing to run");
    rig_close(r);
}

static void pass_without_access_is_left_out_with_a_reason(void **state) // C02, C28
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    PASSES(r, PASS(r, "idle"), PASS(r, "show", SHOW));
    rig_must_compile(r);
    assert_string_equal(rig_why(r, "idle"), "writes nothing and has no effect outside");
    assert_null(rig_why(r, "show"));
    rig_close(r);
}

static void names_are_unique(void **state) // C03
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    PASSES(r, PASS(r, "show", SHOW), PASS(r, "show", SHOW));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'show': the name is taken");
    rig_begin(r);
    rig_tex(r, "hdr");
    rig_buf(r, "hdr");
    PASSES(r, PASS(r, "hdr", SHOW)); // a pass may be called like a resource
    rig_must_fail(r, FG_ERR_INVALID, "resource 'hdr': the name is taken");
    assert_int_equal(rig_count(r->said, "taken"), 1);
    rig_close(r);
}

static void names_are_required(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    assert_int_equal(rig_tex(r, NULL).id, 0);
    assert_int_equal(rig_tex(r, "").id, 0);
    PASSES(r, PASS(r, NULL, SHOW));
    rig_must_fail(r, FG_ERR_INVALID, "texture 0: has no name");
    rig_must_have_said(r, "pass 0: has no name");
    rig_close(r);
}

static void pass_needs_a_callback(void **state) // C04
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    PASSES(r, { .name = "sky", SHOW });
    rig_must_fail(r, FG_ERR_INVALID, "pass 'sky': needs a run callback");
    rig_close(r);
}

static void consumer_may_be_declared_before_its_producer(void **state) // C05
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    PASSES(r, PASS(r, "show", SHOW, .reads = { { a } }), PASS(r, "make", .writes = { { a } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "make show ");
    rig_close(r);
}

static void declaring_needs_an_open_declaration(void **state) // C06
{
    (void) state;
    rig *r = rig_open(0);
    assert_int_equal(rig_tex(r, "a").id, 0);
    rig_must_have_said(r, "texture 'a': declared outside a declaration");
    PASSES(r, PASS(r, "p", SHOW));
    rig_must_have_said(r, "pass 'p': declared outside a declaration");
    assert_int_equal(fg_graph_compile(r->g), FG_ERR_INVALID);
    rig_must_have_said(r, "fg_graph_compile() called without a declaration");
    assert_int_equal(fg_graph_run(r->g), FG_ERR_INVALID);
    rig_must_have_said(r, "fg_graph_run() called before a graph has compiled");
    rig_begin(r);
    PASSES(r, PASS(r, "show", SHOW));
    assert_int_equal(fg_graph_run(r->g), FG_ERR_INVALID); // too early; does the declaration no harm
    rig_must_compile(r);
    rig_must_compile(r); // again: it has compiled
    rig_close(r);
}

static fg_status declare_in_run(const fg_run *run, void *user)
{
    rig *r = user;
    (void) run;
    fg_graph_begin(r->g, NULL);
    assert_int_equal(rig_tex(r, "late").id, 0);
    PASSES(r, PASS(r, "late.pass", SHOW));
    assert_int_equal(fg_graph_compile(r->g), FG_ERR_INVALID);
    assert_int_equal(fg_graph_run(r->g), FG_ERR_INVALID);
    fg_graph_trim(r->g);
    fg_graph_destroy(r->g);
    return FG_OK;
}

static void declaring_while_the_graph_runs_fails_the_frame(void **state) // C07
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    fg_pass_desc show = PASS(r, "show", SHOW);
    show.run = declare_in_run;
    fg_passes(r->g, &show, 1);
    rig_must_compile(r);
    assert_int_equal(fg_graph_run(r->g), FG_ERR_INVALID);
    rig_must_have_said(r, "fg_graph_begin() called while the graph runs");
    rig_must_have_said(r, "texture 'late': declared while the graph runs");
    rig_must_have_said(r, "pass 'late.pass': declared while the graph runs");
    rig_must_have_said(r, "fg_graph_compile() called while the graph runs");
    rig_must_have_said(r, "fg_graph_run() called while the graph runs");
    rig_must_have_said(r, "fg_graph_trim() called while the graph runs");
    rig_must_have_said(r, "fg_graph_destroy() called while the graph runs");
    rig_begin(r);
    PASSES(r, PASS(r, "show", SHOW));
    rig_must_compile(r);
    rig_must_run(r);
    rig_close(r);
}

static void host_can_fail_a_declaration(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    PASSES(r, PASS(r, "show", SHOW));
    fg_fail(r->g, "host: %d lights", 3);
    rig_must_fail(r, FG_ERR_INVALID, "host: 3 lights");
    assert_int_equal(fg_graph_run(r->g), FG_ERR_INVALID);
    rig_close(r);
}

// ---- descriptors ------------------------------------------------------------------------

typedef struct bad_texture {
    fg_tex_desc desc;
    fg_status status;
    const char *text;
} bad_texture;

static void bad_texture_descriptors_are_refused(void **state) // C38
{
    (void) state;
    static const bad_texture cases[] = {
        { { .format = (fg_format) 99 }, FG_ERR_INVALID, "texture 'x': format 99 does not exist" },
        { { .width = -1, .height = 4 }, FG_ERR_INVALID, "texture 'x': size is -1x4" },
        { { .width = 4 }, FG_ERR_INVALID, "texture 'x': size is 4x0" },
        { { .scale_log2 = 16 },
          FG_ERR_INVALID,
          "texture 'x': scale_log2 is 16, must be in [0, 15]" },
        { { .depth = -1 }, FG_ERR_INVALID, "texture 'x': depth -1" },
        { { .depth = 4, .layers = 2 }, FG_ERR_INVALID, "texture 'x': a 3D texture has no layers" },
        { { .cube = true, .layers = 7 }, FG_ERR_INVALID, "texture 'x': a cube map is square" },
        { { .cube = true, .width = 8, .height = 4 }, FG_ERR_INVALID, "8x4 with 0 layers" },
        { { .mips = 8 }, FG_ERR_INVALID, "texture 'x': 8 mips, must be in [0, 7]" },
        { { .mips = -2 }, FG_ERR_INVALID, "texture 'x': -2 mips" },
        { { .mips = 2, .samples = 4 },
          FG_ERR_INVALID,
          "texture 'x': a multisample texture has no mips" },
        { { .history = (fg_history) 7 }, FG_ERR_INVALID, "texture 'x': history policy 7" },
        { { .width = 16385, .height = 1 }, FG_ERR_UNSUPPORTED, "texture 'x': 16385x1x0" },
        { { .depth = 2049 }, FG_ERR_UNSUPPORTED, "is more than the device has: size 2048" },
        { { .layers = 2049 }, FG_ERR_UNSUPPORTED, "2049 layers" },
        { { .samples = 5 }, FG_ERR_UNSUPPORTED, "5 samples is more" },
    };
    rig *r = rig_open(0);
    for (int i = 0; i < FG_COUNT(cases); i++) {
        rig_begin(r);
        assert_int_equal(fg_texture(r->g, "x", &cases[i].desc).id, 0);
        PASSES(r, PASS(r, "show", SHOW));
        rig_must_fail(r, cases[i].status, cases[i].text);
        rig_begin(r);
        assert_int_equal(fg_import_texture(r->g, "x", &cases[i].desc, 7).id, 0);
        rig_must_fail(r, cases[i].status, cases[i].text);
    }
    rig_close(r);
}

static void frame_sized_texture_needs_a_frame_size(void **state) // C38
{
    (void) state;
    rig *r = rig_open(0);
    fg_graph_begin(r->g, NULL);
    assert_int_equal(rig_tex(r, "hdr").id, 0);
    rig_must_fail(r, FG_ERR_INVALID, "texture 'hdr': has the frame's size, which is 0x0");
    rig_close(r);
}

static void bad_buffers_and_imports_are_refused(void **state) // C38, C39
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    assert_int_equal(fg_buffer(r->g, "b", &(fg_buf_desc){ 0 }).id, 0);
    rig_must_fail(r, FG_ERR_INVALID, "buffer 'b': size is 0 bytes");
    rig_begin(r);
    assert_int_equal(fg_buffer(r->g, "b", &(fg_buf_desc){ .size = UINT64_MAX }).id, 0);
    rig_must_fail(r, FG_ERR_UNSUPPORTED, "buffer 'b': 18446744073709551615 bytes is more");
    rig_begin(r);
    assert_int_equal(fg_import_texture(r->g, "t", &(fg_tex_desc){ 0 }, 0).id, 0);
    rig_must_fail(r, FG_ERR_INVALID, "texture 't': an import needs an object");
    rig_begin(r);
    assert_int_equal(fg_import_buffer(r->g, "b", &(fg_buf_desc){ .size = 4 }, 0).id, 0);
    rig_must_fail(r, FG_ERR_INVALID, "buffer 'b': an import needs an object");
    rig_begin(r);
    const fg_buf_desc history = { .size = 4, .history = FG_HISTORY_CLEAR };
    assert_int_equal(fg_import_buffer(r->g, "b", &history, 7).id, 0);
    rig_must_fail(r, FG_ERR_INVALID, "buffer 'b': an import has no history");
    rig_close(r);
}

static void bad_pass_fields_are_refused(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    PASSES(r, PASS(r, "p", SHOW, .kind = (fg_kind) 5));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'p': kind 5");
    rig_begin(r);
    PASSES(r, PASS(r, "p", .effect = (fg_effect) 9));
    rig_must_fail(r, FG_ERR_INVALID, "effect 9 does not exist");
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    PASSES(r, PASS(r, "p", .writes = { { a, .use = (fg_use) 77 } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'p' writes 'a': use 77");
    rig_begin(r);
    const fg_res b = rig_tex(r, "b");
    PASSES(r, PASS(r, "p", .writes = { { b, .load = (fg_load) 3 } }));
    rig_must_fail(r, FG_ERR_INVALID, "load 3 does not exist");
    rig_close(r);
}

static void sizes_resolve_from_the_frame(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    fg_graph_begin(r->g, &(fg_frame_desc){ .width = 1023, .height = 5 });
    const fg_tex_desc quarter = { .scale_log2 = 2, .mips = FG_MIPS_ALL };
    const fg_tex_desc cube = { .width = 8, .height = 8, .cube = true, .format = FG_DEPTH32F };
    const fg_res a = fg_texture(r->g, "a", &quarter), b = fg_texture(r->g, "b", &cube);
    PASSES(r, PASS(r, "p", .writes = { { a, .mips = 1 } }), PASS(r, "q", .writes = { { b } }),
           PASS(r, "show", SHOW, .reads = { { a, .mips = 1 }, { b } }));
    rig_must_compile(r);
    rig_must_run(r);
    // Sizes round up: (1023 + 3) / 4 and (5 + 3) / 4.
    assert_non_null(strstr(fg_null_log(r->dev), "texture a RGBA16F 256x2 mips 9 -> 1\n"));
    assert_non_null(strstr(fg_null_log(r->dev), "texture b DEPTH32F 8x8 cube 6 -> 2\n"));
    rig_close(r);
}

// ---- versions ---------------------------------------------------------------------------

static void null_handle_has_no_next(void **state)
{
    (void) state;
    assert_int_equal(fg_next((fg_res){ 0 }).id, 0);
    const fg_res last = { .id = 1, .version = 65534 };
    assert_int_equal(fg_next(last).version, 0);
}

static void reading_makes_no_version(void **state) // C10
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    PASSES(r, PASS(r, "make", .writes = { { a } }), PASS(r, "one", SHOW, .reads = { { a } }),
           PASS(r, "two", SHOW, .reads = { { a } }), PASS(r, "add", .writes = { { fg_next(a) } }),
           PASS(r, "three", SHOW, .reads = { { fg_next(a) } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "make one two add three ");
    rig_close(r);
}

static void stale_read_is_refused(void **state) // C11
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    PASSES(r, PASS(r, "make", .writes = { { a } }), PASS(r, "add", .writes = { { fg_next(a) } }),
           PASS(r, "show", SHOW, .reads = { { a } }));
    rig_must_fail(
        r, FG_ERR_INVALID,
        "pass 'show' reads a stale handle: version 1 of 'a' is overwritten by pass 'add'");
    rig_close(r);
}

static void handle_of_another_declaration_is_refused(void **state) // C11
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    PASSES(r, PASS(r, "make", SHOW, .writes = { { a } }));
    rig_must_compile(r);
    rig_begin(r);
    rig_tex(r, "b");
    PASSES(r, PASS(r, "make", SHOW, .writes = { { a } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'make' writes a stale handle: resource 1 ('a')");
    rig_begin(r);
    fg_export(r->g, a);
    rig_must_fail(r, FG_ERR_INVALID, "fg_export(): the handle of resource 1 ('a')");
    rig_begin(r);
    fg_last_frame(r->g, a);
    rig_must_fail(r, FG_ERR_INVALID, "fg_last_frame(): the handle of resource 1 ('a')");
    rig_begin(r);
    PASSES(r, PASS(r, "make", SHOW, .writes = { { { 7, 1, rig_tex(r, "c").epoch } } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'make' writes resource 7, which does not exist");
    rig_close(r);
}

static void version_has_one_writer(void **state) // C12, C16
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    PASSES(r, PASS(r, "one", .writes = { { a } }), PASS(r, "two", .writes = { { a } }),
           PASS(r, "show", SHOW, .reads = { { a } }));
    rig_must_fail(r, FG_ERR_INVALID, "passes 'one' and 'two' both write version 1 of 'a'");
    rig_close(r);
}

static void versions_have_no_gap(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), c = fg_next(fg_next(a));
    PASSES(r, PASS(r, "one", .writes = { { a } }), PASS(r, "three", .writes = { { c } }),
           PASS(r, "show", SHOW, .reads = { { c } }));
    rig_must_fail(r, FG_ERR_INVALID, "'a': version 3 is written, but only 2 versions are");
    rig_begin(r);
    const fg_res b = rig_tex(r, "b");
    PASSES(r, PASS(r, "one",
                   .writes = { { fg_next(b), .mip = 0, .mips = 1 }, { fg_next(b), .mips = 1 } }));
    rig_must_fail(r, FG_ERR_INVALID, "'b': version 2 is written, but no pass writes version 1");
    rig_begin(r);
    const fg_res d = rig_tex(r, "d");
    PASSES(r, PASS(r, "show", SHOW, .reads = { { fg_next(d) } }),
           PASS(r, "w", .writes = { { d } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'show' reads version 2 of 'd', which no pass writes");
    rig_close(r);
}

static void pass_may_write_two_parts_and_read_before_it_writes(void **state) // C13, C15
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .layers = 2 });
    PASSES(r,
           PASS(r, "make",
                .writes = { { a, .layer = 0, .layers = 1 }, { a, .layer = 1, .layers = 1 } }),
           PASS(r, "change", .kind = FG_KIND_COMPUTE, .reads = { { a, FG_USE_IMAGE } },
                .writes = { { fg_next(a) } }),
           PASS(r, "show", SHOW, .reads = { { fg_next(a) } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "make change show ");
    rig_close(r);
}

static void pass_does_not_read_what_it_writes(void **state) // C14, C33
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_buf(r, "a");
    PASSES(r,
           PASS(r, "self", SHOW, .kind = FG_KIND_COMPUTE, .reads = { { a } }, .writes = { { a } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'self' reads version 1 of 'a', which it writes itself");
    rig_close(r);
}

static void partial_write_keeps_earlier_writers(void **state) // C17, C18
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = fg_next(a), c = fg_next(b);
    PASSES(r, PASS(r, "one", .writes = { { a } }), PASS(r, "two", .writes = { { b } }),
           PASS(r, "three", .writes = { { c } }), PASS(r, "show", SHOW, .reads = { { c } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "one two three show ");
    rig_close(r);
}

static void full_write_lets_earlier_writers_go(void **state) // C17
{
    (void) state;
    static const fg_load loads[] = { FG_LOAD_CLEAR, FG_LOAD_DISCARD };
    rig *r = rig_open(0);
    for (int i = 0; i < 2; i++) {
        rig_begin(r);
        const fg_res a = rig_tex(r, "a"), b = fg_next(a);
        PASSES(r, PASS(r, "one", .writes = { { a } }),
               PASS(r, "two", .writes = { { b, .load = loads[i] } }),
               PASS(r, "show", SHOW, .reads = { { b } }));
        rig_must_compile(r);
        rig_must_run(r);
        assert_string_equal(r->trace, "two show ");
        assert_string_equal(rig_why(r, "one"), "nobody reads 'a' before 'two' overwrites it");
    }
    rig_close(r);
}

static void versions_share_one_object_that_lives_to_the_last_reader(void **state) // C19
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = fg_next(a), x = rig_tex(r, "x");
    PASSES(r, PASS(r, "one", .writes = { { a } }), PASS(r, "two", .writes = { { b } }),
           PASS(r, "other", .writes = { { x } }), PASS(r, "show", SHOW, .reads = { { b }, { x } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_int_equal(fg_null_live_objects(r->dev), 2);
    char *text = rig_dump(r, FG_DUMP_TEXT);
    assert_non_null(strstr(text, "a: RGBA16F 64x64, 32768 bytes, steps 0..3, slot 0"));
    fg_dump_free(r->g, text);
    rig_close(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(empty_declaration_compiles_to_nothing),
        cmocka_unit_test(pass_without_access_is_left_out_with_a_reason),
        cmocka_unit_test(names_are_unique),
        cmocka_unit_test(names_are_required),
        cmocka_unit_test(pass_needs_a_callback),
        cmocka_unit_test(consumer_may_be_declared_before_its_producer),
        cmocka_unit_test(declaring_needs_an_open_declaration),
        cmocka_unit_test(declaring_while_the_graph_runs_fails_the_frame),
        cmocka_unit_test(host_can_fail_a_declaration),
        cmocka_unit_test(bad_texture_descriptors_are_refused),
        cmocka_unit_test(frame_sized_texture_needs_a_frame_size),
        cmocka_unit_test(bad_buffers_and_imports_are_refused),
        cmocka_unit_test(bad_pass_fields_are_refused),
        cmocka_unit_test(sizes_resolve_from_the_frame),
        cmocka_unit_test(null_handle_has_no_next),
        cmocka_unit_test(reading_makes_no_version),
        cmocka_unit_test(stale_read_is_refused),
        cmocka_unit_test(handle_of_another_declaration_is_refused),
        cmocka_unit_test(version_has_one_writer),
        cmocka_unit_test(versions_have_no_gap),
        cmocka_unit_test(pass_may_write_two_parts_and_read_before_it_writes),
        cmocka_unit_test(pass_does_not_read_what_it_writes),
        cmocka_unit_test(partial_write_keeps_earlier_writers),
        cmocka_unit_test(full_write_lets_earlier_writers_go),
        cmocka_unit_test(versions_share_one_object_that_lives_to_the_last_reader),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
