// SPDX-License-Identifier: MIT
#ifndef RENDERER_H
#define RENDERER_H

#include "image.h"

#include <fg/gl.h>
#include <gi/registry.h>

FG_BEGIN

// A frame of a scene through the graph: G-buffer, shadows, direct light, a plugin, compose,
// tone curve. What render, sequence, report, stability and view are all made of.
typedef enum renderer_layer {
    LAYER_FINAL = 0, // tone mapped, linear display values in [0, 1]
    LAYER_RADIANCE,  // W/(m^2 sr), all light
    LAYER_DIRECT,
    LAYER_INDIRECT, // albedo x E / pi + glossy
    LAYER_ALBEDO,
    LAYER_NORMAL,
    LAYER_POSITION, // world; 0 where nothing is
    LAYER_COUNT,
    LAYER_PLUGIN = LAYER_COUNT, // and on: the plugin's debug layers, in the order of its table
    LAYER_END = LAYER_PLUGIN + GI_MAX_LAYERS,
} renderer_layer;
extern const char *const renderer_layer_names[LAYER_COUNT];

typedef struct renderer renderer;

typedef struct renderer_desc {
    const fg_log *log;
    fg_device *device;       // a gl device, current; borrowed, as all below
    ag_scene *scene;         // the renderer sets its time
    const ag_camera *camera; // copied; NULL: follows the scene's first, else a framing one
    int camera_index;        // with camera NULL: of the scene's (it may move)
    int width, height;
    const gi_plugin *plugin; // NULL: direct light alone
    const gi_value *values;  // copied; NULL: defaults
    float exposure;          // radiance of 1 after exposure is a middle-bright white; 0: 1
    unsigned layers;         // bits 1 << layer that can be read back; 0: final alone. A frame
                             // that is to give a layer that the plugin does not have fails.
    bool needs_all;          // every feature counts as present: nothing is left out
    bool strict;             // a plugin that fails is a frame that fails: see renderer_fault()
    unsigned debug;          // fg_debug bits
    uint64_t seed;
    void (*inspect)(void *user, const fg_written *written);
    void *inspect_user;
    // Of direct light, as ag_shadow_declare() and ag_direct_desc have them; 0: their defaults.
    int shadow_size, shadow_taps;
} renderer_desc;

FG_NODISCARD fg_status renderer_create(const renderer_desc *desc, renderer **out);
void renderer_destroy(renderer *r); // accepts NULL

// Between two frames. The old plugin is destroyed first, and the next frame frees what the graph
// held for it alone; what is before the plugin keeps its textures. If the new one fails in create
// the frame goes on with direct light and the status says why. The same plugin keeps its state
// where it can take the values.
FG_NODISCARD fg_status renderer_set_plugin(renderer *r, const gi_plugin *plugin,
                                           const gi_value *values);

// What the same G-buffer, shadows and direct light are the start of besides: a plugin, the same or
// another, for pictures side by side. Its passes and resources are "b:...".
typedef struct renderer_side {
    const gi_plugin *plugin; // NULL: direct light alone
    const gi_value *values;  // copied; NULL: defaults
    unsigned layers;         // as renderer_desc.layers
} renderer_side;

// Between two frames; NULL ends the split. A plugin that stays is kept as it is if its values do,
// else as by renderer_set_plugin(), which errors are of, too.
FG_NODISCARD fg_status renderer_set_split(renderer *r, const renderer_side *second);
// What can be read back of the next frames; as `layers` of the descriptor.
FG_NODISCARD fg_status renderer_set_layers(renderer *r, unsigned layers);
FG_NODISCARD fg_status renderer_resize(renderer *r, int width, int height);
// The next frames' camera; copied. The scene's is no longer followed.
void renderer_set_camera(renderer *r, const ag_camera *camera);

// Of the next frames, without a compile; 0: 1.
FG_NODISCARD fg_status renderer_set_exposure(renderer *r, float exposure);

// Sets the scene to `time` and runs one frame. Never waits for the GPU.
//
// A plugin that fails in update, whose passes do not compile, or one of whose passes fails or
// touches what it did not declare, is dropped, and this very frame goes on with direct light: the
// status is FG_OK, renderer_fault() says which and why, and so does a warning in the log. It is at
// fault where the frame succeeds without it; if it does not, the failure comes out and the plugin
// stays. Of two that are split, one that is sound stays. A renderer that is `strict` fails instead.
FG_NODISCARD fg_status renderer_frame(renderer *r, double time);

// "plugin 'x' failed in a frame: pass 'x.light' ..." of the last plugin that was dropped or did not
// start; NULL once another was set since, on either side, or if there was none. Until the next call
// that may fail. Debug layers of a plugin that was dropped are not there, which fails no frame.
const char *renderer_fault(const renderer *r);

// Reads a layer of the last frame, of the frame's size but for debug layers; waits.
FG_NODISCARD fg_status renderer_read(renderer *r, renderer_layer layer, image *out);
// Likewise of the second side.
FG_NODISCARD fg_status renderer_second_read(renderer *r, renderer_layer layer, image *out);

// The texture of a layer of the last frame, for a window: 0 if it was not asked for in `layers`.
// Rows from the bottom up; valid until the next frame. POSITION is in render space.
uint32_t renderer_texture(renderer *r, renderer_layer layer);
// Likewise of the second side; 0 without a split.
uint32_t renderer_second_texture(renderer *r, renderer_layer layer);

fg_graph *renderer_graph(renderer *r);
// What a side shows, 0 or 1; NULL: direct light alone, or there is no such side.
const gi_plugin *renderer_plugin(const renderer *r, int side);
int renderer_counters(renderer *r, gi_counter *out, int max);

FG_END

#endif // RENDERER_H
