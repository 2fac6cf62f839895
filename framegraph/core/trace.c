// SPDX-License-Identifier: MIT
#include "dump_priv.h"

#include <fg/trace.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CPU = 1, GPU = 2 }; // threads of the trace
enum { MAX_WAITING = 16 }; // frames whose GPU times have not come; devices keep fewer
enum { MAX_LABEL = 64 };

struct fg_trace {
    fg_allocator allocator;
    const fg_log *log;
    text text;
    int64_t origin;
    bool taken, ended;
    uint64_t frames; // the number of the last frame that is there, and one more; 0: none
    uint64_t waiting[MAX_WAITING];
    int waiting_count;
    int compiles; // when they ran
    char label[MAX_LABEL], waiting_label[MAX_WAITING][MAX_LABEL];
};

// ---- events -----------------------------------------------------------------------------

// Microseconds with all of the nanoseconds: what lies within stays within.
static void put_us(text *t, const char *key, int64_t ns)
{
    const uint64_t n = ns < 0 ? (uint64_t) -ns : (uint64_t) ns;
    fg_text_put(t, ", \"%s\": %s%llu.%03u", key, ns < 0 ? "-" : "", (unsigned long long) (n / 1000),
                (unsigned) (n % 1000));
}

static void put_head(text *t, const char *process)
{
    fg_text_put(t, "{\"displayTimeUnit\": \"ms\", \"traceEvents\": [\n"
                   "{\"name\": \"process_name\", \"ph\": \"M\", \"pid\": 1, \"args\": {\"name\": ");
    fg_text_string(t, process);
    fg_text_put(t,
                "}},\n{\"name\": \"thread_name\", \"ph\": \"M\", \"pid\": 1, \"tid\": %d, "
                "\"args\": {\"name\": \"CPU\"}},\n"
                "{\"name\": \"thread_name\", \"ph\": \"M\", \"pid\": 1, \"tid\": %d, "
                "\"args\": {\"name\": \"GPU\"}}",
                CPU, GPU);
}

static void put_tail(text *t)
{
    fg_text_put(t, "\n]}\n");
}

// A complete event, closed by the caller's "}".
static void put_event(text *t, const char *name, int thread, int64_t begin, int64_t end)
{
    fg_text_put(t, ",\n{\"name\": ");
    fg_text_string(t, name);
    fg_text_put(t, ", \"ph\": \"X\", \"pid\": 1, \"tid\": %d", thread);
    put_us(t, "ts", begin);
    put_us(t, "dur", end - begin);
}

static void put_pass(text *t, const char *name, int thread, int64_t begin, int64_t end)
{
    put_event(t, name, thread, begin, end);
    fg_text_put(t, "}");
}

// A frame's event, around those of its passes.
typedef struct frame_event {
    uint64_t frame;
    const char *label; // NULL: none
    int thread;
    int64_t begin, end;
} frame_event;

static void put_frame(text *t, const frame_event *e)
{
    char name[32];
    snprintf(name, sizeof name, "frame %llu", (unsigned long long) e->frame);
    put_event(t, name, e->thread, e->begin, e->end);
    fg_text_put(t, ", \"args\": {\"frame\": %llu", (unsigned long long) e->frame);
    if (e->label && *e->label) {
        fg_text_put(t, ", \"shows\": ");
        fg_text_string(t, e->label);
    }
    fg_text_put(t, "}}");
}

// ---- a frame ----------------------------------------------------------------------------

// The last frame on the CPU. Nothing where the device times nothing.
static void put_cpu(const fg_graph *g, const char *label, int64_t origin, text *t)
{
    const frame_event event = { g->frame - 1, label, CPU, g->run_begin - origin,
                                g->run_end - origin };
    if (!g->run_begin)
        return;
    put_frame(t, &event);
    for (uint32_t i = 0; i < g->time_count; i++)
        put_pass(t, fg_graph_pass(g, (int) i), CPU, g->time[i].begin - origin,
                 g->time[i].end - origin);
}

static bool gpu_time(const fg_graph *g, uint32_t step, uint64_t frame, int64_t *begin, int64_t *end)
{
    const fg_device_ops *ops = g->device->ops;
    return ops->time_of && ops->time_of(g->device, (int) step, frame, begin, end);
}

// A frame of the compiled graph on the GPU; false while its times have not come back.
static bool put_gpu(const fg_graph *g, uint64_t frame, const char *label, int64_t origin, text *t)
{
    int64_t begin, end;
    frame_event event = { frame, label, GPU, INT64_MAX, INT64_MIN };
    for (uint32_t i = 0; i < g->plan->step_count; i++) {
        if (!gpu_time(g, i, frame, &begin, &end))
            continue;
        event.begin = begin - origin < event.begin ? begin - origin : event.begin;
        event.end = end - origin > event.end ? end - origin : event.end;
    }
    if (event.begin > event.end)
        return false;
    put_frame(t, &event);
    for (uint32_t i = 0; i < g->plan->step_count; i++)
        if (gpu_time(g, i, frame, &begin, &end))
            put_pass(t, fg_graph_pass(g, (int) i), GPU, begin - origin, end - origin);
    return true;
}

void fg_dump_trace(const fg_graph *g, text *t)
{
    uint64_t newest = 0;
    fg_timing time;
    put_head(t, "frame graph");
    put_cpu(g, NULL, g->run_begin, t);
    for (int i = 0; fg_graph_timing(g, i, &time); i++)
        newest = time.gpu_ms >= 0 && time.frame > newest ? time.frame : newest;
    if (g->bound)
        put_gpu(g, newest, NULL, g->run_begin, t);
    put_tail(t);
}

// ---- many frames ------------------------------------------------------------------------

fg_trace *fg_trace_create(const fg_trace_desc *desc)
{
    fg_trace *t = fg_alloc(&desc->allocator, sizeof *t);
    if (!t) {
        fg_logf(desc->log, FG_LOG_ERROR, "trace: out of memory");
        return NULL;
    }
    memset(t, 0, sizeof *t);
    t->allocator = desc->allocator;
    t->log = desc->log;
    t->text.allocator = &t->allocator;
    t->origin = fg_now_ns();
    put_head(&t->text, desc->process ? desc->process : "frame graph");
    return t;
}

void fg_trace_destroy(fg_trace *t)
{
    if (!t)
        return;
    const fg_allocator allocator = t->allocator;
    fg_release(&allocator, t->text.bytes);
    fg_release(&allocator, t);
}

// To be written to: what was taken goes.
static text *open_text(fg_trace *t)
{
    if (t->taken)
        t->text.size = 0;
    t->taken = false;
    return &t->text;
}

static void put_counters(const fg_graph *g, int64_t now, text *t)
{
    const fg_graph_stats s = fg_graph_get_stats(g);
    fg_text_put(t, ",\n{\"name\": \"memory (bytes)\", \"ph\": \"C\", \"pid\": 1");
    put_us(t, "ts", now);
    fg_text_put(t, ", \"args\": {\"transient\": %llu, \"persistent\": %llu}}",
                (unsigned long long) s.transient_bytes, (unsigned long long) s.persistent_bytes);
}

static void forget_waiting(fg_trace *t, int i)
{
    t->waiting_count--;
    for (; i < t->waiting_count; i++) {
        t->waiting[i] = t->waiting[i + 1];
        memcpy(t->waiting_label[i], t->waiting_label[i + 1], MAX_LABEL);
    }
}

static void add_frame(fg_trace *t, const fg_graph *g)
{
    put_cpu(g, t->label, t->origin, open_text(t));
    put_counters(g, g->run_begin - t->origin, open_text(t));
    if (t->waiting_count == MAX_WAITING)
        forget_waiting(t, 0);
    memcpy(t->waiting_label[t->waiting_count], t->label, MAX_LABEL);
    t->waiting[t->waiting_count++] = g->frame - 1;
    t->frames = g->frame;
}

static void put_mark(fg_trace *t, const char *name, int64_t ns)
{
    text *out = open_text(t);
    fg_text_put(out, ",\n{\"name\": ");
    fg_text_string(out, name);
    fg_text_put(out, ", \"ph\": \"i\", \"s\": \"p\", \"pid\": 1, \"tid\": %d", CPU);
    put_us(out, "ts", ns - t->origin);
    fg_text_put(out, "}");
}

static void set_label(fg_trace *t, const fg_graph *g, const char *label)
{
    char change[2 * MAX_LABEL + 16];
    char now[MAX_LABEL];
    snprintf(now, sizeof now, "%s", label ? label : "");
    if (!strcmp(now, t->label))
        return;
    snprintf(change, sizeof change, "%s%s%s", t->label, *t->label ? " > " : "", now);
    put_mark(t, change, g->run_begin);
    memcpy(t->label, now, sizeof now);
}

void fg_trace_frame(fg_trace *t, const fg_graph *g, const char *label)
{
    if (t->ended || !g->compiled || !g->run_begin)
        return;
    if (t->frames != g->frame) {
        if (t->compiles != g->compiles)
            t->waiting_count = 0; // the device has forgotten them
        t->compiles = g->compiles;
        set_label(t, g, label);
        add_frame(t, g);
    }
    for (int i = 0; i < t->waiting_count && t->compiles == g->compiles;)
        if (put_gpu(g, t->waiting[i], t->waiting_label[i], t->origin, open_text(t)))
            forget_waiting(t, i);
        else
            i++;
}

void fg_trace_mark(fg_trace *t, const char *name)
{
    if (!t->ended)
        put_mark(t, name, fg_now_ns());
}

void fg_trace_count(fg_trace *t, const char *name, double value)
{
    if (t->ended || !isfinite(value))
        return;
    text *out = open_text(t);
    fg_text_put(out, ",\n{\"name\": ");
    fg_text_string(out, name);
    fg_text_put(out, ", \"ph\": \"C\", \"pid\": 1");
    put_us(out, "ts", fg_now_ns() - t->origin);
    fg_text_put(out, ", \"args\": {\"value\": %.17g}}", value);
}

void fg_trace_end(fg_trace *t)
{
    if (!t->ended)
        put_tail(open_text(t));
    t->ended = true;
}

const char *fg_trace_text(fg_trace *t, size_t *size)
{
    text *out = open_text(t);
    t->taken = true;
    *size = out->size;
    if (!out->failed)
        return out->size ? out->bytes : "";
    fg_logf(t->log, FG_LOG_ERROR, "trace: out of memory");
    return NULL;
}
