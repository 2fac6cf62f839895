// SPDX-License-Identifier: MIT
#include "report.h"

#include "file.h"
#include "html.h"
#include "report_css.h"
#include "report_js.h"
#include "study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct page {
    FILE *f;
    const fg_log *log;
    const char *folder;
    const cJSON *doc, *scene;
    const char *scene_name;
    int scene_number;
} page;

// ---- tables ----------------------------------------------------------------------------------

static void write_truths(const page *p)
{
    const cJSON *entry;
    fputs("<div class=\"scroll\"><table><thead><tr><th class=\"text\">truth</th><th>samples a "
          "pixel</th>"
          "<th>mean</th><th>RMS</th><th>its own noise over RMS</th></tr></thead><tbody>\n",
          p->f);
    cJSON_ArrayForEach(entry, cJSON_GetObjectItem(p->scene, "references"))
    {
        fputs("<tr>", p->f);
        html_cell(p->f, json_text(entry, "name"));
        html_number(p->f, json_number(entry, "spp"), "%.0f");
        html_number(p->f, json_number(entry, "mean"), "%.4g");
        html_number(p->f, json_number(entry, "rms"), "%.4g");
        html_number(p->f, json_number(entry, "noise") / json_number(entry, "rms"), "%.4f");
        fputs("</tr>\n", p->f);
    }
    fputs("</tbody></table></div>\n", p->f);
}

static void write_row(const page *p, const cJSON *record)
{
    const cJSON *frame = cJSON_GetObjectItem(record, "frame_ms");
    const cJSON *memory = cJSON_GetObjectItem(record, "memory"), *error;
    const double mebi = 1024.0 * 1024.0;
    fprintf(p->f, "<tr%s>", report_on_front(p->doc, record, 0) ? " class=\"front\"" : "");
    html_cell(p->f, json_text(record, "plugin"));
    html_cell(p->f, json_text(record, "label"));
    html_number(p->f, json_number(frame, "median"), "%.2f");
    html_number(p->f, json_number(frame, "p99"), "%.2f");
    html_number(p->f, json_number(frame, "min"), "%.2f");
    cJSON_ArrayForEach(error, cJSON_GetObjectItem(record, "errors"))
    {
        html_number(p->f, json_number(error, "rmse_rms_corrected"), "%.4f");
        html_number(p->f, json_number(error, "energy_ratio"), "%.3f");
    }
    error = cJSON_GetObjectItem(record, "error");
    html_number(p->f, json_number(error, "relmse"), "%.4g");
    html_number(p->f, json_number(error, "smape"), "%.4f");
    html_number(p->f, json_number(error, "nonfinite"), "%.0f");
    html_number(p->f, json_number(memory, "transient_bytes") / mebi, "%.1f");
    html_number(p->f, json_number(memory, "unshared_bytes") / mebi, "%.1f");
    fputs("</tr>\n", p->f);
}

static bool of_scene(const page *p, const cJSON *record)
{
    return !strcmp(json_text(record, "scene"), p->scene_name);
}

static void write_table(const page *p)
{
    const cJSON *record;
    fputs("<h3>All settings</h3>\n<div class=\"scroll\"><table><thead><tr><th "
          "class=\"text\">plugin</th>"
          "<th class=\"text\">setting</th><th>ms median</th><th>p99</th><th>min</th>",
          p->f);
    for (int i = 0; i < REPORT_TRUTHS; ++i)
        fprintf(p->f, "<th>relative RMSE, %s</th><th>energy ratio</th>", truth_names[i]);
    fputs("<th>relMSE</th><th>SMAPE</th><th>not finite</th><th>MiB shared</th><th>MiB unshared</th>"
          "</tr></thead><tbody>\n",
          p->f);
    cJSON_ArrayForEach(record, cJSON_GetObjectItem(p->doc, "records"))
    {
        if (of_scene(p, record))
            write_row(p, record);
    }
    fprintf(p->f,
            "</tbody></table></div>\n<p class=\"quiet\">Marked: on the Pareto front against %s. "
            "relMSE and SMAPE are against it too. The noise of the truth is taken out of relative "
            "RMSE: the square root of MSE less the truth's own variance. Click a heading to "
            "sort.</p>\n",
            truth_names[0]);
}

// ---- plots and pictures ----------------------------------------------------------------------

static fg_status write_plot(const page *p, const char *what, const char *caption)
{
    char stem[64], path[4096], prefix[96];
    report_file_name(stem, sizeof stem, p->scene_name);
    snprintf(path, sizeof path, "%s/plots/%s_%s.svg", p->folder, stem, what);
    snprintf(prefix, sizeof prefix, "s%d-%s-", p->scene_number, what);
    fputs("<figure><div class=\"plot\">", p->f);
    const fg_status status = html_svg(p->f, p->log, path, prefix);
    fprintf(p->f, "</div><figcaption>%s</figcaption></figure>\n", caption);
    return status;
}

static fg_status write_plots(const page *p)
{
    fg_status status = write_plot(p, truth_names[0],
                                  "Error against run time; the truth is one indirect bounce with "
                                  "shadows. Down and left is better.");
    if (status == FG_OK)
        status =
            write_plot(p, truth_names[1],
                       "The same against one bounce in which nothing hides anything: what is left "
                       "is the error of sampling, not of leaving indirect visibility out.");
    if (status == FG_OK)
        status =
            write_plot(p, "passes",
                       "Where a frame's time goes: each pass by its GPU timer, or by the time in "
                       "its callback where that is longer (a software device runs compute there).");
    return status;
}

static fg_status write_image(const page *p, const char *name, const char *alt)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", p->folder, name);
    fputs("<img alt=\"", p->f);
    html_text(p->f, alt);
    fputs("\" src=\"", p->f);
    const fg_status status = html_data(p->f, p->log, path, "image/png");
    fputs("\">", p->f);
    return status;
}

// The truth's picture stands once in the page, as a background that every slider shows.
static fg_status write_truth_style(const page *p)
{
    char path[4096];
    const cJSON *truth = cJSON_GetArrayItem(cJSON_GetObjectItem(p->scene, "references"), 0);
    snprintf(path, sizeof path, "%s/%s", p->folder, json_text(truth, "image"));
    fprintf(p->f, "<style>.ref%d{background-image:url(", p->scene_number);
    const fg_status status = html_data(p->f, p->log, path, "image/png");
    fputs(")}</style>\n", p->f);
    return status;
}

static fg_status write_card(const page *p, const cJSON *record)
{
    const cJSON *images = cJSON_GetObjectItem(record, "images"), *map;
    const cJSON *errors = cJSON_GetObjectItem(record, "errors");
    int i = 0;
    fputs("<figure class=\"card\"><figcaption><b>", p->f);
    html_text(p->f, json_text(record, "plugin"));
    fputs("</b> ", p->f);
    html_text(p->f, json_text(record, "label"));
    fprintf(p->f,
            " &middot; %.2f ms &middot; relative RMSE %.4f</figcaption>\n<div class=\"views\">"
            "<div class=\"view\"><div class=\"wipe\">",
            json_number(cJSON_GetObjectItem(record, "frame_ms"), "median"),
            report_error_of(record, 0));
    fg_status status = write_image(p, json_text(images, "result"), "result");
    fprintf(
        p->f,
        "<div class=\"ref ref%d\"></div></div><input type=\"range\" min=\"0\" max=\"100\" "
        "value=\"50\" aria-label=\"result or truth\"><span>left: result, right: %s</span></div>\n",
        p->scene_number, truth_names[0]);
    cJSON_ArrayForEach(map, cJSON_GetObjectItem(images, "error"))
    {
        const cJSON *error = cJSON_GetArrayItem(errors, i++);
        fputs("<div class=\"view\">", p->f);
        if (status == FG_OK)
            status =
                write_image(p, cJSON_IsString(map) ? map->valuestring : "", "signed error map");
        fprintf(p->f,
                "<span>error against %s: relative RMSE %.4f, energy ratio %.3f</span></div>\n",
                json_text(error, "reference"), json_number(error, "rmse_rms_corrected"),
                json_number(error, "energy_ratio"));
    }
    fputs("</div></figure>\n", p->f);
    return status;
}

static int count_of_scene(const page *p)
{
    const cJSON *record;
    int count = 0;
    cJSON_ArrayForEach(record, cJSON_GetObjectItem(p->doc, "records"))
    {
        count += of_scene(p, record);
    }
    return count;
}

static bool is_base(const cJSON *record)
{
    return !strcmp(json_text(record, "label"), "default");
}

static fg_status write_cards(const page *p)
{
    enum { ALL = 24 };
    const cJSON *record;
    const int count = count_of_scene(p);
    int shown = 0;
    fg_status status = write_truth_style(p);
    fprintf(p->f,
            "<h3>Pictures</h3>\n<p class=\"quiet\">Indirect light alone, the same exposure "
            "throughout. Error maps: red is too bright, blue too dark, full colour at half the "
            "truth's RMS.</p>\n<div class=\"cards\">\n");
    cJSON_ArrayForEach(record, cJSON_GetObjectItem(p->doc, "records"))
    {
        const bool wanted = count <= ALL || is_base(record) || report_on_front(p->doc, record, 0);
        if (status != FG_OK || !of_scene(p, record) || !wanted)
            continue;
        status = write_card(p, record);
        ++shown;
    }
    fputs("</div>\n", p->f);
    if (shown < count)
        fprintf(
            p->f,
            "<p class=\"quiet\">Shown are %d of %d settings: the defaults and the Pareto front. "
            "All pictures are in the folder images.</p>\n",
            shown, count);
    return status;
}

// ---- graphs ----------------------------------------------------------------------------------

static void write_left_out(const page *p, const char *plugin)
{
    const cJSON *record, *entry;
    cJSON_ArrayForEach(record, cJSON_GetObjectItem(p->doc, "records"))
    {
        const cJSON *list = cJSON_GetObjectItem(record, "left_out");
        if (!of_scene(p, record) || strcmp(json_text(record, "plugin"), plugin) != 0 ||
            !cJSON_GetArraySize(list))
            continue;
        fputs("<p>Left out:</p><ul>", p->f);
        cJSON_ArrayForEach(entry, list)
        {
            fputs("<li><code>", p->f);
            html_text(p->f, json_text(entry, "pass"));
            fputs("</code>: ", p->f);
            html_text(p->f, json_text(entry, "why"));
            fputs("</li>", p->f);
        }
        fputs("</ul>\n", p->f);
        return;
    }
}

static fg_status write_graphs(const page *p)
{
    const cJSON *graph;
    int n = 0;
    fg_status status = FG_OK;
    fputs("<h3>Graphs</h3>\n", p->f);
    cJSON_ArrayForEach(graph, cJSON_GetObjectItem(p->scene, "graphs"))
    {
        char path[4096], prefix[64];
        const char *plugin = json_text(graph, "plugin");
        snprintf(path, sizeof path, "%s/%s.svg", p->folder, json_text(graph, "dot"));
        snprintf(prefix, sizeof prefix, "s%d-g%d-", p->scene_number, n++);
        fprintf(p->f, "<details%s><summary>", n == 1 ? "" : " open");
        html_text(p->f, strcmp(plugin, "none") != 0 ? plugin : "direct light alone");
        fputs("</summary><div class=\"plot graph\">", p->f);
        if (status == FG_OK)
            status = html_svg(p->f, p->log, path, prefix);
        fputs("</div>\n", p->f);
        write_left_out(p, plugin);
        fputs("</details>\n", p->f);
    }
    return status;
}

// ---- the page --------------------------------------------------------------------------------

static void write_head(const page *p)
{
    const cJSON *device = cJSON_GetObjectItem(p->doc, "device"), *note;
    const cJSON *size = cJSON_GetObjectItem(p->doc, "size");
    fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<link rel=\"icon\" href=\"data:,\">\n"
          "<title>Afterglow: error against run time</title>\n<style>\n",
          p->f);
    fputs((const char *) report_css, p->f);
    fputs("</style></head><body>\n<h1>Error against run time</h1>\n<p class=\"quiet\">", p->f);
    html_text(p->f, json_text(device, "renderer"));
    fputs(", OpenGL ", p->f);
    html_text(p->f, json_text(device, "version"));
    fprintf(p->f, " &middot; %.0f &times; %.0f &middot; budget %s &middot; Afterglow %s</p>\n",
            cJSON_GetNumberValue(cJSON_GetArrayItem(size, 0)),
            cJSON_GetNumberValue(cJSON_GetArrayItem(size, 1)), json_text(p->doc, "budget"),
            json_text(p->doc, "afterglow"));
    fputs("<p>Every plugin over its quality parameters, against path-traced truths that no plugin "
          "helped "
          "to make. Errors are of the indirect light alone, linear, over the truth's RMS; run "
          "times are "
          "of whole frames, settings measured in turns, each frame waited for.</p>\n",
          p->f);
    cJSON_ArrayForEach(note, cJSON_GetObjectItem(p->doc, "notes"))
    {
        fputs("<p class=\"note\">", p->f);
        html_text(p->f, cJSON_IsString(note) ? note->valuestring : "");
        fputs("</p>\n", p->f);
    }
}

static void write_scene_head(const page *p)
{
    const cJSON *entry;
    fputs("<h2>", p->f);
    html_text(p->f, p->scene_name);
    fprintf(p->f, "</h2>\n<p class=\"quiet\">%.0f triangles</p>\n",
            json_number(p->scene, "triangles"));
    cJSON_ArrayForEach(entry, cJSON_GetObjectItem(p->scene, "not_served"))
    {
        fputs("<p class=\"quiet\">", p->f);
        html_text(p->f, json_text(entry, "plugin"));
        fputs(" is not measured: the scene has no ", p->f);
        html_text(p->f, json_text(entry, "lacks"));
        fputs(".</p>\n", p->f);
    }
}

// The sweep of quality parameters.
static fg_status write_settings(const page *p)
{
    fg_status status = write_plots(p);
    write_table(p);
    if (status == FG_OK)
        status = write_cards(p);
    return status == FG_OK ? write_graphs(p) : status;
}

static fg_status write_scene(page *p, const cJSON *scene, int number)
{
    char prefix[32];
    p->scene = scene;
    p->scene_name = json_text(scene, "name");
    p->scene_number = number;
    write_scene_head(p);
    if (cJSON_GetArraySize(cJSON_GetObjectItem(scene, "references")))
        write_truths(p);
    snprintf(prefix, sizeof prefix, "s%d-", number);
    fg_status status = count_of_scene(p) ? write_settings(p) : FG_OK;
    if (status != FG_OK)
        return status;
    return study_html(p->f, p->log, p->folder, p->doc, p->scene_name, prefix);
}

fg_status report_html(const fg_log *log, const char *folder, const cJSON *doc)
{
    char path[4096];
    file out;
    const cJSON *scene;
    int number = 0;
    snprintf(path, sizeof path, "%s/report.html", folder);
    fg_status status = file_begin(log, path, &out);
    if (status != FG_OK)
        return status;
    page p = { .f = out.stream, .log = log, .folder = folder, .doc = doc };
    write_head(&p);
    cJSON_ArrayForEach(scene, cJSON_GetObjectItem(doc, "scenes"))
    {
        if (status == FG_OK)
            status = write_scene(&p, scene, number++);
    }
    study_tables_html(p.f, doc);
    fprintf(p.f, "<script>\n%s</script>\n</body></html>\n", (const char *) report_js);
    const fg_status written = file_end(log, &out, status == FG_OK);
    return status != FG_OK ? status : written;
}
