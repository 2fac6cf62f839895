// SPDX-License-Identifier: MIT
#include "dump_priv.h"

// Separates entries of an array or object.
static void next_entry(text *t, bool *first)
{
    fg_text_put(t, *first ? "\n    " : ",\n    ");
    *first = false;
}

static void put_accesses(const fg_graph *g, const pass_rec *p, bool writes, text *t)
{
    const decl *d = g->built;
    const uint32_t from = writes ? p->io + p->reads : p->io;
    const uint32_t count = writes ? p->writes : p->reads;
    fg_text_put(t, "[");
    for (uint32_t k = from; k < from + count; k++) {
        const io_rec *io = &d->io[k];
        fg_text_put(t, "%s{\"resource\": ", k > from ? ", " : "");
        fg_text_string(t, res_name(d, io->res));
        if (io->flags & IO_LAST)
            fg_text_put(t, ", \"last_frame\": true");
        else
            fg_text_put(t, ", \"version\": %u", io->version);
        fg_text_put(t,
                    ", \"use\": \"%s\", \"mip\": %u, \"mips\": %u, \"layer\": %u, \"layers\": %u",
                    fg_use_name(io->use), io->mip, io->mips, io->layer, io->layers);
        if (writes)
            fg_text_put(t, ", \"load\": \"%s\"",
                        io->flags & IO_CLEAR     ? "clear"
                        : io->flags & IO_DISCARD ? "discard"
                                                 : "keep");
        fg_text_put(t, ", \"absent\": %s}", g->plan->absent[k] ? "true" : "false");
    }
    fg_text_put(t, "]");
}

static void put_passes(const fg_graph *g, text *t)
{
    const decl *d = g->built;
    bool first = true;
    fg_text_put(t, "  \"passes\": [");
    for (uint32_t i = 0; i < g->plan->step_count; i++) {
        const step_rec *s = &g->plan->step[i];
        const pass_rec *p = &d->pass[s->pass];
        next_entry(t, &first);
        fg_text_put(t, "{\"name\": ");
        fg_text_string(t, pass_name(d, s->pass));
        fg_text_put(t,
                    ", \"kind\": \"%s\", \"enabled\": %s, \"clears\": %u, \"clear_barrier\": %u, "
                    "\"barrier\": %u, \"reads\": ",
                    p->kind == FG_KIND_COMPUTE ? "compute" : "raster", s->off ? "false" : "true",
                    s[1].clear - s->clear, s->clear_bits, s->bits);
        put_accesses(g, p, false, t);
        fg_text_put(t, ", \"writes\": ");
        put_accesses(g, p, true, t);
        fg_text_put(t, "}");
    }
    fg_text_put(t, "\n  ],\n  \"left_out\": [");
    first = true;
    for (uint32_t i = 0; i < d->pass_count; i++) {
        if (g->plan->step_of[i] != NONE)
            continue;
        next_entry(t, &first);
        fg_text_put(t, "{\"pass\": ");
        fg_text_string(t, pass_name(d, i));
        fg_text_put(t, ", \"why\": ");
        fg_text_string(t, fg_reason(g, i));
        fg_text_put(t, "}");
    }
    fg_text_put(t, "\n  ],\n");
}

static void put_resources(const fg_graph *g, text *t)
{
    static const char *const kinds[] = { "transient", "export", "import", "history" };
    const decl *d = g->built;
    bool first = true;
    fg_text_put(t, "  \"resources\": [");
    for (uint32_t r = 0; r < d->res_count; r++) {
        const res_plan *rp = &g->plan->res[r];
        next_entry(t, &first);
        fg_text_put(t, "{\"name\": ");
        fg_text_string(t, res_name(d, r));
        fg_text_put(t, ", \"shape\": \"");
        fg_text_shape(t, &d->res[r]);
        fg_text_put(t, "\", \"bytes\": %llu, \"used\": %s", (unsigned long long) d->res[r].bytes,
                    rp->slot == NONE ? "false" : "true");
        if (rp->slot != NONE)
            fg_text_put(t, ", \"memory\": \"%s\", \"slot\": %u, \"first\": %u, \"last\": %u",
                        kinds[g->plan->slot[rp->slot].kind], rp->slot, rp->first, rp->last);
        fg_text_put(t, "}");
    }
    fg_text_put(t, "\n  ],\n");
}

void fg_dump_json(const fg_graph *g, text *t)
{
    const fg_graph_stats s = g->plan->stats;
    fg_text_put(t, "{\n");
    put_passes(g, t);
    put_resources(g, t);
    fg_text_put(t,
                "  \"memory\": {\"transient_bytes\": %llu, \"unshared_bytes\": %llu, "
                "\"live_bytes\": %llu, \"persistent_bytes\": %llu}\n}\n",
                (unsigned long long) s.transient_bytes, (unsigned long long) s.unshared_bytes,
                (unsigned long long) s.live_bytes, (unsigned long long) s.persistent_bytes);
}
