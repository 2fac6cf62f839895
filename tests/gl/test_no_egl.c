// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>

// A machine with EGL's loader and no driver below it: the loader is told of one that is not there.

static void keep_last(void *user, fg_log_level level, const char *msg)
{
    (void) level;
    snprintf(user, 1024, "%s", msg);
}

static void machine_without_a_driver_is_refused_in_words(void **state)
{
    char said[1024] = "";
    const fg_log log = { keep_last, said, FG_LOG_ERROR };
    const fg_gl_context_desc desc = { .log = &log };
    fg_gl_context *ctx;
    fg_gl_device_info info;
    (void) state;
    assert_int_equal(fg_gl_context_create(&desc, &ctx), FG_ERR_UNSUPPORTED);
    assert_null(ctx);
    assert_non_null(strstr(said, "gl context: EGL gives no device: no driver is installed"));
    assert_false(fg_gl_get_device_info(1, &info));
}

static void device_without_a_driver_is_refused(void **state)
{
    char said[1024] = "";
    const fg_log log = { keep_last, said, FG_LOG_ERROR };
    const fg_gl_device_desc desc = { .log = &log };
    fg_device *dev;
    (void) state;
    assert_int_equal(fg_gl_device_create(&desc, &dev), FG_ERR_UNSUPPORTED);
    assert_string_equal(said, "gl device: no OpenGL context is current");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(machine_without_a_driver_is_refused_in_words),
        cmocka_unit_test(device_without_a_driver_is_refused),
    };
    setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
