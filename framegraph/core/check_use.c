// SPDX-License-Identifier: MIT
// What a pass does with its resources: uses against kinds and formats, overlap, attachments.
#include "graph_priv.h"

#define BIT(use) (1u << (use))

// Uses of a texture that is read or written, in a raster or a compute pass; of a buffer.
static const uint16_t texture_uses[2][2] = {
    { BIT(FG_USE_SAMPLED) | BIT(FG_USE_IMAGE) | BIT(FG_USE_COPY) | BIT(FG_USE_DEPTH),
      BIT(FG_USE_SAMPLED) | BIT(FG_USE_IMAGE) | BIT(FG_USE_COPY) },
    { BIT(FG_USE_IMAGE) | BIT(FG_USE_COPY) | BIT(FG_USE_DEPTH) | BIT(FG_USE_COLOR),
      BIT(FG_USE_IMAGE) | BIT(FG_USE_COPY) },
};
static const uint16_t buffer_uses[2] = {
    BIT(FG_USE_STORAGE) | BIT(FG_USE_COPY) | BIT(FG_USE_UNIFORM) | BIT(FG_USE_VERTEX) |
        BIT(FG_USE_INDEX) | BIT(FG_USE_INDIRECT),
    BIT(FG_USE_STORAGE) | BIT(FG_USE_COPY),
};

static void check_use(fg_graph *g, uint32_t pass, const io_rec *io)
{
    const decl *d = g->open;
    const res_rec *r = &d->res[io->res];
    const bool write = io->flags & IO_WRITE;
    const unsigned allowed =
        r->flags & RES_TEXTURE ? texture_uses[write][d->pass[pass].kind] : buffer_uses[write];
    if (!(allowed & BIT(io->use))) {
        fg_decl_fail(g, FG_ERR_INVALID, "%s pass '%s' %s %s '%s' as %s, which is not possible",
                     d->pass[pass].kind == FG_KIND_COMPUTE ? "compute" : "raster",
                     pass_name(d, pass), write ? "writes" : "reads",
                     r->flags & RES_TEXTURE ? "texture" : "buffer", res_name(d, io->res),
                     fg_use_name(io->use));
        return;
    }
    if (!(r->flags & RES_TEXTURE))
        return;
    const fg_format_info *f = &fg_formats[r->format];
    if ((io->use == FG_USE_IMAGE && !f->image) || (io->use == FG_USE_COLOR && !f->color) ||
        (io->use == FG_USE_DEPTH && !f->depth))
        fg_decl_fail(g, FG_ERR_INVALID, "pass '%s' uses '%s' as %s, which format %s does not allow",
                     pass_name(d, pass), res_name(d, io->res), fg_use_name(io->use), f->name);
}

// Two accesses of one pass to the same texels: only reads, or an image or a storage
// buffer that is read and written in place.
static void check_pair(fg_graph *g, uint32_t pass, const io_rec *a, const io_rec *b)
{
    const decl *d = g->open;
    const bool both = a->flags & b->flags & IO_WRITE;
    if (!((a->flags | b->flags) & IO_WRITE) || (a->flags & IO_LAST) || !io_overlap(a, b))
        return;
    if (!both && a->use == b->use && (a->use == FG_USE_IMAGE || a->use == FG_USE_STORAGE))
        return;
    char text[64];
    const char *range = fg_range_text(text, sizeof text, &d->res[b->res], b);
    fg_decl_fail(g, FG_ERR_INVALID, "pass '%s' %s '%s' as %s and writes it as %s at once%s%s",
                 pass_name(d, pass), both ? "writes" : "reads", res_name(d, b->res),
                 fg_use_name(a->use), fg_use_name(b->use), *range ? ": " : "", range);
}

typedef struct target {
    const io_rec *first; // the attachment that set the size
    int width, height, samples, colors;
    bool layered, depth;
} target;

static bool attaches_layers(const res_rec *r, const io_rec *io)
{
    return (r->layers || r->depth) && io->layers > 1;
}

static void check_attachment(fg_graph *g, uint32_t pass, const io_rec *io, target *t)
{
    const decl *d = g->open;
    const res_rec *r = &d->res[io->res];
    const char *name = res_name(d, io->res);
    const int width = r->width >> io->mip ? r->width >> io->mip : 1;
    const int height = r->height >> io->mip ? r->height >> io->mip : 1;
    const int slices =
        r->depth ? (r->depth >> io->mip ? r->depth >> io->mip : 1) : (int) sub_layers(r);
    if (io->mips != 1)
        fg_decl_fail(g, FG_ERR_INVALID,
                     "pass '%s' attaches %u mips of '%s': an attachment is one mip",
                     pass_name(d, pass), io->mips, name);
    if (io->layers != 1 && io->layers < slices)
        fg_decl_fail(
            g, FG_ERR_INVALID,
            "pass '%s' attaches %u of %d layers of '%s': an attachment is one layer or all",
            pass_name(d, pass), io->layers, slices, name);
    if (io->use == FG_USE_DEPTH && t->depth)
        fg_decl_fail(g, FG_ERR_INVALID, "pass '%s' attaches '%s' as a second depth attachment",
                     pass_name(d, pass), name);
    t->depth |= io->use == FG_USE_DEPTH;
    t->colors += io->use == FG_USE_COLOR;
    if (!t->first) {
        t->first = io;
        t->width = width;
        t->height = height;
        t->samples = r->samples;
        t->layered = attaches_layers(r, io);
    } else if (width != t->width || height != t->height || r->samples != t->samples) {
        fg_decl_fail(
            g, FG_ERR_INVALID,
            "pass '%s': attachment '%s' is %dx%d with %d samples, but '%s' is %dx%d with %d: "
            "they must be equal",
            pass_name(d, pass), name, width, height, r->samples, res_name(d, t->first->res),
            t->width, t->height, t->samples);
    } else if (t->layered != attaches_layers(r, io)) {
        fg_decl_fail(g, FG_ERR_INVALID,
                     "pass '%s': attachments '%s' and '%s' must both be layered or neither",
                     pass_name(d, pass), res_name(d, t->first->res), name);
    }
}

void fg_check_uses(fg_graph *g, uint32_t pass)
{
    const decl *d = g->open;
    const pass_rec *p = &d->pass[pass];
    const io_rec *io = &d->io[p->io];
    const int count = p->reads + p->writes;
    target t = { 0 };
    for (int k = 0; k < count; k++) {
        check_use(g, pass, &io[k]);
        for (int j = 0; j < k; j++)
            if (io[j].res == io[k].res)
                check_pair(g, pass, &io[j], &io[k]);
        if (io[k].use == FG_USE_COLOR || io[k].use == FG_USE_DEPTH)
            check_attachment(g, pass, &io[k], &t);
    }
    const int most = g->limits->max_color_attachments;
    if (t.colors > most)
        fg_decl_fail(g, FG_ERR_UNSUPPORTED,
                     "pass '%s' has %d colour attachments, the device has %d", pass_name(d, pass),
                     t.colors, most);
}
