// SPDX-License-Identifier: MIT
#include "renderer.h"

#include <epoxy/gl.h>
#include <pass/gbuffer.h>
#include <pass/lighting.h>
#include <pass/post.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const renderer_layer_names[LAYER_COUNT] = {
    "final", "radiance", "direct", "indirect", "albedo", "normal", "position",
};

struct renderer {
    renderer_desc desc; // `values` and `camera` point to what is borrowed no longer: unused
    uint64_t features;
    ag_gpu_scene *gpu;
    fg_graph *graph;
    ag_camera camera; // when the scene's own is not followed
    bool follows;
    ag_view view;
    uint64_t frames; // since the plugin was created

    const gi_plugin *plugin;
    void *self;

    bool declared;
    ag_gbuffer_pass gbuffer;
    ag_shadow_pass shadow;
    ag_direct_pass direct;
    ag_compose_pass compose, indirect;
    ag_tone_pass tone;
    fg_res layers[LAYER_END];
};

static fg_status refuse(const renderer_desc *desc, const char *what)
{
    fg_logf(desc->log, FG_LOG_ERROR, "renderer: %s", what);
    return FG_ERR_INVALID;
}

static fg_status check(const renderer_desc *desc)
{
    if (!desc->device || !desc->scene)
        return refuse(desc, "needs a device and a scene");
    if (desc->width < 1 || desc->height < 1)
        return refuse(desc, "the size must be at least 1 x 1");
    if (desc->layers >> LAYER_END)
        return refuse(desc, "there is no such layer");
    if (!(desc->exposure >= 0))
        return refuse(desc, "exposure must not be negative");
    if (!desc->camera && desc->camera_index != 0 &&
        (desc->camera_index < 0 || desc->camera_index >= desc->scene->camera_count))
        return refuse(desc, "there is no camera of that index");
    return FG_OK;
}

static void choose_camera(renderer *r)
{
    const ag_scene *scene = r->desc.scene;
    r->follows = !r->desc.camera && scene->camera_count > 0;
    if (r->desc.camera)
        r->camera = *r->desc.camera;
    else if (!r->follows)
        r->camera = ag_scene_framing_camera(scene);
}

static fg_status create_parts(renderer *r)
{
    const renderer_desc *d = &r->desc;
    const ag_gpu_scene_desc gpu = {
        .log = d->log,
        .device = d->device,
        .scene = d->scene,
        .features = d->needs_all ? ~UINT64_C(0) : 0,
    };
    const fg_graph_desc graph = {
        .device = d->device,
        .log = d->log,
        .debug = d->debug,
        .seed = d->seed,
        .inspect = d->inspect,
        .inspect_user = d->inspect_user,
    };
    const fg_status status = ag_gpu_scene_create(&gpu, &r->gpu);
    if (status)
        return status;
    r->features = ag_gpu_scene_features(r->gpu);
    r->graph = fg_graph_create(&graph);
    return r->graph ? FG_OK : FG_ERR_MEMORY;
}

fg_status renderer_create(const renderer_desc *desc, renderer **out)
{
    *out = NULL;
    fg_status status = check(desc);
    if (status)
        return status;
    renderer *r = calloc(1, sizeof *r);
    if (!r) {
        fg_logf(desc->log, FG_LOG_ERROR, "renderer: out of memory");
        return FG_ERR_MEMORY;
    }
    r->desc = *desc;
    if (r->desc.layers == 0)
        r->desc.layers = 1u << LAYER_FINAL;
    choose_camera(r);
    status = create_parts(r);
    if (!status && desc->plugin)
        status = renderer_set_plugin(r, desc->plugin, desc->values);
    if (status) {
        renderer_destroy(r);
        return status;
    }
    *out = r;
    return FG_OK;
}

static void drop_plugin(renderer *r)
{
    if (r->plugin)
        r->plugin->destroy(r->self);
    r->plugin = NULL;
    r->self = NULL;
    r->declared = false;
}

void renderer_destroy(renderer *r)
{
    if (!r)
        return;
    fg_graph_destroy(r->graph); // before what its callbacks point to
    drop_plugin(r);
    ag_gpu_scene_destroy(r->gpu);
    free(r);
}

fg_status renderer_set_plugin(renderer *r, const gi_plugin *plugin, const gi_value *values)
{
    const gi_env env = {
        .log = r->desc.log,
        .device = r->desc.device,
        .scene = r->desc.scene,
        .gpu_scene = r->gpu,
    };
    gi_value *defaults = NULL;
    fg_status status = FG_OK;
    if (plugin && !values) {
        defaults = calloc((size_t) gi_params_count(plugin) + 1, sizeof *defaults);
        if (!defaults)
            return FG_ERR_MEMORY;
        gi_params_default(plugin, defaults);
        values = defaults;
    }
    const bool kept = plugin && plugin == r->plugin && plugin->set;
    if (!kept || plugin->set(r->self, values) != FG_OK) {
        drop_plugin(r);
        if (plugin)
            status = plugin->create(&env, values, &r->self);
        r->plugin = status || !plugin ? NULL : plugin;
        r->frames = 0;
    }
    r->declared = false;
    free(defaults);
    return status;
}

fg_status renderer_set_layers(renderer *r, unsigned layers)
{
    if (layers >> LAYER_END)
        return refuse(&r->desc, "there is no such layer");
    if (layers == 0)
        layers = 1u << LAYER_FINAL;
    if (layers != r->desc.layers)
        r->declared = false;
    r->desc.layers = layers;
    return FG_OK;
}

fg_status renderer_resize(renderer *r, int width, int height)
{
    if (width < 1 || height < 1)
        return refuse(&r->desc, "the size must be at least 1 x 1");
    if (width == r->desc.width && height == r->desc.height)
        return FG_OK;
    r->desc.width = width;
    r->desc.height = height;
    r->declared = false;
    fg_graph_trim(r->graph); // what the size before last has left
    return FG_OK;
}

void renderer_set_camera(renderer *r, const ag_camera *camera)
{
    r->camera = *camera;
    r->follows = false;
}

// ---- declaring ----------------------------------------------------------------------------

static fg_status never_run(const fg_run *run, void *user)
{
    (void) run;
    (void) user;
    return FG_ERR_INVALID;
}

static void declare_plugin(renderer *r, const ag_scene_res *scene, gi_outputs *out)
{
    const gi_inputs in = {
        .width = r->desc.width,
        .height = r->desc.height,
        .gbuffer = r->gbuffer.out,
        .scene = *scene,
        .direct = r->direct.out,
    };
    if (!r->plugin)
        return;
    if (!(r->plugin->needs & ~r->features)) {
        r->plugin->declare(r->self, r->graph, &in, out);
        return;
    }
    // A pass that stands for the whole technique, so that the graph lists it with the reason.
    char name[64];
    snprintf(name, sizeof name, "%s.technique", r->plugin->name);
    const fg_pass_desc absent = {
        .name = name,
        .effect = FG_EFFECT_EXTERNAL,
        .needs = r->plugin->needs,
        .run = never_run,
    };
    fg_passes(r->graph, &absent, 1);
}

static void declare_output(renderer *r, const ag_scene_res *scene, const gi_outputs *gi)
{
    const ag_compose_pass sum = {
        .view = scene->view,
        .direct = r->direct.out,
        .albedo = r->gbuffer.out.albedo,
        .indirect = gi->indirect,
        .glossy = gi->glossy,
    };
    r->compose = r->indirect = sum;
    r->indirect.direct = (fg_res){ 0 };
    ag_compose_declare(&r->compose, r->graph, "frame.compose", "frame.radiance");
    ag_compose_declare(&r->indirect, r->graph, "frame.indirect", "frame.indirect_radiance");
    r->tone.exposure = r->desc.exposure > 0 ? r->desc.exposure : 1;
    r->tone.radiance = r->compose.out;
    ag_tone_declare(&r->tone, r->graph, "frame.tone", "frame.display");
}

// For messages: "direct", "isr.level".
static const char *layer_name(const renderer *r, renderer_layer layer, char *text, size_t size)
{
    const int i = (int) layer - (int) LAYER_PLUGIN;
    if (layer < LAYER_COUNT)
        return renderer_layer_names[layer];
    if (r->plugin && i < gi_layers_count(r->plugin))
        snprintf(text, size, "%s.%s", r->plugin->name, r->plugin->layers[i].name);
    else
        snprintf(text, size, "%d of %s", i,
                 r->plugin ? r->plugin->name : "a plugin that does not run");
    return text;
}

static void export_layers(renderer *r)
{
    char name[64];
    for (int i = 0; i < LAYER_END; i++) {
        if (!(r->desc.layers & 1u << i))
            continue;
        if (i < LAYER_COUNT || r->layers[i].id)
            fg_export(r->graph, r->layers[i]);
        else
            fg_fail(r->graph, "layer %s: is not there in this scene, at these settings",
                    layer_name(r, (renderer_layer) i, name, sizeof name));
    }
}

static fg_status declare(renderer *r)
{
    fg_graph *g = r->graph;
    const fg_frame_desc frame = {
        .width = r->desc.width,
        .height = r->desc.height,
        .features = r->features,
        .feature_names = ag_feature_names,
        .feature_count = AG_FEATURE_COUNT,
    };
    gi_outputs gi = { 0 };
    fg_graph_begin(g, &frame);
    const ag_scene_res scene = ag_gpu_scene_import(r->gpu, g);
    ag_gbuffer_declare(&r->gbuffer, g, r->gpu, &scene);
    ag_shadow_declare(&r->shadow, g, r->gpu, &scene, r->desc.shadow_size);
    const ag_direct_desc direct = { &scene, &r->gbuffer.out, r->shadow.maps, r->desc.shadow_taps };
    ag_direct_declare(&r->direct, g, r->gpu, &direct);
    declare_plugin(r, &scene, &gi);
    declare_output(r, &scene, &gi);
    const fg_res layers[] = {
        [LAYER_FINAL] = r->tone.out,
        [LAYER_RADIANCE] = r->compose.out,
        [LAYER_DIRECT] = r->direct.out,
        [LAYER_INDIRECT] = r->indirect.out,
        [LAYER_ALBEDO] = r->gbuffer.out.albedo,
        [LAYER_NORMAL] = r->gbuffer.out.normal,
        [LAYER_POSITION] = r->gbuffer.out.position,
    };
    memcpy(r->layers, layers, sizeof layers);
    memcpy(r->layers + LAYER_PLUGIN, gi.layers, sizeof gi.layers);
    export_layers(r);
    const fg_status status = fg_graph_compile(g);
    r->declared = status == FG_OK;
    return status;
}

fg_status renderer_frame(renderer *r, double time)
{
    ag_scene *scene = r->desc.scene;
    fg_status status = FG_OK;
    if (time != scene->time)
        ag_scene_set_time(scene, time);
    const ag_camera *camera = r->follows ? &scene->cameras[r->desc.camera_index] : &r->camera;
    status = ag_view_from_camera(r->desc.log, camera, r->desc.width, r->desc.height, &r->view);
    if (!status)
        status = ag_gpu_scene_update(r->gpu, &r->view);
    const gi_frame frame = { .view = &r->view, .index = r->frames, .time = time };
    if (!status && r->plugin && r->plugin->update)
        status = r->plugin->update(r->self, &frame);
    if (!status && !r->declared)
        status = declare(r);
    if (!status)
        status = fg_graph_run(r->graph);
    r->frames++;
    return status;
}

// ---- reading ------------------------------------------------------------------------------

uint32_t renderer_texture(renderer *r, renderer_layer layer)
{
    const bool wanted = r->declared && layer < LAYER_END && (r->desc.layers & 1u << layer);
    return wanted ? fg_graph_exported(r->graph, r->layers[layer]) : 0;
}

// Turns `count` rows of rgba from row `first` up, counted from the bottom, into rows of rgb from
// the top down.
static void store(const renderer *r, renderer_layer layer, const float *rgba, int first, int count,
                  image *out)
{
    for (int y = first; y < first + count; y++) {
        const float *from = rgba + (size_t) 4 * out->width * (y - first);
        float *to = out->rgb + (size_t) 3 * out->width * (out->height - 1 - y);
        for (int x = 0; x < out->width; x++, from += 4, to += 3) {
            const bool world = layer == LAYER_POSITION && from[3] > 0.5f;
            for (int c = 0; c < 3; c++)
                to[c] = world ? (float) ((double) from[c] + r->view.origin[c]) : from[c];
        }
    }
}

// Size of a layer's texture. What a plugin hands out may be anything.
static fg_status measure(const renderer *r, renderer_layer layer, uint32_t texture, int size[2])
{
    char name[64];
    const char *fault = NULL;
    int target = GL_TEXTURE_2D, format = 0;
    if (texture) {
        glGetTextureParameteriv(texture, GL_TEXTURE_TARGET, &target);
        glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
        glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_WIDTH, &size[0]);
        glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_HEIGHT, &size[1]);
    }
    if (!texture)
        fault = "is not there to be read";
    else if (layer >= LAYER_PLUGIN &&
             (target != GL_TEXTURE_2D || (format != GL_RGBA16F && format != GL_RGBA32F)))
        fault = "must be a 2D texture, RGBA16F or RGBA32F";
    if (!fault)
        return FG_OK;
    fg_logf(r->desc.log, FG_LOG_ERROR, "renderer: layer %s %s",
            layer_name(r, layer, name, sizeof name), fault);
    return FG_ERR_INVALID;
}

fg_status renderer_read(renderer *r, renderer_layer layer, image *out)
{
    // In bands: OpenGL counts the bytes of one call in an int.
    enum { BAND = 64 };
    const uint32_t texture = renderer_texture(r, layer);
    int extent[2] = { 0 };
    fg_status status = measure(r, layer, texture, extent);
    if (status)
        return status;
    const int width = extent[0], height = extent[1];
    const size_t size = sizeof(float) * 4 * (size_t) width * BAND;
    float *rgba = malloc(size);
    status = rgba ? image_create(r->desc.log, width, height, out) : FG_ERR_MEMORY;
    if (!status)
        glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    for (int y = 0; !status && y < height; y += BAND) {
        const int rows = height - y < BAND ? height - y : BAND;
        glGetTextureSubImage(texture, 0, 0, y, 0, width, rows, 1, GL_RGBA, GL_FLOAT, (GLsizei) size,
                             rgba);
        store(r, layer, rgba, y, rows, out);
    }
    free(rgba);
    return status;
}

fg_graph *renderer_graph(renderer *r)
{
    return r->graph;
}

int renderer_counters(renderer *r, gi_counter *out, int max)
{
    return r->plugin && r->plugin->counters ? r->plugin->counters(r->self, out, max) : 0;
}
