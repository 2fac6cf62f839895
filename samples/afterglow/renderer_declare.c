// SPDX-License-Identifier: MIT
#include "renderer_priv.h"

#include <stdio.h>
#include <string.h>

static fg_status never_run(const fg_run *run, void *user)
{
    (void) run;
    (void) user;
    return FG_ERR_INVALID;
}

static void declare_plugin(renderer *r, branch *b, const ag_scene_res *scene, gi_outputs *out)
{
    const gi_inputs in = {
        .width = r->desc.width,
        .height = r->desc.height,
        .gbuffer = r->gbuffer.out,
        .scene = *scene,
        .direct = r->direct.out,
    };
    if (!b->plugin || b->muted)
        return;
    if (!(b->plugin->needs & ~r->features)) {
        b->plugin->declare(b->self, r->graph, &in, out);
        return;
    }
    // A pass that stands for the whole technique, so that the graph lists it with the reason.
    char name[64];
    snprintf(name, sizeof name, "%s.technique", b->plugin->name);
    const fg_pass_desc absent = {
        .name = name,
        .effect = FG_EFFECT_EXTERNAL,
        .needs = b->plugin->needs,
        .run = never_run,
    };
    fg_passes(r->graph, &absent, 1);
}

static void declare_output(renderer *r, branch *b, const ag_scene_res *scene, const gi_outputs *gi)
{
    const ag_compose_pass sum = {
        .view = scene->view,
        .direct = r->direct.out,
        .albedo = r->gbuffer.out.albedo,
        .indirect = gi->indirect,
        .glossy = gi->glossy,
    };
    b->compose = b->indirect = sum;
    b->indirect.direct = (fg_res){ 0 };
    ag_compose_declare(&b->compose, r->graph, "frame.compose", "frame.radiance");
    ag_compose_declare(&b->indirect, r->graph, "frame.indirect", "frame.indirect_radiance");
    b->tone.exposure = r->desc.exposure > 0 ? r->desc.exposure : 1;
    b->tone.radiance = b->compose.out;
    ag_tone_declare(&b->tone, r->graph, "frame.tone", "frame.display");
}

static void declare_side(renderer *r, branch *b, const ag_scene_res *scene, const char *prefix)
{
    gi_outputs gi = { 0 };
    fg_prefix(r->graph, prefix);
    declare_plugin(r, b, scene, &gi);
    fg_prefix(r->graph, prefix); // the plugin may have had one of its own
    declare_output(r, b, scene, &gi);
    const fg_res layers[] = {
        [LAYER_FINAL] = b->tone.out,
        [LAYER_RADIANCE] = b->compose.out,
        [LAYER_DIRECT] = r->direct.out,
        [LAYER_INDIRECT] = b->indirect.out,
        [LAYER_ALBEDO] = r->gbuffer.out.albedo,
        [LAYER_NORMAL] = r->gbuffer.out.normal,
        [LAYER_POSITION] = r->gbuffer.out.position,
    };
    memcpy(b->layer, layers, sizeof layers);
    memcpy(b->layer + LAYER_PLUGIN, gi.layers, sizeof gi.layers);
}

const char *renderer_layer_text(const branch *b, renderer_layer layer, char *text, size_t size)
{
    const int i = (int) layer - (int) LAYER_PLUGIN;
    if (layer < LAYER_COUNT)
        return renderer_layer_names[layer];
    if (b->plugin && i < gi_layers_count(b->plugin))
        snprintf(text, size, "%s.%s", b->plugin->name, b->plugin->layers[i].name);
    else
        snprintf(text, size, "%d of %s", i,
                 b->plugin ? b->plugin->name : "a plugin that does not run");
    return text;
}

// The first layer that the side is to give and cannot; LAYER_END if there is none.
static renderer_layer export_layers(renderer *r, const branch *b)
{
    renderer_layer missing = LAYER_END;
    for (int i = 0; i < LAYER_END; i++) {
        if (!(b->layers & 1u << i))
            continue;
        if (i < LAYER_COUNT || b->layer[i].id)
            fg_export(r->graph, b->layer[i]);
        else if (missing == LAYER_END)
            missing = (renderer_layer) i;
    }
    // Where nothing else was asked for there would be nothing to run.
    if (missing != LAYER_END)
        fg_export(r->graph, b->layer[LAYER_FINAL]);
    return missing;
}

// A layer that is not there fails the frame, but that is no mistake of the plugin's passes: they
// have compiled.
static fg_status check_layers(renderer *r, const renderer_layer *missing)
{
    char name[64];
    for (int i = 0; i < r->sides; i++) {
        const branch *b = &r->side[i];
        if (missing[i] == LAYER_END || b->muted || b->dropped)
            continue;
        fg_logf(r->desc.log, FG_LOG_ERROR,
                "layer %s: is not there in this scene, at these settings",
                renderer_layer_text(b, missing[i], name, sizeof name));
        r->layer_failed = true;
        return FG_ERR_INVALID;
    }
    return FG_OK;
}

fg_status renderer_declare(renderer *r)
{
    fg_graph *g = r->graph;
    const fg_frame_desc frame = {
        .width = r->desc.width,
        .height = r->desc.height,
        .features = r->features,
        .feature_names = ag_feature_names,
        .feature_count = AG_FEATURE_COUNT,
    };
    renderer_layer missing[SIDES];
    fg_graph_begin(g, &frame);
    const ag_scene_res scene = ag_gpu_scene_import(r->gpu, g);
    ag_gbuffer_declare(&r->gbuffer, g, r->gpu, &scene);
    ag_shadow_declare(&r->shadow, g, r->gpu, &scene, r->desc.shadow_size);
    const ag_direct_desc direct = { &scene, &r->gbuffer.out, r->shadow.maps, r->desc.shadow_taps };
    ag_direct_declare(&r->direct, g, r->gpu, &direct);
    for (int i = 0; i < r->sides; i++) {
        declare_side(r, &r->side[i], &scene, i ? RENDERER_SECOND : "");
    }
    fg_prefix(g, "");
    for (int i = 0; i < r->sides; i++)
        missing[i] = export_layers(r, &r->side[i]);
    fg_status status = fg_graph_compile(g);
    if (!status)
        status = check_layers(r, missing);
    r->declared = status == FG_OK;
    return status;
}
