// SPDX-License-Identifier: MIT
#include "report.h"

#include "file.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_REPORT_BYTES = 256 << 20 };

static int read_report(cli *c, const char *folder, cJSON **out)
{
    char path[4096], *text;
    size_t size;
    *out = NULL;
    snprintf(path, sizeof path, "%s/report.json", folder);
    const fg_status status = file_read(&c->log, path, MAX_REPORT_BYTES, &text, &size);
    if (status != FG_OK)
        return cli_status(c, status);
    *out = cJSON_Parse(text);
    free(text);
    if (cJSON_IsArray(cJSON_GetObjectItem(*out, "records")) &&
        cJSON_IsArray(cJSON_GetObjectItem(*out, "scenes")) &&
        cJSON_IsArray(cJSON_GetObjectItem(*out, "notes")) &&
        cJSON_IsObject(cJSON_GetObjectItem(*out, "device")))
        return EXIT_DONE;
    cJSON_Delete(*out);
    *out = NULL;
    return cli_fail(c, EXIT_INPUT, "%s: is no report", path);
}

// Pictures and graphs go where their names say, below the folder: a report from elsewhere must
// not name others.
static int copy_named(cli *c, const options *o, const char *from, const char *name)
{
    char source[4096], target[4096];
    if (!name[0] || name[0] == '/' || strstr(name, "..") ||
        (strncmp(name, "images/", 7) != 0 && strncmp(name, "graphs/", 7) != 0))
        return cli_fail(c, EXIT_INPUT,
                        "%s/report.json: names the file '%s', must be below images or "
                        "graphs",
                        from, name);
    snprintf(source, sizeof source, "%s/%s", from, name);
    snprintf(target, sizeof target, "%s/%s", o->output, name);
    return cli_status(c, file_copy(&c->log, source, target));
}

static int copy_record(cli *c, const options *o, const char *from, const cJSON *record)
{
    const cJSON *images = cJSON_GetObjectItem(record, "images"), *map;
    int code = copy_named(c, o, from, json_text(images, "result"));
    cJSON_ArrayForEach(map, cJSON_GetObjectItem(images, "error"))
    {
        const char *name = cJSON_GetStringValue(map);
        if (code == EXIT_DONE)
            code = copy_named(c, o, from, name ? name : "");
    }
    return code;
}

static int copy_scene(cli *c, const options *o, const char *from, const cJSON *scene)
{
    const cJSON *item;
    int code = EXIT_DONE;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(scene, "references"))
    {
        if (code == EXIT_DONE)
            code = copy_named(c, o, from, json_text(item, "image"));
    }
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(scene, "graphs"))
    {
        if (code == EXIT_DONE)
            code = copy_named(c, o, from, json_text(item, "dot"));
    }
    return code;
}

static cJSON *find_by(cJSON *list, const char *key, const char *text)
{
    cJSON *item;
    cJSON_ArrayForEach(item, list)
    {
        if (!strcmp(json_text(item, key), text))
            return item;
    }
    return NULL;
}

// Moves members of `from` that `into` lacks, by their `key`.
static void join_lists(cJSON *into, cJSON *from, const char *key)
{
    while (cJSON_GetArraySize(from)) {
        cJSON *item = cJSON_DetachItemFromArray(from, 0);
        if (find_by(into, key, json_text(item, key)))
            cJSON_Delete(item);
        else
            cJSON_AddItemToArray(into, item);
    }
}

static int join_scenes(cli *c, const options *o, const char *from, cJSON *into, cJSON *scenes)
{
    while (cJSON_GetArraySize(scenes)) {
        cJSON *scene = cJSON_DetachItemFromArray(scenes, 0);
        cJSON *there = find_by(into, "name", json_text(scene, "name"));
        const int code = copy_scene(c, o, from, scene);
        if (there) {
            join_lists(cJSON_GetObjectItem(there, "graphs"), cJSON_GetObjectItem(scene, "graphs"),
                       "plugin");
            join_lists(cJSON_GetObjectItem(there, "not_served"),
                       cJSON_GetObjectItem(scene, "not_served"), "plugin");
            cJSON_Delete(scene);
        } else {
            cJSON_AddItemToArray(into, scene);
        }
        if (code != EXIT_DONE)
            return code;
    }
    return EXIT_DONE;
}

static bool same_record(const cJSON *a, const cJSON *b)
{
    return !strcmp(json_text(a, "scene"), json_text(b, "scene")) &&
           !strcmp(json_text(a, "plugin"), json_text(b, "plugin")) &&
           cJSON_Compare(cJSON_GetObjectItem(a, "params"), cJSON_GetObjectItem(b, "params"), 1);
}

static int add_record(cli *c, const char *from, cJSON *records, cJSON *record)
{
    cJSON *other;
    cJSON_ArrayForEach(other, records)
    {
        if (same_record(other, record)) {
            cJSON_Delete(record);
            return cli_fail(c, EXIT_INPUT,
                            "%s/report.json: has a setting of '%s' that another folder has too",
                            from, json_text(other, "plugin"));
        }
    }
    cJSON_AddItemToArray(records, record);
    return EXIT_DONE;
}

static int compare_records(const void *a, const void *b)
{
    const double x = json_number(*(const cJSON *const *) a, "index");
    const double y = json_number(*(const cJSON *const *) b, "index");
    return (x > y) - (x < y);
}

// By "index": the order that one run without shards has.
static int sort_records(cli *c, cJSON *records)
{
    const int count = cJSON_GetArraySize(records);
    cJSON **sorted = calloc((size_t) count + 1, sizeof(cJSON *));
    if (!sorted)
        return cli_status(c, FG_ERR_MEMORY);
    for (int i = 0; i < count; ++i)
        sorted[i] = cJSON_DetachItemFromArray(records, 0);
    qsort(sorted, (size_t) count, sizeof(cJSON *), compare_records);
    for (int i = 0; i < count; ++i)
        cJSON_AddItemToArray(records, sorted[i]);
    free(sorted);
    return EXIT_DONE;
}

static bool same_study(const cJSON *a, const cJSON *b)
{
    return !strcmp(json_text(a, "scene"), json_text(b, "scene")) &&
           !strcmp(json_text(a, "name"), json_text(b, "name"));
}

static int join_studies(cli *c, const char *from, cJSON *into, cJSON *list)
{
    while (cJSON_GetArraySize(list)) {
        cJSON *item = cJSON_DetachItemFromArray(list, 0), *other;
        cJSON_AddItemToArray(into, item);
        cJSON_ArrayForEach(other, into)
        {
            if (other != item && same_study(other, item))
                return cli_fail(c, EXIT_INPUT,
                                "%s/report.json: has the study %s that another folder has too",
                                from, json_text(item, "name"));
        }
    }
    return EXIT_DONE;
}

// What studies lack was found while measuring; other notes are of the plots, which are drawn anew.
static void join_notes(cJSON *doc, const cJSON *notes)
{
    const cJSON *note;
    cJSON_ArrayForEach(note, notes)
    {
        if (cJSON_IsString(note) && !strncmp(note->valuestring, "studies: ", 9))
            report_note(doc, "%s", note->valuestring);
    }
}

static int join(cli *c, const options *o, const char *from, cJSON *doc, cJSON *part)
{
    cJSON *records = cJSON_GetObjectItem(part, "records");
    if (!cJSON_Compare(cJSON_GetObjectItem(doc, "size"), cJSON_GetObjectItem(part, "size"), 1) ||
        strcmp(json_text(doc, "budget"), json_text(part, "budget")) != 0)
        return cli_fail(c, EXIT_INPUT, "%s/report.json: size and budget must be those of %s", from,
                        o->operands[0]);
    if (!cJSON_Compare(cJSON_GetObjectItem(doc, "device"), cJSON_GetObjectItem(part, "device"), 1))
        cli_warn("%s: was measured on another device: times do not compare", from);
    join_notes(doc, cJSON_GetObjectItem(part, "notes"));
    int code = join_scenes(c, o, from, cJSON_GetObjectItem(doc, "scenes"),
                           cJSON_GetObjectItem(part, "scenes"));
    while (code == EXIT_DONE && cJSON_GetArraySize(records)) {
        cJSON *record = cJSON_DetachItemFromArray(records, 0);
        code = copy_record(c, o, from, record);
        if (code == EXIT_DONE)
            code = add_record(c, from, cJSON_GetObjectItem(doc, "records"), record);
        else
            cJSON_Delete(record);
    }
    if (code != EXIT_DONE)
        return code;
    return join_studies(c, from, cJSON_GetObjectItem(doc, "studies"),
                        cJSON_GetObjectItem(part, "studies"));
}

// The first report without its contents, to be joined with all, itself too.
static cJSON *empty_copy(const cJSON *first)
{
    cJSON *doc = cJSON_Duplicate(first, 1);
    cJSON_ReplaceItemInObject(doc, "scenes", cJSON_CreateArray());
    cJSON_ReplaceItemInObject(doc, "records", cJSON_CreateArray());
    cJSON_DeleteItemFromObject(doc, "studies");
    cJSON_AddArrayToObject(doc, "studies");
    cJSON_ReplaceItemInObject(doc, "notes", cJSON_CreateArray());
    cJSON_ReplaceItemInObject(doc, "shard", cJSON_CreateNull());
    return doc;
}

// How many shards there are of the run that a report is part of; 0: it is a whole.
static int shards_of(const cJSON *doc)
{
    const cJSON *count = cJSON_GetArrayItem(cJSON_GetObjectItem(doc, "shard"), 1);
    return cJSON_IsNumber(count) ? count->valueint : 0;
}

int report_merge(cli *c, const options *o, cJSON **doc)
{
    int code = EXIT_DONE, parts = 0, shards = 0;
    *doc = NULL;
    for (int i = 0; i < o->operand_count && code == EXIT_DONE; ++i) {
        cJSON *part;
        code = read_report(c, o->operands[i], &part);
        if (code == EXIT_DONE && !*doc)
            *doc = empty_copy(part);
        if (code == EXIT_DONE && shards_of(part)) {
            shards = shards_of(part);
            ++parts;
        }
        if (code == EXIT_DONE)
            code = join(c, o, o->operands[i], *doc, part);
        cJSON_Delete(part);
    }
    if (code == EXIT_DONE && parts < shards)
        report_note(*doc, "joined of %d of %d shards: settings are missing", parts, shards);
    if (code == EXIT_DONE)
        code = sort_records(c, cJSON_GetObjectItem(*doc, "records"));
    if (code == EXIT_DONE)
        code = sort_records(c, cJSON_GetObjectItem(*doc, "studies"));
    return code;
}
