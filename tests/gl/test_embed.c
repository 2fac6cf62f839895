// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>

// Runs samples/embed/host_graph, whose path is HOST_GRAPH, and looks at what it leaves.

enum { SIDE = 128 };

static int run_host(const char *arguments, char *said, int size)
{
    char command[1024];
    snprintf(command, sizeof command, "'%s' %s 2>/dev/null", HOST_GRAPH, arguments);
    FILE *p = popen(command, "r");
    assert_non_null(p);
    const size_t length = fread(said, 1, (size_t) size - 1, p);
    said[length] = '\0';
    const int status = pclose(p);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static float glow(int x, int y)
{
    const float dx = ((float) x + 0.5f - 128.0f) / 32.0f, dy = ((float) y + 0.5f - 128.0f) / 32.0f;
    return 1.0f / (1.0f + dx * dx + dy * dy);
}

// The three passes at a pixel of the picture; `strength` is the channel's in glow.frag.
static float expected(int x, int y, float strength)
{
    float light = 0.0f;
    for (int i = 0; i < 4; ++i)
        light += strength * glow(2 * x + (i & 1), 2 * y + (i >> 1)) / 4.0f;
    const float c = light / (1.0f + light);
    return 255.0f * (c <= 0.0031308f ? 12.92f * c : 1.055f * powf(c, 1.0f / 2.4f) - 0.055f);
}

static void host_draws_the_picture_of_its_passes(void **state)
{
    static unsigned char rgb[SIDE * SIDE * 3];
    static const float strength[3] = { 8, 4, 1 };
    char folder[256], arguments[320], path[300], header[32] = "", said[256];
    (void) state;
    make_folder(folder);
    snprintf(path, sizeof path, "%s/out.ppm", folder);
    snprintf(arguments, sizeof arguments, "'%s'", path);
    assert_int_equal(run_host(arguments, said, sizeof said), 0);
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    assert_int_equal(fread(header, 1, 15, f), 15);
    assert_string_equal(header, "P6\n128 128\n255\n");
    assert_int_equal(fread(rgb, 1, sizeof rgb, f), sizeof rgb);
    assert_int_equal(fgetc(f), EOF);
    fclose(f);
    remove_folder(folder);
    for (int i = 0; i < SIDE * SIDE * 3; ++i) {
        // Half a step of rounding to 8 bits, and half a step for the encoding, which OpenGL
        // leaves to 0.6 steps; half floats (2^-11) move the result by 0.2 at most.
        const float want = expected(i / 3 % SIDE, i / 3 / SIDE, strength[i % 3]);
        if (fabsf((float) rgb[i] - want) > 1.3f)
            fail_msg("byte %d is %d, not %g", i, rgb[i], (double) want);
    }
}

static void host_says_what_was_left_out(void **state)
{
    char said[256];
    (void) state;
    assert_int_equal(run_host("/dev/null", said, sizeof said), 0);
    assert_int_equal(strncmp(said, "left out: unread: ", 18), 0);
}

static void wrong_usage_and_unwritable_file_have_their_codes(void **state)
{
    char said[256];
    (void) state;
    assert_int_equal(run_host("", said, sizeof said), 2);
    assert_int_equal(run_host("/nonexistent/out.ppm", said, sizeof said), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(host_draws_the_picture_of_its_passes),
        cmocka_unit_test(host_says_what_was_left_out),
        cmocka_unit_test(wrong_usage_and_unwritable_file_have_their_codes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
