// SPDX-License-Identifier: MIT
// Which passes run: from those with an effect outside backwards to what they need.
#include "graph_priv.h"

#include <string.h>

enum { WALK = 16 }; // versions that are not worth an index

enum { LIVE = 0 }; // plan.step_of of a pass that runs, until it has its step

typedef struct span {
    unsigned mip, mip_end, layer, layer_end;
} span;

typedef struct cull {
    fg_graph *g;
    const decl *d;
    plan *p;
    uint32_t top;  // of g->stack
    uint32_t mask; // of g->table when passes with FG_EFFECT_INTERNAL are there
    bool internals;
    bool walks; // g->seen is filled
} cull;

static void keep(cull *c, uint32_t pass)
{
    if (c->p->step_of[pass] != NONE || c->d->pass[pass].reason)
        return;
    c->p->step_of[pass] = LIVE;
    c->g->stack[c->top++] = pass;
}

static bool covers(const io_rec *w, const span *r)
{
    return w->mip <= r->mip && w->mip + w->mips >= (int) r->mip_end && w->layer <= r->layer &&
           w->layer + w->layers >= (int) r->layer_end;
}

static bool meets(const io_rec *w, const span *r)
{
    return w->mip < r->mip_end && (int) r->mip < w->mip + w->mips && w->layer < r->layer_end &&
           (int) r->layer < w->layer + w->layers;
}

// Takes away from `r` what `w` writes, where the rest is still one range.
static void subtract(span *r, const io_rec *w)
{
    const unsigned mip_end = w->mip + w->mips, layer_end = w->layer + w->layers;
    if (w->layer <= r->layer && layer_end >= r->layer_end) {
        if (w->mip <= r->mip)
            r->mip = mip_end;
        else if (mip_end >= r->mip_end)
            r->mip_end = w->mip;
    } else if (w->mip <= r->mip && mip_end >= r->mip_end) {
        if (w->layer <= r->layer)
            r->layer = layer_end;
        else if (layer_end >= r->layer_end)
            r->layer_end = w->layer;
    }
}

// Keeps the passes that wrote what `io` sees at `version`, the newest first until all of
// its range is covered. False if none of them runs in this frame.
static bool need(cull *c, const io_rec *io, uint32_t version)
{
    const version_rec *v = &c->p->version[c->p->res[io->res].version];
    span left = { io->mip, io->mip + io->mips, io->layer, io->layer + io->layers };
    bool made = false;
    for (; version; version--) {
        c->g->work++;
        const version_rec *w = &v[version - 1];
        if (w->pass == NONE)
            return true;
        const pass_rec *pass = &c->d->pass[w->pass];
        if (pass->reason)
            continue;
        const uint32_t end = pass->io + pass->reads + pass->writes;
        for (uint32_t k = w->io; k < end; k++) {
            const io_rec *write = &c->d->io[k];
            if (write->res != io->res || !meets(write, &left))
                continue;
            keep(c, w->pass);
            made = true;
            if (covers(write, &left))
                return true;
            subtract(&left, write);
        }
    }
    return made;
}

// ---- resources that are written in parts, many times --------------------------------------

// The newest version that wrote any of what `io` touches; of 3D textures any slice counts.
static uint32_t newest(const uint32_t *last, const res_rec *r, const io_rec *io)
{
    const uint32_t layers = sub_layers(r);
    const uint32_t from = r->depth ? 0 : io->layer, count = r->depth ? 1 : io->layers;
    uint32_t version = 0;
    for (uint32_t m = io->mip; m < (uint32_t) io->mip + io->mips; m++)
        for (uint32_t l = from; l < from + count; l++)
            if (last[m * layers + l] > version)
                version = last[m * layers + l];
    return version;
}

static void set_newest(uint32_t *last, const res_rec *r, const io_rec *io)
{
    const uint32_t layers = sub_layers(r);
    const uint32_t from = r->depth ? 0 : io->layer, count = r->depth ? 1 : io->layers;
    for (uint32_t m = io->mip; m < (uint32_t) io->mip + io->mips; m++)
        for (uint32_t l = from; l < from + count; l++)
            last[m * layers + l] = io->version;
}

// Gives the resources worth it a place in g->last: plan.res[].written, until they are placed.
static bool room_for_walks(cull *c)
{
    fg_graph *g = c->g;
    uint64_t total = 0;
    for (uint32_t r = 0; r < c->d->res_count; r++) {
        const bool worth = c->p->res[r].versions > WALK && sub_count(&c->d->res[r]) > 1;
        c->p->res[r].written = worth ? (uint32_t) total : NONE;
        total += worth ? sub_count(&c->d->res[r]) : 0;
    }
    c->walks = total > 0;
    if (!GROW(g, g->last, g->last_cap, total) || !GROW(g, g->seen, g->seen_cap, c->d->io_count))
        return false;
    for (uint32_t r = 0; r < c->d->res_count; r++)
        for (uint32_t s = 0; c->p->res[r].written != NONE && s < sub_count(&c->d->res[r]); s++)
            g->last[c->p->res[r].written + s] = c->d->res[r].import != NONE;
    return true;
}

// Where need() of each access may begin: in a legal order an access meets the last write.
static bool index_walks(cull *c)
{
    fg_graph *g = c->g;
    if (!room_for_walks(c))
        return false;
    for (uint32_t i = 0; c->walks && i < c->d->pass_count; i++) {
        const pass_rec *p = &c->d->pass[c->p->order[i]];
        for (uint32_t k = p->io; !p->reason && k < io_end(p); k++) {
            const io_rec *io = &c->d->io[k];
            const uint32_t at = c->p->res[io->res].written;
            g->work += at == NONE ? 0 : io->mips * io->layers;
            g->seen[k] = at == NONE ? NONE : newest(g->last + at, &c->d->res[io->res], io);
        }
        for (uint32_t k = p->io + p->reads; !p->reason && k < io_end(p); k++) {
            const io_rec *io = &c->d->io[k];
            const uint32_t at = c->p->res[io->res].written;
            if (at != NONE)
                set_newest(g->last + at, &c->d->res[io->res], io);
        }
    }
    return true;
}

static uint32_t newest_seen(const cull *c, uint32_t k, uint32_t version)
{
    return c->walks && c->g->seen[k] < version ? c->g->seen[k] : version;
}

// A pass that reads what nothing made.
static void starve(cull *c, uint32_t pass, const io_rec *io)
{
    const version_rec *v = &c->p->version[c->p->res[io->res].version];
    const uint32_t version = io->flags & IO_LAST ? c->p->res[io->res].versions : io->version;
    char text[64];
    const char *range = fg_range_text(text, sizeof text, &c->d->res[io->res], io);
    for (uint32_t k = version; k; k--) {
        const uint32_t writer = v[k - 1].pass;
        if (writer == NONE || !c->d->pass[writer].reason)
            continue;
        fg_decl_fail(
            c->g, FG_ERR_INVALID,
            "pass '%s' reads '%s', but its writer '%s' is left out: %s; mark the read optional",
            pass_name(c->d, pass), res_name(c->d, io->res), pass_name(c->d, writer),
            c->d->text + c->d->pass[writer].reason);
        return;
    }
    fg_decl_fail(c->g, FG_ERR_INVALID, "pass '%s' reads '%s' before any pass writes it%s%s",
                 pass_name(c->d, pass), res_name(c->d, io->res), *range ? ": " : "", range);
}

// ---- groups: passes whose names share the text before the first '.' -------------------

static size_t group_length(const char *name)
{
    return strcspn(name, ".");
}

// Finds the table entry of the group of `pass`; entries are pass numbers + 1.
static uint32_t group_at(const cull *c, uint32_t pass)
{
    const char *name = pass_name(c->d, pass);
    const size_t length = group_length(name);
    uint32_t at = fg_hash(name, length) & c->mask;
    for (; c->g->table[at]; at = (at + 1) & c->mask) {
        const char *other = pass_name(c->d, c->g->table[at] - 1);
        if (group_length(other) == length && !memcmp(name, other, length))
            break;
    }
    return at;
}

// Lists internal passes by group: the table has the first, `next` (behind the stack) the rest.
static void index_groups(cull *c)
{
    uint32_t *next = c->g->stack + c->d->pass_count;
    c->mask = 15;
    while (c->mask < 2 * (uint64_t) c->d->pass_count)
        c->mask = 2 * c->mask + 1;
    memset(c->g->table, 0, ((size_t) c->mask + 1) * sizeof *c->g->table);
    for (uint32_t i = c->d->pass_count; i-- > 0;) {
        if (c->d->pass[i].effect != FG_EFFECT_INTERNAL)
            continue;
        const uint32_t at = group_at(c, i);
        next[i] = c->g->table[at];
        c->g->table[at] = i + 1;
    }
}

static void keep_group(cull *c, uint32_t pass)
{
    const uint32_t *next = c->g->stack + c->d->pass_count;
    const uint32_t at = group_at(c, pass);
    for (uint32_t k = c->g->table[at]; k; k = next[k - 1]) {
        if (c->p->step_of[k - 1] == LIVE && k - 1 != pass)
            break; // the group has been kept before
        keep(c, k - 1);
    }
}

// ---- the sweep ----------------------------------------------------------------------

static void keep_inputs(cull *c, uint32_t pass)
{
    const pass_rec *p = &c->d->pass[pass];
    const io_rec *io = &c->d->io[p->io];
    for (int k = 0; k < p->reads; k++) {
        const uint32_t version = io[k].flags & IO_LAST
                                     ? c->p->res[io[k].res].versions
                                     : newest_seen(c, p->io + (uint32_t) k, io[k].version);
        if (need(c, &io[k], version))
            continue;
        if (io[k].flags & IO_OPTIONAL)
            c->p->absent[p->io + (uint32_t) k] = 1;
        else
            starve(c, pass, &io[k]);
    }
    for (int k = p->reads; k < p->reads + p->writes; k++)
        if (!(io[k].flags & (IO_CLEAR | IO_DISCARD)))
            need(c, &io[k], newest_seen(c, p->io + (uint32_t) k, io[k].version - 1u));
    if (c->internals)
        keep_group(c, pass);
}

static void sweep(cull *c)
{
    while (c->top)
        keep_inputs(c, c->g->stack[--c->top]);
}

static bool writes_import(const cull *c, const pass_rec *p)
{
    const io_rec *io = &c->d->io[p->io + p->reads];
    for (int k = 0; k < p->writes; k++)
        if (c->d->res[io[k].res].import != NONE)
            return true;
    return false;
}

// Whether all that a pass must read is made by passes that serve this frame.
static bool fed(const cull *c, uint32_t pass)
{
    const pass_rec *p = &c->d->pass[pass];
    for (uint32_t k = p->io; k < p->io + p->reads; k++) {
        const io_rec *io = &c->d->io[k];
        const res_plan *r = &c->p->res[io->res];
        uint32_t version = io->flags & IO_LAST ? r->versions : io->version;
        for (; version; version--) {
            const uint32_t w = c->p->version[r->version + version - 1].pass;
            if (w == NONE || !c->d->pass[w].reason)
                break;
        }
        if (!version && !(io->flags & IO_OPTIONAL))
            return false;
    }
    return true;
}

fg_status fg_cull(fg_graph *g)
{
    const decl *d = g->open;
    cull c = { .g = g, .d = d, .p = g->next };
    for (uint32_t i = 0; i < d->pass_count; i++) {
        const pass_rec *pass = &d->pass[i];
        c.p->step_of[i] = NONE;
        c.internals |= pass->effect == FG_EFFECT_INTERNAL;
        if (pass->effect == FG_EFFECT_EXTERNAL || (d->import_count && writes_import(&c, pass)))
            keep(&c, i);
    }
    if (d->io_count)
        memset(c.p->absent, 0, d->io_count);
    if (c.internals)
        index_groups(&c);
    if (g->most_versions > WALK && !index_walks(&c)) {
        fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory while culling");
        return FG_ERR_MEMORY;
    }
    for (uint32_t i = 0; i < d->export_count; i++) {
        const res_rec *r = &d->res[d->exports[i].res];
        const io_rec whole = { .res = d->exports[i].res,
                               .mips = r->mips,
                               .layers =
                                   r->depth ? (uint16_t) r->depth : (uint16_t) sub_layers(r) };
        need(&c, &whole, d->exports[i].version);
    }
    sweep(&c);
    if (g->debug & FG_DEBUG_KEEP_ALL)
        for (uint32_t i = 0; i < d->pass_count; i++)
            if (fed(&c, i))
                keep(&c, i);
    sweep(&c);
    return d->status;
}
