// SPDX-License-Identifier: MIT
// Settings along the animation: first the pictures that are compared, then times.
#include "study_priv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct walk {
    course *c;
    renderer *r;
    int frames, compared;
    timing timings[STUDY_POINTS];
    cJSON *paths[STUDY_POINTS];   // "path" of the points' records
    cJSON *errors[STUDY_POINTS];  // "errors" of them
    cJSON *records[STUDY_POINTS]; // in the order of the points, whichever is done first
} walk;

// ---- where -----------------------------------------------------------------------------------

static const study_curve *curve_of(const walk *w, int k)
{
    return &w->c->s->curves[w->c->points[k].curve];
}

static double time_at(const walk *w, int k, int frame)
{
    const double speed = curve_of(w, k)->speed, rate = w->c->s->path.rate;
    const double unit = rate > 0 ? 1 / rate : w->c->d->h->scene->duration / w->frames;
    return frame * unit * (speed > 0 ? speed : 1);
}

static int edge(const walk *w, int k, int pixels)
{
    const double scale = curve_of(w, k)->scale;
    return (int) fmax(1, round(pixels * (scale > 0 ? scale : 1)));
}

// At even distances, the last among them.
static bool is_compared(const walk *w, int frame)
{
    return (frame + 1) * w->compared / w->frames > frame * w->compared / w->frames;
}

static fg_status pose(const walk *w, int k, int frame, double *time)
{
    *time = time_at(w, k, frame);
    return tour_pose(&w->c->tour, w->r, *time);
}

// To the start, by way of nothing, so that no setting inherits what the one before has kept. What
// creates and compiles is in a frame of its own.
static fg_status start(const walk *w, int k)
{
    host *h = w->c->d->h;
    const setting none = { 0 };
    double time = 0;
    fg_status status = host_switch(h, w->r, &none);
    if (status == FG_OK)
        status = renderer_resize(w->r, edge(w, k, w->c->d->width), edge(w, k, w->c->d->height));
    if (status == FG_OK)
        status = host_switch(h, w->r, &w->c->jobs[k].s);
    if (status == FG_OK)
        status = pose(w, k, 0, &time);
    return status == FG_OK ? renderer_frame(w->r, time) : status;
}

static fg_status open_renderer(walk *w, renderer_layer layer)
{
    const studies_desc *d = w->c->d;
    const setting none = { 0 };
    renderer_desc desc = host_renderer_desc(d->h, &none, d->width, d->height);
    desc.layers = 1u << layer;
    desc.strict = true;
    renderer_destroy(w->r);
    w->r = NULL;
    return host_renderer(d->h, &desc, &w->r);
}

static void add_number(cJSON *list, double value)
{
    cJSON_AddItemToArray(list, isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull());
}

// ---- pictures --------------------------------------------------------------------------------

static void add_metrics(metrics *sum, const metrics *e, double weight)
{
    sum->rmse += weight * e->rmse;
    sum->rmse_rms += weight * e->rmse_rms;
    sum->rmse_max += weight * e->rmse_max;
    sum->relmse += weight * e->relmse;
    sum->smape += weight * e->smape;
    sum->bias += weight * e->bias;
    sum->energy_ratio += weight * e->energy_ratio;
    sum->p99 += weight * e->p99;
    sum->nonfinite += e->nonfinite;
}

// Compares the picture with every baseline at that time; traces[i] is a list, a figure a frame.
static fg_status compare(const walk *w, int k, double time, metrics *means, bool *there,
                         cJSON *traces)
{
    course *c = w->c;
    image picture = { 0 };
    fg_status status = renderer_read(w->r, LAYER_INDIRECT, &picture);
    for (int i = 0; c->s->baselines[i] && status == FG_OK; ++i) {
        const image *other;
        metrics e;
        status = study_baseline(c, k, i, time, &other);
        if (status == FG_OK && other)
            status = metrics_compare(&c->d->h->c->log, &picture, other, &e);
        if (status != FG_OK)
            break;
        there[i] = other != NULL;
        if (other)
            add_metrics(&means[i], &e, 1.0 / w->compared);
        add_number(cJSON_GetArrayItem(traces, i), other ? e.rmse_rms : (double) NAN);
    }
    image_finish(&picture);
    return status;
}

static fg_status walk_pictures(const walk *w, int k)
{
    const study *s = w->c->s;
    metrics means[STUDY_BASELINES] = { 0 };
    bool there[STUDY_BASELINES] = { false };
    cJSON *traces = cJSON_GetObjectItem(w->paths[k], "errors");
    fg_status status = start(w, k);
    for (int f = 0; f < w->frames && status == FG_OK; ++f) {
        double time;
        status = pose(w, k, f, &time);
        if (status == FG_OK)
            status = renderer_frame(w->r, time);
        if (status == FG_OK && is_compared(w, f))
            status = compare(w, k, time, means, there, traces);
        for (int i = 0; s->baselines[i] && !is_compared(w, f); ++i)
            add_number(cJSON_GetArrayItem(traces, i), (double) NAN);
    }
    for (int i = 0; s->baselines[i] && status == FG_OK; ++i)
        cJSON_AddItemToArray(w->errors[k], there[i] ? record_error(s->baselines[i], &means[i])
                                                    : cJSON_CreateNull());
    return status;
}

// Baselines first, as they set the light, too: point by point, for its times.
static fg_status make_baselines(const walk *w, int k)
{
    course *c = w->c;
    fg_status status = FG_OK;
    for (int f = 0; f < w->frames && status == FG_OK; ++f)
        for (int i = 0; c->s->baselines[i] && is_compared(w, f) && status == FG_OK; ++i) {
            const image *unused;
            status = study_baseline(c, k, i, time_at(w, k, f), &unused);
        }
    return status;
}

static fg_status all_pictures(walk *w)
{
    fg_status status = FG_OK;
    for (int k = 0; k < w->c->count && status == FG_OK; ++k)
        status = make_baselines(w, k);
    if (status == FG_OK)
        status = open_renderer(w, LAYER_INDIRECT);
    for (int k = 0; k < w->c->count && status == FG_OK; ++k) {
        cli_progress("study path, errors", (double) k / w->c->count);
        status = walk_pictures(w, k);
    }
    cli_progress("study path, errors", 1);
    return status;
}

// ---- times -----------------------------------------------------------------------------------

static void note_counters(const walk *w, int k)
{
    enum { MAX = 64 };
    gi_counter counters[MAX];
    cJSON *lists = cJSON_GetObjectItem(w->paths[k], "counters"), *list;
    const int count = renderer_counters(w->r, counters, MAX);
    cJSON_ArrayForEach(list, lists)
    {
        double value = (double) NAN;
        for (int i = 0; i < count && i < MAX; ++i)
            if (!strcmp(counters[i].name, list->string))
                value = counters[i].value;
        add_number(list, value);
    }
}

static fg_status walk_times(walk *w, int k, bool first)
{
    fg_status status = start(w, k);
    for (int f = 0; f < w->frames && status == FG_OK; ++f) {
        double time;
        status = pose(w, k, f, &time);
        if (status == FG_OK)
            status = timing_frame(&w->timings[k], w->c->d->h->device, w->r, time);
        if (status == FG_OK && first)
            note_counters(w, k);
    }
    return status;
}

// The median over the times through, at each frame.
static void add_ms(const walk *w, int k)
{
    enum { MAX_VISITS = 16 };
    const timing *t = &w->timings[k];
    cJSON *ms = cJSON_AddArrayToObject(w->paths[k], "ms");
    for (int f = 0; f < w->frames; ++f) {
        double values[MAX_VISITS];
        int n = 0;
        for (int at = f; at < t->count && n < MAX_VISITS; at += w->frames)
            values[n++] = t->frame[at];
        add_number(ms, timing_quantile(values, n, 0.5));
    }
}

static void complete(walk *w, int k)
{
    const course *c = w->c;
    cJSON *record = record_create(c->d->h, w->r, &c->jobs[k].s, &w->timings[k],
                                  edge(w, k, c->d->width), edge(w, k, c->d->height));
    add_ms(w, k);
    cJSON_AddItemToObject(record, "path", w->paths[k]);
    cJSON_AddItemToObject(record, "errors", w->errors[k]);
    w->paths[k] = w->errors[k] = NULL;
    w->records[k] = record;
}

// Setting by setting within each visit, so that a slow minute of the machine falls on all. Slow
// settings go once, others as often as the budget says.
static fg_status all_times(walk *w)
{
    const budget *b = w->c->d->budget;
    fg_status status = open_renderer(w, LAYER_FINAL);
    for (int v = 0; v < b->visits && status == FG_OK; ++v)
        for (int k = 0; k < w->c->count && status == FG_OK; ++k) {
            cli_progress("study path", (v + (double) k / w->c->count) / b->visits);
            if (!w->paths[k])
                continue;
            status = walk_times(w, k, v == 0);
            const bool last = v + 1 == b->visits || w->timings[k].frame[0] >= b->slow_ms;
            if (status == FG_OK && last)
                complete(w, k);
        }
    for (int k = 0; k < w->c->count && status == FG_OK; ++k) {
        study_take_point(w->c, k, w->records[k]);
        w->records[k] = NULL;
    }
    cli_progress("study path", 1);
    return status;
}

// ---- both ------------------------------------------------------------------------------------

static cJSON *new_path(const walk *w, int k)
{
    const study *s = w->c->s;
    cJSON *path = cJSON_CreateObject();
    cJSON *seconds = cJSON_AddArrayToObject(path, "seconds");
    for (int f = 0; f < w->frames; ++f)
        add_number(seconds, time_at(w, k, f));
    cJSON *counters = cJSON_AddObjectToObject(path, "counters");
    for (int i = 0; s->path.counters[i]; ++i)
        cJSON_AddArrayToObject(counters, s->path.counters[i]);
    cJSON *errors = cJSON_AddArrayToObject(path, "errors");
    for (int i = 0; s->baselines[i]; ++i)
        cJSON_AddItemToArray(errors, cJSON_CreateArray());
    return path;
}

static fg_status walk_all(walk *w)
{
    const course *c = w->c;
    fg_status status = FG_OK;
    for (int k = 0; k < c->count && status == FG_OK; ++k) {
        w->paths[k] = new_path(w, k);
        w->errors[k] = cJSON_CreateArray();
        status = timing_create(w->frames * c->d->budget->visits, &w->timings[k]);
    }
    if (status == FG_OK && c->s->baselines[0])
        status = all_pictures(w);
    return status == FG_OK ? all_times(w) : status;
}

fg_status study_walk(course *c)
{
    const study_path *p = &c->s->path;
    const bool full = c->d->full;
    baselines own = { .d = c->d }; // of times that no other study has
    baselines *const shared = c->baselines;
    walk *w = calloc(1, sizeof *w);
    if (!w)
        return FG_ERR_MEMORY;
    *w = (walk){ .c = c, .frames = p->frames[full], .compared = p->compared[full] };
    c->baselines = &own;
    fg_status status = walk_all(w);
    c->baselines = shared;
    const fg_status back = tour_end(&c->tour);
    for (int k = 0; k < c->count; ++k) {
        cJSON_Delete(w->paths[k]);
        cJSON_Delete(w->errors[k]);
        cJSON_Delete(w->records[k]);
        timing_finish(&w->timings[k]);
    }
    renderer_destroy(w->r);
    free(w);
    baselines_finish(&own);
    return status == FG_OK ? back : status;
}
