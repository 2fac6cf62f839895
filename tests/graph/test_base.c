// SPDX-License-Identifier: MIT
// Status names, the log and the table of formats.
#include "rig.h"

#include <fg/format.h>
#include <stdio.h>

typedef struct heard {
    int calls;
    size_t length;
} heard;

static void hear(void *user, fg_log_level level, const char *msg)
{
    heard *h = user;
    (void) level;
    h->calls++;
    h->length = strlen(msg);
}

static void messages_above_the_level_are_dropped(void **state)
{
    (void) state;
    heard h = { 0 };
    const fg_log log = { hear, &h, FG_LOG_WARN };
    fg_logf(&log, FG_LOG_ERROR, "%s", "one");
    fg_logf(&log, FG_LOG_WARN, "two");
    fg_logf(&log, FG_LOG_INFO, "three");
    assert_int_equal(h.calls, 2);
    fg_logf(NULL, FG_LOG_ERROR, "nobody hears");
    fg_logf(&(fg_log){ 0 }, FG_LOG_ERROR, "nobody hears");
}

static void messages_are_cut_at_1023_bytes(void **state)
{
    (void) state;
    heard h = { 0 };
    const fg_log log = { hear, &h, FG_LOG_ERROR };
    fg_logf(&log, FG_LOG_ERROR, "%02000d", 7);
    assert_int_equal(h.length, 1023);
}

static void every_status_has_its_own_name(void **state)
{
    (void) state;
    for (int a = FG_OK; a <= FG_ERR_EMPTY; a++)
        for (int b = FG_OK; b < a; b++)
            assert_string_not_equal(fg_status_name((fg_status) a), fg_status_name((fg_status) b));
    assert_string_equal(fg_status_name((fg_status) 99), "unknown status");
}

static void formats_of_one_view_class_have_texels_of_one_size(void **state)
{
    (void) state;
    for (int a = 0; a < FG_FORMAT_COUNT; a++) {
        const fg_format_info *x = fg_format_get((fg_format) a);
        assert_non_null(x->name);
        assert_true(x->bytes > 0 && x->channels > 0);
        assert_true(x->depth != x->color);
        assert_true(!x->depth || (!x->image && !x->view_class));
        for (int b = 0; b < FG_FORMAT_COUNT; b++) {
            const fg_format_info *y = fg_format_get((fg_format) b);
            if (x->view_class && x->view_class == y->view_class)
                assert_int_equal(x->bytes, y->bytes);
        }
    }
    assert_null(fg_format_get(FG_FORMAT_COUNT));
    assert_null(fg_format_get((fg_format) -1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(messages_above_the_level_are_dropped),
        cmocka_unit_test(messages_are_cut_at_1023_bytes),
        cmocka_unit_test(every_status_has_its_own_name),
        cmocka_unit_test(formats_of_one_view_class_have_texels_of_one_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
