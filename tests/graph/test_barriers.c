// SPDX-License-Identifier: MIT
// Memory barriers, clears and subresources.
#include "rig.h"

#include <stdio.h>

// The device's calls of the second frame from its first pass, barrier or clear on.
static const char *second_frame(rig *r)
{
    rig_must_compile(r);
    rig_must_run(r);
    rig_must_run(r);
    return strchr(fg_null_log(r->dev), '\n') + 1;
}

// ---- barriers -----------------------------------------------------------------------------

typedef struct consumer {
    fg_use use;
    const char *bit;
} consumer;

static void buffer_consumers_wait_by_their_own_bit(void **state) // C90
{
    (void) state;
    static const consumer cases[] = {
        { FG_USE_STORAGE, "storage" }, { FG_USE_UNIFORM, "uniform" },   { FG_USE_VERTEX, "vertex" },
        { FG_USE_INDEX, "index" },     { FG_USE_INDIRECT, "indirect" }, { FG_USE_COPY, "copy" },
    };
    for (int i = 0; i < FG_COUNT(cases); i++) {
        rig *r = rig_open(0);
        rig_begin(r);
        const fg_res b = rig_buf(r, "b");
        PASSES(
            r,
            PASS(r, "fill", .kind = FG_KIND_COMPUTE, .writes = { { b, .load = FG_LOAD_DISCARD } }),
            PASS(r, "use", SHOW, .reads = { { b, cases[i].use } }));
        char expected[160];
        // The next frame's write waits for this frame's read: the writer's bit.
        snprintf(expected, sizeof expected,
                 "barrier storage\npass fill compute\nbarrier %s\npass use\nend frame\n",
                 cases[i].bit);
        assert_string_equal(second_frame(r), expected);
        rig_close(r);
    }
}

static void texture_consumers_wait_by_their_own_bit(void **state) // C90
{
    (void) state;
    static const consumer cases[] = {
        { FG_USE_SAMPLED, "sampled" },
        { FG_USE_IMAGE, "image" },
        { FG_USE_COPY, "copy" },
    };
    for (int i = 0; i < FG_COUNT(cases); i++) {
        rig *r = rig_open(0);
        rig_begin(r);
        const fg_res a = rig_tex(r, "a");
        PASSES(
            r,
            PASS(r, "fill", .kind = FG_KIND_COMPUTE, .writes = { { a, .load = FG_LOAD_DISCARD } }),
            PASS(r, "use", SHOW, .reads = { { a, cases[i].use } }));
        char expected[160];
        snprintf(expected, sizeof expected,
                 "barrier image\npass fill compute\nbarrier %s\npass use\nend frame\n",
                 cases[i].bit);
        assert_string_equal(second_frame(r), expected);
        rig_close(r);
    }
}

static void attachment_after_an_image_write_waits(void **state) // C90, C91
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = fg_next(a);
    PASSES(r,
           PASS(r, "fill", .kind = FG_KIND_COMPUTE, .writes = { { a, .load = FG_LOAD_DISCARD } }),
           PASS(r, "draw", .writes = { { b } }), PASS(r, "show", SHOW, .reads = { { b } }));
    // What "draw" leaves as it was still comes from the image write: sampling waits, too.
    assert_string_equal(second_frame(r), "barrier image\npass fill compute\nbarrier attachment\n"
                                         "pass draw 64x64 color 1\nbarrier sampled\npass show\n"
                                         "end frame\n");
    rig_close(r);
}

static void write_after_write_waits(void **state) // C91
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_buf(r, "a"), b = fg_next(a);
    PASSES(r, PASS(r, "one", .kind = FG_KIND_COMPUTE, .writes = { { a, .load = FG_LOAD_DISCARD } }),
           PASS(r, "two", SHOW, .kind = FG_KIND_COMPUTE, .writes = { { b } }));
    assert_string_equal(second_frame(r), "barrier storage\npass one compute\nbarrier storage\n"
                                         "pass two compute\nend frame\n");
    rig_close(r);
}

static void write_after_read_waits(void **state) // C91
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = fg_next(a), c = rig_tex(r, "c");
    PASSES(r, PASS(r, "draw", .writes = { { a, .load = FG_LOAD_DISCARD } }),
           PASS(r, "read", SHOW, .reads = { { a } }, .writes = { { c, .load = FG_LOAD_DISCARD } }),
           PASS(r, "store", SHOW, .kind = FG_KIND_COMPUTE, .writes = { { b } }));
    // Drawing after the last frame's image writes waits as an attachment, and hides them.
    assert_string_equal(second_frame(r), "barrier attachment\npass draw 64x64 color 1\n"
                                         "pass read 64x64 color 2\nbarrier image\n"
                                         "pass store compute\nend frame\n");
    rig_close(r);
}

static void raster_to_sample_needs_no_barrier(void **state) // C92
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = fg_next(b);
    const fg_res z = fg_texture(r->g, "z", &(fg_tex_desc){ .format = FG_DEPTH32F });
    PASSES(r, PASS(r, "draw", .writes = { { a }, { z } }),
           PASS(r, "shade", .reads = { { a }, { z } }, .writes = { { b } }),
           PASS(r, "blend", .reads = { { a }, { z, FG_USE_DEPTH } }, .writes = { { c } }),
           PASS(r, "load", SHOW, .kind = FG_KIND_COMPUTE, .reads = { { c, FG_USE_IMAGE } }));
    assert_null(strstr(second_frame(r), "barrier"));
    rig_close(r);
}

static void second_reader_needs_no_second_barrier(void **state) // C93
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    PASSES(r,
           PASS(r, "fill", .kind = FG_KIND_COMPUTE, .writes = { { a, .load = FG_LOAD_DISCARD } }),
           PASS(r, "one", SHOW, .reads = { { a } }), PASS(r, "two", SHOW, .reads = { { a } }),
           PASS(r, "three", SHOW, .reads = { { a, FG_USE_IMAGE } }),
           PASS(r, "four", SHOW, .reads = { { a }, { a, FG_USE_IMAGE } }));
    assert_string_equal(second_frame(r),
                        "barrier image\npass fill compute\nbarrier sampled\n"
                        "pass one\npass two\nbarrier image\npass three\npass four\n"
                        "end frame\n");
    rig_close(r);
}

static void one_barrier_serves_all_that_was_written_before(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b"), c = rig_buf(r, "c");
    PASSES(r,
           PASS(r, "fill", .kind = FG_KIND_COMPUTE,
                .writes = { { a, .load = FG_LOAD_DISCARD },
                            { b, .load = FG_LOAD_DISCARD },
                            { c, .load = FG_LOAD_DISCARD } }),
           PASS(r, "one", SHOW, .reads = { { a }, { c, FG_USE_UNIFORM } }),
           PASS(r, "two", SHOW, .reads = { { b } }));
    assert_string_equal(second_frame(r),
                        "barrier image|storage\npass fill compute\n"
                        "barrier sampled|uniform\npass one\npass two\nend frame\n");
    rig_close(r);
}

static void disjoint_mips_need_no_barrier(void **state) // C94
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .mips = 2, .layers = 2 }),
                 b = fg_next(a);
    const fg_res c = fg_next(b);
    PASSES(r,
           PASS(r, "one", .kind = FG_KIND_COMPUTE,
                .writes = { { a, .mips = 1, .load = FG_LOAD_DISCARD } }),
           PASS(r, "two", SHOW, .kind = FG_KIND_COMPUTE,
                .writes = { { b, .mip = 1, .layers = 1, .load = FG_LOAD_DISCARD } }),
           PASS(r, "three", SHOW, .kind = FG_KIND_COMPUTE,
                .writes = { { c, .mip = 1, .layer = 1, .load = FG_LOAD_DISCARD } }));
    // Each waits for what the last frame left in its part; the first barrier serves all.
    rig_must_compile(r);
    rig_must_run(r);
    rig_must_run(r);
    assert_int_equal(rig_count(fg_null_log(r->dev), "barrier"), 0 + 1);
    rig_close(r);
}

static void barriers_are_the_same_every_frame_and_from_the_cached_plan(void **state) // C95, C105
{
    (void) state;
    rig *r = rig_open(0);
    char *first = NULL;
    for (int i = 0; i < 4; i++) {
        rig_begin(r);
        const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
        PASSES(
            r,
            PASS(r, "fill", .kind = FG_KIND_COMPUTE, .writes = { { a, .load = FG_LOAD_DISCARD } }),
            PASS(r, "draw", .reads = { { a } }, .writes = { { b, .load = FG_LOAD_CLEAR } }),
            PASS(r, "show", SHOW, .reads = { { b } }));
        rig_must_compile(r);
        rig_must_run(r);
        const char *steps = strchr(strstr(fg_null_log(r->dev), "frame "), '\n');
        first = first ? first : strdup(steps);
        assert_string_equal(steps, first);
    }
    assert_int_equal(fg_graph_get_stats(r->g).compiles, 1);
    free(first);
    rig_close(r);
}

static void histories_wait_across_frames(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res h = fg_texture(r->g, "h", &(fg_tex_desc){ .history = FG_HISTORY_CLEAR });
    PASSES(r,
           PASS(r, "blend", SHOW, .kind = FG_KIND_COMPUTE, .reads = { { fg_last_frame(r->g, h) } },
                .writes = { { h, .load = FG_LOAD_DISCARD } }));
    // Last frame's image is sampled, and the one from before, sampled last frame, is stored to.
    assert_string_equal(second_frame(r), "barrier sampled|image\npass blend compute\nend frame\n");
    rig_close(r);
}

static void memory_shared_by_transients_waits(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
    PASSES(r,
           PASS(r, "store", SHOW, .kind = FG_KIND_COMPUTE,
                .writes = { { a, .load = FG_LOAD_DISCARD } }),
           PASS(r, "draw", SHOW, .writes = { { b, .load = FG_LOAD_DISCARD } }));
    assert_int_equal(fg_graph_get_stats(r->g).pool_bytes, 0);
    // "b" is drawn into what "a" was stored to; next frame "a" stores where "b" was drawn.
    assert_string_equal(second_frame(r), "barrier image\npass store compute\nbarrier attachment\n"
                                         "pass draw 64x64 color 1\nend frame\n");
    assert_int_equal(fg_null_live_objects(r->dev), 1);
    rig_close(r);
}

static void imports_wait_across_frames(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_import_buffer(r->g, "a", &(fg_buf_desc){ 16 }, 50);
    PASSES(r, PASS(r, "count", .kind = FG_KIND_COMPUTE, .reads = { { a } },
                   .writes = { { fg_next(a) } }));
    assert_string_equal(second_frame(r), "barrier storage\npass count compute\nend frame\n");
    rig_close(r);
}

static void plan_after_one_with_image_writes_starts_with_a_full_barrier(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    PASSES(r, PASS(r, "store", SHOW, .kind = FG_KIND_COMPUTE,
                   .writes = { { a, .load = FG_LOAD_DISCARD } }));
    rig_must_compile(r);
    rig_must_run(r);
    rig_begin(r);
    const fg_res b = rig_tex(r, "b");
    PASSES(r, PASS(r, "draw", SHOW, .writes = { { b, .load = FG_LOAD_DISCARD } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_non_null(strstr(fg_null_log(r->dev),
                           "barrier sampled|image|attachment|storage|uniform|vertex|index|indirect|"
                           "copy\npass draw 64x64 color 1\n"));
    rig_must_run(r);
    assert_null(strstr(fg_null_log(r->dev), "barrier"));
    rig_close(r);
}

// ---- clears -------------------------------------------------------------------------------

static void first_partial_write_is_cleared_to_zero(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = rig_tex(r, "a"), b = rig_buf(r, "b");
    PASSES(r, PASS(r, "draw", .writes = { { a } }), PASS(r, "more", .writes = { { fg_next(a) } }),
           PASS(r, "fill", .kind = FG_KIND_COMPUTE, .writes = { { b } }),
           PASS(r, "show", SHOW, .reads = { { fg_next(a) }, { b } }));
    assert_string_equal(
        second_frame(r),
        "clear 1 mips 0+1 layers 0+1 to 0 0 0 0\npass draw 64x64 color 1\n"
        "pass more 64x64 color 1\nbarrier copy\nclear 2 to 0 0 0 0\n"
        "barrier storage\npass fill compute\nbarrier storage\npass show\nend frame\n");
    rig_close(r);
}

static void clear_values_are_those_of_the_last_declaration(void **state) // C102
{
    (void) state;
    rig *r = rig_open(0);
    for (int i = 0; i < 3; i++) {
        rig_begin(r);
        const fg_res a = rig_tex(r, "a"), b = rig_tex(r, "b");
        const float red = (float) i;
        PASSES(r,
               PASS(r, "draw",
                    .writes = { { a, .load = FG_LOAD_DISCARD },
                                { b, .load = FG_LOAD_CLEAR, .clear = { red, 0.5f, 0, 1 } } }),
               PASS(r, "show", SHOW, .reads = { { a }, { b } }));
        rig_must_compile(r);
        rig_must_run(r);
        char line[80];
        snprintf(line, sizeof line, "clear 2 mips 0+1 layers 0+1 to %d 0.5 0 1\n", i);
        assert_non_null(strstr(fg_null_log(r->dev), line));
        assert_int_equal(rig_count(fg_null_log(r->dev), "clear"), 1);
    }
    assert_int_equal(fg_graph_get_stats(r->g).compiles, 1);
    rig_close(r);
}

static void parts_that_nobody_wrote_read_as_zeros(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .mips = 3, .layers = 4 });
    PASSES(r,
           PASS(r, "one", .kind = FG_KIND_COMPUTE,
                .writes = { { a, .mips = 1, .layer = 1, .layers = 2, .load = FG_LOAD_DISCARD } }),
           PASS(r, "show", SHOW, .reads = { { a } }));
    rig_must_compile(r);
    rig_must_run(r);
    const char *log = fg_null_log(r->dev);
    assert_non_null(strstr(log, "clear 1 mips 0+1 layers 0+1 to 0 0 0 0\n"));
    assert_non_null(strstr(log, "clear 1 mips 0+1 layers 3+1 to 0 0 0 0\n"));
    assert_non_null(strstr(log, "clear 1 mips 1+2 layers 0+4 to 0 0 0 0\n"));
    assert_int_equal(rig_count(log, "clear"), 3);
    rig_close(r);
}

static void parts_of_a_write_have_their_own_load(void **state) // C83
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .layers = 3 });
    PASSES(
        r,
        PASS(r, "draw", .kind = FG_KIND_COMPUTE,
             .writes = { { a, .layer = 0, .layers = 1 },
                         { a, .layer = 1, .layers = 1, .load = FG_LOAD_DISCARD },
                         { a, .layer = 2, .layers = 1, .load = FG_LOAD_CLEAR, .clear = { 7 } } }),
        PASS(r, "show", SHOW, .reads = { { a } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_non_null(strstr(fg_null_log(r->dev), "clear 1 mips 0+1 layers 0+1 to 0 0 0 0\n"
                                                "clear 1 mips 0+1 layers 2+1 to 7 0 0 0\n"));
    assert_int_equal(rig_count(fg_null_log(r->dev), "clear"), 2);
    rig_close(r);
}

// ---- subresources -------------------------------------------------------------------------

static void mip_chain_is_no_cycle_and_its_reader_keeps_all_of_it(void **state) // C80, C81, C82
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .mips = 4 });
    PASSES(r, PASS(r, "mip0", .writes = { { a, .mips = 1, .load = FG_LOAD_DISCARD } }));
    static const char *const names[] = { "mip0", "mip1", "mip2", "mip3" };
    for (uint8_t i = 1; i < 4; i++) {
        const uint8_t above = (uint8_t) (i - 1);
        PASSES(r, PASS(r, names[i], .reads = { { a, .mip = above, .mips = 1 } },
                       .writes = { { fg_next(a), .mip = i, .mips = 1, .load = FG_LOAD_DISCARD } }));
        a = fg_next(a);
    }
    PASSES(r, PASS(r, "show", SHOW, .reads = { { a } }));
    assert_string_equal(second_frame(r), "pass mip0 64x64 color 1\npass mip1 32x32 color 1 mip 1\n"
                                         "pass mip2 16x16 color 1 mip 2\n"
                                         "pass mip3 8x8 color 1 mip 3\npass show\nend frame\n");
    rig_close(r);
}

static void reader_of_one_mip_lets_the_others_go(void **state) // C81
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .mips = 3 }), b = fg_next(a),
                 c = fg_next(b);
    PASSES(r, PASS(r, "mip0", .writes = { { a, .mip = 0, .mips = 1 } }),
           PASS(r, "mip1", .writes = { { b, .mip = 1, .mips = 1 } }),
           PASS(r, "mip2", .writes = { { c, .mip = 2, .mips = 1 } }),
           PASS(r, "show", SHOW, .reads = { { c, .mip = 1, .mips = 1 } }));
    rig_must_compile(r);
    rig_must_run(r);
    assert_string_equal(r->trace, "mip1 show ");
    assert_string_equal(rig_why(r, "mip2"), "no running pass reads the part of 'a' that it writes");
    rig_close(r);
}

static void compute_mip_chain_waits_once_a_mip(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .mips = 2 }), b = fg_next(a);
    PASSES(r,
           PASS(r, "mip0", .kind = FG_KIND_COMPUTE,
                .writes = { { a, .mips = 1, .load = FG_LOAD_DISCARD } }),
           PASS(r, "mip1", .kind = FG_KIND_COMPUTE, .reads = { { a, .mips = 1 } },
                .writes = { { b, .mip = 1, .load = FG_LOAD_DISCARD } }),
           PASS(r, "show", SHOW, .reads = { { b } }));
    // Before "show" the sampled bit again, for mip 1; mip 1's write needs no wait of its own,
    // as the frame's first barrier came after all that touched it.
    assert_string_equal(second_frame(r),
                        "barrier image\npass mip0 compute\nbarrier sampled\n"
                        "pass mip1 compute\nbarrier sampled\npass show\nend frame\n");
    rig_close(r);
}

static void cube_is_attached_face_by_face_or_as_a_whole(void **state)
{
    (void) state;
    rig *r = rig_open(0);
    rig_begin(r);
    const fg_res a = fg_texture(r->g, "a", &(fg_tex_desc){ .cube = true }), b = fg_next(a);
    PASSES(r, PASS(r, "all", .writes = { { a, .load = FG_LOAD_DISCARD } }),
           PASS(r, "one", SHOW, .writes = { { b, .layer = 4, .layers = 1 } }));
    assert_string_equal(
        second_frame(r),
        "pass all 64x64 color 1 layered\npass one 64x64 color 1 layer 4\nend frame\n");
    rig_close(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buffer_consumers_wait_by_their_own_bit),
        cmocka_unit_test(texture_consumers_wait_by_their_own_bit),
        cmocka_unit_test(attachment_after_an_image_write_waits),
        cmocka_unit_test(write_after_write_waits),
        cmocka_unit_test(write_after_read_waits),
        cmocka_unit_test(raster_to_sample_needs_no_barrier),
        cmocka_unit_test(second_reader_needs_no_second_barrier),
        cmocka_unit_test(one_barrier_serves_all_that_was_written_before),
        cmocka_unit_test(disjoint_mips_need_no_barrier),
        cmocka_unit_test(barriers_are_the_same_every_frame_and_from_the_cached_plan),
        cmocka_unit_test(histories_wait_across_frames),
        cmocka_unit_test(memory_shared_by_transients_waits),
        cmocka_unit_test(imports_wait_across_frames),
        cmocka_unit_test(plan_after_one_with_image_writes_starts_with_a_full_barrier),
        cmocka_unit_test(first_partial_write_is_cleared_to_zero),
        cmocka_unit_test(clear_values_are_those_of_the_last_declaration),
        cmocka_unit_test(parts_that_nobody_wrote_read_as_zeros),
        cmocka_unit_test(parts_of_a_write_have_their_own_load),
        cmocka_unit_test(mip_chain_is_no_cycle_and_its_reader_keeps_all_of_it),
        cmocka_unit_test(reader_of_one_mip_lets_the_others_go),
        cmocka_unit_test(compute_mip_chain_waits_once_a_mip),
        cmocka_unit_test(cube_is_attached_face_by_face_or_as_a_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
