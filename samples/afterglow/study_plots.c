// SPDX-License-Identifier: MIT
#include "plot.h"
#include "study.h"

#include <math.h>
#include <string.h>

void study_stem(char *out, size_t size, const cJSON *item, int panel)
{
    char scene[64];
    report_file_name(scene, sizeof scene, json_text(item, "scene"));
    snprintf(out, size, "plots/%s_study_%.32s_%d", scene, json_text(item, "name"), panel);
}

static double frame_ms(const cJSON *point)
{
    return json_number(cJSON_GetObjectItem(point, "frame_ms"), "median");
}

static double error_of(const cJSON *point, int baseline, bool over_max)
{
    return 100 * study_error(cJSON_GetArrayItem(cJSON_GetObjectItem(point, "errors"), baseline),
                             over_max);
}

static bool of_curve(const cJSON *point, const char *label)
{
    return !strcmp(json_text(point, "curve"), label);
}

static bool has_curve(const cJSON *points, const char *label)
{
    const cJSON *point;
    cJSON_ArrayForEach(point, points)
    {
        if (of_curve(point, label))
            return true;
    }
    return false;
}

static void write_number(FILE *f, double value)
{
    if (isfinite(value))
        fprintf(f, " %.9g", value);
    else
        fputs(" NaN", f);
}

static const char *ylabel(const study_panel *p)
{
    if (p->of == PANEL_COUNTER)
        return p->label;
    return p->of == PANEL_MS ? "frame, median ms" : "RMSE of indirect light, %";
}

// ---- lines -----------------------------------------------------------------------------------

static void write_axis(FILE *f, const study *s, const study_panel *p)
{
    fprintf(f, "set key outside right top\nset xlabel ");
    plot_text(f, s->x_label ? s->x_label : s->x);
    if (s->x_log) { // a little room: a tic at the very end is lost to rounding
        int last = 0;
        fprintf(f, "\nset logscale x\nset xtics (");
        for (; s->values[last]; ++last)
            fprintf(f, "%s%s", last ? ", " : "", s->values[last]);
        fprintf(f, ")\nset xrange [0.93*%s:1.07*%s]", s->values[0], s->values[last - 1]);
    } else {
        fprintf(f, "\nset autoscale xfix");
    }
    fprintf(f, "\nset yrange [0:*]\nset ylabel '%s'\n", ylabel(p));
}

// x, then what is drawn: ms of the frame and after the RSM, or error over RMS and over maximum.
static void write_curve(FILE *f, const cJSON *points, const char *label, const study_panel *p,
                        int number)
{
    const cJSON *point;
    fprintf(f, "$c%d << END_OF_DATA\n", number);
    cJSON_ArrayForEach(point, points)
    {
        if (!of_curve(point, label))
            continue;
        write_number(f, json_number(point, "x"));
        if (p->of == PANEL_MS) {
            write_number(f, frame_ms(point));
            write_number(f, study_own_ms(point));
        } else {
            write_number(f, error_of(point, p->of, false));
            write_number(f, error_of(point, p->of, true));
        }
        fputc('\n', f);
    }
    fprintf(f, "NaN NaN NaN\nEND_OF_DATA\n");
}

static void write_lines(FILE *f, const study *s, const study_panel *p, const cJSON *points)
{
    int drawn = 0;
    write_axis(f, s, p);
    for (int i = 0; s->curves[i].label; ++i)
        write_curve(f, points, s->curves[i].label, p, i);
    fprintf(f, "plot ");
    for (int i = 0; s->curves[i].label; ++i) {
        if (!has_curve(points, s->curves[i].label))
            continue;
        fprintf(f, "%s$c%d using 1:2 with linespoints pt 7 ps 0.8 lw 1.5 lc rgb '%s' title ",
                drawn++ ? ", " : "", i, plot_colour(i));
        plot_text(f, s->curves[i].label);
        fprintf(f, ", $c%d using 1:3 with linespoints pt 6 ps 0.6 dt 2 lc rgb '%s' title '   %s'",
                i, plot_colour(i), p->of == PANEL_MS ? "after the RSM" : "over maximum");
    }
    fputc('\n', f);
}

// ---- bars ------------------------------------------------------------------------------------

static const cJSON *point_at(const cJSON *points, const char *label, const char *x)
{
    const cJSON *point;
    cJSON_ArrayForEach(point, points)
    {
        if (of_curve(point, label) && !strcmp(json_text(point, "x"), x))
            return point;
    }
    return NULL;
}

static void write_bars(FILE *f, const study *s, const study_panel *p, const cJSON *points)
{
    const bool ms = p->of == PANEL_MS;
    int bars = 0;
    fprintf(f, "$bars << END_OF_DATA\n");
    for (int i = 0; s->curves[i].label; ++i) {
        if (!has_curve(points, s->curves[i].label))
            continue;
        plot_text(f, s->curves[i].label);
        for (int k = 0; s->values[k]; ++k) {
            const cJSON *point = point_at(points, s->curves[i].label, s->values[k]);
            write_number(f, ms ? frame_ms(point) : error_of(point, p->of, false));
            if (!ms)
                write_number(f, error_of(point, p->of, true));
        }
        fputc('\n', f);
    }
    fprintf(f,
            "END_OF_DATA\nset style data histograms\nset style histogram clustered gap 2\n"
            "set style fill solid 0.9 noborder\nset key outside right top\n"
            "set yrange [0:*]\nset ylabel '%s'\nplot ",
            ylabel(p));
    for (int k = 0; s->values[k]; ++k)
        for (int over = 0; over < (ms ? 1 : 2); ++over, ++bars) {
            char title[96];
            snprintf(title, sizeof title, "%s=%s%s", s->x, s->values[k],
                     over ? ", over maximum" : "");
            fprintf(f, "%s$bars using %d%s lc rgb '%s' fs %s title ", bars ? ", " : "", bars + 2,
                    bars ? "" : ":xtic(1)", plot_colour(k),
                    over ? "transparent solid 0.4" : "solid 0.9");
            plot_text(f, title);
        }
    fputc('\n', f);
}

static void write_stages(FILE *f, const study *s, const cJSON *points)
{
    const cJSON *point, *stage;
    fprintf(f, "$bars << END_OF_DATA\n");
    for (int i = 0; s->curves[i].label; ++i)
        cJSON_ArrayForEach(point, points)
        {
            if (!of_curve(point, s->curves[i].label))
                continue;
            plot_text(f, s->curves[i].label);
            cJSON_ArrayForEach(stage, cJSON_GetObjectItem(point, "stages"))
            {
                write_number(f, json_number(stage, "ms"));
            }
            fputc('\n', f);
        }
    fprintf(f, "END_OF_DATA\nset style data histograms\nset style histogram rowstacked\n"
               "set boxwidth 0.6\nset style fill solid 0.9 noborder\n"
               "set key outside right top invert\nset yrange [0:*]\nset ylabel 'ms of a frame'\n"
               "plot ");
    for (int i = 0; study_stages[i]; ++i) {
        if (i && !study_has_stage(points, study_stages[i]))
            continue;
        fprintf(f, "%s$bars using %d%s lc rgb '%s' title ", i ? ", " : "", i + 2,
                i ? "" : ":xtic(1)", i ? plot_colour(i - 1) : "#cccccc");
        plot_text(f, study_stages[i]);
    }
    fputc('\n', f);
}

// ---- along the animation ---------------------------------------------------------------------

// A figure a frame, null where there is none.
static const cJSON *trace_of(const cJSON *point, const study_panel *p)
{
    const cJSON *path = cJSON_GetObjectItem(point, "path");
    if (p->of == PANEL_MS)
        return cJSON_GetObjectItem(path, "ms");
    if (p->of == PANEL_COUNTER)
        return cJSON_GetObjectItem(cJSON_GetObjectItem(path, "counters"), p->counter);
    return cJSON_GetArrayItem(cJSON_GetObjectItem(path, "errors"), p->of);
}

static void write_trace(FILE *f, const cJSON *point, const study_panel *p)
{
    const double unit = p->of >= 0 ? 100 : 1;
    const cJSON *path = cJSON_GetObjectItem(point, "path"), *value;
    const cJSON *second = cJSON_GetArrayItem(cJSON_GetObjectItem(path, "seconds"), 0);
    cJSON_ArrayForEach(value, trace_of(point, p))
    {
        if (second && cJSON_IsNumber(value)) {
            write_number(f, second->valuedouble);
            write_number(f, unit * value->valuedouble);
            fputc('\n', f);
        }
        second = second ? second->next : NULL;
    }
}

static void write_walk(FILE *f, const cJSON *points, const char *label, const study_panel *p,
                       int number)
{
    const cJSON *point;
    fprintf(f, "$c%d << END_OF_DATA\n", number);
    cJSON_ArrayForEach(point, points)
    {
        if (of_curve(point, label))
            write_trace(f, point, p);
    }
    fprintf(f, "NaN NaN\nEND_OF_DATA\n");
}

static void write_path(FILE *f, const study *s, const study_panel *p, const cJSON *points)
{
    int drawn = 0;
    fprintf(f,
            "set key outside right top\nset xlabel 'time of the animation, s'\n"
            "set autoscale xfix\nset ylabel '%s'\nset yrange [0:*]\n",
            ylabel(p));
    for (int i = 0; s->curves[i].label; ++i)
        write_walk(f, points, s->curves[i].label, p, i);
    fprintf(f, "plot ");
    for (int i = 0; s->curves[i].label; ++i) {
        if (!has_curve(points, s->curves[i].label))
            continue;
        fprintf(f, "%s$c%d using 1:2 with %s lw 1.8 lc rgb '%s' title ", drawn++ ? ", " : "", i,
                p->of >= 0 ? "linespoints pt 7 ps 0.5" : "lines", plot_colour(i));
        plot_text(f, s->curves[i].label);
    }
    fputc('\n', f);
}

// ---- files -----------------------------------------------------------------------------------

static bool has_number(const cJSON *list)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, list)
    {
        if (cJSON_IsNumber(item))
            return true;
    }
    return false;
}

// Whether any point has what the panel shows: gnuplot refuses to draw nothing.
static bool drawable(const study_panel *p, const cJSON *points)
{
    const cJSON *point;
    cJSON_ArrayForEach(point, points)
    {
        if (p->kind == PANEL_PATH ? has_number(trace_of(point, p))
            : p->of == PANEL_MS   ? frame_ms(point) > 0
                                  : isfinite(error_of(point, p->of, false)))
            return true;
    }
    return false;
}

static fg_status draw(const fg_log *log, const char *folder, cJSON *doc, const cJSON *item,
                      int panel)
{
    const study *s = study_find(json_text(item, "name"));
    const study_panel *p = &s->panels[panel];
    const cJSON *points = cJSON_GetObjectItem(item, "points");
    char stem[160];
    plot out;
    study_stem(stem, sizeof stem, item, panel);
    plot_remove(folder, stem);
    if (!drawable(p, points))
        return FG_OK;
    const fg_status status = plot_begin(log, folder, stem, 400, &out);
    if (status != FG_OK)
        return status;
    switch (p->kind) {
    case PANEL_LINES: write_lines(out.out.stream, s, p, points); break;
    case PANEL_BARS: write_bars(out.out.stream, s, p, points); break;
    case PANEL_STAGES: write_stages(out.out.stream, s, points); break;
    case PANEL_PATH: write_path(out.out.stream, s, p, points); break;
    case PANEL_NONE: break;
    }
    return plot_end(log, &out, true, doc);
}

fg_status study_plots(const fg_log *log, const char *folder, cJSON *doc)
{
    const cJSON *item;
    fg_status status = FG_OK;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(doc, "studies"))
    {
        const study *s = study_find(json_text(item, "name"));
        for (int i = 0; s && s->panels[i].kind && status == FG_OK; ++i)
            status = draw(log, folder, doc, item, i);
    }
    return status;
}
