// SPDX-License-Identifier: MIT
#ifndef IMAGE_H
#define IMAGE_H

#include <fg/base.h>

FG_BEGIN

// A linear RGB picture in host memory.
typedef struct image {
    int width, height;
    float *rgb; // [3 * width * height], top row first; owned
} image;

// How a PNG shows the values: light is clamped to [0, 1] and sRGB-encoded; data (normals) is
// stored as value / 2 + 1 / 2 without encoding. EXR and PFM hold the floats as they are.
typedef enum image_kind {
    IMAGE_LIGHT = 0,
    IMAGE_DATA,
} image_kind;

// Zeros. FG_ERR_INVALID for a size below 1, FG_ERR_MEMORY.
FG_NODISCARD fg_status image_create(const fg_log *log, int width, int height, image *out);
void image_finish(image *img); // accepts a zeroed one

// By extension .png, .exr, .pfm; anything else is FG_ERR_INVALID. Writes beside and renames,
// so that a failure leaves no file and no half of one. FG_ERR_IO names path and reason.
FG_NODISCARD fg_status image_write(const fg_log *log, const char *path, const image *img,
                                   image_kind kind);

// FG_ERR_INPUT for anything broken, truncated or absurd. PNG is decoded from sRGB to linear.
FG_NODISCARD fg_status image_read(const fg_log *log, const char *path, image *out);

// Whether the extension is one that image_write() takes: to be asked before the work is done.
bool image_writable(const char *path);

FG_END

#endif // IMAGE_H
