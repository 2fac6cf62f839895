// SPDX-License-Identifier: MIT
// Steps in order, lifetimes, and a memory slot for each live resource. Transients of one
// group (equal shape, formats of one view class) take over each other's slots; for
// intervals, taking any free one needs as few as there are alive at once.
#include "graph_priv.h"

#include <string.h>

typedef struct place {
    fg_graph *g;
    const decl *d;
    plan *p;
    uint32_t mask;             // of g->table
    uint32_t like, like_group; // the transient placed last; if there are groups
    uint64_t live;             // bytes
} place;

static uint32_t add_slot(fg_graph *g, uint32_t res, slot_kind kind)
{
    plan *p = g->next;
    const res_rec *r = &g->open->res[res];
    if (!GROW(g, p->slot, p->slot_cap, p->slot_count + 1))
        return NONE;
    p->slot[p->slot_count] = (slot_rec){ .res = res,
                                         .kind = (uint8_t) kind,
                                         .subs = p->sub_count,
                                         .group = NONE,
                                         .next = NONE,
                                         .pool = NONE };
    p->sub_count += r->depth ? r->mips : sub_count(r);
    return p->slot_count++;
}

group_key fg_group_of(const res_rec *r)
{
    group_key k = { .size = r->bytes };
    if (!(r->flags & RES_TEXTURE))
        return k;
    const int view_class = fg_formats[r->format].view_class;
    k.texture = 1;
    k.cube = (r->flags & RES_CUBE) != 0;
    k.width = r->width;
    k.height = r->height;
    k.depth = r->depth;
    k.layers = r->layers;
    k.mips = r->mips;
    k.samples = r->samples;
    k.view_class = (uint16_t) (view_class ? view_class : 0x8000 | r->format);
    return k;
}

// Whether two transients share a group for certain.
static bool same_shape(const res_rec *a, const res_rec *b)
{
    const size_t from = offsetof(res_rec, width);
    return a->bytes == b->bytes &&
           !memcmp((const char *) a + from, (const char *) b + from, sizeof *a - from);
}

// The group of a resource, found in g->table (entries are group numbers + 1) or new.
static uint32_t group_of(place *c, uint32_t res)
{
    fg_graph *g = c->g;
    plan *p = c->p;
    // Runs of equal resources are common.
    if (p->group_count && same_shape(&c->d->res[c->like], &c->d->res[res]))
        return c->like_group;
    const group_key key = fg_group_of(&c->d->res[res]);
    const uint32_t hash = fg_hash(&key, sizeof key);
    uint32_t at = hash & c->mask;
    for (; g->table[at]; at = (at + 1) & c->mask) {
        g->work++;
        if (!memcmp(&p->group[g->table[at] - 1].key, &key, sizeof key))
            break;
    }
    if (!g->table[at]) {
        if (!GROW(g, p->group, p->group_cap, p->group_count + 1))
            return NONE;
        p->group[p->group_count] = (group_rec){ .key = key, .hash = hash, .free = NONE };
        g->table[at] = ++p->group_count;
    }
    c->like = res;
    return c->like_group = g->table[at] - 1;
}

static bool take_transient(place *c, uint32_t res)
{
    plan *p = c->p;
    const uint32_t group = group_of(c, res);
    if (group == NONE)
        return false;
    uint32_t slot = p->group[group].free;
    if (slot == NONE) {
        slot = add_slot(c->g, res, SLOT_SHARED);
        if (slot == NONE)
            return false;
        p->slot[slot].group = group;
        p->stats.transient_bytes += c->d->res[res].bytes;
    } else {
        p->group[group].free = p->slot[slot].next;
    }
    p->res[res].slot = slot;
    p->stats.unshared_bytes += c->d->res[res].bytes;
    c->live += c->d->res[res].bytes;
    if (c->live > p->stats.live_bytes)
        p->stats.live_bytes = c->live;
    return true;
}

// Gives `res` its memory at its first use.
static bool take(place *c, uint32_t res)
{
    plan *p = c->p;
    const res_rec *r = &c->d->res[res];
    const uint32_t subs = r->depth ? r->mips : sub_count(r);
    p->res[res].written = subs > 1 ? p->written_count : r->import != NONE;
    p->written_count += subs > 1 ? subs : 0;
    if (!(r->flags & RES_EXPORT) && !r->history && r->import == NONE)
        return take_transient(c, res);
    const slot_kind kind = r->history          ? SLOT_HISTORY
                           : r->import != NONE ? SLOT_IMPORT
                                               : SLOT_EXPORT;
    const uint32_t slot = add_slot(c->g, res, kind);
    if (slot == NONE || (kind == SLOT_HISTORY && add_slot(c->g, res, kind) == NONE))
        return false;
    p->res[res].slot = slot;
    if (kind != SLOT_IMPORT)
        p->stats.persistent_bytes += kind == SLOT_HISTORY ? 2 * r->bytes : r->bytes;
    return true;
}

// Returns the memory of a transient after its last use.
static void give_back(place *c, uint32_t res)
{
    plan *p = c->p;
    slot_rec *slot = &p->slot[p->res[res].slot];
    if (slot->kind != SLOT_SHARED)
        return;
    c->live -= c->d->res[res].bytes;
    if (c->g->debug & FG_DEBUG_NO_SHARING)
        return;
    slot->next = p->group[slot->group].free;
    p->group[slot->group].free = p->res[res].slot;
}

// Steps of the passes that run, and where each resource is used last.
static void find_lifetimes(place *c)
{
    plan *p = c->p;
    for (uint32_t i = 0; i < c->d->pass_count; i++) {
        const uint32_t pass = p->order[i];
        if (p->step_of[pass] == NONE)
            continue;
        const uint32_t step = p->step_of[pass] = p->step_count++;
        p->step[step] = (step_rec){ .pass = pass };
        const pass_rec *rec = &c->d->pass[pass];
        for (uint32_t k = rec->io, end = io_end(rec); k < end; k++)
            if (!p->absent[k]) {
                res_plan *r = &p->res[c->d->io[k].res];
                r->last = step;
                r->last_io = k;
            }
    }
}

static bool place_step(place *c, uint32_t step)
{
    plan *p = c->p;
    const pass_rec *rec = &c->d->pass[p->step[step].pass];
    const uint32_t end = io_end(rec);
    bool ends = false;
    for (uint32_t k = rec->io; k < end; k++) {
        const io_rec *io = &c->d->io[k];
        res_plan *r = &p->res[io->res];
        if (p->absent[k])
            continue;
        if (r->first == NONE) {
            r->first = step;
            if (!take(c, io->res))
                return false;
        }
        if (io_incoherent(io))
            p->slot[r->slot].incoherent = p->incoherent = true;
        ends |= r->last == step;
    }
    for (uint32_t k = rec->io; ends && k < end; k++)
        if (!p->absent[k] && p->res[c->d->io[k].res].last_io == k)
            give_back(c, c->d->io[k].res);
    return true;
}

fg_status fg_place(fg_graph *g)
{
    const decl *d = g->open;
    plan *p = g->next;
    place c = { .g = g, .d = d, .p = p, .mask = 15 };
    while (c.mask < 2 * (uint64_t) d->res_count)
        c.mask = 2 * c.mask + 1;
    memset(g->table, 0, ((size_t) c.mask + 1) * sizeof *g->table);
    p->step_count = p->slot_count = p->group_count = p->sub_count = p->written_count = 0;
    p->incoherent = false;
    p->stats = (fg_graph_stats){ .declared = (int) d->pass_count };
    find_lifetimes(&c);
    p->stats.kept = (int) p->step_count;
    p->stats.left_out = (int) (d->pass_count - p->step_count);
    for (uint32_t i = 0; i < p->step_count; i++)
        if (!place_step(&c, i)) {
            fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory while placing '%s'",
                         pass_name(d, p->step[i].pass));
            return FG_ERR_MEMORY;
        }
    // The other object of a history has the same incoherent writers, a frame apart.
    for (uint32_t s = 0; p->stats.persistent_bytes && s + 1 < p->slot_count; s++)
        if (p->slot[s].kind == SLOT_HISTORY && p->slot[s].res == p->slot[s + 1].res)
            p->slot[s].incoherent = p->slot[s + 1].incoherent =
                p->slot[s].incoherent || p->slot[s + 1].incoherent;
    return FG_OK;
}
