// SPDX-License-Identifier: MIT
// Traces of many frames, on a device whose clock the test sets.
#include "rig.h"

#include <fg/trace.h>
#include <math.h>
#include <time.h>

// A null device that says when passes ran on a GPU, of the last KEPT frames that have come back.
enum { KEPT = 3, PASS_NS = 1000 };
static struct {
    fg_device_ops ops;
    int64_t start;
    uint64_t newest; // frame that has come back, and one more
} fake;

static bool time_of(fg_device *dev, int timer, uint64_t frame, int64_t *begin, int64_t *end)
{
    (void) dev;
    if (frame >= fake.newest || frame + KEPT < fake.newest || timer > 1)
        return false;
    *begin = fake.start + (int64_t) frame * 1000000 + (int64_t) timer * 2 * PASS_NS;
    *end = *begin + PASS_NS;
    return true;
}

static fg_status nothing(const fg_run *run, void *user)
{
    (void) run, (void) user;
    return FG_OK;
}

static void declare(rig *r, const char *first)
{
    rig_begin(r);
    const fg_res a = rig_tex(r, "a");
    const fg_pass_desc passes[] = {
        { .name = first, .writes = { { a } }, .run = nothing },
        { .name = "show", .reads = { { a } }, .run = nothing, .effect = FG_EFFECT_EXTERNAL },
    };
    fg_passes(r->g, passes, FG_COUNT(passes));
    rig_must_compile(r);
}

static rig *open_rig(void)
{
    rig *r = rig_open(0);
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    fake.start = (int64_t) t.tv_sec * 1000000000 + t.tv_nsec;
    fake.newest = 0;
    fake.ops = *r->dev->ops;
    fake.ops.time_of = time_of;
    r->dev->ops = &fake.ops;
    return r;
}

static void take(fg_trace *t, char *out, size_t room)
{
    size_t size;
    const char *text = fg_trace_text(t, &size);
    assert_non_null(text);
    assert_int_equal(strlen(text), size);
    const size_t used = strlen(out);
    assert_true(used + size < room);
    memcpy(out + used, text, size + 1);
}

static void gpu_times_come_late_and_once(void **state)
{
    (void) state;
    static char text[65536];
    rig *r = open_rig();
    fg_trace *t = fg_trace_create(&(fg_trace_desc){ 0 });
    text[0] = '\0';
    declare(r, "draw");
    for (uint64_t frame = 0; frame < 6; ++frame) {
        fake.newest = frame > 1 ? frame - 1 : 0; // two frames late, first none, then one a frame
        rig_must_run(r);
        fg_trace_frame(t, r->g, "a");
        fg_trace_frame(t, r->g, "a"); // the same frame once more: nothing to add
        take(t, text, sizeof text);
    }
    assert_int_equal(rig_count(text, "\"tid\": 1, \"ts\""), 6 * 3 + 1); // with one mark
    assert_int_equal(rig_count(text, "\"tid\": 2, \"ts\""), 4 * 3);
    fake.newest = 6;
    fg_trace_frame(t, r->g, "a");
    fg_trace_end(t);
    fg_trace_frame(t, r->g, "a");
    take(t, text, sizeof text);
    assert_int_equal(rig_count(text, "\"tid\": 2, \"ts\""), 6 * 3);
    assert_int_equal(rig_count(text, "\"name\": \"frame 5\""), 2);
    assert_int_equal(rig_count(text, "\"ph\": \"i\""), 1);
    assert_string_equal(text + strlen(text) - 4, "\n]}\n");
    fg_trace_destroy(t);
    rig_close(r);
}

static void frames_under_way_at_a_compile_are_on_the_cpu_alone(void **state)
{
    (void) state;
    static char text[65536];
    rig *r = open_rig();
    fg_trace *t = fg_trace_create(&(fg_trace_desc){ 0 });
    text[0] = '\0';
    declare(r, "draw");
    rig_must_run(r);
    fg_trace_frame(t, r->g, "a");
    declare(r, "other");
    rig_must_run(r);
    fake.newest = 2; // what comes back now must not go by the new names
    fg_trace_frame(t, r->g, "b");
    take(t, text, sizeof text);
    assert_int_equal(rig_count(text, "\"draw\""), 1);
    assert_int_equal(rig_count(text, "\"other\""), 2);
    assert_non_null(strstr(text, "\"name\": \"a > b\", \"ph\": \"i\""));
    fg_trace_destroy(t);
    rig_close(r);
}

static void names_are_escaped_and_values_kept(void **state)
{
    (void) state;
    static char text[65536];
    rig *r = open_rig();
    fg_trace *t = fg_trace_create(&(fg_trace_desc){ .process = "a \"host\"" });
    text[0] = '\0';
    fg_trace_frame(t, r->g, "before anything has compiled");
    fg_trace_mark(t, "resized\n");
    fg_trace_count(t, "vpls", 0.1);
    fg_trace_count(t, "lost", HUGE_VAL); // not finite: JSON has no word for it
    take(t, text, sizeof text);
    assert_non_null(strstr(text, "\"a \\\"host\\\"\""));
    assert_non_null(strstr(text, "\"resized\\u000a\""));
    assert_non_null(strstr(text, "\"value\": 0.10000000000000001"));
    assert_null(strstr(text, "lost"));
    assert_null(strstr(text, "before"));
    fg_trace_destroy(t);
    rig_close(r);
}

static void *allocate(void *user, void *ptr, size_t size)
{
    int *left = user;
    if (size && (*left)-- <= 0)
        return NULL;
    if (size)
        return realloc(ptr, size);
    free(ptr);
    return NULL;
}

static void a_trace_without_memory_is_lost_and_says_so(void **state)
{
    (void) state;
    rig *r = open_rig();
    size_t size;
    for (int budget = 0; budget < 2; ++budget) {
        int left = budget;
        const fg_trace_desc desc = { .log = &r->log, .allocator = { allocate, &left } };
        fg_trace *t = fg_trace_create(&desc);
        assert_true(!t == (budget == 0));
        if (t)
            assert_null(fg_trace_text(t, &size));
        rig_must_have_said(r, "trace: out of memory");
        fg_trace_destroy(t);
    }
    fg_trace_destroy(NULL);
    rig_close(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gpu_times_come_late_and_once),
        cmocka_unit_test(frames_under_way_at_a_compile_are_on_the_cpu_alone),
        cmocka_unit_test(names_are_escaped_and_values_kept),
        cmocka_unit_test(a_trace_without_memory_is_lost_and_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
