// SPDX-License-Identifier: MIT
// What isr's gather takes for a pair of texel and VPL, against the same sums as a plain C loop over
// the very same texels and VPLs.
#include "bench_isr.h"

#include "bench_isr_loop.h"

#include <epoxy/gl.h>
#include <gi/eye_rows.h>
#include <pass/gather.h>
#include <pass/gbuffer.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FOOTPRINT, DISC, CLAMPS, WARM = 2, FRAMES = 11 };

static const char *const gathers[CLAMPS] = { "footprint.gather", "disc.gather" };
static const char *const figures[CLAMPS][3] = {
    { "isr.pair_over_c_footprint", "isr.pair_ns_footprint", "isr.pair_ns_c_footprint" },
    { "isr.pair_over_c", "isr.pair_ns", "isr.pair_ns_c" },
};

typedef struct pairs {
    ag_gpu_scene *gpu;
    ag_view view;
    fg_graph *graph;
    ag_gbuffer_pass gbuffer;
    ag_rsm_pass rsm;
    ag_vpl_pass vpl;
    ag_multires_pass eye;
    ag_gather_pass gather[CLAMPS];
    uint32_t texels, vpls; // how many
    uint32_t *list;
    float *position, *normal; // of the G-buffer, 4 a pixel
    ag_vpl *lights;
    float *arrays; // 9 of the loop's
    loop loop;
    int times; // that it runs, so as to take long enough
    samples ms[CLAMPS], c_ms[CLAMPS];
} pairs;

// ---- the passes of isr -----------------------------------------------------------------------

// The thresholds that isr has by default.
static ag_multires_desc default_eye(const bench *b)
{
    const gi_plugin *isr = gi_find(b->registry, "isr");
    ag_multires_desc desc = { 0 };
    const int count = isr ? gi_params_count(isr) : 0;
    gi_value *values = calloc((size_t) count + 1, sizeof *values);
    if (isr && values)
        gi_params_default(isr, values);
    for (int i = 0; values && i + GI_EYE_ROWS <= count; i++)
        if (!strcmp(isr->params[i].name, "depth"))
            desc = gi_eye_desc("eye", values + i, b->size[0], b->size[1]);
    free(values);
    return desc;
}

static fg_status declare(const bench *b, pairs *p)
{
    const ag_multires_desc eye = default_eye(b);
    const ag_gather_desc descs[CLAMPS] = {
        { .prefix = "footprint", .clamp = AG_CLAMP_FOOTPRINT, .multires = &p->eye },
        { .prefix = "disc", .clamp = AG_CLAMP_DISC, .multires = &p->eye },
    };
    fg_graph *g = fg_graph_create(&(fg_graph_desc){ .device = b->device, .log = &b->log });
    p->graph = g;
    if (!eye.prefix)
        return FG_ERR_UNSUPPORTED;
    if (!g)
        return FG_ERR_MEMORY;
    fg_graph_begin(g, &(fg_frame_desc){ b->size[0], b->size[1], ag_gpu_scene_features(p->gpu),
                                        ag_feature_names, AG_FEATURE_COUNT });
    const ag_scene_res res = ag_gpu_scene_import(p->gpu, g);
    ag_gbuffer_declare(&p->gbuffer, g, p->gpu, &res);
    ag_rsm_declare(&p->rsm, g, p->gpu, &res, &(ag_rsm_desc){ .prefix = "map", .size = 256 });
    ag_vpl_declare(&p->vpl, g, &p->rsm,
                   &(ag_vpl_desc){ .prefix = "map", .pattern = AG_VPL_REGULAR, .budget = 256 });
    ag_multires_declare(&p->eye, g, &res, &p->gbuffer.out, &eye);
    for (int i = 0; i < CLAMPS; i++) {
        ag_gather_declare(&p->gather[i], g, &res, &p->gbuffer.out, &p->vpl, &descs[i]);
        fg_export(g, p->gather[i].out);
    }
    const fg_res read[] = {
        p->vpl.vpls,          p->vpl.count, p->eye.texels, p->eye.count, p->gbuffer.out.position,
        p->gbuffer.out.normal
    };
    for (int i = 0; i < FG_COUNT(read); i++)
        fg_export(g, read[i]);
    return fg_graph_compile(g);
}

static fg_status create(const bench *b, pairs *p)
{
    const ag_camera *camera = &b->scene->cameras[b->camera];
    fg_status status = ag_gpu_scene_create(
        &(ag_gpu_scene_desc){ .log = &b->log, .device = b->device, .scene = b->scene }, &p->gpu);
    if (status == FG_OK)
        status = ag_view_from_camera(&b->log, camera, b->size[0], b->size[1], &p->view);
    if (status == FG_OK)
        status = ag_gpu_scene_update(p->gpu, &p->view);
    if (status == FG_OK)
        status = declare(b, p);
    return status == FG_OK ? fg_graph_run(p->graph) : status;
}

static void destroy(pairs *p)
{
    fg_graph_destroy(p->graph);
    ag_gpu_scene_destroy(p->gpu);
    free(p->list);
    free(p->position);
    free(p->normal);
    free(p->lights);
    free(p->arrays);
}

// ---- the same for the loop -------------------------------------------------------------------

static void read_buffer(const pairs *p, fg_res res, size_t size, void *out)
{
    glGetNamedBufferSubData(fg_graph_exported(p->graph, res), 0, (GLsizeiptr) size, out);
}

static fg_status read_back(const bench *b, pairs *p)
{
    uint32_t count[4];
    const size_t pixels = 4 * (size_t) b->size[0] * (size_t) b->size[1];
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    read_buffer(p, p->eye.count, sizeof count, count);
    p->texels = count[0];
    read_buffer(p, p->vpl.count, sizeof count, count);
    p->vpls = count[0];
    p->loop.receivers = (int) (p->texels + LOOP_BLOCK - 1) / LOOP_BLOCK * LOOP_BLOCK;
    p->list = calloc((size_t) p->texels + 1, sizeof *p->list);
    p->lights = calloc((size_t) p->vpls + 1, sizeof *p->lights);
    p->position = malloc(pixels * sizeof(float));
    p->normal = malloc(pixels * sizeof(float));
    p->arrays = calloc(9 * (size_t) p->loop.receivers + 1, sizeof *p->arrays);
    if (!p->list || !p->lights || !p->position || !p->normal || !p->arrays)
        return FG_ERR_MEMORY;
    read_buffer(p, p->eye.texels, p->texels * sizeof *p->list, p->list);
    read_buffer(p, p->vpl.vpls, p->vpls * sizeof *p->lights, p->lights);
    const fg_res maps[] = { p->gbuffer.out.position, p->gbuffer.out.normal };
    float *const to[] = { p->position, p->normal };
    for (int i = 0; i < 2; i++)
        glGetTextureImage(fg_graph_exported(p->graph, maps[i]), 0, GL_RGBA, GL_FLOAT,
                          (GLsizei) (pixels * sizeof(float)), to[i]);
    return FG_OK;
}

// passes/multires/texel.glsl, receiver.glsl: the mean of the four pixels at the texel's middle.
static void add_receiver(const bench *b, pairs *p, int i)
{
    const uint32_t code = p->list[i];
    const int level = (int) (code >> 28), half = level ? 1 << (level - 1) : 0;
    const int x = (int) (code & 0x3fff) << level, y = (int) (code >> 14 & 0x3fff) << level;
    float position[3] = { 0 }, normal[3] = { 0 }, length = 0;
    for (int k = 0; k < (level ? 4 : 1); k++) {
        const int px = level ? x + half - 1 + (k & 1) : x, py = level ? y + half - 1 + (k >> 1) : y;
        const size_t at = 4 * ((size_t) py * (size_t) b->size[0] + (size_t) px);
        for (int c = 0; c < 3; c++) {
            position[c] += p->position[at + (size_t) c] * (level ? 0.25f : 1);
            normal[c] += p->normal[at + (size_t) c] * (level ? 0.25f : 1);
        }
    }
    for (int c = 0; c < 3; c++)
        length += normal[c] * normal[c];
    for (int c = 0; c < 3; c++) {
        p->loop.position[c][i] = position[c] * p->loop.unit;
        p->loop.normal[c][i] = normal[c] / fmaxf(sqrtf(length), 1e-6f);
    }
}

static void prepare_loop(const bench *b, pairs *p)
{
    double diagonal = 0;
    int exponent;
    for (int c = 0; c < 3; c++) {
        const double length = b->scene->box_max[c] - b->scene->box_min[c];
        diagonal += length * length;
    }
    frexp(sqrt(diagonal), &exponent);
    p->loop.unit = ldexpf(1, -exponent);
    p->loop.vpls = p->lights;
    p->loop.vpl_count = (int) p->vpls;
    p->times = (int) (1 + 5e7 / (1 + (double) p->texels * (double) p->vpls));
    for (int c = 0; c < 3; c++) {
        p->loop.position[c] = p->arrays + (size_t) p->loop.receivers * (size_t) c;
        p->loop.normal[c] = p->arrays + (size_t) p->loop.receivers * (size_t) (3 + c);
        p->loop.sum[c] = p->arrays + (size_t) p->loop.receivers * (size_t) (6 + c);
    }
    for (int i = 0; i < (int) p->texels; i++)
        add_receiver(b, p, i);
}

// RMS of the difference of both sides' sums over the RMS: that they compute the same.
static double disagreement(const pairs *p, int clamp)
{
    const ag_pyramid *pyramid = &p->eye.pyramid;
    const size_t width = (size_t) pyramid->size[0], height = (size_t) pyramid->size[1];
    float *values = malloc(4 * width * height * sizeof *values);
    double off = 0, sum = 0;
    if (!values)
        return (double) NAN;
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glGetTextureImage(fg_graph_exported(p->graph, p->gather[clamp].out), 0, GL_RGBA, GL_FLOAT,
                      (GLsizei) (4 * width * height * sizeof *values), values);
    for (uint32_t i = 0; i < p->texels; i++) {
        const uint32_t code = p->list[i];
        int at[2];
        ag_pyramid_origin(pyramid, (int) (code >> 28), at);
        const size_t x = (size_t) at[0] + (code & 0x3fff),
                     y = (size_t) at[1] + (code >> 14 & 0x3fff);
        for (size_t c = 0; c < 3; c++) {
            const double a = (double) values[4 * (y * width + x) + c],
                         l = (double) p->loop.sum[c][i];
            off += (a - l) * (a - l);
            sum += a * a;
        }
    }
    free(values);
    return sqrt(off / fmax(sum, 1e-300));
}

// ---- in turn ---------------------------------------------------------------------------------

static fg_status run_turn(const bench *b, pairs *p)
{
    const int threads = (int) sysconf(_SC_NPROCESSORS_ONLN);
    fg_timing t;
    fg_status status = fg_graph_run(p->graph);
    if (status == FG_OK)
        status = fg_gl_finish(b->device);
    for (int i = 0; status == FG_OK && fg_graph_timing(p->graph, i, &t); i++)
        for (int k = 0; k < CLAMPS; k++)
            if (!strcmp(t.pass, gathers[k]) && t.gpu_ms >= 0)
                samples_add(&p->ms[k], t.gpu_ms);
    for (int k = 0; k < CLAMPS && status == FG_OK; k++) {
        p->loop.footprint = k == FOOTPRINT;
        const double start = bench_now_ms();
        loop_run(&p->loop, threads, p->times);
        samples_add(&p->c_ms[k], (bench_now_ms() - start) / p->times);
    }
    return status;
}

static void print_all(const bench *b, pairs *p)
{
    const double ns = 1e6 / ((double) p->texels * (double) p->vpls);
    for (int k = 0; k < CLAMPS; k++) {
        const double gpu = samples_typical(&p->ms[k]), c = samples_typical(&p->c_ms[k]);
        p->loop.footprint = k == FOOTPRINT;
        loop_run(&p->loop, 1, 1);
        const double off = disagreement(p, k);
        if (b->verbose || !(off < 1e-3))
            fprintf(stderr, "%s: %s: %u texels, %u VPLs: %.2f ms, in C %.2f ms; differ by %.2g\n",
                    b->scene_name, gathers[k], p->texels, p->vpls, gpu, c, off);
        bench_print(b, figures[k][0], b->size, gpu / c, "x");
        bench_print(b, figures[k][1], b->size, gpu * ns, "ns");
        bench_print(b, figures[k][2], b->size, c * ns, "ns");
    }
}

fg_status bench_pairs(const bench *b)
{
    static pairs p;
    p = (pairs){ .texels = 0 };
    if (!bench_wants(b, figures[0][0]) && !bench_wants(b, figures[1][0]) &&
        !bench_wants(b, figures[0][1]) && !bench_wants(b, figures[1][1]))
        return FG_OK;
    fg_status status = create(b, &p);
    if (status == FG_OK)
        status = read_back(b, &p);
    if (status == FG_OK)
        prepare_loop(b, &p);
    for (int i = 0; i < WARM + FRAMES && status == FG_OK; i++) {
        if (i == WARM)
            for (int k = 0; k < CLAMPS; k++)
                p.ms[k].count = p.c_ms[k].count = 0;
        status = run_turn(b, &p);
    }
    if (status == FG_OK)
        print_all(b, &p);
    destroy(&p);
    return status == FG_ERR_UNSUPPORTED ? FG_OK : status;
}
