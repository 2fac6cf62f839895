// SPDX-License-Identifier: MIT
#include "view_priv.h"

#include <stdlib.h>
#include <string.h>

// ---- the list --------------------------------------------------------------------------------

static bool add_slots(view *v, int count)
{
    view_gi *gi = &v->gi;
    gi->slots = calloc((size_t) count, sizeof *gi->slots);
    gi->names = calloc((size_t) count, sizeof *gi->names);
    if (!gi->slots || !gi->names)
        return false;
    gi->count = count;
    for (int i = 0; i < count; ++i) {
        snprintf(gi->slots[i].name, VIEW_NAME, "%s", i ? gi_name(v->h->registry, i - 1) : "none");
        gi->names[i] = gi->slots[i].name;
    }
    gi->slots[0].loaded = true;
    return true;
}

bool view_gi_create(view *v)
{
    view_gi *gi = &v->gi;
    int count = 1;
    while (gi_name(v->h->registry, count - 1))
        ++count;
    if (!add_slots(v, count))
        return false;
    for (int i = 0; i < v->start->count; ++i) {
        const setting *s = &v->start->settings[i];
        const int slot = view_gi_find(v, setting_name(s));
        if (slot < 0)
            continue;
        if (s->plugin && !gi->slots[slot].loaded && !setting_copy(s, &gi->slots[slot].s))
            return false;
        gi->slots[slot].loaded = true;
        if (i < 2)
            gi->side[i] = slot;
        if (slot < FG_COUNT(gi->given))
            gi->given[slot] = true;
    }
    gi->any_given = v->start->count > 1;
    gi->divider = 0.5;
    gi->wanted = gi->side[0] != 0;
    gi->ready = !gi->wanted;
    return true;
}

void view_gi_finish(view *v)
{
    for (int i = 0; i < v->gi.count; ++i)
        setting_finish(&v->gi.slots[i].s);
    free(v->gi.slots);
    free(v->gi.names);
    v->gi = (view_gi){ 0 };
}

const view_slot *view_gi_slot(const view *v, int side)
{
    return &v->gi.slots[v->gi.side[side]];
}

int view_gi_find(const view *v, const char *name)
{
    for (int i = 0; i < v->gi.count; ++i)
        if (!strcmp(v->gi.slots[i].name, name))
            return i;
    return -1;
}

bool view_gi_load(view *v, int slot)
{
    view_slot *s = &v->gi.slots[slot];
    if (!s->loaded && host_setting(v->h, s->name, &s->s) != EXIT_DONE)
        view_say(v, FG_LOG_ERROR, "%s: cannot be had", s->name);
    s->loaded = true;
    return slot == 0 || s->s.plugin;
}

// ---- what is wanted --------------------------------------------------------------------------

void view_gi_touch(view *v)
{
    v->gi.wanted = true;
    v->gi.said = false;
}

void view_gi_want(view *v, int side, int slot)
{
    if (slot < 0 || slot >= v->gi.count || slot == v->gi.side[side])
        return;
    if (side == 0 && v->layer >= LAYER_PLUGIN) // it was the old one's
        view_layer_set(v, LAYER_FINAL);
    v->gi.side[side] = slot;
    view_gi_touch(v);
}

void view_gi_next(view *v, int side, int step)
{
    const view_gi *gi = &v->gi;
    int slot = gi->side[side];
    for (int i = 0; i < gi->count; ++i) {
        slot = (slot + step + gi->count) % gi->count;
        if (!gi->any_given || (slot < FG_COUNT(gi->given) && gi->given[slot]))
            break;
    }
    view_gi_want(v, side, slot);
}

void view_gi_split(view *v, bool split)
{
    v->gi.split = split;
    view_gi_touch(v);
}

// ---- layers ----------------------------------------------------------------------------------

int view_layer_count(const view *v)
{
    const gi_plugin *p = view_gi_slot(v, 0)->s.plugin;
    return LAYER_COUNT + (p ? gi_layers_count(p) : 0);
}

const char *view_layer_name(const view *v, int layer, char *text, size_t size)
{
    const gi_plugin *p = view_gi_slot(v, 0)->s.plugin;
    if (layer < LAYER_COUNT)
        return renderer_layer_names[layer];
    snprintf(text, size, "%s.%s", p ? p->name : "none",
             p && layer < view_layer_count(v) ? p->layers[layer - LAYER_COUNT].name : "?");
    return text;
}

void view_layer_set(view *v, renderer_layer layer)
{
    char name[VIEW_NAME];
    v->layer = layer;
    view_say(v, FG_LOG_DEBUG, "layer %s", view_layer_name(v, (int) layer, name, sizeof name));
}

// ---- the renderer gets it --------------------------------------------------------------------

void view_gi_apply(view *v)
{
    const int slot = v->gi.side[0];
    v->gi.wanted = v->gi.said = false;
    const bool there = view_gi_load(v, slot);
    const setting *s = &v->gi.slots[slot].s;
    const fg_status status = renderer_set_plugin(v->r, s->plugin, s->values);
    if (status != FG_OK)
        view_say(v, FG_LOG_ERROR, "%s: failed to start: %s; direct light alone",
                 view_gi_slot(v, 0)->name, fg_status_name(status));
    else if (there)
        view_say(v, FG_LOG_DEBUG, "plugin %s", view_gi_slot(v, 0)->name);
    v->graph.stale = true;
    v->stats.pass_count = 0;
}
