// SPDX-License-Identifier: MIT
// Steps in order, lifetimes, and a memory slot for each live resource. Transients of one
// group (equal shape, formats of one view class) take over each other's slots; for
// intervals, taking any free one needs as few as there are alive at once.
#include "graph_priv.h"

#include <string.h>

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

// The group of a resource, found in g->table (entries are group numbers + 1) or new.
static uint32_t group_of(fg_graph *g, uint32_t res, uint32_t mask)
{
    plan *p = g->next;
    const group_key key = fg_group_of(&g->open->res[res]);
    // Runs of equal resources are common.
    if (p->group_count && !memcmp(&p->group[p->group_count - 1].key, &key, sizeof key))
        return p->group_count - 1;
    uint32_t at = fg_hash(&key, sizeof key) & mask;
    for (; g->table[at]; at = (at + 1) & mask) {
        g->work++;
        if (!memcmp(&p->group[g->table[at] - 1].key, &key, sizeof key))
            return g->table[at] - 1;
    }
    if (!GROW(g, p->group, p->group_cap, p->group_count + 1))
        return NONE;
    p->group[p->group_count] = (group_rec){ .key = key, .free = NONE };
    g->table[at] = ++p->group_count;
    return p->group_count - 1;
}

static bool take_transient(fg_graph *g, uint32_t res, uint32_t mask)
{
    plan *p = g->next;
    const uint32_t group = group_of(g, res, mask);
    if (group == NONE)
        return false;
    uint32_t slot = p->group[group].free;
    if (slot == NONE) {
        slot = add_slot(g, res, SLOT_SHARED);
        if (slot == NONE)
            return false;
        p->slot[slot].group = group;
        p->stats.transient_bytes += g->open->res[res].bytes;
    } else {
        p->group[group].free = p->slot[slot].next;
    }
    p->res[res].slot = slot;
    p->stats.unshared_bytes += g->open->res[res].bytes;
    return true;
}

// Gives `res` its memory at its first use.
static bool take(fg_graph *g, uint32_t res, uint32_t mask)
{
    plan *p = g->next;
    const res_rec *r = &g->open->res[res];
    if (!(r->flags & RES_EXPORT) && !r->history && r->import == NONE)
        return take_transient(g, res, mask);
    const slot_kind kind = r->history          ? SLOT_HISTORY
                           : r->import != NONE ? SLOT_IMPORT
                                               : SLOT_EXPORT;
    const uint32_t slot = add_slot(g, res, kind);
    if (slot == NONE || (kind == SLOT_HISTORY && add_slot(g, res, kind) == NONE))
        return false;
    p->res[res].slot = slot;
    if (kind != SLOT_IMPORT)
        p->stats.persistent_bytes += kind == SLOT_HISTORY ? 2 * r->bytes : r->bytes;
    return true;
}

// Returns the memory of a transient after its last use.
static void give_back(fg_graph *g, uint32_t res)
{
    plan *p = g->next;
    slot_rec *slot = &p->slot[p->res[res].slot];
    if (slot->kind != SLOT_SHARED || g->debug & FG_DEBUG_NO_SHARING)
        return;
    slot->next = p->group[slot->group].free;
    p->group[slot->group].free = p->res[res].slot;
}

// Steps of the passes that run, and where each resource is used last.
static void find_lifetimes(fg_graph *g)
{
    const decl *d = g->open;
    plan *p = g->next;
    for (uint32_t r = 0; r < d->res_count; r++)
        p->res[r].first = p->res[r].last = NONE;
    for (uint32_t i = 0; i < d->pass_count; i++) {
        const uint32_t pass = p->order[i];
        if (p->step_of[pass] == NONE)
            continue;
        const uint32_t step = p->step_of[pass] = p->step_count++;
        p->step[step] = (step_rec){ .pass = pass };
        const pass_rec *rec = &d->pass[pass];
        for (uint32_t k = rec->io; k < rec->io + rec->reads + rec->writes; k++)
            if (!p->absent[k])
                p->res[d->io[k].res].last = step;
    }
}

static bool place_step(fg_graph *g, uint32_t step, uint32_t mask, uint64_t *live)
{
    const decl *d = g->open;
    plan *p = g->next;
    const pass_rec *rec = &d->pass[p->step[step].pass];
    const uint32_t end = rec->io + rec->reads + rec->writes;
    for (uint32_t k = rec->io; k < end; k++) {
        const io_rec *io = &d->io[k];
        res_plan *r = &p->res[io->res];
        if (p->absent[k])
            continue;
        if (r->first == NONE) {
            r->first = step;
            if (!take(g, io->res, mask))
                return false;
            *live += p->slot[r->slot].kind == SLOT_SHARED ? d->res[io->res].bytes : 0;
        }
        if ((io->flags & IO_WRITE) && (io->use == FG_USE_IMAGE || io->use == FG_USE_STORAGE))
            p->slot[r->slot].incoherent = p->incoherent = true;
    }
    if (*live > p->stats.live_bytes)
        p->stats.live_bytes = *live;
    for (uint32_t k = rec->io; k < end; k++) {
        const io_rec *io = &d->io[k];
        res_plan *r = &p->res[io->res];
        if (p->absent[k] || r->last != step)
            continue;
        r->last = step | 0x80000000u; // given back; a pass may name it twice
        give_back(g, io->res);
        *live -= p->slot[r->slot].kind == SLOT_SHARED ? d->res[io->res].bytes : 0;
    }
    return true;
}

fg_status fg_place(fg_graph *g)
{
    const decl *d = g->open;
    plan *p = g->next;
    uint64_t live = 0;
    uint32_t mask = 15;
    while (mask < 2 * (uint64_t) d->res_count)
        mask = 2 * mask + 1;
    memset(g->table, 0, ((size_t) mask + 1) * sizeof *g->table);
    p->step_count = p->slot_count = p->group_count = p->sub_count = 0;
    p->incoherent = false;
    p->stats = (fg_graph_stats){ .declared = (int) d->pass_count };
    find_lifetimes(g);
    p->stats.kept = (int) p->step_count;
    p->stats.left_out = (int) (d->pass_count - p->step_count);
    for (uint32_t i = 0; i < p->step_count; i++)
        if (!place_step(g, i, mask, &live)) {
            fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory while placing '%s'",
                         pass_name(d, p->step[i].pass));
            return FG_ERR_MEMORY;
        }
    for (uint32_t r = 0; r < d->res_count; r++)
        if (p->res[r].last != NONE)
            p->res[r].last &= 0x7fffffffu;
    // The other object of a history has the same incoherent writers, a frame apart.
    for (uint32_t s = 0; s + 1 < p->slot_count; s++)
        if (p->slot[s].kind == SLOT_HISTORY && p->slot[s].res == p->slot[s + 1].res)
            p->slot[s].incoherent = p->slot[s + 1].incoherent =
                p->slot[s].incoherent || p->slot[s + 1].incoherent;
    return FG_OK;
}
