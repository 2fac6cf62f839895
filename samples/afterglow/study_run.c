// SPDX-License-Identifier: MIT
#include "study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_POINTS = STUDY_CURVES * STUDY_VALUES, PATH_FULL = 48, PATH_QUICK = 12 };

typedef struct point {
    char text[256]; // the whole setting
    int curve;
    const char *value; // of x; NULL: none is swept
} point;

// A study on a scene while it is measured.
typedef struct course {
    const studies_desc *d;
    const study *s;
    baselines *baselines;
    cJSON *points_json;
    int count;
    point points[MAX_POINTS];
    job jobs[MAX_POINTS];
    batch batch;
} course;

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

// Says of a record what point it is, and hands it over.
static void take_point(course *c, int k, cJSON *record)
{
    cJSON_AddStringToObject(record, "curve", c->s->curves[c->points[k].curve].label);
    cJSON_AddItemToObject(record, "x", x_json(c->points[k].value));
    study_add_stages(record);
    cJSON_AddItemToArray(c->points_json, record);
}

// ---- pictures and times ----------------------------------------------------------------------

// The picture that point k is compared with; NULL: there is none.
static fg_status baseline_of(course *c, int k, int baseline, const image **out)
{
    const char *text = c->s->baselines[baseline];
    const int truth = study_truth(text);
    *out = NULL;
    if (truth < 0)
        return baselines_get(c->baselines, text, c->points[k].text, out);
    if (c->d->truths)
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
        status = baseline_of(c, k, i, &other);
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
            status = baseline_of(c, k, i, &picture);
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
        take_point(c, k, c->batch.records[k]);
        c->batch.records[k] = NULL;
    }
    batch_finish(&c->batch);
    return status;
}

// ---- along the animation ---------------------------------------------------------------------

// Once through the animation. Slow settings go once, others as often as the budget says.
static fg_status walk(course *c, renderer *r, int k, int frames, timing *t)
{
    const double duration = c->d->h->scene->duration;
    fg_status status = host_switch(c->d->h, r, &c->jobs[k].s);
    if (status == FG_OK)
        status = renderer_frame(r, 0); // what creates and compiles is not to be timed
    for (int i = 0; i < frames && status == FG_OK; ++i)
        status = timing_frame(t, c->d->h->device, r, duration * i / frames);
    return status;
}

// The median over the passes at each of the times.
static cJSON *path_json(const course *c, const timing *t, int frames)
{
    enum { MAX_VISITS = 16 };
    cJSON *path = cJSON_CreateObject();
    cJSON *seconds = cJSON_AddArrayToObject(path, "seconds");
    cJSON *ms = cJSON_AddArrayToObject(path, "ms");
    for (int i = 0; i < frames; ++i) {
        double values[MAX_VISITS];
        int n = 0;
        for (int at = i; at < t->count && n < MAX_VISITS; at += frames)
            values[n++] = t->frame[at];
        const double median = timing_quantile(values, n, 0.5);
        cJSON_AddItemToArray(seconds, cJSON_CreateNumber(c->d->h->scene->duration * i / frames));
        cJSON_AddItemToArray(ms, cJSON_CreateNumber(median));
    }
    return path;
}

// Setting by setting within each visit, so that a slow minute of the machine falls on all.
static fg_status walk_all(course *c, renderer *r, int frames, timing *timings)
{
    const budget *b = c->d->budget;
    fg_status status = FG_OK;
    for (int k = 0; k < c->count && status == FG_OK; ++k)
        status = timing_create(frames * b->visits, &timings[k]);
    for (int v = 0; v < b->visits && status == FG_OK; ++v)
        for (int k = 0; k < c->count && status == FG_OK; ++k) {
            cli_progress("study path", (v + (double) k / c->count) / b->visits);
            if (v && timings[k].frame[0] >= b->slow_ms)
                continue;
            status = walk(c, r, k, frames, &timings[k]);
            const bool last = v + 1 == b->visits || timings[k].frame[0] >= b->slow_ms;
            if (status != FG_OK || !last)
                continue;
            cJSON *record =
                record_create(c->d->h, r, &c->jobs[k].s, &timings[k], c->d->width, c->d->height);
            cJSON_AddItemToObject(record, "path", path_json(c, &timings[k], frames));
            take_point(c, k, record);
        }
    cli_progress("study path", 1);
    return status;
}

static fg_status run_path(course *c)
{
    const setting none = { 0 };
    const int frames = c->d->full ? PATH_FULL : PATH_QUICK;
    timing *timings = calloc((size_t) c->count + 1, sizeof *timings);
    renderer *r = NULL;
    const renderer_desc desc = host_renderer_desc(c->d->h, &none, c->d->width, c->d->height);
    fg_status status = timings ? host_renderer(c->d->h, &desc, &r) : FG_ERR_MEMORY;
    if (status == FG_OK)
        status = walk_all(c, r, frames, timings);
    for (int k = 0; k < c->count && timings; ++k)
        timing_finish(&timings[k]);
    free(timings);
    renderer_destroy(r);
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
        .d = d, .s = s, .baselines = b, .points_json = cJSON_GetObjectItem(item, "points")
    };
    fg_status status = FG_OK;
    make_points(c);
    if (s->path && !(d->h->scene->duration > 0)) {
        report_note(d->doc, "studies: nothing moves in %.200s: %s is left out", d->h->scene_name,
                    s->name);
    } else if (c->count) {
        status = s->path ? run_path(c) : run_points(c);
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
