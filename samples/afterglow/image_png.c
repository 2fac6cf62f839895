// SPDX-License-Identifier: MIT
#include "image_priv.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

// All that must outlive libpng's longjmp stands here, never in a local of the function that
// called setjmp.
typedef struct png_job {
    FILE *file;
    char *why;
    fg_status status;
    png_structp png;
    png_infop info;
    unsigned char *bytes;
    png_bytep *rows;
    image *out;
} png_job;

static void on_error(png_structp png, png_const_charp msg)
{
    png_job *job = png_get_error_ptr(png);
    snprintf(job->why, IMAGE_WHY, "%s", msg);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp msg)
{
    (void) png;
    (void) msg;
}

// IEC 61966-2-1.
static float srgb_encode(float x)
{
    return x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1 / 2.4f) - 0.055f;
}

static float srgb_decode(float x)
{
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

// NaN becomes 0: a byte has no way to say it.
static float clamp01(float x)
{
    return x > 0 ? (x < 1 ? x : 1) : 0;
}

static unsigned char to_byte(float x, image_kind kind)
{
    const float shown = kind == IMAGE_DATA ? clamp01(x / 2 + 0.5f) : srgb_encode(clamp01(x));
    return (unsigned char) (shown * 255 + 0.5f);
}

static fg_status encode(png_job *job, const image *img, image_kind kind)
{
    if (setjmp(png_jmpbuf(job->png)))
        return FG_ERR_IO;
    png_init_io(job->png, job->file);
    png_set_IHDR(job->png, job->info, (png_uint_32) img->width, (png_uint_32) img->height, 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (kind == IMAGE_LIGHT)
        png_set_sRGB(job->png, job->info, PNG_sRGB_INTENT_RELATIVE);
    png_write_info(job->png, job->info);
    const size_t row = 3 * (size_t) img->width;
    for (int y = 0; y < img->height; ++y) {
        for (size_t i = 0; i < row; ++i)
            job->bytes[i] = to_byte(img->rgb[row * (size_t) y + i], kind);
        png_write_row(job->png, job->bytes);
    }
    png_write_end(job->png, job->info);
    png_write_flush(job->png);
    return FG_OK;
}

static fg_status write_png(FILE *file, const image *img, image_kind kind, char why[IMAGE_WHY])
{
    png_job job = { .file = file, .why = why };
    fg_status status = FG_ERR_MEMORY;
    snprintf(why, IMAGE_WHY, "out of memory");
    job.bytes = malloc(3 * (size_t) img->width);
    job.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
    if (job.png)
        job.info = png_create_info_struct(job.png);
    if (job.bytes && job.info)
        status = encode(&job, img, kind);
    png_destroy_write_struct(&job.png, &job.info);
    free(job.bytes);
    return status;
}

// Everything becomes RGB of 8 or 16 bits.
static void ask_for_rgb(png_job *job)
{
    png_set_expand(job->png);
    png_set_gray_to_rgb(job->png);
    png_set_strip_alpha(job->png);
    png_set_interlace_handling(job->png);
    png_read_update_info(job->png, job->info);
}

static void to_linear(const png_job *job)
{
    const bool deep = png_get_bit_depth(job->png, job->info) == 16;
    const size_t row = 3 * (size_t) job->out->width;
    for (int y = 0; y < job->out->height; ++y)
        for (size_t i = 0; i < row; ++i) {
            const png_bytep in = job->rows[y];
            const float x =
                deep ? (float) (in[2 * i] << 8 | in[2 * i + 1]) / 65535 : (float) in[i] / 255;
            job->out->rgb[row * (size_t) y + i] = srgb_decode(x);
        }
}

static bool allocate_rows(png_job *job, size_t width, size_t height, size_t row)
{
    job->status = image_alloc((int) width, (int) height, job->out, job->why);
    if (job->status != FG_OK)
        return false;
    job->bytes = calloc(height, row);
    job->rows = calloc(height, sizeof *job->rows);
    if (!job->bytes || !job->rows) {
        snprintf(job->why, IMAGE_WHY, "out of memory");
        job->status = FG_ERR_MEMORY;
        return false;
    }
    for (size_t y = 0; y < height; ++y)
        job->rows[y] = job->bytes + row * y;
    return true;
}

// Deflate makes at most 1032 bytes of one (RFC 1951: 258 bytes in 2 bits), so that a picture
// much larger than that is known to be a lie before memory is spent on it.
static bool file_can_hold(png_job *job, double stored_bytes, int64_t size)
{
    if (stored_bytes <= 1032.0 * (double) size)
        return true;
    snprintf(job->why, IMAGE_WHY, "is truncated: %lld bytes cannot hold its pixels",
             (long long) size);
    return false;
}

static fg_status decode(png_job *job, int64_t size)
{
    if (setjmp(png_jmpbuf(job->png)))
        return FG_ERR_INPUT;
    png_init_io(job->png, job->file);
    png_set_user_limits(job->png, IMAGE_MAX_SIDE, IMAGE_MAX_SIDE);
    png_set_chunk_malloc_max(job->png, 1 << 24);
    png_read_info(job->png, job->info);
    const png_uint_32 width = png_get_image_width(job->png, job->info);
    const png_uint_32 height = png_get_image_height(job->png, job->info);
    if (!image_size_allowed(width, height, job->why) ||
        !file_can_hold(job, (double) png_get_rowbytes(job->png, job->info) * height, size))
        return FG_ERR_INPUT;
    ask_for_rgb(job);
    if (png_get_channels(job->png, job->info) != 3)
        png_error(job->png, "is not a colour picture");
    if (!allocate_rows(job, width, height, png_get_rowbytes(job->png, job->info)))
        return job->status;
    png_read_image(job->png, job->rows);
    png_read_end(job->png, NULL);
    to_linear(job);
    return FG_OK;
}

static fg_status read_png(FILE *file, int64_t size, image *out, char why[IMAGE_WHY])
{
    png_job job = { .file = file, .why = why, .out = out };
    fg_status status = FG_ERR_MEMORY;
    snprintf(why, IMAGE_WHY, "out of memory");
    job.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
    if (job.png)
        job.info = png_create_info_struct(job.png);
    if (job.info)
        status = decode(&job, size);
    png_destroy_read_struct(&job.png, &job.info, NULL);
    free(job.rows);
    free(job.bytes);
    return status;
}

const image_coder image_png = { ".png", write_png, read_png };
