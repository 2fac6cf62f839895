// SPDX-License-Identifier: MIT
#include "view_priv.h"

#include "ui_bridge.h"

#include <math.h>
#include <string.h>

// ---- taking ----------------------------------------------------------------------------------

static double blend(double old, double now, double weight)
{
    return old + weight * (now - old);
}

static void take_pass(view_pass *p, const fg_timing *t, bool known, double weight)
{
    if (!known) {
        snprintf(p->name, sizeof p->name, "%s", t->pass);
        p->gpu_ms = -1;
        p->cpu_ms = t->cpu_ms;
    }
    p->cpu_ms = blend(p->cpu_ms, t->cpu_ms, weight);
    if (t->gpu_ms >= 0)
        p->gpu_ms = p->gpu_ms < 0 ? t->gpu_ms : blend(p->gpu_ms, t->gpu_ms, weight);
}

void view_stats_take(view *v, double cpu_ms)
{
    view_stats *s = &v->stats;
    fg_graph *g = renderer_graph(v->r);
    fg_timing t;
    int i = 0;
    // Over half a second, however many frames that are.
    const double weight = fmin(1, fmax(0.02, view_history_mean(&s->frames, 1) / 500));
    for (; i < VIEW_MAX_PASSES && fg_graph_timing(g, i, &t); ++i) {
        const bool known =
            i < s->pass_count && !strncmp(s->passes[i].name, t.pass, sizeof s->passes[i].name - 1);
        take_pass(&s->passes[i], &t, known, weight);
    }
    s->pass_count = i;
    s->cpu_ms = s->cpu_ms > 0 ? blend(s->cpu_ms, cpu_ms, weight) : cpu_ms;
    s->graph = fg_graph_get_stats(g);
    s->counter_count = renderer_counters(v->r, s->counters, VIEW_MAX_COUNTERS);
    if (s->counter_count > VIEW_MAX_COUNTERS)
        s->counter_count = VIEW_MAX_COUNTERS;
}

// ---- showing ---------------------------------------------------------------------------------

static double longest(const view_stats *s, double *gpu)
{
    double max = 1e-6;
    *gpu = 0;
    for (int i = 0; i < s->pass_count; ++i) {
        const double ms = s->passes[i].gpu_ms;
        max = ms > max ? ms : max;
        *gpu += ms > 0 ? ms : 0;
    }
    return max;
}

static void pass_row(const view_pass *p, double max)
{
    char text[96];
    ui_table_next();
    ui_text(UI_PLAIN, p->name);
    ui_tooltip(p->name);
    ui_table_next();
    snprintf(text, sizeof text, p->gpu_ms < 0 ? "-" : "%.3f ms", p->gpu_ms);
    ui_bar(p->gpu_ms > 0 ? p->gpu_ms / max : 0, 0, text);
    ui_table_next();
    snprintf(text, sizeof text, "%.4g", p->cpu_ms);
    ui_text(UI_DIM, text);
    ui_tooltip("ms of the CPU: the pass's callback and what the device does around it");
}

void view_stats_plot(const view *v)
{
    const view_stats *s = &v->stats;
    char text[96];
    const double mean = view_history_mean(&s->frames, 30);
    snprintf(text, sizeof text, "%.1f ms a frame, %.1f a second", mean, mean > 0 ? 1e3 / mean : 0);
    const ui_curve curve = {
        .values = s->frames.ms,
        .count = s->frames.count,
        .first = s->frames.count == VIEW_HISTORY ? s->frames.next : 0,
        .max = (float) (1.1 * view_history_max(&s->frames)),
        .height = 3.5f * ui_unit(),
        .text = text,
    };
    ui_plot(&curve);
}

static void times(const view *v)
{
    const view_stats *s = &v->stats;
    const float em = ui_unit();
    char text[160];
    double gpu;
    const double max = longest(s, &gpu);
    snprintf(text, sizeof text, "GPU%s %.2f ms; submitted in %.2f ms",
             fg_gl_software(v->h->device) ? " (here the CPU)" : "", gpu, s->cpu_ms);
    ui_text(UI_DIM, text);
    const float widths[] = { 14 * em, 0, 4 * em };
    if (!ui_table_begin("passes", widths, FG_COUNT(widths)))
        return;
    for (int i = 0; i < s->pass_count; ++i)
        pass_row(&s->passes[i], max);
    ui_table_end();
}

static void bytes_row(const char *name, uint64_t bytes, uint64_t max, const char *help)
{
    char text[64];
    ui_table_next();
    ui_text(UI_PLAIN, name);
    ui_tooltip(help);
    ui_table_next();
    snprintf(text, sizeof text, "%.2f MiB", (double) bytes / 1048576);
    ui_bar(max > 0 ? (double) bytes / (double) max : 0, 0, text);
    ui_tooltip(help);
}

static void memory(const view_stats *s)
{
    const fg_graph_stats *g = &s->graph;
    const float widths[] = { 13 * ui_unit(), 0 };
    uint64_t max = g->pool_bytes > g->unshared_bytes ? g->pool_bytes : g->unshared_bytes;
    if (!ui_table_begin("memory", widths, FG_COUNT(widths)))
        return;
    bytes_row("pool", g->pool_bytes, max, "all device memory that the graph holds now");
    bytes_row("transient", g->transient_bytes, max, "of transients as they are placed");
    bytes_row("unshared", g->unshared_bytes, max, "the same if none shared memory");
    bytes_row("live", g->live_bytes, max, "the most alive at once: no placement needs less");
    bytes_row("persistent", g->persistent_bytes, max, "histories and exports");
    ui_table_end();
}

static void counters(const view_stats *s)
{
    const float widths[] = { 13 * ui_unit(), 0 };
    char text[64];
    if (!ui_table_begin("counters", widths, FG_COUNT(widths)))
        return;
    for (int i = 0; i < s->counter_count; ++i) {
        ui_table_next();
        ui_text(UI_PLAIN, s->counters[i].name);
        ui_table_next();
        snprintf(text, sizeof text, "%.10g", s->counters[i].value);
        ui_text(UI_PLAIN, text);
    }
    ui_table_end();
}

static void left_out(view *v)
{
    const char *pass, *why;
    for (int i = 0; (pass = fg_graph_left_out(renderer_graph(v->r), i, &why)); ++i) {
        ui_text(UI_ACCENT, pass);
        ui_text_wrapped(UI_DIM, why, 0);
    }
}

void view_stats_panel(view *v)
{
    char title[64];
    if (ui_header("Passes: time on the GPU, ms on the CPU", true))
        times(v);
    if (ui_header("Memory", true))
        memory(&v->stats);
    if (v->stats.counter_count && ui_header("Counters", true))
        counters(&v->stats);
    snprintf(title, sizeof title, "Left out: %d of %d passes###left out", v->stats.graph.left_out,
             v->stats.graph.declared);
    if (ui_header(title, false))
        left_out(v);
}
