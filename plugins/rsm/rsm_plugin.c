// SPDX-License-Identifier: MIT
#include <gi/light_rows.h>
#include <gi/plugin.h>
#include <gi/visibility.h>
#include <pass/gather.h>
#include <pass/readback.h>

#include <math.h>
#include <stdlib.h>

static const char *const pattern_names[] = { "all", "regular", "stratified", NULL };
static const double vpl_sweep[] = { 16, 64, 256, 1024, 4096, 16384, (double) NAN };

enum {
    RSM_SIZE,
    PATTERN,
    VPLS,
    CLAMP,
    CLAMP_D2,
    SOLID_ANGLE,
    SEED,
    VISIBILITY,
    ISM_SIZE,
    ISM_POINTS,
    PARAM_COUNT
};

static const gi_param params[] = {
    GI_RSM_SIZE_PARAM(RSM_SIZE),
    [PATTERN] = { .name = "pattern",
                  .type = GI_ENUM,
                  .unit = "1",
                  .def = AG_VPL_REGULAR,
                  .choices = pattern_names,
                  .help = "which texels become VPLs: all, or one of each block" },
    [VPLS] = { .name = "vpls",
               .type = GI_INT,
               .unit = "1",
               .min = 1,
               .max = 1048576,
               .def = 1024,
               .quality = true,
               .sweep = vpl_sweep,
               .help =
                   "at most this many, unless all; split over lights by their power, a power of "
                   "four for each map; one more for each map with a share below one" },
    GI_CLAMP_PARAMS(CLAMP, CLAMP_D2, "VPL"),
    GI_SOLID_ANGLE_PARAM(SOLID_ANGLE),
    [SEED] = { .name = "seed",
               .type = GI_INT,
               .unit = "1",
               .min = 0,
               .max = 4294967295.0,
               .def = 1,
               .help = "of the stratified pattern" },
    GI_VISIBILITY_PARAMS(VISIBILITY, ISM_SIZE, ISM_POINTS),
    { .name = NULL },
};

static const gi_layer layers[] = {
    { "vpls", "VPLs over direct light, as large as their flux" },
    { NULL },
};

typedef struct rsm {
    gi_env env;
    gi_value values[PARAM_COUNT];
    ag_rsm_pass map;
    ag_vpl_pass vpl;
    ag_ism_samples *points; // NULL until visibility wants them
    ag_ism_pass ism;
    ag_gather_pass gather;
    ag_vpl_dots_pass dots;
    ag_readback count;
    int samples; // pixels that gather
} rsm;

static fg_status rsm_set(void *self, const gi_value *values)
{
    rsm *r = self;
    for (int i = 0; i < PARAM_COUNT; i++)
        r->values[i] = values[i];
    if (values[VISIBILITY].i != GI_VISIBILITY_ISM || r->points)
        return FG_OK;
    const ag_ism_samples_desc samples = { .log = r->env.log, .scene = r->env.scene };
    return ag_ism_samples_create(&samples, &r->points);
}

static void rsm_destroy(void *self)
{
    rsm *r = self;
    if (!r)
        return;
    ag_readback_finish(&r->count);
    ag_ism_samples_destroy(r->points);
    free(r);
}

static fg_status rsm_create(const gi_env *env, const gi_value *values, void **self)
{
    rsm *r = calloc(1, sizeof *r);
    *self = NULL;
    if (!r || ag_readback_init(&r->count) != FG_OK) {
        fg_logf(env->log, FG_LOG_ERROR, "rsm: out of memory");
        rsm_destroy(r);
        return FG_ERR_MEMORY;
    }
    r->env = *env;
    const fg_status status = rsm_set(r, values);
    if (status) {
        rsm_destroy(r);
        return status;
    }
    *self = r;
    return FG_OK;
}

static void rsm_declare(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    rsm *r = self;
    const gi_value *v = r->values;
    const ag_rsm_desc map = {
        .prefix = "rsm",
        .size = (int) v[RSM_SIZE].i,
        .equal_solid_angle = v[SOLID_ANGLE].i != 0,
    };
    const ag_vpl_desc vpl = {
        .prefix = "rsm",
        .pattern = (ag_vpl_pattern) v[PATTERN].i,
        .budget = (int) v[VPLS].i,
        .seed = (uint32_t) v[SEED].i,
    };
    const ag_gather_desc gather = {
        .prefix = "rsm",
        .clamp = (ag_clamp) v[CLAMP].i,
        .clamp_d2 = (float) v[CLAMP_D2].f,
        .visibility = v[VISIBILITY].i == GI_VISIBILITY_ISM ? &r->ism : NULL,
    };
    ag_rsm_declare(&r->map, g, r->env.gpu_scene, &in->scene, &map);
    ag_vpl_declare(&r->vpl, g, &r->map, &vpl);
    if (gather.visibility) {
        const ag_ism_desc ism = {
            .prefix = "rsm",
            .vpls = r->vpl.vpls,
            .count = r->vpl.count,
            .capacity = r->vpl.capacity,
            .size = (int) v[ISM_SIZE].i,
            .points = (int) v[ISM_POINTS].i,
        };
        ag_ism_declare(&r->ism, g, r->points, &in->scene, &ism);
    }
    ag_gather_declare(&r->gather, g, &in->scene, &in->gbuffer, &r->vpl, &gather);
    ag_readback_declare(&r->count, g, "rsm.count_vpls", r->vpl.count, 4 * sizeof(uint32_t));
    const ag_vpl_dots_desc dots = { "rsm", &in->scene, &in->gbuffer, in->direct };
    ag_vpl_dots_declare(&r->dots, g, r->env.gpu_scene, &r->vpl, &dots);
    out->indirect = r->gather.out;
    out->layers[0] = r->dots.out;
    r->samples = in->width * in->height;
}

static int rsm_counters(void *self, gi_counter *out, int max)
{
    rsm *r = self;
    uint32_t count[4] = { 0 };
    const bool known = ag_readback_latest(&r->count, count);
    const gi_counter counters[] = {
        { "shadow_maps", r->values[VISIBILITY].i ? r->ism.map_count : 0 },
        { "samples", r->samples },
        { "vpl_slots", count[1] },
        { "vpls", count[0] },
    };
    int n = 0;
    for (; n < FG_COUNT(counters) - (known ? 0 : 2) && n < max; n++)
        out[n] = counters[n];
    return n;
}

static const gi_plugin plugin = {
    .abi = GI_PLUGIN_ABI,
    .name = "rsm",
    .source = "Dachsbacher, Stamminger. Reflective Shadow Maps. I3D 2005; as gathered in Nichols, "
              "Shopf, Wyman. Hierarchical Image-Space Radiosity. EGSR 2009",
    .summary = "one diffuse bounce, gathered at every pixel from every VPL; indirect visibility by "
               "imperfect shadow maps, off by default",
    .params = params,
    .layers = layers,
    .needs = AG_FEATURE_LIGHT | AG_FEATURE_GEOMETRY,
    .create = rsm_create,
    .set = rsm_set,
    .declare = rsm_declare,
    .counters = rsm_counters,
    .destroy = rsm_destroy,
};

GI_PLUGIN_ENTRY(rsm)
{
    return &plugin;
}
