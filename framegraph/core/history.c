// SPDX-License-Identifier: MIT
// Resources with a history: two objects each, known by name for the life of the graph.
#include "graph_priv.h"

#include <stdio.h>
#include <string.h>

static const char *shape_text(char *buf, size_t size, const group_key *k, uint32_t format)
{
    if (k->texture)
        snprintf(buf, size, "%s %dx%dx%d, %u layers, %u mips, %u samples%s",
                 fg_format_get((fg_format) format)->name, k->width, k->height, k->depth, k->layers,
                 k->mips, k->samples, k->cube ? ", cube" : "");
    else
        snprintf(buf, size, "%llu bytes", (unsigned long long) k->size);
    return buf;
}

static void destroy_objects(fg_graph *g, history_rec *h)
{
    for (int i = 0; i < 2; i++) {
        fg_object_destroy(g, h->key.texture, h->object[i]);
        h->object[i] = 0;
    }
    h->valid = false;
}

static history_rec *find(fg_graph *g, uint32_t res)
{
    for (uint32_t i = 0; i < g->history_count; i++)
        if (!strcmp(g->history[i].name, res_name(g->built, res)))
            return &g->history[i];
    return NULL;
}

static history_rec *add(fg_graph *g, uint32_t res)
{
    const char *name = res_name(g->built, res);
    const size_t length = strlen(name) + 1;
    char *copy = NULL;
    if (GROW(g, g->history, g->history_cap, g->history_count + 1))
        copy = fg_alloc(&g->allocator, length);
    if (!copy) {
        fg_logf(g->log, FG_LOG_ERROR, "graph: out of memory for the history of '%s'", name);
        return NULL;
    }
    memcpy(copy, name, length);
    history_rec *h = &g->history[g->history_count++];
    *h = (history_rec){ .name = copy,
                        .key = fg_group_of(&g->built->res[res]),
                        .format = g->built->res[res].format,
                        .bytes = g->built->res[res].bytes };
    return h;
}

// A resource that came back with another shape or format starts anew.
static void check_shape(fg_graph *g, history_rec *h, uint32_t res)
{
    const res_rec *r = &g->built->res[res];
    const group_key key = fg_group_of(r);
    char before[128], now[128];
    if (!memcmp(&key, &h->key, sizeof key) && h->format == r->format)
        return;
    if (h->object[0] || h->object[1])
        fg_logf(g->log, FG_LOG_INFO, "history '%s': reset, it was %s and is now %s", h->name,
                shape_text(before, sizeof before, &h->key, h->format),
                shape_text(now, sizeof now, &key, r->format));
    destroy_objects(g, h);
    h->key = key;
    h->format = r->format;
    h->bytes = r->bytes;
}

// What the first frame reads: zeros, or whatever is there.
static void clear_last(fg_graph *g, const history_rec *h, uint32_t res)
{
    const res_rec *r = &g->built->res[res];
    const fg_tex_desc tex = fg_tex_desc_of(r);
    fg_clear clear = fg_whole_clear(r, &tex, h->object[!h->current]);
    clear.poison = r->history == FG_HISTORY_DISCARD;
    if (!clear.poison || g->debug & FG_DEBUG_POISON)
        g->device->ops->clear(g->device, &clear);
}

static void point(fg_graph *g, const history_rec *h)
{
    g->plan->res[h->res].object = h->object[h->current];
    g->plan->res[h->res].last_object = h->object[!h->current];
}

static fg_status bind_one(fg_graph *g, uint32_t res)
{
    history_rec *h = find(g, res);
    h = h ? h : add(g, res);
    if (!h)
        return FG_ERR_MEMORY;
    h->res = res;
    check_shape(g, h, res);
    const bool fresh = !h->object[0] || !h->object[1];
    for (int i = 0; i < 2; i++) {
        const fg_status status = h->object[i] ? FG_OK : fg_object_create(g, res, &h->object[i]);
        if (status != FG_OK)
            return status;
    }
    if (fresh)
        clear_last(g, h, res);
    point(g, h);
    return FG_OK;
}

fg_status fg_history_bind(fg_graph *g)
{
    for (uint32_t i = 0; i < g->history_count; i++)
        g->history[i].res = NONE;
    for (uint32_t s = 0; s < g->plan->slot_count; s++) {
        if (g->plan->slot[s].kind != SLOT_HISTORY)
            continue;
        const fg_status status = bind_one(g, g->plan->slot[s].res);
        if (status != FG_OK)
            return status;
        s++; // its other object
    }
    return FG_OK;
}

void fg_history_swap(fg_graph *g)
{
    for (uint32_t i = 0; i < g->history_count; i++) {
        history_rec *h = &g->history[i];
        if (h->res == NONE)
            continue;
        h->current = !h->current;
        h->valid = true;
        if (g->bound)
            point(g, h);
    }
}

// Whether the compiled graph uses a history; it may not be bound yet.
static bool in_use(const fg_graph *g, const history_rec *h)
{
    const plan *p = g->plan;
    for (uint32_t s = 0; g->compiled && s < p->slot_count; s++)
        if (p->slot[s].kind == SLOT_HISTORY && !strcmp(h->name, res_name(g->built, p->slot[s].res)))
            return true;
    return false;
}

void fg_history_trim(fg_graph *g, bool all)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < g->history_count; i++) {
        history_rec *h = &g->history[i];
        if (!all && in_use(g, h)) {
            g->history[left++] = *h;
            continue;
        }
        destroy_objects(g, h);
        fg_release(&g->allocator, h->name);
    }
    g->history_count = left;
}

void fg_graph_forget(fg_graph *g, const char *prefix)
{
    const size_t length = prefix ? strlen(prefix) : 0;
    if (g->running) {
        fg_misuse(g, "fg_graph_forget", "while the graph runs");
        return;
    }
    for (uint32_t i = 0; i < g->history_count; i++) {
        history_rec *h = &g->history[i];
        if (length && strncmp(h->name, prefix, length) != 0)
            continue;
        destroy_objects(g, h);
        h->res = NONE;    // a swap that is due is none of its
        g->bound = false; // the next run makes it again
    }
}

bool fg_history_is_valid(const fg_graph *g, uint32_t res)
{
    for (uint32_t i = 0; i < g->history_count; i++)
        if (g->history[i].res == res)
            return g->history[i].valid;
    return false;
}
