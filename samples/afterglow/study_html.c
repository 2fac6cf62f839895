// SPDX-License-Identifier: MIT
#include "html.h"
#include "study.h"

#include <math.h>
#include <string.h>

// ---- tables ----------------------------------------------------------------------------------

static bool shows_stage(const study *s, const cJSON *points, const char *stage)
{
    return s->panels[0].kind == PANEL_STAGES && study_has_stage(points, stage);
}

static void write_head(FILE *f, const study *s, const cJSON *points)
{
    fputs("<div class=\"scroll\"><table><thead><tr><th class=\"text\">curve</th>", f);
    if (s->x) {
        fputs("<th>", f);
        html_text(f, s->x);
        fputs("</th>", f);
    }
    for (int i = 0; study_stages[i]; ++i)
        if (shows_stage(s, points, study_stages[i]))
            fprintf(f, "<th>%s</th>", study_stages[i]);
    fputs("<th>frame</th><th>after the RSM</th>", f);
    for (int i = 0; s->baselines[i]; ++i) {
        fputs("<th>RMSE/RMS %</th><th>RMSE/max %</th><th>energy ratio</th>", f);
    }
    fputs("<th>VPLs a texel</th><th>lit %</th></tr></thead><tbody>\n", f);
}

static void write_x(FILE *f, const cJSON *point)
{
    const double number = json_number(point, "x");
    if (isfinite(number))
        html_number(f, number, "%g");
    else
        html_cell(f, json_text(point, "x"));
}

static void write_row(FILE *f, const study *s, const cJSON *points, const cJSON *point)
{
    const cJSON *errors = cJSON_GetObjectItem(point, "errors");
    const cJSON *counters = cJSON_GetObjectItem(point, "counters");
    const cJSON *size = cJSON_GetObjectItem(point, "size");
    const double pixels = cJSON_GetNumberValue(cJSON_GetArrayItem(size, 0)) *
                          cJSON_GetNumberValue(cJSON_GetArrayItem(size, 1));
    fputs("<tr>", f);
    html_cell(f, json_text(point, "curve"));
    if (s->x)
        write_x(f, point);
    for (int i = 0; study_stages[i]; ++i)
        if (shows_stage(s, points, study_stages[i]))
            html_number(f, study_stage_ms(point, study_stages[i]), "%.2f");
    html_number(f, json_number(cJSON_GetObjectItem(point, "frame_ms"), "median"), "%.2f");
    html_number(f, study_own_ms(point), "%.2f");
    for (int i = 0; s->baselines[i]; ++i) {
        const cJSON *error = cJSON_GetArrayItem(errors, i);
        html_number(f, 100 * study_error(error, false), "%.2f");
        html_number(f, 100 * study_error(error, true), "%.2f");
        html_number(f, json_number(error, "energy_ratio"), "%.3f");
    }
    const double nodes = json_number(counters, "nodes_per_sample"); // of a tree: a cut each
    html_number(f, isfinite(nodes) ? nodes : json_number(counters, "vpls"), "%.0f");
    html_number(f, 100 * json_number(counters, "samples") / pixels, "%.2f");
    fputs("</tr>\n", f);
}

static void write_table(FILE *f, const study *s, const cJSON *item)
{
    const cJSON *points = cJSON_GetObjectItem(item, "points"), *point;
    const bool open = s->panels[0].kind == PANEL_STAGES;
    fprintf(f, "<details%s><summary>Figures, times in ms</summary>\n", open ? " open" : "");
    write_head(f, s, points);
    cJSON_ArrayForEach(point, points)
    {
        write_row(f, s, points, point);
    }
    fputs("</tbody></table></div>\n", f);
    if (s->baselines[0]) {
        fputs("<p class=\"quiet\">Errors of the indirect light, in turn against ", f);
        for (int i = 0; s->baselines[i]; ++i) {
            fputs(i ? ", <code>" : "<code>", f);
            html_text(f, s->baselines[i]);
            fputs("</code>", f);
        }
        fputs(". Over RMS against a path-traced truth: its noise is taken out.</p>\n", f);
    }
    fputs("</details>\n", f);
}

// ---- the section -----------------------------------------------------------------------------

static fg_status write_study(FILE *f, const fg_log *log, const char *folder, const cJSON *item,
                             const char *prefix)
{
    const study *s = study_find(json_text(item, "name"));
    fg_status status = FG_OK;
    fputs("<h4>", f);
    html_text(f, s->title);
    fputs("</h4>\n", f);
    for (int i = 0; s->panels[i].kind && status == FG_OK; ++i) {
        char stem[160], path[4096], ids[96];
        study_stem(stem, sizeof stem, item, i);
        snprintf(path, sizeof path, "%s/%s.svg", folder, stem);
        snprintf(ids, sizeof ids, "%s%s%d-", prefix, s->name, i);
        fputs("<figure><div class=\"plot\">", f);
        status = html_svg(f, log, path, ids);
        fputs("</div><figcaption>", f);
        html_text(f, s->panels[i].caption);
        fputs("</figcaption></figure>\n", f);
    }
    write_table(f, s, item);
    return status;
}

fg_status study_html(FILE *f, const fg_log *log, const char *folder, const cJSON *doc,
                     const char *scene, const char *prefix)
{
    const cJSON *item;
    int count = 0;
    fg_status status = FG_OK;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(doc, "studies"))
    {
        const bool mine = !strcmp(json_text(item, "scene"), scene);
        if (status != FG_OK || !mine || !study_find(json_text(item, "name")))
            continue;
        if (!count++)
            fputs("<h3>Studies</h3>\n<p class=\"quiet\">Tables and figures of the papers, drawn "
                  "again on this scene and device. RMSE is over the RMS of what is compared with; "
                  "dashed or pale over its maximum, since the papers do not say which. Times are "
                  "of the "
                  "frame, dashed of the technique's own passes after the reflective shadow "
                  "maps.</p>\n",
                  f);
        status = write_study(f, log, folder, item, prefix);
    }
    return status;
}
