// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "count_comp.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static fg_status nothing(const fg_run *run, void *user)
{
    (void) run, (void) user;
    return FG_OK;
}

static fg_status clear_texture(const fg_run *run, void *user)
{
    const uint32_t texture = fg_run_object(run, *(const fg_res *) user);
    glClearTexImage(texture, 0, GL_RED, GL_FLOAT, NULL);
    return FG_OK;
}

// Declares `count` passes named PREFIX.0, PREFIX.1, ...
static void declare(fg_graph *g, const char *prefix, int count)
{
    char name[32];
    fg_graph_begin(g, &(fg_frame_desc){ .width = 8, .height = 8 });
    for (int i = 0; i < count; ++i) {
        snprintf(name, sizeof name, "%s.%d", prefix, i);
        const fg_pass_desc one = {
            .name = name,
            .kind = FG_KIND_COMPUTE,
            .run = nothing,
            .effect = FG_EFFECT_EXTERNAL,
        };
        fg_passes(g, &one, 1);
    }
    assert_int_equal(fg_graph_compile(g), FG_OK);
}

static void run(fg_graph *g, int frames)
{
    for (int i = 0; i < frames; ++i)
        assert_int_equal(fg_graph_run(g), FG_OK);
}

static void timings_come_back_with_their_names(void **state)
{
    fixture *f = *state;
    fg_graph *g = open_graph(f, 0, 0);
    declare(g, "first", 3);
    run(g, 3);
    assert_int_equal(fg_gl_finish(f->device), FG_OK);
    for (int i = 0; i < 3; ++i) {
        fg_timing t;
        char name[32];
        snprintf(name, sizeof name, "first.%d", i);
        assert_true(fg_graph_timing(g, i, &t));
        assert_string_equal(t.pass, name);
        assert_true(t.gpu_ms >= 0.0 && t.gpu_ms < 1000.0);
        assert_true(t.gpu_start_ms >= 0.0 && t.gpu_start_ms < 1000.0);
        assert_true(i > 0 || t.gpu_start_ms == 0.0);
        assert_int_equal(t.frame, 2); // the newest
    }
    fg_graph_destroy(g);
}

static void timings_of_a_new_declaration_are_its_own(void **state)
{
    fixture *f = *state;
    fg_graph *g = open_graph(f, 0, 0);
    fg_timing t;
    declare(g, "first", 3);
    run(g, 2);
    assert_int_equal(fg_gl_finish(f->device), FG_OK);
    assert_true(fg_graph_timing(g, 0, &t));
    assert_true(t.gpu_ms >= 0.0);
    declare(g, "second", 2);
    assert_true(fg_graph_timing(g, 0, &t));
    assert_string_equal(t.pass, "second.0");
    assert_true(t.gpu_ms < 0.0); // none has come back: not what "first.0" took
    run(g, 1);
    assert_int_equal(fg_gl_finish(f->device), FG_OK);
    assert_true(fg_graph_timing(g, 1, &t));
    assert_string_equal(t.pass, "second.1");
    assert_true(t.gpu_ms >= 0.0);
    assert_int_equal(t.frame, 2);
    assert_false(fg_graph_timing(g, 2, &t));
    fg_graph_destroy(g);
}

static void more_passes_than_before_are_all_timed(void **state)
{
    fixture *f = *state;
    fg_graph *g = open_graph(f, 0, 0);
    declare(g, "few", 2);
    run(g, 1);
    declare(g, "many", 100); // beyond the first size of the ring
    run(g, 2);
    assert_int_equal(fg_gl_finish(f->device), FG_OK);
    for (int i = 0; i < 100; ++i) {
        fg_timing t;
        assert_true(fg_graph_timing(g, i, &t));
        assert_true(t.gpu_ms >= 0.0);
    }
    fg_graph_destroy(g);
}

static void timings_come_without_waiting_within_some_frames(void **state)
{
    // Nothing but frames: no finish, no read back. On a GPU results lag by a few frames; the
    // bound leaves room for a machine that does other things.
    fixture *f = *state;
    fg_graph *g = open_graph(f, 0, 0);
    fg_timing t = { .gpu_ms = -1.0 };
    fg_graph_begin(g, &(fg_frame_desc){ .width = 64, .height = 64 });
    fg_res texture = fg_texture(g, "t", &(fg_tex_desc){ .format = FG_R32F });
    const fg_pass_desc one = {
        .name = "clear",
        .kind = FG_KIND_COMPUTE,
        .writes = { { texture, .load = FG_LOAD_DISCARD } },
        .run = clear_texture,
        .user = &texture,
    };
    fg_passes(g, &one, 1);
    fg_export(g, texture);
    assert_int_equal(fg_graph_compile(g), FG_OK);
    int frames = 0;
    for (; frames < 100000 && t.gpu_ms < 0.0; ++frames) {
        run(g, 1);
        assert_true(fg_graph_timing(g, 0, &t));
    }
    assert_true(t.gpu_ms >= 0.0);
    assert_true(frames > 1); // never in the frame itself
    fg_graph_destroy(g);
}

// ---- a GPU that lags --------------------------------------------------------------------

static int asked; // results asked for
static bool lagging;
static PFNGLGETQUERYOBJECTUI64VPROC real_result;
static PFNGLGETQUERYOBJECTUIVPROC real_available;

static void GLAPIENTRY counting_result(GLuint query, GLenum name, GLuint64 *value)
{
    ++asked;
    real_result(query, name, value);
}

static void GLAPIENTRY available_unless_lagging(GLuint query, GLenum name, GLuint *value)
{
    real_available(query, name, value);
    if (lagging)
        *value = 0;
}

static void no_result_is_asked_for_before_it_is_there(void **state)
{
    fixture *f = *state;
    fg_graph *g = open_graph(f, 0, 0);
    fg_timing t;
    declare(g, "pass", 2);
    run(g, 1);
    assert_int_equal(fg_gl_finish(f->device), FG_OK); // resolves the entry points
    real_result = epoxy_glGetQueryObjectui64v;
    real_available = epoxy_glGetQueryObjectuiv;
    epoxy_glGetQueryObjectui64v = counting_result;
    epoxy_glGetQueryObjectuiv = available_unless_lagging;
    asked = 0;
    lagging = true;
    run(g, 50); // more frames than the ring holds
    assert_int_equal(asked, 0);
    assert_true(fg_graph_timing(g, 1, &t));
    assert_int_equal(t.frame, 0);
    lagging = false;
    assert_int_equal(fg_gl_finish(f->device), FG_OK); // what lagged is there for sure
    run(g, 1);
    assert_int_equal(fg_gl_finish(f->device), FG_OK);
    epoxy_glGetQueryObjectui64v = real_result;
    epoxy_glGetQueryObjectuiv = real_available;
    assert_true(asked > 0);
    assert_true(fg_graph_timing(g, 1, &t));
    assert_string_equal(t.pass, "pass.1");
    assert_int_equal(t.frame, 51); // those before went untimed when the ring was full
    fg_graph_destroy(g);
}

// ---- when, by the CPU's clock -----------------------------------------------------------

static int64_t monotonic(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t) t.tv_sec * 1000000000 + t.tv_nsec;
}

// Each frame lies within what the CPU saw of it, but for what two clocks that were set once drift
// apart in a test: 100 millionths, a bad quartz, of 10 s are 1 ms. With the results of a query
// meant for a buffer of the host's, as well.
static void frames_lie_where_the_cpu_saw_them(void **state)
{
    enum { FRAMES = 5, PASSES = 3, SLACK = 1000000 };
    fixture *f = *state;
    fg_graph *g = open_graph(f, 0, 0);
    const fg_device_ops *ops = f->device->ops;
    int64_t from[FRAMES], to[FRAMES], begin, end;
    GLuint buffer;
    glCreateBuffers(1, &buffer);
    glNamedBufferStorage(buffer, 4096, NULL, 0);
    declare(g, "pass", PASSES);
    for (int i = 0; i < FRAMES; ++i) {
        from[i] = monotonic();
        run(g, 1);
        glBindBuffer(GL_QUERY_BUFFER, buffer);
        assert_int_equal(fg_gl_finish(f->device), FG_OK);
        to[i] = monotonic();
    }
    for (uint64_t i = 0; i < FRAMES; ++i) {
        int64_t before = from[i] - SLACK;
        for (int k = 0; k < PASSES; ++k) {
            assert_true(ops->time_of(f->device, k, i, &begin, &end));
            assert_true(before <= begin && begin <= end && end <= to[i] + SLACK);
            before = end;
        }
        assert_false(ops->time_of(f->device, PASSES, i, &begin, &end));
    }
    assert_false(ops->time_of(f->device, 0, FRAMES, &begin, &end)); // has not run
    run(g, 20);
    assert_int_equal(fg_gl_finish(f->device), FG_OK);
    assert_false(ops->time_of(f->device, 0, 0, &begin, &end)); // too long ago
    declare(g, "other", PASSES);
    run(g, 1);
    assert_false(ops->time_of(f->device, 0, 20, &begin, &end)); // of the graph before
    glDeleteBuffers(1, &buffer);
    fg_graph_destroy(g);
}

// ---- a software renderer --------------------------------------------------------------------

static fg_status count_long(const fg_run *run, void *user)
{
    const fg_status status = use_program(run, &(fg_gl_program_desc){ { &count_comp } });
    if (status)
        return status;
    fg_gl_storage(run, 0, *(const fg_res *) user);
    glDispatchCompute(4000, 50, 1);
    return FG_OK;
}

// 200 000 invocations on one counter take their time on any machine: more than the empty pass
// before them, and most of the frame's.
static void compute_passes_take_time(void **state)
{
    (void) state;
    fixture f;
    fixture_open(&f, NULL);
    fg_graph *g = open_graph(&f, 0, 0);
    fg_graph_begin(g, &(fg_frame_desc){ .width = 8, .height = 8 });
    fg_res counter = fg_buffer(g, "counter", &(fg_buf_desc){ .size = 16 });
    const fg_pass_desc passes[] = {
        { .name = "empty", .kind = FG_KIND_COMPUTE, .run = nothing, .effect = FG_EFFECT_EXTERNAL },
        { .name = "long",
          .kind = FG_KIND_COMPUTE,
          .writes = { { counter } },
          .run = count_long,
          .user = &counter,
          .effect = FG_EFFECT_EXTERNAL },
    };
    fg_passes(g, passes, FG_COUNT(passes));
    assert_int_equal(fg_graph_compile(g), FG_OK);
    fg_timing empty, longer;
    run(g, 3);
    assert_int_equal(fg_gl_finish(f.device), FG_OK);
    assert_true(fg_graph_timing(g, 0, &empty));
    assert_true(fg_graph_timing(g, 1, &longer));
    assert_true(empty.gpu_ms >= 0 && longer.gpu_ms > empty.gpu_ms);
    assert_true(longer.gpu_start_ms >= empty.gpu_ms);
    if (fg_gl_software(f.device))
        assert_true(longer.gpu_ms > 0.1); // 200 000 atomic additions: 0.5 ns each is out of reach
    fg_graph_destroy(g);
    fixture_close(&f);
}

static int open_timestamps(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    fixture_open(f, &(fg_gl_device_desc){ .timestamps = true });
    *state = f;
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define TEST(f) cmocka_unit_test_setup_teardown(f, open_timestamps, close_gl)
        TEST(timings_come_back_with_their_names),
        TEST(timings_of_a_new_declaration_are_its_own),
        TEST(more_passes_than_before_are_all_timed),
        TEST(timings_come_without_waiting_within_some_frames),
        TEST(no_result_is_asked_for_before_it_is_there),
        TEST(frames_lie_where_the_cpu_saw_them),
        cmocka_unit_test(compute_passes_take_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
