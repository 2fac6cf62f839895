// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>

#include "cells_comp.h"
#include "fullscreen_vert.h"
#include "step_comp.h"
#include "step_frag.h"
#include "sum_comp.h"

// Two chains of passes, raster and compute in turn, in two formats that share memory through
// views; their ends are subtracted. Any texel read from the wrong texture changes the picture.

enum { W = 37, H = 29, LINKS = 8 };

typedef struct link {
    fg_res from, other, to;
    bool from_uint, to_uint, raster;
} link;

typedef struct chains {
    link links[2][LINKS];
    link sum;
} chains;

static fg_status run_first(const fg_run *run, void *user)
{
    const link *l = user;
    const fg_status status = use_program(run, &(fg_gl_program_desc){ { &cells_comp }, "SEED=5" });
    fg_gl_image(run, 0, l->to, 0, GL_WRITE_ONLY, FG_R32F);
    fg_gl_dispatch_2d(W, H, 8, 8);
    return status;
}

static fg_status run_link(const fg_run *run, void *user)
{
    static const char *const defines[2][2] = { { "", "TO_UINT" },
                                               { "FROM_UINT", "FROM_UINT;TO_UINT" } };
    const link *l = user;
    const fg_gl_program_desc raster = { { &fullscreen_vert, &step_frag },
                                        defines[l->from_uint][l->to_uint] };
    const fg_gl_program_desc compute = { { &step_comp }, defines[l->from_uint][l->to_uint] };
    const fg_status status = use_program(run, l->raster ? &raster : &compute);
    fg_gl_sample(run, 0, l->from, FG_GL_NEAREST);
    if (l->raster) {
        fg_gl_fullscreen(run);
    } else {
        fg_gl_image(run, 0, l->to, 0, GL_WRITE_ONLY, l->to_uint ? FG_R32UI : FG_R32F);
        fg_gl_dispatch_2d(W, H, 8, 8);
    }
    return status;
}

static fg_status run_sum(const fg_run *run, void *user)
{
    const link *l = user;
    const fg_status status = use_program(run, &(fg_gl_program_desc){ { &sum_comp } });
    fg_gl_sample(run, 0, l->from, FG_GL_NEAREST);
    fg_gl_sample(run, 1, l->other, FG_GL_NEAREST);
    fg_gl_image(run, 0, l->to, 0, GL_WRITE_ONLY, FG_R32F);
    fg_gl_dispatch_2d(W, H, 8, 8);
    return status;
}

static fg_res texture(fg_graph *g, const char *name, bool is_uint)
{
    return fg_texture(g, name, &(fg_tex_desc){ .format = is_uint ? FG_R32UI : FG_R32F });
}

static void declare_chain(fg_graph *g, link links[LINKS], char letter, int first)
{
    for (int i = 0; i < LINKS; ++i) {
        char name[16];
        link *l = &links[i];
        *l = (link){ .raster = (i + first) % 2, .to_uint = i % 3 == 1 && i < LINKS - 1 };
        if (i) {
            l->from = links[i - 1].to;
            l->from_uint = links[i - 1].to_uint;
        } else {
            l->raster = false;
        }
        snprintf(name, sizeof name, "%c.%d", letter, i);
        l->to = texture(g, name, l->to_uint);
        const fg_pass_desc one = {
            .name = name,
            .kind = l->raster ? FG_KIND_RASTER : FG_KIND_COMPUTE,
            .reads = { { l->from } },
            .writes = { { l->to, .load = FG_LOAD_DISCARD } },
            .run = i ? run_link : run_first,
            .user = l,
        };
        fg_passes(g, &one, 1);
    }
}

static void declare(fg_graph *g, chains *c)
{
    fg_graph_begin(g, &(fg_frame_desc){ .width = W, .height = H });
    declare_chain(g, c->links[0], 'a', 0);
    declare_chain(g, c->links[1], 'b', 1);
    c->sum = (link){ .from = c->links[0][LINKS - 1].to, .other = c->links[1][LINKS - 2].to };
    c->sum.to = texture(g, "sum", false);
    const fg_pass_desc sum = {
        .name = "sum",
        .kind = FG_KIND_COMPUTE,
        .reads = { { c->sum.from }, { c->sum.other } },
        .writes = { { c->sum.to, .load = FG_LOAD_DISCARD } },
        .run = run_sum,
        .user = &c->sum,
    };
    fg_passes(g, &sum, 1);
    fg_export(g, c->sum.to);
    assert_int_equal(fg_graph_compile(g), FG_OK);
}

// The same by hand.
static void expected_picture(float picture[W * H])
{
    static uint32_t rows[LINKS][W * H];
    for (int i = 0; i < W * H; ++i)
        rows[0][i] = (uint32_t) (i % W + 4096 * (i / W) + 5);
    for (int k = 1; k < LINKS; ++k)
        for (int i = 0; i < W * H; ++i)
            rows[k][i] = (3 * rows[k - 1][i / W * W + (i % W + 1) % W] + 1) & 0xffff;
    for (int i = 0; i < W * H; ++i)
        picture[i] = (float) rows[LINKS - 1][i] - 2.0f * (float) rows[LINKS - 2][i];
}

static fg_graph_stats render(fixture *f, unsigned debug, uint64_t seed, float picture[W * H])
{
    chains c;
    fg_graph *g = open_graph(f, debug, seed);
    declare(g, &c);
    for (int frame = 0; frame < 2; ++frame)
        assert_int_equal(fg_graph_run(g), FG_OK);
    read_floats(fg_graph_exported(g, c.sum.to), picture, W * H);
    const fg_graph_stats stats = fg_graph_get_stats(g);
    fg_graph_destroy(g);
    return stats;
}

static void memory_shared_through_views_shows_the_right_picture(void **state)
{
    static float expected[W * H], got[W * H];
    expected_picture(expected);
    const fg_graph_stats shared = render(*state, FG_DEBUG_POISON, 0, got);
    assert_memory_equal(got, expected, sizeof got);
    assert_true(shared.transient_bytes < shared.unshared_bytes); // it did share
    const fg_graph_stats apart = render(*state, FG_DEBUG_NO_SHARING, 0, got);
    assert_memory_equal(got, expected, sizeof got);
    assert_true(apart.transient_bytes == apart.unshared_bytes);
}

static void every_legal_order_gives_the_same_picture(void **state)
{
    static float expected[W * H], got[W * H];
    expected_picture(expected);
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        render(*state, FG_DEBUG_RANDOM_ORDER | FG_DEBUG_POISON, seed, got);
        assert_memory_equal(got, expected, sizeof got);
    }
}

// ---- objects come and go --------------------------------------------------------------

// GL objects that were created and not deleted, counted at libepoxy's entry points.
static int live, created;

#define COUNTED(noun, NOUN)                                                                        \
    static PFNGLGEN##NOUN##PROC real_gen_##noun;                                                   \
    static PFNGLDELETE##NOUN##PROC real_delete_##noun;                                             \
    static void GLAPIENTRY gen_##noun(GLsizei n, GLuint *names)                                    \
    {                                                                                              \
        real_gen_##noun(n, names);                                                                 \
        live += n;                                                                                 \
        created += n;                                                                              \
    }                                                                                              \
    static void GLAPIENTRY delete_##noun(GLsizei n, const GLuint *names)                           \
    {                                                                                              \
        for (GLsizei i = 0; i < n; ++i)                                                            \
            live -= names[i] != 0;                                                                 \
        real_delete_##noun(n, names);                                                              \
    }

#define COUNTED_CREATE(noun, NOUN)                                                                 \
    static PFNGLCREATE##NOUN##PROC real_create_##noun;                                             \
    static void GLAPIENTRY create_##noun(GLsizei n, GLuint *names)                                 \
    {                                                                                              \
        real_create_##noun(n, names);                                                              \
        live += n;                                                                                 \
        created += n;                                                                              \
    }

#define COUNTED_TARGET(noun, NOUN)                                                                 \
    static PFNGLCREATE##NOUN##PROC real_create_##noun;                                             \
    static void GLAPIENTRY create_##noun(GLenum target, GLsizei n, GLuint *names)                  \
    {                                                                                              \
        real_create_##noun(target, n, names);                                                      \
        live += n;                                                                                 \
        created += n;                                                                              \
    }

COUNTED(textures, TEXTURES)
COUNTED(buffers, BUFFERS)
COUNTED(framebuffers, FRAMEBUFFERS)
COUNTED(queries, QUERIES)
COUNTED(samplers, SAMPLERS)
COUNTED(arrays, VERTEXARRAYS)
COUNTED_TARGET(textures, TEXTURES)
COUNTED_TARGET(queries, QUERIES)
COUNTED_CREATE(buffers, BUFFERS)
COUNTED_CREATE(framebuffers, FRAMEBUFFERS)
COUNTED_CREATE(samplers, SAMPLERS)
COUNTED_CREATE(arrays, VERTEXARRAYS)

static PFNGLCREATEPROGRAMPROC real_create_program;
static PFNGLDELETEPROGRAMPROC real_delete_program;
static PFNGLCREATESHADERPROC real_create_shader;
static PFNGLDELETESHADERPROC real_delete_shader;

static GLuint GLAPIENTRY create_program(void)
{
    ++live, ++created;
    return real_create_program();
}

static void GLAPIENTRY delete_program(GLuint name)
{
    live -= name != 0;
    real_delete_program(name);
}

static GLuint GLAPIENTRY create_shader(GLenum stage)
{
    ++live, ++created;
    return real_create_shader(stage);
}

static void GLAPIENTRY delete_shader(GLuint name)
{
    live -= name != 0;
    real_delete_shader(name);
}

// Counts from here on. libepoxy's pointers first point at what finds the real ones and then
// overwrites them, so each is called once before.
static void count_objects(void)
{
    GLuint name;
#define RESOLVE(Noun)                                                                              \
    glGen##Noun(1, &name);                                                                         \
    glDelete##Noun(1, &name)
#define HOOK(noun, Noun)                                                                           \
    real_gen_##noun = epoxy_glGen##Noun;                                                           \
    real_delete_##noun = epoxy_glDelete##Noun;                                                     \
    real_create_##noun = epoxy_glCreate##Noun;                                                     \
    epoxy_glGen##Noun = gen_##noun;                                                                \
    epoxy_glDelete##Noun = delete_##noun;                                                          \
    epoxy_glCreate##Noun = create_##noun
    RESOLVE(Textures);
    RESOLVE(Buffers);
    RESOLVE(Framebuffers);
    RESOLVE(Queries);
    RESOLVE(Samplers);
    RESOLVE(VertexArrays);
    HOOK(textures, Textures);
    HOOK(buffers, Buffers);
    HOOK(framebuffers, Framebuffers);
    HOOK(queries, Queries);
    HOOK(samplers, Samplers);
    HOOK(arrays, VertexArrays);
    real_create_program = epoxy_glCreateProgram;
    real_delete_program = epoxy_glDeleteProgram;
    real_create_shader = epoxy_glCreateShader;
    real_delete_shader = epoxy_glDeleteShader;
    epoxy_glCreateProgram = create_program;
    epoxy_glDeleteProgram = delete_program;
    epoxy_glCreateShader = create_shader;
    epoxy_glDeleteShader = delete_shader;
    live = created = 0;
}

static void stop_counting(void)
{
#define UNHOOK(noun, Noun)                                                                         \
    epoxy_glGen##Noun = real_gen_##noun;                                                           \
    epoxy_glDelete##Noun = real_delete_##noun;                                                     \
    epoxy_glCreate##Noun = real_create_##noun
    UNHOOK(textures, Textures);
    UNHOOK(buffers, Buffers);
    UNHOOK(framebuffers, Framebuffers);
    UNHOOK(queries, Queries);
    UNHOOK(samplers, Samplers);
    UNHOOK(arrays, VertexArrays);
    epoxy_glCreateProgram = real_create_program;
    epoxy_glDeleteProgram = real_delete_program;
    epoxy_glCreateShader = real_create_shader;
    epoxy_glDeleteShader = real_delete_shader;
}

static void every_object_made_is_deleted(void **state)
{
    static float picture[W * H];
    fixture f, inner;
    (void) state;
    fixture_open(&f, NULL);
    render(&f, FG_DEBUG_POISON, 0, picture); // resolves every entry point
    const fg_gl_device_desc desc = { .log = &f.log };
    inner = f;
    count_objects();
    assert_int_equal(fg_gl_device_create(&desc, &inner.device), FG_OK);
    render(&inner, FG_DEBUG_POISON, 0, picture);
    assert_true(live > 0); // the counters do count: programs and timers are the device's
    fg_device_destroy(inner.device);
    stop_counting();
    assert_true(created > 40);
    assert_int_equal(live, 0);
    fixture_close(&f);
}

static void steady_frames_create_nothing(void **state)
{
    fixture *f = *state;
    chains c;
    fg_graph *g = open_graph(f, 0, 0);
    declare(g, &c);
    assert_int_equal(fg_graph_run(g), FG_OK);
    count_objects();
    for (int frame = 0; frame < 10; ++frame) {
        declare(g, &c); // an equal declaration
        assert_int_equal(fg_graph_run(g), FG_OK);
    }
    stop_counting();
    assert_int_equal(created, 0);
    assert_int_equal(live, 0);
    fg_graph_destroy(g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define TEST(f) cmocka_unit_test_setup_teardown(f, open_gl, close_gl)
        TEST(memory_shared_through_views_shows_the_right_picture),
        TEST(every_legal_order_gives_the_same_picture),
        cmocka_unit_test(every_object_made_is_deleted),
        TEST(steady_frames_create_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
