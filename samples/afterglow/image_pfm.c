// SPDX-License-Identifier: MIT
#include "image_priv.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// A portable float map: "PF", width and height, a scale whose sign tells the byte order
// (negative: little-endian), then rows from the bottom up. The size of the scale is a unit
// that nobody agrees on: it is written as 1 and ignored.

static bool little_endian(void)
{
    const uint16_t one = 1;
    return *(const unsigned char *) &one == 1;
}

static void swap_bytes(float *values, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        uint32_t u;
        memcpy(&u, values + i, sizeof u);
        u = u >> 24 | (u >> 8 & 0xff00) | (u << 8 & 0xff0000) | u << 24;
        memcpy(values + i, &u, sizeof u);
    }
}

static fg_status write_pfm(FILE *file, const image *img, image_kind kind, char why[IMAGE_WHY])
{
    (void) kind;
    const size_t row = 3 * (size_t) img->width;
    const char *scale = little_endian() ? "-1.0" : "1.0";
    bool ok = fprintf(file, "PF\n%d %d\n%s\n", img->width, img->height, scale) > 0;
    for (int y = img->height - 1; ok && y >= 0; --y)
        ok = fwrite(img->rgb + row * (size_t) y, sizeof *img->rgb, row, file) == row;
    if (ok && fflush(file) == 0)
        return FG_OK;
    snprintf(why, IMAGE_WHY, "%s", strerror(errno));
    return FG_ERR_IO;
}

// One word of the header, and the single white space after it.
static bool read_word(FILE *file, char word[24])
{
    int c = getc(file);
    size_t n = 0;
    while (c == ' ' || c == '\t' || c == '\n' || c == '\r')
        c = getc(file);
    for (; c > ' ' && c < 127; c = getc(file)) {
        if (n == 23)
            return false;
        word[n++] = (char) c;
    }
    word[n] = 0;
    return n > 0 && (c == ' ' || c == '\t' || c == '\n' || c == '\r');
}

static bool read_number(FILE *file, double *value)
{
    char word[24], *end;
    if (!read_word(file, word))
        return false;
    *value = strtod(word, &end);
    return *end == 0 && isfinite(*value);
}

static fg_status read_pfm(FILE *file, int64_t size, image *out, char why[IMAGE_WHY])
{
    char magic[24] = "";
    double width, height, scale;
    if (!read_word(file, magic) || strcmp(magic, "PF") != 0) {
        snprintf(why, IMAGE_WHY, "not a colour PFM: it must start with PF");
        return FG_ERR_INPUT;
    }
    if (!read_number(file, &width) || !read_number(file, &height) || !read_number(file, &scale) ||
        width != floor(width) || height != floor(height) || scale == 0) {
        snprintf(why, IMAGE_WHY, "the PFM header must have a width, a height and a scale");
        return FG_ERR_INPUT;
    }
    if (!image_size_allowed(width, height, why))
        return FG_ERR_INPUT;
    const size_t row = 3 * (size_t) width;
    const int64_t need = (int64_t) (row * sizeof(float)) * (int64_t) height;
    const int64_t have = size - ftell(file);
    if (have != need) {
        snprintf(why, IMAGE_WHY, "has %lld bytes of pixels, %.0f x %.0f need %lld",
                 (long long) have, width, height, (long long) need);
        return FG_ERR_INPUT;
    }
    const fg_status status = image_alloc((int) width, (int) height, out, why);
    if (status != FG_OK)
        return status;
    for (int y = out->height - 1; y >= 0; --y) {
        float *to = out->rgb + row * (size_t) y;
        if (fread(to, sizeof *to, row, file) != row) {
            snprintf(why, IMAGE_WHY, "ends early");
            return FG_ERR_INPUT;
        }
        if ((scale < 0) != little_endian())
            swap_bytes(to, row);
    }
    return FG_OK;
}

const image_coder image_pfm = { ".pfm", write_pfm, read_pfm };
