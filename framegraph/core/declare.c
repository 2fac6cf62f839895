// SPDX-License-Identifier: MIT
#include "graph_priv.h"

#include <stdio.h>
#include <string.h>

// ---- the declaration as a whole -----------------------------------------------------

static void fail_v(fg_graph *g, fg_status status, const char *fmt, va_list args)
{
    char msg[1024];
    vsnprintf(msg, sizeof msg, fmt, args);
    fg_logf(g->log, FG_LOG_ERROR, "%s", msg);
    if (g->running)
        g->disturbed = true;
    else if (g->declaring && g->open->status == FG_OK)
        g->open->status = status;
}

fg_status fg_misuse(fg_graph *g, const char *call, const char *rule)
{
    fg_logf(g->log, FG_LOG_ERROR, "graph: %s() called %s", call, rule);
    g->disturbed = g->running;
    return FG_ERR_INVALID;
}

void fg_decl_fail(fg_graph *g, fg_status status, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    fail_v(g, status, fmt, args);
    va_end(args);
}

void fg_fail(fg_graph *g, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    fail_v(g, FG_ERR_INVALID, fmt, args);
    va_end(args);
}

void fg_decl_reset(decl *d)
{
    d->res_count = d->pass_count = d->io_count = d->export_count = d->text_count = 0;
    d->clear_count = d->import_count = 0;
    d->status = FG_OK;
}

void fg_decl_free(const fg_allocator *a, decl *d)
{
    fg_release(a, d->res);
    fg_release(a, d->pass);
    fg_release(a, d->io);
    fg_release(a, d->exports);
    fg_release(a, d->text);
    fg_release(a, d->callback);
    fg_release(a, d->clear);
    fg_release(a, d->import);
}

#define SAME(field, n)                                                                             \
    (a->n == b->n && (!a->n || !memcmp(a->field, b->field, a->n * sizeof *a->field)))

bool fg_decl_equal(const decl *a, const decl *b)
{
    return SAME(res, res_count) && SAME(pass, pass_count) && SAME(io, io_count) &&
           SAME(exports, export_count) && SAME(text, text_count);
}

uint32_t fg_decl_text(fg_graph *g, const char *text, size_t length)
{
    decl *d = g->open;
    const uint32_t at = d->text_count ? d->text_count : 1;
    if (!GROW(g, d->text, d->text_cap, at + length + 1))
        return 0;
    d->text[0] = '\0';
    memcpy(d->text + at, text, length);
    d->text[at + length] = '\0';
    d->text_count = at + (uint32_t) length + 1;
    return at;
}

// Whether a declaration may be added to; logs why not.
static bool may_declare(fg_graph *g, const char *what, const char *name)
{
    if (g->running) {
        fg_decl_fail(g, FG_ERR_INVALID, "%s '%s': declared while the graph runs", what,
                     name ? name : "");
        return false;
    }
    if (!g->declaring) {
        fg_decl_fail(g, FG_ERR_INVALID,
                     "%s '%s': declared outside a declaration, call fg_graph_begin()", what,
                     name ? name : "");
        return false;
    }
    if (!name || !*name) {
        fg_decl_fail(g, FG_ERR_INVALID, "%s %u: has no name", what,
                     *what == 'p' ? g->open->pass_count : g->open->res_count);
        return false;
    }
    return true;
}

void fg_prefix(fg_graph *g, const char *prefix)
{
    if (!may_declare(g, "graph", "fg_prefix()"))
        return;
    prefix = prefix ? prefix : "";
    const size_t length = strlen(prefix);
    if (length >= sizeof g->prefix || strchr(prefix, '.')) {
        fg_decl_fail(g, FG_ERR_INVALID,
                     "fg_prefix(): '%s' must have at most %d bytes and no '.' among them", prefix,
                     (int) sizeof g->prefix - 1);
        return;
    }
    memcpy(g->prefix, prefix, length + 1);
    g->prefix_length = (uint32_t) length;
}

const char *fg_decl_name(fg_graph *g, const char *name)
{
    if (!g->prefix_length || !name || !*name)
        return name;
    const size_t length = strlen(name) + 1;
    if (!GROW(g, g->name, g->name_cap, g->prefix_length + length)) {
        fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory while declaring '%s%s'", g->prefix,
                     name);
        return name;
    }
    memcpy(g->name, g->prefix, g->prefix_length);
    memcpy(g->name + g->prefix_length, name, length);
    return g->name;
}

void fg_graph_begin(fg_graph *g, const fg_frame_desc *desc)
{
    static const fg_frame_desc none = { 0 };
    if (g->running) {
        fg_misuse(g, "fg_graph_begin", "while the graph runs");
        return;
    }
    desc = desc ? desc : &none;
    fg_decl_reset(g->open);
    g->open->width = desc->width;
    g->open->height = desc->height;
    g->features = desc->features;
    g->feature_names = desc->feature_names;
    g->feature_count = desc->feature_names ? desc->feature_count : 0;
    g->prefix_length = 0;
    g->declaring = true;
    g->last_known = false;
    g->epoch++;
}

fg_res fg_next(fg_res res)
{
    // Version 0 is refused where it is used: there are too many.
    if (res.id && res.version != VERSION_LAST)
        res.version = res.version == VERSION_LAST - 1 ? 0 : (uint16_t) (res.version + 1);
    return res;
}

// ---- resources --------------------------------------------------------------------------

// Levels of the full chain.
static int mip_levels(int width, int height, int depth)
{
    return 32 - __builtin_clz((unsigned) (width | height | depth));
}

static int at_mip(int size, int mip)
{
    return size >> mip > 1 ? size >> mip : 1;
}

static uint64_t texture_bytes(const res_rec *r)
{
    uint64_t texels = 0;
    for (int m = 0; m < r->mips; m++)
        texels += (uint64_t) at_mip(r->width, m) * (uint64_t) at_mip(r->height, m) *
                  (uint64_t) (r->depth ? at_mip(r->depth, m) : 1);
    const fg_format_info *f = &fg_formats[r->format];
    return texels * sub_layers(r) * r->samples * (uint64_t) f->bytes;
}

static bool frame_size(fg_graph *g, const char *name, const fg_tex_desc *desc, res_rec *r)
{
    if (desc->width < 0 || desc->height < 0 || !desc->width != !desc->height)
        REFUSE("texture '%s': size is %dx%d, must be positive or 0x0 for the frame's", name,
               desc->width, desc->height);
    r->width = desc->width;
    r->height = desc->height;
    if (desc->width)
        return true;
    if (desc->scale_log2 < 0 || desc->scale_log2 > 15)
        REFUSE("texture '%s': scale_log2 is %d, must be in [0, 15]", name, desc->scale_log2);
    if (g->open->width <= 0 || g->open->height <= 0)
        REFUSE("texture '%s': has the frame's size, which is %dx%d and must be positive", name,
               g->open->width, g->open->height);
    const int round_up = (1 << desc->scale_log2) - 1;
    r->width = (int) (((int64_t) g->open->width + round_up) >> desc->scale_log2);
    r->height = (int) (((int64_t) g->open->height + round_up) >> desc->scale_log2);
    return true;
}

static bool within_limits(fg_graph *g, const char *name, const fg_tex_desc *desc, const res_rec *r)
{
    const fg_device_limits *l = g->limits;
    const int size = desc->depth ? l->max_3d_size : l->max_texture_size;
    if (r->width <= size && r->height <= size && desc->depth <= size &&
        desc->layers <= l->max_layers && desc->samples <= l->max_samples &&
        desc->depth <= UINT16_MAX && desc->layers <= UINT16_MAX)
        return true;
    fg_decl_fail(
        g, FG_ERR_UNSUPPORTED,
        "texture '%s': %dx%dx%d, %d layers, %d samples is more than the device has: size %d, "
        "%d layers, %d samples",
        name, r->width, r->height, desc->depth, desc->layers, desc->samples, size, l->max_layers,
        l->max_samples);
    return false;
}

static bool texture_shape(fg_graph *g, const char *name, const fg_tex_desc *desc, res_rec *r)
{
    if (!fg_format_get(desc->format))
        REFUSE("texture '%s': format %d does not exist", name, (int) desc->format);
    if (desc->depth < 0 || desc->layers < 0 || desc->samples < 0)
        REFUSE("texture '%s': depth %d, layers %d, samples %d must not be negative", name,
               desc->depth, desc->layers, desc->samples);
    if (!frame_size(g, name, desc, r) || !within_limits(g, name, desc, r))
        return false;
    if (desc->depth && (desc->layers || desc->cube || desc->samples > 1))
        REFUSE("texture '%s': a 3D texture has no layers, faces or samples", name);
    if (desc->cube && (desc->layers % 6 || r->width != r->height || desc->samples > 1))
        REFUSE(
            "texture '%s': a cube map is square, has a multiple of 6 layers and one sample; this "
            "is %dx%d with %d layers and %d samples",
            name, r->width, r->height, desc->layers, desc->samples);
    const int full = mip_levels(r->width, r->height, desc->depth);
    if (desc->mips < FG_MIPS_ALL || desc->mips > full)
        REFUSE("texture '%s': %d mips, must be in [0, %d] or FG_MIPS_ALL", name, desc->mips, full);
    if (desc->samples > 1 && desc->mips != 0 && desc->mips != 1)
        REFUSE("texture '%s': a multisample texture has no mips", name);
    if ((unsigned) desc->history > FG_HISTORY_DISCARD)
        REFUSE("texture '%s': history policy %d does not exist", name, (int) desc->history);
    r->depth = (uint16_t) desc->depth;
    r->layers = (uint16_t) (desc->cube && !desc->layers ? 6 : desc->layers);
    r->mips = (uint8_t) (desc->mips == FG_MIPS_ALL ? full : desc->mips ? desc->mips : 1);
    r->samples = (uint8_t) (desc->samples ? desc->samples : 1);
    r->format = (uint8_t) desc->format;
    r->history = (uint8_t) desc->history;
    r->flags = RES_TEXTURE | (desc->cube ? RES_CUBE : 0);
    r->bytes = texture_bytes(r);
    return true;
}

static bool buffer_shape(fg_graph *g, const char *name, const fg_buf_desc *desc, res_rec *r)
{
    if (!desc->size)
        REFUSE("buffer '%s': size is 0 bytes, must be positive", name);
    if ((unsigned) desc->history > FG_HISTORY_DISCARD)
        REFUSE("buffer '%s': history policy %d does not exist", name, (int) desc->history);
    const uint64_t most = g->limits->max_buffer_bytes;
    if (desc->size > most) {
        fg_decl_fail(g, FG_ERR_UNSUPPORTED,
                     "buffer '%s': %llu bytes is more than the device's %llu", name,
                     (unsigned long long) desc->size, (unsigned long long) most);
        return false;
    }
    r->bytes = desc->size;
    r->history = (uint8_t) desc->history;
    r->mips = 1;
    r->samples = 1;
    return true;
}

static fg_res add_resource(fg_graph *g, const char *name, res_rec *r)
{
    decl *d = g->open;
    const size_t length = strlen(name);
    r->name = fg_decl_text(g, name, length);
    if (!r->name || !GROW(g, d->res, d->res_cap, d->res_count + 1)) {
        fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory while declaring '%s'", name);
        return (fg_res){ 0 };
    }
    d->res[d->res_count++] = *r;
    return (fg_res){ .id = d->res_count, .version = 1, .epoch = (uint16_t) g->epoch };
}

static bool same_desc(const fg_tex_desc *a, const fg_tex_desc *b)
{
    return a->format == b->format && a->width == b->width && a->height == b->height &&
           a->scale_log2 == b->scale_log2 && a->depth == b->depth && a->layers == b->layers &&
           a->mips == b->mips && a->samples == b->samples && a->cube == b->cube &&
           a->history == b->history;
}

// Runs of equal textures are common: the last good one is kept.
static bool texture_record(fg_graph *g, const char *name, const fg_tex_desc *desc, res_rec *r)
{
    if (!g->last_known || !same_desc(desc, &g->last_desc)) {
        if (!texture_shape(g, name, desc, r))
            return false;
        g->last_desc = *desc;
        g->last_rec = *r;
        g->last_known = true;
    }
    *r = g->last_rec;
    return true;
}

fg_res fg_texture(fg_graph *g, const char *name, const fg_tex_desc *desc)
{
    res_rec r = { .import = NONE };
    name = fg_decl_name(g, name);
    if (!may_declare(g, "texture", name) || !texture_record(g, name, desc, &r))
        return (fg_res){ 0 };
    return add_resource(g, name, &r);
}

fg_res fg_buffer(fg_graph *g, const char *name, const fg_buf_desc *desc)
{
    res_rec r = { .import = NONE };
    name = fg_decl_name(g, name);
    if (!may_declare(g, "buffer", name) || !buffer_shape(g, name, desc, &r))
        return (fg_res){ 0 };
    return add_resource(g, name, &r);
}

static fg_res add_import(fg_graph *g, const char *name, res_rec *r, uint32_t object)
{
    decl *d = g->open;
    const char *what = r->flags & RES_TEXTURE ? "texture" : "buffer";
    if (!object || r->history) {
        fg_decl_fail(g, FG_ERR_INVALID, "%s '%s': an import %s", what, name,
                     object ? "has no history" : "needs an object");
        return (fg_res){ 0 };
    }
    if (!GROW(g, d->import, d->import_cap, d->import_count + 1)) {
        fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory while declaring '%s'", name);
        return (fg_res){ 0 };
    }
    r->import = d->import_count;
    const fg_res res = add_resource(g, name, r);
    if (res.id)
        d->import[d->import_count++] = object;
    return res;
}

fg_res fg_import_texture(fg_graph *g, const char *name, const fg_tex_desc *desc, uint32_t object)
{
    res_rec r = { .import = NONE };
    name = fg_decl_name(g, name);
    if (!may_declare(g, "texture", name) || !texture_shape(g, name, desc, &r))
        return (fg_res){ 0 };
    return add_import(g, name, &r, object);
}

fg_res fg_import_buffer(fg_graph *g, const char *name, const fg_buf_desc *desc, uint32_t object)
{
    res_rec r = { .import = NONE };
    name = fg_decl_name(g, name);
    if (!may_declare(g, "buffer", name) || !buffer_shape(g, name, desc, &r))
        return (fg_res){ 0 };
    return add_import(g, name, &r, object);
}

// Whether `res` is a handle of the open declaration; says what is wrong with it.
static bool good_handle(fg_graph *g, const char *who, fg_res res)
{
    const decl *d = g->open;
    if (res.epoch != (uint16_t) g->epoch)
        REFUSE("%s: the handle of resource %u ('%s') is of an earlier declaration", who, res.id,
               fg_epoch_built(g, res.epoch) && res.id - 1 < g->built->res_count
                   ? res_name(g->built, res.id - 1)
                   : "no longer known");
    if (res.id - 1 >= d->res_count)
        REFUSE("%s: there is no resource %u", who, res.id);
    if (!res.version)
        REFUSE("%s: '%s' has more than %d versions", who, res_name(d, res.id - 1),
               VERSION_LAST - 1);
    return true;
}

fg_res fg_last_frame(fg_graph *g, fg_res res)
{
    if (!res.id || !may_declare(g, "graph", "fg_last_frame()") ||
        !good_handle(g, "fg_last_frame()", res))
        return (fg_res){ 0 };
    if (!g->open->res[res.id - 1].history) {
        fg_decl_fail(g, FG_ERR_INVALID,
                     "fg_last_frame(): '%s' is declared without a history policy",
                     res_name(g->open, res.id - 1));
        return (fg_res){ 0 };
    }
    res.version = VERSION_LAST;
    return res;
}

void fg_export(fg_graph *g, fg_res res)
{
    if (!may_declare(g, "graph", "fg_export()"))
        return;
    if (!res.id) {
        fg_decl_fail(g, FG_ERR_INVALID, "fg_export(): the handle is null");
        return;
    }
    decl *d = g->open;
    if (!good_handle(g, "fg_export()", res))
        return;
    if (res.version == VERSION_LAST) {
        fg_decl_fail(g, FG_ERR_INVALID, "fg_export(): last frame's '%s' cannot be exported",
                     res_name(d, res.id - 1));
        return;
    }
    if (!GROW(g, d->exports, d->export_cap, d->export_count + 1)) {
        fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory while exporting '%s'",
                     res_name(d, res.id - 1));
        return;
    }
    d->exports[d->export_count++] = (export_rec){ res.id - 1, res.version };
    d->res[res.id - 1].flags |= RES_EXPORT;
}
