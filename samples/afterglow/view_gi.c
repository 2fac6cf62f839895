// SPDX-License-Identifier: MIT
#include "view_priv.h"

#include "ui_bridge.h"

#include <stdlib.h>
#include <string.h>

// ---- the list --------------------------------------------------------------------------------

static bool take_given(view *v, const setting *s, int place)
{
    const int slot = view_gi_find(v, setting_name(s));
    view_slot *to = &v->gi.slots[slot > 0 ? slot : 0];
    to->given = true;
    if (place < 2)
        v->gi.side[place] = slot > 0 ? slot : 0;
    if (!s->plugin || to->loaded)
        return true;
    to->loaded = true;
    return setting_copy(s, &to->sides[0]) && setting_copy(s, &to->sides[1]);
}

bool view_gi_create(view *v)
{
    view_gi *gi = &v->gi;
    if (!view_gi_scan(v))
        return false;
    for (int i = 0; i < v->start->count; ++i)
        if (!take_given(v, &v->start->settings[i], i))
            return false;
    gi->any_given = v->start->count > 1;
    gi->divider = 0.5;
    gi->wanted = gi->side[0] != 0;
    gi->ready = !gi->wanted;
    return true;
}

void view_gi_finish(view *v)
{
    for (int i = 0; i < v->gi.count; ++i) {
        setting_finish(&v->gi.slots[i].sides[0]);
        setting_finish(&v->gi.slots[i].sides[1]);
    }
    free(v->gi.slots);
    free(v->gi.names);
    v->gi = (view_gi){ 0 };
}

const char *view_gi_name(const view *v, int side)
{
    return v->gi.names[v->gi.side[side]];
}

setting *view_gi_setting(view *v, int side)
{
    return &v->gi.slots[v->gi.side[side]].sides[side];
}

int view_gi_find(const view *v, const char *name)
{
    for (int i = 0; i < v->gi.count; ++i)
        if (!strcmp(v->gi.names[i], name))
            return i;
    return -1;
}

bool view_gi_load(view *v, int slot)
{
    view_slot *s = &v->gi.slots[slot];
    if (!s->loaded && (host_setting(v->h, s->name, &s->sides[0]) != EXIT_DONE ||
                       !setting_copy(&s->sides[0], &s->sides[1])))
        view_say(v, FG_LOG_ERROR, "%s: cannot be had", s->name);
    s->loaded = true;
    return slot == 0 || s->sides[0].plugin;
}

// ---- what is wanted --------------------------------------------------------------------------

void view_gi_touch(view *v, unsigned sides)
{
    v->gi.wanted |= sides;
    v->gi.said = v->gi.quiet = false;
}

void view_gi_nudge(view *v, unsigned sides)
{
    if (!v->gi.wanted)
        v->gi.said = v->gi.quiet = true;
    v->gi.wanted |= sides;
}

void view_gi_want(view *v, int side, int slot)
{
    if (slot < 0 || slot >= v->gi.count || slot == v->gi.side[side])
        return;
    if (side == 0 && v->layer >= LAYER_PLUGIN) // it was the old one's
        view_layer_set(v, LAYER_FINAL);
    v->gi.side[side] = slot;
    view_gi_touch(v, 1u << side);
}

void view_gi_next(view *v, int side, int step)
{
    const view_gi *gi = &v->gi;
    int slot = gi->side[side];
    for (int i = 0; i < gi->count; ++i) {
        slot = (slot + step + gi->count) % gi->count;
        if (!gi->any_given || gi->slots[slot].given)
            break;
    }
    view_gi_want(v, side, slot);
}

// The divider comes to where it can be seen and held.
void view_gi_split(view *v, bool split)
{
    float left, right;
    const float width = (float) v->window.width, at = (float) v->gi.divider * width;
    view_free_part(v, &left, &right);
    if (split && (at < left + 4 * ui_unit() || at > right - 4 * ui_unit()))
        v->gi.divider = 0.5 * (double) ((left + right) / width);
    v->gi.split = split;
    view_gi_touch(v, 2);
}

// ---- layers ----------------------------------------------------------------------------------

int view_layer_count(view *v)
{
    const gi_plugin *p = view_gi_setting(v, 0)->plugin;
    return LAYER_COUNT + (p ? gi_layers_count(p) : 0);
}

const char *view_layer_name(view *v, int layer, char *text, size_t size)
{
    const gi_plugin *p = view_gi_setting(v, 0)->plugin;
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

// What the right side shows beside the left one's layer: the plugin's own by the same name.
static renderer_layer second_layer(view *v)
{
    const gi_plugin *left = view_gi_setting(v, 0)->plugin, *right = view_gi_setting(v, 1)->plugin;
    if (v->shown < LAYER_PLUGIN)
        return v->shown;
    for (int i = 0; left && right && i < gi_layers_count(right); ++i)
        if (!strcmp(right->layers[i].name, left->layers[v->shown - LAYER_PLUGIN].name))
            return (renderer_layer) (LAYER_PLUGIN + i);
    return LAYER_FINAL;
}

// ---- the renderer gets it --------------------------------------------------------------------

static fg_status set_second(view *v)
{
    const setting *s = view_gi_setting(v, 1);
    v->gi.second = second_layer(v);
    const renderer_side side = { s->plugin, s->values, 1u << v->gi.second };
    return renderer_set_split(v->r, &side);
}

fg_status view_gi_layers(view *v)
{
    // A plugin's layer comes with the plugin.
    const bool there = v->layer < LAYER_PLUGIN || v->gi.applied == v->gi.side[0];
    v->shown = there ? v->layer : LAYER_FINAL;
    const fg_status status = renderer_set_layers(v->r, 1u << v->shown);
    if (status != FG_OK || !v->gi.shows_split || second_layer(v) == v->gi.second)
        return status;
    return set_second(v);
}

static void apply_left(view *v)
{
    const setting *s = view_gi_setting(v, 0);
    v->gi.applied = v->gi.side[0];
    if (renderer_set_plugin(v->r, s->plugin, s->values) == FG_OK)
        view_say(v, FG_LOG_DEBUG, "plugin %s", setting_name(s));
}

static void apply_right(view *v)
{
    const bool split = v->gi.split;
    v->gi.shows_split = split;
    const fg_status status = split ? set_second(v) : renderer_set_split(v->r, NULL);
    if (status == FG_OK)
        view_say(v, FG_LOG_DEBUG, "split %s", split ? setting_name(view_gi_setting(v, 1)) : "off");
}

static void set_title(view *v)
{
    char title[256];
    const bool split = v->gi.shows_split;
    snprintf(title, sizeof title, "%.100s: %s%s%s - afterglow", v->h->scene_name,
             view_gi_name(v, 0), split ? " | " : "", split ? view_gi_name(v, 1) : "");
    view_window_title(&v->window, title);
}

void view_gi_apply(view *v)
{
    const unsigned wanted = v->gi.wanted;
    v->gi.wanted = 0;
    v->gi.said = v->gi.quiet = false;
    view_gi_load(v, v->gi.side[0]);
    if (v->gi.split)
        view_gi_load(v, v->gi.side[1]);
    if (wanted & 1)
        apply_left(v);
    if (wanted & 2)
        apply_right(v);
    v->graph.stale = true;
    set_title(v);
}
