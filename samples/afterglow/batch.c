// SPDX-License-Identifier: MIT
#include "batch.h"

#include <stdlib.h>

fg_status batch_create(batch *b)
{
    b->records = calloc((size_t) b->count + 1, sizeof(cJSON *));
    b->timings = calloc((size_t) b->count + 1, sizeof *b->timings);
    b->estimate = calloc((size_t) b->count + 1, sizeof *b->estimate);
    if (!b->records || !b->timings || !b->estimate)
        return FG_ERR_MEMORY;
    for (int k = 0; k < b->count; ++k) {
        b->records[k] = cJSON_CreateObject();
        const fg_status status =
            timing_create(b->budget->visits * b->budget->frames, &b->timings[k]);
        if (status != FG_OK)
            return status;
    }
    return FG_OK;
}

void batch_finish(batch *b)
{
    for (int k = 0; k < b->count; ++k) {
        if (b->records)
            cJSON_Delete(b->records[k]);
        if (b->timings)
            timing_finish(&b->timings[k]);
    }
    free(b->records);
    free(b->timings);
    free(b->estimate);
}

// ---- pictures --------------------------------------------------------------------------------

static fg_status run_error_frames(batch *b, renderer *r, int k)
{
    fg_status status = host_switch(b->h, r, &b->jobs[k].s);
    for (int i = 0; i < b->budget->error_frames && status == FG_OK; ++i) {
        const double start = now_ms();
        status = renderer_frame(r, 0);
        if (status == FG_OK)
            status = fg_gl_finish(b->h->device);
        b->estimate[k] = now_ms() - start;
    }
    return status;
}

static fg_status take_pictures(batch *b)
{
    const setting none = { 0 };
    renderer *r = NULL;
    renderer_desc desc = host_renderer_desc(b->h, &none, b->width, b->height);
    desc.layers = 1u << LAYER_INDIRECT;
    desc.strict = true; // figures of direct light under a plugin's name are none
    fg_status status = host_renderer(b->h, &desc, &r);
    for (int k = 0; k < b->count && status == FG_OK; ++k) {
        image result = { 0 };
        cli_progress(b->what, 0.5 * k / b->count);
        if (!b->records[k])
            continue;
        // By way of nothing, so that no setting inherits what the one before has kept.
        status = host_switch(b->h, r, &none);
        if (status == FG_OK)
            status = run_error_frames(b, r, k);
        if (status == FG_OK)
            status = renderer_read(r, LAYER_INDIRECT, &result);
        if (status == FG_OK)
            status = b->judge(b->user, k, r, &result);
        image_finish(&result);
    }
    renderer_destroy(r);
    return status;
}

// ---- run time --------------------------------------------------------------------------------

// The rest of a record, from the renderer as it stands after the last visit.
static void complete_record(batch *b, renderer *r, int k)
{
    const job *j = &b->jobs[k];
    cJSON *run = record_create(b->h, r, &j->s, &b->timings[k], b->width, b->height);
    cJSON *own = b->records[k];
    cJSON_DeleteItemFromObject(run, "error");
    cJSON_AddNumberToObject(run, "index", b->first_index + k);
    cJSON_AddStringToObject(run, "label", j->label);
    cJSON *item;
    while ((item = cJSON_DetachItemFromArray(own, 0)))
        cJSON_AddItemToObject(run, item->string, item);
    cJSON_Delete(own);
    b->records[k] = run;
}

static fg_status visit(batch *b, renderer *r, int k, int number)
{
    timing *t = &b->timings[k];
    const double last = t->count ? t->frame[t->count - 1] : b->estimate[k];
    const bool slow = last > b->budget->slow_ms;
    const bool once = b->estimate[k] > b->budget->too_slow_ms;
    if (once && number)
        return FG_OK;
    fg_status status = host_switch(b->h, r, &b->jobs[k].s);
    // What creates and compiles is not to be timed; for the slow, the warm-up frame has to do.
    if (status == FG_OK && !slow)
        status = renderer_frame(r, 0);
    if (status == FG_OK)
        status = timing_run(t, b->h->device, r, 0, slow ? 1 : b->budget->frames);
    if (status == FG_OK && (once || number + 1 == b->budget->visits))
        complete_record(b, r, k);
    return status;
}

static fg_status measure_time(batch *b)
{
    const setting none = { 0 };
    renderer *r = NULL;
    renderer_desc desc = host_renderer_desc(b->h, &none, b->width, b->height);
    desc.strict = true;
    fg_status status = host_renderer(b->h, &desc, &r);
    for (int v = 0; v < b->budget->visits && status == FG_OK; ++v)
        for (int k = 0; k < b->count && status == FG_OK; ++k) {
            cli_progress(b->what, 0.5 + 0.5 * (v + (double) k / b->count) / b->budget->visits);
            if (b->records[k])
                status = visit(b, r, k, v);
        }
    cli_progress(b->what, 1);
    renderer_destroy(r);
    return status;
}

fg_status batch_run(batch *b)
{
    const fg_status status = take_pictures(b);
    return status == FG_OK ? measure_time(b) : status;
}
