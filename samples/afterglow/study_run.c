// SPDX-License-Identifier: MIT
#include "study_priv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- points ----------------------------------------------------------------------------------

// Of two settings as text.
static bool same_plugin(const char *a, const char *b)
{
    const size_t length = strcspn(a, " ");
    return length == strcspn(b, " ") && !strncmp(a, b, length);
}

static bool measured(const studies_desc *d, const char *setting_text)
{
    for (int i = 0; i < d->plugin_count; ++i)
        if (same_plugin(setting_name(&d->plugins[i]), setting_text))
            return true;
    return false;
}

static void add_point(course *c, int curve, const char *value)
{
    const char *why, *base = c->s->curves[curve].setting;
    char text[sizeof c->points[0].text];
    point *p = &c->points[c->count];
    job *j = &c->jobs[c->count];
    *p = (point){ .curve = curve, .value = value };
    *j = (job){ .base = false };
    if (value)
        snprintf(text, sizeof text, "%s %s=%s", base, c->s->x, value);
    else
        snprintf(text, sizeof text, "%s", base);
    memcpy(p->text, text, sizeof text);
    snprintf(j->label, sizeof j->label, "%.90s", text);
    if (!study_setting(c->d, text, &j->s))
        return;
    if (host_serves(c->d->h, j->s.plugin, &why))
        ++c->count;
    else
        setting_finish(&j->s);
}

static void make_points(course *c)
{
    const study *s = c->s;
    for (int i = 0; s->curves[i].setting; ++i) {
        if (!measured(c->d, s->curves[i].setting))
            continue;
        if (!s->x)
            add_point(c, i, NULL);
        for (int k = 0; s->x && s->values[k]; ++k)
            add_point(c, i, s->values[k]);
    }
}

static cJSON *x_json(const char *value)
{
    double number;
    if (!value)
        return cJSON_CreateNull();
    if (parse_double(value, -1e300, 1e300, &number))
        return cJSON_CreateNumber(number);
    return cJSON_CreateString(value);
}

void study_take_point(course *c, int k, cJSON *record)
{
    cJSON_AddStringToObject(record, "curve", c->s->curves[c->points[k].curve].label);
    cJSON_AddItemToObject(record, "x", x_json(c->points[k].value));
    study_add_stages(record);
    cJSON_AddItemToArray(c->points_json, record);
}

// ---- pictures and times ----------------------------------------------------------------------

fg_status study_baseline(course *c, int k, int baseline, double time, const image **out)
{
    const char *text = c->s->baselines[baseline];
    const int truth = study_truth(text);
    *out = NULL;
    if (truth < 0)
        return baselines_get(c->baselines, &c->tour, time, text, c->points[k].text, out);
    if (c->d->truths && !c->s->path.frames[0]) // truths are of time 0
        *out = &c->d->truths->picture[truth];
    return FG_OK;
}

static fg_status judge(void *user, int k, renderer *r, image *picture)
{
    course *c = user;
    fg_status status = FG_OK;
    cJSON *errors = cJSON_AddArrayToObject(c->batch.records[k], "errors");
    (void) r;
    for (int i = 0; c->s->baselines[i] && status == FG_OK; ++i) {
        const char *name = c->s->baselines[i];
        const int truth = study_truth(name);
        const image *other;
        metrics e;
        status = study_baseline(c, k, i, 0, &other);
        if (status == FG_OK && other)
            status = metrics_compare(&c->d->h->c->log, picture, other, &e);
        if (status != FG_OK || !other)
            cJSON_AddItemToArray(errors, cJSON_CreateNull());
        else
            cJSON_AddItemToArray(errors, truth < 0 ? record_error(name, &e)
                                                   : truth_error(c->d->truths, truth, &e));
    }
    return status;
}

// Baselines first: their time must not be in that of the points.
static fg_status make_baselines(course *c)
{
    fg_status status = FG_OK;
    for (int k = 0; k < c->count; ++k)
        for (int i = 0; c->s->baselines[i] && status == FG_OK; ++i) {
            const image *picture;
            status = study_baseline(c, k, i, 0, &picture);
        }
    return status;
}

static fg_status run_points(course *c)
{
    char what[96];
    const studies_desc *d = c->d;
    snprintf(what, sizeof what, "%s: study %s", d->h->scene_name, c->s->name);
    c->batch = (batch){
        .h = d->h,
        .budget = d->budget,
        .width = d->width,
        .height = d->height,
        .jobs = c->jobs,
        .count = c->count,
        .what = what,
        .judge = judge,
        .user = c,
    };
    fg_status status = make_baselines(c);
    if (status == FG_OK)
        status = batch_create(&c->batch);
    if (status == FG_OK)
        status = batch_run(&c->batch);
    for (int k = 0; k < c->count && status == FG_OK; ++k) {
        study_take_point(c, k, c->batch.records[k]);
        c->batch.records[k] = NULL;
    }
    batch_finish(&c->batch);
    return status;
}

// ---- studies ---------------------------------------------------------------------------------

static cJSON *new_study(const studies_desc *d, const study *s)
{
    cJSON *item = cJSON_CreateObject();
    cJSON_AddStringToObject(item, "scene", d->h->scene_name);
    cJSON_AddStringToObject(item, "name", s->name);
    cJSON_AddStringToObject(item, "title", s->title);
    cJSON_AddNumberToObject(item, "index", d->scene_number * 1000 + (double) (s - studies));
    if (s->x) {
        cJSON *x = cJSON_AddObjectToObject(item, "x");
        cJSON_AddStringToObject(x, "parameter", s->x);
        cJSON_AddStringToObject(x, "label", s->x_label ? s->x_label : s->x);
    } else {
        cJSON_AddNullToObject(item, "x");
    }
    cJSON *list = cJSON_AddArrayToObject(item, "baselines");
    for (int i = 0; s->baselines[i]; ++i)
        cJSON_AddItemToArray(list, cJSON_CreateString(s->baselines[i]));
    cJSON_AddArrayToObject(item, "points");
    return item;
}

static fg_status run_study(const studies_desc *d, const study *s, baselines *b)
{
    course *c = calloc(1, sizeof *c);
    if (!c)
        return FG_ERR_MEMORY;
    cJSON *item = new_study(d, s);
    *c = (course){
        .d = d,
        .s = s,
        .baselines = b,
        .tour = tour_begin(d->h, s->path.tour),
        .points_json = cJSON_GetObjectItem(item, "points"),
    };
    fg_status status = FG_OK;
    make_points(c);
    const bool path = s->path.frames[0] > 0;
    if (path && !s->path.tour && !(d->h->scene->duration > 0)) {
        report_note(d->doc, "studies: nothing moves in %.200s: %s is left out", d->h->scene_name,
                    s->name);
    } else if (c->count) {
        status = path ? study_walk(c) : run_points(c);
        cJSON_AddItemToArray(cJSON_GetObjectItem(d->doc, "studies"), item);
        item = NULL;
    }
    for (int k = 0; k < c->count; ++k)
        setting_finish(&c->jobs[k].s);
    cJSON_Delete(item);
    free(c);
    return status;
}

// A note of the plugins that a study would show and that are not measured here.
static void note_absent(const studies_desc *d, const study *s)
{
    char names[160] = "";
    size_t used = 0;
    for (int i = 0; s->curves[i].setting && used < sizeof names; ++i) {
        const char *text = s->curves[i].setting;
        bool said = measured(d, text);
        for (int k = 0; k < i; ++k)
            said = said || same_plugin(s->curves[k].setting, text);
        if (!said)
            used += (size_t) snprintf(names + used, sizeof names - used, "%s%.*s", used ? ", " : "",
                                      (int) strcspn(text, " "), text);
    }
    if (used)
        report_note(d->doc, "studies: %s is without %s: not among the plugins measured", s->name,
                    names);
}

fg_status studies_measure(const studies_desc *d)
{
    const options *o = d->h->o;
    baselines b = { .d = d };
    int wanted = 0, number;
    fg_status status = FG_OK;
    for (const study *s = studies; s->name; ++s)
        wanted += study_wanted(o, d->full, s);
    number = d->scene_number * wanted;
    for (const study *s = studies; s->name && status == FG_OK; ++s) {
        if (!study_wanted(o, d->full, s) || (o->shards && (++number - o->shard) % o->shards))
            continue;
        note_absent(d, s);
        status = run_study(d, s, &b);
    }
    baselines_finish(&b);
    return status;
}
