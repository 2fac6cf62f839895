// SPDX-License-Identifier: MIT
// Names, versions and uses of an open declaration. Everything is looked at, so that
// one compile reports every mistake.
#include "graph_priv.h"

#include <stdio.h>
#include <string.h>

// ---- words for messages -----------------------------------------------------------

const char *fg_use_name(unsigned use)
{
    static const char *const names[] = { "default", "sampled",  "image",   "color",
                                         "depth",   "storage",  "uniform", "vertex",
                                         "index",   "indirect", "copy" };
    return use < FG_COUNT(names) ? names[use] : "?";
}

static int span(char *buf, size_t size, const char *what, unsigned from, unsigned count)
{
    return count == 1 ? snprintf(buf, size, "%s %u", what, from)
                      : snprintf(buf, size, "%ss %u..%u", what, from, from + count - 1);
}

const char *fg_range_text(char *buf, size_t size, const res_rec *r, const io_rec *io)
{
    const char *layer = r->depth ? "slice" : "layer";
    size_t at = 0;
    buf[0] = '\0';
    if (io->flags & IO_WHOLE)
        return buf;
    if (io->mips != r->mips)
        at = (size_t) span(buf, size, "mip", io->mip, io->mips);
    if (io->layers != (r->depth ? (uint32_t) r->depth : sub_layers(r)) && at < size)
        span(buf + at, size - at, at ? ", layer" : layer, io->layer, io->layers);
    return buf;
}

// ---- names ----------------------------------------------------------------------------

// Open addressing; an entry is a hash and a record number + 1.
static void check_names(fg_graph *g, bool passes, uint32_t mask)
{
    const decl *d = g->open;
    const uint32_t count = passes ? d->pass_count : d->res_count;
    memset(g->table, 0, 2 * ((size_t) mask + 1) * sizeof *g->table);
    for (uint32_t i = 0; i < count; i++) {
        const char *name = passes ? pass_name(d, i) : res_name(d, i);
        const uint32_t hash = fg_hash(name, strlen(name));
        uint32_t *entry = g->table + 2 * (size_t) (hash & mask);
        for (uint32_t at = hash; entry[1]; entry = g->table + 2 * (size_t) (++at & mask)) {
            const uint32_t k = entry[1] - 1;
            g->work++;
            if (entry[0] == hash && !strcmp(name, passes ? pass_name(d, k) : res_name(d, k)))
                fg_decl_fail(g, FG_ERR_INVALID, "%s '%s': the name is taken by another %s",
                             passes ? "pass" : "resource", name, passes ? "pass" : "resource");
        }
        entry[0] = hash;
        entry[1] = i + 1;
    }
}

// ---- versions ---------------------------------------------------------------------------

// Counts the versions of each resource and lays out plan.version.
static bool count_versions(fg_graph *g)
{
    const decl *d = g->open;
    plan *p = g->next;
    uint32_t total = 0;
    g->most_versions = 0;
    for (uint32_t r = 0; r < d->res_count; r++)
        p->res[r] = (res_plan){
            .versions = d->res[r].import != NONE, .first = NONE, .last = NONE, .slot = NONE
        };
    for (uint32_t i = 0; i < d->io_count; i++) {
        const io_rec *io = &d->io[i];
        res_plan *r = &p->res[io->res];
        if (!(io->flags & IO_WRITE))
            continue;
        if (io->version > r->versions)
            r->versions = io->version;
        r->writes++;
    }
    for (uint32_t r = 0; r < d->res_count; r++) {
        // More versions than writes: one is missing. Keeps the table linear.
        const uint32_t most = p->res[r].writes + (d->res[r].import != NONE);
        if (p->res[r].versions > most) {
            fg_decl_fail(
                g, FG_ERR_INVALID,
                "'%s': version %u is written, but only %u versions are; one in between has "
                "no pass that writes it",
                res_name(d, r), p->res[r].versions, most);
            return false;
        }
        p->res[r].version = total;
        total += p->res[r].versions;
        if (p->res[r].versions > g->most_versions)
            g->most_versions = p->res[r].versions;
    }
    if (!GROW(g, p->version, p->version_cap, total)) {
        fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory for %u versions", total);
        return false;
    }
    if (total)
        memset(p->version, 0xff, total * sizeof *p->version); // NONE
    g->missing = total - d->import_count;
    return true;
}

static bool index_write(fg_graph *g, uint32_t pass, uint32_t i)
{
    const decl *d = g->open;
    const io_rec *io = &d->io[i];
    version_rec *v = &g->next->version[g->next->res[io->res].version + io->version - 1u];
    if (d->res[io->res].import != NONE && io->version == 1) {
        fg_decl_fail(g, FG_ERR_INVALID,
                     "pass '%s' writes '%s' as it was imported: write fg_next() of the handle",
                     pass_name(d, pass), res_name(d, io->res));
        return false;
    }
    if (v->pass == NONE) {
        *v = (version_rec){ pass, i };
        g->missing--;
    } else if (v->pass != pass) {
        fg_decl_fail(g, FG_ERR_INVALID,
                     "passes '%s' and '%s' both write version %u of '%s': the later one writes "
                     "fg_next() of it",
                     pass_name(d, v->pass), pass_name(d, pass), io->version, res_name(d, io->res));
        return false;
    }
    return true;
}

static bool check_gaps(fg_graph *g)
{
    const decl *d = g->open;
    bool good = true;
    for (uint32_t r = 0; g->missing && r < d->res_count; r++) {
        const res_plan *rp = &g->next->res[r];
        for (uint32_t v = d->res[r].import != NONE; v < rp->versions; v++) {
            if (g->next->version[rp->version + v].pass != NONE)
                continue;
            fg_decl_fail(g, FG_ERR_INVALID,
                         "'%s': version %u is written, but no pass writes version %u",
                         res_name(d, r), rp->versions, v + 1);
            good = false;
        }
    }
    return good;
}

static bool index_versions(fg_graph *g)
{
    const decl *d = g->open;
    bool good = count_versions(g);
    for (uint32_t i = 0; good && i < d->pass_count; i++) {
        const pass_rec *pass = &d->pass[i];
        const uint32_t writes = pass->io + pass->reads;
        for (uint32_t k = writes; k < writes + pass->writes; k++)
            good &= index_write(g, i, k);
    }
    return good && check_gaps(g);
}

// ---- what a pass reads ------------------------------------------------------------------

static void check_read(fg_graph *g, uint32_t pass, const io_rec *io, bool *in_order)
{
    const decl *d = g->open;
    const res_plan *r = &g->next->res[io->res];
    if (io->flags & IO_LAST) {
        if (!r->versions)
            fg_decl_fail(g, FG_ERR_INVALID,
                         "pass '%s' reads last frame's '%s', which no pass ever writes",
                         pass_name(d, pass), res_name(d, io->res));
        return;
    }
    if (io->version > r->versions) {
        fg_decl_fail(g, FG_ERR_INVALID, "pass '%s' reads version %u of '%s', which no pass writes",
                     pass_name(d, pass), io->version, res_name(d, io->res));
        return;
    }
    const version_rec *v = &g->next->version[r->version + io->version - 1u];
    if (v->pass == pass)
        fg_decl_fail(g, FG_ERR_INVALID,
                     "pass '%s' reads version %u of '%s', which it writes itself: read the version "
                     "before",
                     pass_name(d, pass), io->version, res_name(d, io->res));
    if (v->pass != NONE && v->pass > pass)
        *in_order = false;
    if (io->version < r->versions && v[1].pass < pass)
        fg_decl_fail(
            g, FG_ERR_INVALID,
            "pass '%s' reads a stale handle: version %u of '%s' is overwritten by pass '%s', "
            "declared before it",
            pass_name(d, pass), io->version, res_name(d, io->res), pass_name(d, v[1].pass));
}

static void check_exports(fg_graph *g)
{
    const decl *d = g->open;
    for (uint32_t i = 0; i < d->export_count; i++) {
        const export_rec *e = &d->exports[i];
        const res_plan *r = &g->next->res[e->res];
        if (e->version > r->versions)
            fg_decl_fail(g, FG_ERR_INVALID, "export of version %u of '%s', which no pass writes",
                         e->version, res_name(d, e->res));
        else if (e->version < r->versions)
            fg_decl_fail(g, FG_ERR_INVALID,
                         "export of a stale handle: version %u of '%s' is overwritten by pass '%s'",
                         e->version, res_name(d, e->res),
                         pass_name(d, g->next->version[r->version + e->version].pass));
    }
}

// ---- everything -----------------------------------------------------------------------

static bool room(fg_graph *g, uint32_t *mask)
{
    const decl *d = g->open;
    plan *p = g->next;
    const uint32_t most = d->pass_count > d->res_count ? d->pass_count : d->res_count;
    *mask = 15;
    while (*mask < 2 * (uint64_t) most)
        *mask = 2 * *mask + 1;
    if (most < NONE / 8 && GROW(g, g->table, g->table_cap, 2 * ((uint64_t) *mask + 1)) &&
        GROW(g, g->stack, g->stack_cap, 2 * (uint64_t) d->pass_count + 1) &&
        GROW(g, p->res, p->res_cap, d->res_count) &&
        GROW(g, p->order, p->order_cap, d->pass_count) &&
        GROW(g, p->step_of, p->step_of_cap, d->pass_count) &&
        GROW(g, p->step, p->step_cap, (uint64_t) d->pass_count + 2) &&
        GROW(g, p->absent, p->absent_cap, d->io_count))
        return true;
    fg_decl_fail(g, FG_ERR_MEMORY, "graph: out of memory for %u passes", d->pass_count);
    return false;
}

fg_status fg_check(fg_graph *g, bool *in_order)
{
    const decl *d = g->open;
    uint32_t mask;
    *in_order = true;
    if (!room(g, &mask))
        return d->status;
    check_names(g, false, mask);
    check_names(g, true, mask);
    if (!index_versions(g))
        return d->status;
    for (uint32_t i = 0; i < d->pass_count; i++) {
        const pass_rec *pass = &d->pass[i];
        const io_rec *io = &d->io[pass->io];
        g->next->order[i] = i;
        for (int k = 0; k < pass->reads; k++)
            check_read(g, i, &io[k], in_order);
        for (int k = pass->reads; k < pass->reads + pass->writes; k++) {
            const version_rec *v = &g->next->version[g->next->res[io[k].res].version];
            if (io[k].version > 1 && v[io[k].version - 2].pass != NONE &&
                v[io[k].version - 2].pass > i)
                *in_order = false;
        }
        fg_check_uses(g, i);
    }
    check_exports(g);
    return d->status;
}
