// SPDX-License-Identifier: MIT
#include "gl_priv.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static void forget_results(const gl_timers *t, gl_timer_result *results)
{
    if (results)
        memset(results, 0, (size_t) t->capacity * sizeof *results);
}

void gl_timers_forget(gl_device *d)
{
    gl_timers *t = &d->timers;
    for (int i = 0; i < GL_TIMER_FRAMES; ++i) {
        t->frames[i].last = 0;
        if (t->frames[i].issued)
            memset(t->frames[i].issued, 0, (size_t) t->capacity * sizeof *t->frames[i].issued);
        forget_results(t, t->frames[i].results);
    }
    forget_results(t, t->results);
    t->current = -1;
}

void gl_timers_destroy(gl_device *d)
{
    gl_timers *t = &d->timers;
    const gl_timers kept = { .on_cpu = t->on_cpu, .clock_ahead = t->clock_ahead, .current = -1 };
    for (int i = 0; i < GL_TIMER_FRAMES; ++i) {
        if (t->frames[i].queries)
            glDeleteQueries(2 * t->capacity, t->frames[i].queries);
        free(t->frames[i].queries);
        free(t->frames[i].issued);
        free(t->frames[i].results);
    }
    free(t->results);
    *t = kept;
}

// Called in the first frame after a compile that brought more passes; what is under way is lost.
static fg_status grow(gl_device *d, int timers)
{
    gl_timers *t = &d->timers;
    int capacity = 32;

    while (capacity < timers)
        capacity *= 2;
    gl_timers_destroy(d);
    const size_t n = (size_t) capacity;
    t->results = calloc(n, sizeof *t->results);
    bool ok = t->results != NULL;
    for (int i = 0; i < GL_TIMER_FRAMES; ++i) {
        gl_timer_frame *f = &t->frames[i];
        f->queries = calloc(2 * n, sizeof *f->queries);
        f->issued = calloc(n, sizeof *f->issued);
        f->results = calloc(n, sizeof *f->results);
        ok = ok && f->queries && f->issued && f->results;
    }
    t->capacity = ok ? capacity : 0;
    if (!ok) {
        gl_timers_destroy(d);
        fg_logf(d->log, FG_LOG_ERROR, "gl device: out of memory for %d timers", timers);
        return FG_ERR_MEMORY;
    }
    for (int i = 0; i < GL_TIMER_FRAMES; ++i)
        glCreateQueries(GL_TIMESTAMP, 2 * capacity, t->frames[i].queries);
    return FG_OK;
}

static uint64_t query_ns(GLuint query)
{
    GLuint64 ns = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &ns);
    return ns;
}

static void read_frame(gl_timers *t, gl_timer_frame *f)
{
    uint64_t first = UINT64_MAX;
    for (int i = 0; i < t->capacity; ++i) {
        if (!f->issued[i])
            continue;
        const GLuint *pair = f->queries + 2 * (size_t) i;
        const uint64_t begin = query_ns(pair[0]), end = query_ns(pair[1]);
        first = begin < first ? begin : first;
        f->results[i] = (gl_timer_result){
            .begin = begin, .end = end > begin ? end : begin, .frame = f->frame, .valid = true
        };
    }
    for (int i = 0; i < t->capacity; ++i) {
        f->results[i].first = first;
        if (f->issued[i])
            t->results[i] = f->results[i];
        f->issued[i] = false;
    }
    f->last = 0;
}

void gl_timers_collect(gl_device *d)
{
    gl_timers *t = &d->timers;
    for (int i = 0; i < GL_TIMER_FRAMES; ++i) {
        // Oldest first: the ring's next place holds it.
        const int place = (t->next + i) % GL_TIMER_FRAMES;
        gl_timer_frame *f = &t->frames[place];
        GLuint there = 0;
        if (!f->last || place == t->current)
            continue;
        glBindBuffer(GL_QUERY_BUFFER, 0); // the host's would take what is read here
        glGetQueryObjectuiv(f->last, GL_QUERY_RESULT_AVAILABLE, &there);
        if (!there)
            return; // what came later is not there either
        read_frame(t, f);
    }
}

fg_status gl_timers_begin_frame(gl_device *d, uint64_t frame, int timers)
{
    gl_timers *t = &d->timers;
    if (timers > t->capacity) {
        const fg_status status = grow(d, timers);
        if (status)
            return status;
    }
    gl_timers_collect(d);
    t->current = -1;
    t->frame = frame;
    t->frame_ns = 0;
    if (t->on_cpu || timers == 0 || t->frames[t->next].last)
        return FG_OK; // the GPU is further behind than the ring is long: no timing of this frame
    t->current = t->next;
    t->next = (t->next + 1) % GL_TIMER_FRAMES;
    t->frames[t->current].frame = frame;
    forget_results(t, t->frames[t->current].results);
    return FG_OK;
}

void gl_timers_end_frame(gl_device *d)
{
    d->timers.current = -1;
}

static uint64_t clock_ns(void)
{
    struct timespec clock;
    clock_gettime(CLOCK_MONOTONIC, &clock);
    return (uint64_t) clock.tv_sec * 1000000000u + (uint64_t) clock.tv_nsec;
}

// The GPU's clock is read between two readings of the CPU's; the closest of some is taken.
void gl_timers_set_clock(gl_device *d)
{
    enum { TRIES = 5 };
    uint64_t closest = UINT64_MAX;
    for (int i = 0; i < TRIES && !d->timers.on_cpu; ++i) {
        GLint64 gpu = 0;
        const uint64_t before = clock_ns();
        glGetInteger64v(GL_TIMESTAMP, &gpu);
        const uint64_t apart = clock_ns() - before;
        if (apart < closest) {
            closest = apart;
            d->timers.clock_ahead = (int64_t) (before + apart / 2) - (int64_t) gpu;
        }
    }
}

// A software renderer puts timestamps into its rasteriser's queue, past which compute shaders run:
// their passes would take no time. The CPU is the device then, so that waiting for it at both ends
// of a pass idles nothing.
static void mark_on_cpu(gl_timers *t, int timer, bool end)
{
    glFinish();
    const uint64_t now = clock_ns();
    if (!t->frame_ns)
        t->frame_ns = now;
    if (!end)
        t->pass_ns = now;
    else
        t->results[timer] = (gl_timer_result){
            .begin = t->pass_ns, .end = now, .first = t->frame_ns, .frame = t->frame, .valid = true
        };
}

void gl_timers_mark(gl_device *d, int timer, bool end)
{
    gl_timers *t = &d->timers;
    if (t->on_cpu && timer >= 0 && timer < t->capacity) {
        mark_on_cpu(t, timer, end);
        return;
    }
    if (t->current < 0 || timer < 0 || timer >= t->capacity)
        return;
    gl_timer_frame *f = &t->frames[t->current];
    const GLuint query = f->queries[2 * (size_t) timer + end];
    glQueryCounter(query, GL_TIMESTAMP);
    if (end) {
        f->issued[timer] = true;
        f->last = query;
    }
}

bool gl_timers_read(fg_device *dev, int timer, double *start_ms, double *ms, uint64_t *frame)
{
    const gl_timers *t = &((gl_device *) dev)->timers;
    if (timer < 0 || timer >= t->capacity || !t->results[timer].valid)
        return false;
    const gl_timer_result *r = &t->results[timer];
    *start_ms = (double) (r->begin - r->first) * 1e-6;
    *ms = (double) (r->end - r->begin) * 1e-6;
    *frame = r->frame;
    return true;
}

bool gl_timers_of(fg_device *dev, int timer, uint64_t frame, int64_t *begin, int64_t *end)
{
    const gl_timers *t = &((gl_device *) dev)->timers;
    if (timer < 0 || timer >= t->capacity)
        return false;
    const gl_timer_result *r = &t->results[timer];
    for (int i = 0; i < GL_TIMER_FRAMES && !(r->valid && r->frame == frame); ++i)
        r = &t->frames[i].results[timer];
    if (!r->valid || r->frame != frame)
        return false;
    *begin = (int64_t) r->begin + t->clock_ahead;
    *end = (int64_t) r->end + t->clock_ahead;
    return true;
}
