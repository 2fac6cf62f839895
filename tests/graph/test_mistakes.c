// SPDX-License-Identifier: MIT
// Mistakes that compile and run find: each message names pass, resource and rule.
#include "rig.h"

static void reading_what_nobody_wrote_is_refused(void **state) // C30
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    PASSES(r, PASS(r, "show", SHOW, .reads = { { a } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'show' reads version 1 of 'a', which no pass writes");
    rig_close(r);
}

static void reading_a_mip_that_nobody_wrote_is_refused(void **state) // C30
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .mips = 3 });
    PASSES(r, PASS(r, "make", .writes = { { a, .mips = 1 } }),
           PASS(r, "show", SHOW, .reads = { { a, .mip = 2 } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'show' reads 'a' before any pass writes it: mip 2");
    rig_close(r);
}

static void cycle_is_named_pass_by_pass(void **state) // C32
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = rig_tex(r, "c");
    PASSES(r, PASS(r, "one", .reads = { { c } }, .writes = { { a } }),
           PASS(r, "two", .reads = { { a } }, .writes = { { b } }),
           PASS(r, "three", .reads = { { b } }, .writes = { { c } }),
           PASS(r, "show", SHOW, .reads = { { c } }));
    rig_must_fail(
        r, FG_ERR_INVALID,
        "cycle: pass 'one' waits for 'three' because of 'c', 'three' waits for 'two' because "
        "of 'b', 'two' waits for 'one' because of 'a'");
    rig_close(r);
}

static void cycle_through_an_overwrite_is_found(void **state) // C32
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res x = rig_buf(r, "x"), y = rig_buf(r, "y");
    PASSES(r, PASS(r, "make", .writes = { { x } }),
           PASS(r, "look", SHOW, .reads = { { x }, { y } }),
           PASS(r, "change", .writes = { { fg_next(x) }, { y } }));
    rig_must_fail(r, FG_ERR_INVALID,
                  "cycle: pass 'look' waits for 'change' because of 'y', 'change' waits for 'look' "
                  "because of 'x'");
    rig_close(r);
}

static void attachments_must_agree(void **state) // C34
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    fg_res a = rig_tex(r, "a"), b = fg_texture(r->g, "b", &(fg_tex_desc){ .scale_log2 = 1 });
    PASSES(r, PASS(r, "draw", SHOW, .writes = { { a }, { b } }));
    rig_must_fail(r, FG_ERR_INVALID,
                  "pass 'draw': attachment 'b' is 32x32 with 1 samples, but 'a' is 64x64 with 1");
    rig_begin(r);
    a = rig_tex(r, "a");
    b = fg_texture(r->g, "b", &(fg_tex_desc){ .format = FG_DEPTH32F, .samples = 4 });
    PASSES(r, PASS(r, "draw", SHOW, .writes = { { a }, { b } }));
    rig_must_fail(r, FG_ERR_INVALID, "attachment 'b' is 64x64 with 4 samples");
    rig_begin(r);
    a = rig_tex(r, "a");
    b = fg_texture(r->g, "b", &(fg_tex_desc){ .layers = 3 });
    PASSES(r, PASS(r, "draw", SHOW, .writes = { { a }, { b } }));
    rig_must_fail(r, FG_ERR_INVALID, "attachments 'a' and 'b' must both be layered or neither");
    rig_begin(r);
    a = fg_texture(r->g, "a", &(fg_tex_desc){ .format = FG_DEPTH16 });
    b = fg_texture(r->g, "b", &(fg_tex_desc){ .format = FG_DEPTH16 });
    PASSES(r, PASS(r, "draw", SHOW, .writes = { { a }, { b } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'draw' attaches 'b' as a second depth attachment");
    rig_close(r);
}

static void attachment_is_one_mip_and_one_layer_or_all(void **state) // C34
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .mips = 2 });
    PASSES(r, PASS(r, "draw", SHOW, .writes = { { a } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'draw' attaches 2 mips of 'a'");
    rig_begin(r);
    const fg_res b = fg_texture(r->g, "b", &(fg_tex_desc){ .cube = true });
    PASSES(r, PASS(r, "draw", SHOW, .writes = { { b, .layer = 2, .layers = 2 } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'draw' attaches 2 of 6 layers of 'b'");
    rig_close(r);
}

static void more_attachments_than_the_device_has_are_refused(void **state)
{
    (void) state;
    const fg_null_desc null = { .limits = { .max_color_attachments = 2 } };
    rig *r = rig_open_with((fg_graph_desc){ 0 }, &null);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = rig_tex(r, "c");
    PASSES(r, PASS(r, "draw", SHOW, .writes = { { a }, { b }, { c } }));
    rig_must_fail(r, FG_ERR_UNSUPPORTED, "pass 'draw' has 3 colour attachments, the device has 2");
    rig_close(r);
}

typedef struct bad_use {
    fg_kind kind;
    fg_format format; // of "x"
    bool buffer, write;
    fg_use use;
    const char *text;
} bad_use;

static void uses_that_kind_or_format_do_not_allow_are_refused(void **state) // C37
{
    (void) state;
    static const bad_use cases[] = {
        { FG_KIND_COMPUTE, FG_RGBA16F, false, true, FG_USE_COLOR,
          "compute pass 'p' writes texture 'x' as color" },
        { FG_KIND_COMPUTE, FG_DEPTH32F, false, false, FG_USE_DEPTH,
          "compute pass 'p' reads texture 'x' as depth" },
        { FG_KIND_RASTER, FG_RGBA16F, false, false, FG_USE_COLOR,
          "raster pass 'p' reads texture 'x' as color" },
        { FG_KIND_RASTER, FG_RGBA16F, false, true, FG_USE_SAMPLED,
          "writes texture 'x' as sampled" },
        { FG_KIND_RASTER, FG_RGBA16F, false, false, FG_USE_STORAGE,
          "reads texture 'x' as storage" },
        { FG_KIND_RASTER, FG_RGBA16F, true, true, FG_USE_UNIFORM, "writes buffer 'x' as uniform" },
        { FG_KIND_RASTER, FG_RGBA16F, true, true, FG_USE_VERTEX, "writes buffer 'x' as vertex" },
        { FG_KIND_RASTER, FG_RGBA16F, true, true, FG_USE_INDEX, "writes buffer 'x' as index" },
        { FG_KIND_RASTER, FG_RGBA16F, true, true, FG_USE_INDIRECT,
          "writes buffer 'x' as indirect" },
        { FG_KIND_RASTER, FG_RGBA16F, true, false, FG_USE_SAMPLED, "reads buffer 'x' as sampled" },
        { FG_KIND_RASTER, FG_RGBA16F, true, true, FG_USE_COLOR, "writes buffer 'x' as color" },
        { FG_KIND_RASTER, FG_RGBA16F, true, false, FG_USE_IMAGE, "reads buffer 'x' as image" },
        { FG_KIND_COMPUTE, FG_DEPTH32F, false, true, FG_USE_DEFAULT,
          "pass 'p' uses 'x' as image, which format DEPTH32F does not allow" },
        { FG_KIND_COMPUTE, FG_SRGB8_ALPHA8, false, true, FG_USE_DEFAULT,
          "format SRGB8_ALPHA8 does not allow" },
        { FG_KIND_RASTER, FG_DEPTH16, false, true, FG_USE_COLOR,
          "pass 'p' uses 'x' as color, which format DEPTH16" },
        { FG_KIND_RASTER, FG_R8, false, true, FG_USE_DEPTH,
          "pass 'p' uses 'x' as depth, which format R8" },
    };
    rig *r = rig_open(0);
    for (int i = 0; i < FG_COUNT(cases); i++) {
        const bad_use *c = &cases[i];
        rig_begin(r);
        const fg_res x =
            c->buffer ? fg_import_buffer(r->g, "x", &(fg_buf_desc){ 64 }, 5)
                      : fg_import_texture(r->g, "x", &(fg_tex_desc){ .format = c->format }, 5);
        fg_pass_desc p = PASS(r, "p", SHOW, .kind = c->kind);
        p.reads[0] = c->write ? (fg_io){ 0 } : (fg_io){ x, c->use };
        p.writes[0] = c->write ? (fg_io){ fg_next(x), c->use } : (fg_io){ 0 };
        fg_passes(r->g, &p, 1);
        rig_must_fail(r, FG_ERR_INVALID, c->text);
    }
    rig_close(r);
}

static void overlap_inside_a_pass_is_refused(void **state) // C41
{
    (void) state;
    static const struct {
        fg_io read, write, more;
        const char *text; // NULL: allowed
    } cases[] = {
        { { .use = FG_USE_SAMPLED },
          { .use = FG_USE_COLOR },
          { 0 },
          "pass 'p' reads 'a' as sampled and writes it as color at once" },
        { { .use = FG_USE_SAMPLED },
          { .use = FG_USE_IMAGE },
          { 0 },
          "reads 'a' as sampled and writes it as image at once" },
        { { .use = FG_USE_SAMPLED, .mip = 1 },
          { .use = FG_USE_IMAGE, .mips = 2 },
          { 0 },
          "at once: mips 0..1" },
        { { .use = FG_USE_SAMPLED, .mip = 1 },
          { .use = FG_USE_COLOR, .mips = 1, .layers = 1 },
          { 0 },
          NULL },
        { { .use = FG_USE_SAMPLED, .layer = 1 },
          { .use = FG_USE_IMAGE, .layers = 1 },
          { 0 },
          NULL },
        { { .use = FG_USE_IMAGE }, { .use = FG_USE_IMAGE }, { 0 }, NULL },
        { { .use = FG_USE_COPY },
          { .use = FG_USE_COPY },
          { 0 },
          "reads 'a' as copy and writes it as copy" },
        { { .use = FG_USE_SAMPLED, .mip = 2 },
          { .use = FG_USE_IMAGE, .mips = 1 },
          { .use = FG_USE_IMAGE, .mip = 1, .mips = 1 },
          NULL },
        { { .use = FG_USE_SAMPLED, .mip = 2 },
          { .use = FG_USE_IMAGE, .mips = 1 },
          { .use = FG_USE_IMAGE, .mips = 2 },
          "pass 'p' writes 'a' as image and writes it as image at once" },
    };
    rig *r = rig_open(0);
    for (int i = 0; i < FG_COUNT(cases); i++) {
        rig_begin(r);
        const fg_tex_desc desc = { .mips = 3, .layers = 2 };
        const fg_res a = fg_import_texture(r->g, "a", &desc, 3);
        fg_pass_desc p = PASS(r, "p");
        p.reads[0] = cases[i].read;
        p.writes[0] = cases[i].write;
        p.writes[1] = cases[i].more;
        p.reads[0].res = a;
        p.writes[0].res = fg_next(a);
        p.writes[1].res = cases[i].more.use ? fg_next(a) : (fg_res){ 0 };
        fg_passes(r->g, &p, 1);
        if (cases[i].text)
            rig_must_fail(r, FG_ERR_INVALID, cases[i].text);
        else
            rig_must_compile(r);
    }
    rig_close(r);
}

static void depth_may_be_tested_and_sampled_at_once(void **state) // C41
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res z = fg_texture(r->g, "z", &(fg_tex_desc){ .format = FG_DEPTH32F }),
                 a = rig_tex(r, "a");
    PASSES(r, PASS(r, "depth", .writes = { { z, .load = FG_LOAD_CLEAR } }),
           PASS(r, "shade", SHOW, .reads = { { z }, { z, FG_USE_DEPTH } }, .writes = { { a } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_non_null(strstr(fg_null_log(r->dev), "pass shade 64x64 color 2 depth-test 1\n"));
    rig_close(r);
}

static void subresource_out_of_range_is_refused(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .mips = 3, .layers = 4 });
    PASSES(r, PASS(r, "p", .writes = { { a, .mip = 2, .mips = 2 } }));
    rig_must_fail(
        r, FG_ERR_INVALID,
        "pass 'p': mips 2..3, layers 0..3 of 'a' are out of range, it has 3 mips, 4 layers");
    rig_begin(r);
    const fg_res b = fg_texture(r->g, "b", &(fg_tex_desc){ .cube = true });
    PASSES(r, PASS(r, "p", .writes = { { b, .layer = 6 } }));
    rig_must_fail(r, FG_ERR_INVALID, "'b' are out of range, it has 1 mips, 6 layers");
    rig_begin(r);
    PASSES(r, PASS(r, "p", .writes = { { rig_buf(r, "c"), .mips = 1 } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'p': buffer 'c' has no mips or layers to choose");
    rig_close(r);
}

static void import_as_it_arrived_cannot_be_written(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_import_texture(r->g, "a", &(fg_tex_desc){ 0 }, 4);
    PASSES(r, PASS(r, "p", .writes = { { a } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'p' writes 'a' as it was imported: write fg_next()");
    rig_close(r);
}

static void last_frame_cannot_be_written_and_needs_a_policy(void **state) // C76
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .history = FG_HISTORY_CLEAR });
    PASSES(r, PASS(r, "p", .writes = { { fg_last_frame(r->g, a) } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'p' writes last frame's 'a'");
    rig_begin(r);
    assert_int_equal(fg_last_frame(r->g, rig_tex(r, "b")).id, 0);
    rig_must_fail(r, FG_ERR_INVALID, "'b' is declared without a history policy");
    rig_begin(r);
    a = fg_texture(r->g, "a", &(fg_tex_desc){ .history = FG_HISTORY_CLEAR });
    PASSES(r, PASS(r, "p", SHOW, .reads = { { fg_last_frame(r->g, a) } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'p' reads last frame's 'a', which no pass ever writes");
    rig_begin(r);
    a = fg_texture(r->g, "a", &(fg_tex_desc){ .history = FG_HISTORY_CLEAR });
    fg_export(r->g, fg_last_frame(r->g, a));
    rig_must_fail(r, FG_ERR_INVALID, "last frame's 'a' cannot be exported");
    rig_close(r);
}

static void every_mistake_is_reported_at_once(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    PASSES(r, { .name = "one" }, PASS(r, "two", SHOW, .reads = { { a } }));
    fg_buffer(r->g, "b", &(fg_buf_desc){ 0 });
    rig_must_fail(r, FG_ERR_INVALID, "pass 'one': needs a run callback");
    rig_must_have_said(r, "buffer 'b': size is 0 bytes");
    rig_begin(r);
    const fg_res c = rig_tex(r, "c");
    PASSES(r, PASS(r, "two", SHOW, .reads = { { c } }), PASS(r, "two", SHOW, .reads = { { c } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'two': the name is taken");
    rig_must_have_said(r, "pass 'two' reads version 1 of 'c', which no pass writes");
    rig_close(r);
}

// ---- while it runs ------------------------------------------------------------------------

typedef struct ask {
    rig *r;
    fg_res res;
    uint32_t object;
    int size[3];
    int what; // 0: object, 1: size, 2: history
} ask;

static fg_status ask_for(const fg_run *run, void *user)
{
    ask *a = user;
    if (a->what == 0)
        a->object = fg_run_object(run, a->res);
    else if (a->what == 1)
        fg_run_size(run, a->res, 0, a->size);
    else
        a->object = fg_run_history_valid(run, a->res);
    return FG_OK;
}

static void undeclared_access_fails_the_frame(void **state) // C35, C36
{
    (void) state;
    for (int what = 0; what < 3; what++) {
        rig *r = rig_open(0);
        rig_begin(r);
        const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
        ask q = { .r = r, .res = b, .what = what, .object = 9 };
        PASSES(r, PASS(r, "one", .writes = { { a } }), PASS(r, "two", .writes = { { b } }),
               PASS(r, "mid", SHOW, .reads = { { b } }),
               { .name = "show", SHOW, .reads = { { a } }, .run = ask_for, .user = &q });
        rig_must_compile(r);
        assert_int_equal(fg_graph_run(r->g), FG_ERR_INVALID);
        assert_int_equal(q.object, what == 1 ? 9 : 0);
        rig_must_have_said(r, "pass 'show' asks for version 1 of 'b', which it did not declare");
        q.res = a;
        rig_must_run(r); // the next frame starts afresh
        rig_close(r);
    }
}

static void wrong_version_and_null_are_refused_while_running(void **state) // C35
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    ask q = { .r = r, .res = fg_next(a) };
    PASSES(r, PASS(r, "one", .writes = { { a } }),
           { .name = "show", SHOW, .reads = { { a } }, .run = ask_for, .user = &q });
    rig_must_compile(r);
    assert_int_equal(fg_graph_run(r->g), FG_ERR_INVALID);
    rig_must_have_said(r, "pass 'show' asks for version 2 of 'a', which it did not declare");
    q.res = (fg_res){ 0 };
    assert_int_equal(fg_graph_run(r->g), FG_ERR_INVALID);
    rig_must_have_said(r, "pass 'show' asks for the null handle");
    q.res = (fg_res){ .id = 99, .version = 1, .epoch = a.epoch };
    assert_int_equal(fg_graph_run(r->g), FG_ERR_INVALID);
    rig_must_have_said(r, "asks for version 1 of 'no resource'");
    rig_close(r);
}

static void stale_handle_is_refused_while_running(void **state) // C11
{
    (void) state;
    rig *r = rig_open(0);
    ask q = { .r = r };
    for (int i = 0; i < 2; i++) {
        rig_begin(r);
        const fg_res a = i ? fg_texture(r->g, "a", &(fg_tex_desc){ .mips = 2 }) : rig_tex(r, "a");
        q.res = i ? q.res : a;
        PASSES(r, PASS(r, "one", .writes = { { a, .mips = 1 } }),
               { .name = "show", SHOW, .reads = { { a } }, .run = ask_for, .user = &q });
        rig_must_compile(r);
        assert_int_equal(fg_graph_run(r->g), i ? FG_ERR_INVALID : FG_OK);
    }
    rig_must_have_said(r, "pass 'show' asks for resource 1 by a stale handle");
    rig_close(r);
}

static void graph_needs_a_device(void **state)
{
    (void) state;
    assert_null(fg_graph_create(NULL));
    assert_null(fg_graph_create(&(fg_graph_desc){ 0 }));
    fg_graph_destroy(NULL);
    fg_device_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reading_what_nobody_wrote_is_refused),
        cmocka_unit_test(reading_a_mip_that_nobody_wrote_is_refused),
        cmocka_unit_test(cycle_is_named_pass_by_pass),
        cmocka_unit_test(cycle_through_an_overwrite_is_found),
        cmocka_unit_test(attachments_must_agree),
        cmocka_unit_test(attachment_is_one_mip_and_one_layer_or_all),
        cmocka_unit_test(more_attachments_than_the_device_has_are_refused),
        cmocka_unit_test(uses_that_kind_or_format_do_not_allow_are_refused),
        cmocka_unit_test(overlap_inside_a_pass_is_refused),
        cmocka_unit_test(depth_may_be_tested_and_sampled_at_once),
        cmocka_unit_test(subresource_out_of_range_is_refused),
        cmocka_unit_test(import_as_it_arrived_cannot_be_written),
        cmocka_unit_test(last_frame_cannot_be_written_and_needs_a_policy),
        cmocka_unit_test(every_mistake_is_reported_at_once),
        cmocka_unit_test(undeclared_access_fails_the_frame),
        cmocka_unit_test(wrong_version_and_null_are_refused_while_running),
        cmocka_unit_test(stale_handle_is_refused_while_running),
        cmocka_unit_test(graph_needs_a_device),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
