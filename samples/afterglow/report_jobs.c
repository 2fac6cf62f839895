// SPDX-License-Identifier: MIT
#include "report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Quick: so many values of a parameter, and so many settings of a scene, shared by the plugins.
enum { MAX_PRODUCT = 200, QUICK_VALUES = 4, QUICK_SETTINGS = 16, QUICK_LEAST = 3, QUICK_MOST = 7 };

void jobs_finish(job_list *list)
{
    for (int i = 0; i < list->count; ++i)
        setting_finish(&list->jobs[i].s);
    free(list->jobs);
    *list = (job_list){ 0 };
}

static bool same_values(const setting *a, const setting *b)
{
    if (a->plugin != b->plugin)
        return false;
    for (int i = 0; a->plugin && i < gi_params_count(a->plugin); ++i) {
        const bool is_float = a->plugin->params[i].type == GI_FLOAT;
        if (is_float ? a->values[i].f != b->values[i].f : a->values[i].i != b->values[i].i)
            return false;
    }
    return true;
}

static void write_label(const setting *base, job *j)
{
    const gi_plugin *p = base->plugin;
    size_t at = 0;
    for (int i = 0; p && i < gi_params_count(p) && at < sizeof j->label; ++i) {
        char value[64];
        const bool is_float = p->params[i].type == GI_FLOAT;
        if (is_float ? base->values[i].f == j->s.values[i].f
                     : base->values[i].i == j->s.values[i].i)
            continue;
        gi_params_print(p, j->s.values, i, value, sizeof value);
        const int n = snprintf(j->label + at, sizeof j->label - at, "%s%s=%s", at ? " " : "",
                               p->params[i].name, value);
        at += n > 0 ? (size_t) n : 0;
    }
    if (!at)
        snprintf(j->label, sizeof j->label, p ? "default" : "direct light alone");
}

// Appends a copy of `s` if it is not there yet.
static fg_status append(job_list *list, const setting *base, const setting *s)
{
    for (int i = 0; i < list->count; ++i)
        if (same_values(&list->jobs[i].s, s))
            return FG_OK;
    if (list->count == list->capacity) {
        const int capacity = list->capacity ? 2 * list->capacity : 16;
        job *jobs = realloc(list->jobs, (size_t) capacity * sizeof *jobs);
        if (!jobs)
            return FG_ERR_MEMORY;
        list->jobs = jobs;
        list->capacity = capacity;
    }
    job *j = &list->jobs[list->count];
    *j = (job){ .base = s == base };
    if (!setting_copy(s, &j->s))
        return FG_ERR_MEMORY;
    write_label(base, j);
    ++list->count;
    return FG_OK;
}

// A parameter that --set has fixed is not swept.
static bool pinned(const options *o, const gi_plugin *p, const gi_param *row)
{
    for (int i = 0; i < o->set_count; ++i) {
        const char *text = o->set[i];
        const size_t key = strcspn(text, "="), name = strlen(row->name), plugin = strlen(p->name);
        if (key == name && !strncmp(text, row->name, name))
            return true;
        if (key == plugin + 1 + name && !strncmp(text, p->name, plugin) &&
            !strncmp(text + plugin + 1, row->name, name))
            return true;
    }
    return false;
}

static int sweep_length(const options *o, const gi_plugin *p, int i)
{
    const gi_param *row = &p->params[i];
    int n = 0;
    if (!row->quality || !row->sweep || pinned(o, p, row))
        return 0;
    while (!isnan(row->sweep[n]))
        ++n;
    return n;
}

static void set_swept(setting *s, int i, int k)
{
    const gi_param *row = &s->plugin->params[i];
    if (row->type == GI_FLOAT)
        s->values[i].f = row->sweep[k];
    else
        s->values[i].i = (int64_t) row->sweep[k];
}

// Each parameter alone over its first `values` values, the others at base; in turns, so that a
// limit on settings leaves every parameter its cheapest ones.
static fg_status one_at_a_time(const options *o, const setting *base, int values, int limit,
                               job_list *out)
{
    const int first = out->count - 1; // the base stands already
    const int count = gi_params_count(base->plugin);
    fg_status status = FG_OK;
    for (int k = 0; k < values && status == FG_OK; ++k)
        for (int i = 0; i < count && status == FG_OK && out->count - first < limit; ++i) {
            setting s;
            if (k >= sweep_length(o, base->plugin, i))
                continue;
            if (!setting_copy(base, &s))
                return FG_ERR_MEMORY;
            set_swept(&s, i, k);
            status = append(out, base, &s);
            setting_finish(&s);
        }
    return status;
}

static fg_status product(const options *o, const setting *base, int total, job_list *out)
{
    const int count = gi_params_count(base->plugin);
    fg_status status = FG_OK;
    for (int n = 0; n < total && status == FG_OK; ++n) {
        setting s;
        int rest = n;
        if (!setting_copy(base, &s))
            return FG_ERR_MEMORY;
        for (int i = 0; i < count; ++i) {
            const int length = sweep_length(o, base->plugin, i);
            if (!length)
                continue;
            set_swept(&s, i, rest % length);
            rest /= length;
        }
        status = append(out, base, &s);
        setting_finish(&s);
    }
    return status;
}

static fg_status add_plugin(const options *o, const setting *base, bool full, int limit,
                            job_list *out)
{
    enum { ALL = 1 << 20 };
    int total = 1;
    const fg_status status = append(out, base, base);
    if (status != FG_OK || !base->plugin)
        return status;
    for (int i = 0; i < gi_params_count(base->plugin) && total <= MAX_PRODUCT; ++i) {
        const int length = sweep_length(o, base->plugin, i);
        total *= length ? length : 1;
    }
    if (!full)
        return one_at_a_time(o, base, QUICK_VALUES, limit, out);
    if (total <= MAX_PRODUCT)
        return product(o, base, total, out);
    return one_at_a_time(o, base, ALL, ALL, out);
}

fg_status jobs_build(const options *o, const setting *plugins, int count, bool full, job_list *out)
{
    const setting none = { 0 };
    int limit = QUICK_SETTINGS / (count > 0 ? count : 1);
    limit = limit < QUICK_LEAST ? QUICK_LEAST : limit > QUICK_MOST ? QUICK_MOST : limit;
    *out = (job_list){ 0 };
    fg_status status = append(out, &none, &none);
    for (int i = 0; i < count && status == FG_OK; ++i)
        if (plugins[i].plugin)
            status = add_plugin(o, &plugins[i], full, limit, out);
    if (status != FG_OK)
        jobs_finish(out);
    return status;
}
