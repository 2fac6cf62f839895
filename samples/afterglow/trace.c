// SPDX-License-Identifier: MIT
#include "trace.h"

#include "file.h"

#include <fg/trace.h>
#include <stdlib.h>

struct trace {
    const fg_log *log;
    file out;
    fg_trace *events;
    bool lost; // out of memory, logged
};

fg_status trace_create(const fg_log *log, const char *path, trace **out)
{
    *out = NULL;
    if (!path)
        return FG_OK;
    trace *t = calloc(1, sizeof *t);
    if (!t) {
        fg_logf(log, FG_LOG_ERROR, "trace: out of memory");
        return FG_ERR_MEMORY;
    }
    t->log = log;
    fg_status status = file_begin(log, path, &t->out);
    if (status == FG_OK) {
        t->events = fg_trace_create(&(fg_trace_desc){ .log = log, .process = "afterglow" });
        status = t->events ? FG_OK : FG_ERR_MEMORY;
        if (status != FG_OK)
            (void) !file_end(log, &t->out, false);
    }
    if (status != FG_OK) {
        free(t);
        return status;
    }
    *out = t;
    return FG_OK;
}

static void take_text(trace *t)
{
    size_t size;
    const char *text = t->lost ? NULL : fg_trace_text(t->events, &size);
    if (text)
        fwrite(text, 1, size, t->out.stream); // file_end() asks whether all went well
    t->lost = !text;
}

void trace_frame(trace *t, renderer *r)
{
    char shows[96];
    if (!t)
        return;
    const gi_plugin *first = renderer_plugin(r, 0), *second = renderer_plugin(r, 1);
    snprintf(shows, sizeof shows, "%s%s%s", first ? first->name : "none", second ? " | " : "",
             second ? second->name : "");
    fg_trace_frame(t->events, renderer_graph(r), shows);
    take_text(t);
}

void trace_mark(trace *t, const char *name)
{
    if (t)
        fg_trace_mark(t->events, name);
}

fg_status trace_finish(trace *t, fg_device *device, renderer *r, bool keep)
{
    if (!t)
        return FG_OK;
    fg_status status = FG_OK;
    if (keep && r) {
        status = fg_gl_finish(device);
        trace_frame(t, r);
    }
    fg_trace_end(t->events);
    take_text(t);
    if (status == FG_OK && t->lost)
        status = FG_ERR_MEMORY;
    const fg_status written = file_end(t->log, &t->out, keep && status == FG_OK);
    fg_trace_destroy(t->events);
    free(t);
    return status != FG_OK ? status : written;
}
