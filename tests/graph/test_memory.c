// SPDX-License-Identifier: MIT
// Order, lifetimes and who shares memory with whom.
#include "rig.h"

#include <stdio.h>

enum { FRAME_BYTES = 64 * 64 * 8 }; // an RGBA16F of the frame's size

// A chain of `count` textures t0, t1, ...; each pass reads the one before.
static void declare_chain(rig *r, int count, const fg_tex_desc *desc)
{
    fg_res before = { 0 };
    for (int i = 0; i < count; i++) {
        char pass[16], tex[16];
        snprintf(pass, sizeof pass, "p%d", i);
        snprintf(tex, sizeof tex, "t%d", i);
        const fg_res made = fg_texture(r->g, tex, desc);
        PASSES(r, PASS(r, pass, .reads = { { before } },
                       .writes = { { made, .load = FG_LOAD_DISCARD } },
                       .effect = i == count - 1 ? FG_EFFECT_EXTERNAL : FG_EFFECT_NONE));
        before = made;
    }
}

// ---- order --------------------------------------------------------------------------------

static void order_is_the_declared_one_where_it_can_be(void **state) // C51
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
    PASSES(r, PASS(r, "z", SHOW), PASS(r, "y", .writes = { { a } }), PASS(r, "x", SHOW),
           PASS(r, "w", .writes = { { b } }), PASS(r, "v", SHOW, .reads = { { b }, { a } }),
           PASS(r, "u", SHOW));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "z y x w v u ");
    rig_close(r);
}

static void pass_runs_earlier_only_where_one_before_needs_it(void **state) // C05, C50
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = rig_tex(r, "c");
    PASSES(r, PASS(r, "show", SHOW, .reads = { { c } }), PASS(r, "free", SHOW),
           PASS(r, "one", .writes = { { a } }), PASS(r, "other", SHOW, .writes = { { b } }),
           PASS(r, "two", .reads = { { a } }, .writes = { { c } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "one two show free other ");
    rig_close(r);
}

static void overwriting_waits_for_all_readers(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    // "late" must come before "change", and needs "feed", declared after both.
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
    PASSES(r, PASS(r, "make", .writes = { { a } }),
           PASS(r, "late", SHOW, .reads = { { a }, { b } }),
           PASS(r, "change", .writes = { { fg_next(a) } }), PASS(r, "feed", .writes = { { b } }),
           PASS(r, "show", SHOW, .reads = { { fg_next(a) } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "make feed late change show ");
    rig_close(r);
}

static void same_declaration_gives_the_same_plan_everywhere(void **state) // C50, C67
{
    (void) state;
    char *text[3];
    rig *r[2] = { rig_open(0), rig_open(0) };
    for (int i = 0; i < 2; i++) {
        rig_begin(r[i]);
        declare_chain(r[i], 9, &(fg_tex_desc){ 0 });
        rig_must_compile(r[i]);
        text[i] = rig_dump(r[i], FG_DUMP_TEXT);
    }
    rig_must_run(r[1]);
    char *first = strdup(fg_null_log(r[1]->dev));
    // Another graph in between, then the first again.
    rig_begin(r[1]);
    declare_chain(r[1], 3, &(fg_tex_desc){ .format = FG_R8 });
    rig_must_compile(r[1]);
    rig_must_run(r[1]);
    rig_begin(r[1]);
    declare_chain(r[1], 9, &(fg_tex_desc){ 0 });
    rig_must_compile(r[1]);
    text[2] = rig_dump(r[1], FG_DUMP_TEXT);
    rig_must_run(r[1]);
    assert_string_equal(text[0], text[1]);
    assert_string_equal(text[0], text[2]);
    // The passes got the objects that they had.
    assert_string_equal(strstr(first, "pass p0"), strstr(fg_null_log(r[1]->dev), "pass p0"));
    free(first);
    fg_dump_free(r[0]->g, text[0]);
    fg_dump_free(r[1]->g, text[1]);
    fg_dump_free(r[1]->g, text[2]);
    rig_close(r[0]);
    rig_close(r[1]);
}

// ---- lifetimes ----------------------------------------------------------------------------

static void lifetimes_are_first_to_last_use(void **state) // C60
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = rig_tex(r, "c"), d = rig_tex(r, "d");
    PASSES(r, PASS(r, "p0", .writes = { { a } }), PASS(r, "p1", .writes = { { b } }),
           PASS(r, "p2", SHOW, .reads = { { a } }),
           PASS(r, "p3", .reads = { { b } }, .writes = { { c } }),
           PASS(r, "gone", .reads = { { a } }, .writes = { { d } }),
           PASS(r, "p4", SHOW, .reads = { { c } }));
    rig_must_compile(r);
    char *text = rig_dump(r, FG_DUMP_TEXT);
    assert_non_null(strstr(text, "a: RGBA16F 64x64, 32768 bytes, steps 0..2, slot 0"));
    assert_non_null(strstr(text, "b: RGBA16F 64x64, 32768 bytes, steps 1..3, slot 1"));
    assert_non_null(strstr(text, "c: RGBA16F 64x64, 32768 bytes, steps 3..4, slot 0"));
    assert_non_null(strstr(text, "d: RGBA16F 64x64, not used")); // C65
    fg_dump_free(r->g, text);
    rig_close(r);
}

static void chain_needs_the_memory_of_two(void **state) // C61
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    declare_chain(r, 8, &(fg_tex_desc){ 0 });
    rig_must_compile(r);
    rig_must_run(r);
    const fg_graph_stats s = fg_graph_get_stats(r->g);
    assert_int_equal(s.transient_bytes, 2 * FRAME_BYTES);
    assert_int_equal(s.unshared_bytes, 8 * FRAME_BYTES);
    assert_int_equal(s.live_bytes, 2 * FRAME_BYTES);
    assert_int_equal(s.pool_bytes, 2 * FRAME_BYTES);
    assert_int_equal(fg_null_live_bytes(r->dev), 2 * FRAME_BYTES);
    rig_close(r);
}

static void other_shapes_do_not_share(void **state) // C63
{
    (void) state;
    static const fg_tex_desc descs[] = {
        { .format = FG_RGBA16F },
        { .format = FG_RGBA32F },
        { .format = FG_RGBA16F, .mips = 2 },
        { .format = FG_RGBA16F, .width = 32, .height = 128 },
        { .format = FG_RGBA16F, .layers = 1 },
        { .format = FG_RGBA16F, .depth = 1 },
        { .format = FG_RGBA16F, .samples = 4 },
        { .format = FG_DEPTH32F },
        { .format = FG_DEPTH24_STENCIL8 },
        { .format = FG_RGBA16F, .layers = 6 },
        { .format = FG_RGBA16F, .cube = true },
    };
    rig *r = rig_open(0);
    rig_begin(r);
    for (int i = 0; i < FG_COUNT(descs); i++) {
        char pass[16], tex[16];
        snprintf(pass, sizeof pass, "p%d", i);
        snprintf(tex, sizeof tex, "t%d", i);
        const fg_res made = fg_texture(r->g, tex, &descs[i]);
        PASSES(r, PASS(r, pass, SHOW, .writes = { { made, .mips = 1 } }));
    }
    rig_must_compile(r);
    rig_must_run(r);
    assert_int_equal(fg_null_live_objects(r->dev), FG_COUNT(descs));
    rig_close(r);
}

static void formats_of_one_view_class_share_through_a_view(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
    const fg_res c = fg_texture(r->g, "c", &(fg_tex_desc){ .format = FG_RG32F });
    PASSES(r, PASS(r, "p0", .writes = { { a } }),
           PASS(r, "p1", .reads = { { a } }, .writes = { { b } }),
           PASS(r, "p2", .reads = { { b } }, .writes = { { c } }),
           PASS(r, "show", SHOW, .reads = { { c } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_non_null(strstr(fg_null_log(r->dev), "view c RG32F 64x64 of 1 -> 3\n"));
    assert_int_equal(fg_graph_get_stats(r->g).transient_bytes, 2 * FRAME_BYTES);
    assert_int_equal(fg_null_live_bytes(r->dev), 2 * FRAME_BYTES);
    rig_close(r);
}

static void imports_histories_and_exports_never_share(void **state) // C64
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_tex_desc history = { .history = FG_HISTORY_CLEAR };
    const fg_res a = fg_import_texture(r->g, "a", &(fg_tex_desc){ 0 }, 90);
    const fg_res b = fg_texture(r->g, "b", &history), c = rig_tex(r, "c"), d = rig_tex(r, "d");
    fg_export(r->g, c);
    PASSES(r, PASS(r, "p0", .writes = { { fg_next(a) } }),
           PASS(r, "p1", SHOW, .reads = { { fg_last_frame(r->g, b) } }, .writes = { { b } }),
           PASS(r, "p2", .writes = { { c } }), PASS(r, "p3", SHOW, .writes = { { d } }));
    rig_must_compile(r);
    rig_must_run(r);
    const fg_graph_stats s = fg_graph_get_stats(r->g);
    assert_int_equal(s.transient_bytes, FRAME_BYTES);
    assert_int_equal(s.persistent_bytes, 3 * FRAME_BYTES);
    assert_int_equal(fg_null_live_objects(r->dev), 4);
    rig_close(r);
}

static void sharing_can_be_switched_off(void **state) // C69
{
    (void) state;
    rig *r = rig_open(FG_DEBUG_NO_SHARING);
    rig_begin(r);
    declare_chain(r, 8, &(fg_tex_desc){ 0 });
    rig_must_compile(r);
    rig_must_run(r);
    const fg_graph_stats s = fg_graph_get_stats(r->g);
    assert_int_equal(s.transient_bytes, s.unshared_bytes);
    assert_int_equal(s.live_bytes, 2 * FRAME_BYTES);
    assert_int_equal(fg_null_live_objects(r->dev), 8);
    rig_close(r);
}

static void bytes_count_mips_layers_and_samples(void **state)
{
    (void) state;
    rig *r = rig_open(FG_DEBUG_NO_SHARING);
    rig_begin(r);
    const fg_tex_desc mips = {
        .format = FG_R8, .width = 5, .height = 3, .mips = FG_MIPS_ALL, .layers = 2
    };
    const fg_tex_desc solid = { .format = FG_R32F, .width = 4, .height = 4, .depth = 4, .mips = 3 };
    const fg_tex_desc multi = { .format = FG_RGBA8, .width = 2, .height = 2, .samples = 4 };
    const fg_res a = fg_texture(r->g, "a", &mips), b = fg_texture(r->g, "b", &solid);
    const fg_res c = fg_texture(r->g, "c", &multi);
    PASSES(r, PASS(r, "p", SHOW, .kind = FG_KIND_COMPUTE, .writes = { { a }, { b } }),
           PASS(r, "q", SHOW, .writes = { { c } }));
    rig_must_compile(r);
    rig_must_run(r);
    // 5x3 + 2x1 + 1x1 texels in 2 layers; 64 + 8 + 1 texels of 4 bytes; 4 texels of 4x4 bytes.
    const uint64_t bytes = 2 * (15 + 2 + 1) + 4 * (64 + 8 + 1) + 4 * 4 * 4;
    assert_int_equal(fg_graph_get_stats(r->g).transient_bytes, bytes);
    assert_int_equal(fg_null_live_bytes(r->dev), bytes);
    rig_close(r);
}

// ---- the pool -----------------------------------------------------------------------------

static void resize_frees_the_old_size(void **state) // C66
{
    (void) state;
    rig *r = rig_open(0);
    for (int size = 64; size < 128; size++) {
        fg_graph_begin(r->g, &(fg_frame_desc){ .width = size, .height = size });
        declare_chain(r, 4, &(fg_tex_desc){ .scale_log2 = 1 });
        rig_must_compile(r);
        rig_must_run(r);
        const uint64_t half = (uint64_t) (size + 1) / 2;
        assert_int_equal(fg_null_live_bytes(r->dev), 2 * half * half * 8);
        assert_int_equal(fg_graph_get_stats(r->g).pool_bytes, fg_null_live_bytes(r->dev));
    }
    rig_close(r);
}

static void changing_one_size_reallocates_it_and_the_old_one_goes_with_time(void **state) // C66
{
    (void) state;
    rig *r = rig_open(0);
    uint64_t most = 0;
    for (int size = 1; size <= 40; size++) {
        rig_begin(r);
        const fg_tex_desc desc = { .format = FG_R8, .width = size, .height = 1 };
        declare_chain(r, 2, &desc);
        rig_must_compile(r);
        rig_must_run(r);
        const uint64_t bytes = fg_null_live_bytes(r->dev);
        most = bytes > most ? bytes : most;
    }
    // Two of each of the last nine or ten sizes at most.
    assert_in_range(most, 80, 2 * 10 * 40);
    fg_graph_trim(r->g);
    assert_int_equal(fg_null_live_bytes(r->dev), 80);
    rig_must_run(r);
    rig_close(r);
}

static void switching_between_graphs_does_not_grow_memory(void **state) // C68, C113
{
    (void) state;
    rig *r = rig_open_with((fg_graph_desc){ 0 }, &(fg_null_desc){ 0 });
    int objects = 0;
    for (int i = 0; i < 1000; i++) {
        rig_begin(r);
        declare_chain(r, i % 2 ? 5 : 7, &(fg_tex_desc){ .format = i % 2 ? FG_R8 : FG_RG32F });
        rig_must_compile(r);
        rig_must_run(r);
        objects = i == 1 ? fg_null_live_objects(r->dev) : objects;
        if (i > 1)
            assert_int_equal(fg_null_live_objects(r->dev), objects);
    }
    assert_int_equal(fg_graph_get_stats(r->g).compiles, 1000);
    rig_close(r);
}

typedef struct head {
    fg_res a, b;
    uint32_t object[2];
} head;

static fg_status note_head(const fg_run *run, void *user)
{
    head *h = user;
    h->object[0] = fg_run_object(run, h->a);
    h->object[1] = fg_run_object(run, h->b);
    return FG_OK;
}

// What comes first, then a chain of `count` textures of the same shape beginning at its end.
static void declare_head_and_tail(rig *r, head *h, int count)
{
    rig_begin(r);
    h->a = rig_tex(r, "head.a");
    h->b = rig_tex(r, "head.b");
    const fg_pass_desc first = {
        .name = "head", .writes = { { h->a }, { h->b } }, .run = note_head, .user = h
    };
    fg_passes(r->g, &first, 1);
    fg_res before = h->a;
    for (int i = 0; i < count; i++) {
        char pass[32], tex[32];
        snprintf(pass, sizeof pass, "tail%d.p%d", count, i);
        snprintf(tex, sizeof tex, "tail%d.t%d", count, i);
        const fg_res made = rig_tex(r, tex);
        PASSES(r, PASS(r, pass, .reads = { { before } }, .writes = { { made } }));
        before = made;
    }
    PASSES(r, PASS(r, "show", SHOW, .reads = { { before }, { h->b } }));
}

static void passes_that_stay_keep_their_objects(void **state)
{
    (void) state;
    static const int tails[] = { 4, 1, 7, 0, 2, 7, 1, 4 };
    rig *r = rig_open(0);
    head h = { .object = { 0 } };
    uint32_t object[2] = { 0 };
    for (int i = 0; i < FG_COUNT(tails); i++) {
        declare_head_and_tail(r, &h, tails[i]);
        rig_must_compile(r);
        fg_graph_trim(r->g);
        const char *log = fg_null_log(r->dev);
        for (int k = 0; k < 2 && i > 0; k++) {
            char gone[32];
            snprintf(gone, sizeof gone, "destroy texture %u\n", object[k]);
            assert_null(strstr(log, gone));
        }
        rig_must_run(r);
        assert_true(i == 0 || !strstr(fg_null_log(r->dev), "texture head."));
        for (int k = 0; k < 2; k++) {
            assert_true(i == 0 || object[k] == h.object[k]);
            object[k] = h.object[k];
        }
        // What the tail before had besides is gone.
        const fg_graph_stats stats = fg_graph_get_stats(r->g);
        assert_int_equal(stats.pool_bytes, stats.transient_bytes);
    }
    rig_close(r);
}

static void poison_fills_transients_before_their_first_use(void **state) // C68
{
    (void) state;
    rig *r = rig_open(FG_DEBUG_POISON);
    for (int i = 0; i < 2; i++) {
        rig_begin(r);
        const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .mips = 2 }), b = rig_buf(r, "b");
        PASSES(r, PASS(r, "make", .writes = { { a, .mips = 1, .load = FG_LOAD_DISCARD } }),
               PASS(r, "fill", .writes = { { b, .load = FG_LOAD_DISCARD } }),
               PASS(r, "show", SHOW, .reads = { { a, .mips = 1 }, { b } }));
        rig_must_compile(r);
        rig_must_run(r);
        const char *log = fg_null_log(r->dev);
        assert_non_null(strstr(log, "poison 1 mips 0+2 layers 0+1\npass make"));
        assert_non_null(strstr(log, "poison 2\n"));
    }
    rig_close(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(order_is_the_declared_one_where_it_can_be),
        cmocka_unit_test(pass_runs_earlier_only_where_one_before_needs_it),
        cmocka_unit_test(overwriting_waits_for_all_readers),
        cmocka_unit_test(same_declaration_gives_the_same_plan_everywhere),
        cmocka_unit_test(lifetimes_are_first_to_last_use),
        cmocka_unit_test(chain_needs_the_memory_of_two),
        cmocka_unit_test(other_shapes_do_not_share),
        cmocka_unit_test(formats_of_one_view_class_share_through_a_view),
        cmocka_unit_test(imports_histories_and_exports_never_share),
        cmocka_unit_test(sharing_can_be_switched_off),
        cmocka_unit_test(bytes_count_mips_layers_and_samples),
        cmocka_unit_test(resize_frees_the_old_size),
        cmocka_unit_test(changing_one_size_reallocates_it_and_the_old_one_goes_with_time),
        cmocka_unit_test(switching_between_graphs_does_not_grow_memory),
        cmocka_unit_test(passes_that_stay_keep_their_objects),
        cmocka_unit_test(poison_fills_transients_before_their_first_use),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
