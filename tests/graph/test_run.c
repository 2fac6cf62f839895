// SPDX-License-Identifier: MIT
// Running, the compile cache, switching passes off, and what a graph shows of itself.
#include "rig.h"

#include <stdio.h>

// ---- the cache ----------------------------------------------------------------------------

typedef struct counter {
    long calls;
} counter;

static void *count_calls(void *user, void *ptr, size_t size)
{
    ((counter *) user)->calls++;
    if (size)
        return realloc(ptr, size);
    free(ptr);
    return NULL;
}

// A frame with a bit of everything.
static fg_res declare_frame(rig *r)
{
    const fg_res a = rig_tex(r, "a"), b = rig_buf(r, "b");
    const fg_res h = fg_texture(r->g, "h", &(fg_tex_desc){ .history = FG_HISTORY_CLEAR });
    const fg_res s = fg_import_texture(r->g, "screen", &(fg_tex_desc){ 0 }, 900);
    PASSES(r, PASS(r, "draw", .writes = { { a, .load = FG_LOAD_CLEAR, .clear = { 1 } } }),
           PASS(r, "fill", .kind = FG_KIND_COMPUTE, .reads = { { a } }, .writes = { { b } }),
           PASS(r, "blend", .reads = { { fg_last_frame(r->g, h) }, { b } }, .writes = { { h } }),
           PASS(r, "gone", .writes = { { fg_next(a) } }),
           PASS(r, "show", .reads = { { h } }, .writes = { { fg_next(s) } }));
    return a;
}

static void unchanged_declaration_compiles_and_allocates_nothing(void **state) // C100
{
    (void) state;
    counter c = { 0 };
    rig *r =
        rig_open_with((fg_graph_desc){ .allocator = { count_calls, &c } }, &(fg_null_desc){ 0 });
    long before = 0;
    for (int i = 0; i < 50; i++) {
        rig_begin(r);
        declare_frame(r);
        rig_must_compile(r);
        rig_must_run(r);
        if (i == 1)
            before = c.calls;
        if (i > 1)
            assert_int_equal(c.calls, before);
    }
    assert_int_equal(fg_graph_get_stats(r->g).compiles, 1);
    rig_close(r);
}

static void running_again_allocates_nothing(void **state) // C100
{
    (void) state;
    counter c = { 0 };
    rig *r =
        rig_open_with((fg_graph_desc){ .allocator = { count_calls, &c } }, &(fg_null_desc){ 0 });
    rig_begin(r);
    declare_frame(r);
    rig_must_compile(r);
    rig_must_run(r);
    const long before = c.calls;
    for (int i = 0; i < 10; i++)
        rig_must_run(r);
    assert_int_equal(c.calls, before);
    rig_close(r);
}

// Declares one graph; field `change` of it is not as in change 0.
static void declare_variant(rig *r, int change)
{
    fg_tex_desc tex = { .width = 32, .height = 32, .mips = 2 };
    fg_pass_desc p = PASS(r, "p", .kind = FG_KIND_COMPUTE);
    static const char *const names[] = { "one" };
    const fg_frame_desc frame = { 64, 64, change == 1 ? 1 : 0, names, 1 };
    rig_forget(r);
    fg_graph_begin(r->g, &frame);
    tex.format = change == 2 ? FG_RG32F : FG_RGBA16F;
    tex.width += change == 3;
    tex.height += change == 4;
    tex.depth = change == 5 ? 2 : 0;
    tex.layers = change == 6 ? 6 : 0;
    tex.mips = change == 7 ? 3 : 2;
    tex.history = change == 8 ? FG_HISTORY_CLEAR : FG_HISTORY_NONE;
    const fg_res a = fg_texture(r->g, change == 9 ? "z" : "a", &tex);
    const fg_res b = fg_buffer(r->g, "b", &(fg_buf_desc){ .size = change == 10 ? 8u : 4u });
    const fg_tex_desc in = { .format = change == 11 ? FG_R8 : FG_RGBA8 };
    const fg_res c = fg_import_texture(r->g, "c", &in, 70);
    p.name = change == 12 ? "q" : "p";
    p.effect = change == 13 ? FG_EFFECT_EXTERNAL : FG_EFFECT_NONE;
    p.needs = change == 14 ? 1u << 5 : 0;
    p.reads[0] = (fg_io){ .res = c, .use = change == 15 ? FG_USE_IMAGE : FG_USE_SAMPLED };
    p.reads[0].optional = change == 16;
    p.writes[0] = (fg_io){ .res = a, .load = change == 17 ? FG_LOAD_DISCARD : FG_LOAD_KEEP };
    p.writes[0].mip = change == 18;
    p.writes[0].mips = 1;
    p.writes[0].layers = change == 6 ? 2 : 0;
    p.writes[1] = (fg_io){ .res = b };
    const fg_res sees = change == 19 ? b : a;
    fg_passes(r->g, &p, 1);
    PASSES(r, PASS(r, "need", .needs = 1), PASS(r, "show", SHOW, .reads = { { .res = sees } }));
    if (change == 20)
        fg_export(r->g, a);
}

static void every_field_makes_a_new_plan(void **state) // C101
{
    (void) state;
    for (int change = 1; change <= 20; change++) {
        rig *r = rig_open(0);
        declare_variant(r, 0);
        rig_must_compile(r);
        declare_variant(r, 0);
        rig_must_compile(r);
        assert_int_equal(fg_graph_get_stats(r->g).compiles, 1);
        declare_variant(r, change);
        const fg_status status = fg_graph_compile(r->g);
        // A pass that is left out starves its reader.
        assert_int_equal(status, change == 14 ? FG_ERR_INVALID : FG_OK);
        assert_int_equal(fg_graph_get_stats(r->g).compiles, change == 14 ? 1 : 2);
        rig_close(r);
    }
}

typedef struct import_seen {
    fg_res res;
    uint32_t object;
} import_seen;

static fg_status see_import(const fg_run *run, void *user)
{
    import_seen *s = user;
    s->object = fg_run_object(run, s->res);
    return FG_OK;
}

static void another_imported_object_is_bound_without_a_compile(void **state) // C101
{
    (void) state;
    rig *r = rig_open(0);
    for (uint32_t i = 0; i < 4; i++) {
        import_seen s;
        rig_begin(r);
        s.res = fg_import_texture(r->g, "screen", &(fg_tex_desc){ 0 }, 500 + i % 3);
        s.res = fg_next(s.res);
        PASSES(r, { .name = "show", .writes = { { s.res } }, .run = see_import, .user = &s });
        rig_must_compile(r);
        rig_must_run(r);
        assert_int_equal(s.object, 500 + i % 3);
        char line[64];
        snprintf(line, sizeof line, "pass show 64x64 color %u\n", 500 + i % 3);
        assert_non_null(strstr(fg_null_log(r->dev), line));
    }
    assert_int_equal(fg_graph_get_stats(r->g).compiles, 1);
    rig_close(r);
}

static fg_status add_one(const fg_run *run, void *user)
{
    (void) run;
    ++*(int *) user;
    return FG_OK;
}

static void callbacks_and_users_are_those_of_the_last_declaration(void **state) // C102
{
    (void) state;
    rig *r = rig_open(0);
    int counts[3] = { 0 };
    for (int i = 0; i < 3; i++) {
        rig_begin(r);
        PASSES(r, { .name = "show", SHOW, .run = add_one, .user = &counts[i] });
        rig_must_compile(r);
        rig_must_run(r);
    }
    for (int i = 0; i < 3; i++)
        assert_int_equal(counts[i], 1);
    assert_int_equal(fg_graph_get_stats(r->g).compiles, 1);
    rig_close(r);
}

static void handles_of_earlier_equal_declarations_still_serve(void **state)
{
    (void) state;
    rig *r = rig_open_with((fg_graph_desc){ 0 }, &(fg_null_desc){ 0 });
    import_seen s = { 0 };
    // More declarations than a handle's epoch can tell apart.
    for (int i = 0; i < 70000; i++) {
        rig_begin(r);
        const fg_res a = fg_import_texture(r->g, "screen", &(fg_tex_desc){ 0 }, 500);
        s.res = i ? s.res : a;
        PASSES(r, { .name = "show", SHOW, .reads = { { a } }, .run = see_import, .user = &s });
        rig_must_compile(r);
    }
    rig_must_run(r);
    assert_int_equal(s.object, 500);
    rig_close(r);
}

static void failed_compile_leaves_the_plan_before(void **state) // C104
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    declare_frame(r);
    rig_must_compile(r);
    rig_must_run(r);
    char *before = rig_dump(r, FG_DUMP_TEXT);
    rig_begin(r);
    const fg_res x = rig_tex(r, "x");
    PASSES(r, PASS(r, "bad", SHOW, .reads = { { x } }));
    rig_must_fail(r, FG_ERR_INVALID, "pass 'bad' reads version 1 of 'x'");
    assert_int_equal(fg_graph_compile(r->g), FG_ERR_INVALID); // and again
    char *after = rig_dump(r, FG_DUMP_TEXT);
    assert_string_equal(before, after);
    rig_must_run(r);
    assert_string_equal(r->trace, "draw fill blend show ");
    rig_begin(r);
    declare_frame(r);
    rig_must_compile(r);
    assert_int_equal(fg_graph_get_stats(r->g).compiles, 1);
    fg_dump_free(r->g, before);
    fg_dump_free(r->g, after);
    rig_close(r);
}

// ---- passes on and off --------------------------------------------------------------------

static void disabled_pass_leaves_defined_contents(void **state) // C103
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = rig_tex(r, "c");
    PASSES(r,
           PASS(r, "make",
                .writes = { { a, .load = FG_LOAD_DISCARD },
                            { b, .load = FG_LOAD_CLEAR, .clear = { 3 } },
                            { c } }),
           PASS(r, "change", .writes = { { fg_next(a), .load = FG_LOAD_KEEP } }),
           PASS(r, "show", SHOW, .reads = { { fg_next(a) }, { b }, { c } }));
    rig_must_compile(r);
    assert_int_equal(fg_pass_enable(r->g, "make", false), FG_OK);
    rig_must_run(r);
    assert_string_equal(r->trace, "change show ");
    const char *log = fg_null_log(r->dev);
    assert_non_null(strstr(log, "clear 1 mips 0+1 layers 0+1 to 0 0 0 0\n"));
    assert_non_null(strstr(log, "clear 2 mips 0+1 layers 0+1 to 3 0 0 0\n"));
    assert_non_null(strstr(log, "clear 3 mips 0+1 layers 0+1 to 0 0 0 0\n"));
    assert_int_equal(fg_pass_enable(r->g, "make", true), FG_OK);
    assert_int_equal(fg_pass_enable(r->g, "change", false), FG_OK);
    rig_must_run(r);
    assert_string_equal(r->trace, "make show ");
    assert_int_equal(rig_count(fg_null_log(r->dev), "clear"), 2); // b and c, as ever
    assert_int_equal(fg_graph_get_stats(r->g).compiles, 1);
    rig_close(r);
}

static void disabled_pass_stays_off_over_a_recompile(void **state) // C103
{
    (void) state;
    rig *r = rig_open(0);
    for (int i = 0; i < 3; i++) {
        rig_begin(r);
        PASSES(r, PASS(r, "one", SHOW), PASS(r, i == 1 ? "other" : "two", SHOW));
        rig_must_compile(r);
        if (i == 0)
            assert_int_equal(fg_pass_enable(r->g, "one", false), FG_OK);
        rig_must_run(r);
        assert_string_equal(r->trace, i == 1 ? "other " : "two ");
    }
    assert_int_equal(fg_pass_enable(r->g, "three", false), FG_ERR_INVALID);
    rig_must_have_said(r, "there is no pass 'three'");
    assert_int_equal(fg_pass_enable(r->g, NULL, false), FG_ERR_INVALID);
    rig_close(r);
}

static void barriers_hold_while_a_pass_is_off(void **state) // C95, C103
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    PASSES(r,
           PASS(r, "fill", .kind = FG_KIND_COMPUTE, .writes = { { a, .load = FG_LOAD_DISCARD } }),
           PASS(r, "one", SHOW, .reads = { { a } }), PASS(r, "two", SHOW, .reads = { { a } }));
    rig_must_compile(r);
    assert_int_equal(fg_pass_enable(r->g, "one", false), FG_OK);
    rig_must_run(r);
    // The barrier that "two" relies on was planned before "one".
    const char *fill = strstr(fg_null_log(r->dev), "pass fill");
    assert_non_null(strstr(fill, "sampled"));
    assert_true(strstr(fill, "sampled") < strstr(fill, "pass two"));
    rig_close(r);
}

// ---- failing ------------------------------------------------------------------------------

static fg_status fail_once(const fg_run *run, void *user)
{
    (void) run;
    return ++*(int *) user == 1 ? FG_ERR_SHADER : FG_OK;
}

static void failing_callback_ends_the_frame_and_the_next_is_fine(void **state) // C121
{
    (void) state;
    rig *r = rig_open(0);
    int calls = 0;
    rig_begin(r);
    PASSES(r, PASS(r, "one", SHOW), { .name = "bad", SHOW, .run = fail_once, .user = &calls },
           PASS(r, "two", SHOW));
    rig_must_compile(r);
    assert_int_equal(fg_graph_run(r->g), FG_ERR_SHADER);
    assert_string_equal(r->trace, "one ");
    rig_must_have_said(r, "pass 'bad' failed: shader does not build");
    assert_non_null(strstr(fg_null_log(r->dev), "end frame"));
    rig_must_run(r);
    assert_string_equal(r->trace, "one two ");
    rig_close(r);
}

// ---- what passes and hosts can ask --------------------------------------------------------

typedef struct sizes {
    fg_res res[4];
    int size[5][3];
    uint64_t frame;
    bool device;
} sizes;

static fg_status ask_sizes(const fg_run *run, void *user)
{
    sizes *s = user;
    for (int i = 0; i < 4; i++)
        fg_run_size(run, s->res[i], i == 0 ? 2 : 0, s->size[i]);
    fg_run_size(run, s->res[0], 99, s->size[4]);
    s->frame = fg_run_frame(run);
    s->device = fg_run_device(run) != NULL;
    return FG_OK;
}

static void sizes_are_those_of_the_mip(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    sizes s;
    rig_begin(r);
    s.res[0] = fg_texture(r->g, "a", &(fg_tex_desc){ .width = 37, .height = 5, .mips = 4 });
    s.res[1] = fg_texture(r->g, "b", &(fg_tex_desc){ .layers = 5 });
    s.res[2] = fg_texture(r->g, "c", &(fg_tex_desc){ .width = 4, .height = 4, .depth = 7 });
    s.res[3] = rig_buf(r, "d");
    PASSES(r, { .name = "ask",
                SHOW,
                .kind = FG_KIND_COMPUTE,
                .writes = { { s.res[0] }, { s.res[1] }, { s.res[2] }, { s.res[3] } },
                .run = ask_sizes,
                .user = &s });
    rig_must_compile(r);
    rig_must_run(r);
    rig_must_run(r);
    static const int expected[5][3] = {
        { 9, 1, 1 }, { 64, 64, 5 }, { 4, 4, 7 }, { 256, 0, 0 }, { 0, 0, 1 }
    };
    assert_memory_equal(s.size, expected, sizeof expected);
    assert_int_equal(s.frame, 1);
    assert_true(s.device);
    rig_close(r);
}

typedef struct inspected {
    int calls, layer, mips;
    bool texture, buffer;
    uint32_t object;
} inspected;

static void inspect(void *user, const fg_written *w)
{
    inspected *i = user;
    i->calls++;
    i->texture |= w->tex && w->tex->width == 64 && !strcmp(w->resource, "a");
    i->buffer |= w->buf && w->buf->size == 256 && !strcmp(w->pass, "make");
    i->layer = w->tex ? w->layer : i->layer;
    i->mips = w->mips;
    i->object |= w->object;
}

static void inspection_sees_each_thing_written(void **state)
{
    (void) state;
    inspected seen = { 0 };
    rig *r = rig_open_with((fg_graph_desc){ .inspect = inspect, .inspect_user = &seen },
                           &(fg_null_desc){ 0 });
    rig_begin(r);
    const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .layers = 3 }), b = rig_buf(r, "b");
    PASSES(r,
           PASS(r, "make", .kind = FG_KIND_COMPUTE,
                .writes = { { a, .layer = 2, .layers = 1 }, { b } }),
           PASS(r, "show", SHOW, .reads = { { a, .layer = 2 }, { b } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_int_equal(seen.calls, 2);
    assert_true(seen.texture && seen.buffer);
    assert_int_equal(seen.layer, 2);
    assert_int_equal(seen.object, 1 | 2);
    rig_close(r);
}

static void every_pass_has_its_timing(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    declare_frame(r);
    rig_must_compile(r);
    rig_must_run(r);
    static const char *const order[] = { "draw", "fill", "blend", "show" };
    double before = 0;
    fg_timing t;
    for (int i = 0; i < 4; i++) {
        assert_true(fg_graph_timing(r->g, i, &t));
        assert_string_equal(t.pass, order[i]);
        assert_string_equal(fg_graph_pass(r->g, i), order[i]);
        assert_true(t.gpu_ms < 0); // the null device times nothing
        assert_true(t.cpu_ms >= 0 && t.cpu_start_ms >= before - 1e-9); // whole ns, rounded
        before = t.cpu_start_ms + t.cpu_ms;
    }
    assert_true(before > 0); // four passes that write their lines take some time
    assert_false(fg_graph_timing(r->g, 4, &t));
    assert_false(fg_graph_timing(r->g, -1, &t));
    assert_null(fg_graph_pass(r->g, 4));
    assert_non_null(strstr(fg_null_log(r->dev), "frame 0 timers 4\n"));
    rig_close(r);
}

static void device_that_times_nothing_shows_no_times(void **state)
{
    (void) state;
    rig *r = rig_open_with((fg_graph_desc){ 0 }, &(fg_null_desc){ .record = false });
    rig_begin(r);
    declare_frame(r);
    rig_must_compile(r);
    rig_must_run(r);
    fg_timing t;
    for (int i = 0; i < 4; i++) {
        assert_true(fg_graph_timing(r->g, i, &t));
        assert_string_equal(t.pass, fg_graph_pass(r->g, i));
        assert_true(t.gpu_ms < 0);
        assert_true(t.cpu_ms <= 0 && t.cpu_start_ms <= 0);
    }
    assert_false(fg_graph_timing(r->g, 4, &t));
    char *trace = rig_dump(r, FG_DUMP_TRACE);
    assert_null(strstr(trace, "\"draw\""));
    fg_dump_free(r->g, trace);
    rig_close(r);
}

// ---- dumps --------------------------------------------------------------------------------

// Brackets close in order, strings end, and nothing below a blank is in them.
static bool json_is_sound(const char *s)
{
    char stack[64];
    int depth = 0;
    for (bool text = false; *s; s++) {
        if (text && *s == '\\') {
            s++;
            if (!*s || !strchr("\"\\/bfnrtu", *s))
                return false;
        } else if (*s == '"') {
            text = !text;
        } else if (!text && (*s == '{' || *s == '[')) {
            stack[depth++] = *s == '{' ? '}' : ']';
        } else if (text ? (unsigned char) *s < 0x20
                        : (*s == '}' || *s == ']') && (!depth || stack[--depth] != *s)) {
            return false;
        }
    }
    return depth == 0;
}

static void dumps_escape_names(void **state) // C123
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a\"b\\c\n\t\x01");
    PASSES(r, PASS(r, "make \"it\"", .writes = { { a } }),
           PASS(r, "show\\", SHOW, .reads = { { a } }),
           PASS(r, "lost \"", .writes = { { fg_next(a) } }));
    rig_must_compile(r);
    rig_must_run(r);
    static const fg_dump formats[] = { FG_DUMP_JSON, FG_DUMP_TRACE, FG_DUMP_DOT };
    for (int i = 0; i < FG_COUNT(formats); i++) {
        char *text = rig_dump(r, formats[i]);
        assert_non_null(strstr(text, "\"make \\\"it\\\"\""));
        assert_non_null(strstr(text, "\"show\\\\\""));
        if (i != 1)
            assert_non_null(strstr(text, "\"a\\\"b\\\\c\\u000a\\u0009\\u0001\""));
        if (i != 2)
            assert_true(json_is_sound(text));
        fg_dump_free(r->g, text);
    }
    rig_close(r);
}

static void dumps_tell_what_was_left_out_and_why(void **state) // C28
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    declare_frame(r);
    assert_null(fg_graph_dump(r->g, FG_DUMP_TEXT)); // not compiled
    rig_must_have_said(r, "nothing has compiled");
    rig_must_compile(r);
    assert_null(fg_graph_dump(r->g, (fg_dump) 9));
    char *text = rig_dump(r, FG_DUMP_TEXT), *json = rig_dump(r, FG_DUMP_JSON);
    char *dot = rig_dump(r, FG_DUMP_DOT);
    assert_non_null(strstr(text, "passes: 5 declared, 4 run, 1 left out\n   0  draw (raster)\n"));
    assert_non_null(strstr(text, "left out:\n      gone: nobody reads 'a'\n"));
    assert_non_null(strstr(text, "writes a.1 as color, clear\n"));
    assert_non_null(strstr(text, "reads  h of last frame as sampled\n"));
    assert_non_null(strstr(text, "memory: transient 33024 bytes, without sharing 33024"));
    assert_non_null(strstr(json, "{\"pass\": \"gone\", \"why\": \"nobody reads 'a'\"}"));
    assert_non_null(strstr(json, "\"persistent_bytes\": 65536"));
    assert_non_null(strstr(dot, "p3 [shape=box, style=\"dashed\", label=\"gone\""));
    assert_non_null(strstr(dot, "style=dashed, constraint=false, label=\"last frame\""));
    fg_dump_free(r->g, text);
    fg_dump_free(r->g, json);
    fg_dump_free(r->g, dot);
    rig_close(r);
}

static void cached_plan_and_fresh_one_dump_alike(void **state) // C105
{
    (void) state;
    rig *a = rig_open(0), *b = rig_open(0);
    for (int i = 0; i < 3; i++) {
        rig_begin(a);
        declare_frame(a);
        rig_must_compile(a);
    }
    rig_begin(b);
    PASSES(b, PASS(b, "other", SHOW));
    rig_must_compile(b);
    rig_begin(b);
    declare_frame(b);
    rig_must_compile(b);
    static const fg_dump formats[] = { FG_DUMP_TEXT, FG_DUMP_DOT, FG_DUMP_JSON };
    for (int i = 0; i < FG_COUNT(formats); i++) {
        char *x = rig_dump(a, formats[i]), *y = rig_dump(b, formats[i]);
        assert_string_equal(x, y);
        fg_dump_free(a->g, x);
        fg_dump_free(b->g, y);
    }
    rig_close(a);
    rig_close(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unchanged_declaration_compiles_and_allocates_nothing),
        cmocka_unit_test(running_again_allocates_nothing),
        cmocka_unit_test(every_field_makes_a_new_plan),
        cmocka_unit_test(another_imported_object_is_bound_without_a_compile),
        cmocka_unit_test(callbacks_and_users_are_those_of_the_last_declaration),
        cmocka_unit_test(handles_of_earlier_equal_declarations_still_serve),
        cmocka_unit_test(failed_compile_leaves_the_plan_before),
        cmocka_unit_test(disabled_pass_leaves_defined_contents),
        cmocka_unit_test(disabled_pass_stays_off_over_a_recompile),
        cmocka_unit_test(barriers_hold_while_a_pass_is_off),
        cmocka_unit_test(failing_callback_ends_the_frame_and_the_next_is_fine),
        cmocka_unit_test(sizes_are_those_of_the_mip),
        cmocka_unit_test(inspection_sees_each_thing_written),
        cmocka_unit_test(every_pass_has_its_timing),
        cmocka_unit_test(device_that_times_nothing_shows_no_times),
        cmocka_unit_test(dumps_escape_names),
        cmocka_unit_test(dumps_tell_what_was_left_out_and_why),
        cmocka_unit_test(cached_plan_and_fresh_one_dump_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
