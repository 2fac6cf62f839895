// SPDX-License-Identifier: MIT
#include "hisr.h"

#include <gi/eye_rows.h>
#include <gi/light_rows.h>
#include <gi/visibility.h>
#include <pass/readback.h>

#include <stdlib.h>

static const char *const bound_names[] = { "patch", "paper", NULL };
static const double tau_sweep[] = { 0.1, 0.03, 0.01, 0.003, 0.001, 0.0003, 0.0001, (double) NAN };

enum {
    RSM_SIZE,
    TAU,
    FINEST,
    BOUND,
    EYE,
    CLAMP = EYE + GI_EYE_ROWS,
    CLAMP_D2,
    SOLID_ANGLE,
    VISIBILITY,
    ISM_SIZE,
    ISM_POINTS,
    PARAM_COUNT,
};

static const gi_param params[] = {
    GI_RSM_SIZE_PARAM(RSM_SIZE),
    [TAU] = { .name = "tau",
              .type = GI_FLOAT,
              .unit = "1",
              .min = 0,
              .max = 1e12,
              .def = 2e-4,
              .quality = true,
              .sweep = tau_sweep,
              .help = "what a node may err by, over the mean radiosity of what the lights reach" },
    [FINEST] = { .name = "finest",
                 .type = GI_INT,
                 .unit = "1",
                 .min = 1,
                 .max = 1024,
                 .def = 1024,
                 .power_of_two = true,
                 .help = "nodes along an edge of a map on the finest level; at most its texels" },
    [BOUND] = { .name = "bound",
                .type = GI_ENUM,
                .unit = "1",
                .def = HISR_BOUND_PATCH,
                .choices = bound_names,
                .help = "what is held against tau: the error of a node; the paper's contribution" },
    GI_EYE_PARAMS(EYE, 2),
    GI_CLAMP_PARAMS(CLAMP, CLAMP_D2, "node"),
    GI_SOLID_ANGLE_PARAM(SOLID_ANGLE),
    GI_VISIBILITY_PARAMS(VISIBILITY, ISM_SIZE, ISM_POINTS),
    { .name = NULL },
};

typedef struct hisr {
    gi_env env;
    gi_value values[PARAM_COUNT];
    ag_rsm_pass map;
    hisr_tree tree;
    ag_multires_pass eye;
    hisr_gather gather, cut;
    ag_upsample_pass upsample, cut_upsample;
    ag_readback visited;
    ag_ism_samples *points; // NULL until visibility wants them
    ag_ism_pass ism;
} hisr;

static fg_status hisr_set(void *self, const gi_value *values)
{
    hisr *h = self;
    for (int i = 0; i < PARAM_COUNT; i++)
        h->values[i] = values[i];
    if (values[VISIBILITY].i != GI_VISIBILITY_ISM || h->points)
        return FG_OK;
    const ag_ism_samples_desc samples = { .log = h->env.log, .scene = h->env.scene };
    return ag_ism_samples_create(&samples, &h->points);
}

static void hisr_destroy(void *self)
{
    hisr *h = self;
    if (!h)
        return;
    ag_readback_finish(&h->visited);
    ag_ism_samples_destroy(h->points);
    free(h);
}

static fg_status hisr_create(const gi_env *env, const gi_value *values, void **self)
{
    hisr *h = calloc(1, sizeof *h);
    *self = NULL;
    if (!h || ag_readback_init(&h->visited) != FG_OK) {
        fg_logf(env->log, FG_LOG_ERROR, "hisr: out of memory");
        hisr_destroy(h);
        return FG_ERR_MEMORY;
    }
    h->env = *env;
    const fg_status status = hisr_set(h, values);
    if (status) {
        hisr_destroy(h);
        return status;
    }
    *self = h;
    return FG_OK;
}

// The level that has `edge` nodes along an edge of a face, or the nearest that there is.
static int level_of_edge(const hisr_tree *tree, int edge)
{
    int level = 0;
    while (level + 1 < tree->levels && 32 << level <= edge)
        level++;
    return level;
}

static void declare_visibility(hisr *h, fg_graph *g, const gi_inputs *in)
{
    hisr_eyes_declare(&h->tree, g);
    const ag_ism_desc ism = {
        .prefix = "hisr",
        .vpls = h->tree.eyes,
        .count = h->tree.count,
        .capacity = h->tree.eye_count,
        .size = (int) h->values[ISM_SIZE].i,
        .points = (int) h->values[ISM_POINTS].i,
    };
    ag_ism_declare(&h->ism, g, h->points, &in->scene, &ism);
}

static void hisr_declare(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    hisr *h = self;
    const gi_value *v = h->values;
    const ag_rsm_desc map = {
        .prefix = "hisr",
        .size = (int) v[RSM_SIZE].i,
        .equal_solid_angle = v[SOLID_ANGLE].i != 0,
    };
    const ag_multires_desc eye = gi_eye_desc("hisr", v + EYE, in->width, in->height);
    ag_rsm_declare(&h->map, g, h->env.gpu_scene, &in->scene, &map);
    hisr_tree_declare(&h->tree, g, &h->map);
    ag_multires_declare(&h->eye, g, &in->scene, &in->gbuffer, &eye);
    hisr_gather_desc gather = {
        .prefix = "hisr",
        .tau = (float) v[TAU].f,
        .finest = level_of_edge(&h->tree, (int) v[FINEST].i),
        .clamp = (ag_clamp) v[CLAMP].i,
        .clamp_d2 = (float) v[CLAMP_D2].f,
        .bound = (hisr_bound) v[BOUND].i,
        .visibility = v[VISIBILITY].i == GI_VISIBILITY_ISM ? &h->ism : NULL,
    };
    if (gather.visibility)
        declare_visibility(h, g, in);
    hisr_gather_declare(&h->gather, g, &h->tree, &h->eye, &gather);
    ag_upsample_declare(&h->upsample, g, &h->eye, h->gather.out, "hisr");
    ag_readback_declare(&h->visited, g, "hisr.count_nodes", h->gather.visited,
                        4 * sizeof(uint32_t));
    out->indirect = h->upsample.out;
    gather.prefix = "hisr.cut";
    gather.cut = true;
    gather.visibility = NULL;
    hisr_gather_declare(&h->cut, g, &h->tree, &h->eye, &gather);
    ag_upsample_declare(&h->cut_upsample, g, &h->eye, h->cut.out, "hisr.cut");
    out->layers[0] = h->cut_upsample.out;
}

static int hisr_counters(void *self, gi_counter *out, int max)
{
    hisr *h = self;
    uint32_t visited[4] = { 0 };
    const bool known = ag_readback_latest(&h->visited, visited);
    const double nodes = visited[0] + 4294967296.0 * visited[1], texels = visited[2];
    const gi_counter counters[] = {
        { "shadow_maps", h->values[VISIBILITY].i ? h->ism.map_count : 0 },
        { "tree_nodes", hisr_tree_nodes(&h->tree, h->tree.levels - 1) },
        { "samples", texels },
        { "nodes_per_sample", texels > 0 ? nodes / texels : 0 },
    };
    int n = 0;
    for (; n < FG_COUNT(counters) - (known ? 0 : 2) && n < max; n++)
        out[n] = counters[n];
    return n;
}

static const gi_layer layers[] = {
    { "cut", "nodes that a texel gathered from: blue 64, green 1024, red 16384" },
    { NULL },
};

static const gi_plugin plugin = {
    .abi = GI_PLUGIN_ABI,
    .name = "hisr",
    .source = "Nichols, Shopf, Wyman. Hierarchical Image-Space Radiosity for Interactive Global "
              "Illumination. EGSR 2009",
    .summary =
        "one diffuse bounce; each texel of a multiresolution buffer gathers from a cut of "
        "its own through a tree of VPLs; indirect visibility by imperfect shadow maps, off by "
        "default",
    .params = params,
    .layers = layers,
    .needs = AG_FEATURE_LIGHT | AG_FEATURE_GEOMETRY,
    .create = hisr_create,
    .set = hisr_set,
    .declare = hisr_declare,
    .counters = hisr_counters,
    .destroy = hisr_destroy,
};

GI_PLUGIN_ENTRY(hisr)
{
    return &plugin;
}
