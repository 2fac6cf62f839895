// SPDX-License-Identifier: MIT
// Clears and memory barriers of a plan.
//
// OpenGL orders everything itself but the writes of shaders to images and storage
// buffers. After such a write a consumer of any kind needs the barrier bit of its own
// access; and such a write after any access needs its own bit, since "stores issued
// after the barrier wait for all accesses before it". A barrier holds for all memory,
// so per bit the position of the last one is all there is to know: an access needs a
// barrier if what it depends on is newer.
//
// A frame follows itself, and what it leaves behind is its own doing: planning starts as
// if all that is ever stored to had just been stored to. That is at most one barrier of
// a kind a frame too many.
#include "graph_priv.h"

#include <string.h>

enum { BARRIER_BITS = 9 };

typedef struct barrier_state {
    fg_graph *g;
    const decl *d;
    plan *p;
    uint32_t at[BARRIER_BITS]; // position of the last barrier per bit; 0: none
} barrier_state;

enum { COPY_BIT = 8 };
_Static_assert(FG_BARRIER_COPY == 1 << COPY_BIT, "index of a barrier bit");

// Indices of fg_barrier bits.
static const uint8_t use_bit[] = {
    [FG_USE_SAMPLED] = 0,  [FG_USE_IMAGE] = 1,       [FG_USE_COLOR] = 2,  [FG_USE_DEPTH] = 2,
    [FG_USE_STORAGE] = 3,  [FG_USE_UNIFORM] = 4,     [FG_USE_VERTEX] = 5, [FG_USE_INDEX] = 6,
    [FG_USE_INDIRECT] = 7, [FG_USE_COPY] = COPY_BIT,
};

// ---- clears: what is read or kept before it is written -----------------------------------

// A run of subresources of `io` that are in one state.
typedef struct clear_run {
    uint32_t layer, layers, mip;
} clear_run;

static bool add_clear(fg_graph *g, const io_rec *io, const clear_run *run, uint32_t value,
                      uint8_t flags)
{
    plan *p = g->next;
    if (!GROW(g, p->clear, p->clear_cap, p->clear_count + 1))
        return false;
    // Grows the clear before it where this one is the same layers of the next mip.
    if (p->clear_count > p->step[p->step_count].clear) {
        clear_rec *c = &p->clear[p->clear_count - 1];
        if (c->res == io->res && c->flags == flags && c->value == value && c->layer == run->layer &&
            c->layers == run->layers && c->mip + c->mips == (int) run->mip) {
            c->mips++;
            return true;
        }
    }
    p->clear[p->clear_count++] = (clear_rec){
        .res = io->res,
        .value = value,
        .layer = (uint16_t) run->layer,
        .layers = (uint16_t) run->layers,
        .mip = (uint8_t) run->mip,
        .mips = 1,
        .flags = flags,
    };
    return true;
}

// What happens to subresources that were (`before`) or were not yet written when the pass
// of `io` comes.
static uint8_t clear_flags(const io_rec *io, bool before)
{
    if (before)
        return io->flags & IO_CLEAR ? CLEAR_IF_ON : 0;
    return io->flags & IO_DISCARD ? CLEAR_IF_OFF : CLEAR_IF_ON | CLEAR_IF_OFF;
}

// Adds the clears that `io` needs and notes that it has been written.
static bool clear_for(fg_graph *g, const io_rec *io, uint32_t value)
{
    plan *p = g->next;
    const res_rec *r = &g->open->res[io->res];
    res_plan *rp = &p->res[io->res];
    const bool flat = r->depth > 0;
    const uint32_t layers = flat ? 1 : sub_layers(r);
    if (layers * r->mips == 1) {
        const uint8_t flags = clear_flags(io, rp->written);
        rp->written = 1;
        return !flags || add_clear(g, io, &(clear_run){ 0, 1, 0 }, value, flags);
    }
    const uint32_t from = flat ? 0 : io->layer, to = flat ? 1u : (uint32_t) io->layer + io->layers;
    uint8_t *written = p->written + rp->written;
    for (uint32_t m = io->mip; m < (uint32_t) io->mip + io->mips; m++) {
        uint8_t *row = written + (size_t) m * layers;
        for (uint32_t l = from, end; l < to; l = end) {
            for (end = l + 1; end < to && row[end] == row[l];)
                end++;
            g->work += end - l;
            const uint8_t flags = clear_flags(io, row[l]);
            if (flags && !add_clear(g, io, &(clear_run){ l, end - l, m }, value, flags))
                return false;
        }
        memset(row + from, 1, to - from);
    }
    return true;
}

static bool poison(fg_graph *g, uint32_t step, const io_rec *io)
{
    const plan *p = g->next;
    const res_rec *r = &g->open->res[io->res];
    const res_plan *rp = &p->res[io->res];
    if (rp->first != step || p->slot[rp->slot].kind == SLOT_IMPORT)
        return true;
    const uint8_t flags = CLEAR_IF_ON | CLEAR_IF_OFF | CLEAR_POISON;
    clear_run run = { 0, r->depth ? 1 : sub_layers(r), 0 };
    for (; run.mip < r->mips; run.mip++)
        if (!add_clear(g, io, &run, NONE, flags))
            return false;
    return true;
}

static bool plan_clears(fg_graph *g, uint32_t step)
{
    const decl *d = g->open;
    plan *p = g->next;
    const pass_rec *rec = &d->pass[p->step[step].pass];
    const uint32_t end = io_end(rec);
    const uint32_t first = p->clear_count;
    uint32_t value = rec->clear;
    p->step[p->step_count].clear = first; // where this step's begin, see add_clear()
    for (uint32_t k = rec->io; g->debug & FG_DEBUG_POISON && k < end; k++)
        if (!p->absent[k] && !poison(g, step, &d->io[k]))
            return false;
    for (uint32_t k = rec->io; k < end; k++) {
        const io_rec *io = &d->io[k];
        if (p->absent[k] || io->flags & IO_LAST)
            continue;
        if (!clear_for(g, io, io->flags & IO_CLEAR ? value : NONE))
            return false;
        value += (io->flags & IO_CLEAR) != 0;
    }
    p->step[step].clear = first;
    p->step[step + 1].clear = p->clear_count;
    for (uint32_t k = first; k < p->clear_count; k++)
        p->step[step].clears |= p->clear[k].flags & CLEAR_IF_ON;
    return true;
}

// Subresources of imports come written, all others not.
static bool prepare_written(fg_graph *g)
{
    const decl *d = g->open;
    plan *p = g->next;
    if (!p->written_count)
        return true;
    if (!GROW(g, p->written, p->written_cap, p->written_count))
        return false;
    memset(p->written, 0, p->written_count);
    for (uint32_t r = 0; d->import_count && r < d->res_count; r++) {
        const uint32_t count = d->res[r].depth ? d->res[r].mips : sub_count(&d->res[r]);
        if (p->res[r].slot != NONE && count > 1 && d->res[r].import != NONE)
            memset(p->written + p->res[r].written, 1, count);
    }
    return true;
}

// What outlives the frame must not show what nobody wrote: cleared after the last step.
static bool plan_end(fg_graph *g)
{
    const decl *d = g->open;
    plan *p = g->next;
    p->step[p->step_count].clear = p->clear_count;
    for (uint32_t r = 0; p->stats.persistent_bytes && r < d->res_count; r++) {
        const res_rec *rec = &d->res[r];
        const uint32_t slot = p->res[r].slot;
        if (slot == NONE ||
            (p->slot[slot].kind != SLOT_HISTORY && p->slot[slot].kind != SLOT_EXPORT))
            continue;
        const io_rec whole = { .res = r,
                               .mips = rec->mips,
                               .layers = (uint16_t) (rec->depth ? 1u : sub_layers(rec)) };
        if (!clear_for(g, &whole, NONE))
            return false;
    }
    p->step[p->step_count + 1].clear = p->clear_count;
    return true;
}

// ---- barriers ---------------------------------------------------------------------------

// What an access touches: `rows` by `columns` subresources.
typedef struct touch {
    sub_state *first;
    uint32_t stride, rows, columns;
    uint32_t bit;    // index of the barrier bit it needs
    bool incoherent; // a write to an image or a storage buffer
} touch;

// Whether `t` needs a barrier at `now`.
static inline bool needs_barrier(const barrier_state *b, const touch *t, uint32_t now)
{
    const uint32_t last = b->at[t->bit];
    const sub_state *row = t->first;
    b->g->work += (uint64_t) t->rows * t->columns;
    for (uint32_t m = 0; m < t->rows; m++, row += t->stride)
        for (uint32_t l = 0; l < t->columns; l++)
            if (row[l].write > last ||
                (t->incoherent && row[l].touch > last && row[l].touch != now))
                return true;
    return false;
}

static inline void note(const touch *t, uint32_t now)
{
    sub_state *row = t->first;
    for (uint32_t m = 0; m < t->rows; m++, row += t->stride)
        for (uint32_t l = 0; l < t->columns; l++) {
            row[l].touch = now;
            if (t->incoherent)
                row[l].write = now;
        }
}

// After a full overwrite that OpenGL orders, what shaders stored before no longer shows.
static void forget(const touch *t)
{
    sub_state *row = t->first;
    for (uint32_t m = 0; m < t->rows; m++, row += t->stride)
        for (uint32_t l = 0; l < t->columns; l++)
            row[l].write = 0;
}

// Where nothing is ever written incoherently there is nothing to do.
static inline bool touch_of_io(const barrier_state *b, uint32_t k, touch *t)
{
    const io_rec *io = &b->d->io[k];
    if (b->p->absent[k])
        return false;
    const slot_rec *slot = &b->p->slot[b->p->res[io->res].slot + (io->flags & IO_LAST ? 1 : 0)];
    if (!slot->incoherent)
        return false;
    const res_rec *r = &b->d->res[io->res];
    t->first = &b->p->sub[slot->subs];
    t->bit = use_bit[io->use];
    t->incoherent = io_incoherent(io);
    t->stride = t->rows = t->columns = 1;
    if (r->mips == 1 && r->layers <= 1)
        return true;
    t->stride = sub_layers(r);
    t->first += (size_t) io->mip * t->stride + (r->depth ? 0 : io->layer);
    t->rows = io->mips;
    t->columns = r->depth ? 1 : io->layers;
    return true;
}

static bool touch_of_clear(const barrier_state *b, const clear_rec *c, touch *t)
{
    const slot_rec *slot = &b->p->slot[b->p->res[c->res].slot];
    if (!slot->incoherent)
        return false;
    const res_rec *r = &b->d->res[c->res];
    t->stride = r->depth ? 1 : sub_layers(r);
    t->first = &b->p->sub[slot->subs + (size_t) c->mip * t->stride + c->layer];
    t->rows = c->mips;
    t->columns = c->layers;
    t->bit = COPY_BIT;
    t->incoherent = false;
    return true;
}

static void issue(barrier_state *b, unsigned bits, uint32_t now)
{
    for (; bits; bits &= bits - 1)
        b->at[__builtin_ctz(bits)] = now;
}

// The clears of a step that are done when its pass is on.
static void barriers_of_clears(barrier_state *b, step_rec *s, uint32_t now)
{
    touch t;
    for (uint32_t k = s->clear; k < s[1].clear; k++)
        if ((b->p->clear[k].flags & CLEAR_IF_ON) && touch_of_clear(b, &b->p->clear[k], &t) &&
            needs_barrier(b, &t, now + 1))
            s->clear_bits = 1u << COPY_BIT;
    issue(b, s->clear_bits, now);
    for (uint32_t k = s->clear; k < s[1].clear; k++) {
        const clear_rec *c = &b->p->clear[k];
        if (!(c->flags & CLEAR_IF_ON) || !touch_of_clear(b, c, &t))
            continue;
        note(&t, now + 1);
        if (c->flags & CLEAR_IF_OFF)
            forget(&t);
    }
}

// A first write that discards: cleared when the pass is off, so new either way.
static void forget_discarded(barrier_state *b, const step_rec *s)
{
    touch t;
    for (uint32_t k = s->clear; k < s[1].clear; k++)
        if (b->p->clear[k].flags == CLEAR_IF_OFF && touch_of_clear(b, &b->p->clear[k], &t))
            forget(&t);
}

// Four positions a step: barrier, clears, barrier, pass.
static void barriers_of_step(barrier_state *b, uint32_t step, uint32_t now)
{
    step_rec *s = &b->p->step[step];
    const pass_rec *rec = &b->d->pass[s->pass];
    const uint32_t end = io_end(rec), writes = rec->io + rec->reads;
    touch touches[FG_MAX_READS + FG_MAX_WRITES];
    unsigned count = 0, bits = 0;
    bool draws = false; // writes that OpenGL orders
    if (s->clears)
        barriers_of_clears(b, s, now);
    for (uint32_t k = rec->io; k < end; k++) {
        touch *t = &touches[count];
        if (!touch_of_io(b, k, t))
            continue;
        draws |= k >= writes && !t->incoherent;
        bits |= (unsigned) needs_barrier(b, t, now + 3) << t->bit;
        count++;
    }
    if (bits)
        issue(b, bits, now + 2);
    s->bits = (uint16_t) bits;
    if (draws)
        forget_discarded(b, s);
    for (unsigned i = 0; i < count; i++)
        note(&touches[i], now + 3);
}

static bool plan_all(barrier_state *b)
{
    plan *p = b->p;
    p->clear_count = 0;
    if (!prepare_written(b->g) || !GROW(b->g, p->sub, p->sub_cap, p->sub_count))
        return false;
    for (uint32_t i = 0; p->incoherent && i < p->sub_count; i++)
        p->sub[i] = (sub_state){ 1, 1 };
    for (uint32_t i = 0; i < p->step_count; i++) {
        if (!plan_clears(b->g, i))
            return false;
        if (p->incoherent)
            barriers_of_step(b, i, 4 + 4 * i);
    }
    return plan_end(b->g);
}

fg_status fg_barriers(fg_graph *g)
{
    barrier_state b = { .g = g, .d = g->open, .p = g->next };
    if (plan_all(&b))
        return FG_OK;
    fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory while planning barriers");
    return FG_ERR_MEMORY;
}
