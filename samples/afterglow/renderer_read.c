// SPDX-License-Identifier: MIT
#include "renderer_priv.h"

#include <epoxy/gl.h>
#include <stdlib.h>

static uint32_t texture_of(const renderer *r, int side, renderer_layer layer)
{
    const branch *b = &r->side[side];
    const bool wanted =
        r->declared && side < r->sides && layer < LAYER_END && (b->layers & 1u << layer);
    return wanted ? fg_graph_exported(r->graph, b->layer[layer]) : 0;
}

uint32_t renderer_texture(renderer *r, renderer_layer layer)
{
    return texture_of(r, 0, layer);
}

uint32_t renderer_second_texture(renderer *r, renderer_layer layer)
{
    return texture_of(r, 1, layer);
}

// Turns `count` rows of rgba from row `first` up, counted from the bottom, into rows of rgb from
// the top down.
static void store(const renderer *r, renderer_layer layer, const float *rgba, int first, int count,
                  image *out)
{
    for (int y = first; y < first + count; y++) {
        const float *from = rgba + (size_t) 4 * out->width * (y - first);
        float *to = out->rgb + (size_t) 3 * out->width * (out->height - 1 - y);
        for (int x = 0; x < out->width; x++, from += 4, to += 3) {
            const bool world = layer == LAYER_POSITION && from[3] > 0.5f;
            for (int c = 0; c < 3; c++)
                to[c] = world ? (float) ((double) from[c] + r->view.origin[c]) : from[c];
        }
    }
}

// Size of a layer's texture. What a plugin hands out may be anything.
static fg_status measure(const renderer *r, const branch *b, renderer_layer layer, int size[2],
                         uint32_t texture)
{
    char name[64];
    const char *fault = NULL;
    int target = GL_TEXTURE_2D, format = 0;
    if (texture) {
        glGetTextureParameteriv(texture, GL_TEXTURE_TARGET, &target);
        glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
        glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_WIDTH, &size[0]);
        glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_HEIGHT, &size[1]);
    }
    if (!texture)
        fault = "is not there to be read";
    else if (layer >= LAYER_PLUGIN &&
             (target != GL_TEXTURE_2D || (format != GL_RGBA16F && format != GL_RGBA32F)))
        fault = "must be a 2D texture, RGBA16F or RGBA32F";
    if (!fault)
        return FG_OK;
    fg_logf(r->desc.log, FG_LOG_ERROR, "renderer: layer %s %s",
            renderer_layer_text(b, layer, name, sizeof name), fault);
    return FG_ERR_INVALID;
}

static fg_status read_side(renderer *r, int side, renderer_layer layer, image *out)
{
    // In bands: OpenGL counts the bytes of one call in an int.
    enum { BAND = 64 };
    const uint32_t texture = texture_of(r, side, layer);
    int extent[2] = { 0 };
    fg_status status = measure(r, &r->side[side], layer, extent, texture);
    if (status)
        return status;
    const int width = extent[0], height = extent[1];
    const size_t size = sizeof(float) * 4 * (size_t) width * BAND;
    float *rgba = malloc(size);
    status = rgba ? image_create(r->desc.log, width, height, out) : FG_ERR_MEMORY;
    if (!status)
        glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    for (int y = 0; !status && y < height; y += BAND) {
        const int rows = height - y < BAND ? height - y : BAND;
        glGetTextureSubImage(texture, 0, 0, y, 0, width, rows, 1, GL_RGBA, GL_FLOAT, (GLsizei) size,
                             rgba);
        store(r, layer, rgba, y, rows, out);
    }
    free(rgba);
    return status;
}

fg_status renderer_read(renderer *r, renderer_layer layer, image *out)
{
    return read_side(r, 0, layer, out);
}

fg_status renderer_second_read(renderer *r, renderer_layer layer, image *out)
{
    return read_side(r, 1, layer, out);
}
