// SPDX-License-Identifier: MIT
#include "graph_priv.h"

#include <string.h>
#include <time.h>

// Every consumer: after another plan's writes, or a pass that is off.
enum { ALL_BITS = 2 * FG_BARRIER_COPY - 1 };

int64_t fg_now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t) t.tv_sec * 1000000000 + t.tv_nsec;
}

// ---- one pass ---------------------------------------------------------------------------

static void clear_resources(fg_graph *g, uint32_t step, unsigned when)
{
    const plan *p = g->plan;
    for (uint32_t i = p->step[step].clear; i < p->step[step + 1].clear; i++) {
        const clear_rec *c = &p->clear[i];
        if (!(c->flags & when))
            continue;
        const res_rec *r = &g->built->res[c->res];
        const fg_tex_desc tex = fg_tex_desc_of(r);
        fg_clear clear = fg_whole_clear(r, &tex, p->res[c->res].object);
        clear.mip = c->mip;
        clear.mips = c->mips;
        clear.layer = c->layer;
        clear.layers = c->layers;
        clear.poison = (c->flags & CLEAR_POISON) != 0;
        if (c->value != NONE)
            memcpy(clear.value, g->built->clear[c->value].rgba, sizeof clear.value);
        g->device->ops->clear(g->device, &clear);
    }
}

static uint64_t mix(uint64_t key, uint64_t word)
{
    key = (key ^ word) * 0xff51afd7ed558ccdu;
    return key ^ key >> 32;
}

static void attach(fg_graph *g, const io_rec *io, fg_pass_begin *begin)
{
    const res_rec *r = &g->built->res[io->res];
    const res_plan *rp = &g->plan->res[io->res];
    const bool array = r->layers || r->depth;
    fg_attachment *a =
        io->use == FG_USE_DEPTH ? &begin->depth : &begin->color[begin->color_count++];
    a->object = io->flags & IO_LAST ? rp->last_object : rp->object;
    a->mip = io->mip;
    a->layer = io->layer;
    a->layers = io->layers;
    a->layered = array && io->layers > 1;
    if (io->use == FG_USE_DEPTH)
        begin->depth_read_only = !(io->flags & IO_WRITE);
    begin->width = r->width >> io->mip ? r->width >> io->mip : 1;
    begin->height = r->height >> io->mip ? r->height >> io->mip : 1;
    const uint64_t place = (uint64_t) io->mip << 33 | (uint64_t) io->layer << 17 |
                           (uint64_t) io->layers << 1 | (io->use == FG_USE_DEPTH);
    begin->framebuffer_key = mix(mix(begin->framebuffer_key, a->object), place);
}

// Only attachments that are counted or have an object mean anything.
static void describe(fg_graph *g, uint32_t step, fg_pass_begin *begin)
{
    const decl *d = g->built;
    const pass_rec *p = &d->pass[g->plan->step[step].pass];
    begin->name = d->text + p->name;
    begin->timer = (int) step;
    begin->kind = (fg_kind) p->kind;
    begin->color_count = 0;
    begin->depth.object = 0;
    begin->depth_read_only = false;
    begin->width = begin->height = 0;
    begin->framebuffer_key = 0;
    if (p->kind != FG_KIND_RASTER)
        return;
    const io_rec *io = &d->io[p->io];
    for (int k = 0; k < p->reads + p->writes; k++)
        if ((io[k].use == FG_USE_COLOR || io[k].use == FG_USE_DEPTH) &&
            !g->plan->absent[p->io + (uint32_t) k])
            attach(g, &io[k], begin);
}

static void inspect(fg_graph *g, uint32_t pass)
{
    const decl *d = g->built;
    const pass_rec *p = &d->pass[pass];
    for (uint32_t k = p->io + p->reads; k < p->io + p->reads + p->writes; k++) {
        const io_rec *io = &d->io[k];
        const res_rec *r = &d->res[io->res];
        const bool texture = r->flags & RES_TEXTURE;
        const fg_tex_desc tex = fg_tex_desc_of(r);
        const fg_buf_desc buf = { .size = r->bytes, .history = (fg_history) r->history };
        const fg_written written = {
            .pass = d->text + p->name,
            .resource = d->text + r->name,
            .tex = texture ? &tex : NULL,
            .buf = texture ? NULL : &buf,
            .object = g->plan->res[io->res].object,
            .mip = io->mip,
            .mips = io->mips,
            .layer = io->layer,
            .layers = io->layers,
        };
        g->inspect(g->inspect_user, &written);
    }
}

static fg_status run_pass(fg_graph *g, uint32_t step, fg_pass_begin *begin)
{
    const fg_device_ops *ops = g->device->ops;
    const uint32_t pass = g->plan->step[step].pass;
    const callback *call = &g->built->callback[pass];
    fg_run run = { .graph = g, .pass = pass, .step = step };
    describe(g, step, begin);
    fg_status status = ops->pass_begin(g->device, begin);
    if (status != FG_OK) {
        fg_logf(g->log, FG_LOG_ERROR, "pass '%s': the device cannot begin it: %s", begin->name,
                fg_status_name(status));
        return status;
    }
    status = call->run(&run, call->user);
    ops->pass_end(g->device, begin);
    if (status != FG_OK)
        fg_logf(g->log, FG_LOG_ERROR, "pass '%s' failed: %s", begin->name, fg_status_name(status));
    else if (g->disturbed)
        status = FG_ERR_INVALID;
    else
        status = run.status;
    if (status == FG_OK && g->inspect)
        inspect(g, pass);
    return status;
}

// A pass that is off: what it was to make first gets its clear value, the rest stays.
static void skip_pass(fg_graph *g, uint32_t step)
{
    if (g->plan->incoherent)
        g->device->ops->barrier(g->device, ALL_BITS); // those of its own accesses, and more
    clear_resources(g, step, CLEAR_IF_OFF);
}

static fg_status run_step(fg_graph *g, uint32_t step, fg_pass_begin *begin)
{
    const fg_device_ops *ops = g->device->ops;
    const step_rec *s = &g->plan->step[step];
    if (s->off) {
        skip_pass(g, step);
        return FG_OK;
    }
    if (s->clear_bits)
        ops->barrier(g->device, s->clear_bits);
    if (s->clears)
        clear_resources(g, step, CLEAR_IF_ON);
    if (s->bits)
        ops->barrier(g->device, s->bits);
    return run_pass(g, step, begin);
}

// ---- the frame ----------------------------------------------------------------------------

static fg_status run_steps(fg_graph *g)
{
    fg_pass_begin begin;
    memset(&begin, 0, sizeof begin);
    const bool timed = g->device->ops->timing;
    int64_t before = timed ? fg_now_ns() : 0;
    g->time_count = 0;
    for (uint32_t i = 0; i < g->plan->step_count; i++) {
        const fg_status status = run_step(g, i, &begin);
        if (status != FG_OK)
            return status;
        if (!timed)
            continue;
        const int64_t after = fg_now_ns();
        g->time[i] = (step_time){ before, after };
        before = after;
    }
    g->time_count = timed ? g->plan->step_count : 0;
    const step_rec *end = &g->plan->step[g->plan->step_count];
    if (end->clear != end[1].clear && g->plan->incoherent)
        g->device->ops->barrier(g->device, FG_BARRIER_COPY);
    clear_resources(g, g->plan->step_count, CLEAR_IF_ON);
    return FG_OK;
}

static fg_status run_frame(fg_graph *g)
{
    const fg_device_ops *ops = g->device->ops;
    if (g->swap_due)
        fg_history_swap(g);
    g->swap_due = false;
    fg_status status = g->bound ? FG_OK : fg_bind(g);
    if (status != FG_OK)
        return status;
    status = ops->frame_begin(g->device, g->frame, (int) g->plan->step_count);
    if (status != FG_OK) {
        fg_logf(g->log, FG_LOG_ERROR, "graph: the device cannot begin a frame: %s",
                fg_status_name(status));
        return status;
    }
    if (g->after_incoherent)
        ops->barrier(g->device, ALL_BITS);
    g->after_incoherent = false;
    status = run_steps(g);
    const fg_status end = ops->frame_end(g->device);
    if (status == FG_OK && end != FG_OK)
        fg_logf(g->log, FG_LOG_ERROR, "graph: the device cannot end a frame: %s",
                fg_status_name(end));
    return status != FG_OK ? status : end;
}

fg_status fg_graph_run(fg_graph *g)
{
    if (g->running || !g->compiled)
        return fg_misuse(g, "fg_graph_run",
                         g->running ? "while the graph runs" : "before a graph has compiled");
    g->running = true;
    g->disturbed = false;
    const bool timed = g->device->ops->timing;
    g->run_begin = timed ? fg_now_ns() : 0;
    const fg_status status = run_frame(g);
    g->run_end = timed ? fg_now_ns() : 0;
    g->running = false;
    g->frame++;
    g->ran |= g->bound;
    g->swap_due = status == FG_OK;
    // A frame cut short leaves its barriers behind.
    g->after_incoherent |= status != FG_OK && g->plan->incoherent;
    return status;
}

uint32_t fg_graph_exported(const fg_graph *g, fg_res res)
{
    if (!g->compiled || !g->ran || !fg_epoch_built(g, res.epoch))
        return 0;
    for (uint32_t i = 0; i < g->built->export_count; i++) {
        const export_rec *e = &g->built->exports[i];
        if (e->res + 1 == res.id && e->version == res.version)
            return g->plan->res[e->res].object;
    }
    return 0;
}

// ---- what a pass may ask ----------------------------------------------------------------

// The access of this pass that `res` names; NULL, and the frame fails, if there is none.
static const io_rec *access_of(const fg_run *run, fg_res res, bool any_version)
{
    const fg_graph *g = run->graph;
    const decl *d = g->built;
    const pass_rec *p = &d->pass[run->pass];
    const io_rec *io = &d->io[p->io];
    const bool fresh = fg_epoch_built(g, res.epoch);
    if (fresh)
        for (int k = 0; k < p->reads + p->writes; k++)
            if (io[k].res + 1 == res.id && (any_version || io[k].version == res.version))
                return &io[k];
    const char *name = d->text + p->name;
    ((fg_run *) run)->status = FG_ERR_INVALID;
    if (!res.id)
        fg_logf(g->log, FG_LOG_ERROR, "pass '%s' asks for the null handle", name);
    else if (!fresh)
        fg_logf(g->log, FG_LOG_ERROR,
                "pass '%s' asks for resource %u by a stale handle, of another declaration", name,
                res.id);
    else
        fg_logf(g->log, FG_LOG_ERROR,
                "pass '%s' asks for version %u of '%s', which it did not declare", name,
                res.version, res.id - 1 < d->res_count ? res_name(d, res.id - 1) : "no resource");
    return NULL;
}

static bool null_allowed(const fg_run *run, fg_res res)
{
    return !res.id && run->graph->built->pass[run->pass].flags & PASS_ABSENT;
}

uint32_t fg_run_object(const fg_run *run, fg_res res)
{
    const fg_graph *g = run->graph;
    if (null_allowed(run, res))
        return 0;
    const io_rec *io = access_of(run, res, false);
    if (!io || g->plan->absent[io - g->built->io])
        return 0;
    const res_plan *r = &g->plan->res[io->res];
    return io->flags & IO_LAST ? r->last_object : r->object;
}

void fg_run_size(const fg_run *run, fg_res res, int mip, int size[3])
{
    size[0] = size[1] = size[2] = 0;
    const io_rec *io = null_allowed(run, res) ? NULL : access_of(run, res, true);
    if (!io)
        return;
    const res_rec *r = &run->graph->built->res[io->res];
    const int full[3] = { r->width, r->height, r->depth };
    if (!(r->flags & RES_TEXTURE)) {
        size[0] = r->bytes > INT32_MAX ? INT32_MAX : (int) r->bytes;
        return;
    }
    for (int i = 0; i < 3; i++)
        size[i] = mip < 0 || mip >= r->mips ? 0 : full[i] >> mip > 1 ? full[i] >> mip : 1;
    if (!r->depth)
        size[2] = (int) sub_layers(r);
}

bool fg_run_history_valid(const fg_run *run, fg_res res)
{
    if (null_allowed(run, res))
        return false;
    const io_rec *io = access_of(run, res, true);
    return io && fg_history_is_valid(run->graph, io->res);
}

fg_device *fg_run_device(const fg_run *run)
{
    return run->graph->device;
}

const char *fg_run_pass(const fg_run *run)
{
    return pass_name(run->graph->built, run->pass);
}

uint64_t fg_run_frame(const fg_run *run)
{
    return run->graph->frame;
}

bool fg_graph_timing(const fg_graph *g, int i, fg_timing *out)
{
    if (!g->compiled || i < 0 || (uint32_t) i >= g->plan->step_count)
        return false;
    *out = (fg_timing){ .pass = fg_graph_pass(g, i), .gpu_ms = -1 };
    double start, ms;
    uint64_t frame;
    // Before its first run the device still has the timings of the graph before.
    if (g->bound && g->device->ops->timing &&
        g->device->ops->timing(g->device, i, &start, &ms, &frame)) {
        out->gpu_start_ms = start;
        out->gpu_ms = ms;
        out->frame = frame;
    }
    if ((uint32_t) i < g->time_count) {
        out->cpu_start_ms = (double) (g->time[i].begin - g->run_begin) * 1e-6;
        out->cpu_ms = (double) (g->time[i].end - g->time[i].begin) * 1e-6;
    }
    return true;
}
