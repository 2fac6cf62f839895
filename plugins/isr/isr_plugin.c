// SPDX-License-Identifier: MIT
#include "cluster.h"

#include <gi/eye_rows.h>
#include <gi/light_rows.h>
#include <gi/visibility.h>
#include <pass/gather.h>
#include <pass/readback.h>

#include <stdlib.h>

enum { SOURCE_CLUSTERS, SOURCE_REGULAR };
static const char *const source_names[] = { "clusters", "regular", NULL };
static const double flux_sweep[] = { 1, 0.1, 0.01, 0.001, 0, (double) NAN };

enum {
    RSM_SIZE,
    SOURCE,
    LIGHT_INITIAL,
    LIGHT_COARSEST,
    LIGHT_DEPTH,
    LIGHT_NORMAL,
    LIGHT_FLUX,
    VPLS,
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
    [SOURCE] = { .name = "source",
                 .type = GI_ENUM,
                 .unit = "1",
                 .choices = source_names,
                 .help = "VPLs: patches by discontinuities (sec. 3.4), or a regular pattern (sec. "
                         "3.2)" },
    [LIGHT_INITIAL] = { .name = "light_initial",
                        .type = GI_INT,
                        .unit = "blocks",
                        .min = 1,
                        .max = 1024,
                        .def = 32,
                        .power_of_two = true,
                        .help = "finest patches along a map's edge" },
    [LIGHT_COARSEST] = { .name = "light_coarsest",
                         .type = GI_INT,
                         .unit = "patches",
                         .min = 1,
                         .max = 1024,
                         .def = 8,
                         .power_of_two = true,
                         .help = "coarsest along a map's edge, within [light_initial / 8, "
                                 "light_initial]; its square is split over lights by power" },
    [LIGHT_DEPTH] = { .name = "light_depth",
                      .type = GI_FLOAT,
                      .unit = "1",
                      .min = 0,
                      .max = 1e6,
                      .def = 0.05,
                      .help = "depth derivative, over the distance, from which on a patch of light "
                              "is divided" },
    [LIGHT_NORMAL] = { .name = "light_normal",
                       .type = GI_FLOAT,
                       .unit = "1",
                       .min = 0,
                       .max = 4,
                       .def = 0.3,
                       .help = "extent of a component of the normal from which on it is" },
    [LIGHT_FLUX] = { .name = "light_flux",
                     .type = GI_FLOAT,
                     .unit = "1",
                     .min = 0,
                     .max = 1,
                     .def = 0.01,
                     .quality = true,
                     .sweep = flux_sweep,
                     .help = "share of all flux below which it is not, whatever it holds" },
    [VPLS] = { .name = "vpls",
               .type = GI_INT,
               .unit = "1",
               .min = 1,
               .max = 1048576,
               .def = 256,
               .help = "at most this many, with source=regular" },
    GI_EYE_PARAMS(EYE, 3),
    GI_CLAMP_PARAMS(CLAMP, CLAMP_D2, "VPL"),
    GI_SOLID_ANGLE_PARAM(SOLID_ANGLE),
    GI_VISIBILITY_PARAMS(VISIBILITY, ISM_SIZE, ISM_POINTS),
    { .name = NULL },
};

enum { LEVEL_LAYER, VALIDITY_LAYER, VPLS_LAYER };

static const gi_layer layers[] = {
    [LEVEL_LAYER] = { "level", "which level lights each pixel, blue the finest; white: lit pixels "
                               "of shared blocks" },
    [VALIDITY_LAYER] = { "validity", "the flattened multiresolution buffer: what is lit" },
    [VPLS_LAYER] = { "vpls", "VPLs over direct light, as large as their flux" },
    { NULL },
};

typedef struct isr {
    gi_env env;
    gi_value values[PARAM_COUNT];
    ag_rsm_pass map;
    ag_vpl_pass vpl;
    isr_clusters clusters;
    ag_ism_samples *points; // NULL until visibility wants them
    ag_ism_pass ism;
    ag_multires_pass eye;
    ag_gather_pass gather;
    ag_upsample_pass upsample;
    ag_multires_debug debug;
    ag_vpl_dots_pass dots;
    ag_readback vpl_count, texel_count;
} isr;

static fg_status isr_set(void *self, const gi_value *values)
{
    isr *s = self;
    for (int i = 0; i < PARAM_COUNT; i++)
        s->values[i] = values[i];
    if (s->points || values[VISIBILITY].i != GI_VISIBILITY_ISM)
        return FG_OK;
    const ag_ism_samples_desc samples = { .log = s->env.log, .scene = s->env.scene };
    return ag_ism_samples_create(&samples, &s->points);
}

static void isr_destroy(void *self)
{
    isr *s = self;
    if (!s)
        return;
    ag_ism_samples_destroy(s->points);
    ag_readback_finish(&s->vpl_count);
    ag_readback_finish(&s->texel_count);
    free(s);
}

static fg_status isr_create(const gi_env *env, const gi_value *values, void **self)
{
    isr *s = calloc(1, sizeof *s);
    *self = NULL;
    if (!s || ag_readback_init(&s->vpl_count) != FG_OK ||
        ag_readback_init(&s->texel_count) != FG_OK) {
        fg_logf(env->log, FG_LOG_ERROR, "isr: out of memory");
        isr_destroy(s);
        return FG_ERR_MEMORY;
    }
    s->env = *env;
    const fg_status status = isr_set(s, values);
    if (status) {
        isr_destroy(s);
        return status;
    }
    *self = s;
    return FG_OK;
}

static void declare_clusters(isr *s, fg_graph *g)
{
    const gi_value *v = s->values;
    const int initial = (int) v[LIGHT_INITIAL].i, coarsest = (int) v[LIGHT_COARSEST].i;
    const isr_clusters_desc clusters = {
        .prefix = "isr",
        .initial = initial,
        .coarsest = coarsest < initial ? coarsest : initial,
        .depth = (float) v[LIGHT_DEPTH].f,
        .normal = (float) v[LIGHT_NORMAL].f,
        .least_flux = (float) v[LIGHT_FLUX].f,
    };
    isr_clusters_declare(&s->clusters, &s->vpl, g, &s->map, &clusters);
}

static void declare_vpls(isr *s, fg_graph *g, const gi_inputs *in)
{
    const gi_value *v = s->values;
    const ag_rsm_desc map = {
        .prefix = "isr",
        .size = (int) v[RSM_SIZE].i,
        .equal_solid_angle = v[SOLID_ANGLE].i != 0,
    };
    const ag_vpl_desc vpl = {
        .prefix = "isr",
        .pattern = AG_VPL_REGULAR,
        .budget = (int) v[VPLS].i,
    };
    ag_rsm_declare(&s->map, g, s->env.gpu_scene, &in->scene, &map);
    if (v[SOURCE].i == SOURCE_CLUSTERS)
        declare_clusters(s, g);
    else
        ag_vpl_declare(&s->vpl, g, &s->map, &vpl);
    ag_readback_declare(&s->vpl_count, g, "isr.count_vpls", s->vpl.count, 4 * sizeof(uint32_t));
}

static void declare_visibility(isr *s, fg_graph *g, const gi_inputs *in)
{
    const ag_ism_desc ism = {
        .prefix = "isr",
        .vpls = s->vpl.vpls,
        .count = s->vpl.count,
        .capacity = s->vpl.capacity,
        .size = (int) s->values[ISM_SIZE].i,
        .points = (int) s->values[ISM_POINTS].i,
    };
    ag_ism_declare(&s->ism, g, s->points, &in->scene, &ism);
}

static void isr_declare(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    isr *s = self;
    const gi_value *v = s->values;
    const ag_multires_desc eye = gi_eye_desc("isr", v + EYE, in->width, in->height);
    const ag_gather_desc gather = {
        .prefix = "isr",
        .clamp = (ag_clamp) v[CLAMP].i,
        .clamp_d2 = (float) v[CLAMP_D2].f,
        .multires = &s->eye,
        .visibility = v[VISIBILITY].i == GI_VISIBILITY_ISM ? &s->ism : NULL,
    };
    declare_vpls(s, g, in);
    if (gather.visibility)
        declare_visibility(s, g, in);
    ag_multires_declare(&s->eye, g, &in->scene, &in->gbuffer, &eye);
    ag_gather_declare(&s->gather, g, &in->scene, &in->gbuffer, &s->vpl, &gather);
    ag_upsample_declare(&s->upsample, g, &s->eye, s->gather.out, "isr");
    ag_readback_declare(&s->texel_count, g, "isr.count_texels", s->eye.count, 4 * sizeof(uint32_t));
    ag_multires_debug_declare(&s->debug, g, &s->eye, "isr");
    const ag_vpl_dots_desc dots = { "isr", &in->scene, &in->gbuffer, in->direct };
    ag_vpl_dots_declare(&s->dots, g, s->env.gpu_scene, &s->vpl, &dots);
    out->indirect = s->upsample.out;
    out->layers[LEVEL_LAYER] = s->debug.levels;
    out->layers[VALIDITY_LAYER] = s->debug.validity;
    out->layers[VPLS_LAYER] = s->dots.out;
}

static int isr_counters(void *self, gi_counter *out, int max)
{
    isr *s = self;
    uint32_t vpls[4] = { 0 }, texels[4] = { 0 };
    int n = 0;
    if (n < max)
        out[n++] = (gi_counter){ "shadow_maps", s->values[VISIBILITY].i ? s->ism.map_count : 0 };
    if (n < max && ag_readback_latest(&s->texel_count, texels))
        out[n++] = (gi_counter){ "samples", texels[0] };
    if (n < max && ag_readback_latest(&s->vpl_count, vpls))
        out[n++] = (gi_counter){ "vpls", vpls[0] };
    return n;
}

static const gi_plugin plugin = {
    .abi = GI_PLUGIN_ABI,
    .name = "isr",
    .source = "Nichols, Shopf, Wyman. Hierarchical Image-Space Radiosity for Interactive Global "
              "Illumination. EGSR 2009, sec. 3.1-3.4",
    .summary = "one diffuse bounce, gathered from VPLs where the image needs it and interpolated "
               "between; indirect visibility as an option",
    .params = params,
    .layers = layers,
    .needs = AG_FEATURE_LIGHT | AG_FEATURE_GEOMETRY,
    .create = isr_create,
    .set = isr_set,
    .declare = isr_declare,
    .counters = isr_counters,
    .destroy = isr_destroy,
};

GI_PLUGIN_ENTRY(isr)
{
    return &plugin;
}
