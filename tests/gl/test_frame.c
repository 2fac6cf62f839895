// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <stdlib.h>

#include "arguments_comp.h"
#include "cells_comp.h"
#include "cells_frag.h"
#include "count_comp.h"
#include "fullscreen_vert.h"
#include "layers_comp.h"
#include "layers_frag.h"
#include "layers_geom.h"
#include "layers_vert.h"
#include "mip_comp.h"
#include "shadow_comp.h"

// Passes through a real graph. Sizes are no multiples of a work group, so that edges count.

enum { W = 13, H = 11 };

typedef struct pass {
    fg_res from, to, args;
    const char *defines;
    int mip;
} pass;

// What cell.glsl says of texel `i` of rows of `width`.
static float cell_of(int i, int width)
{
    const int row = i / width;
    return (float) (i - row * width + 4096 * row);
}

static float cell(int i)
{
    return cell_of(i, W);
}

static fg_status draw_cells(const fg_run *run, void *user)
{
    const pass *p = user;
    const fg_gl_program_desc desc = { { &fullscreen_vert, &cells_frag }, p->defines };
    const fg_status status = use_program(run, &desc);
    fg_gl_fullscreen(run);
    return status;
}

static fg_status store_cells(const fg_run *run, void *user)
{
    const pass *p = user;
    const fg_gl_program_desc desc = { { &cells_comp }, p->defines };
    const fg_status status = use_program(run, &desc);
    int size[3];
    fg_run_size(run, p->to, 0, size);
    fg_gl_image(run, 0, p->to, 0, GL_WRITE_ONLY, FG_R32F);
    fg_gl_dispatch_2d(size[0], size[1], 8, 8);
    return status;
}

static fg_res cells_texture(fg_graph *g, const char *name)
{
    return fg_texture(g, name, &(fg_tex_desc){ .format = FG_R32F, .width = W, .height = H });
}

static void run(fg_graph *g)
{
    assert_int_equal(fg_graph_compile(g), FG_OK);
    assert_int_equal(fg_graph_run(g), FG_OK);
}

static void begin(fg_graph *g)
{
    fg_graph_begin(g, &(fg_frame_desc){ .width = W, .height = H });
}

// ---- exact values -----------------------------------------------------------------

static void raster_pass_writes_exact_values(void **state)
{
    float got[W * H];
    pass draw = { .defines = "SEED=100" };
    fg_graph *g = open_graph(*state, FG_DEBUG_POISON, 0);
    begin(g);
    draw.to = cells_texture(g, "cells");
    const fg_pass_desc passes[] = {
        { .name = "draw",
          .writes = { { draw.to, .load = FG_LOAD_DISCARD } },
          .run = draw_cells,
          .user = &draw },
    };
    fg_passes(g, passes, FG_COUNT(passes));
    fg_export(g, draw.to);
    run(g);
    read_floats(fg_graph_exported(g, draw.to), got, W * H);
    for (int i = 0; i < W * H; ++i)
        assert_true(got[i] == cell(i) + 100.0f);
    fg_graph_destroy(g);
}

static void compute_pass_writes_exact_values(void **state)
{
    float got[W * H];
    pass store = { 0 };
    fg_graph *g = open_graph(*state, FG_DEBUG_POISON, 0);
    begin(g);
    store.to = cells_texture(g, "cells");
    const fg_pass_desc passes[] = {
        { .name = "store",
          .kind = FG_KIND_COMPUTE,
          .writes = { { store.to, .load = FG_LOAD_DISCARD } },
          .run = store_cells,
          .user = &store },
    };
    fg_passes(g, passes, FG_COUNT(passes));
    fg_export(g, store.to);
    run(g);
    read_floats(fg_graph_exported(g, store.to), got, W * H);
    for (int i = 0; i < W * H; ++i)
        assert_true(got[i] == cell(i));
    fg_graph_destroy(g);
}

// ---- the state that a pass finds --------------------------------------------------

static fg_status wreck_state(const fg_run *r, void *user)
{
    (void) r, (void) user;
    glEnable(GL_BLEND);
    glBlendFunc(GL_ZERO, GL_ZERO);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT_AND_BACK);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, 1, 1);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_NEVER, 0, 0xff);
    glEnable(GL_RASTERIZER_DISCARD);
    glDepthFunc(GL_NEVER);
    glDepthMask(GL_FALSE);
    glDepthRange(0.25, 0.3);
    glFrontFace(GL_CW);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glClipControl(GL_UPPER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
    glViewport(3, 3, 1, 1);
    glBindVertexArray(0);
    return FG_OK;
}

static fg_status check_and_draw(const fg_run *run, void *user)
{
    // What a picture does not show.
    GLint front = 0, program = -1;
    glGetIntegerv(GL_FRONT_FACE, &front);
    glGetIntegerv(GL_CURRENT_PROGRAM, &program);
    assert_int_equal(front, GL_CCW);
    assert_int_equal(program, 0);
    assert_true(glIsEnabled(GL_FRAMEBUFFER_SRGB));
    return draw_cells(run, user);
}

static void pass_inherits_no_state(void **state)
{
    float got[W * H];
    pass draw = { 0 };
    fg_graph *g = open_graph(*state, FG_DEBUG_POISON, 0);
    begin(g);
    draw.to = cells_texture(g, "cells");
    const fg_res depth = fg_texture(g, "depth", &(fg_tex_desc){ .format = FG_DEPTH32F });
    const fg_pass_desc passes[] = {
        { .name = "wreck", .run = wreck_state, .effect = FG_EFFECT_EXTERNAL },
        { .name = "draw",
          .writes = { { draw.to, .load = FG_LOAD_DISCARD }, { depth, FG_USE_DEPTH } },
          .run = check_and_draw,
          .user = &draw },
    };
    fg_passes(g, passes, FG_COUNT(passes));
    fg_export(g, draw.to);
    fg_export(g, depth);
    run(g);
    read_floats(fg_graph_exported(g, draw.to), got, W * H);
    for (int i = 0; i < W * H; ++i)
        assert_true(got[i] == cell(i));
    glGetTextureImage(fg_graph_exported(g, depth), 0, GL_DEPTH_COMPONENT, GL_FLOAT, sizeof got,
                      got);
    for (int i = 0; i < W * H; ++i)
        assert_true(got[i] == 0.5f); // clip space z over w, as [0, 1] has it
    fg_graph_destroy(g);
}

static void nearer_depth_is_greater(void **state)
{
    // Far (0.25) after near (0.5) must lose, nearer (0.75) must win.
    float got[W * H];
    pass draw[3] = { { .defines = "SEED=0;DEPTH=0.5" },
                     { .defines = "SEED=1000000;DEPTH=0.25" },
                     { .defines = "SEED=2;DEPTH=0.75" } };
    fg_graph *g = open_graph(*state, 0, 0);
    begin(g);
    fg_res color = cells_texture(g, "cells");
    fg_res depth = fg_texture(g, "depth", &(fg_tex_desc){ .format = FG_DEPTH32F });
    static const char *const names[] = { "first", "farther", "nearer" };
    for (int i = 0; i < 3; ++i) {
        const fg_pass_desc one = {
            .name = names[i],
            .writes = { { color }, { depth, FG_USE_DEPTH } },
            .run = draw_cells,
            .user = &draw[i],
        };
        fg_passes(g, &one, 1);
        if (i < 2) {
            color = fg_next(color);
            depth = fg_next(depth);
        }
    }
    fg_export(g, color);
    run(g);
    read_floats(fg_graph_exported(g, color), got, W * H);
    for (int i = 0; i < W * H; ++i)
        assert_true(got[i] == cell(i) + 2.0f);
    fg_graph_destroy(g);
}

static void read_only_depth_is_tested_and_not_written(void **state)
{
    float got[W * H];
    pass fill = { .defines = "DEPTH=0.5" }, test = { .defines = "SEED=7;DEPTH=0.75" };
    fg_graph *g = open_graph(*state, 0, 0);
    begin(g);
    const fg_res a = cells_texture(g, "a"), b = cells_texture(g, "b");
    const fg_res depth = fg_texture(g, "depth", &(fg_tex_desc){ .format = FG_DEPTH32F });
    const fg_pass_desc passes[] = {
        { .name = "fill",
          .writes = { { a }, { depth, FG_USE_DEPTH } },
          .run = draw_cells,
          .user = &fill },
        { .name = "test",
          .reads = { { depth, FG_USE_DEPTH } },
          .writes = { { b } },
          .run = draw_cells,
          .user = &test },
    };
    fg_passes(g, passes, FG_COUNT(passes));
    fg_export(g, b);
    fg_export(g, depth);
    run(g);
    read_floats(fg_graph_exported(g, b), got, W * H);
    assert_true(got[W * H - 1] == cell(W * H - 1) + 7.0f);
    glGetTextureImage(fg_graph_exported(g, depth), 0, GL_DEPTH_COMPONENT, GL_FLOAT, sizeof got,
                      got);
    for (int i = 0; i < W * H; ++i)
        assert_true(got[i] == 0.5f);
    fg_graph_destroy(g);
}

// ---- barriers ---------------------------------------------------------------------

static fg_status write_arguments(const fg_run *run, void *user)
{
    const pass *p = user;
    const fg_status status = use_program(run, &(fg_gl_program_desc){ { &arguments_comp } });
    fg_gl_sample(run, 0, p->from, FG_GL_NEAREST);
    fg_gl_storage(run, 0, p->to);
    glDispatchCompute(1, 1, 1);
    return status;
}

static fg_status count_indirectly(const fg_run *run, void *user)
{
    const pass *p = user;
    const fg_status status = use_program(run, &(fg_gl_program_desc){ { &count_comp } });
    fg_gl_storage(run, 0, p->to);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, fg_run_object(run, p->args));
    glDispatchComputeIndirect(0);
    return status;
}

static void image_to_sampler_to_indirect_dispatch_is_ordered(void **state)
{
    uint32_t counted = 0;
    pass store = { .defines = "SEED=100" }, arguments = { 0 }, count = { 0 };
    fg_graph *g = open_graph(*state, FG_DEBUG_POISON, 0);
    begin(g);
    store.to = arguments.from = cells_texture(g, "cells");
    arguments.to = count.args = fg_buffer(g, "arguments", &(fg_buf_desc){ .size = 12 });
    count.to = fg_buffer(g, "counter", &(fg_buf_desc){ .size = 4 });
    const fg_pass_desc passes[] = {
        { .name = "store",
          .kind = FG_KIND_COMPUTE,
          .writes = { { store.to, .load = FG_LOAD_DISCARD } },
          .run = store_cells,
          .user = &store },
        { .name = "arguments",
          .kind = FG_KIND_COMPUTE,
          .reads = { { arguments.from } },
          .writes = { { arguments.to, .load = FG_LOAD_DISCARD } },
          .run = write_arguments,
          .user = &arguments },
        { .name = "count",
          .kind = FG_KIND_COMPUTE,
          .reads = { { count.args, FG_USE_INDIRECT } },
          .writes = { { count.to, .load = FG_LOAD_CLEAR } },
          .run = count_indirectly,
          .user = &count },
    };
    fg_passes(g, passes, FG_COUNT(passes));
    fg_export(g, count.to);
    run(g);
    const uint32_t counter = fg_graph_exported(g, count.to);
    assert_int_not_equal(counter, 0);
    glGetNamedBufferSubData(counter, 0, sizeof counted, &counted);
    assert_int_equal(counted, 101); // cell (1, 0) + SEED groups of one invocation
    fg_graph_destroy(g);
}

static fg_status store_mip(const fg_run *run, void *user)
{
    const pass *p = user;
    const fg_status status = use_program(run, &(fg_gl_program_desc){ { &mip_comp }, p->defines });
    int size[3];
    fg_run_size(run, p->to, p->mip, size);
    fg_gl_sample(run, 0, p->from, FG_GL_NEAREST);
    fg_gl_image(run, 0, p->to, p->mip, GL_WRITE_ONLY, FG_R32F);
    fg_gl_dispatch_2d(size[0], size[1], 8, 8);
    return status;
}

static void mip_chain_by_successive_passes_sums_up(void **state)
{
    enum { SIDE = 16, MIPS = 5 };
    static const char *const names[] = { "mip0", "mip1", "mip2", "mip3", "mip4" };
    static const char *const from[] = { "", "FROM=0", "FROM=1", "FROM=2", "FROM=3" };
    float got = 0.0f, sum = 0.0f;
    pass steps[MIPS];
    fg_graph *g = open_graph(*state, FG_DEBUG_POISON, 0);
    begin(g);
    const fg_tex_desc desc = { .format = FG_R32F, .width = SIDE, .height = SIDE, .mips = MIPS };
    fg_res at = fg_texture(g, "pyramid", &desc), last = { 0 };
    for (int i = 0; i < MIPS; ++i) {
        steps[i] = (pass){ .from = last, .to = at, .mip = i, .defines = from[i] };
        fg_pass_desc one = {
            .name = names[i],
            .kind = FG_KIND_COMPUTE,
            .writes = { { at, .load = FG_LOAD_DISCARD, .mip = (uint8_t) i, .mips = 1 } },
            .run = i ? store_mip : store_cells,
            .user = &steps[i],
        };
        if (i)
            one.reads[0] = (fg_io){ .res = last, .mip = (uint8_t) (i - 1), .mips = 1 };
        fg_passes(g, &one, 1);
        last = at;
        at = fg_next(at);
    }
    fg_export(g, last);
    run(g);
    glGetTextureImage(fg_graph_exported(g, last), MIPS - 1, GL_RED, GL_FLOAT, sizeof got, &got);
    for (int i = 0; i < SIDE * SIDE; ++i)
        sum += cell_of(i, SIDE); // whole numbers below 2^24: exact
    assert_true(got == sum);
    fg_graph_destroy(g);
}

// ---- layers -----------------------------------------------------------------------

static fg_status draw_layers(const fg_run *run, void *user)
{
    (void) user;
    const fg_gl_program_desc desc = { { &layers_vert, &layers_geom, &layers_frag } };
    const fg_status status = use_program(run, &desc);
    glDrawArraysInstanced(GL_TRIANGLES, 0, 3, 2);
    return status;
}

static void layered_attachment_has_all_layers(void **state)
{
    enum { LAYERS = 2 };
    float got[W * H * LAYERS];
    fg_graph *g = open_graph(*state, 0, 0);
    begin(g);
    const fg_res to = fg_texture(g, "array", &(fg_tex_desc){ .format = FG_R32F, .layers = LAYERS });
    const fg_pass_desc one = {
        .name = "layers",
        .writes = { { to } },
        .run = draw_layers,
    };
    fg_passes(g, &one, 1);
    fg_export(g, to);
    run(g);
    glGetTextureImage(fg_graph_exported(g, to), 0, GL_RED, GL_FLOAT, sizeof got, got);
    static const float expected[LAYERS] = { 10, 20 };
    for (int i = 0; i < W * H * LAYERS; ++i)
        assert_true(got[i] == expected[i / (W * H)]);
    fg_graph_destroy(g);
}

static void one_layer_is_attached_alone(void **state)
{
    enum { FACES = 6, SIDE = 8 };
    float got[SIDE * SIDE * FACES];
    pass draw = { 0 };
    fg_graph *g = open_graph(*state, 0, 0);
    begin(g);
    const fg_tex_desc desc = { .format = FG_R32F, .width = SIDE, .height = SIDE, .cube = true };
    draw.to = fg_texture(g, "cube", &desc);
    const fg_pass_desc one = {
        .name = "face",
        .writes = { { draw.to, .layer = 3, .layers = 1 } },
        .run = draw_cells,
        .user = &draw,
    };
    fg_passes(g, &one, 1);
    fg_export(g, draw.to);
    run(g);
    glGetTextureImage(fg_graph_exported(g, draw.to), 0, GL_RED, GL_FLOAT, sizeof got, got);
    for (int i = 0; i < SIDE * SIDE * FACES; ++i) {
        const int texel = i % (SIDE * SIDE);
        const float number = cell_of(texel, SIDE);
        assert_true(got[i] == (i / (SIDE * SIDE) == 3 ? number : 0.0f));
    }
    fg_graph_destroy(g);
}

static fg_status store_layers(const fg_run *run, void *user)
{
    const pass *p = user;
    const fg_status status = use_program(run, &(fg_gl_program_desc){ { &layers_comp } });
    fg_gl_image(run, 0, p->to, 0, GL_WRITE_ONLY, FG_R32F);
    glDispatchCompute(2, 2, 3);
    return status;
}

static void image_of_an_array_has_all_layers(void **state)
{
    float got[8 * 8 * 3];
    pass store = { 0 };
    fg_graph *g = open_graph(*state, FG_DEBUG_POISON, 0);
    begin(g);
    const fg_tex_desc desc = { .format = FG_R32F, .width = 8, .height = 8, .layers = 3 };
    store.to = fg_texture(g, "array", &desc);
    const fg_pass_desc one = {
        .name = "store",
        .kind = FG_KIND_COMPUTE,
        .writes = { { store.to, .load = FG_LOAD_DISCARD } },
        .run = store_layers,
        .user = &store,
    };
    fg_passes(g, &one, 1);
    fg_export(g, store.to);
    run(g);
    glGetTextureImage(fg_graph_exported(g, store.to), 0, GL_RED, GL_FLOAT, sizeof got, got);
    for (int i = 0; i < 8 * 8 * 3; ++i)
        assert_true(got[i] == (i < 64 ? 100.0f : i < 128 ? 200.0f : 300.0f));
    fg_graph_destroy(g);
}

// ---- samplers ---------------------------------------------------------------------

static fg_status compare_depth(const fg_run *run, void *user)
{
    const pass *p = user;
    const fg_status status = use_program(run, &(fg_gl_program_desc){ { &shadow_comp } });
    fg_gl_sample(run, 0, p->from, FG_GL_SHADOW);
    fg_gl_storage(run, 0, p->to);
    glDispatchCompute(1, 1, 1);
    return status;
}

static void shadow_filter_lights_what_is_nearer(void **state)
{
    float got[2] = { -1, -1 };
    pass draw = { 0 }, compare = { 0 };
    fg_graph *g = open_graph(*state, FG_DEBUG_POISON, 0);
    begin(g);
    const fg_res color = cells_texture(g, "colour");
    compare.from = fg_texture(g, "shadow", &(fg_tex_desc){ .format = FG_DEPTH32F });
    compare.to = fg_buffer(g, "result", &(fg_buf_desc){ .size = 8 });
    const fg_pass_desc passes[] = {
        { .name = "draw",
          .writes = { { color }, { compare.from, FG_USE_DEPTH } },
          .run = draw_cells,
          .user = &draw },
        { .name = "compare",
          .kind = FG_KIND_COMPUTE,
          .reads = { { compare.from } },
          .writes = { { compare.to, .load = FG_LOAD_DISCARD } },
          .run = compare_depth,
          .user = &compare },
    };
    fg_passes(g, passes, FG_COUNT(passes));
    fg_export(g, compare.to);
    run(g);
    glGetNamedBufferSubData(fg_graph_exported(g, compare.to), 0, sizeof got, got);
    assert_true(got[0] == 1.0f); // nearer than 0.5 in the map
    assert_true(got[1] == 0.0f);
    fg_graph_destroy(g);
}

// ---- history ----------------------------------------------------------------------

static fg_status add_one(const fg_run *run, void *user)
{
    const pass *p = user;
    glCopyNamedBufferSubData(fg_run_object(run, p->from), fg_run_object(run, p->to), 0, 0, 4);
    const fg_status status = use_program(run, &(fg_gl_program_desc){ { &count_comp } });
    fg_gl_storage(run, 0, p->to);
    glDispatchCompute(1, 1, 1);
    return status;
}

static void history_carries_a_count_from_frame_to_frame(void **state)
{
    pass p = { 0 };
    fg_graph *g = open_graph(*state, FG_DEBUG_POISON, 0);
    for (int frame = 1; frame <= 5; ++frame) {
        uint32_t count = 0;
        begin(g);
        p.to = fg_buffer(g, "count", &(fg_buf_desc){ .size = 4, .history = FG_HISTORY_CLEAR });
        p.from = fg_last_frame(g, p.to);
        const fg_pass_desc one = {
            .name = "count",
            .kind = FG_KIND_COMPUTE,
            .reads = { { p.from, FG_USE_COPY } },
            .writes = { { p.to, .load = FG_LOAD_DISCARD } },
            .run = add_one,
            .user = &p,
        };
        fg_passes(g, &one, 1);
        fg_export(g, p.to);
        run(g);
        glGetNamedBufferSubData(fg_graph_exported(g, p.to), 0, sizeof count, &count);
        assert_int_equal(count, frame);
    }
    fg_graph_destroy(g);
}

// ---- what the host owns -------------------------------------------------------------

static uint32_t host_texture(void)
{
    uint32_t texture;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, GL_R32F, W, H);
    return texture;
}

// Names come again on some drivers: a framebuffer that outlives its texture would be found.
static void forgotten_import_takes_its_framebuffer_along(void **state)
{
    fixture *f = *state;
    float got[W * H];
    fg_graph *g = open_graph(f, 0, 0);
    for (int round = 0; round < 3; ++round) {
        pass draw = { 0 };
        const uint32_t texture = host_texture();
        begin(g);
        const fg_tex_desc desc = { .format = FG_R32F, .width = W, .height = H };
        draw.to = fg_next(fg_import_texture(g, "host", &desc, texture));
        const fg_pass_desc one = {
            .name = "draw",
            .writes = { { draw.to, .load = FG_LOAD_DISCARD } },
            .run = draw_cells,
            .user = &draw,
        };
        fg_passes(g, &one, 1);
        run(g);
        read_floats(texture, got, W * H);
        for (int i = 0; i < W * H; ++i)
            assert_true(got[i] == cell(i));
        count_deleted_framebuffers();
        fg_gl_forget_texture(f->device, texture);
        assert_int_equal(deleted_framebuffers(), 1);
        glDeleteTextures(1, &texture);
    }
    fg_graph_destroy(g);
}

// ---- a lost context -------------------------------------------------------------------

static GLenum GLAPIENTRY context_is_lost(void)
{
    return GL_GUILTY_CONTEXT_RESET;
}

static void lost_context_ends_the_frame_and_all_that_follow(void **state)
{
    fixture *f = *state;
    pass store = { 0 };
    fg_graph *g = open_graph(f, 0, 0);
    begin(g);
    store.to = cells_texture(g, "cells");
    const fg_pass_desc one = {
        .name = "store",
        .kind = FG_KIND_COMPUTE,
        .writes = { { store.to, .load = FG_LOAD_DISCARD } },
        .run = store_cells,
        .user = &store,
    };
    fg_passes(g, &one, 1);
    fg_export(g, store.to);
    run(g);
    const PFNGLGETGRAPHICSRESETSTATUSPROC status = epoxy_glGetGraphicsResetStatus;
    epoxy_glGetGraphicsResetStatus = context_is_lost;
    assert_int_equal(fg_graph_run(g), FG_ERR_DEVICE);
    epoxy_glGetGraphicsResetStatus = status;
    log_takes(f, "gl device: the context is lost (0x8253)");
    assert_int_equal(fg_graph_run(g), FG_ERR_DEVICE);
    assert_int_equal(fg_gl_finish(f->device), FG_ERR_DEVICE);
    f->said[0] = '\0'; // what the graph says of it is its own matter
    fg_graph_destroy(g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define TEST(f) cmocka_unit_test_setup_teardown(f, open_gl, close_gl)
        TEST(raster_pass_writes_exact_values),
        TEST(compute_pass_writes_exact_values),
        TEST(pass_inherits_no_state),
        TEST(nearer_depth_is_greater),
        TEST(read_only_depth_is_tested_and_not_written),
        TEST(image_to_sampler_to_indirect_dispatch_is_ordered),
        TEST(mip_chain_by_successive_passes_sums_up),
        TEST(layered_attachment_has_all_layers),
        TEST(one_layer_is_attached_alone),
        TEST(image_of_an_array_has_all_layers),
        TEST(shadow_filter_lights_what_is_nearer),
        TEST(history_carries_a_count_from_frame_to_frame),
        TEST(forgotten_import_takes_its_framebuffer_along),
        TEST(lost_context_ends_the_frame_and_all_that_follow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
