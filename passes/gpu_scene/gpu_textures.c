// SPDX-License-Identifier: MIT
#include "gpu_scene_priv.h"

#include <pass/surface.h>

#include <epoxy/gl.h>
#include <math.h>
#include <stdlib.h>

// Without bindless textures a draw of many materials can reach AG_MAX_TEXTURE_BINS texture arrays.
// Textures keep their sizes while those are few enough; else they are resampled to
// powers of two, else to the nearest three classes.
enum { SIZE_EXACT, SIZE_POWER_OF_TWO, SIZE_CLASS, SIZE_RULES };

static int size_class(int n, int rule)
{
    int size = 1;
    if (rule == SIZE_EXACT)
        return n;
    if (rule == SIZE_CLASS)
        return n <= 256 ? 256 : n <= 1024 ? 1024 : 4096;
    while (size < n && size < 16384)
        size *= 2;
    return size;
}

static texture_bin bin_for(const ag_texture *t, int rule)
{
    const int edge = t->width > t->height ? t->width : t->height;
    return (texture_bin){
        .width = size_class(rule == SIZE_EXACT ? t->width : edge, rule),
        .height = size_class(rule == SIZE_EXACT ? t->height : edge, rule),
        .srgb = t->srgb,
        .nearest = t->nearest,
    };
}

static bool same_bin(const texture_bin *a, const texture_bin *b)
{
    return a->width == b->width && a->height == b->height && a->srgb == b->srgb &&
           a->nearest == b->nearest;
}

// Gives every texture a bin and a layer; false if AG_MAX_TEXTURE_BINS are too few.
static bool assign_bins(const ag_scene *scene, int rule, texture_set *set)
{
    set->bin_count = 0;
    for (int t = 0; t < scene->texture_count; t++) {
        const texture_bin want = bin_for(&scene->textures[t], rule);
        int b = 0;
        while (b < set->bin_count && !same_bin(&set->bins[b], &want))
            b++;
        if (b == AG_MAX_TEXTURE_BINS)
            return false;
        if (b == set->bin_count)
            set->bins[set->bin_count++] = want;
        set->places[t][0] = b;
        set->places[t][1] = set->bins[b].layers++;
    }
    return true;
}

static uint8_t to_byte(float x, bool srgb)
{
    if (srgb)
        x = x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1 / 2.4f) - 0.055f;
    return (uint8_t) (fminf(fmaxf(x, 0), 1) * 255 + 0.5f);
}

// Bilinear, in linear light. Enlarging only, but for images beyond the largest class.
static uint8_t *resample(const ag_texture *t, int width, int height)
{
    uint8_t *out = malloc((size_t) width * height * 4);
    for (int y = 0; out && y < height; y++) {
        for (int x = 0; x < width; x++) {
            float rgba[4];
            uint8_t *texel = out + 4 * ((size_t) y * width + x);
            ag_texture_sample(t, ((float) x + 0.5f) / (float) width,
                              ((float) y + 0.5f) / (float) height, rgba);
            for (int c = 0; c < 4; c++)
                texel[c] = to_byte(rgba[c], t->srgb && c < 3);
        }
    }
    return out;
}

// How texels are read from memory is the host's to set. Here they lie one after the other.
enum { UNPACK_NUMBERS = 8 };
static const GLenum unpack[UNPACK_NUMBERS] = {
    GL_UNPACK_ALIGNMENT,   GL_UNPACK_ROW_LENGTH,   GL_UNPACK_SKIP_ROWS,  GL_UNPACK_SKIP_PIXELS,
    GL_UNPACK_SKIP_IMAGES, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST,
};

typedef struct unpack_state {
    GLint numbers[UNPACK_NUMBERS], buffer;
} unpack_state;

static unpack_state unpack_begin(void)
{
    unpack_state host;
    glGetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &host.buffer);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    for (int i = 0; i < UNPACK_NUMBERS; i++) {
        glGetIntegerv(unpack[i], &host.numbers[i]);
        glPixelStorei(unpack[i], unpack[i] == GL_UNPACK_ALIGNMENT ? 4 : 0);
    }
    return host;
}

static void unpack_end(const unpack_state *host)
{
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, (GLuint) host->buffer);
    for (int i = 0; i < UNPACK_NUMBERS; i++)
        glPixelStorei(unpack[i], host->numbers[i]);
}

static bool upload(const ag_texture *t, const texture_bin *bin, int layer)
{
    const bool exact = t->width == bin->width && t->height == bin->height;
    uint8_t *made = exact ? NULL : resample(t, bin->width, bin->height);
    if (!exact && !made)
        return false;
    glTextureSubImage3D(bin->texture, 0, 0, 0, layer, bin->width, bin->height, 1, GL_RGBA,
                        GL_UNSIGNED_BYTE, exact ? t->rgba : made);
    free(made);
    return true;
}

static uint64_t create_bin(texture_bin *bin)
{
    int levels = 1;
    const int edge = bin->width > bin->height ? bin->width : bin->height;
    while (edge >> levels)
        levels++;
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &bin->texture);
    glTextureStorage3D(bin->texture, levels, bin->srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, bin->width,
                       bin->height, bin->layers);
    // Wrapping is the shader's; it needs seams that repeat. Minification is trilinear.
    glCreateSamplers(1, &bin->sampler);
    glSamplerParameteri(bin->sampler, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glSamplerParameteri(bin->sampler, GL_TEXTURE_MAG_FILTER, bin->nearest ? GL_NEAREST : GL_LINEAR);
    return (uint64_t) bin->width * bin->height * bin->layers * 4 * 4 / 3;
}

// By the first rule that AG_MAX_TEXTURE_BINS suffice for.
static void choose_bins(const fg_log *log, const ag_scene *scene, texture_set *set)
{
    int rule = SIZE_EXACT;
    while (rule < SIZE_RULES && !assign_bins(scene, rule, set)) {
        *set = (texture_set){ .places = set->places };
        rule++;
    }
    assert(rule < SIZE_RULES); // 3 sizes x 2 x 2 always fit
    if (rule != SIZE_EXACT)
        fg_logf(log, FG_LOG_WARN, "%s: textures of many sizes are resampled to %d arrays",
                scene->name, set->bin_count);
}

static fg_status create_bins(const fg_log *log, const char *scene, texture_set *set)
{
    int max_size = 0, max_layers = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_size);
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &max_layers);
    for (int b = 0; b < set->bin_count; b++) {
        texture_bin *bin = &set->bins[b];
        if (bin->width > max_size || bin->height > max_size || bin->layers > max_layers) {
            fg_logf(log, FG_LOG_ERROR, "%s: %d textures of %d x %d; the device takes %d of %d",
                    scene, bin->layers, bin->width, bin->height, max_layers, max_size);
            return FG_ERR_UNSUPPORTED;
        }
        set->bytes += create_bin(bin);
    }
    return FG_OK;
}

fg_status texture_set_init(const fg_log *log, const ag_scene *scene, texture_set *set)
{
    if (scene->texture_count == 0)
        return FG_OK;
    set->places = calloc((size_t) scene->texture_count, sizeof *set->places);
    if (!set->places) {
        fg_logf(log, FG_LOG_ERROR, "%s: out of memory for textures", scene->name);
        return FG_ERR_MEMORY;
    }
    choose_bins(log, scene, set);
    const fg_status status = create_bins(log, scene->name, set);
    if (status)
        return status;
    const unpack_state host = unpack_begin();
    int done = 0;
    while (done < scene->texture_count &&
           upload(&scene->textures[done], &set->bins[set->places[done][0]], set->places[done][1]))
        done++;
    unpack_end(&host);
    if (done < scene->texture_count) {
        fg_logf(log, FG_LOG_ERROR, "%s: out of memory for texture %s", scene->name,
                scene->textures[done].name);
        return FG_ERR_MEMORY;
    }
    for (int b = 0; b < set->bin_count; b++)
        glGenerateTextureMipmap(set->bins[b].texture);
    return FG_OK;
}

void texture_set_finish(texture_set *set)
{
    for (int b = 0; b < set->bin_count; b++) {
        glDeleteTextures(1, &set->bins[b].texture);
        glDeleteSamplers(1, &set->bins[b].sampler);
    }
    free(set->places);
    *set = (texture_set){ 0 };
}
