// SPDX-License-Identifier: MIT
#include "view_priv.h"

#include "ui_bridge.h"

#include <string.h>

// ---- what is shown ---------------------------------------------------------------------------

static void name_cell(const char *name, const char *help)
{
    ui_table_next();
    ui_text(UI_PLAIN, name);
    ui_tooltip(help);
    ui_table_next();
}

static void plugin_row(view *v, int side)
{
    int slot = v->gi.side[side];
    const gi_plugin *p = view_gi_setting(v, side)->plugin;
    const char *why = NULL;
    char text[128];
    name_cell(side ? "right" : "plugin",
              side ? "Shift+N and Shift+P go through them" : "N and P go through them");
    if (ui_combo(side ? "##right" : "##plugin", &slot, v->gi.names, v->gi.count))
        view_gi_want(v, side, slot);
    ui_tooltip(p ? p->summary : "direct light alone");
    if (host_serves(v->h, p, &why))
        return;
    snprintf(text, sizeof text, "does nothing: the scene has no %s", why);
    ui_text(UI_WARN, text);
}

static void plugin_rows(view *v)
{
    bool split = v->gi.split;
    plugin_row(v, 0);
    name_cell("split", "X: another plugin on the right; drag the line between");
    if (ui_checkbox("##split", &split))
        view_gi_split(v, split);
    if (split)
        plugin_row(v, 1);
}

static void layer_row(view *v)
{
    char names[LAYER_END][VIEW_NAME];
    const char *items[LAYER_END];
    const int count = view_layer_count(v);
    int layer = (int) v->layer;
    for (int i = 0; i < count; ++i)
        items[i] = view_layer_name(v, i, names[i], VIEW_NAME);
    name_cell("layer", "L and K go through them. What is not shown costs nothing");
    if (ui_combo("##layer", &layer, items, count))
        view_layer_set(v, (renderer_layer) layer);
    const gi_plugin *p = view_gi_setting(v, 0)->plugin;
    if (p && layer >= LAYER_COUNT && layer < count)
        ui_tooltip(p->layers[layer - LAYER_COUNT].help);
}

static void exposure_row(view *v)
{
    const ui_range range = { 1e-4, 1e4, "%.4g", true };
    name_cell("exposure", "factor before the tone curve of the final layer; = and -");
    ui_slider_float("##exposure", &v->exposure, &range);
}

static void camera_rows(view *v)
{
    const int count = v->h->scene->camera_count;
    int index = v->camera_index < 0 ? count : v->camera_index;
    bool orbit = v->camera.orbiting;
    name_cell("camera", "C goes through the scene's; WASD and the right button fly");
    if (ui_combo("##camera", &index, v->camera_names, count + 1)) {
        if (index < count)
            view_follow_camera(v, index);
        else
            view_own_camera(v);
    }
    name_cell("orbit", "O: turn around what is in the middle");
    if (ui_checkbox("##orbit", &orbit))
        view_do(v, VIEW_ORBIT);
    const ui_range speed = { 1e-3, 1e4, "%.3g m/s", true };
    name_cell("speed", "of flight; the wheel changes it");
    ui_slider_float("##speed", &v->camera.speed, &speed);
}

static void scale_row(view *v)
{
    static const char *const scales[] = { "1", "1/2", "1/4" };
    int size[2];
    char text[64];
    view_frame_size(v, size);
    name_cell("scale", "of the frame against the window, for slow devices; [ and ]");
    ui_combo("##scale", &v->scale_log2, scales, FG_COUNT(scales));
    snprintf(text, sizeof text, "a frame of %d x %d", size[0], size[1]);
    ui_tooltip(text);
}

static void clock_line(view *v)
{
    char text[64];
    if (ui_button(v->clock.paused ? "Go" : "Pause"))
        view_do(v, VIEW_PAUSE);
    ui_tooltip("Space");
    ui_same_line();
    if (ui_button("Step"))
        view_do(v, VIEW_STEP);
    ui_tooltip(". (period): 1/60 s");
    ui_same_line();
    if (ui_button("Reset"))
        view_do(v, VIEW_RESET);
    ui_tooltip("R: the clock to 0, the plugin anew");
    ui_same_line();
    snprintf(text, sizeof text, "%.2f s, frame %lld", view_clock_seconds(&v->clock),
             (long long) v->clock.tick);
    ui_text(UI_DIM, text);
}

static void files(view *v)
{
    ui_input("##path", v->params_path, sizeof v->params_path);
    ui_tooltip("file of the parameter set: plugin, values, layer, exposure, camera");
    if (ui_button("Save"))
        view_do(v, VIEW_SAVE);
    ui_tooltip("F7");
    ui_same_line();
    if (ui_button("Load"))
        view_do(v, VIEW_LOAD);
    ui_tooltip("F8");
    ui_same_line();
    if (ui_button("Picture"))
        view_do(v, VIEW_SHOT);
    ui_tooltip("F5: PNG of the frame; F6: of the window");
    ui_same_line();
    if (ui_button("Graph"))
        view_do(v, VIEW_GRAPH);
    ui_tooltip("G");
    ui_same_line();
    if (ui_button("Keys"))
        view_do(v, VIEW_HELP);
    ui_tooltip("F1");
}

// ---- where things stand ----------------------------------------------------------------------

static float edge(void)
{
    return 0.6f * ui_unit();
}

static float panel_width(const view *v)
{
    const float wide = 30 * ui_unit(), most = 0.9f * (float) v->window.width;
    return wide < most ? wide : most;
}

// On a wide window the figures stand on the right, else below the controls.
static bool two_panels(const view *v)
{
    return (float) v->window.width > 110 * ui_unit();
}

void view_free_part(const view *v, float *left, float *right)
{
    const float taken = panel_width(v) + edge();
    *left = v->panel ? taken : 0;
    *right = (float) v->window.width - (v->panel && two_panels(v) ? taken : 0);
    if (*right - *left > 15 * ui_unit())
        return;
    *left = 0;
    *right = (float) v->window.width;
}

// ---- the windows -----------------------------------------------------------------------------

static void fault(const view *v)
{
    const char *text = renderer_fault(v->r);
    if (text)
        ui_text_wrapped(UI_BAD, text, 0);
}

static void controls(view *v, bool alone)
{
    const float widths[] = { 8 * ui_unit(), 0 };
    fault(v);
    if (ui_table_begin("view", widths, FG_COUNT(widths))) {
        plugin_rows(v);
        layer_row(v);
        exposure_row(v);
        scale_row(v);
        camera_rows(v);
        ui_table_end();
    }
    clock_line(v);
    view_stats_plot(v);
    files(v);
    view_param_rows(v, 0);
    if (v->gi.split)
        view_param_rows(v, 1);
    if (alone)
        view_stats_panel(v);
}

static void main_panel(view *v)
{
    const bool two = two_panels(v);
    const ui_window left = {
        .title = "afterglow",
        .x = edge(),
        .y = edge(),
        .width = panel_width(v),
        .height = (float) v->window.height - 2 * edge(),
        .flags = UI_FIXED,
    };
    ui_window right = left;
    right.title = "figures";
    right.x = (float) v->window.width - panel_width(v) - edge();
    if (ui_window_begin(&left, NULL))
        controls(v, !two);
    ui_window_end();
    if (!two)
        return;
    if (ui_window_begin(&right, NULL))
        view_stats_panel(v);
    ui_window_end();
}

static void help_window(view *v)
{
    const float em = ui_unit(), widths[] = { 9 * em, 36 * em };
    const float most = (float) v->window.height - 4 * em, tall = 60 * em;
    const ui_window window = {
        .title = "Keys",
        .x = 0.5f * (float) v->window.width - 23 * em,
        .y = 2 * em,
        .width = 46 * em,
        .height = tall < most ? tall : most,
    };
    const view_key_help *key;
    if (ui_window_begin(&window, &v->help) && ui_table_begin("keys", widths, FG_COUNT(widths))) {
        for (int i = 0; (key = view_key_list(i)); ++i) {
            ui_table_next();
            ui_text(UI_ACCENT, key->key);
            ui_table_next();
            ui_text(UI_PLAIN, key->help);
        }
        ui_table_end();
    }
    ui_window_end();
}

// What takes seconds is said before it is done.
static void notice(const view *v, char *text, size_t size)
{
    const bool both = v->gi.split && v->gi.wanted == 3;
    const char *first = view_gi_name(v, v->gi.wanted & 1 ? 0 : 1);
    if (v->gi.wanted == 2 && !v->gi.split)
        snprintf(text, size, "ending the split ...");
    else
        snprintf(text, size, "preparing %s%s%s ...", first, both ? " and " : "",
                 both ? view_gi_name(v, 1) : "");
}

// Whether a message is shown: news with the panel alone, a fault where the panel has not got it.
static bool is_shown(const view *v, const view_message *m)
{
    const char *fault = renderer_fault(v->r);
    if (!v->panel)
        return m->level <= FG_LOG_WARN;
    return !fault || !strstr(m->text, fault);
}

// Below the picture, where they push nothing aside.
static void messages(const view *v)
{
    static const ui_color colors[] = { [FG_LOG_ERROR] = UI_BAD, [FG_LOG_WARN] = UI_WARN };
    float left, right;
    view_free_part(v, &left, &right);
    const ui_window window = {
        .title = "##messages",
        .x = 0.5f * (left + right),
        .y = (float) v->window.height - ui_unit(),
        .flags = UI_FITTED,
    };
    char text[256];
    const bool prepares = v->gi.wanted && !v->gi.quiet;
    int count = prepares;
    for (int i = 0; i < v->messages.count; ++i)
        count += is_shown(v, &v->messages.list[i]);
    if (!count)
        return;
    const bool open = ui_window_begin(&window, NULL);
    for (int i = v->messages.count - 1; open && i >= 0; --i) {
        const view_message *m = &v->messages.list[i];
        if (is_shown(v, m))
            ui_text_wrapped(m->level <= FG_LOG_WARN ? colors[m->level] : UI_PLAIN, m->text,
                            right - left - 2 * ui_unit());
    }
    if (open && prepares) {
        notice(v, text, sizeof text);
        ui_text(UI_ACCENT, text);
    }
    ui_window_end();
}

// The line between two sides, with their names on it.
static void divider(const view *v)
{
    const float em = ui_unit(), x = (float) (v->gi.divider * v->window.width);
    for (int i = 0; i < 2; ++i) {
        const char *name = view_gi_name(v, i);
        const float width = ui_text_width(name) + em;
        const float left = i ? x + 0.5f * em : x - 0.5f * em - width;
        ui_draw_rect(left, em, width, 1.8f * em, 0x191817d0);
        ui_draw_text(left + 0.5f * em, 1.4f * em, 0xf2b15cff, name);
    }
    ui_draw_line(x, 0, x, (float) v->window.height, 0xf2b15cff);
    ui_draw_rect(x - 0.3f * em, 0.5f * (float) v->window.height - em, 0.6f * em, 2 * em,
                 0xf2b15cff);
}

void view_panel(view *v)
{
    if (v->gi.shows_split)
        divider(v);
    if (v->panel)
        main_panel(v);
    if (v->help)
        help_window(v);
    messages(v);
}
