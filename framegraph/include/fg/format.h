// SPDX-License-Identifier: MIT
#ifndef FG_FORMAT_H
#define FG_FORMAT_H

#include <fg/base.h>

FG_BEGIN

// Texel formats, named as in OpenGL. Float formats hold linear values.
typedef enum fg_format {
    FG_RGBA16F = 0,
    FG_RGBA32F,
    FG_RG32F,
    FG_RG16F,
    FG_R32F,
    FG_R16F,
    FG_R11G11B10F,
    FG_RGBA8,
    FG_SRGB8_ALPHA8,
    FG_RGB10_A2,
    FG_RG16, // unsigned normalised
    FG_RG16_SNORM,
    FG_RG8,
    FG_R8,
    FG_RGBA32UI,
    FG_RG32UI,
    FG_R32UI,
    FG_R16UI,
    FG_R8UI,
    FG_DEPTH32F,
    FG_DEPTH16,
    FG_DEPTH24_STENCIL8,
    FG_DEPTH32F_STENCIL8,
    FG_FORMAT_COUNT,
} fg_format;

typedef struct fg_format_info {
    const char *name; // "RGBA16F"
    int bytes;        // per texel
    int channels;
    int view_class;      // formats of one class may share memory through glTextureView; 0: none
    bool depth, stencil; // usable as depth attachment only (and sampled)
    bool image;          // usable with image load/store
    bool color;          // colour-renderable
    bool is_float, is_integer;
} fg_format_info;

// NULL for a value outside the enumeration.
FG_API const fg_format_info *fg_format_get(fg_format format);

FG_END

#endif // FG_FORMAT_H
