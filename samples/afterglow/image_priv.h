// SPDX-License-Identifier: MIT
#ifndef IMAGE_PRIV_H
#define IMAGE_PRIV_H

#include "image.h"

#include <stdio.h>

// What a coder leaves behind when it fails: the reason, without the path.
enum { IMAGE_WHY = 160 };

// Bounds on what is read, so that a header that lies costs no memory. 8K pictures fit.
enum { IMAGE_MAX_SIDE = 32768, IMAGE_MAX_PIXELS = 1 << 26 };

// Whether a picture of that size is read; if not, `why` says so.
bool image_size_allowed(double width, double height, char why[IMAGE_WHY]);

// Zeros, silently.
fg_status image_alloc(int width, int height, image *out, char why[IMAGE_WHY]);

// Coders of one format. `file` is open and at its start, `size` its length in bytes. A reader
// that fails leaves `out` to image_finish().
typedef struct image_coder {
    const char *extension;
    fg_status (*write)(FILE *file, const image *img, image_kind kind, char why[IMAGE_WHY]);
    fg_status (*read)(FILE *file, int64_t size, image *out, char why[IMAGE_WHY]);
} image_coder;

extern const image_coder image_png, image_exr, image_pfm;

#endif // IMAGE_PRIV_H
