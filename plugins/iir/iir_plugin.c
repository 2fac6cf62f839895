// SPDX-License-Identifier: MIT
#include "domain_layer.h"

#include <gi/plugin.h>
#include <pass/compensate.h>
#include <pass/gather.h>
#include <pass/interleave.h>
#include <pass/paraboloid.h>
#include <pass/post.h>
#include <pass/vpl_shared.h>

#include <epoxy/gl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const mode_names[] = { "incremental", "anew", NULL };
static const char *const first_names[] = { "fill", "budget", NULL };
static const char *const escape_names[] = { "lost", "rescaled", NULL };
static const char *const deal_names[] = { "curve", "creation", NULL };
static const char *const visibility_names[] = { "maps", "none", NULL };
static const char *const clamp_names[] = { "footprint",  "disc",     "none",
                                           "irradiance", "geometry", NULL };
static const ag_clamp clamps[] = { AG_CLAMP_FOOTPRINT, AG_CLAMP_DISC, AG_CLAMP_NONE,
                                   AG_CLAMP_IRRADIANCE, AG_CLAMP_GEOMETRY };
static const char *const metric_names[] = { "plane", "distance", NULL };
static const double light_sweep[] = { 16, 64, 256, 1024, 4096, (double) NAN };

enum {
    MODE,
    MAX_LIGHTS,
    RECALC_MIN,
    RECALC_MAX,
    DELAY,
    FIRST,
    SETTLE,
    RIM,
    ESCAPE,
    BLUR,
    VISIBILITY,
    MAP_SIZE,
    TILES,
    DEAL,
    CLAMP,
    CLAMP_E,
    CLAMP_G,
    COMPENSATE,
    METRIC,
    ALPHA,
    BETA,
    PARAM_COUNT
};

// clang-format off
static const gi_param params[] = {
    [MODE] = { .name = "mode", .type = GI_ENUM, .unit = "1", .choices = mode_names,
        .help = "VPLs kept from frame to frame, or all made anew: the paper's comparison method" },
    [MAX_LIGHTS] = { .name = "max_lights", .type = GI_INT, .unit = "1", .min = 1,
        .max = IIR_MAX_VPLS, .def = 256, .quality = true, .sweep = light_sweep,
        .help = "sampling points of all lights together, split by power" },
    [RECALC_MIN] = { .name = "recalc_min", .type = GI_INT, .unit = "1 a frame", .min = 0,
        .max = IIR_MAX_VPLS, .def = 4,
        .help = "points that a frame frees at least, where that makes the distribution better" },
    [RECALC_MAX] = { .name = "recalc_max", .type = GI_INT, .unit = "1 a frame", .min = 0,
        .max = IIR_MAX_VPLS, .def = 8, .help = "points, and shadow maps, made at most" },
    [DELAY] = { .name = "delay", .type = GI_INT, .unit = "frames", .min = 0, .max = 1, .def = 1,
        .help = "1: VPLs are managed on a thread beside the frame and a frame late" },
    [FIRST] = { .name = "first", .type = GI_ENUM, .unit = "1", .choices = first_names,
        .help = "a frame that finds no VPL makes all, or keeps to recalc_max" },
    [SETTLE] = { .name = "settle", .type = GI_BOOL, .unit = "1", .def = 1,
        .help = "points stay where taking one away gains nothing; off: the paper's rule, which "
                "never rests" },
    [RIM] = { .name = "rim", .type = GI_FLOAT, .unit = "1", .min = 0, .max = 1, .def = 0.35,
        .help = "how far within a spot's rim a new point is, over the radius of its empty circle; "
                "the paper's is 0" },
    [ESCAPE] = { .name = "escape", .type = GI_ENUM, .unit = "1", .choices = escape_names,
        .help = "power that leaves the scene is lost, or goes to the VPLs as in the paper" },
    [BLUR] = { .name = "blur", .type = GI_INT, .unit = "texels", .min = 1, .max = 1024, .def = 16,
        .help = "longer edge of the blurred textures that colour VPLs" },
    [VISIBILITY] = { .name = "visibility", .type = GI_ENUM, .unit = "1",
        .choices = visibility_names, .help = "of a VPL from a pixel: by its shadow map, or always" },
    [MAP_SIZE] = { .name = "map_size", .type = GI_INT, .unit = "texels", .min = 16, .max = 1024,
        .def = 256, .power_of_two = true, .help = "edge of a VPL's paraboloid shadow map" },
    [TILES] = { .name = "tiles", .type = GI_INT, .unit = "1", .min = 1, .max = 8, .def = 4,
        .power_of_two = true,
        .help = "n: n x n subsets of the VPLs, one for each pixel of a block of n x n" },
    [DEAL] = { .name = "deal", .type = GI_ENUM, .unit = "1", .choices = deal_names,
        .help = "VPLs to subsets: along a space-filling curve, or as they were made" },
    [CLAMP] = { .name = "clamp", .type = GI_ENUM, .unit = "1", .choices = clamp_names,
        .help = "what bounds a near VPL: its patch, exactly; a disc of its area; nothing; "
                "the paper's most irradiance; the most of cosines / (pi d^2)" },
    [CLAMP_E] = { .name = "clamp_e", .type = GI_FLOAT, .unit = "W/m^2", .min = 1e-12, .max = 1e12,
        .def = 1, .help = "most irradiance of one VPL, with clamp=irradiance" },
    [CLAMP_G] = { .name = "clamp_g", .type = GI_FLOAT, .unit = "1/m^2", .min = 0, .max = 1e12,
        .help = "most of cosines / (pi d^2), with clamp=geometry; 0: by the area of the VPLs" },
    [COMPENSATE] = { .name = "compensate", .type = GI_INT, .unit = "1", .min = 0, .max = 256,
        .def = 32, .help = "samples a pixel that give back, from the picture, what clamp=geometry "
                           "takes away; 0: none" },
    [METRIC] = { .name = "metric", .type = GI_ENUM, .unit = "1", .choices = metric_names,
        .help = "what alpha bounds: how far off a pixel's plane another is, over the distance to "
                "the eye; or the distance of the two, m, as in the paper" },
    [ALPHA] = { .name = "alpha", .type = GI_FLOAT, .unit = "1 or m", .min = 0, .max = 1e12,
        .def = 0.01, .help = "pixels beyond it are of another surface to the filter" },
    [BETA] = { .name = "beta", .type = GI_FLOAT, .unit = "1", .min = -1, .max = 1, .def = 0.8,
        .help = "least cosine between normals of one surface" },
    { .name = NULL },
};
// clang-format on

enum { VPLS_LAYER, DOMAIN_LAYER, UNFILTERED_LAYER };
static const gi_layer layers[] = {
    [VPLS_LAYER] = { "vpls", "VPLs over direct light, as large as their flux" },
    [DOMAIN_LAYER] = { "domain", "sampling points of the first light and their Voronoi cells" },
    [UNFILTERED_LAYER] = { "unfiltered", "E / pi through the tone curve, before the filter" },
    { NULL },
};

typedef struct iir {
    gi_env env;
    gi_value values[PARAM_COUNT];
    iir_worker *worker;
    ag_paraboloid_maps *maps; // NULL without visibility
    iir_result stats;         // of this frame; its list is of the worker's step
    ag_vpl *list;             // [max_lights], what the next frame uploads
    ag_paraboloid_eye *eyes;  // likewise
    float clamp_g;            // of this frame
    int width, height;

    ag_split_pass split;
    ag_paraboloid_pass shadow;
    ag_vpl_pass vpl; // buffers that this plugin fills itself
    ag_gather_pass gather;
    ag_combine_pass combine;
    ag_compensate_pass compensate;
    ag_box_filter_pass filter;
    ag_near_pass near;
    ag_vpl_dots_pass dots;
    ag_tone_pass unfiltered;
    iir_domain_layer domain;
} iir;

// ---- life ------------------------------------------------------------------------------------

static void iir_destroy(void *self)
{
    iir *s = self;
    if (!s)
        return;
    iir_worker_destroy(s->worker);
    ag_paraboloid_destroy(s->maps);
    iir_domain_layer_finish(&s->domain);
    free(s->list);
    free(s->eyes);
    free(s);
}

static fg_status create_parts(iir *s)
{
    const size_t most = (size_t) s->values[MAX_LIGHTS].i;
    const iir_manager_desc manager = {
        .log = s->env.log,
        .scene = s->env.scene,
        .max_lights = (int) most,
        .blur = (int) s->values[BLUR].i,
    };
    const ag_paraboloid_desc maps = {
        .log = s->env.log,
        .device = s->env.device,
        .scene = s->env.scene,
        .size = (int) s->values[MAP_SIZE].i,
        .capacity = (int) most,
    };
    s->list = calloc(most, sizeof *s->list);
    s->eyes = calloc(most, sizeof *s->eyes);
    if (!s->list || !s->eyes || iir_domain_layer_init(&s->domain, (int) most) != FG_OK) {
        fg_logf(s->env.log, FG_LOG_ERROR, "iir: out of memory");
        return FG_ERR_MEMORY;
    }
    const fg_status status = iir_worker_create(&manager, &s->worker);
    if (status || s->values[VISIBILITY].i != 0)
        return status;
    return ag_paraboloid_create(&maps, &s->maps);
}

static fg_status iir_create(const gi_env *env, const gi_value *values, void **self)
{
    iir *s = calloc(1, sizeof *s);
    *self = NULL;
    if (!s) {
        fg_logf(env->log, FG_LOG_ERROR, "iir: out of memory");
        return FG_ERR_MEMORY;
    }
    s->env = *env;
    memcpy(s->values, values, sizeof s->values);
    const fg_status status = create_parts(s);
    if (status) {
        iir_destroy(s);
        return status;
    }
    *self = s;
    return FG_OK;
}

static fg_status iir_set(void *self, const gi_value *values)
{
    static const int built_in[] = { MAX_LIGHTS, BLUR, VISIBILITY, MAP_SIZE };
    iir *s = self;
    for (int i = 0; i < FG_COUNT(built_in); i++)
        if (values[built_in[i]].i != s->values[built_in[i]].i)
            return FG_ERR_UNSUPPORTED;
    memcpy(s->values, values, sizeof s->values);
    return FG_OK;
}

// ---- steps 1 to 4, on the CPU ----------------------------------------------------------------

static iir_budget budget_of(const iir *s)
{
    const gi_value *v = s->values;
    return (iir_budget){
        .mode = (iir_mode) v[MODE].i,
        .max_lights = (int) v[MAX_LIGHTS].i,
        .recalc_min = (int) v[RECALC_MIN].i,
        .recalc_max = (int) v[RECALC_MAX].i,
        .fill_first = v[FIRST].i == 0,
        .settle = v[SETTLE].i != 0,
        .rescale = v[ESCAPE].i != 0,
        .rim = v[RIM].f,
        .deal = (iir_deal) v[DEAL].i,
        .tiles = (int) v[TILES].i,
    };
}

static void list_vpls(iir *s, const ag_view *view)
{
    for (int i = 0; i < s->stats.count; i++) {
        const iir_vpl *from = s->stats.vpls + i;
        ag_vpl_patch patch = { .area = from->area };
        for (int k = 0; k < 3; k++)
            patch.position[k] = (float) (from->position[k] - view->origin[k]);
        memcpy(patch.normal, from->normal, sizeof patch.normal);
        memcpy(patch.flux, from->flux, sizeof patch.flux);
        memcpy(patch.edges, from->edges, sizeof patch.edges);
        ag_vpl_from_host(&patch, s->list + i);
        s->eyes[i] = (ag_paraboloid_eye){ .slot = from->slot, .fresh = from->fresh };
        memcpy(s->eyes[i].position, from->position, sizeof from->position);
        memcpy(s->eyes[i].normal, from->normal, sizeof from->normal);
    }
}

// A bound of 1 / A_j takes from a VPL only what it has too much within its own patch, as a disc
// form factor would; an eighth of that leaves nothing of its spot, and what it takes comes from no
// farther than 1.6 edges of a patch, which the picture mostly shows.
static float geometry_bound(const iir *s)
{
    const double own = s->values[CLAMP_G].f;
    double sum = 0;
    int count = 0;
    for (int i = 0; i < s->stats.count; i++) {
        const double area = (double) s->stats.vpls[i].area;
        if (area > 0) {
            sum += log(area);
            count++;
        }
    }
    const double bound = own > 0 ? own : count > 0 ? 0.125 / exp(sum / count) : 1;
    return (float) fmin(fmax(bound, 1e-12), 1e12);
}

static fg_status iir_update(void *self, const gi_frame *frame)
{
    iir *s = self;
    const ag_scene *scene = s->env.scene;
    const iir_budget budget = budget_of(s);
    const iir_lights lights = { .lights = scene->lights, .count = scene->light_count };
    const iir_result *result;
    const fg_status status =
        iir_worker_frame(s->worker, &lights, &budget, (int) s->values[DELAY].i, &result);
    if (status)
        return status;
    s->stats = *result;
    list_vpls(s, frame->view);
    if (clamps[s->values[CLAMP].i] == AG_CLAMP_GEOMETRY)
        s->gather.bound = s->compensate.bound = s->clamp_g = geometry_bound(s);
    if (s->maps)
        ag_paraboloid_set(s->maps, s->eyes, s->stats.count, frame->view);
    return FG_OK;
}

// ---- steps 5 to 9, on the GPU ----------------------------------------------------------------

static fg_status run_upload(const fg_run *run, void *user)
{
    const iir *s = user;
    const uint32_t count[4] = { (uint32_t) s->stats.count, (uint32_t) s->stats.count };
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // shaders may have used the memory before
    if (s->stats.count > 0)
        glNamedBufferSubData(fg_run_object(run, s->vpl.vpls), 0,
                             (GLsizeiptr) ((size_t) s->stats.count * sizeof *s->list), s->list);
    glNamedBufferSubData(fg_run_object(run, s->vpl.count), 0, sizeof count, count);
    return FG_OK;
}

static void declare_vpls(iir *s, fg_graph *g)
{
    const uint64_t most = (uint64_t) s->values[MAX_LIGHTS].i;
    s->vpl = (ag_vpl_pass){
        .gpu = s->env.gpu_scene,
        .vpls = fg_buffer(g, "iir.vpls", &(fg_buf_desc){ .size = most * sizeof(ag_vpl) }),
        .count = fg_buffer(g, "iir.count", &(fg_buf_desc){ .size = 4 * sizeof(uint32_t) }),
        .capacity = (int) most,
    };
    const fg_pass_desc upload = {
        .name = "iir.upload",
        .kind = FG_KIND_COMPUTE,
        .writes = { { s->vpl.vpls, FG_USE_STORAGE, FG_LOAD_KEEP },
                    { s->vpl.count, FG_USE_STORAGE, FG_LOAD_DISCARD } },
        .needs = AG_FEATURE_LIGHT | AG_FEATURE_GEOMETRY,
        .run = run_upload,
        .user = s,
    };
    fg_passes(g, &upload, 1);
}

static void declare_layers(iir *s, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    const ag_vpl_dots_desc dots = { "iir", &in->scene, &in->gbuffer, in->direct };
    ag_vpl_dots_declare(&s->dots, g, s->env.gpu_scene, &s->vpl, &dots);
    s->unfiltered = (ag_tone_pass){ .radiance = s->combine.out, .exposure = 1 };
    ag_tone_declare(&s->unfiltered, g, "iir.unfiltered_layer", "iir.unfiltered_layer");
    iir_domain_layer_declare(&s->domain, g, &s->stats);
    out->layers[VPLS_LAYER] = s->dots.out;
    out->layers[DOMAIN_LAYER] = s->domain.out;
    out->layers[UNFILTERED_LAYER] = s->unfiltered.out;
}

// The combined light and what its bound has taken away.
static fg_res declare_compensation(iir *s, fg_graph *g, const gi_inputs *in)
{
    const gi_value *v = s->values;
    if (clamps[v[CLAMP].i] != AG_CLAMP_GEOMETRY || v[COMPENSATE].i == 0)
        return s->combine.out;
    const ag_compensate_desc desc = {
        .prefix = "iir",
        .in = s->combine.out,
        .direct = in->direct,
        .bound = s->clamp_g,
        .tiles = (int) v[TILES].i,
        .samples = (int) v[COMPENSATE].i,
        .width = in->width,
        .height = in->height,
    };
    ag_compensate_declare(&s->compensate, g, &in->scene, &in->gbuffer, &desc);
    return s->compensate.out;
}

static void iir_declare(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    iir *s = self;
    const gi_value *v = s->values;
    const ag_split_desc split = { "iir", (int) v[TILES].i, in->width, in->height };
    const ag_gather_desc gather = {
        .prefix = "iir",
        .clamp = clamps[v[CLAMP].i],
        .clamp_e = (float) v[CLAMP_E].f,
        .clamp_g = s->clamp_g,
        .on_surface = true,
        .split = &s->split,
        .paraboloid = s->maps ? &s->shadow : NULL,
        .far_only = true,
    };
    const ag_box_filter_desc filter = { (ag_box_metric) v[METRIC].i, (float) v[ALPHA].f,
                                        (float) v[BETA].f };
    s->width = in->width;
    s->height = in->height;
    declare_vpls(s, g);
    ag_split_declare(&s->split, g, &in->scene, &in->gbuffer, &split);
    if (s->maps)
        ag_paraboloid_declare(&s->shadow, g, s->maps, "iir");
    ag_gather_declare(&s->gather, g, &in->scene, &in->gbuffer, &s->vpl, &gather);
    ag_combine_declare(&s->combine, g, &s->split, s->gather.out);
    ag_box_filter_declare(&s->filter, g, &s->split, declare_compensation(s, g, in), &filter);
    declare_layers(s, g, in, out);
    out->indirect = s->filter.out;
    if (s->gather.far_only) {
        const ag_near_desc near = { "iir", s->filter.out, gather.paraboloid };
        ag_near_declare(&s->near, g, &in->scene, &in->gbuffer, &s->vpl, &near);
        out->indirect = s->near.out;
    }
}

static int iir_counters(void *self, gi_counter *out, int max)
{
    const iir *s = self;
    const iir_result *r = &s->stats;
    const gi_counter counters[] = {
        { "vpls", r->count },
        { "shadow_maps", s->maps ? ag_paraboloid_drawn(s->maps) : 0 },
        { "samples", (double) s->width * s->height },
        { "new_vpls", r->fresh },
        { "invalid", r->invalid },
        { "deleted", r->deleted },
        { "escaped", r->escaped },
        { "rays", r->rays },
        { "dispersion", r->dispersion },
        { "manage_ms", r->ms },
    };
    int n = 0;
    for (; n < FG_COUNT(counters) && n < max; n++)
        out[n] = counters[n];
    return n;
}

static const gi_plugin plugin = {
    .abi = GI_PLUGIN_ABI,
    .name = "iir",
    .source = "Laine, Saransaari, Kontkanen, Lehtinen, Aila. Incremental Instant Radiosity for "
              "Real-Time Indirect Illumination. EGSR 2007",
    .summary = "one diffuse bounce with indirect shadows, from VPLs that are kept, with their "
               "shadow maps, as long as the light reaches them",
    .params = params,
    .layers = layers,
    .needs = AG_FEATURE_LIGHT | AG_FEATURE_GEOMETRY,
    .create = iir_create,
    .set = iir_set,
    .update = iir_update,
    .declare = iir_declare,
    .counters = iir_counters,
    .destroy = iir_destroy,
};

GI_PLUGIN_ENTRY(iir)
{
    return &plugin;
}
