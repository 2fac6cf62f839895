// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <epoxy/egl.h>
#include <stdio.h>

static void keep_last(void *user, fg_log_level level, const char *msg)
{
    (void) level;
    snprintf(user, 1024, "%s", msg);
}

static int devices(void)
{
    fg_gl_device_info info;
    int n = 0;
    while (fg_gl_get_device_info(n + 1, &info))
        ++n;
    return n;
}

static void some_listed_device_gives_opengl_45(void **state)
{
    fg_gl_device_info info;
    int usable = 0;
    (void) state;
    for (int n = 1; fg_gl_get_device_info(n, &info); ++n) {
        assert_true(strlen(info.name) > 0);
        usable += info.renderer[0] && info.version[0] == '4';
    }
    assert_true(usable > 0);
}

static void info_past_the_end_is_false(void **state)
{
    fg_gl_device_info info;
    (void) state;
    assert_false(fg_gl_get_device_info(0, &info));
    assert_false(fg_gl_get_device_info(-1, &info));
    assert_false(fg_gl_get_device_info(devices() + 1, &info));
    assert_string_equal(info.renderer, "");
}

static void listing_leaves_the_current_context(void **state)
{
    fg_gl_context *ctx;
    fg_gl_device_info info;
    (void) state;
    assert_int_equal(fg_gl_context_create(NULL, &ctx), FG_OK);
    const EGLContext before = eglGetCurrentContext();
    assert_true(before != EGL_NO_CONTEXT);
    assert_true(fg_gl_get_device_info(1, &info));
    assert_true(eglGetCurrentContext() == before);
    assert_int_equal(glGetError(), GL_NO_ERROR);
    fg_gl_context_destroy(ctx);
    assert_true(eglGetCurrentContext() == EGL_NO_CONTEXT);
    assert_true(fg_gl_get_device_info(1, &info));
    assert_true(eglGetCurrentContext() == EGL_NO_CONTEXT);
}

static void each_usable_device_can_be_chosen(void **state)
{
    fg_gl_device_info info;
    (void) state;
    for (int n = 1; fg_gl_get_device_info(n, &info); ++n) {
        if (!info.renderer[0])
            continue;
        fg_gl_context *ctx;
        const fg_gl_context_desc desc = { .device = n };
        assert_int_equal(fg_gl_context_create(&desc, &ctx), FG_OK);
        assert_string_equal((const char *) glGetString(GL_RENDERER), info.renderer);
        fg_gl_context_destroy(ctx);
    }
}

static void device_out_of_range_is_refused_with_the_range(void **state)
{
    char said[1024] = "", expected[128];
    const fg_log log = { keep_last, said, FG_LOG_ERROR };
    const int past = devices() + 1;
    const fg_gl_context_desc desc = { .log = &log, .device = past };
    fg_gl_context *ctx = (fg_gl_context *) said;
    (void) state;
    assert_int_equal(fg_gl_context_create(&desc, &ctx), FG_ERR_INVALID);
    assert_null(ctx);
    snprintf(expected, sizeof expected, "gl context: device is %d, must be 0 (any) to %d", past,
             past - 1);
    assert_string_equal(said, expected);
}

static void device_without_a_context_is_refused(void **state)
{
    char said[1024] = "";
    const fg_log log = { keep_last, said, FG_LOG_ERROR };
    const fg_gl_device_desc desc = { .log = &log };
    fg_device *dev = (fg_device *) said;
    (void) state;
    assert_true(eglGetCurrentContext() == EGL_NO_CONTEXT);
    assert_int_equal(fg_gl_device_create(&desc, &dev), FG_ERR_UNSUPPORTED);
    assert_null(dev);
    assert_string_equal(said, "gl device: no OpenGL context is current");
}

static void two_contexts_take_turns(void **state)
{
    fg_gl_context *a, *b;
    (void) state;
    assert_int_equal(fg_gl_context_create(NULL, &a), FG_OK);
    const EGLContext first = eglGetCurrentContext();
    assert_int_equal(fg_gl_context_create(NULL, &b), FG_OK);
    assert_true(eglGetCurrentContext() != first);
    assert_int_equal(fg_gl_context_make_current(a), FG_OK);
    assert_true(eglGetCurrentContext() == first);
    fg_gl_context_destroy(b); // not the current one: that stays
    assert_true(eglGetCurrentContext() == first);
    fg_gl_context_destroy(a);
    fg_gl_context_destroy(NULL);
}

static void context_is_a_debug_context_when_asked(void **state)
{
    (void) state;
    for (int debug = 0; debug < 2; ++debug) {
        fg_gl_context *ctx;
        GLint flags = 0, profile = 0;
        const fg_gl_context_desc desc = { .debug = debug };
        assert_int_equal(fg_gl_context_create(&desc, &ctx), FG_OK);
        glGetIntegerv(GL_CONTEXT_FLAGS, &flags);
        glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
        assert_int_equal((flags & GL_CONTEXT_FLAG_DEBUG_BIT) != 0, debug);
        assert_int_equal(profile, GL_CONTEXT_CORE_PROFILE_BIT);
        fg_gl_context_destroy(ctx);
    }
}

static void twenty_contexts_come_and_go(void **state)
{
    (void) state;
    for (int i = 0; i < 20; ++i) {
        fixture f;
        fixture_open(&f, NULL);
        fixture_close(&f);
    }
}

static void a_gl_error_is_logged_and_counted(void **state)
{
    fixture f;
    (void) state;
    fixture_open(&f, NULL);
    glEnable(GL_ARRAY_BUFFER); // not a capability
    assert_int_equal(fg_gl_error_count(f.device), 1);
    log_takes(&f, "GL_INVALID_ENUM");
    assert_int_equal(glGetError(), GL_INVALID_ENUM);
    f.provoked = 1;
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(device_without_a_context_is_refused),
        cmocka_unit_test(some_listed_device_gives_opengl_45),
        cmocka_unit_test(info_past_the_end_is_false),
        cmocka_unit_test(listing_leaves_the_current_context),
        cmocka_unit_test(each_usable_device_can_be_chosen),
        cmocka_unit_test(device_out_of_range_is_refused_with_the_range),
        cmocka_unit_test(two_contexts_take_turns),
        cmocka_unit_test(context_is_a_debug_context_when_asked),
        cmocka_unit_test(twenty_contexts_come_and_go),
        cmocka_unit_test(a_gl_error_is_logged_and_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
