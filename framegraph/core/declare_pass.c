// SPDX-License-Identifier: MIT
#include "graph_priv.h"

#include <stdio.h>
#include <string.h>

// What the slow path of an access finds wrong with its handle.
static void refuse_handle(fg_graph *g, const char *pass, const char *verb, fg_res res)
{
    const decl *d = g->open;
    if (res.epoch != (uint16_t) g->epoch) {
        const bool known = fg_epoch_built(g, res.epoch) && res.id - 1 < g->built->res_count;
        fg_decl_fail(g, FG_ERR_INVALID,
                     "pass '%s' %s a stale handle: resource %u%s%s%s is of an earlier declaration",
                     pass, verb, res.id, known ? " ('" : "",
                     known ? res_name(g->built, res.id - 1) : "", known ? "')" : "");
    } else if (res.id - 1 >= d->res_count) {
        fg_decl_fail(g, FG_ERR_INVALID, "pass '%s' %s resource %u, which does not exist", pass,
                     verb, res.id);
    } else {
        fg_decl_fail(g, FG_ERR_INVALID, "pass '%s' %s '%s', which has more than %d versions", pass,
                     verb, res_name(d, res.id - 1), VERSION_LAST - 1);
    }
}

static bool resolve_range(fg_graph *g, const char *pass, const fg_io *in, const res_rec *r,
                          io_rec *out)
{
    const unsigned layers = sub_layers(r);
    const unsigned all_layers = r->depth ? (unsigned) r->depth : layers;
    const unsigned mips = in->mips ? in->mips : r->mips - (in->mip < r->mips ? in->mip : 0u);
    const unsigned count =
        in->layers ? in->layers : all_layers - (in->layer < all_layers ? in->layer : 0u);
    if (!(r->flags & RES_TEXTURE))
        REFUSE("pass '%s': buffer '%s' has no mips or layers to choose", pass,
               g->open->text + r->name);
    if (in->mip + mips > r->mips || in->layer + count > all_layers)
        REFUSE("pass '%s': mips %u..%u, layers %u..%u of '%s' are out of range, it has %u mips, %u "
               "layers",
               pass, in->mip, in->mip + mips - 1, in->layer, in->layer + count - 1,
               g->open->text + r->name, r->mips, all_layers);
    out->mip = in->mip;
    out->mips = (uint8_t) mips;
    out->layer = in->layer;
    out->layers = (uint16_t) count;
    if (mips == r->mips && count == all_layers)
        out->flags |= IO_WHOLE;
    return true;
}

static fg_use default_use(const res_rec *r, bool write, fg_kind kind)
{
    if (!(r->flags & RES_TEXTURE))
        return FG_USE_STORAGE;
    if (!write)
        return FG_USE_SAMPLED;
    if (kind == FG_KIND_COMPUTE)
        return FG_USE_IMAGE;
    return fg_formats[r->format].depth ? FG_USE_DEPTH : FG_USE_COLOR;
}

static bool take_io(fg_graph *g, const fg_pass_desc *pass, const fg_io *in, bool write, io_rec *out)
{
    const decl *d = g->open;
    const char *verb = write ? "writes" : "reads";
    if (in->res.epoch != (uint16_t) g->epoch || in->res.id - 1 >= d->res_count ||
        !in->res.version) {
        refuse_handle(g, pass->name, verb, in->res);
        return false;
    }
    const res_rec *r = &d->res[in->res.id - 1];
    if ((unsigned) in->use > FG_USE_COPY || (unsigned) in->load > FG_LOAD_DISCARD)
        REFUSE("pass '%s' %s '%s': use %d or load %d does not exist", pass->name, verb,
               d->text + r->name, (int) in->use, (int) in->load);
    out->res = in->res.id - 1;
    out->version = in->res.version;
    out->use = (uint8_t) (in->use ? in->use : default_use(r, write, pass->kind));
    out->flags = (uint8_t) ((write ? IO_WRITE : 0) | (in->optional && !write ? IO_OPTIONAL : 0) |
                            (write && in->load == FG_LOAD_CLEAR ? IO_CLEAR : 0) |
                            (write && in->load == FG_LOAD_DISCARD ? IO_DISCARD : 0));
    out->zero = 0;
    if (in->res.version == VERSION_LAST) {
        if (write)
            REFUSE("pass '%s' writes last frame's '%s', which is over", pass->name,
                   d->text + r->name);
        out->flags |= IO_LAST;
    }
    if (in->mip | in->mips | in->layer | in->layers)
        return resolve_range(g, pass->name, in, r, out);
    out->flags |= IO_WHOLE;
    out->mip = 0;
    out->mips = r->mips;
    out->layer = 0;
    out->layers = r->depth ? (uint16_t) r->depth : (uint16_t) sub_layers(r);
    return true;
}

static bool take_ios(fg_graph *g, const fg_pass_desc *pass, pass_rec *p)
{
    decl *d = g->open;
    for (int i = 0; i < FG_MAX_READS; i++) {
        const fg_io *in = &pass->reads[i];
        if (!in->res.id) {
            if (!in->optional)
                break;
            p->flags |= PASS_ABSENT;
            continue;
        }
        if (!take_io(g, pass, in, false, &d->io[d->io_count]))
            return false;
        d->io_count++;
        p->reads++;
    }
    for (int i = 0; i < FG_MAX_WRITES; i++) {
        const fg_io *in = &pass->writes[i];
        if (!in->res.id)
            break;
        if (!take_io(g, pass, in, true, &d->io[d->io_count]))
            return false;
        if (in->load == FG_LOAD_CLEAR)
            memcpy(d->clear[d->clear_count++].rgba, in->clear, sizeof in->clear);
        d->io_count++;
        p->writes++;
    }
    return true;
}

// "scene has no 'emissive', 'area light'". Part of the key: it changes with the names.
static bool add_reason(fg_graph *g, pass_rec *p, uint64_t lacking)
{
    char text[512];
    int at = snprintf(text, sizeof text, "scene has no");
    const char *comma = "";
    for (int bit = 0; bit < 64 && at < (int) sizeof text - 1; bit++) {
        if (!(lacking >> bit & 1))
            continue;
        const size_t left = sizeof text - (size_t) at;
        const char *name = bit < g->feature_count ? g->feature_names[bit] : NULL;
        at += name ? snprintf(text + at, left, "%s '%s'", comma, name)
                   : snprintf(text + at, left, "%s feature %d", comma, bit);
        comma = ",";
    }
    p->reason = fg_decl_text(g, text, strlen(text));
    return p->reason != 0;
}

static bool room_for_pass(fg_graph *g)
{
    decl *d = g->open;
    return GROW(g, d->pass, d->pass_cap, d->pass_count + 1) &&
           GROW(g, d->callback, d->callback_cap, d->pass_count + 1) &&
           GROW(g, d->io, d->io_cap, d->io_count + FG_MAX_READS + FG_MAX_WRITES) &&
           GROW(g, d->clear, d->clear_cap, d->clear_count + FG_MAX_WRITES);
}

static bool add_pass(fg_graph *g, const fg_pass_desc *in)
{
    decl *d = g->open;
    if (!in->name || !*in->name)
        REFUSE("pass %u: has no name", d->pass_count);
    if (!in->run)
        REFUSE("pass '%s': needs a run callback", in->name);
    if ((unsigned) in->kind > FG_KIND_COMPUTE || (unsigned) in->effect > FG_EFFECT_EXTERNAL)
        REFUSE("pass '%s': kind %d or effect %d does not exist", in->name, (int) in->kind,
               (int) in->effect);
    const size_t length = strlen(in->name);
    pass_rec p = {
        .needs = in->needs,
        .io = d->io_count,
        .clear = d->clear_count,
        .kind = (uint8_t) in->kind,
        .effect = (uint8_t) in->effect,
    };
    p.name = room_for_pass(g) ? fg_decl_text(g, in->name, length) : 0;
    const uint64_t lacking = in->needs & ~g->features;
    if (!p.name || (lacking && !add_reason(g, &p, lacking))) {
        fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory while declaring '%s'", in->name);
        return false;
    }
    if (!take_ios(g, in, &p))
        return false;
    d->pass[d->pass_count] = p;
    d->callback[d->pass_count++] = (callback){ in->run, in->user };
    return true;
}

void fg_passes(fg_graph *g, const fg_pass_desc *passes, int count)
{
    if (g->running || !g->declaring) {
        fg_decl_fail(g, FG_ERR_INVALID, "pass '%s': declared %s",
                     count > 0 && passes->name ? passes->name : "",
                     g->running ? "while the graph runs"
                                : "outside a declaration, call fg_graph_begin()");
        return;
    }
    for (int i = 0; i < count; i++) {
        if (g->prefix_length) {
            fg_pass_desc named = passes[i];
            named.name = fg_decl_name(g, named.name);
            add_pass(g, &named);
        } else {
            add_pass(g, &passes[i]);
        }
    }
}
