// SPDX-License-Identifier: MIT
#include "record.h"

#include "file.h"
#include "trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double) t.tv_sec * 1e3 + (double) t.tv_nsec * 1e-6;
}

// ---- timing ----------------------------------------------------------------------------------

fg_status timing_create(int capacity, timing *out)
{
    *out = (timing){ .capacity = capacity };
    out->frame = calloc((size_t) capacity, sizeof *out->frame);
    out->cpu = calloc((size_t) capacity, sizeof *out->cpu);
    if (out->frame && out->cpu)
        return FG_OK;
    timing_finish(out);
    return FG_ERR_MEMORY;
}

void timing_finish(timing *t)
{
    free(t->frame);
    free(t->cpu);
    for (int i = 0; i < t->pass_count; ++i) {
        free(t->gpu[i]);
        free(t->call[i]);
    }
    *t = (timing){ 0 };
}

static double *nan_row(int capacity)
{
    double *row = malloc((size_t) capacity * sizeof *row);
    for (int k = 0; row && k < capacity; ++k)
        row[k] = (double) NAN;
    return row;
}

// The pass's row, made when it is new; -1 where there is no room.
static int find_pass(timing *t, const char *name)
{
    for (int i = 0; i < t->pass_count; ++i)
        if (!strncmp(t->pass[i], name, sizeof t->pass[i] - 1))
            return t->gpu[i] && t->call[i] ? i : -1;
    if (t->pass_count == TIMING_MAX_PASSES)
        return -1;
    t->gpu[t->pass_count] = nan_row(t->capacity);
    t->call[t->pass_count] = nan_row(t->capacity);
    snprintf(t->pass[t->pass_count], sizeof t->pass[0], "%s", name);
    ++t->pass_count; // timing_finish() frees what was had of a row
    return t->gpu[t->pass_count - 1] && t->call[t->pass_count - 1] ? t->pass_count - 1 : -1;
}

static void take_passes(timing *t, const fg_graph *g)
{
    fg_timing pass;
    for (int i = 0; fg_graph_timing(g, i, &pass); ++i) {
        const int row = find_pass(t, pass.pass);
        if (row >= 0 && pass.gpu_ms >= 0)
            t->gpu[row][t->count] = pass.gpu_ms;
        if (row >= 0)
            t->call[row][t->count] = pass.cpu_ms;
    }
}

fg_status timing_frame(timing *t, fg_device *device, renderer *r, double time)
{
    if (t->count >= t->capacity)
        return FG_OK;
    fg_status status = fg_gl_finish(device);
    const double start = now_ms();
    if (status == FG_OK)
        status = renderer_frame(r, time);
    const double submitted = now_ms();
    if (status == FG_OK)
        status = fg_gl_finish(device);
    if (status != FG_OK)
        return status;
    t->frame[t->count] = now_ms() - start;
    t->cpu[t->count] = submitted - start;
    take_passes(t, renderer_graph(r));
    trace_frame(t->trace, r);
    ++t->count;
    return FG_OK;
}

fg_status timing_run(timing *t, fg_device *device, renderer *r, int frame, int frames)
{
    fg_status status = renderer_frame(r, (frame + 1) / 60.0); // warm-up
    if (status == FG_OK)
        trace_frame(t->trace, r);
    for (int i = 1; i <= frames && status == FG_OK; ++i)
        status = timing_frame(t, device, r, (frame + 1 + i) / 60.0);
    return status;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

double timing_quantile(const double *values, int count, double q)
{
    int n = 0;
    double *sorted = malloc((size_t) (count > 0 ? count : 1) * sizeof *sorted);
    for (int i = 0; sorted && i < count; ++i)
        if (!isnan(values[i]))
            sorted[n++] = values[i];
    if (!n) {
        free(sorted);
        return (double) NAN;
    }
    qsort(sorted, (size_t) n, sizeof *sorted, compare_doubles);
    const double at = q * (n - 1);
    const int low = (int) at, high = low + 1 < n ? low + 1 : low;
    const double result = sorted[low] + (at - low) * (sorted[high] - sorted[low]);
    free(sorted);
    return result;
}

// ---- JSON ------------------------------------------------------------------------------------

static void add_number(cJSON *object, const char *name, double value)
{
    cJSON_AddItemToObject(object, name,
                          isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull());
}

cJSON *record_device(const host *h)
{
    cJSON *device = cJSON_CreateObject();
    cJSON_AddStringToObject(device, "renderer", fg_gl_renderer(h->device));
    cJSON_AddStringToObject(device, "version", fg_gl_version(h->device));
    return device;
}

cJSON *record_features(uint64_t features)
{
    cJSON *array = cJSON_CreateArray();
    for (int i = 0; i < AG_FEATURE_COUNT; ++i)
        if (features >> i & 1)
            cJSON_AddItemToArray(array, cJSON_CreateString(ag_feature_names[i]));
    return array;
}

cJSON *record_params(const setting *s)
{
    cJSON *params = cJSON_CreateObject();
    for (int i = 0; s->plugin && i < gi_params_count(s->plugin); ++i) {
        const gi_param *row = &s->plugin->params[i];
        switch (row->type) {
        case GI_INT: cJSON_AddNumberToObject(params, row->name, (double) s->values[i].i); break;
        case GI_FLOAT: cJSON_AddNumberToObject(params, row->name, s->values[i].f); break;
        case GI_BOOL: cJSON_AddBoolToObject(params, row->name, s->values[i].i != 0); break;
        case GI_ENUM:
            cJSON_AddStringToObject(params, row->name, row->choices[s->values[i].i]);
            break;
        }
    }
    return params;
}

static cJSON *frame_json(const timing *t)
{
    cJSON *frame = cJSON_CreateObject();
    add_number(frame, "median", timing_quantile(t->frame, t->count, 0.5));
    add_number(frame, "p99", timing_quantile(t->frame, t->count, 0.99));
    add_number(frame, "min", timing_quantile(t->frame, t->count, 0));
    cJSON_AddNumberToObject(frame, "frames", t->count);
    return frame;
}

static cJSON *passes_json(const timing *t)
{
    cJSON *passes = cJSON_CreateArray();
    for (int i = 0; i < t->pass_count; ++i) {
        cJSON *pass = cJSON_CreateObject();
        cJSON_AddStringToObject(pass, "name", t->pass[i]);
        add_number(pass, "gpu_ms", timing_quantile(t->gpu[i], t->gpu[i] ? t->count : 0, 0.5));
        add_number(pass, "cpu_ms", timing_quantile(t->call[i], t->call[i] ? t->count : 0, 0.5));
        cJSON_AddItemToArray(passes, pass);
    }
    return passes;
}

static cJSON *counters_json(renderer *r)
{
    enum { MAX = 64 };
    gi_counter counters[MAX];
    const int count = renderer_counters(r, counters, MAX);
    cJSON *object = cJSON_CreateObject();
    for (int i = 0; i < count && i < MAX; ++i)
        add_number(object, counters[i].name, counters[i].value);
    return object;
}

static cJSON *memory_json(renderer *r)
{
    const fg_graph_stats stats = fg_graph_get_stats(renderer_graph(r));
    cJSON *memory = cJSON_CreateObject();
    cJSON_AddNumberToObject(memory, "transient_bytes", (double) stats.transient_bytes);
    cJSON_AddNumberToObject(memory, "unshared_bytes", (double) stats.unshared_bytes);
    cJSON_AddNumberToObject(memory, "persistent_bytes", (double) stats.persistent_bytes);
    return memory;
}

static cJSON *left_out_json(renderer *r)
{
    const char *pass, *why;
    cJSON *list = cJSON_CreateArray();
    for (int i = 0; (pass = fg_graph_left_out(renderer_graph(r), i, &why)); ++i) {
        cJSON *entry = cJSON_CreateObject();
        cJSON_AddStringToObject(entry, "pass", pass);
        cJSON_AddStringToObject(entry, "why", why);
        cJSON_AddItemToArray(list, entry);
    }
    return list;
}

cJSON *record_error(const char *reference, const metrics *m)
{
    cJSON *error = cJSON_CreateObject();
    cJSON_AddStringToObject(error, "reference", reference);
    add_number(error, "rmse", m->rmse);
    add_number(error, "rmse_rms", m->rmse_rms);
    add_number(error, "rmse_max", m->rmse_max);
    add_number(error, "relmse", m->relmse);
    add_number(error, "smape", m->smape);
    add_number(error, "bias", m->bias);
    add_number(error, "energy_ratio", m->energy_ratio);
    add_number(error, "p99", m->p99);
    cJSON_AddNumberToObject(error, "nonfinite", (double) m->nonfinite);
    return error;
}

cJSON *record_create(const host *h, renderer *r, const setting *s, const timing *t, int width,
                     int height)
{
    const setting none = { 0 };

    cJSON *record = cJSON_CreateObject(), *cpu = cJSON_CreateObject();
    if (h->fell_back || renderer_fault(r))
        s = &none;
    add_number(cpu, "median", timing_quantile(t->cpu, t->count, 0.5));
    cJSON_AddItemToObject(record, "device", record_device(h));
    cJSON_AddStringToObject(record, "scene", h->scene_name);
    cJSON_AddItemToObject(record, "size", cJSON_CreateIntArray((int[]){ width, height }, 2));
    cJSON_AddStringToObject(record, "plugin", setting_name(s));
    cJSON_AddItemToObject(record, "params", record_params(s));
    cJSON_AddItemToObject(record, "frame_ms", frame_json(t));
    cJSON_AddItemToObject(record, "cpu_ms", cpu);
    cJSON_AddItemToObject(record, "passes", passes_json(t));
    cJSON_AddItemToObject(record, "counters", counters_json(r));
    cJSON_AddItemToObject(record, "memory", memory_json(r));
    cJSON_AddItemToObject(record, "left_out", left_out_json(r));
    cJSON_AddNullToObject(record, "error");
    return record;
}

fg_status record_write(const fg_log *log, const cJSON *json, const char *path)
{
    return file_write_text(log, path, cJSON_Print(json));
}
