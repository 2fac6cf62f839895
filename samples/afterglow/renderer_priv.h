// SPDX-License-Identifier: MIT
#ifndef RENDERER_PRIV_H
#define RENDERER_PRIV_H

// The renderer from the inside: renderer.c owns its parts and runs frames, renderer_declare.c
// declares them, renderer_read.c reads what came out.

#include "renderer.h"

#include <pass/gbuffer.h>
#include <pass/lighting.h>
#include <pass/post.h>

enum { SIDES = 2 };
#define RENDERER_SECOND "b:" // what the second side's names begin with

// A plugin and what shows its light.
typedef struct branch {
    const gi_plugin *plugin;
    void *self;
    gi_value *values; // what it runs with; NULL without a plugin
    uint64_t frames;  // since the plugin was created
    unsigned layers;  // wanted
    bool dropped;     // the plugin was at fault: its layers are missed by nobody
    bool muted;       // the frame is tried without it

    ag_compose_pass compose, indirect;
    ag_tone_pass tone;
    fg_res layer[LAYER_END];
} branch;

struct renderer {
    renderer_desc desc; // `values` and `camera` point to what is borrowed no longer: unused
    uint64_t features;
    ag_gpu_scene *gpu;
    fg_graph *graph;
    ag_camera camera; // when the scene's own is not followed
    bool follows;
    ag_view view;

    fg_log log;        // what plugins and the graph say, on its way to desc.log
    bool trying;       // a failure may be a plugin's: errors are not said yet
    char heard[512];   // the first of them
    char fault[768];   // renderer_fault(), or ""
    bool trim_due;     // a plugin or its values have gone
    bool layer_failed; // a layer that was asked for is not there

    bool declared;
    ag_gbuffer_pass gbuffer;
    ag_shadow_pass shadow;
    ag_direct_pass direct;
    branch side[SIDES];
    int sides; // 2: split
};

fg_status renderer_declare(renderer *r);
// For messages: "direct", "isr.level".
const char *renderer_layer_text(const branch *b, renderer_layer layer, char *text, size_t size);

#endif // RENDERER_PRIV_H
