// SPDX-License-Identifier: MIT
#include "stability.h"

#include <epoxy/gl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEFAULT_SIZE = 48 };

// ---- what every buffer must keep -------------------------------------------------------------

// Light is never negative. Buffers of it are known by their names.
static bool holds_light(const char *name)
{
    static const char *const words[] = { "radiance", "flux",   "irradiance", "emissive", "indirect",
                                         "direct.",  "glossy", "albedo",     "display" };
    for (int i = 0; i < FG_COUNT(words); ++i)
        if (strstr(name, words[i]))
            return true;
    return false;
}

static void check_floats(stability *s, const fg_written *w, const float *values, size_t count)
{
    const bool light = holds_light(w->resource);
    long bad = 0;
    for (size_t i = 0; i < count; ++i)
        bad += !isfinite(values[i]) || (light && values[i] < 0);
    if (bad && !s->bad)
        snprintf(s->where, sizeof s->where, "%s after %s", w->resource, w->pass);
    s->bad += bad;
}

static int at_level(int size, int mip)
{
    return size >> mip > 1 ? size >> mip : 1;
}

static void check_texture(stability *s, const fg_written *w)
{
    const fg_format_info *info = fg_format_get(w->tex->format);
    if ((!info->is_float && !info->depth) || info->stencil || w->tex->samples > 1)
        return;
    for (int mip = w->mip; mip < w->mip + w->mips; ++mip) {
        const int width = at_level(w->tex->width, mip), height = at_level(w->tex->height, mip);
        const bool volume = w->tex->depth > 0;
        const int first = volume ? 0 : w->layer,
                  layers = volume ? at_level(w->tex->depth, mip) : w->layers;
        const size_t channels = info->depth ? 1 : 4;
        const size_t count = (size_t) width * (size_t) height * (size_t) layers * channels;
        float *values = malloc(count * sizeof *values);
        if (!values) {
            ++s->bad;
            return;
        }
        glGetTextureSubImage(w->object, mip, 0, 0, first, width, height, layers,
                             info->depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT,
                             (GLsizei) (count * sizeof *values), values);
        check_floats(s, w, values, count);
        free(values);
    }
}

// Buffers mix integers and floats; those named so hold floats alone.
static void check_buffer(stability *s, const fg_written *w)
{
    const size_t length = strlen(w->resource);
    if (length < 5 || strcmp(w->resource + length - 5, ".vpls") != 0)
        return;
    float *values = malloc(w->buf->size);
    if (!values) {
        ++s->bad;
        return;
    }
    glGetNamedBufferSubData(w->object, 0, (GLsizeiptr) w->buf->size, values);
    check_floats(s, w, values, w->buf->size / sizeof *values);
    free(values);
}

static void put_nan(stability *s, const fg_written *w)
{
    const float value[4] = { NAN, NAN, NAN, 1 };
    if (strcmp(w->resource, "gbuffer.normal") != 0)
        return;
    s->poked = true;
    glTextureSubImage2D(w->object, 0, w->tex->width / 2, w->tex->height / 2, 1, 1, GL_RGBA,
                        GL_FLOAT, value);
}

static void inspect(void *user, const fg_written *w)
{
    stability *s = user;
    const char *own = setting_name(s->setting);
    if (s->own_passes && strncmp(w->pass, own, strlen(own)) != 0)
        return;
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    if (s->poke)
        put_nan(s, w);
    else if (w->tex)
        check_texture(s, w);
    else
        check_buffer(s, w);
}

// ---- settings ---------------------------------------------------------------------------------

static bool has_param(const gi_plugin *p, const char *name, size_t length)
{
    for (int i = 0; i < gi_params_count(p); ++i)
        if (strlen(p->params[i].name) == length && !strncmp(p->params[i].name, name, length))
            return true;
    return false;
}

int stability_find_vpls(const gi_plugin *p)
{
    for (int i = 0; p && i < gi_params_count(p); ++i)
        if (!strcmp(p->params[i].name, "vpls") && p->params[i].type == GI_INT)
            return i;
    return -1;
}

// Sets all of `values`, or those that the plugin takes.
static fg_status with(const stability *s, const char *values, bool all, setting *out)
{
    const gi_plugin *p = s->setting->plugin;
    char word[64];
    *out = (setting){ 0 };
    if (!p && all)
        return FG_ERR_UNSUPPORTED;
    if (!setting_copy(s->setting, out))
        return FG_ERR_MEMORY;
    for (const char *at = values; p && *at;) {
        const size_t length = strcspn(at, " ");
        snprintf(word, sizeof word, "%.*s", (int) length, at);
        const bool taken = has_param(p, word, strcspn(word, "=")) &&
                           gi_params_set(NULL, p, out->values, word) == FG_OK;
        if (!taken && all) {
            setting_finish(out);
            return FG_ERR_UNSUPPORTED;
        }
        at += length + (at[length] == ' ');
    }
    return FG_OK;
}

fg_status stability_with(const stability *s, const char *values, setting *out)
{
    return with(s, values, true, out);
}

fg_status stability_with_known(const stability *s, const char *values, setting *out)
{
    return with(s, values, false, out);
}

// ---- frames ----------------------------------------------------------------------------------

static double samples_of(renderer *r)
{
    gi_counter counters[16];
    const int count = renderer_counters(r, counters, FG_COUNT(counters));
    for (int i = 0; i < count && i < FG_COUNT(counters); ++i)
        if (!strcmp(counters[i].name, "samples"))
            return counters[i].value;
    return (double) NAN;
}

fg_status stability_open(stability *s, const shot *what, renderer **out)
{
    const renderer_desc desc = {
        .log = &s->log,
        .device = s->device,
        .scene = what->scene,
        .camera = what->camera,
        .width = what->width ? what->width : DEFAULT_SIZE,
        .height = what->height ? what->height : DEFAULT_SIZE,
        .plugin = s->setting->plugin,
        .values = what->values ? what->values : s->setting->values,
        .layers = 1u << what->layer,
        .strict = true,
        .debug = what->debug | FG_DEBUG_POISON,
        .seed = 1,
        .inspect = inspect,
        .inspect_user = s,
    };
    return renderer_create(&desc, out);
}

fg_status stability_render(stability *s, const shot *what, image *out)
{
    renderer *r = NULL;
    *out = (image){ 0 };
    fg_status status = stability_open(s, what, &r);
    for (int i = 0; i < (what->frames ? what->frames : 1) && status == FG_OK; ++i)
        status = renderer_frame(r, what->time + i * what->step);
    if (status == FG_OK)
        status = renderer_read(r, what->layer, out);
    s->samples = status == FG_OK ? samples_of(r) : (double) NAN;
    renderer_destroy(r);
    return status;
}
