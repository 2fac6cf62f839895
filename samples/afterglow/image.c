// SPDX-License-Identifier: MIT
#include "file.h"
#include "image_priv.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { CODERS = 3 };
static const image_coder *const coders[CODERS] = { &image_png, &image_exr, &image_pfm };

bool image_size_allowed(double width, double height, char why[IMAGE_WHY])
{
    if (width >= 1 && height >= 1 && width <= IMAGE_MAX_SIDE && height <= IMAGE_MAX_SIDE &&
        width * height <= IMAGE_MAX_PIXELS)
        return true;
    snprintf(why, IMAGE_WHY, "is %g x %g, must be 1 to %d a side and at most %d pixels", width,
             height, IMAGE_MAX_SIDE, IMAGE_MAX_PIXELS);
    return false;
}

fg_status image_alloc(int width, int height, image *out, char why[IMAGE_WHY])
{
    out->rgb = calloc((size_t) width * (size_t) height, 3 * sizeof *out->rgb);
    if (!out->rgb) {
        snprintf(why, IMAGE_WHY, "out of memory for %d x %d", width, height);
        return FG_ERR_MEMORY;
    }
    out->width = width;
    out->height = height;
    return FG_OK;
}

fg_status image_create(const fg_log *log, int width, int height, image *out)
{
    char why[IMAGE_WHY];
    fg_status status = FG_ERR_INVALID;
    *out = (image){ 0 };
    if (width < 1 || height < 1)
        snprintf(why, sizeof why, "size is %d x %d, must be at least 1 x 1", width, height);
    else
        status = image_alloc(width, height, out, why);
    if (status != FG_OK)
        fg_logf(log, FG_LOG_ERROR, "image: %s", why);
    return status;
}

void image_finish(image *img)
{
    if (!img)
        return;
    free(img->rgb);
    *img = (image){ 0 };
}

static const image_coder *find_coder(const char *path)
{
    const char *dot = path ? strrchr(path, '.') : NULL;
    for (int i = 0; dot && i < CODERS; ++i)
        if (!strcasecmp(dot, coders[i]->extension))
            return coders[i];
    return NULL;
}

static const image_coder *need_coder(const fg_log *log, const char *path)
{
    const image_coder *coder = find_coder(path);
    if (!coder)
        fg_logf(log, FG_LOG_ERROR, "%s: the name must end in .png, .exr or .pfm",
                path ? path : "(null)");
    return coder;
}

bool image_writable(const char *path)
{
    return find_coder(path) != NULL;
}

fg_status image_write(const fg_log *log, const char *path, const image *img, image_kind kind)
{
    char why[IMAGE_WHY] = "";
    file out;
    const image_coder *coder = need_coder(log, path);
    if (!coder)
        return FG_ERR_INVALID;
    if (!img->rgb || img->width < 1 || img->height < 1) {
        fg_logf(log, FG_LOG_ERROR, "%s: there is no picture to write", path);
        return FG_ERR_INVALID;
    }
    fg_status status = file_begin(log, path, &out);
    if (status != FG_OK)
        return status;
    status = coder->write(out.stream, img, kind, why);
    if (status != FG_OK)
        fg_logf(log, FG_LOG_ERROR, "%s: cannot write: %s", path, why);
    const fg_status end = file_end(log, &out, status == FG_OK);
    return status != FG_OK ? status : end;
}

static fg_status read_file(const image_coder *coder, const char *path, image *out,
                           char why[IMAGE_WHY])
{
    struct stat st;
    FILE *in = fopen(path, "rbe");
    if (!in) {
        snprintf(why, IMAGE_WHY, "%s", strerror(errno));
        return FG_ERR_INPUT;
    }
    fg_status status = FG_ERR_INPUT;
    if (fstat(fileno(in), &st) || !S_ISREG(st.st_mode))
        snprintf(why, IMAGE_WHY, "not a regular file");
    else
        status = coder->read(in, st.st_size, out, why);
    fclose(in);
    return status;
}

fg_status image_read(const fg_log *log, const char *path, image *out)
{
    char why[IMAGE_WHY] = "";
    *out = (image){ 0 };
    const image_coder *coder = need_coder(log, path);
    if (!coder)
        return FG_ERR_INPUT;
    const fg_status status = read_file(coder, path, out, why);
    if (status != FG_OK) {
        fg_logf(log, FG_LOG_ERROR, "%s: cannot read: %s", path, why);
        image_finish(out);
    }
    return status;
}
