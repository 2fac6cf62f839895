// SPDX-License-Identifier: MIT
#include "view_priv.h"

#include <stdlib.h>
#include <string.h>

// ---- names -----------------------------------------------------------------------------------

static bool add_slot(view *v, const char *name)
{
    view_gi *gi = &v->gi;
    const size_t count = (size_t) gi->count + 1;
    view_slot *slots = realloc(gi->slots, count * sizeof *slots);
    if (!slots)
        return false;
    gi->slots = slots;
    const char **names = realloc(gi->names, count * sizeof *names);
    if (!names)
        return false;
    gi->names = names;
    gi->slots[gi->count] = (view_slot){ .name = name, .loaded = gi->count == 0 };
    gi->names[gi->count++] = name;
    return true;
}

bool view_gi_scan(view *v)
{
    const char *name;
    bool memory = v->gi.count > 0 || add_slot(v, "none");
    for (int i = 0; memory && (name = gi_name(v->h->registry, i)); ++i)
        if (view_gi_find(v, name) < 0)
            memory = add_slot(v, name);
    return memory;
}

// ---- modules ---------------------------------------------------------------------------------

// The values of the old table that the new one has by name and takes, else its defaults. The old
// one stays readable: see gi_reload().
static bool carry_over(const gi_plugin *fresh, setting *s)
{
    const setting old = *s;
    const int count = old.plugin ? gi_params_count(old.plugin) : 0;
    *s = (setting){ 0 };
    if (!fresh) {
        free(old.values);
        return true;
    }
    s->values = calloc((size_t) gi_params_count(fresh) + 1, sizeof *s->values);
    if (!s->values) {
        free(old.values);
        return false;
    }
    s->plugin = fresh;
    gi_params_default(fresh, s->values);
    for (int i = 0; i < count; ++i) {
        char value[128], text[256];
        gi_params_print(old.plugin, old.values, i, value, sizeof value);
        snprintf(text, sizeof text, "%s=%s", old.plugin->params[i].name, value);
        if (gi_params_set(NULL, fresh, s->values, text) != FG_OK)
            continue; // gone, or no longer in range: the default stands
    }
    free(old.values);
    return true;
}

static void reload(view *v, int slot)
{
    view_slot *s = &v->gi.slots[slot];
    const fg_status status = gi_reload(v->h->registry, s->name);
    if (status == FG_ERR_INPUT || status == FG_ERR_INVALID || status == FG_ERR_MEMORY) {
        view_say(v, FG_LOG_WARN, "%s: could not be loaded again, goes on as it was", s->name);
        return;
    }
    const gi_plugin *fresh = status == FG_OK ? gi_find(v->h->registry, s->name) : NULL;
    if (v->gi.side[0] == slot && v->layer >= LAYER_PLUGIN)
        view_layer_set(v, LAYER_FINAL);
    const bool memory = carry_over(fresh, &s->sides[0]) && carry_over(fresh, &s->sides[1]);
    view_gi_touch(v, (v->gi.side[0] == slot ? 1u : 0) | (v->gi.side[1] == slot ? 2u : 0));
    if (!memory)
        view_say(v, FG_LOG_ERROR, "%s: out of memory", s->name);
    else if (fresh)
        view_say(v, FG_LOG_INFO, "%s: loaded again", s->name);
    else
        view_say(v, FG_LOG_ERROR, "%s: the new module is refused; direct light alone", s->name);
}

void view_gi_watch(view *v)
{
    if (v->now - v->gi.looked < 0.5)
        return;
    v->gi.looked = v->now;
    for (int i = 1; i < v->gi.count; ++i)
        if (v->gi.slots[i].loaded && gi_changed(v->h->registry, v->gi.slots[i].name))
            reload(v, i);
    if (v->now - v->gi.scanned < 2)
        return;
    v->gi.scanned = v->now;
    if (gi_rescan(v->h->registry) != FG_OK || !view_gi_scan(v))
        view_say(v, FG_LOG_ERROR, "the plugin folders cannot be looked at");
}
