// SPDX-License-Identifier: MIT
#include "graph_priv.h"

#include <stdlib.h>
#include <string.h>

fg_graph *fg_graph_create(const fg_graph_desc *desc)
{
    if (!desc || !desc->device) {
        fg_logf(desc ? desc->log : NULL, FG_LOG_ERROR, "graph: needs a device");
        return NULL;
    }
    fg_graph *g = fg_alloc(&desc->allocator, sizeof *g);
    if (!g) {
        fg_logf(desc->log, FG_LOG_ERROR, "graph: out of memory");
        return NULL;
    }
    memset(g, 0, sizeof *g);
    g->device = desc->device;
    g->limits = desc->device->ops->limits(desc->device);
    g->log = desc->log;
    g->allocator = desc->allocator;
    g->debug = desc->debug;
    g->seed = desc->seed;
    g->inspect = desc->inspect;
    g->inspect_user = desc->inspect_user;
    g->open = &g->decls[0];
    g->built = &g->decls[1];
    g->next = &g->plans[0];
    g->plan = &g->plans[1];
    return g;
}

void fg_graph_destroy(fg_graph *g)
{
    if (!g)
        return;
    if (g->running) {
        fg_misuse(g, "fg_graph_destroy", "while the graph runs");
        return;
    }
    const fg_allocator a = g->allocator;
    fg_bind_free(g);
    for (int i = 0; i < 2; i++) {
        fg_decl_free(&a, &g->decls[i]);
        fg_plan_free(&a, &g->plans[i]);
    }
    for (uint32_t i = 0; i < g->off_count; i++)
        fg_release(&a, g->off[i]);
    fg_release(&a, g->off);
    fg_release(&a, g->name);
    fg_release(&a, g->table);
    fg_release(&a, g->stack);
    fg_release(&a, g->last);
    fg_release(&a, g->seen);
    fg_release(&a, g->time);
    fg_release(&a, g);
}

static void free_reasons(const fg_allocator *a, plan *p)
{
    for (uint32_t i = 0; i < p->why_cap; i++)
        fg_release(a, p->why[i]);
    fg_release(a, p->why);
    p->why = NULL;
    p->why_cap = 0;
}

void fg_plan_free(const fg_allocator *a, plan *p)
{
    free_reasons(a, p);
    fg_release(a, p->res);
    fg_release(a, p->version);
    fg_release(a, p->order);
    fg_release(a, p->step_of);
    fg_release(a, p->step);
    fg_release(a, p->slot);
    fg_release(a, p->group);
    fg_release(a, p->sub);
    fg_release(a, p->clear);
    fg_release(a, p->written);
    fg_release(a, p->absent);
}

bool fg_epoch_built(const fg_graph *g, uint16_t epoch)
{
    if (!g->compiled)
        return false;
    const uint64_t back = (uint16_t) (g->epoch_equal_last - epoch);
    return epoch == (uint16_t) g->epoch_built || back <= g->epoch_equal_last - g->epoch_equal;
}

static void swap_decl(fg_graph *g)
{
    decl *d = g->built;
    g->built = g->open;
    g->open = d;
}

static bool same_imports(const decl *a, const decl *b)
{
    return !a->import_count || !memcmp(a->import, b->import, a->import_count * sizeof *a->import);
}

// Nothing but callbacks, clear values and imported objects can differ.
static void take_equal(fg_graph *g)
{
    const bool imports = !same_imports(g->open, g->built);
    swap_decl(g);
    if (g->epoch != g->epoch_equal_last + 1)
        g->epoch_equal = g->epoch;
    g->epoch_equal_last = g->epoch;
    if (imports && g->bound)
        fg_bind_imports(g);
}

static uint32_t switch_off(fg_graph *g, uint32_t step)
{
    const char *name = pass_name(g->built, g->plan->step[step].pass);
    for (uint32_t i = 0; i < g->off_count; i++)
        if (!strcmp(name, g->off[i]))
            return 1;
    return 0;
}

static void commit(fg_graph *g)
{
    plan *p = g->plan;
    g->after_incoherent |= g->ran && p->incoherent;
    free_reasons(&g->allocator, p);
    g->plan = g->next;
    g->next = p;
    swap_decl(g);
    g->epoch_built = g->epoch_equal = g->epoch_equal_last = g->epoch;
    g->compiled = true;
    g->bound = g->ran = false;
    g->time_count = 0;
    g->compiles++;
    for (uint32_t i = 0; g->off_count && i < g->plan->step_count; i++)
        g->plan->step[i].off = (uint16_t) switch_off(g, i);
    fg_logf(g->log, FG_LOG_DEBUG, "graph: compiled %d passes, %d kept, in %llu steps",
            g->plan->stats.declared, g->plan->stats.kept, (unsigned long long) g->work);
}

static fg_status build(fg_graph *g)
{
    bool in_order;
    g->work = 0;
    fg_status status = fg_check(g, &in_order);
    if (status == FG_OK)
        status = fg_order(g, in_order);
    if (status == FG_OK)
        status = fg_cull(g);
    if (status == FG_OK)
        status = fg_place(g);
    if (status != FG_OK)
        return status;
    if (!g->next->step_count) {
        fg_decl_fail(g, FG_ERR_EMPTY,
                     "graph: nothing to run: of %u passes none shows, exports or keeps anything",
                     g->open->pass_count);
        return FG_ERR_EMPTY;
    }
    return fg_barriers(g);
}

fg_status fg_graph_compile(fg_graph *g)
{
    if (g->running || !g->declaring) {
        if (!g->running && g->open->status == FG_OK && g->compiled)
            return FG_OK; // compiled already
        return fg_misuse(g, "fg_graph_compile",
                         g->running ? "while the graph runs" : "without a declaration");
    }
    fg_status status = g->open->status;
    const bool equal = g->compiled && status == FG_OK && fg_decl_equal(g->open, g->built);
    if (status == FG_OK && !equal)
        status = build(g);
    g->declaring = false;
    g->prefix_length = 0;
    if (status != FG_OK)
        return status;
    if (equal)
        take_equal(g);
    else
        commit(g);
    fg_decl_reset(g->open);
    return FG_OK;
}

// ---- passes on and off ------------------------------------------------------------------

static bool remember_off(fg_graph *g, const char *pass)
{
    const size_t length = strlen(pass) + 1;
    char *name =
        GROW(g, g->off, g->off_cap, g->off_count + 1) ? fg_alloc(&g->allocator, length) : NULL;
    if (!name)
        return false;
    memcpy(name, pass, length);
    g->off[g->off_count++] = name;
    return true;
}

fg_status fg_pass_enable(fg_graph *g, const char *pass, bool enabled)
{
    const decl *d = g->built;
    uint32_t i = 0;
    while (g->compiled && pass && i < d->pass_count && strcmp(pass, pass_name(d, i)) != 0)
        i++;
    if (!g->compiled || !pass || i == d->pass_count) {
        fg_logf(g->log, FG_LOG_ERROR, "graph: fg_pass_enable(): there is no pass '%s'",
                pass ? pass : "");
        return FG_ERR_INVALID;
    }
    uint32_t k = 0;
    while (k < g->off_count && strcmp(pass, g->off[k]) != 0)
        k++;
    if (enabled && k < g->off_count) {
        fg_release(&g->allocator, g->off[k]);
        g->off[k] = g->off[--g->off_count];
    } else if (!enabled && k == g->off_count && !remember_off(g, pass)) {
        fg_logf(g->log, FG_LOG_ERROR, "graph: out of memory while disabling '%s'", pass);
        return FG_ERR_MEMORY;
    }
    if (g->plan->step_of[i] != NONE)
        g->plan->step[g->plan->step_of[i]].off = !enabled;
    return FG_OK;
}

// ---- looking at it ----------------------------------------------------------------------

fg_graph_stats fg_graph_get_stats(const fg_graph *g)
{
    fg_graph_stats s = { 0 };
    if (g->compiled)
        s = g->plan->stats;
    s.compiles = g->compiles;
    s.pool_bytes = fg_pool_bytes(g);
    return s;
}

const char *fg_graph_pass(const fg_graph *g, int i)
{
    if (!g->compiled || i < 0 || (uint32_t) i >= g->plan->step_count)
        return NULL;
    return pass_name(g->built, g->plan->step[i].pass);
}
