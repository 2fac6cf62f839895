// SPDX-License-Identifier: MIT
#include "report.h"

#include "file.h"
#include "study.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

const char *json_text(const cJSON *object, const char *name)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(object, name));
    return text ? text : "";
}

double json_number(const cJSON *object, const char *name)
{
    const cJSON *item = cJSON_GetObjectItem(object, name);
    return cJSON_IsNumber(item) ? item->valuedouble : (double) NAN;
}

void report_file_name(char *out, size_t size, const char *text)
{
    enum { HASH = 9 }; // letters of "-%08x"
    const char *slash = strrchr(text, '/');
    uint32_t hash = 2166136261; // FNV-1a
    size_t n = 0;
    for (const char *at = slash && slash[1] ? slash + 1 : text; *at && n + HASH + 1 < size; ++at)
        out[n++] = isalnum((unsigned char) *at) || *at == '-' ? *at : '_';
    out[n] = 0;
    for (const char *at = text; *at; ++at)
        hash = (hash ^ (unsigned char) *at) * 16777619;
    if (strcmp(out, text) != 0)
        snprintf(out + n, size - n, "-%08x", (unsigned) hash);
}

void report_note(cJSON *doc, const char *fmt, ...)
{
    cJSON *notes = cJSON_GetObjectItem(doc, "notes");
    const cJSON *other;
    char text[320];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    cJSON_ArrayForEach(other, notes)
    {
        if (cJSON_IsString(other) && !strcmp(other->valuestring, text))
            return;
    }
    cJSON_AddItemToArray(notes, cJSON_CreateString(text));
    cli_warn("report: %s", text);
}

double report_error_of(const cJSON *record, int truth)
{
    return json_number(cJSON_GetArrayItem(cJSON_GetObjectItem(record, "errors"), truth),
                       "rmse_rms_corrected");
}

double report_pass_ms(const cJSON *pass)
{
    const double gpu = json_number(pass, "gpu_ms"), call = json_number(pass, "cpu_ms");
    return gpu > call || isnan(call) ? gpu : call;
}

static double median_of(const cJSON *record)
{
    return json_number(cJSON_GetObjectItem(record, "frame_ms"), "median");
}

bool report_on_front(const cJSON *doc, const cJSON *record, int truth)
{
    const cJSON *other;
    const double ms = median_of(record), error = report_error_of(record, truth);
    if (!(ms > 0) || !(error >= 0))
        return false;
    cJSON_ArrayForEach(other, cJSON_GetObjectItem(doc, "records"))
    {
        const double other_ms = median_of(other), other_error = report_error_of(other, truth);
        if (!strcmp(json_text(other, "scene"), json_text(record, "scene")) && other_ms <= ms &&
            other_error <= error && (other_ms < ms || other_error < error))
            return false;
    }
    return true;
}

// ---- CSV -------------------------------------------------------------------------------------

static void csv_text(FILE *f, const char *text)
{
    fputc('"', f);
    for (; *text; ++text) {
        if (*text == '"')
            fputc('"', f);
        fputc((unsigned char) *text < 0x20 ? ' ' : *text, f);
    }
    fputc('"', f);
}

static void csv_number(FILE *f, const cJSON *object, const char *name)
{
    const double value = json_number(object, name);
    fputc(',', f);
    if (isfinite(value))
        fprintf(f, "%.9g", value);
}

static void csv_params(FILE *f, const cJSON *params)
{
    const cJSON *item;
    char all[1024];
    size_t at = 0;
    all[0] = 0;
    cJSON_ArrayForEach(item, params)
    {
        char *value = cJSON_IsString(item) ? NULL : cJSON_PrintUnformatted(item);
        const int n = snprintf(all + at, sizeof all - at, "%s%s=%s", at ? " " : "", item->string,
                               value ? value : cJSON_GetStringValue(item));
        free(value);
        at += n > 0 && (size_t) n < sizeof all - at ? (size_t) n : 0;
    }
    csv_text(f, all);
}

static const char *const metric_names[] = { "rmse", "rmse_rms",     "rmse_max", "relmse",   "smape",
                                            "bias", "energy_ratio", "p99",      "nonfinite" };
static const char *const memory_names[] = { "transient_bytes", "unshared_bytes",
                                            "persistent_bytes" };

static void csv_record(FILE *f, const cJSON *record)
{
    const cJSON *frame = cJSON_GetObjectItem(record, "frame_ms");
    const cJSON *memory = cJSON_GetObjectItem(record, "memory");
    const cJSON *size = cJSON_GetObjectItem(record, "size"), *error;
    csv_text(f, json_text(record, "scene"));
    fputc(',', f);
    csv_text(f, json_text(record, "plugin"));
    fputc(',', f);
    csv_text(f, json_text(record, "label"));
    fputc(',', f);
    csv_params(f, cJSON_GetObjectItem(record, "params"));
    for (int i = 0; i < 2; ++i)
        fprintf(f, ",%.0f", cJSON_GetNumberValue(cJSON_GetArrayItem(size, i)));
    csv_number(f, frame, "median");
    csv_number(f, frame, "p99");
    csv_number(f, frame, "min");
    csv_number(f, cJSON_GetObjectItem(record, "cpu_ms"), "median");
    for (int i = 0; i < FG_COUNT(memory_names); ++i)
        csv_number(f, memory, memory_names[i]);
    cJSON_ArrayForEach(error, cJSON_GetObjectItem(record, "errors"))
    {
        for (int i = 0; i < FG_COUNT(metric_names); ++i)
            csv_number(f, error, metric_names[i]);
    }
    fputc('\n', f);
}

fg_status report_csv(const fg_log *log, const char *folder, const cJSON *doc)
{
    char path[4096];
    file out;
    const cJSON *record;
    snprintf(path, sizeof path, "%s/report.csv", folder);
    const fg_status status = file_begin(log, path, &out);
    if (status != FG_OK)
        return status;
    fprintf(out.stream, "scene,plugin,label,params,width,height,frame_ms_median,frame_ms_p99,"
                        "frame_ms_min,cpu_ms_median");
    for (int i = 0; i < FG_COUNT(memory_names); ++i)
        fprintf(out.stream, ",%s", memory_names[i]);
    for (int t = 0; t < REPORT_TRUTHS; ++t)
        for (int i = 0; i < FG_COUNT(metric_names); ++i)
            fprintf(out.stream, ",%s_%s", truth_names[t], metric_names[i]);
    fputc('\n', out.stream);
    cJSON_ArrayForEach(record, cJSON_GetObjectItem(doc, "records"))
    {
        csv_record(out.stream, record);
    }
    return file_end(log, &out, true);
}

// ---- all of it -------------------------------------------------------------------------------

int report_write(cli *c, const char *folder, cJSON *doc)
{
    char path[4096];
    fg_status status = report_plots(&c->log, folder, doc);
    snprintf(path, sizeof path, "%s/report.json", folder);
    if (status == FG_OK)
        status = study_plots(&c->log, folder, doc);
    if (status == FG_OK)
        status = report_csv(&c->log, folder, doc);
    if (status == FG_OK)
        status = report_html(&c->log, folder, doc);
    if (status == FG_OK)
        status = record_write(&c->log, doc, path);
    return cli_status(c, status);
}
