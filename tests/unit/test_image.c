// SPDX-License-Identifier: MIT
#include "image.h"
#include "last_log.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "afterglow-image-XXXXXX";
static const fg_log logger = { .fn = remember, .level = FG_LOG_WARN };
static const char *const extensions[] = { "png", "exr", "pfm" };

static const char *in_folder(const char *name)
{
    static char path[2][512];
    static int turn;
    turn = !turn;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

static int files_in_folder(void)
{
    int count = 0;
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    for (const struct dirent *entry = readdir(dir); entry; entry = readdir(dir))
        count += entry->d_name[0] != '.';
    closedir(dir);
    return count;
}

static int make_folder(void **state)
{
    (void) state;
    strcpy(folder, "afterglow-image-XXXXXX");
    last[0] = 0;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void) state;
    DIR *dir = opendir(folder);
    for (const struct dirent *entry = readdir(dir); entry; entry = readdir(dir))
        if (entry->d_name[0] != '.')
            remove(in_folder(entry->d_name));
    closedir(dir);
    return rmdir(folder);
}

static void store(const char *path, const unsigned char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static unsigned char *load(const char *path, size_t *size)
{
    struct stat st;
    assert_int_equal(stat(path, &st), 0);
    *size = (size_t) st.st_size;
    unsigned char *bytes = malloc(*size);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

// Values from `low` to `high`.
static image ramp_of(int width, int height, float low, float high)
{
    image img;
    assert_int_equal(image_create(&logger, width, height, &img), FG_OK);
    const int n = 3 * width * height;
    for (int i = 0; i < n; ++i)
        img.rgb[i] = low + (high - low) * (float) i / (float) (n - 1);
    return img;
}

// More rows than two EXR chunks have (16 each).
static image ramp(float low, float high)
{
    return ramp_of(7, 37, low, high);
}

static void near_by(float a, float b, float tolerance)
{
    if (!(fabsf(a - b) <= tolerance))
        fail_msg("%.9g is not %.9g", (double) a, (double) b);
}

static void expect_refused(const char *path, const char *reason)
{
    image img;
    last[0] = 0;
    assert_int_equal(image_read(&logger, path, &img), FG_ERR_INPUT);
    assert_null(img.rgb);
    assert_non_null(strstr(last, path));
    if (!strstr(last, reason))
        fail_msg("\"%s\" does not say \"%s\"", last, reason);
}

// The plain ramp's second chunk compresses to its own size, which readers take for raw rows.
static void floats_survive_bit_for_bit(void **state)
{
    (void) state;
    const float odd[] = { -0.0f, -3.5f, 1e-40f, 3e38f, 1.1920929e-7f, INFINITY };
    for (int e = 1; e < 3; ++e) {
        char name[16];
        image img = ramp(-7, 90000), back;
        memcpy(img.rgb + 30, odd, sizeof odd);
        snprintf(name, sizeof name, "a.%s", extensions[e]);
        assert_int_equal(image_write(&logger, in_folder(name), &img, IMAGE_LIGHT), FG_OK);
        assert_int_equal(image_read(&logger, in_folder(name), &back), FG_OK);
        assert_int_equal(back.width, img.width);
        assert_int_equal(back.height, img.height);
        assert_memory_equal(back.rgb, img.rgb, (size_t) (3 * 7 * 37) * sizeof(float));
        image_finish(&img);
        image_finish(&back);
    }
    assert_int_equal(files_in_folder(), 2);
}

// Half a step of 1/255 in sRGB is at most 0.5 / 255 * 2.4 / 1.055 in linear light, the
// steepest slope of the decoding curve.
static void png_keeps_light_to_half_a_step(void **state)
{
    (void) state;
    image img = ramp(0, 1), back;
    assert_int_equal(image_write(&logger, in_folder("a.png"), &img, IMAGE_LIGHT), FG_OK);
    assert_int_equal(image_read(&logger, in_folder("a.png"), &back), FG_OK);
    assert_int_equal(back.width, 7);
    assert_int_equal(back.height, 37);
    for (int i = 0; i < 3 * 7 * 37; ++i)
        near_by(back.rgb[i], img.rgb[i], 0.5f / 255 * 2.4f / 1.055f + 1e-6f);
    image_finish(&img);
    image_finish(&back);
}

static float srgb_of_byte(int byte)
{
    return powf(((float) byte / 255 + 0.055f) / 1.055f, 2.4f);
}

static void png_clamps_light_and_centres_data(void **state)
{
    (void) state;
    image img, back;
    const float light[] = { -1, NAN, 7, 0.5f, 1, INFINITY }, data[] = { -1, 0, 1, -9, 9, NAN };
    assert_int_equal(image_create(&logger, 2, 1, &img), FG_OK);

    memcpy(img.rgb, light, sizeof light);
    assert_int_equal(image_write(&logger, in_folder("l.png"), &img, IMAGE_LIGHT), FG_OK);
    assert_int_equal(image_read(&logger, in_folder("l.png"), &back), FG_OK);
    const float shown_light[] = { 0, 0, 1, srgb_of_byte(188), 1, 1 };
    for (int i = 0; i < 6; ++i)
        near_by(back.rgb[i], shown_light[i], 1e-6f);
    image_finish(&back);

    memcpy(img.rgb, data, sizeof data);
    assert_int_equal(image_write(&logger, in_folder("d.png"), &img, IMAGE_DATA), FG_OK);
    assert_int_equal(image_read(&logger, in_folder("d.png"), &back), FG_OK);
    const float shown_data[] = { 0, srgb_of_byte(128), 1, 0, 1, 0 };
    for (int i = 0; i < 6; ++i)
        near_by(back.rgb[i], shown_data[i], 1e-6f);
    image_finish(&back);
    image_finish(&img);
}

static void the_top_row_comes_first(void **state)
{
    (void) state;
    for (int e = 0; e < 3; ++e) {
        char name[16];
        image img, back;
        assert_int_equal(image_create(&logger, 1, 2, &img), FG_OK);
        img.rgb[0] = 1;
        snprintf(name, sizeof name, "a.%s", extensions[e]);
        assert_int_equal(image_write(&logger, in_folder(name), &img, IMAGE_LIGHT), FG_OK);
        assert_int_equal(image_read(&logger, in_folder(name), &back), FG_OK);
        assert_true(back.rgb[0] == 1 && back.rgb[3] == 0);
        image_finish(&img);
        image_finish(&back);
    }
    // A PFM stores the bottom row first: the red of the top row is the fourth float.
    size_t size;
    unsigned char *bytes = load(in_folder("a.pfm"), &size);
    float first, fourth;
    memcpy(&first, bytes + size - 6 * sizeof first, sizeof first);
    memcpy(&fourth, bytes + size - 3 * sizeof first, sizeof fourth);
    assert_true(first == 0 && fourth == 1);
    free(bytes);
}

static void a_file_cut_short_anywhere_is_refused(void **state)
{
    (void) state;
    for (int e = 0; e < 3; ++e) {
        char name[16];
        size_t size;
        image img = ramp_of(2, 17, 0, 1);
        snprintf(name, sizeof name, "a.%s", extensions[e]);
        assert_int_equal(image_write(&logger, in_folder(name), &img, IMAGE_LIGHT), FG_OK);
        image_finish(&img);
        unsigned char *bytes = load(in_folder(name), &size);
        for (size_t cut = 0; cut < size; ++cut) {
            store(in_folder(name), bytes, cut);
            expect_refused(in_folder(name), "cannot read: ");
        }
        free(bytes);
    }
}

// What a flipped byte gives is either a picture or a refusal; sanitizers see the rest.
static void a_flipped_byte_never_crashes(void **state)
{
    (void) state;
    for (int e = 0; e < 3; ++e) {
        char name[16];
        size_t size;
        int refused = 0;
        image img = ramp_of(2, 17, 0, 1);
        snprintf(name, sizeof name, "a.%s", extensions[e]);
        assert_int_equal(image_write(&logger, in_folder(name), &img, IMAGE_LIGHT), FG_OK);
        image_finish(&img);
        unsigned char *bytes = load(in_folder(name), &size);
        for (size_t at = 0; at < size; ++at) {
            bytes[at] ^= 0xff;
            store(in_folder(name), bytes, size);
            const fg_status status = image_read(&logger, in_folder(name), &img);
            assert_true(status == FG_OK || status == FG_ERR_INPUT || status == FG_ERR_MEMORY);
            assert_true((status == FG_OK) == (img.rgb != NULL));
            refused += status != FG_OK;
            image_finish(&img);
            bytes[at] ^= 0xff;
        }
        assert_true(refused > 0);
        free(bytes);
    }
}

static void broken_pfm_headers_are_refused(void **state)
{
    (void) state;
    static const struct {
        const char *text, *reason;
    } cases[] = {
        { "Pf\n1 1\n-1\n0000", "must start with PF" },
        { "PF\n1\n-1\n", "a width, a height and a scale" },
        { "PF\n1 x\n-1\n000000000000", "a width, a height and a scale" },
        { "PF\n1 1\n0\n000000000000", "a width, a height and a scale" },
        { "PF\n1.5 1\n-1\n000000000000", "a width, a height and a scale" },
        { "PF\n0 1\n-1\n", "is 0 x 1, must be 1 to 32768 a side" },
        { "PF\n-4 1\n-1\n", "is -4 x 1" },
        { "PF\n1e300 1\n-1\n", "must be 1 to 32768 a side" },
        { "PF\n99999 1\n-1\n", "is 99999 x 1" },
        { "PF\n20000 20000\n-1\n", "at most 67108864 pixels" },
        { "PF\n1 1\n-1\n0000000000001", "has 13 bytes of pixels, 1 x 1 need 12" },
    };
    for (int i = 0; i < FG_COUNT(cases); ++i) {
        store(in_folder("a.pfm"), (const unsigned char *) cases[i].text, strlen(cases[i].text));
        expect_refused(in_folder("a.pfm"), cases[i].reason);
    }
}

static void a_big_endian_pfm_is_read(void **state)
{
    (void) state;
    image back;
    store(in_folder("a.pfm"), (const unsigned char *) "PF 1 1 1 \x3f\x80\0\0\x40\0\0\0\xbf\0\0\0",
          21);
    assert_int_equal(image_read(&logger, in_folder("a.pfm"), &back), FG_OK);
    assert_true(back.rgb[0] == 1 && back.rgb[1] == 2 && back.rgb[2] == -0.5f);
    image_finish(&back);
}

static void a_png_that_claims_more_than_it_can_hold_is_refused(void **state)
{
    (void) state;
    size_t size;
    image img = ramp(0, 1);
    assert_int_equal(image_write(&logger, in_folder("a.png"), &img, IMAGE_LIGHT), FG_OK);
    image_finish(&img);
    unsigned char *bytes = load(in_folder("a.png"), &size);
    // Width of 8000 in IHDR, and the checksum that goes with the new 17 bytes.
    bytes[18] = 8000 >> 8;
    bytes[19] = 8000 & 0xff;
    bytes[22] = 8000 >> 8;
    bytes[23] = 8000 & 0xff;
    uint32_t crc = 0xffffffffu;
    for (int i = 12; i < 29; ++i) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; ++k)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    for (int i = 0; i < 4; ++i)
        bytes[29 + i] = (unsigned char) (~crc >> (24 - 8 * i));
    store(in_folder("a.png"), bytes, size);
    expect_refused(in_folder("a.png"), "cannot hold its pixels");
    free(bytes);
}

// ---- EXR files by hand: uncompressed scanlines --------------------------------------

typedef struct exr_bytes {
    unsigned char data[2048];
    size_t size;
} exr_bytes;

static void put(exr_bytes *e, const void *bytes, size_t size)
{
    assert_true(e->size + size <= sizeof e->data);
    memcpy(e->data + e->size, bytes, size);
    e->size += size;
}

static void put_int(exr_bytes *e, int32_t value)
{
    put(e, &value, sizeof value); // the tests run on little-endian machines
}

static void put_head(exr_bytes *e, const char *name, const char *type, int32_t size)
{
    put(e, name, strlen(name) + 1);
    put(e, type, strlen(type) + 1);
    put_int(e, size);
}

enum { HALF = 1, UINT = 0 };

// Channels are the letters of `channels`, which must be sorted; two pixels from `x0`, one row.
static exr_bytes small_exr(const char *channels, int type, int width, int sampling)
{
    exr_bytes e = { { 0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0 }, 8 };
    const int count = (int) strlen(channels), bytes = type == HALF ? 2 : 4;
    const float one = 1;
    const int32_t box[4] = { 5, -3, 5 + width - 1, -3 };
    put_head(&e, "channels", "chlist", 18 * count + 1);
    for (int i = 0; i < count; ++i) {
        put(&e, (const char[2]){ channels[i], 0 }, 2);
        put_int(&e, type);
        put_int(&e, 0);
        put_int(&e, sampling);
        put_int(&e, 1);
    }
    put(&e, "", 1);
    put_head(&e, "compression", "compression", 1);
    put(&e, "", 1);
    put_head(&e, "dataWindow", "box2i", 16);
    put(&e, box, 16);
    put_head(&e, "displayWindow", "box2i", 16);
    put(&e, box, 16);
    put_head(&e, "lineOrder", "lineOrder", 1);
    put(&e, "", 1);
    put_head(&e, "pixelAspectRatio", "float", 4);
    put(&e, &one, 4);
    put_head(&e, "screenWindowCenter", "v2f", 8);
    put_int(&e, 0);
    put_int(&e, 0);
    put_head(&e, "screenWindowWidth", "float", 4);
    put(&e, &one, 4);
    put(&e, "", 1);
    put_int(&e, (int32_t) e.size + 8); // where the only chunk stands
    put_int(&e, 0);
    put_int(&e, -3);
    put_int(&e, 2 * count * bytes);
    for (int i = 0; i < 2 * count; ++i) { // i as a half: i = 2^k (1 + m / 1024)
        static const uint16_t half[] = {
            0, 0x3c00, 0x4000, 0x4200, 0x4400, 0x4500, 0x4600, 0x4700
        };
        put(&e, type == HALF ? (const void *) &half[i] : (const void *) &i, (size_t) bytes);
    }
    return e;
}

static void a_half_float_exr_with_alpha_and_an_offset_is_read(void **state)
{
    (void) state;
    image back;
    const exr_bytes e = small_exr("ABGR", HALF, 2, 1);
    store(in_folder("a.exr"), e.data, e.size);
    assert_int_equal(image_read(&logger, in_folder("a.exr"), &back), FG_OK);
    assert_int_equal(back.width, 2);
    assert_int_equal(back.height, 1);
    // Planes in the file are A 0 1, B 2 3, G 4 5, R 6 7.
    const float expected[] = { 6, 4, 2, 7, 5, 3 };
    assert_memory_equal(back.rgb, expected, sizeof expected);
    image_finish(&back);
}

static void exr_channels_that_are_not_colour_are_refused(void **state)
{
    (void) state;
    exr_bytes e = small_exr("BG", HALF, 2, 1);
    store(in_folder("a.exr"), e.data, e.size);
    expect_refused(in_folder("a.exr"), "must have the channels R, G and B");

    e = small_exr("BGR", UINT, 2, 1);
    store(in_folder("a.exr"), e.data, e.size);
    expect_refused(in_folder("a.exr"), "channel B must be half or float at every pixel");
}

static void an_exr_of_absurd_size_is_refused(void **state)
{
    (void) state;
    const int widths[] = { 0, -5, 40000, 2147483647 - 5 };
    for (int i = 0; i < FG_COUNT(widths); ++i) {
        const exr_bytes e = small_exr("BGR", HALF, widths[i], 1);
        store(in_folder("a.exr"), e.data, e.size);
        expect_refused(in_folder("a.exr"), "cannot read: ");
    }
}

static void what_is_not_a_picture_is_refused(void **state)
{
    (void) state;
    for (int e = 0; e < 3; ++e) {
        char name[16];
        snprintf(name, sizeof name, "a.%s", extensions[e]);
        expect_refused(in_folder(name), "No such file or directory");
        store(in_folder(name), (const unsigned char *) "hello, world", 12);
        expect_refused(in_folder(name), "cannot read: ");
    }
    expect_refused(in_folder("a.jpg"), "must end in .png, .exr or .pfm");
    assert_int_equal(mkdir(in_folder("dir.png"), 0700), 0);
    expect_refused(in_folder("dir.png"), "not a regular file");
}

static void only_known_names_are_writable(void **state)
{
    (void) state;
    image img = ramp(0, 1);
    assert_true(image_writable("a.png") && image_writable("x/b.EXR") && image_writable("c.d.pfm"));
    assert_false(image_writable("a.jpg") || image_writable("png") || image_writable("a.png/b") ||
                 image_writable(""));
    assert_int_equal(image_write(&logger, in_folder("a.jpg"), &img, IMAGE_LIGHT), FG_ERR_INVALID);
    assert_non_null(strstr(last, "must end in .png, .exr or .pfm"));
    assert_int_equal(files_in_folder(), 0);
    image_finish(&img);
}

static void a_failed_write_leaves_what_was_there(void **state)
{
    (void) state;
    image img = ramp(0, 1);
    for (int e = 0; e < 3; ++e) {
        char name[32];
        snprintf(name, sizeof name, "none/a.%s", extensions[e]);
        assert_int_equal(image_write(&logger, in_folder(name), &img, IMAGE_LIGHT), FG_ERR_IO);
        assert_non_null(strstr(last, "a."));
        assert_non_null(strstr(last, "No such file or directory"));
        snprintf(name, sizeof name, "dir%d.%s", e, extensions[e]);
        assert_int_equal(mkdir(in_folder(name), 0700), 0);
        assert_int_equal(image_write(&logger, in_folder(name), &img, IMAGE_LIGHT), FG_ERR_IO);
        assert_non_null(strstr(last, "Is a directory"));
        assert_int_equal(files_in_folder(), e + 1);
    }
    image_finish(&img);
}

// A limit on file size stands for a full disk.
static void a_full_disk_leaves_the_old_file(void **state)
{
    (void) state;
    struct rlimit old, tight;
    image img = ramp(0, 1);
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    tight = old;
    tight.rlim_cur = 100;
    for (int e = 0; e < 3; ++e) {
        char name[16];
        size_t size;
        snprintf(name, sizeof name, "a.%s", extensions[e]);
        store(in_folder(name), (const unsigned char *) "old", 3);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &tight), 0);
        const fg_status status = image_write(&logger, in_folder(name), &img, IMAGE_LIGHT);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
        assert_int_equal(status, FG_ERR_IO);
        assert_non_null(strstr(last, "cannot write: "));
        assert_int_equal(files_in_folder(), e + 1);
        unsigned char *bytes = load(in_folder(name), &size);
        assert_int_equal(size, 3);
        free(bytes);
    }
    image_finish(&img);
}

static void sizes_below_one_are_invalid(void **state)
{
    (void) state;
    image img;
    assert_int_equal(image_create(&logger, 0, 4, &img), FG_ERR_INVALID);
    assert_string_equal(last, "image: size is 0 x 4, must be at least 1 x 1");
    assert_int_equal(image_create(&logger, 4, -1, &img), FG_ERR_INVALID);
    assert_null(img.rgb);
    assert_int_equal(image_write(&logger, in_folder("a.png"), &img, IMAGE_LIGHT), FG_ERR_INVALID);
    image_finish(&img);
    image_finish(NULL);
}

#define IN_FOLDER(f) cmocka_unit_test_setup_teardown(f, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_FOLDER(floats_survive_bit_for_bit),
        IN_FOLDER(png_keeps_light_to_half_a_step),
        IN_FOLDER(png_clamps_light_and_centres_data),
        IN_FOLDER(the_top_row_comes_first),
        IN_FOLDER(a_file_cut_short_anywhere_is_refused),
        IN_FOLDER(a_flipped_byte_never_crashes),
        IN_FOLDER(broken_pfm_headers_are_refused),
        IN_FOLDER(a_big_endian_pfm_is_read),
        IN_FOLDER(a_png_that_claims_more_than_it_can_hold_is_refused),
        IN_FOLDER(a_half_float_exr_with_alpha_and_an_offset_is_read),
        IN_FOLDER(exr_channels_that_are_not_colour_are_refused),
        IN_FOLDER(an_exr_of_absurd_size_is_refused),
        IN_FOLDER(what_is_not_a_picture_is_refused),
        IN_FOLDER(only_known_names_are_writable),
        IN_FOLDER(a_failed_write_leaves_what_was_there),
        IN_FOLDER(a_full_disk_leaves_the_old_file),
        IN_FOLDER(sizes_below_one_are_invalid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
