// SPDX-License-Identifier: MIT
#include "report.h"

#include "plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static double frame_median(const cJSON *record)
{
    return json_number(cJSON_GetObjectItem(record, "frame_ms"), "median");
}

static bool of_scene(const cJSON *record, const char *scene)
{
    return !strcmp(json_text(record, "scene"), scene);
}

static bool listed(const char *const *names, int count, const char *name)
{
    for (int i = 0; i < count; ++i)
        if (!strcmp(names[i], name))
            return true;
    return false;
}

// Plugins of the scene in the order of records.
enum { MAX_PLUGINS = 64 };
static int list_plugins(const cJSON *doc, const char *scene, const char *names[MAX_PLUGINS])
{
    const cJSON *record;
    int count = 0;
    cJSON_ArrayForEach(record, cJSON_GetObjectItem(doc, "records"))
    {
        const char *name = json_text(record, "plugin");
        if (of_scene(record, scene) && count < MAX_PLUGINS && !listed(names, count, name))
            names[count++] = name;
    }
    return count;
}

typedef struct point {
    double ms, error;
    const char *label;
} point;

static int compare_points(const void *a, const void *b)
{
    const double x = ((const point *) a)->ms, y = ((const point *) b)->ms;
    return (x > y) - (x < y);
}

// Points of a plugin, or of the Pareto front where `plugin` is NULL, fastest first. free() them.
static point *collect(const cJSON *doc, const char *scene, const char *plugin, int truth,
                      int *count)
{
    const cJSON *records = cJSON_GetObjectItem(doc, "records"), *record;
    point *points = calloc((size_t) cJSON_GetArraySize(records) + 1, sizeof *points);
    *count = 0;
    cJSON_ArrayForEach(record, records)
    {
        const point p = { frame_median(record), report_error_of(record, truth),
                          json_text(record, "label") };
        const bool wanted = plugin ? !strcmp(json_text(record, "plugin"), plugin)
                                   : report_on_front(doc, record, truth);
        if (points && of_scene(record, scene) && wanted && p.ms > 0 && p.error > 0)
            points[(*count)++] = p;
    }
    if (points)
        qsort(points, (size_t) *count, sizeof *points, compare_points);
    return points;
}

static fg_status write_block(FILE *f, const char *name, const cJSON *doc, const char *scene,
                             const char *plugin, int truth)
{
    int count;
    point *points = collect(doc, scene, plugin, truth, &count);
    if (!points)
        return FG_ERR_MEMORY;
    fprintf(f, "$%s << END_OF_DATA\n", name);
    for (int i = 0; i < count; ++i) {
        fprintf(f, "%.9g %.9g ", points[i].ms, points[i].error);
        plot_text(f, points[i].label);
        fputc('\n', f);
    }
    if (!count)
        fprintf(f, "NaN NaN \"\"\n");
    fprintf(f, "END_OF_DATA\n");
    free(points);
    return FG_OK;
}

static void write_ranges(FILE *f, const cJSON *doc, const char *scene, int truth, double noise)
{
    const cJSON *record;
    double low[2] = { (double) INFINITY, (double) INFINITY }, high[2] = { 0, 0 };
    cJSON_ArrayForEach(record, cJSON_GetObjectItem(doc, "records"))
    {
        const double v[2] = { frame_median(record), report_error_of(record, truth) };
        if (!of_scene(record, scene) || !(v[0] > 0) || !(v[1] > 0))
            continue;
        for (int i = 0; i < 2; ++i) {
            low[i] = fmin(low[i], v[i]);
            high[i] = fmax(high[i], v[i]);
        }
    }
    if (noise > 0)
        low[1] = fmin(low[1], noise);
    for (int i = 0; i < 2; ++i)
        if (high[i] > 0)
            fprintf(f, "set %crange [%.6g:%.6g]\n", "xy"[i], low[i] / 1.5, high[i] * 1.5);
}

static double noise_of(const cJSON *scene, int truth)
{
    const cJSON *entry = cJSON_GetArrayItem(cJSON_GetObjectItem(scene, "references"), truth);
    return json_number(entry, "noise") / json_number(entry, "rms");
}

static fg_status write_front(FILE *f, const cJSON *doc, const cJSON *scene, int truth)
{
    const char *name = json_text(scene, "name"), *plugins[MAX_PLUGINS];
    const int count = list_plugins(doc, name, plugins);
    const double noise = noise_of(scene, truth);
    fg_status status = FG_OK;
    fprintf(f, "set logscale xy\nset key outside right top\nset xlabel 'frame, median ms'\n"
               "set ylabel 'relative RMSE of indirect light'\n");
    write_ranges(f, doc, name, truth, noise);
    for (int i = 0; i < count && status == FG_OK; ++i) {
        char block[16];
        snprintf(block, sizeof block, "p%d", i);
        status = write_block(f, block, doc, name, plugins[i], truth);
    }
    if (status == FG_OK)
        status = write_block(f, "front", doc, name, NULL, truth);
    fprintf(f, "plot $front using 1:2 with steps lc rgb '#999999' lw 5 title 'Pareto front'");
    for (int i = 0; i < count; ++i) {
        fprintf(f, ", $p%d using 1:2 with linespoints pt 7 ps 0.8 lw 1.5 lc rgb '%s' title ", i,
                plot_colour(i));
        plot_text(f, plugins[i]);
    }
    if (noise > 0)
        fprintf(f, ", %.6g with lines dt 2 lc rgb '#555555' title 'noise of the truth'", noise);
    fprintf(f, ", $front using 1:2:3 with labels left offset 0.7,0.7 font ',10' notitle\n");
    return status;
}

// ---- bars: passes of every record ------------------------------------------------------------

enum { MAX_STACK = 14 };
typedef struct stack {
    const char *name;
    double total;
} stack;

static int compare_stacks(const void *a, const void *b)
{
    const double x = ((const stack *) a)->total, y = ((const stack *) b)->total;
    return (x < y) - (x > y);
}

// The passes that take most, most first.
static int list_passes(const cJSON *doc, const char *scene, stack *out, int max)
{
    const cJSON *record, *pass;
    int count = 0;
    cJSON_ArrayForEach(record, cJSON_GetObjectItem(doc, "records"))
    {
        if (!of_scene(record, scene))
            continue;
        cJSON_ArrayForEach(pass, cJSON_GetObjectItem(record, "passes"))
        {
            const char *name = json_text(pass, "name");
            const double ms = report_pass_ms(pass);
            int i = 0;
            while (i < count && strcmp(out[i].name, name) != 0)
                ++i;
            if (i == count && count < max)
                out[count++] = (stack){ name, 0 };
            if (i < count && ms > 0)
                out[i].total += ms;
        }
    }
    qsort(out, (size_t) count, sizeof *out, compare_stacks);
    return count < MAX_STACK ? count : MAX_STACK;
}

static double pass_ms(const cJSON *record, const char *name)
{
    const cJSON *pass;
    cJSON_ArrayForEach(pass, cJSON_GetObjectItem(record, "passes"))
    {
        if (!strcmp(json_text(pass, "name"), name)) {
            const double ms = report_pass_ms(pass);
            return ms > 0 ? ms : 0;
        }
    }
    return 0;
}

static void write_bar(FILE *f, const cJSON *record, const stack *passes, int count)
{
    char label[160];
    double rest = frame_median(record);
    snprintf(label, sizeof label, "%s %s", json_text(record, "plugin"), json_text(record, "label"));
    plot_text(f, label);
    for (int i = 0; i < count; ++i) {
        const double ms = pass_ms(record, passes[i].name);
        fprintf(f, " %.9g", ms);
        rest -= ms;
    }
    fprintf(f, " %.9g\n", rest > 0 ? rest : 0);
}

static fg_status write_bars(FILE *f, const cJSON *doc, const cJSON *scene)
{
    stack passes[TIMING_MAX_PASSES];
    const char *name = json_text(scene, "name");
    const int count = list_passes(doc, name, passes, TIMING_MAX_PASSES);
    const cJSON *record;
    fprintf(f, "$bars << END_OF_DATA\n");
    cJSON_ArrayForEach(record, cJSON_GetObjectItem(doc, "records"))
    {
        if (of_scene(record, name))
            write_bar(f, record, passes, count);
    }
    fprintf(
        f,
        "END_OF_DATA\nset style data histograms\nset style histogram rowstacked\n"
        "set boxwidth 0.75\nset style fill solid 0.9 noborder\nset key outside right top invert\n"
        "set ylabel 'ms of a frame'\nset yrange [0:*]\nset xtics rotate by -40 font ',10'\n"
        "set rmargin 24\nplot ");
    for (int i = 0; i < count; ++i) {
        fprintf(f, "$bars using %d%s lc rgb '%s' title ", i + 2, i ? "" : ":xtic(1)",
                plot_colour(i));
        plot_text(f, passes[i].name);
        fprintf(f, ", ");
    }
    fprintf(f, "$bars using %d%s lc rgb '#cccccc' title 'outside passes'\n", count + 2,
            count ? "" : ":xtic(1)");
    return FG_OK;
}

// ---- files -----------------------------------------------------------------------------------

// Whether any record of the scene has a time and an error that logarithmic axes can show.
static bool plottable(const cJSON *doc, const char *scene, int truth)
{
    const cJSON *record;
    cJSON_ArrayForEach(record, cJSON_GetObjectItem(doc, "records"))
    {
        if (of_scene(record, scene) && frame_median(record) > 0 &&
            report_error_of(record, truth) > 0)
            return true;
    }
    return false;
}

// The front against `truth`; -1: bars.
static fg_status draw(const fg_log *log, const char *folder, cJSON *doc, const cJSON *scene,
                      int truth)
{
    char name[64], stem[128];
    plot p = { 0 };
    const char *what = truth < 0 ? "passes" : truth_names[truth];
    report_file_name(name, sizeof name, json_text(scene, "name"));
    snprintf(stem, sizeof stem, "plots/%s_%s", name, what);
    plot_remove(folder, stem);
    if (truth >= 0 && !plottable(doc, json_text(scene, "name"), truth)) {
        report_note(doc, "%.200s: no relative error against %s to plot", json_text(scene, "name"),
                    what);
        return FG_OK;
    }
    fg_status status = plot_begin(log, folder, stem, truth < 0 ? 560 : 480, &p);
    if (status != FG_OK)
        return status;
    status = truth < 0 ? write_bars(p.out.stream, doc, scene)
                       : write_front(p.out.stream, doc, scene, truth);
    const fg_status written = plot_end(log, &p, status == FG_OK, doc);
    return status != FG_OK ? status : written;
}

static void draw_graphs(const char *folder, cJSON *doc, cJSON *scene)
{
    cJSON *graph;
    cJSON_ArrayForEach(graph, cJSON_GetObjectItem(scene, "graphs"))
    {
        char dot[4096], svg[4096 + 8];
        snprintf(dot, sizeof dot, "%s/%s", folder, json_text(graph, "dot"));
        snprintf(svg, sizeof svg, "%s.svg", dot);
        unlink(svg);
        const char *const argv[] = { "dot", "-Tsvg", dot, "-o", svg, NULL };
        if (!plot_program(argv, "no pictures of graphs", doc))
            unlink(svg);
    }
}

// Not so where studies alone were run.
static bool has_records(const cJSON *doc, const char *scene)
{
    const cJSON *record;
    cJSON_ArrayForEach(record, cJSON_GetObjectItem(doc, "records"))
    {
        if (of_scene(record, scene))
            return true;
    }
    return false;
}

fg_status report_plots(const fg_log *log, const char *folder, cJSON *doc)
{
    cJSON *scene;
    fg_status status = FG_OK;
    cJSON_ArrayForEach(scene, cJSON_GetObjectItem(doc, "scenes"))
    {
        const bool swept = has_records(doc, json_text(scene, "name"));
        for (int truth = -1; swept && truth < REPORT_TRUTHS && status == FG_OK; ++truth)
            status = draw(log, folder, doc, scene, truth);
        draw_graphs(folder, doc, scene);
    }
    return status;
}
