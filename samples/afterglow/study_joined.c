// SPDX-License-Identifier: MIT
// Tables 1 and 2 of Laine et al. 2007: scenes as rows. Curves of such a study come in pairs, the
// method and what it is compared with at the same size.
#include "html.h"
#include "study.h"

#include <string.h>

static const char *const common[] = { "split", "gather, splat", "combine", "filter" };

typedef struct pair {
    const cJSON *ours, *other;
} pair;

static const cJSON *point_of(const cJSON *points, const char *label)
{
    const cJSON *point;
    cJSON_ArrayForEach(point, points)
    {
        if (!strcmp(json_text(point, "curve"), label))
            return point;
    }
    return NULL;
}

static bool pair_of(const study *s, const cJSON *item, int i, pair *out)
{
    const cJSON *points = cJSON_GetObjectItem(item, "points");
    *out = (pair){ point_of(points, s->curves[i].label), point_of(points, s->curves[i + 1].label) };
    return out->ours && out->other;
}

// Sum of the passes whose names begin so.
static double passes_ms(const cJSON *point, const char *start)
{
    const cJSON *pass;
    double sum = 0;
    cJSON_ArrayForEach(pass, cJSON_GetObjectItem(point, "passes"))
    {
        const double ms = report_pass_ms(pass);
        if (!strncmp(json_text(pass, "name"), start, strlen(start)) && ms > 0)
            sum += ms;
    }
    return sum;
}

static double common_ms(const cJSON *point)
{
    double sum = 0;
    for (int i = 0; i < FG_COUNT(common); ++i)
        sum += study_stage_ms(point, common[i]);
    return sum;
}

static double frame_ms(const cJSON *point)
{
    return json_number(cJSON_GetObjectItem(point, "frame_ms"), "median");
}

static double manage_ms(const cJSON *point)
{
    enum { MOST = 256 };
    const cJSON *counters = cJSON_GetObjectItem(cJSON_GetObjectItem(point, "path"), "counters");
    const cJSON *value;
    double ms[MOST];
    int count = 0;
    cJSON_ArrayForEach(value, cJSON_GetObjectItem(counters, "manage_ms"))
    {
        if (cJSON_IsNumber(value) && count < MOST)
            ms[count++] = value->valuedouble;
    }
    return timing_quantile(ms, count, 0.5);
}

static void write_scene_size(FILE *f, const cJSON *item, const cJSON *point)
{
    const cJSON *size = cJSON_GetObjectItem(point, "size");
    html_cell(f, json_text(item, "scene"));
    fprintf(f, "<td>%.0f &times; %.0f</td>", cJSON_GetNumberValue(cJSON_GetArrayItem(size, 0)),
            cJSON_GetNumberValue(cJSON_GetArrayItem(size, 1)));
}

// Indirect light is what the frame takes without direct light, as the paper's own factors have it:
// (1000/7.1 - 6.9) / (1000/48.6 - 6.9) = 9.8.
static void write_row_1(FILE *f, const cJSON *item, const pair *p)
{
    const double direct = passes_ms(p->ours, "shadow.") + passes_ms(p->ours, "direct.");
    const double ours = frame_ms(p->ours), other = frame_ms(p->other);
    const double figures[] = {
        direct,
        passes_ms(p->ours, "gbuffer."),
        common_ms(p->ours),
        study_stage_ms(p->ours, "visibility"),
        study_stage_ms(p->other, "visibility"),
        manage_ms(p->ours),
        ours,
        other,
        1000 / ours,
        1000 / other,
        (other - direct) / (ours - direct),
        other / ours,
    };
    fputs("<tr>", f);
    write_scene_size(f, item, p->ours);
    for (int i = 0; i < FG_COUNT(figures); ++i)
        html_number(f, figures[i], "%.2f");
    fputs("</tr>\n", f);
}

static void write_row_2(FILE *f, const cJSON *item, const pair *p)
{
    fputs("<tr>", f);
    write_scene_size(f, item, p->ours);
    for (int i = 0; i < FG_COUNT(common); ++i)
        html_number(f, study_stage_ms(p->ours, common[i]), "%.2f");
    html_number(f, common_ms(p->ours), "%.2f");
    fputs("</tr>\n", f);
}

// Returns how many rows there are; without `f` they are counted alone.
static int write_rows(FILE *f, const cJSON *doc,
                      void (*write)(FILE *f, const cJSON *item, const pair *p))
{
    const cJSON *item;
    int rows = 0;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(doc, "studies"))
    {
        const study *s = study_find(json_text(item, "name"));
        for (int i = 0; s && s->joined && s->curves[i].label && s->curves[i + 1].label; i += 2) {
            pair p;
            if (!pair_of(s, item, i, &p))
                continue;
            ++rows;
            if (f)
                write(f, item, &p);
        }
    }
    return rows;
}

static void write_table(FILE *f, const cJSON *doc, const char *heads,
                        void (*write)(FILE *f, const cJSON *item, const pair *p))
{
    fprintf(f,
            "<div class=\"scroll\"><table><thead><tr><th class=\"text\">scene</th>"
            "<th>size</th>%s</tr></thead><tbody>\n",
            heads);
    write_rows(f, doc, write);
    fputs("</tbody></table></div>\n", f);
}

void study_tables_html(FILE *f, const cJSON *doc)
{
    if (!write_rows(NULL, doc, NULL))
        return;
    fputs("<h2>Incremental instant radiosity: all scenes</h2>\n"
          "<h3>Table 1: incremental against anew</h3>\n"
          "<p class=\"quiet\">256 VPLs, 4 to 8 of them new a frame, while light and camera move. "
          "Medians, in ms. Common: table 2. Maps: shadow maps of VPLs. CPU: VPL management, on a "
          "thread of its own. Speedup (&times;) of indirect light: of frames without direct light, "
          "as in the "
          "paper.</p>\n",
          f);
    write_table(f, doc,
                "<th>direct</th><th>G-buffer</th><th>common</th><th>maps</th><th>anew</th>"
                "<th>CPU</th><th>frame</th><th>anew</th><th>fps</th><th>anew</th>"
                "<th>&times; indirect</th><th>&times; frame</th>",
                write_row_1);
    fputs("<h3>Table 2: common steps</h3>\n<p class=\"quiet\">Medians, in ms.</p>\n", f);
    write_table(f, doc,
                "<th>split</th><th>accumulate</th><th>combine</th><th>filter</th><th>sum</th>",
                write_row_2);
}
