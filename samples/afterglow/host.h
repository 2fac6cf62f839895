// SPDX-License-Identifier: MIT
#ifndef HOST_H
#define HOST_H

#include "cli.h"

#include <cjson/cJSON.h>

// What the commands share: the scene as the options ask for it, plugins with their values, the
// device, one renderer. Functions that can fail return an exit code and have noted why.

// A plugin and what it is set to. Plugin NULL: direct light alone.
typedef struct setting {
    const gi_plugin *plugin;
    gi_value *values;     // owned; NULL without a plugin
    renderer_layer layer; // what --layer asks for, where a command takes it
} setting;

void setting_finish(setting *s);
bool setting_copy(const setting *from, setting *to); // false: out of memory
const char *setting_name(const setting *s);          // the plugin's, or "none"

typedef struct host {
    cli *c;
    const options *o;
    gi_registry *registry;
    ag_scene *scene;
    const char *scene_name; // as it was asked for
    ag_camera camera;       // where has_camera
    bool has_camera;        // else the scene's, by index
    int camera_index;
    fg_gl_context *context;
    fg_device *device;
    bool dark_said; // the warning that surfaces alone shine, once a scene
    bool as_it_is;  // host_open_scene() adds no default light
    bool hot;       // plugins can be loaded again: set before host_open_registry()
    bool fell_back; // the plugin failed: direct light goes on alone
    bool refused;   // a module that was asked for was refused: nobody knows its parameters
} host;

void host_init(host *h, cli *c, const options *o);
void host_finish(host *h);

int host_open_registry(host *h);
// Opens the scene (the one before is closed), adds lights, chooses the camera.
int host_open_scene(host *h, const char *name);
// Takes over a scene that was made by code, or NULL.
void host_take_scene(host *h, ag_scene *scene, const char *name);
int host_open_device(host *h);
// A device for the context that is current, of a window: the caller's.
int host_take_context(host *h);
void host_drop_device(host *h); // before the context of host_take_context() goes

bool host_has_plugin(const host *h, const char *name); // whether there is one; it may not load
// The plugin `name` with the values that --set gives. An unknown name is wrong usage; a module
// that is there and was refused leaves plugin NULL, with a warning: direct light goes on alone.
int host_setting(host *h, const char *name, setting *out);
// One setting for each --gi, or for each plugin that loads when `all` and none was given.
// `out` has CLI_MAX_GI entries.
int host_settings(host *h, bool all, setting *out, int *count);
// All that a frame of the first operand takes, in the order in which mistakes are cheapest to find:
// registry, settings (one for each --gi), scene, device.
int host_open(host *h, setting *out, int *count);
// Complains about a --set that none of the plugins takes, unless one was refused.
int host_check_set(host *h, const setting *settings, int count);

// The camera at the scene's current time.
ag_camera host_camera(const host *h);
// Whether the scene has what the plugin needs; if not, `why` names the first thing lacking.
bool host_serves(const host *h, const gi_plugin *plugin, const char **why);

// A descriptor with all that the options say; the caller adds its own.
renderer_desc host_renderer_desc(const host *h, const setting *s, int width, int height);

// Creates a renderer with the descriptor's plugin. One that fails in create is a warning, not a
// failure: direct light goes on alone and `fell_back` says so.
FG_NODISCARD fg_status host_renderer(host *h, const renderer_desc *desc, renderer **out);
// Likewise between two frames.
FG_NODISCARD fg_status host_switch(host *h, renderer *r, const setting *s);
// renderer_frame(), and `fell_back` where the plugin was at fault; the renderer has warned.
FG_NODISCARD fg_status host_frame(host *h, renderer *r, double time);

image_kind host_layer_kind(renderer_layer layer);
// -o: there, with an extension of a picture where `picture`, and writable.
int host_check_output(cli *c, const options *o, bool picture);
// --trace, if it is given: writable, and no other file of this command.
int host_check_trace(cli *c, const options *o);
// -o as a folder: made, and writable.
int host_check_folder(cli *c, const options *o);

#endif // HOST_H
