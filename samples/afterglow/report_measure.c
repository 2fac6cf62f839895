// SPDX-License-Identifier: MIT
#include "report.h"

#include "file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct budget {
    int size;
    int spp_small, spp_large; // of the truth, in scenes below and from SMALL triangles on
    int error_frames;         // the picture that is compared is the n-th at time 0
    int visits, frames;       // of the timing loop: every setting in turn, so often
    double slow_ms;           // settings slower than this are timed once a visit
    double too_slow_ms;       // and slower than this in the first visit only
} budget;
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
    timing *timings;  // one a job
    double *estimate; // one a job: ms of the last frame of the error's
    cJSON **records;  // one a job; NULL: not served, or another shard's
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

// The noise of the truth is independent of the result and of the truth: its square is in the
// squares of both the error and the truth's RMS, and is taken out of both.
static cJSON *error_json(const truths *t, int truth, const metrics *e)
{
    const double noise = t->noise[truth] * t->noise[truth];
    const double square = e->rmse * e->rmse - noise, rms = t->rms[truth] * t->rms[truth] - noise;
    const double corrected = square > 0 && rms > 0 ? sqrt(square / rms) : (double) NAN;
    cJSON *json = record_error(truth_names[truth], e);
    cJSON_AddNumberToObject(json, "noise", t->noise[truth]);
    cJSON_AddItemToObject(json, "rmse_rms_corrected",
                          isfinite(corrected) ? cJSON_CreateNumber(corrected) : cJSON_CreateNull());
    return json;
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
            cJSON_AddItemToArray(errors, error_json(t, i, &e));
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

static fg_status run_error_frames(measure *m, renderer *r, int k)
{
    fg_status status = host_switch(&m->h, r, &m->jobs->jobs[k].s);
    for (int i = 0; i < m->budget->error_frames && status == FG_OK; ++i) {
        const double start = now_ms();
        status = renderer_frame(r, 0);
        if (status == FG_OK)
            status = fg_gl_finish(m->h.device);
        m->estimate[k] = now_ms() - start;
    }
    return status;
}

static fg_status measure_error(measure *m, const truths *t)
{
    const setting none = { 0 };
    renderer *r = NULL;
    renderer_desc desc = host_renderer_desc(&m->h, &none, m->width, m->height);
    desc.layers = 1u << LAYER_INDIRECT;
    fg_status status = host_renderer(&m->h, &desc, &r);
    for (int k = 0; k < m->jobs->count && status == FG_OK; ++k) {
        image result = { 0 };
        const job *j = &m->jobs->jobs[k];
        cli_progress("errors", (double) k / m->jobs->count);
        if (!m->records[k])
            continue;
        // By way of nothing, so that no setting inherits what the one before has kept.
        status = host_switch(&m->h, r, &none);
        if (status == FG_OK)
            status = run_error_frames(m, r, k);
        if (status == FG_OK)
            status = renderer_read(r, LAYER_INDIRECT, &result);
        if (status == FG_OK)
            status = add_error(m, &result, t, k, m->records[k]);
        if (status == FG_OK && j->base)
            status = write_graph(m, r, j);
        image_finish(&result);
    }
    cli_progress("errors", 1);
    renderer_destroy(r);
    return status;
}

// ---- run time --------------------------------------------------------------------------------

// The rest of a record, from the renderer as it stands after the last visit.
static void complete_record(measure *m, renderer *r, int k)
{
    const job *j = &m->jobs->jobs[k];
    cJSON *run = record_create(&m->h, r, &j->s, &m->timings[k], m->width, m->height);
    cJSON *own = m->records[k];
    cJSON_DeleteItemFromObject(run, "error");
    cJSON_AddNumberToObject(run, "index", m->scene_number * 100000 + k);
    cJSON_AddStringToObject(run, "label", j->label);
    cJSON *item;
    while ((item = cJSON_DetachItemFromArray(own, 0)))
        cJSON_AddItemToObject(run, item->string, item);
    cJSON_Delete(own);
    m->records[k] = run;
}

static fg_status visit(measure *m, renderer *r, int k, int number)
{
    timing *t = &m->timings[k];
    const double last = t->count ? t->frame[t->count - 1] : m->estimate[k];
    const bool slow = last > m->budget->slow_ms;
    const bool once = m->estimate[k] > m->budget->too_slow_ms;
    if (once && number)
        return FG_OK;
    fg_status status = host_switch(&m->h, r, &m->jobs->jobs[k].s);
    // What creates and compiles is not to be timed; for the slow, the warm-up frame has to do.
    if (status == FG_OK && !slow)
        status = renderer_frame(r, 0);
    if (status == FG_OK)
        status = timing_run(t, m->h.device, r, 0, slow ? 1 : m->budget->frames);
    if (status == FG_OK && (once || number + 1 == m->budget->visits))
        complete_record(m, r, k);
    return status;
}

static fg_status measure_time(measure *m)
{
    const setting none = { 0 };
    renderer *r = NULL;
    const renderer_desc desc = host_renderer_desc(&m->h, &none, m->width, m->height);
    fg_status status = host_renderer(&m->h, &desc, &r);
    for (int v = 0; v < m->budget->visits && status == FG_OK; ++v)
        for (int k = 0; k < m->jobs->count && status == FG_OK; ++k) {
            cli_progress("times", (v + (double) k / m->jobs->count) / m->budget->visits);
            if (m->records[k])
                status = visit(m, r, k, v);
        }
    cli_progress("times", 1);
    renderer_destroy(r);
    return status;
}

// ---- scenes ----------------------------------------------------------------------------------

// An empty record for each job that is this shard's and that the scene serves.
static fg_status choose_jobs(measure *m)
{
    const options *o = m->h.o;
    cJSON *not_served = cJSON_GetObjectItem(m->scene, "not_served");
    for (int k = 0; k < m->jobs->count; ++k) {
        const job *j = &m->jobs->jobs[k];
        const char *lacks;
        if (o->shards && (m->scene_number * m->jobs->count + k + 1 - o->shard) % o->shards)
            continue;
        if (host_serves(&m->h, j->s.plugin, &lacks)) {
            m->records[k] = cJSON_CreateObject();
            const fg_status status =
                timing_create(m->budget->visits * m->budget->frames, &m->timings[k]);
            if (status != FG_OK)
                return status;
        } else if (j->base) {
            cJSON *entry = cJSON_CreateObject();
            cJSON_AddStringToObject(entry, "plugin", j->s.plugin->name);
            cJSON_AddStringToObject(entry, "lacks", lacks);
            cJSON_AddItemToArray(not_served, entry);
        }
    }
    return FG_OK;
}

static fg_status measure_jobs(measure *m, const truths *t)
{
    fg_status status = choose_jobs(m);
    if (status == FG_OK)
        status = measure_error(m, t);
    if (status == FG_OK)
        status = measure_time(m);
    cJSON *records = cJSON_GetObjectItem(m->doc, "records");
    for (int k = 0; k < m->jobs->count; ++k) {
        if (status == FG_OK && m->records[k])
            cJSON_AddItemToArray(records, m->records[k]);
        else
            cJSON_Delete(m->records[k]);
        m->records[k] = NULL;
        timing_finish(&m->timings[k]);
    }
    return status;
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
    code = truths_render(&m->h, &desc, &t);
    if (code == EXIT_DONE)
        code = cli_status(m->h.c, measure_jobs(m, &t));
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
    if (o->shards)
        cJSON_AddItemToObject(doc, "shard",
                              cJSON_CreateIntArray((int[]){ o->shard, o->shards }, 2));
    else
        cJSON_AddNullToObject(doc, "shard");
    cJSON_AddItemToObject(doc, "device", record_device(&m->h));
    cJSON_AddArrayToObject(doc, "notes");
    cJSON_AddArrayToObject(doc, "scenes");
    cJSON_AddArrayToObject(doc, "records");
    return doc;
}

static int measure_scenes(measure *m, const job_list *jobs)
{
    static const char *const defaults[] = { "cornell", "atrium" };
    const options *o = m->h.o;
    const int count = o->operand_count ? o->operand_count : FG_COUNT(defaults);
    int code = EXIT_DONE;
    m->jobs = jobs;
    m->timings = calloc((size_t) jobs->count, sizeof *m->timings);
    m->records = calloc((size_t) jobs->count, sizeof(cJSON *));
    m->estimate = calloc((size_t) jobs->count, sizeof *m->estimate);
    if (!m->timings || !m->records || !m->estimate)
        code = cli_status(m->h.c, FG_ERR_MEMORY);
    for (int i = 0; i < count && code == EXIT_DONE; ++i) {
        m->scene_number = i;
        code = measure_scene(m, o->operand_count ? o->operands[i] : defaults[i]);
    }
    free(m->timings);
    free(m->records);
    free(m->estimate);
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
        code = cli_status(c, jobs_build(o, plugins, count, full, &jobs));
    if (code == EXIT_DONE)
        code = host_open_device(&m.h);
    if (code == EXIT_DONE)
        code = check_size(&m);
    if (code == EXIT_DONE) {
        m.doc = new_document(&m);
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
