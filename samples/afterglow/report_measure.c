// SPDX-License-Identifier: MIT
#include "report.h"

#include "batch.h"
#include "file.h"
#include "study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SMALL = 1000 };
static const budget quick_budget = { 256, 256, 32, 1, 3, 3, 300, 1000 };
static const budget full_budget = { 1024, 4096, 1024, 8, 5, 5, 2000, 60000 };

typedef struct measure {
    host h;
    const budget *budget;
    const char *folder;
    int width, height;
    cJSON *doc, *scene; // the document, and the entry of the scene at hand
    const job_list *jobs;
    const setting *plugins;
    int plugin_count;
    const truths *truths;
    batch batch; // of the scene at hand
    int scene_number;
} measure;

// ---- error -----------------------------------------------------------------------------------

static fg_status write_map(measure *m, const image *result, const truths *t, int truth, cJSON *list,
                           const char *stem)
{
    char name[256], path[4096];
    image map = { 0 };
    snprintf(name, sizeof name, "%s_%s.png", stem, truth_names[truth]);
    snprintf(path, sizeof path, "%s/%s", m->folder, name);
    fg_status status =
        metrics_error_map(&m->h.c->log, result, &t->picture[truth], t->scale[truth], &map);
    if (status == FG_OK)
        status = image_write(&m->h.c->log, path, &map, IMAGE_LIGHT);
    image_finish(&map);
    cJSON_AddItemToArray(list, cJSON_CreateString(name));
    return status;
}

static fg_status write_images(measure *m, image *result, const truths *t, int index, cJSON *record)
{
    char scene[64], stem[160], name[200], path[4096];
    fg_status status = FG_OK;
    report_file_name(scene, sizeof scene, m->h.scene_name);
    snprintf(stem, sizeof stem, "images/%s_%03d", scene, index);
    cJSON *images = cJSON_AddObjectToObject(record, "images");
    snprintf(name, sizeof name, "%s.png", stem);
    cJSON_AddStringToObject(images, "result", name);
    cJSON *maps = cJSON_AddArrayToObject(images, "error");
    for (int i = 0; i < REPORT_TRUTHS && status == FG_OK; ++i)
        status = write_map(m, result, t, i, maps, stem);
    for (int i = 0; i < 3 * result->width * result->height; ++i)
        result->rgb[i] *= (float) t->exposure;
    snprintf(path, sizeof path, "%s/%s", m->folder, name);
    return status == FG_OK ? image_write(&m->h.c->log, path, result, IMAGE_LIGHT) : status;
}

// Errors against every truth, and the pictures.
static fg_status add_error(measure *m, image *result, const truths *t, int index, cJSON *record)
{
    cJSON *errors = cJSON_CreateArray();
    fg_status status = FG_OK;
    for (int i = 0; i < REPORT_TRUTHS && status == FG_OK; ++i) {
        metrics e;
        status = metrics_compare(&m->h.c->log, result, &t->picture[i], &e);
        if (status == FG_OK)
            cJSON_AddItemToArray(errors, truth_error(t, i, &e));
    }
    if (status == FG_OK)
        cJSON_AddItemToObject(record, "error", cJSON_Duplicate(cJSON_GetArrayItem(errors, 0), 1));
    cJSON_AddItemToObject(record, "errors", errors);
    return status == FG_OK ? write_images(m, result, t, index, record) : status;
}

static fg_status write_graph(measure *m, renderer *r, const job *j)
{
    char scene[64], plugin[64], name[200], path[4096];
    char *dot = fg_graph_dump(renderer_graph(r), FG_DUMP_DOT);
    if (!dot)
        return FG_ERR_MEMORY;
    report_file_name(scene, sizeof scene, m->h.scene_name);
    report_file_name(plugin, sizeof plugin, setting_name(&j->s));
    snprintf(name, sizeof name, "graphs/%s_%s.dot", scene, plugin);
    snprintf(path, sizeof path, "%s/%s", m->folder, name);
    cJSON *entry = cJSON_CreateObject();
    cJSON_AddStringToObject(entry, "plugin", setting_name(&j->s));
    cJSON_AddStringToObject(entry, "dot", name);
    cJSON_AddItemToArray(cJSON_GetObjectItem(m->scene, "graphs"), entry);
    const fg_status status = file_write(&m->h.c->log, path, dot, strlen(dot));
    fg_dump_free(renderer_graph(r), dot);
    return status;
}

static fg_status judge(void *user, int k, renderer *r, image *picture)
{
    measure *m = user;
    const job *j = &m->jobs->jobs[k];
    const fg_status status = add_error(m, picture, m->truths, k, m->batch.records[k]);
    return status == FG_OK && j->base ? write_graph(m, r, j) : status;
}

// ---- scenes ----------------------------------------------------------------------------------

// Leaves out what is another shard's and what the scene does not serve.
static void choose_jobs(measure *m)
{
    const options *o = m->h.o;
    cJSON *not_served = cJSON_GetObjectItem(m->scene, "not_served");
    for (int k = 0; k < m->jobs->count; ++k) {
        const job *j = &m->jobs->jobs[k];
        const char *lacks;
        const bool served = host_serves(&m->h, j->s.plugin, &lacks);
        const bool others =
            o->shards && (m->scene_number * m->jobs->count + k + 1 - o->shard) % o->shards;
        if (served && !others)
            continue;
        cJSON_Delete(m->batch.records[k]);
        m->batch.records[k] = NULL;
        if (!served && !others && j->base) {
            cJSON *entry = cJSON_CreateObject();
            cJSON_AddStringToObject(entry, "plugin", j->s.plugin->name);
            cJSON_AddStringToObject(entry, "lacks", lacks);
            cJSON_AddItemToArray(not_served, entry);
        }
    }
}

static fg_status measure_jobs(measure *m)
{
    m->batch = (batch){
        .h = &m->h,
        .budget = m->budget,
        .width = m->width,
        .height = m->height,
        .jobs = m->jobs->jobs,
        .count = m->jobs->count,
        .first_index = m->scene_number * 100000,
        .what = "settings",
        .judge = judge,
        .user = m,
    };
    cJSON *records = cJSON_GetObjectItem(m->doc, "records");
    fg_status status = batch_create(&m->batch);
    if (status == FG_OK) {
        choose_jobs(m);
        status = batch_run(&m->batch);
    }
    for (int k = 0; k < m->jobs->count && status == FG_OK; ++k) {
        if (m->batch.records[k])
            cJSON_AddItemToArray(records, m->batch.records[k]);
        m->batch.records[k] = NULL;
    }
    batch_finish(&m->batch);
    return status;
}

static fg_status measure_all(measure *m, const truths *t)
{
    const studies_desc desc = {
        .h = &m->h,
        .budget = m->budget,
        .width = m->width,
        .height = m->height,
        .full = m->budget == &full_budget,
        .plugins = m->plugins,
        .plugin_count = m->plugin_count,
        .truths = t->picture[0].rgb ? t : NULL,
        .scene_number = m->scene_number,
        .doc = m->doc,
    };
    m->truths = t;
    const fg_status status = m->jobs->count ? measure_jobs(m) : FG_OK;
    return status == FG_OK ? studies_measure(&desc) : status;
}

static int render_truths(measure *m, uint64_t triangles, truths *t)
{
    int spp[REPORT_TRUTHS];
    spp[0] = triangles < SMALL ? m->budget->spp_small : m->budget->spp_large;
    spp[1] = (spp[0] + 1) / 2; // a ray that nothing stops costs more
    for (int i = 0; i < REPORT_TRUTHS && m->h.o->spp > 0; ++i)
        spp[i] = m->h.o->spp;
    const truths_desc desc = {
        .folder = m->folder,
        .scene_json = m->scene,
        .width = m->width,
        .height = m->height,
        .spp = { spp[0], spp[1] },
    };
    return truths_render(&m->h, &desc, t);
}

static int measure_scene(measure *m, const char *name)
{
    truths t = { 0 };
    uint64_t triangles = 0;
    int code = host_open_scene(&m->h, name);
    if (code != EXIT_DONE)
        return code;
    for (int i = 0; i < m->h.scene->instance_count; ++i)
        triangles += m->h.scene->primitives[m->h.scene->instances[i].primitive].index_count / 3;
    m->scene = cJSON_CreateObject();
    cJSON_AddItemToArray(cJSON_GetObjectItem(m->doc, "scenes"), m->scene);
    cJSON_AddStringToObject(m->scene, "name", name);
    cJSON_AddNumberToObject(m->scene, "triangles", (double) triangles);
    cJSON_AddArrayToObject(m->scene, "not_served");
    cJSON_AddArrayToObject(m->scene, "graphs");
    if (m->jobs->count || studies_need_truths(m->h.o, m->budget == &full_budget))
        code = render_truths(m, triangles, &t);
    if (code == EXIT_DONE)
        code = cli_status(m->h.c, measure_all(m, &t));
    truths_finish(&t);
    return code;
}

static cJSON *new_document(const measure *m)
{
    const options *o = m->h.o;
    cJSON *doc = cJSON_CreateObject();
    cJSON_AddStringToObject(doc, "afterglow", AFTERGLOW_VERSION);
    cJSON_AddStringToObject(doc, "budget", m->budget == &full_budget ? "full" : "quick");
    cJSON_AddItemToObject(doc, "size", cJSON_CreateIntArray((int[]){ m->width, m->height }, 2));
    cJSON_AddNumberToObject(doc, "error_frame", m->budget->error_frames - 1);
    cJSON_AddNumberToObject(doc, "seed", (double) o->seed);
    const int shadow[2] = { o->shadow_size, o->shadow_taps ? o->shadow_taps : 4 };
    cJSON_AddItemToObject(doc, "shadow", cJSON_CreateIntArray(shadow, 2));
    if (o->shards)
        cJSON_AddItemToObject(doc, "shard",
                              cJSON_CreateIntArray((int[]){ o->shard, o->shards }, 2));
    else
        cJSON_AddNullToObject(doc, "shard");
    cJSON_AddItemToObject(doc, "device", record_device(&m->h));
    cJSON_AddArrayToObject(doc, "notes");
    cJSON_AddArrayToObject(doc, "scenes");
    cJSON_AddArrayToObject(doc, "records");
    cJSON_AddArrayToObject(doc, "studies");
    return doc;
}

static int measure_scenes(measure *m, const job_list *jobs)
{
    static const char *const defaults[] = { "cornell", "atrium" };
    const options *o = m->h.o;
    const int count = o->operand_count ? o->operand_count : FG_COUNT(defaults);
    int code = EXIT_DONE;
    m->jobs = jobs;
    for (int i = 0; i < count && code == EXIT_DONE; ++i) {
        m->scene_number = i;
        code = measure_scene(m, o->operand_count ? o->operands[i] : defaults[i]);
    }
    return code;
}

// Before the truth is traced, which takes long.
static int check_size(const measure *m)
{
    const int most = m->h.device->ops->limits(m->h.device)->max_texture_size;
    if (m->width <= most && m->height <= most)
        return EXIT_DONE;
    return cli_fail(m->h.c, EXIT_FAILED, "--size: is %dx%d, the device takes at most %d", m->width,
                    m->height, most);
}

int report_measure(cli *c, const options *o, cJSON **doc)
{
    const bool full = o->budget && !strcmp(o->budget, "full");
    measure m = { .budget = full ? &full_budget : &quick_budget, .folder = o->output };
    setting plugins[CLI_MAX_GI];
    job_list jobs = { 0 };
    int count = 0;
    m.width = o->width ? o->width : m.budget->size;
    m.height = o->height ? o->height : m.budget->size;
    host_init(&m.h, c, o);
    int code = host_open_registry(&m.h);
    if (code == EXIT_DONE)
        code = host_settings(&m.h, true, plugins, &count);
    if (code == EXIT_DONE)
        code = studies_check(c, o);
    if (code == EXIT_DONE && !o->study_count)
        code = cli_status(c, jobs_build(o, plugins, count, full, &jobs));
    if (code == EXIT_DONE)
        code = host_open_device(&m.h);
    if (code == EXIT_DONE)
        code = check_size(&m);
    if (code == EXIT_DONE) {
        m.doc = new_document(&m);
        m.plugins = plugins;
        m.plugin_count = count;
        code = measure_scenes(&m, &jobs);
    }
    for (int i = 0; i < count; ++i)
        setting_finish(&plugins[i]);
    jobs_finish(&jobs);
    host_finish(&m.h);
    if (code != EXIT_DONE) {
        cJSON_Delete(m.doc);
        m.doc = NULL;
    }
    *doc = m.doc;
    return code;
}
