// SPDX-License-Identifier: MIT
#include "dump_priv.h"

#include <stdio.h>
#include <string.h>

void fg_text_put(text *t, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    const int n = vsnprintf(NULL, 0, fmt, args);
    va_end(args);
    if (t->failed || n < 0)
        return;
    const uint64_t need = (uint64_t) t->size + (uint64_t) n + 1;
    if (need > t->cap && !fg_grow(t->allocator, (void **) &t->bytes, &t->cap, need, 1)) {
        t->failed = true;
        return;
    }
    va_start(args, fmt);
    vsnprintf(t->bytes + t->size, (size_t) n + 1, fmt, args);
    va_end(args);
    t->size += (uint32_t) n;
}

void fg_text_string(text *t, const char *s)
{
    fg_text_put(t, "\"");
    for (; *s; s++) {
        const unsigned char c = (unsigned char) *s;
        if (c == '"' || c == '\\')
            fg_text_put(t, "\\%c", c);
        else if (c < 0x20)
            fg_text_put(t, "\\u%04x", c);
        else
            fg_text_put(t, "%c", c);
    }
    fg_text_put(t, "\"");
}

void fg_text_shape(text *t, const res_rec *r)
{
    if (!(r->flags & RES_TEXTURE)) {
        fg_text_put(t, "%llu bytes", (unsigned long long) r->bytes);
        return;
    }
    fg_text_put(t, "%s %dx%d", fg_format_get((fg_format) r->format)->name, r->width, r->height);
    if (r->depth)
        fg_text_put(t, "x%d", r->depth);
    if (r->layers)
        fg_text_put(t, ", %u %s", r->layers, r->flags & RES_CUBE ? "faces" : "layers");
    if (r->mips > 1)
        fg_text_put(t, ", %u mips", r->mips);
    if (r->samples > 1)
        fg_text_put(t, ", %u samples", r->samples);
}

// ---- text -------------------------------------------------------------------------------

static void put_access(const fg_graph *g, uint32_t k, text *t)
{
    const decl *d = g->built;
    const io_rec *io = &d->io[k];
    const bool write = io->flags & IO_WRITE;
    char range[64];
    fg_range_text(range, sizeof range, &d->res[io->res], io);
    fg_text_put(t, "      %s %s", write ? "writes" : "reads ", res_name(d, io->res));
    if (io->flags & IO_LAST)
        fg_text_put(t, " of last frame");
    else
        fg_text_put(t, ".%u", io->version);
    fg_text_put(t, " as %s%s%s", fg_use_name(io->use), *range ? ", " : "", range);
    if (write)
        fg_text_put(t, ", %s",
                    io->flags & IO_CLEAR     ? "clear"
                    : io->flags & IO_DISCARD ? "discard"
                                             : "keep");
    fg_text_put(t, "%s\n", g->plan->absent[k] ? ", absent" : "");
}

static void put_bits(unsigned bits, text *t)
{
    static const char *const names[] = { "sampled", "image", "attachment", "storage", "uniform",
                                         "vertex",  "index", "indirect",   "copy" };
    const char *before = "      barrier ";
    for (int i = 0; i < FG_COUNT(names); i++)
        if (bits >> i & 1) {
            fg_text_put(t, "%s%s", before, names[i]);
            before = "|";
        }
    if (bits)
        fg_text_put(t, "\n");
}

static void put_step(const fg_graph *g, uint32_t step, text *t)
{
    const decl *d = g->built;
    const step_rec *s = &g->plan->step[step];
    const pass_rec *p = &d->pass[s->pass];
    fg_text_put(t, "%4u  %s (%s%s)\n", step, pass_name(d, s->pass),
                p->kind == FG_KIND_COMPUTE ? "compute" : "raster", s->off ? ", off" : "");
    put_bits(s->clear_bits, t);
    for (uint32_t i = s->clear; i < s[1].clear; i++) {
        const clear_rec *c = &g->plan->clear[i];
        if (c->flags & CLEAR_IF_ON)
            fg_text_put(t, "      %s %s mips %u+%u layers %u+%u\n",
                        c->flags & CLEAR_POISON ? "poison" : "clear", res_name(d, c->res), c->mip,
                        c->mips, c->layer, c->layers);
    }
    put_bits(s->bits, t);
    for (uint32_t k = p->io; k < p->io + p->reads + p->writes; k++)
        put_access(g, k, t);
}

static void put_resource(const fg_graph *g, uint32_t r, text *t)
{
    static const char *const kinds[] = { "slot", "export, slot", "import, slot", "history, slot" };
    const decl *d = g->built;
    const res_plan *rp = &g->plan->res[r];
    fg_text_put(t, "      %s: ", res_name(d, r));
    fg_text_shape(t, &d->res[r]);
    if (rp->slot == NONE)
        fg_text_put(t, ", not used\n");
    else
        fg_text_put(t, ", %llu bytes, steps %u..%u, %s %u\n", (unsigned long long) d->res[r].bytes,
                    rp->first, rp->last, kinds[g->plan->slot[rp->slot].kind], rp->slot);
}

void fg_dump_text(const fg_graph *g, text *t)
{
    const decl *d = g->built;
    const fg_graph_stats s = g->plan->stats;
    fg_text_put(t, "passes: %d declared, %d run, %d left out\n", s.declared, s.kept, s.left_out);
    for (uint32_t i = 0; i < g->plan->step_count; i++)
        put_step(g, i, t);
    fg_text_put(t, "left out:\n");
    for (uint32_t i = 0; i < d->pass_count; i++)
        if (g->plan->step_of[i] == NONE)
            fg_text_put(t, "      %s: %s\n", pass_name(d, i), fg_reason(g, i));
    fg_text_put(t, "resources:\n");
    for (uint32_t r = 0; r < d->res_count; r++)
        put_resource(g, r, t);
    fg_text_put(t,
                "memory: transient %llu bytes, without sharing %llu, alive at once %llu, "
                "persistent %llu\n",
                (unsigned long long) s.transient_bytes, (unsigned long long) s.unshared_bytes,
                (unsigned long long) s.live_bytes, (unsigned long long) s.persistent_bytes);
}

// ---- Graphviz -----------------------------------------------------------------------------

static void put_edges(const fg_graph *g, uint32_t pass, text *t)
{
    const decl *d = g->built;
    const pass_rec *p = &d->pass[pass];
    for (uint32_t k = p->io; k < p->io + p->reads + p->writes; k++) {
        const io_rec *io = &d->io[k];
        if (io->flags & IO_WRITE)
            fg_text_put(t, "  p%u -> r%u [color=\"#b04020\"", pass, io->res);
        else
            fg_text_put(t, "  r%u -> p%u [color=\"#2060a0\"", io->res, pass);
        if (io->flags & IO_LAST)
            fg_text_put(t, ", style=dashed, constraint=false, label=\"last frame\"");
        else if (g->plan->res[io->res].versions > 1)
            fg_text_put(t, ", label=\"%u\"", io->version);
        fg_text_put(t, "];\n");
    }
}

void fg_dump_dot(const fg_graph *g, text *t)
{
    const decl *d = g->built;
    fg_text_put(t, "digraph frame {\n  rankdir=LR;\n  node [fontname=\"sans-serif\"];\n");
    for (uint32_t i = 0; i < d->pass_count; i++) {
        const bool runs = g->plan->step_of[i] != NONE;
        fg_text_put(t, "  p%u [shape=box, style=\"%s\", label=", i, runs ? "filled" : "dashed");
        fg_text_string(t, pass_name(d, i));
        if (!runs) {
            fg_text_put(t, ", tooltip=");
            fg_text_string(t, fg_reason(g, i));
        }
        fg_text_put(t, "];\n");
    }
    for (uint32_t r = 0; r < d->res_count; r++) {
        fg_text_put(t, "  r%u [shape=ellipse, style=\"%s\", label=", r,
                    g->plan->res[r].slot == NONE ? "dashed" : "solid");
        fg_text_string(t, res_name(d, r));
        fg_text_put(t, "];\n");
    }
    for (uint32_t i = 0; i < d->pass_count; i++)
        put_edges(g, i, t);
    fg_text_put(t, "}\n");
}

// ---- all formats --------------------------------------------------------------------------

char *fg_graph_dump(const fg_graph *g, fg_dump format)
{
    static void (*const dumps[])(const fg_graph *g, text *t) = { fg_dump_text, fg_dump_dot,
                                                                 fg_dump_json, fg_dump_trace };
    text t = { .allocator = &g->allocator };
    if (!g->compiled || (unsigned) format >= FG_COUNT(dumps)) {
        fg_logf(g->log, FG_LOG_ERROR, "graph: fg_graph_dump(): %s",
                g->compiled ? "there is no such format" : "nothing has compiled");
        return NULL;
    }
    dumps[format](g, &t);
    if (!t.failed)
        return t.bytes;
    fg_logf(g->log, FG_LOG_ERROR, "graph: out of memory for a dump");
    fg_release(&g->allocator, t.bytes);
    return NULL;
}

void fg_dump_free(const fg_graph *g, char *dump)
{
    fg_release(&g->allocator, dump);
}
