// SPDX-License-Identifier: MIT
#include "graph_priv.h"

// View classes are the bits of a texel: OpenGL 4.5, table 8.22. Depth formats have none.
#define COLOR(n, b, c, img, flt, integer)                                                          \
    [FG_##n] = { .name = #n,                                                                       \
                 .bytes = (b),                                                                     \
                 .channels = (c),                                                                  \
                 .view_class = (b) *8,                                                             \
                 .image = (img),                                                                   \
                 .color = true,                                                                    \
                 .is_float = (flt),                                                                \
                 .is_integer = (integer) }
#define DEPTH(n, b, c, flt)                                                                        \
    [FG_##n] = { .name = #n,                                                                       \
                 .bytes = (b),                                                                     \
                 .channels = (c),                                                                  \
                 .depth = true,                                                                    \
                 .stencil = (c) > 1,                                                               \
                 .is_float = (flt) }

// Bytes are those of memory: the 32-bit float depth with stencil is padded to 8.
const fg_format_info fg_formats[FG_FORMAT_COUNT] = {
    COLOR(RGBA16F, 8, 4, true, true, false),
    COLOR(RGBA32F, 16, 4, true, true, false),
    COLOR(RG32F, 8, 2, true, true, false),
    COLOR(RG16F, 4, 2, true, true, false),
    COLOR(R32F, 4, 1, true, true, false),
    COLOR(R16F, 2, 1, true, true, false),
    COLOR(R11G11B10F, 4, 3, true, true, false),
    COLOR(RGBA8, 4, 4, true, false, false),
    COLOR(SRGB8_ALPHA8, 4, 4, false, false, false),
    COLOR(RGB10_A2, 4, 4, true, false, false),
    COLOR(RG16, 4, 2, true, false, false),
    COLOR(RG16_SNORM, 4, 2, true, false, false),
    COLOR(RG8, 2, 2, true, false, false),
    COLOR(R8, 1, 1, true, false, false),
    COLOR(RGBA32UI, 16, 4, true, false, true),
    COLOR(RG32UI, 8, 2, true, false, true),
    COLOR(R32UI, 4, 1, true, false, true),
    COLOR(R16UI, 2, 1, true, false, true),
    COLOR(R8UI, 1, 1, true, false, true),
    DEPTH(DEPTH32F, 4, 1, true),
    DEPTH(DEPTH16, 2, 1, false),
    DEPTH(DEPTH24_STENCIL8, 4, 2, false),
    DEPTH(DEPTH32F_STENCIL8, 8, 2, true),
};

const fg_format_info *fg_format_get(fg_format format)
{
    return (unsigned) format < FG_FORMAT_COUNT ? &fg_formats[format] : NULL;
}
