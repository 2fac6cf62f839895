// SPDX-License-Identifier: MIT
#include <fg/device.h>

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct object {
    uint64_t bytes; // 0: a view
    uint32_t next;  // free list, in numbers
    bool live;
} object;

typedef struct null_device {
    fg_device base;
    fg_device_ops ops; // timing only where it records
    fg_device_limits limits;
    bool record;
    int fail_at, creations, live;
    uint64_t bytes;
    object *objects; // object n is at n - 1
    uint32_t count, cap;
    char *log;
    size_t log_size, log_cap;
} null_device;

static const char *const bit_names[] = { "sampled", "image", "attachment", "storage", "uniform",
                                         "vertex",  "index", "indirect",   "copy" };

static bool log_room(null_device *d, size_t more)
{
    if (d->log_size + more < d->log_cap)
        return true;
    const size_t cap = 2 * (d->log_cap + more);
    char *log = realloc(d->log, cap);
    if (!log)
        return false;
    d->log = log;
    d->log_cap = cap;
    return true;
}

// Lines that no longer fit in memory are lost.
static FG_PRINTF(2, 3) void put(null_device *d, const char *fmt, ...)
{
    va_list args, again;
    if (!d->record)
        return;
    va_start(args, fmt);
    va_copy(again, args);
    const int n = vsnprintf(NULL, 0, fmt, args);
    va_end(args);
    if (n > 0 && log_room(d, (size_t) n + 1)) {
        vsnprintf(d->log + d->log_size, (size_t) n + 1, fmt, again);
        d->log_size += (size_t) n;
    }
    va_end(again);
}

static const fg_device_limits *limits(fg_device *dev)
{
    return &((null_device *) dev)->limits;
}

// ---- objects ----------------------------------------------------------------------------

static fg_status create(null_device *d, uint64_t bytes, uint32_t *out)
{
    *out = 0;
    if (++d->creations == d->fail_at)
        return FG_ERR_MEMORY;
    if (d->count == d->cap) {
        const uint32_t cap = d->cap ? 2 * d->cap : 64;
        object *objects = realloc(d->objects, cap * sizeof *objects);
        if (!objects)
            return FG_ERR_MEMORY;
        d->objects = objects;
        d->cap = cap;
    }
    d->objects[d->count++] = (object){ .bytes = bytes, .live = true };
    d->live++;
    d->bytes += bytes;
    *out = d->count;
    return FG_OK;
}

static void destroy_object(null_device *d, const char *what, uint32_t n)
{
    put(d, "destroy %s %u\n", what, n);
    if (!n || n > d->count || !d->objects[n - 1].live)
        return;
    d->objects[n - 1].live = false;
    d->bytes -= d->objects[n - 1].bytes;
    d->live--;
}

static uint64_t texture_bytes(const fg_tex_desc *t)
{
    uint64_t texels = 0;
    for (int m = 0; m < t->mips; m++) {
        const int w = t->width >> m, h = t->height >> m, s = t->depth >> m;
        texels += (uint64_t) (w ? w : 1) * (uint64_t) (h ? h : 1) * (uint64_t) (s ? s : 1);
    }
    return texels * (uint64_t) (t->layers ? t->layers : 1) * (uint64_t) t->samples *
           (uint64_t) fg_format_get(t->format)->bytes;
}

// "RGBA16F 64x64", and what is not plain 2D.
static const char *shape(char *buf, size_t size, const fg_tex_desc *t)
{
    int n = snprintf(buf, size, "%s %dx%d", fg_format_get(t->format)->name, t->width, t->height);
    if (t->depth)
        n += snprintf(buf + n, size - (size_t) n, "x%d", t->depth);
    if (t->layers)
        n += snprintf(buf + n, size - (size_t) n, " %s %d", t->cube ? "cube" : "layers", t->layers);
    if (t->mips > 1)
        n += snprintf(buf + n, size - (size_t) n, " mips %d", t->mips);
    if (t->samples > 1)
        snprintf(buf + n, size - (size_t) n, " samples %d", t->samples);
    return buf;
}

static fg_status texture_create(fg_device *dev, const char *label, const fg_tex_desc *desc,
                                uint32_t *out)
{
    null_device *d = (null_device *) dev;
    char buf[128];
    const fg_status status = create(d, texture_bytes(desc), out);
    put(d, "texture %s %s -> %u\n", label, shape(buf, sizeof buf, desc), *out);
    return status;
}

static fg_status view_create(fg_device *dev, const char *label, uint32_t of,
                             const fg_tex_desc *desc, uint32_t *out)
{
    null_device *d = (null_device *) dev;
    char buf[128];
    const fg_status status = create(d, 0, out);
    put(d, "view %s %s of %u -> %u\n", label, shape(buf, sizeof buf, desc), of, *out);
    return status;
}

static fg_status buffer_create(fg_device *dev, const char *label, uint64_t size, uint32_t *out)
{
    null_device *d = (null_device *) dev;
    const fg_status status = create(d, size, out);
    put(d, "buffer %s %llu -> %u\n", label, (unsigned long long) size, *out);
    return status;
}

static void texture_destroy(fg_device *dev, uint32_t n)
{
    destroy_object((null_device *) dev, "texture", n);
}

static void buffer_destroy(fg_device *dev, uint32_t n)
{
    destroy_object((null_device *) dev, "buffer", n);
}

// ---- frames -----------------------------------------------------------------------------

static fg_status frame_begin(fg_device *dev, uint64_t frame, int timers)
{
    put((null_device *) dev, "frame %llu timers %d\n", (unsigned long long) frame, timers);
    return FG_OK;
}

static fg_status frame_end(fg_device *dev)
{
    put((null_device *) dev, "end frame\n");
    return FG_OK;
}

static void barrier(fg_device *dev, unsigned bits)
{
    null_device *d = (null_device *) dev;
    if (!d->record)
        return;
    const char *before = "barrier ";
    for (int i = 0; i < FG_COUNT(bit_names); i++)
        if (bits >> i & 1) {
            put(d, "%s%s", before, bit_names[i]);
            before = "|";
        }
    put(d, "\n");
}

static void clear(fg_device *dev, const fg_clear *c)
{
    null_device *d = (null_device *) dev;
    if (!d->record)
        return;
    put(d, "%s %u", c->poison ? "poison" : "clear", c->object);
    if (c->tex)
        put(d, " mips %d+%d layers %d+%d", c->mip, c->mips, c->layer, c->layers);
    if (!c->poison)
        put(d, " to %g %g %g %g", (double) c->value[0], (double) c->value[1], (double) c->value[2],
            (double) c->value[3]);
    put(d, "\n");
}

static fg_status pass_begin(fg_device *dev, const fg_pass_begin *b)
{
    null_device *d = (null_device *) dev;
    if (!d->record)
        return FG_OK;
    put(d, "pass %s", b->name);
    if (b->kind == FG_KIND_COMPUTE)
        put(d, " compute");
    if (b->width)
        put(d, " %dx%d", b->width, b->height);
    for (int i = 0; i < b->color_count + 1; i++) {
        const fg_attachment *a = i < b->color_count ? &b->color[i] : &b->depth;
        if (!a->object)
            continue;
        put(d, " %s %u",
            i < b->color_count   ? "color"
            : b->depth_read_only ? "depth-test"
                                 : "depth",
            a->object);
        if (a->mip)
            put(d, " mip %d", a->mip);
        if (a->layer)
            put(d, " layer %d", a->layer);
        if (a->layered)
            put(d, " layered");
    }
    put(d, "\n");
    return FG_OK;
}

static void pass_end(fg_device *dev, const fg_pass_begin *b)
{
    (void) dev;
    (void) b;
}

// The table asks for these parameters. NOLINTNEXTLINE(readability-non-const-parameter)
static bool timing(fg_device *dev, int timer, double *start_ms, double *ms, uint64_t *frame)
{
    (void) dev;
    (void) timer;
    (void) start_ms;
    (void) ms;
    (void) frame;
    return false;
}

static void reset(fg_device *dev)
{
    put((null_device *) dev, "reset\n");
}

static void destroy(fg_device *dev)
{
    null_device *d = (null_device *) dev;
    free(d->objects);
    free(d->log);
    free(d);
}

static const fg_device_ops null_ops = {
    .name = "null",
    .limits = limits,
    .texture_create = texture_create,
    .view_create = view_create,
    .buffer_create = buffer_create,
    .texture_destroy = texture_destroy,
    .buffer_destroy = buffer_destroy,
    .frame_begin = frame_begin,
    .frame_end = frame_end,
    .barrier = barrier,
    .clear = clear,
    .pass_begin = pass_begin,
    .pass_end = pass_end,
    .reset = reset,
    .destroy = destroy,
};

fg_device *fg_null_create(const fg_null_desc *desc)
{
    null_device *d = calloc(1, sizeof *d);
    if (!d)
        return NULL;
    // The least that OpenGL 4.5 promises.
    static const fg_device_limits least = { 8, 16384, 2048, 2048, 4, (uint64_t) 1 << 27 };
    const fg_device_limits want = desc ? desc->limits : (fg_device_limits){ 0 };
    d->record = desc && desc->record;
    d->ops = null_ops;
    d->ops.timing = d->record ? timing : NULL;
    d->base.ops = &d->ops;
    d->fail_at = desc ? desc->fail_at : 0;
    d->limits = (fg_device_limits){
        .max_color_attachments =
            want.max_color_attachments ? want.max_color_attachments : least.max_color_attachments,
        .max_texture_size = want.max_texture_size ? want.max_texture_size : least.max_texture_size,
        .max_3d_size = want.max_3d_size ? want.max_3d_size : least.max_3d_size,
        .max_layers = want.max_layers ? want.max_layers : least.max_layers,
        .max_samples = want.max_samples ? want.max_samples : least.max_samples,
        .max_buffer_bytes = want.max_buffer_bytes ? want.max_buffer_bytes : least.max_buffer_bytes,
    };
    return &d->base;
}

const char *fg_null_log(const fg_device *dev)
{
    const null_device *d = (const null_device *) dev;
    return d->log && d->log_size ? d->log : "";
}

void fg_null_clear_log(fg_device *dev)
{
    null_device *d = (null_device *) dev;
    d->log_size = 0;
}

int fg_null_live_objects(const fg_device *dev)
{
    return ((const null_device *) dev)->live;
}

uint64_t fg_null_live_bytes(const fg_device *dev)
{
    return ((const null_device *) dev)->bytes;
}

void fg_device_destroy(fg_device *dev)
{
    if (dev)
        dev->ops->destroy(dev);
}
