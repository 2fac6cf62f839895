// SPDX-License-Identifier: MIT
#ifndef GLTF_IMAGE_H
#define GLTF_IMAGE_H

#include <fg/base.h>

// An encoded PNG or JPEG file and what comes of it.
typedef struct gltf_picture {
    const uint8_t *bytes;
    size_t size;
    int width, height;
    uint8_t *rgba;     // malloc()ed, NULL before decoding
    const char *fault; // of decoding
} gltf_picture;

// Reads the size without decoding. NULL, or what is wrong.
const char *gltf_picture_probe(gltf_picture *p);
// Decodes them all, on as many threads as there are processors. Where one fails, its `rgba` stays
// NULL and `fault` says why.
void gltf_picture_decode_all(gltf_picture *pictures, int count);

#endif // GLTF_IMAGE_H
