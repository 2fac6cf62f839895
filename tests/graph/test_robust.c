// SPDX-License-Identifier: MIT
// Running out of memory at every call, and graphs of 10 000 passes.
#include "rig.h"

#include <stdio.h>

typedef struct scarce {
    long calls, fail_at, live;
} scarce;

static void *allocate(void *user, void *ptr, size_t size)
{
    scarce *s = user;
    if (!size) {
        s->live -= ptr != NULL;
        free(ptr);
        return NULL;
    }
    if (++s->calls == s->fail_at)
        return NULL;
    s->live += ptr == NULL;
    return realloc(ptr, size);
}

// Enough of everything to make each array grow at least once. Out of order, so that
// sorting allocates too.
static void declare(rig *r, int count)
{
    const fg_res screen = fg_import_texture(r->g, "screen", &(fg_tex_desc){ 0 }, 900);
    const fg_res h =
        fg_texture(r->g, "h", &(fg_tex_desc){ .history = FG_HISTORY_CLEAR, .mips = 2 });
    fg_res before = h;
    PASSES(r, PASS(r, "show", .reads = { { h } }, .writes = { { fg_next(screen) } }));
    PASSES(r, PASS(r, "blend", .kind = FG_KIND_COMPUTE, .reads = { { fg_last_frame(r->g, h) } },
                   .writes = { { h } }));
    for (int i = 0; i < count; i++) {
        char pass[16], tex[16];
        snprintf(pass, sizeof pass, "p%d", i);
        snprintf(tex, sizeof tex, "t%d", i);
        const fg_tex_desc desc = { .format = i % 2 ? FG_RG32F : FG_RGBA16F };
        const fg_res made = fg_texture(r->g, tex, &desc);
        PASSES(r,
               PASS(r, pass, .reads = { { before } }, .writes = { { made, .load = FG_LOAD_CLEAR } },
                    .needs = i % 7 == 3, .effect = i % 4 ? FG_EFFECT_NONE : FG_EFFECT_EXTERNAL));
        before = i % 7 == 3 ? before : made;
    }
    fg_export(r->g, before);
    // Nobody reads it, but who wrote which of its layers is looked up.
    fg_res parts = fg_texture(r->g, "parts", &(fg_tex_desc){ .layers = 4 });
    for (int i = 0; i < count; i++, parts = fg_next(parts)) {
        char pass[16];
        snprintf(pass, sizeof pass, "q%d", i);
        PASSES(r, PASS(r, pass, .writes = { { parts, .layer = (uint16_t) (i % 4), .layers = 1 } }));
    }
}

// A whole life; each call may fail, with FG_ERR_MEMORY and nothing else.
static bool live_once(rig *r)
{
    rig_begin(r);
    declare(r, 20);
    fg_status status = fg_graph_compile(r->g);
    status = status == FG_OK ? fg_graph_run(r->g) : status;
    if (status == FG_OK)
        status = fg_pass_enable(r->g, "blend", false);
    char *text = status == FG_OK ? fg_graph_dump(r->g, FG_DUMP_TEXT) : NULL;
    fg_dump_free(r->g, text);
    if (status != FG_OK) {
        assert_int_equal(status, FG_ERR_MEMORY);
        rig_must_have_said(r, "memory");
    }
    return text != NULL;
}

static void failing_allocation_at_any_call_leaks_nothing_and_the_graph_stays(void **state) // C120
{
    (void) state;
    long n = 1;
    for (bool whole = false; !whole; n++) {
        scarce s = { .fail_at = n };
        fg_log log = { 0 };
        rig *r = calloc(1, sizeof *r);
        assert_non_null(r);
        r->dev = fg_null_create(&(fg_null_desc){ 0 });
        const fg_graph_desc desc = { .device = r->dev, .log = &log, .allocator = { allocate, &s } };
        fg_graph *g = fg_graph_create(&desc);
        if (!g) {
            assert_int_equal(n, 1);
            fg_device_destroy(r->dev);
            free(r);
            continue;
        }
        fg_graph_destroy(g);
        assert_int_equal(s.live, 0);
        fg_device_destroy(r->dev);
        free(r);

        s = (scarce){ .fail_at = n };
        r = rig_open_with((fg_graph_desc){ .allocator = { allocate, &s } }, &(fg_null_desc){ 0 });
        whole = live_once(r);
        // Afterwards there is memory: everything works.
        s.fail_at = 0;
        assert_true(live_once(r));
        rig_must_run(r);
        rig_close(r);
        assert_int_equal(s.live, 0);
    }
    assert_in_range(n, 30, 400); // there were calls that failed
}

static void failing_device_at_any_creation_leaks_nothing_and_the_graph_stays(void **state) // C120
{
    (void) state;
    int n = 1;
    for (bool whole = false; !whole; n++) {
        rig *r = rig_open_with((fg_graph_desc){ 0 }, &(fg_null_desc){ .fail_at = n });
        rig_begin(r);
        declare(r, 20);
        rig_must_compile(r);
        const fg_status status = fg_graph_run(r->g);
        whole = status == FG_OK;
        if (!whole) {
            assert_int_equal(status, FG_ERR_MEMORY);
            rig_must_have_said(r, ": out of memory");
        }
        rig_must_run(r); // the next one has it
        rig_must_run(r);
        rig_close(r);
    }
    assert_in_range(n, 5, 40);
}

static void failed_device_keeps_the_history(void **state) // C73, C120
{
    (void) state;
    rig *r = rig_open_with((fg_graph_desc){ 0 }, &(fg_null_desc){ .fail_at = 3 });
    rig_begin(r);
    const fg_tex_desc history = { .history = FG_HISTORY_CLEAR };
    fg_res h = fg_texture(r->g, "h", &history);
    PASSES(r, PASS(r, "blend", SHOW, .reads = { { fg_last_frame(r->g, h) } }, .writes = { { h } }));
    rig_must_compile(r);
    rig_must_run(r);
    rig_begin(r);
    h = fg_texture(r->g, "h", &history);
    PASSES(r, PASS(r, "blend", SHOW, .reads = { { fg_last_frame(r->g, h) } }, .writes = { { h } }),
           PASS(r, "more", SHOW, .writes = { { rig_tex(r, "x") } }));
    rig_must_compile(r);
    assert_int_equal(fg_graph_run(r->g), FG_ERR_MEMORY);
    rig_must_have_said(r, "graph: 32768 bytes for 'x': out of memory");
    rig_must_run(r);
    assert_null(strstr(r->said, "reset"));
    assert_int_equal(fg_null_live_objects(r->dev), 3);
    rig_close(r);
}

// ---- many passes --------------------------------------------------------------------------

static fg_status nothing(const fg_run *run, void *user)
{
    (void) run;
    (void) user;
    return FG_OK;
}

typedef enum shape {
    CHAIN = 0,    // each pass reads the one before
    BACKWARDS,    // the same, declared from the end
    ONE_RESOURCE, // each pass changes one buffer
    IN_PARTS,     // each pass changes one layer of a texture, each layer five times
    WIDE,         // one pass reads each of many; 20 at a time
    ONE_READ_BY_ALL,
    SHAPES,
} shape;

static void declare_many(fg_graph *g, int count, shape s)
{
    fg_graph_begin(g, &(fg_frame_desc){ .width = 64, .height = 64 });
    fg_res *made = calloc((size_t) count, sizeof *made);
    assert_non_null(made);
    for (int i = 0; i < count; i++) {
        char tex[16];
        snprintf(tex, sizeof tex, "t%d", i);
        if (i && (s == ONE_RESOURCE || s == IN_PARTS))
            made[i] = fg_next(made[i - 1]);
        else if (s == IN_PARTS)
            made[i] = fg_texture(g, tex, &(fg_tex_desc){ .layers = count / 5 });
        else
            made[i] = fg_buffer(g, tex, &(fg_buf_desc){ .size = 4 });
    }
    for (int k = 0; k < count; k++) {
        const int i = s == BACKWARDS ? count - 1 - k : k;
        char name[16];
        snprintf(name, sizeof name, "p%d", i);
        fg_pass_desc p = { .name = name, .run = nothing, .writes = { { made[i] } } };
        p.effect = i == count - 1 ? FG_EFFECT_EXTERNAL : FG_EFFECT_NONE;
        if (i && (s == CHAIN || s == BACKWARDS))
            p.reads[0].res = made[i - 1];
        for (int j = 0; s == WIDE && i >= 20 && j < 20; j++)
            p.reads[j].res = made[i - 1 - j];
        if (i && s == ONE_READ_BY_ALL)
            p.reads[0].res = made[0];
        if (s == IN_PARTS) {
            p.kind = FG_KIND_COMPUTE;
            p.writes[0].layer = (uint16_t) (i % (count / 5));
            p.writes[0].layers = 1;
        }
        if (s == ONE_READ_BY_ALL || s == IN_PARTS)
            p.effect = FG_EFFECT_EXTERNAL;
        fg_passes(g, &p, 1);
    }
    free(made);
}

// Steps that the compile's loops took, as the log says.
static double steps_of(int count, shape s)
{
    rig *r = rig_open_with((fg_graph_desc){ 0 }, &(fg_null_desc){ 0 });
    declare_many(r->g, count, s);
    rig_must_compile(r);
    const char *at = strstr(r->said, "kept, in ");
    assert_non_null(at);
    const double steps = strtod(at + strlen("kept, in "), NULL);
    assert_int_equal(fg_graph_get_stats(r->g).kept, count);
    assert_int_equal(fg_graph_run(r->g), FG_OK);
    rig_close(r);
    return steps;
}

static void ten_thousand_passes_take_linear_time(void **state) // C122
{
    (void) state;
    for (shape s = CHAIN; s < SHAPES; s++) {
        const double few = steps_of(1000, s), many = steps_of(10000, s);
        assert_true(few >= 1000);
        // Ten times the passes: ten times the steps. Hash tables of a different fill and
        // the passes at the ends account for the rest.
        assert_true(many < 12 * few);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(failing_allocation_at_any_call_leaks_nothing_and_the_graph_stays),
        cmocka_unit_test(failing_device_at_any_creation_leaks_nothing_and_the_graph_stays),
        cmocka_unit_test(failed_device_keeps_the_history),
        cmocka_unit_test(ten_thousand_passes_take_linear_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
