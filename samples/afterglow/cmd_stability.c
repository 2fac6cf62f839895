// SPDX-License-Identifier: MIT
#include "record.h"
#include "stability.h"

#include <math.h>
#include <string.h>

static void receive(void *user, fg_log_level level, const char *msg)
{
    stability *s = user;
    s->warnings += level == FG_LOG_WARN;
    if (level == FG_LOG_ERROR && !s->error[0])
        snprintf(s->error, sizeof s->error, "%s", msg);
}

// What came of a case: "pass", "known", "fail" or "not served".
static const char *judge(const stability_case *k, const stability *s, fg_status status,
                         double measured)
{
    if (status == FG_ERR_UNSUPPORTED && !s->error[0])
        return "not served";
    if (status != FG_OK || s->bad || !(measured >= 0))
        return "fail";
    if (measured <= k->bound)
        return "pass";
    return k->known && measured <= k->known_bound ? "known" : "fail";
}

static void note(const stability_case *k, const stability *s, fg_status status, const char *verdict,
                 char out[640])
{
    out[0] = 0;
    if (s->bad)
        snprintf(out, 640, "%ld values of %s are not finite, or negative light", s->bad, s->where);
    else if (!strcmp(verdict, "fail") && status != FG_OK)
        snprintf(out, 640, "%s", s->error[0] ? s->error : fg_status_name(status));
    else if (!strcmp(verdict, "known"))
        snprintf(out, 640, "%s", k->known);
}

static cJSON *case_json(const stability_case *k, const char *plugin, const char *verdict,
                        double measured, const char *why)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "row", k->row);
    cJSON_AddStringToObject(json, "case", k->name);
    cJSON_AddStringToObject(json, "plugin", plugin);
    cJSON_AddStringToObject(json, "status", verdict);
    cJSON_AddStringToObject(json, "figure", k->figure);
    cJSON_AddItemToObject(json, "measured",
                          isfinite(measured) ? cJSON_CreateNumber(measured) : cJSON_CreateNull());
    cJSON_AddNumberToObject(json, "bound", k->bound);
    cJSON_AddStringToObject(json, "note", why);
    return json;
}

// Runs one case for one plugin and prints its cell. True if it failed.
static bool run_case(host *h, const stability_case *k, const setting *plugin, cJSON *list)
{
    const gi_plugin *rsm = host_has_plugin(h, "rsm") ? gi_find(h->registry, "rsm") : NULL;
    stability s = { .device = h->device, .setting = plugin, .rsm = rsm };
    double measured = (double) NAN;
    char why[640];
    s.log = (fg_log){ .fn = receive, .user = &s, .level = FG_LOG_WARN };
    s.frames = h->o->frames ? h->o->frames : 300;
    const fg_status status = k->run(&s, &measured);
    const char *verdict = judge(k, &s, status, measured);
    note(k, &s, status, verdict, why);
    cJSON_AddItemToArray(list, case_json(k, setting_name(plugin), verdict, measured, why));
    if (!strcmp(verdict, "not served"))
        printf(" %20s", "-");
    else
        printf(" %10.3g %9s", measured, verdict);
    fflush(stdout);
    return !strcmp(verdict, "fail");
}

static void print_notes(const cJSON *list)
{
    const cJSON *entry;
    cJSON_ArrayForEach(entry, list)
    {
        const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(entry, "note"));
        if (text && text[0])
            printf("%s, %s: %s: %s\n", cJSON_GetStringValue(cJSON_GetObjectItem(entry, "case")),
                   cJSON_GetStringValue(cJSON_GetObjectItem(entry, "plugin")),
                   cJSON_GetStringValue(cJSON_GetObjectItem(entry, "status")), text);
    }
}

static const stability_case *const tables[] = { stability_light_cases,     stability_frame_cases,
                                                stability_hierarchy_cases, stability_reuse_cases,
                                                stability_change_cases,    NULL };

static const stability_case *find_case(const char *name)
{
    for (int t = 0; tables[t]; ++t)
        for (const stability_case *k = tables[t]; k->name; ++k)
            if (!strcmp(k->name, name))
                return k;
    return NULL;
}

static bool wanted(const options *o, const char *name)
{
    for (int i = 0; i < o->operand_count; ++i)
        if (!strcmp(o->operands[i], name))
            return true;
    return !o->operand_count;
}

static int check_names(cli *c, const options *o)
{
    for (int i = 0; i < o->operand_count; ++i)
        if (!find_case(o->operands[i]))
            return cli_fail(c, EXIT_USAGE, "stability: there is no case '%s'", o->operands[i]);
    return EXIT_DONE;
}

static int run_all(host *h, const setting *plugins, int count)
{
    char path[4096];
    int failed = 0, ran = 0;
    cJSON *doc = cJSON_CreateObject(), *list;
    cJSON_AddItemToObject(doc, "device", record_device(h));
    list = cJSON_AddArrayToObject(doc, "cases");
    printf("%3s %-26s %9s", "row", "case", "at most");
    for (int i = 0; i < count; ++i)
        printf(" %20s", setting_name(&plugins[i]));
    printf("\n");
    for (int t = 0; tables[t]; ++t)
        for (const stability_case *k = tables[t]; k->name; ++k) {
            if (!wanted(h->o, k->name))
                continue;
            printf("%3d %-26s %9.3g", k->row, k->name, k->bound);
            for (int i = 0; i < count; ++i, ++ran)
                failed += run_case(h, k, &plugins[i], list);
            printf("\n");
        }
    print_notes(list);
    snprintf(path, sizeof path, "%s/stability.json", h->o->output);
    const fg_status status = record_write(&h->c->log, doc, path);
    cJSON_Delete(doc);
    if (status != FG_OK)
        return cli_status(h->c, status);
    if (failed)
        return cli_fail(h->c, EXIT_FAILED, "stability: %d of %d cases failed", failed, ran);
    return EXIT_DONE;
}

// Direct light alone first, then the plugins.
static int choose_plugins(host *h, setting out[CLI_MAX_GI + 1], int *count)
{
    out[0] = (setting){ 0 };
    const int code = host_settings(h, true, out + 1, count);
    if (code == EXIT_DONE)
        ++*count;
    return code;
}

static int run(cli *c, const options *o)
{
    host h;
    setting plugins[CLI_MAX_GI + 1];
    int count = 0;
    host_init(&h, c, o);
    int code = check_names(c, o);
    if (code == EXIT_DONE)
        code = host_check_folder(c, o);
    if (code == EXIT_DONE)
        code = host_open_registry(&h);
    if (code == EXIT_DONE)
        code = choose_plugins(&h, plugins, &count);
    if (code == EXIT_DONE)
        code = host_open_device(&h);
    if (code == EXIT_DONE)
        code = run_all(&h, plugins, count);
    for (int i = 1; i < count; ++i)
        setting_finish(&plugins[i]);
    host_finish(&h);
    return code;
}

const command command_stability = {
    .name = "stability",
    .operands = "[CASE]...",
    .summary = "Runs the stiff and extreme cases for direct light and every plugin",
    .help =
        "Prints a table and writes stability.json to the folder that -o names; exit code 1 if any\n"
        "case fails. In every frame all that the graph writes is read back: no value may be other\n"
        "than finite and no light negative, with transient textures filled with NaN before. known: "
        "the\n"
        "bound is not kept, for the reason given and by no more than is known. --frames: length "
        "of\n"
        "the long cases, in which nothing moves or a light goes to and fro (300).",
    .max_operands = -1,
    .option_names = " --gi --set --device --shader-dir --plugin-dir --frames --output ",
    .run = run,
};
