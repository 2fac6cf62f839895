// SPDX-License-Identifier: MIT
#include "gl_priv.h"

#include <math.h>
#include <string.h>

// A texel as glClearTexSubImage takes it.
typedef struct texel {
    GLenum pixels, type;
    union {
        float f[4];
        uint32_t u[4];
        uint8_t bytes[16];
    } data;
} texel;

// Drivers clamp a NaN that is cleared into depth, and some clamp it to the far plane, which would
// hide a mistake: depth takes what 0xcd bytes are in a fixed format, neither far nor near.
static const float depth_poison = 0xcdcd / 65535.0f;

static texel poison_texel(const fg_tex_desc *desc)
{
    const fg_format_info *info = fg_format_get(desc->format);
    const gl_format *gl = gl_format_get(desc->format);
    texel t = { .pixels = gl->pixels, .type = gl->type };

    memset(t.data.bytes, 0xcd, sizeof t.data.bytes);
    if (info->depth && info->is_float) {
        t.data.f[0] = depth_poison;
    } else if (gl->type == GL_FLOAT) {
        for (int i = 0; i < 4; ++i)
            t.data.f[i] = NAN;
    } else if (info->is_float) {
        memset(t.data.bytes, 0xff, sizeof t.data.bytes); // half, 11 and 10 bits: all ones is NaN
    }
    return t;
}

static float srgb_encode(float linear)
{
    if (linear <= 0.0031308f)
        return 12.92f * linear;
    return 1.055f * powf(linear, 1.0f / 2.4f) - 0.055f;
}

static uint32_t to_unsigned(float value)
{
    if (!(value > 0.0f))
        return 0;
    return value >= 4294967295.0f ? UINT32_MAX : (uint32_t) value;
}

static texel clear_texel(const fg_tex_desc *desc, const float value[4])
{
    const fg_format_info *info = fg_format_get(desc->format);
    texel t = { .pixels = GL_RGBA, .type = GL_FLOAT };

    memcpy(t.data.f, value, sizeof t.data.f);
    if (info->depth && info->stencil) {
        t.pixels = GL_DEPTH_STENCIL;
        t.type = GL_FLOAT_32_UNSIGNED_INT_24_8_REV;
        t.data.u[1] = 0;
    } else if (info->depth) {
        t.pixels = GL_DEPTH_COMPONENT;
    } else if (info->is_integer) {
        t.pixels = GL_RGBA_INTEGER;
        t.type = GL_UNSIGNED_INT;
        for (int i = 0; i < 4; ++i)
            t.data.u[i] = to_unsigned(value[i]);
    } else if (desc->format == FG_SRGB8_ALPHA8) {
        for (int i = 0; i < 3; ++i) // uploads are taken as encoded already
            t.data.f[i] = srgb_encode(value[i]);
    }
    return t;
}

static int mip_size(int size, int mip)
{
    const int s = size >> mip;
    return s > 0 ? s : 1;
}

static void clear_texture(const fg_clear *c)
{
    const texel t = c->poison ? poison_texel(c->tex) : clear_texel(c->tex, c->value);
    for (int mip = c->mip; mip < c->mip + c->mips; ++mip) {
        const int w = mip_size(c->tex->width, mip), h = mip_size(c->tex->height, mip);
        const bool volume = c->tex->depth > 0; // slices shrink with the mips: always all of them
        const int z = volume ? 0 : c->layer;
        const int d = volume ? mip_size(c->tex->depth, mip) : c->layers;
        glClearTexSubImage(c->object, mip, 0, 0, z, w, h, d, t.pixels, t.type, &t.data);
    }
}

// Buffers have no format: `value` [0] fills them as 32 bits.
static void clear_buffer(const fg_clear *c)
{
    uint32_t word = 0xcdcdcdcd;
    uint8_t bytes[4];
    const uint64_t whole = c->size & ~UINT64_C(3);

    if (!c->poison)
        memcpy(&word, c->value, sizeof word);
    memcpy(bytes, &word, sizeof bytes);
    if (whole)
        glClearNamedBufferSubData(c->object, GL_R32UI, 0, (GLsizeiptr) whole, GL_RED_INTEGER,
                                  GL_UNSIGNED_INT, &word);
    for (uint64_t i = whole; i < c->size; ++i)
        glClearNamedBufferSubData(c->object, GL_R8UI, (GLintptr) i, 1, GL_RED_INTEGER,
                                  GL_UNSIGNED_BYTE, &bytes[i - whole]);
}

void gl_clear(fg_device *dev, const fg_clear *clear)
{
    (void) dev;
    if (clear->tex)
        clear_texture(clear);
    else
        clear_buffer(clear);
}
