// SPDX-License-Identifier: MIT
#ifndef GI_PLUGIN_H
#define GI_PLUGIN_H

#include <fg/graph.h>
#include <pass/frame.h>

FG_BEGIN

// A global-illumination technique as a plugin of the frame graph:
//
//     const gi_plugin *p = gi_find(registry, "rsm");            // gi/registry.h
//     gi_value *values = ...;                                   // gi_params_default(),
//     gi_params_set() void *self; p->create(&(gi_env){ .device = dev, .scene = scene }, values,
//     &self); for each frame:
//         p->update(self, &frame);                              // CPU work
//         fg_graph_begin(...); ... G-buffer ...
//         p->declare(self, g, &in, &out);                       // passes "rsm.*"
//         ... compose reads out.indirect ...
//     p->destroy(self);
enum { GI_PLUGIN_ABI = 2 };

// ---- parameters --------------------------------------------------------------------

typedef enum gi_type {
    GI_INT = 0,
    GI_FLOAT,
    GI_BOOL, // "0", "1", "false", "true", "off", "on"
    GI_ENUM, // one of `choices`; the value is its index
} gi_type;

// One row of a plugin's table. The order of rows is the order of values.
typedef struct gi_param {
    const char *name; // "rsm_size"
    gi_type type;
    const char *unit; // "texels", "m", "1" for a pure number
    double min, max;  // inclusive; ignored for BOOL and ENUM
    double def;
    const char *const *choices; // ENUM: ends at NULL
    const char *help;           // one line
    bool power_of_two;          // INT: no other values
    bool quality;               // `report` sweeps it over `sweep`
    const double *sweep;        // quality values from cheap to exact, ends at NAN
} gi_param;

// A value by its row's type: i for INT, BOOL and ENUM, f for FLOAT.
typedef union gi_value {
    int64_t i;
    double f;
} gi_value;

// ---- debug layers --------------------------------------------------------------------

// A picture of a technique's inner workings, e.g. which level of a hierarchy lights a pixel, for
// `render --layer NAME`. Its passes cost nothing while nobody looks: the graph culls them.
typedef struct gi_layer {
    const char *name; // "level"; at most 31 letters, no '.'; a plugin's own
    const char *help; // one line
} gi_layer;

enum { GI_MAX_LAYERS = 8 };

// ---- what a plugin gets ---------------------------------------------------------------

typedef struct gi_env {
    const fg_log *log;     // Optional. This and all below: borrowed for the life of the plugin.
    fg_device *device;     // current on the calling thread
    const ag_scene *scene; // its time is the frame's when update() and the passes run
    ag_gpu_scene *gpu_scene;
} gi_env;

typedef struct gi_frame {
    const ag_view *view; // borrowed until the frame has run
    uint64_t index;      // 0, 1, 2, ... since create()
    double time;         // seconds
} gi_frame;

// What the host has declared before. Handles are of this declaration.
typedef struct gi_inputs {
    int width, height;
    ag_gbuffer gbuffer;
    ag_scene_res scene; // view, vertices, instances, materials, lights, as graph resources
    fg_res direct;      // RGBA32F: radiance of direct light and emission, W/(m^2 sr)
} gi_inputs;

// All but layers of the inputs' size. A null handle: the technique gives none.
typedef struct gi_outputs {
    fg_res indirect; // RGBA16F or RGBA32F: outgoing indirect radiance over albedo, that is E / pi,
                     // W/(m^2 sr)
    fg_res glossy;   // likewise: reflected glossy radiance, W/(m^2 sr), to be added as it is

    // In the order of the plugin's table: RGBA16F or RGBA32F, of any size, rows from the bottom
    // up, linear values in [0, 1] to be shown as they are. Null: not at these settings.
    fg_res layers[GI_MAX_LAYERS];
} gi_outputs;

typedef struct gi_counter {
    const char *name; // "vpls"; static
    double value;
} gi_counter;

// ---- the vtable -----------------------------------------------------------------------------

// Each plugin folder defines exactly one. All calls come from the thread that owns the
// device's context. Call order: create; then a frame at a time update, declare (only when
// something changed that declarations depend on), run; counters any time; destroy.
typedef struct gi_plugin {
    int abi;                // GI_PLUGIN_ABI
    const char *name;       // the folder, e.g. "rsm"; also the prefix of its passes and resources
    const char *source;     // the paper: authors, title, venue, year
    const char *summary;    // one line: what it computes and what it leaves out
    const gi_param *params; // ends at a NULL name
    const gi_layer *layers; // ends at a NULL name, at most GI_MAX_LAYERS. Optional.
    uint64_t needs; // scene features without which there is nothing to do, e.g. AG_FEATURE_LIGHT

    // `values` has one entry per row of `params`, all in range, and is copied.
    // On failure `*self` is NULL and nothing is left allocated.
    fg_status (*create)(const gi_env *env, const gi_value *values, void **self);

    // New values without losing the rest. FG_ERR_UNSUPPORTED: create anew. Optional.
    fg_status (*set)(void *self, const gi_value *values);

    // CPU work before a frame: light motion, buffer contents. Optional. A plugin that fails here,
    // in what it declares or in a pass may be dropped: samples/afterglow goes on with direct light.
    fg_status (*update)(void *self, const gi_frame *frame);

    // Adds the technique's passes and fills `out`, zeroed by the caller. Errors stick to the graph.
    void (*declare)(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out);

    // Fills at most `max`; returns how many there are. Never waits for the GPU. Optional.
    int (*counters)(void *self, gi_counter *out, int max);

    // Accepts NULL and half-built objects.
    void (*destroy)(void *self);
} gi_plugin;

// A shared module gi_NAME.so exports one function, by this name; its vtable is static:
//
//     GI_PLUGIN_ENTRY(rsm)
//     {
//         return &plugin;
//     }
#define GI_PLUGIN_SYMBOL "gi_plugin_entry"
typedef const gi_plugin *(*gi_plugin_entry_fn)(void);

#ifdef GI_PLUGINS_LINKED // all techniques in one library: each entry has a name of its own
#define GI_PLUGIN_ENTRY(name)                                                                      \
    const gi_plugin *gi_plugin_entry_##name(void);                                                 \
    const gi_plugin *gi_plugin_entry_##name(void)
#else
#define GI_PLUGIN_ENTRY(name)                                                                      \
    FG_API const gi_plugin *gi_plugin_entry(void);                                                 \
    FG_API const gi_plugin *gi_plugin_entry(void)
#endif

FG_END

#endif // GI_PLUGIN_H
