// SPDX-License-Identifier: MIT
#ifndef VIEW_PRIV_H
#define VIEW_PRIV_H

#include "trace.h"
#include "view.h"
#include "view_camera.h"
#include "view_keys.h"
#include "view_params.h"
#include "view_present.h"
#include "view_state.h"
#include "view_window.h"

// What the parts of the viewer share.

// ---- plugins (view_gi.c) ---------------------------------------------------------------------

// A plugin by name, with the values that it keeps on either side while others are shown. The first
// is "none".
typedef struct view_slot {
    const char *name; // the registry's
    setting sides[2]; // plugin NULL: not loaded yet, refused, or none
    bool loaded;      // or tried to
    bool given;       // by --gi: one of those that the keys go through
} view_slot;

typedef struct view_gi {
    view_slot *slots;
    const char **names; // of the slots, for a list
    int count;
    bool any_given; // else the keys go through all
    int side[2];    // slots wanted: left (or alone) and right
    bool split;
    double divider;         // of the width
    unsigned wanted;        // a bit for each side of which the renderer has something else
    bool said;              // the window says what it prepares
    bool quiet;             // or need not: it takes no time
    int applied;            // slot of the left side that the renderer was given
    bool ready;             // a frame with what was asked for at first was shown
    bool shows_split;       // the renderer's
    renderer_layer second;  // layer of the second side that the renderer gives
    double looked, scanned; // seconds: when modules and folders were last looked at
} view_gi;

// ---- figures (view_stats.c) ------------------------------------------------------------------

enum { VIEW_MAX_PASSES = 128, VIEW_MAX_COUNTERS = 64 };

typedef struct view_pass {
    char name[VIEW_NAME];
    double gpu_ms, cpu_ms; // averaged; gpu_ms negative: none yet
} view_pass;

typedef struct view_stats {
    view_history frames; // from one frame to the next
    double cpu_ms;       // of a frame's submission, averaged
    view_pass passes[VIEW_MAX_PASSES];
    int pass_count;
    gi_counter counters[VIEW_MAX_COUNTERS];
    int counter_count;
    fg_graph_stats graph;
} view_stats;

// ---- the graph's picture (view_graph.c) ------------------------------------------------------

typedef struct view_graph_row {
    char name[VIEW_NAME], shape[VIEW_NAME];
    double bytes;
    int first, last; // steps
    int slot;        // of memory: equal ones share it
    char memory[16]; // "transient", "import", "history", "export"
} view_graph_row;

typedef struct view_graph {
    bool shown, stale;
    int compiles; // of the graph that this is a picture of
    view_graph_row *rows;
    int row_count;
    char (*passes)[VIEW_NAME];
    int pass_count;
} view_graph;

// ---- all -------------------------------------------------------------------------------------

typedef struct view {
    host *h;
    const view_start *start;
    fg_log log; // to the panel and to stderr
    view_window window;
    view_presenter presenter;
    renderer *r;
    trace *events; // --trace; NULL without
    view_gi gi;
    view_clock clock;
    view_camera camera;
    int camera_index; // of the scene, followed; -1: the viewer's own
    const char **camera_names;
    renderer_layer layer; // wanted
    renderer_layer shown; // of the last frame
    double exposure;
    int size[2];    // of the last frame
    int scale_log2; // of the frame against the window: 0, 1 or 2
    view_stats stats;
    view_graph graph;
    view_messages messages;
    bool panel, help;
    bool ui;          // ui_create() was called
    bool dragging;    // the divider
    bool window_shot; // after this frame is drawn
    bool quit;
    int64_t frames; // shown
    double now;     // seconds since the command began
    char params_path[1024];
    char shot_dir[900];
    int shots; // written
} view;

// view.c
// A line in the panel and, at FG_LOG_WARN and above or with --verbose, on stderr.
void view_say(view *v, fg_log_level level, const char *fmt, ...) FG_PRINTF(3, 4);
void view_do(view *v, view_action action); // view_actions.c
void view_own_camera(view *v);             // stops following the scene's
void view_follow_camera(view *v, int index);
void view_frame_size(const view *v, int size[2]);

// view_gi.c
bool view_gi_create(view *v); // false: out of memory
void view_gi_finish(view *v);
const char *view_gi_name(const view *v, int side);
setting *view_gi_setting(view *v, int side);
void view_gi_want(view *v, int side, int slot); // shown when the window has said so
void view_gi_next(view *v, int side, int step);
void view_gi_split(view *v, bool split);
// Values, or what else a plugin is to begin anew with, changed; `sides`: a bit each.
void view_gi_touch(view *v, unsigned sides);
void view_gi_nudge(view *v, unsigned sides); // by as little as a slider moves: nothing is said
int view_gi_find(const view *v, const char *name); // -1: there is none
bool view_gi_load(view *v, int slot);              // false: refused; the log has said why
// Between two frames: what is wanted becomes what is shown. Failures are messages.
void view_gi_apply(view *v);
// Of the next frame, in each: the layers that are shown.
FG_NODISCARD fg_status view_gi_layers(view *v);
// view_reload.c: modules that have changed, appeared or gone, a few times a second.
bool view_gi_scan(view *v); // slots for all names there are; false: out of memory
void view_gi_watch(view *v);
// Layers there are with the left plugin.
int view_layer_count(view *v);
const char *view_layer_name(view *v, int layer, char *text, size_t size);
void view_layer_set(view *v, renderer_layer layer);

// view_set.c
void view_save_set(view *v);
void view_load_set(view *v);
// All of it or, with a line that says why, nothing.
FG_NODISCARD fg_status view_take_set(view *v, const char *path, const view_set *s);
void view_shoot_frame(view *v);
void view_shoot_window(view *v);

// view_panel.c, view_param_rows.c, view_stats.c, view_graph.c
void view_panel(view *v);
// What the panels leave of the window, where that is enough for a line of text: from, to, pixels.
void view_free_part(const view *v, float *left, float *right);
void view_param_rows(view *v, int side);
void view_stats_take(view *v, double cpu_ms); // of a frame that was submitted
void view_stats_plot(const view *v);
void view_stats_panel(view *v);
void view_graph_panel(view *v);
void view_graph_finish(view_graph *g);

#endif // VIEW_PRIV_H
