// SPDX-License-Identifier: MIT
// Device memory of the compiled graph. Objects stay in a pool when a plan no longer
// uses them, so that going back to it costs nothing; they go when the frame's size
// changes, after IDLE_COMPILES plans without use, or by fg_graph_trim().
#include "graph_priv.h"

#include <string.h>

enum { IDLE_COMPILES = 8 };

fg_tex_desc fg_tex_desc_of(const res_rec *r)
{
    return (fg_tex_desc){
        .format = (fg_format) r->format,
        .width = r->width,
        .height = r->height,
        .depth = r->depth,
        .layers = r->layers,
        .mips = r->mips,
        .samples = r->samples,
        .cube = (r->flags & RES_CUBE) != 0,
        .history = (fg_history) r->history,
    };
}

fg_clear fg_whole_clear(const res_rec *r, const fg_tex_desc *tex, uint32_t object)
{
    return (fg_clear){
        .object = object,
        .tex = r->flags & RES_TEXTURE ? tex : NULL,
        .size = r->flags & RES_TEXTURE ? 0 : r->bytes,
        .mips = r->mips,
        .layers = r->depth ? 1 : (int) sub_layers(r),
    };
}

fg_status fg_object_create(fg_graph *g, uint32_t res, uint32_t *object)
{
    const fg_device_ops *ops = g->device->ops;
    const res_rec *r = &g->built->res[res];
    const char *name = res_name(g->built, res);
    const fg_tex_desc desc = fg_tex_desc_of(r);
    const fg_status status = r->flags & RES_TEXTURE
                                 ? ops->texture_create(g->device, name, &desc, object)
                                 : ops->buffer_create(g->device, name, r->bytes, object);
    if (status != FG_OK)
        fg_logf(g->log, FG_LOG_ERROR, "graph: %llu bytes for '%s': %s",
                (unsigned long long) r->bytes, name, fg_status_name(status));
    return status;
}

void fg_object_destroy(fg_graph *g, bool texture, uint32_t object)
{
    if (!object)
        return;
    if (texture)
        g->device->ops->texture_destroy(g->device, object);
    else
        g->device->ops->buffer_destroy(g->device, object);
}

// ---- views: one object in another format ----------------------------------------------

static fg_status view_of(fg_graph *g, uint32_t pool, uint32_t res, uint32_t *object)
{
    const res_rec *r = &g->built->res[res];
    for (uint32_t i = g->pool[pool].view; i; i = g->view[i - 1].next)
        if (g->view[i - 1].format == r->format) {
            *object = g->view[i - 1].object;
            return FG_OK;
        }
    const fg_tex_desc desc = fg_tex_desc_of(r);
    const char *name = res_name(g->built, res);
    if (!GROW(g, g->view, g->view_cap, g->view_count + 1)) {
        fg_logf(g->log, FG_LOG_ERROR, "graph: out of memory for a view of '%s'", name);
        return FG_ERR_MEMORY;
    }
    const fg_status status =
        g->device->ops->view_create(g->device, name, g->pool[pool].object, &desc, object);
    if (status != FG_OK) {
        fg_logf(g->log, FG_LOG_ERROR, "graph: view for '%s': %s", name, fg_status_name(status));
        return status;
    }
    g->view[g->view_count++] = (pool_view){ pool, r->format, *object, g->pool[pool].view };
    g->pool[pool].view = g->view_count;
    return FG_OK;
}

// Destroys the views of entries that are without an object now.
static void destroy_views(fg_graph *g)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < g->view_count; i++) {
        if (!g->pool[g->view[i].pool].object)
            fg_object_destroy(g, true, g->view[i].object);
        else
            g->view[left++] = g->view[i];
    }
    g->view_count = left;
}

// ---- the pool ---------------------------------------------------------------------------

// Removes entries without an object; slots and views follow.
static void compact(fg_graph *g, uint32_t *moved)
{
    uint32_t left = 0;
    destroy_views(g);
    for (uint32_t i = 0; i < g->pool_count; i++) {
        moved[i] = left;
        if (!g->pool[i].object)
            continue;
        g->pool[left] = g->pool[i];
        g->pool[left++].view = 0;
    }
    g->pool_count = left;
    for (uint32_t i = 0; i < g->view_count; i++) {
        pool_view *v = &g->view[i];
        v->pool = moved[v->pool];
        v->next = g->pool[v->pool].view;
        g->pool[v->pool].view = i + 1;
    }
    for (uint32_t s = 0; s < g->plan->slot_count; s++)
        if (g->plan->slot[s].pool != NONE)
            g->plan->slot[s].pool = moved[g->plan->slot[s].pool];
}

static bool pooled_kind(const slot_rec *s)
{
    return s->kind == SLOT_SHARED || s->kind == SLOT_EXPORT;
}

static group_rec group_of_slot(const fg_graph *g, const slot_rec *slot)
{
    if (slot->group != NONE)
        return g->plan->group[slot->group];
    group_rec group = { .key = fg_group_of(&g->built->res[slot->res]) };
    group.hash = fg_hash(&group.key, sizeof group.key);
    return group;
}

// Finds a pool entry for each slot; of equal ones the oldest, so that the same plan
// gets the same objects.
static bool match(fg_graph *g)
{
    plan *p = g->plan;
    uint32_t mask = 15;
    while (mask < 2 * (uint64_t) g->pool_count)
        mask = 2 * mask + 1;
    if (!GROW(g, g->table, g->table_cap, (uint64_t) mask + 1 + g->pool_count))
        return false;
    memset(g->table, 0, ((size_t) mask + 1) * sizeof *g->table);
    for (uint32_t i = g->pool_count; i-- > 0;) {
        const uint32_t at = g->pool[i].hash & mask;
        g->pool[i].next = g->table[at];
        g->pool[i].used = false;
        g->table[at] = i + 1;
    }
    for (uint32_t s = 0; s < p->slot_count; s++) {
        slot_rec *slot = &p->slot[s];
        slot->pool = NONE;
        if (!pooled_kind(slot))
            continue;
        const group_rec group = group_of_slot(g, slot);
        uint32_t *link = &g->table[group.hash & mask];
        while (*link && memcmp(&g->pool[*link - 1].key, &group.key, sizeof group.key) != 0)
            link = &g->pool[*link - 1].next;
        if (!*link)
            continue;
        slot->pool = *link - 1;
        g->pool[slot->pool].used = true;
        *link = g->pool[slot->pool].next;
    }
    return true;
}

// Destroys entries without use, those that have been idle for `idle` compiles.
static void evict(fg_graph *g, uint32_t idle)
{
    bool any = false;
    for (uint32_t i = 0; i < g->pool_count; i++) {
        if (g->pool[i].used || g->pool[i].idle < idle)
            continue;
        fg_object_destroy(g, g->pool[i].key.texture, g->pool[i].object);
        g->pool[i].object = 0;
        any = true;
    }
    if (any)
        compact(g, g->table); // match() left room for it
}

static fg_status create_slot(fg_graph *g, slot_rec *slot)
{
    const res_rec *r = &g->built->res[slot->res];
    const group_rec group = group_of_slot(g, slot);
    pool_rec made = {
        .key = group.key, .hash = group.hash, .bytes = r->bytes, .format = r->format, .used = true
    };
    if (!GROW(g, g->pool, g->pool_cap, g->pool_count + 1)) {
        fg_logf(g->log, FG_LOG_ERROR, "graph: out of memory for '%s'",
                res_name(g->built, slot->res));
        return FG_ERR_MEMORY;
    }
    const fg_status status = fg_object_create(g, slot->res, &made.object);
    if (status != FG_OK)
        return status;
    slot->pool = g->pool_count;
    g->pool[g->pool_count++] = made;
    return FG_OK;
}

static fg_status bind_resources(fg_graph *g)
{
    const decl *d = g->built;
    for (uint32_t r = 0; r < d->res_count; r++) {
        res_plan *rp = &g->plan->res[r];
        if (rp->slot == NONE || !pooled_kind(&g->plan->slot[rp->slot])) {
            rp->object = 0;
            continue;
        }
        const uint32_t pool = g->plan->slot[rp->slot].pool;
        const bool same =
            !(d->res[r].flags & RES_TEXTURE) || g->pool[pool].format == d->res[r].format;
        rp->object = g->pool[pool].object;
        if (same)
            continue;
        const fg_status status = view_of(g, pool, r, &rp->object);
        if (status != FG_OK)
            return status;
    }
    return FG_OK;
}

void fg_bind_imports(fg_graph *g)
{
    const decl *d = g->built;
    for (uint32_t r = 0; d->import_count && r < d->res_count; r++)
        if (d->res[r].import != NONE)
            g->plan->res[r].object = d->import[d->res[r].import];
}

fg_status fg_bind(fg_graph *g)
{
    const decl *d = g->built;
    const bool resized = d->width != g->pool_width || d->height != g->pool_height;
    g->device->ops->reset(g->device);
    if (!GROW(g, g->time, g->time_cap, g->plan->step_count) || !match(g)) {
        fg_logf(g->log, FG_LOG_ERROR, "graph: out of memory while binding");
        return FG_ERR_MEMORY;
    }
    for (uint32_t i = 0; i < g->pool_count; i++)
        g->pool[i].idle = g->pool[i].used ? 0 : g->pool[i].idle + 1;
    evict(g, resized ? 0 : IDLE_COMPILES);
    g->pool_width = d->width;
    g->pool_height = d->height;
    fg_status status = FG_OK;
    for (uint32_t s = 0; s < g->plan->slot_count && status == FG_OK; s++)
        if (pooled_kind(&g->plan->slot[s]) && g->plan->slot[s].pool == NONE)
            status = create_slot(g, &g->plan->slot[s]);
    if (status == FG_OK)
        status = bind_resources(g);
    if (status == FG_OK)
        status = fg_history_bind(g);
    if (status != FG_OK)
        return status;
    fg_bind_imports(g);
    g->bound = true;
    return FG_OK;
}

void fg_graph_trim(fg_graph *g)
{
    if (g->running) {
        fg_misuse(g, "fg_graph_trim", "while the graph runs");
        return;
    }
    if (g->pool_count && g->compiled && match(g))
        evict(g, 0);
    fg_history_trim(g, false);
}

void fg_bind_free(fg_graph *g)
{
    if (g->compiled)
        g->device->ops->reset(g->device);
    for (uint32_t i = 0; i < g->view_count; i++)
        fg_object_destroy(g, true, g->view[i].object);
    for (uint32_t i = 0; i < g->pool_count; i++)
        fg_object_destroy(g, g->pool[i].key.texture, g->pool[i].object);
    fg_history_trim(g, true);
    fg_release(&g->allocator, g->view);
    fg_release(&g->allocator, g->pool);
    fg_release(&g->allocator, g->history);
}

uint64_t fg_pool_bytes(const fg_graph *g)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < g->pool_count; i++)
        bytes += g->pool[i].bytes;
    for (uint32_t i = 0; i < g->history_count; i++)
        bytes +=
            g->history[i].bytes * ((g->history[i].object[0] != 0) + (g->history[i].object[1] != 0));
    return bytes;
}
