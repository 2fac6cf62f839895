// SPDX-License-Identifier: MIT
// An order of all passes that obeys reads and writes: the declared one where it does,
// else depth first from the declared one, so that a pass runs at its place unless
// something declared before it needs it.
#include "graph_priv.h"

#include <stdio.h>

// A graph over passes in rows: from[i] .. from[i + 1] are the entries of i.
typedef struct edges {
    uint32_t *from, *to; // from: count + 1
    uint32_t from_cap, to_cap;
} edges;

typedef struct order_state {
    fg_graph *g;
    edges readers;       // version -> passes that read it
    edges before, after; // pass -> passes that it waits for; that wait for it
    uint32_t *fill;
    uint32_t fill_cap;
} order_state;

static uint32_t version_at(const fg_graph *g, const io_rec *io, uint32_t version)
{
    return g->next->res[io->res].version + version - 1;
}

// Calls `edge` for all that `pass` waits for. A later version waits for the readers of the
// one before.
static void each_before(order_state *o, uint32_t pass,
                        void (*edge)(order_state *o, uint32_t pass, uint32_t before))
{
    const decl *d = o->g->open;
    const plan *p = o->g->next;
    const pass_rec *rec = &d->pass[pass];
    for (uint32_t k = rec->io; k < rec->io + rec->reads + rec->writes; k++) {
        const io_rec *io = &d->io[k];
        const bool write = io->flags & IO_WRITE;
        const uint32_t version = write ? io->version - 1u : io->version;
        if ((io->flags & IO_LAST) || !version)
            continue;
        const uint32_t v = version_at(o->g, io, version);
        if (p->version[v].pass != NONE && p->version[v].pass != pass)
            edge(o, pass, p->version[v].pass);
        for (uint32_t r = write ? o->readers.from[v] : 0; write && r < o->readers.from[v + 1]; r++)
            if (o->readers.to[r] != pass)
                edge(o, pass, o->readers.to[r]);
    }
}

static void count_edge(order_state *o, uint32_t pass, uint32_t before)
{
    (void) pass;
    o->after.from[before + 1]++;
    o->g->work++;
}

static void store_edge(order_state *o, uint32_t pass, uint32_t before)
{
    o->after.to[o->fill[before]++] = pass;
}

static bool alloc_rows(fg_graph *g, edges *e, uint32_t rows)
{
    if (!GROW(g, e->from, e->from_cap, (uint64_t) rows + 1))
        return false;
    for (uint32_t i = 0; i <= rows; i++)
        e->from[i] = 0;
    return true;
}

static void free_rows(fg_graph *g, edges *e)
{
    fg_release(&g->allocator, e->from);
    fg_release(&g->allocator, e->to);
}

// Turns counts at [i + 1] into offsets and copies them to `fill`.
static bool sum_rows(order_state *o, edges *e, uint32_t rows)
{
    if (!GROW(o->g, o->fill, o->fill_cap, (uint64_t) rows + 1))
        return false;
    for (uint32_t i = 0; i < rows; i++) {
        o->fill[i] = e->from[i];
        e->from[i + 1] += e->from[i];
    }
    return GROW(o->g, e->to, e->to_cap, (uint64_t) e->from[rows] + 1);
}

static bool collect_readers(order_state *o)
{
    fg_graph *g = o->g;
    const decl *d = g->open;
    const uint32_t last = d->res_count - 1;
    const uint32_t versions =
        d->res_count ? g->next->res[last].version + g->next->res[last].versions : 0;
    if (!alloc_rows(g, &o->readers, versions))
        return false;
    for (uint32_t i = 0; i < d->io_count; i++)
        if (!(d->io[i].flags & (IO_WRITE | IO_LAST)))
            o->readers.from[version_at(g, &d->io[i], d->io[i].version) + 1]++;
    if (!sum_rows(o, &o->readers, versions))
        return false;
    for (uint32_t i = 0; i < d->pass_count; i++)
        for (uint32_t k = d->pass[i].io; k < d->pass[i].io + d->pass[i].reads; k++)
            if (!(d->io[k].flags & IO_LAST))
                o->readers.to[o->fill[version_at(g, &d->io[k], d->io[k].version)]++] = i;
    return true;
}

// Rows come out ascending in both directions, which makes the order stable.
static bool collect_edges(order_state *o)
{
    const uint32_t count = o->g->open->pass_count;
    if (!collect_readers(o) || !alloc_rows(o->g, &o->after, count))
        return false;
    for (uint32_t i = 0; i < count; i++)
        each_before(o, i, count_edge);
    if (!sum_rows(o, &o->after, count))
        return false;
    for (uint32_t i = 0; i < count; i++)
        each_before(o, i, store_edge);

    if (!alloc_rows(o->g, &o->before, count))
        return false;
    for (uint32_t e = 0; e < o->after.from[count]; e++)
        o->before.from[o->after.to[e] + 1]++;
    if (!sum_rows(o, &o->before, count))
        return false;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t e = o->after.from[i]; e < o->after.from[i + 1]; e++)
            o->before.to[o->fill[o->after.to[e]]++] = i;
    return true;
}

// A resource for which `pass` waits for `before`.
static const char *waits_for(const fg_graph *g, uint32_t pass, uint32_t before)
{
    const decl *d = g->open;
    const pass_rec *a = &d->pass[pass], *b = &d->pass[before];
    for (uint32_t i = a->io; i < a->io + a->reads + a->writes; i++)
        for (uint32_t k = b->io; k < b->io + b->reads + b->writes; k++) {
            const bool write = d->io[i].flags & IO_WRITE;
            if (d->io[i].res == d->io[k].res && !((d->io[i].flags | d->io[k].flags) & IO_LAST) &&
                d->io[k].version == d->io[i].version - (write ? 1 : 0))
                return res_name(d, d->io[i].res);
        }
    return "?";
}

// `stack` holds the path; it closes at its top.
static void report_cycle(fg_graph *g, const uint32_t *stack, uint32_t top, uint32_t closing)
{
    char text[900];
    size_t at = 0;
    uint32_t i = top;
    while (i > 0 && stack[i] != closing)
        i--;
    for (; i <= top && at < sizeof text - 1; i++) {
        const uint32_t before = i < top ? stack[i + 1] : closing;
        const int n = snprintf(text + at, sizeof text - at, "%s'%s' waits for '%s' because of '%s'",
                               at ? ", " : "", pass_name(g->open, stack[i]),
                               pass_name(g->open, before), waits_for(g, stack[i], before));
        at += (size_t) n;
    }
    fg_decl_fail(g, FG_ERR_INVALID, "cycle: pass %s", text);
}

#define WHITE NONE       // not seen
#define GREY (NONE - 1u) // on the path

// Depth first without recursion; plan.step_of holds the colour, or the place when done.
static bool visit(order_state *o, uint32_t root, uint32_t *done)
{
    fg_graph *g = o->g;
    plan *p = g->next;
    uint32_t depth = 1;
    p->step_of[root] = GREY;
    g->stack[0] = root;
    while (depth) {
        const uint32_t pass = g->stack[depth - 1];
        if (o->fill[pass] == o->before.from[pass + 1]) {
            p->step_of[pass] = *done;
            p->order[(*done)++] = pass;
            depth--;
            continue;
        }
        const uint32_t next = o->before.to[o->fill[pass]++];
        if (p->step_of[next] == GREY) {
            report_cycle(g, g->stack, depth - 1, next);
            return false;
        }
        if (p->step_of[next] == WHITE) {
            p->step_of[next] = GREY;
            g->stack[depth++] = next;
        }
    }
    return true;
}

static bool depth_first(order_state *o)
{
    const uint32_t count = o->g->open->pass_count;
    uint32_t *colour = o->g->next->step_of, done = 0;
    for (uint32_t i = 0; i < count; i++) {
        colour[i] = WHITE;
        o->fill[i] = o->before.from[i];
    }
    for (uint32_t root = 0; root < count; root++)
        if (colour[root] == WHITE && !visit(o, root, &done))
            return false;
    return true;
}

// splitmix64
static uint64_t random_next(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

// Any pass that waits for nothing more may be next.
static void random_order(order_state *o)
{
    fg_graph *g = o->g;
    const uint32_t count = g->open->pass_count;
    uint64_t state = g->seed;
    uint32_t ready = 0, done = 0;
    for (uint32_t i = 0; i < count; i++) {
        o->fill[i] = o->before.from[i + 1] - o->before.from[i];
        if (!o->fill[i])
            g->stack[ready++] = i;
    }
    while (ready) {
        const uint32_t k = (uint32_t) (random_next(&state) % ready);
        const uint32_t pass = g->stack[k];
        g->stack[k] = g->stack[--ready];
        g->next->order[done++] = pass;
        for (uint32_t e = o->after.from[pass]; e < o->after.from[pass + 1]; e++)
            if (!--o->fill[o->after.to[e]])
                g->stack[ready++] = o->after.to[e];
    }
}

fg_status fg_order(fg_graph *g, bool in_order)
{
    const bool random = g->debug & FG_DEBUG_RANDOM_ORDER;
    if (in_order && !random)
        return FG_OK; // as fg_check() laid it out
    order_state o = { .g = g };
    if (!collect_edges(&o))
        fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory while ordering %u passes",
                     g->open->pass_count);
    else if (depth_first(&o) && random)
        random_order(&o);
    free_rows(g, &o.readers);
    free_rows(g, &o.before);
    free_rows(g, &o.after);
    fg_release(&g->allocator, o.fill);
    return g->open->status;
}
