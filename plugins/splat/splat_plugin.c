// SPDX-License-Identifier: MIT
#include <gi/eye_rows.h>
#include <gi/light_rows.h>
#include <pass/readback.h>
#include <pass/vpl.h>

#include "splat_priv.h"

#include <stdlib.h>

static const double vpl_sweep[] = { 16, 64, 256, 1024, (double) NAN };

enum {
    RSM_SIZE,
    VPLS,
    EYE,
    REACH = EYE + GI_EYE_PATCH_ROWS,
    SOLID_ANGLE,
    PARAM_COUNT,
};

static const gi_param params[] = {
    GI_RSM_SIZE_PARAM(RSM_SIZE),
    [VPLS] = { .name = "vpls",
               .type = GI_INT,
               .unit = "1",
               .min = 1,
               .max = 1048576,
               .def = 256,
               .quality = true,
               .sweep = vpl_sweep,
               .help = "splats: at most this many, split over the maps by power" },
    GI_EYE_PATCH_PARAMS(EYE, 0),
    [REACH] = { .name = "reach",
                .type = GI_FLOAT,
                .unit = "1",
                .min = 0,
                .max = 1e6,
                .def = 0,
                .help = "least irradiance that a VPL is splatted for, over the mean radiosity of "
                        "what the lights light" },
    GI_SOLID_ANGLE_PARAM(SOLID_ANGLE),
    { .name = NULL },
};

typedef struct splat {
    gi_env env;
    gi_value values[PARAM_COUNT];
    ag_rsm_pass map;
    ag_vpl_pass vpl;
    ag_multires_pass multires;
    splat_refine_pass refine;
    splat_light_pass light;
    ag_upsample_pass upsample;
    ag_readback vpls, patches;
} splat;

static fg_status splat_set(void *self, const gi_value *values)
{
    splat *s = self;
    for (int i = 0; i < PARAM_COUNT; i++)
        s->values[i] = values[i];
    return FG_OK;
}

static void splat_destroy(void *self)
{
    splat *s = self;
    if (!s)
        return;
    ag_readback_finish(&s->vpls);
    ag_readback_finish(&s->patches);
    splat_light_finish(&s->light);
    free(s);
}

static fg_status splat_create(const gi_env *env, const gi_value *values, void **self)
{
    splat *s = calloc(1, sizeof *s);
    *self = NULL;
    if (!s || ag_readback_init(&s->vpls) != FG_OK || ag_readback_init(&s->patches) != FG_OK) {
        fg_logf(env->log, FG_LOG_ERROR, "splat: out of memory");
        splat_destroy(s);
        return FG_ERR_MEMORY;
    }
    splat_light_init(&s->light);
    s->env = *env;
    *self = s;
    return splat_set(s, values);
}

static void declare_vpls(splat *s, fg_graph *g, const gi_inputs *in)
{
    const gi_value *v = s->values;
    const ag_rsm_desc map = {
        .prefix = "splat",
        .size = (int) v[RSM_SIZE].i,
        .equal_solid_angle = v[SOLID_ANGLE].i != 0,
    };
    const ag_vpl_desc vpl = {
        .prefix = "splat",
        .pattern = AG_VPL_REGULAR,
        .budget = (int) v[VPLS].i,
    };
    ag_rsm_declare(&s->map, g, s->env.gpu_scene, &in->scene, &map);
    ag_vpl_declare(&s->vpl, g, &s->map, &vpl);
}

static void splat_declare(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    splat *s = self;
    const gi_value *v = s->values;
    const ag_multires_desc multires = gi_eye_patch_desc("splat", v + EYE, in->width, in->height);
    declare_vpls(s, g, in);
    ag_multires_declare(&s->multires, g, &in->scene, &in->gbuffer, &multires);
    splat_refine_declare(&s->refine, g, &s->multires);
    splat_light_declare(&s->light, g, &s->refine, &s->vpl, (float) v[REACH].f);
    ag_upsample_declare(&s->upsample, g, &s->multires, s->light.out, "splat");
    ag_readback_declare(&s->vpls, g, "splat.count_vpls", s->vpl.count, sizeof(uint32_t));
    ag_readback_declare(&s->patches, g, "splat.count_patches", s->refine.patches, sizeof(uint32_t));
    out->indirect = s->upsample.out;
}

static int splat_counters(void *self, gi_counter *out, int max)
{
    splat *s = self;
    uint32_t vpls = 0, patches = 0;
    const bool known =
        ag_readback_latest(&s->vpls, &vpls) && ag_readback_latest(&s->patches, &patches);
    const gi_counter counters[] = {
        { "shadow_maps", 0 },
        { "refinements", s->refine.rounds },
        { "vpl_slots", s->vpl.capacity },
        { "vpls", vpls },
        { "patches", patches },
        { "samples", patches },
    };
    int n = 0;
    for (; n < FG_COUNT(counters) - (known ? 0 : 3) && n < max; n++)
        out[n] = counters[n];
    return n;
}

static const gi_plugin plugin = {
    .abi = GI_PLUGIN_ABI,
    .name = "splat",
    .source = "Nichols, Wyman. Multiresolution Splatting for Indirect Illumination. I3D 2009; "
              "Dachsbacher, Stamminger. Splatting Indirect Illumination. I3D 2006",
    .summary = "one diffuse bounce, each VPL splatted into patches of the image as fine as they "
               "must be; no indirect visibility",
    .params = params,
    .needs = AG_FEATURE_LIGHT | AG_FEATURE_GEOMETRY,
    .create = splat_create,
    .set = splat_set,
    .declare = splat_declare,
    .counters = splat_counters,
    .destroy = splat_destroy,
};

GI_PLUGIN_ENTRY(splat)
{
    return &plugin;
}
