// SPDX-License-Identifier: MIT
// Techniques whose frames run in turn, and their times.
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

double bench_now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double) t.tv_sec * 1e3 + (double) t.tv_nsec * 1e-6;
}

// ---- samples ---------------------------------------------------------------------------------

void samples_add(samples *s, double ms)
{
    s->ms[s->count++ % MAX_FRAMES] = ms;
}

static bool take_least;

void samples_take_least(void)
{
    take_least = true;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

double samples_typical(const samples *s)
{
    double sorted[MAX_FRAMES];
    const int n = s->count < MAX_FRAMES ? s->count : MAX_FRAMES;
    memcpy(sorted, s->ms, sizeof sorted);
    qsort(sorted, (size_t) n, sizeof *sorted, ascending);
    if (!n)
        return (double) NAN;
    return take_least ? sorted[0] : 0.5 * (sorted[n / 2] + sorted[(n - 1) / 2]);
}

// ---- a side ----------------------------------------------------------------------------------

static fg_status parse_words(const bench *b, side *s, const char *values)
{
    char word[96];
    for (const char *at = values; at && *at;) {
        const size_t length = strcspn(at, " ");
        snprintf(word, sizeof word, "%.*s", (int) length, at);
        if (gi_params_set(&b->log, s->table, s->set, word) != FG_OK)
            return FG_ERR_UNSUPPORTED;
        at += length + (at[length] == ' ');
    }
    return FG_OK;
}

// "a=1 b=2" over the defaults, and over both what --set gives.
static fg_status parse_values(const bench *b, side *s, const char *values)
{
    const bool subject = b->program->subject && !strcmp(b->program->subject, s->plugin);
    gi_params_default(s->table, s->set);
    fg_status status = parse_words(b, s, values);
    for (int i = 0; subject && i < b->set_count && status == FG_OK; i++)
        status = parse_words(b, s, b->set[i]);
    return status;
}

bool side_plugin_exists(const bench *b, const char *plugin)
{
    const char *name;
    for (int i = 0; (name = gi_name(b->registry, i)); i++)
        if (!strcmp(name, plugin))
            return true;
    fprintf(stderr, "%s: there is no plugin %s\n", b->program->name, plugin);
    return false;
}

static fg_status find_plugin(const bench *b, side *s)
{
    s->table = side_plugin_exists(b, s->plugin) ? gi_find(b->registry, s->plugin) : NULL;
    if (!s->table)
        return FG_ERR_UNSUPPORTED;
    s->set = calloc((size_t) gi_params_count(s->table) + 1, sizeof *s->set);
    return s->set ? parse_values(b, s, s->values) : FG_ERR_MEMORY;
}

fg_status side_open(const bench *b, side *s, const int size[2])
{
    const fg_status status = s->plugin ? find_plugin(b, s) : FG_OK;
    if (status != FG_OK)
        return status;
    return renderer_create(&(renderer_desc){ .log = &b->log,
                                             .device = b->device,
                                             .scene = b->scene,
                                             .camera_index = b->camera,
                                             .width = size[0],
                                             .height = size[1],
                                             .plugin = s->table,
                                             .values = s->set,
                                             .strict = true,
                                             .needs_all = s->needs_all,
                                             .layers = s->picture ? 1u << LAYER_INDIRECT : 0 },
                           &s->r);
}

void side_close(side *s)
{
    renderer_destroy(s->r);
    free(s->set);
    s->r = NULL;
    s->set = NULL;
    side_forget(s);
}

fg_status side_set(const bench *b, side *s, const char *values)
{
    const fg_status status = parse_values(b, s, values);
    return status == FG_OK ? renderer_set_plugin(s->r, s->table, s->set) : status;
}

void side_forget(side *s)
{
    s->frame.count = 0;
    s->pass_count = 0;
}

static pass_time *find_pass(side *s, const char *name)
{
    for (int i = 0; i < s->pass_count; i++)
        if (!strncmp(s->passes[i].name, name, sizeof s->passes[i].name - 1))
            return &s->passes[i];
    if (s->pass_count == MAX_PASSES)
        return NULL;
    pass_time *p = &s->passes[s->pass_count++];
    *p = (pass_time){ .ms.count = 0 };
    snprintf(p->name, sizeof p->name, "%s", name);
    return p;
}

fg_status side_frame(const bench *b, side *s, double time)
{
    fg_timing t;
    fg_status status = fg_gl_finish(b->device);
    const double start = bench_now_ms();
    if (status == FG_OK)
        status = renderer_frame(s->r, time);
    if (status == FG_OK)
        status = fg_gl_finish(b->device); // its timings are there then
    samples_add(&s->frame, bench_now_ms() - start);
    for (int i = 0; status == FG_OK && fg_graph_timing(renderer_graph(s->r), i, &t); i++) {
        pass_time *p = find_pass(s, t.pass);
        if (p && t.gpu_ms >= 0)
            samples_add(&p->ms, t.gpu_ms);
    }
    return status;
}

fg_status side_picture(side *s, image *out)
{
    return renderer_read(s->r, LAYER_INDIRECT, out);
}

void side_list_counters(const bench *b, side *s)
{
    gi_counter counters[16];
    const int count = renderer_counters(s->r, counters, FG_COUNT(counters));
    if (!b->verbose)
        return;
    fprintf(stderr, "%s: %s %s:", b->label, s->plugin, s->values);
    for (int i = 0; i < count && i < FG_COUNT(counters); i++)
        fprintf(stderr, " %s %.4g", counters[i].name, counters[i].value);
    fprintf(stderr, "\n");
}

double side_counter(side *s, const char *name)
{
    gi_counter counters[16];
    const int count = renderer_counters(s->r, counters, FG_COUNT(counters));
    for (int i = 0; i < count && i < FG_COUNT(counters); i++)
        if (!strcmp(counters[i].name, name))
            return counters[i].value;
    return (double) NAN;
}

// ---- its passes ------------------------------------------------------------------------------

bool step_is_gather(const char *step)
{
    return !strncmp(step, "gather", 6);
}

bool step_is_map(const char *step)
{
    return !strncmp(step, "face", 4);
}

bool step_is_fixed(const char *step)
{
    return !step_is_gather(step) && !step_is_map(step);
}

double side_sum(const side *s, bool (*wanted)(const char *step))
{
    const size_t length = strlen(s->plugin);
    double sum = 0;
    int found = 0;
    for (int i = 0; i < s->pass_count; i++) {
        const pass_time *p = &s->passes[i];
        if (strncmp(p->name, s->plugin, length) != 0 || p->name[length] != '.' ||
            !wanted(p->name + length + 1))
            continue;
        sum += samples_typical(&p->ms);
        found++;
    }
    return found ? sum : (double) NAN;
}

void side_list(const bench *b, const side *s)
{
    if (!b->verbose)
        return;
    fprintf(stderr, "%s: %s %s: frame %.2f ms\n", b->label, s->plugin ? s->plugin : "direct light",
            s->values ? s->values : "", samples_typical(&s->frame));
    for (int i = 0; i < s->pass_count; i++)
        fprintf(stderr, "    %-24s %9.3f ms\n", s->passes[i].name,
                samples_typical(&s->passes[i].ms));
}
