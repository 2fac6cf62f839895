// SPDX-License-Identifier: MIT
// What the gather costs a pair of pixel and VPL, and how much more the exact form factor of near
// patches costs than the disc. Both gathers are in every frame, in two graphs in turn, which run
// them in the one and in the other order.
//
//     bench_gather [EDGE [VPLS]]    pixels along an edge (128); VPL blocks along an edge (32)
#include <epoxy/gl.h>
#include <fg/device.h>
#include <pass/gather.h>
#include <pass/gbuffer.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes.h"

enum { MAP = 256, WARM = 3, FRAMES = 11, SIDES = 2, ORDERS = 2 };

static const char *const names[SIDES] = { "footprint.gather", "disc.gather" };

typedef struct side_by_side {
    fg_graph *graph;
    ag_gbuffer_pass gbuffer;
    ag_rsm_pass rsm;
    ag_vpl_pass vpl;
    ag_gather_pass gathers[SIDES];
} side_by_side;

typedef struct bench {
    fg_gl_context *context;
    fg_device *device;
    ag_scene *scene;
    ag_gpu_scene *gpu;
    int edge, grid;
    side_by_side orders[ORDERS];
    double ms[SIDES][ORDERS * FRAMES];
    int count[SIDES];
} bench;

static void print(void *user, fg_log_level level, const char *msg)
{
    (void) user, (void) level;
    fprintf(stderr, "bench_gather: %s\n", msg);
}

static const fg_log to_stderr = { .fn = print, .level = FG_LOG_WARN };

static fg_status declare(bench *b, int order)
{
    side_by_side *s = &b->orders[order];
    const fg_frame_desc frame = { b->edge, b->edge, b->scene->features, ag_feature_names,
                                  AG_FEATURE_COUNT };
    const ag_rsm_desc rsm = { .prefix = "map", .size = MAP };
    const ag_vpl_desc vpl = { .prefix = "map", .pattern = AG_VPL_REGULAR, .grid = b->grid };
    const ag_gather_desc sides[SIDES] = {
        { .prefix = "footprint", .clamp = AG_CLAMP_FOOTPRINT },
        { .prefix = "disc", .clamp = AG_CLAMP_DISC },
    };
    fg_graph *g = fg_graph_create(&(fg_graph_desc){ .device = b->device, .log = &to_stderr });
    s->graph = g;
    if (!g)
        return FG_ERR_MEMORY;
    fg_graph_begin(g, &frame);
    const ag_scene_res res = ag_gpu_scene_import(b->gpu, g);
    ag_gbuffer_declare(&s->gbuffer, g, b->gpu, &res);
    ag_rsm_declare(&s->rsm, g, b->gpu, &res, &rsm);
    ag_vpl_declare(&s->vpl, g, &s->rsm, &vpl);
    for (int i = 0; i < SIDES; i++) {
        const int side = i ^ order;
        ag_gather_declare(&s->gathers[side], g, &res, &s->gbuffer.out, &s->vpl, &sides[side]);
        fg_export(g, s->gathers[side].out);
    }
    fg_export(g, s->vpl.count);
    return fg_graph_compile(g);
}

static fg_status create(bench *b)
{
    ag_view view;
    fg_status s = fg_gl_context_create(&(fg_gl_context_desc){ .log = &to_stderr }, &b->context);
    if (!s)
        s = fg_gl_device_create(&(fg_gl_device_desc){ .log = &to_stderr }, &b->device);
    if (!s)
        s = scenes_open(&to_stderr, "cornell", &b->scene);
    if (!s)
        s = ag_gpu_scene_create(&(ag_gpu_scene_desc){ &to_stderr, b->device, b->scene, 0 },
                                &b->gpu);
    if (!s)
        s = ag_view_from_camera(&to_stderr, &b->scene->cameras[0], b->edge, b->edge, &view);
    if (!s)
        s = ag_gpu_scene_update(b->gpu, &view);
    for (int i = 0; i < ORDERS && !s; i++)
        s = declare(b, i);
    return s;
}

static void destroy(bench *b)
{
    for (int i = 0; i < ORDERS; i++)
        fg_graph_destroy(b->orders[i].graph);
    ag_gpu_scene_destroy(b->gpu);
    ag_scene_destroy(b->scene);
    fg_device_destroy(b->device);
    fg_gl_context_destroy(b->context);
}

// The frame's GPU times come back some frames late: those of any frame after warming up count.
static void take(bench *b, const fg_graph *g)
{
    fg_timing t;
    for (int i = 0; fg_graph_timing(g, i, &t); i++)
        for (int side = 0; side < SIDES; side++)
            if (!strcmp(t.pass, names[side]) && t.gpu_ms > 0)
                b->ms[side][b->count[side]++] = t.gpu_ms;
}

static fg_status measure(bench *b)
{
    fg_status s = FG_OK;
    for (int i = 0; i < WARM + FRAMES && !s; i++)
        for (int order = 0; order < ORDERS && !s; order++) {
            s = fg_graph_run(b->orders[order].graph);
            glFinish();
            if (i >= WARM)
                take(b, b->orders[order].graph);
        }
    return s;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

static double median(double *values, int count)
{
    qsort(values, (size_t) count, sizeof *values, ascending);
    return count ? values[count / 2] : 0;
}

static void report(bench *b)
{
    uint32_t vpls[4] = { 0 };
    const side_by_side *s = &b->orders[0];
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(fg_graph_exported(s->graph, s->vpl.count), 0, sizeof vpls, vpls);
    const double mpairs = 1e-6 * b->edge * b->edge * vpls[0];
    const double footprint = median(b->ms[0], b->count[0]), disc = median(b->ms[1], b->count[1]);
    if (!(disc > 0) || !(mpairs > 0)) {
        fprintf(stderr, "bench_gather: no times came back\n");
        return;
    }
    printf("BENCH rsm.footprint_over_disc cornell %dx%d %.3f x\n", b->edge, b->edge,
           footprint / disc);
    printf("BENCH gather.ms_per_mpair cornell %dx%d %.5f ms\n", b->edge, b->edge,
           footprint / mpairs);
    printf("BENCH gather.disc_ms_per_mpair cornell %dx%d %.5f ms\n", b->edge, b->edge,
           disc / mpairs);
}

int main(int argc, char **argv)
{
    static bench b;
    b.edge = argc > 1 ? atoi(argv[1]) : 128;
    b.grid = argc > 2 ? atoi(argv[2]) : 32;
    fg_status s = create(&b);
    if (!s)
        s = measure(&b);
    if (!s)
        report(&b);
    else
        fprintf(stderr, "bench_gather: %s\n", fg_status_name(s));
    destroy(&b);
    return s || !b.count[0] ? 1 : 0;
}
