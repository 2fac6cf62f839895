// SPDX-License-Identifier: MIT
// Why a pass does not run, in words. Made when asked for and kept until the next compile.
#include "graph_priv.h"

#include <stdio.h>
#include <string.h>

// A pass that reads or keeps version `version` of what `io` writes; NONE if there is none.
static uint32_t reader_of(const decl *d, const io_rec *io)
{
    for (uint32_t i = 0; i < d->pass_count; i++) {
        const pass_rec *p = &d->pass[i];
        for (uint32_t k = p->io; k < p->io + p->reads; k++)
            if (d->io[k].res == io->res &&
                ((d->io[k].flags & IO_LAST) || d->io[k].version == io->version))
                return i;
    }
    return NONE;
}

static uint32_t writer_of(const decl *d, uint32_t res, unsigned version)
{
    for (uint32_t i = 0; i < d->pass_count; i++) {
        const pass_rec *p = &d->pass[i];
        for (uint32_t k = p->io + p->reads; k < p->io + p->reads + p->writes; k++)
            if (d->io[k].res == res && d->io[k].version == version)
                return i;
    }
    return NONE;
}

static void describe(const fg_graph *g, uint32_t pass, char *buf, size_t size)
{
    const decl *d = g->built;
    const pass_rec *p = &d->pass[pass];
    if (p->effect == FG_EFFECT_INTERNAL && !p->writes) {
        const char *name = pass_name(d, pass);
        snprintf(buf, size, "no other pass of its group '%.*s' runs", (int) strcspn(name, "."),
                 name);
        return;
    }
    if (!p->writes) {
        snprintf(buf, size, "writes nothing and has no effect outside");
        return;
    }
    // The first thing that it writes and somebody takes, else the first.
    for (uint32_t k = p->io + p->reads; k < p->io + p->reads + p->writes; k++) {
        const uint32_t reader = reader_of(d, &d->io[k]);
        if (reader == NONE || reader == pass)
            continue;
        snprintf(buf, size, "'%s' is read only by passes that do not run, such as '%s'",
                 res_name(d, d->io[k].res), pass_name(d, reader));
        if (g->plan->step_of[reader] == NONE)
            return;
        // A running reader needs another part of it.
        snprintf(buf, size, "no running pass reads the part of '%s' that it writes",
                 res_name(d, d->io[k].res));
        return;
    }
    const io_rec *first = &d->io[p->io + p->reads];
    const uint32_t next = writer_of(d, first->res, first->version + 1u);
    if (next == NONE)
        snprintf(buf, size, "nobody reads '%s'", res_name(d, first->res));
    else if (g->plan->step_of[next] == NONE)
        snprintf(buf, size, "'%s' is changed only by passes that do not run, such as '%s'",
                 res_name(d, first->res), pass_name(d, next));
    else
        snprintf(buf, size, "nobody reads '%s' before '%s' overwrites it", res_name(d, first->res),
                 pass_name(d, next));
}

static const char *remember(fg_graph *g, uint32_t pass, const char *text)
{
    plan *p = g->plan;
    const uint32_t before = p->why_cap;
    if (!GROW(g, p->why, p->why_cap, g->built->pass_count))
        return "out of memory";
    for (uint32_t i = before; i < p->why_cap; i++)
        p->why[i] = NULL;
    const size_t length = strlen(text) + 1;
    char *copy = fg_alloc(&g->allocator, length);
    if (!copy)
        return "out of memory";
    memcpy(copy, text, length);
    p->why[pass] = copy;
    return copy;
}

const char *fg_reason(const fg_graph *g, uint32_t pass)
{
    const decl *d = g->built;
    char text[512];
    if (d->pass[pass].reason)
        return d->text + d->pass[pass].reason;
    if (pass < g->plan->why_cap && g->plan->why[pass])
        return g->plan->why[pass];
    describe(g, pass, text, sizeof text);
    // A cache: the graph looks the same before and after.
    return remember((fg_graph *) g, pass, text);
}

const char *fg_graph_left_out(const fg_graph *g, int i, const char **why)
{
    if (!g->compiled || i < 0)
        return NULL;
    for (uint32_t pass = 0; pass < g->built->pass_count; pass++) {
        if (g->plan->step_of[pass] != NONE || i-- > 0)
            continue;
        if (why)
            *why = fg_reason(g, pass);
        return pass_name(g->built, pass);
    }
    return NULL;
}
