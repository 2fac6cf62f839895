// SPDX-License-Identifier: MIT
#include "view_priv.h"

#include "ui_bridge.h"

#include <math.h>
#include <string.h>

// ---- parameters ------------------------------------------------------------------------------

// "%.4g W/m^2" in `text`.
static const char *format_of(const gi_param *row, const char *number, char *text, size_t size)
{
    const bool pure = !row->unit || !strcmp(row->unit, "1");
    snprintf(text, size, "%s%s%s", number, pure ? "" : " ", pure ? "" : row->unit);
    return strchr(text + strlen(number), '%') ? number : text; // a unit is no format
}

// What spans decades is moved along them.
static bool spans(const gi_param *row)
{
    return row->max - row->min > 1000 && row->min >= 0;
}

// Steps from one power of two to the next.
static bool power_slider(const gi_param *row, gi_value *value)
{
    char text[64];
    const ui_range range = {
        .min = ceil(log2(fmax(1, row->min))),
        .max = floor(log2(fmax(1, row->max))),
        .format = text,
    };
    int64_t exponent = (int64_t) lround(log2(fmax(1, (double) value->i)));
    char number[24];
    snprintf(number, sizeof number, "%lld", (long long) value->i);
    format_of(row, number, text, sizeof text);
    if (!ui_slider_int("##value", &exponent, &range))
        return false;
    value->i = (int64_t) 1 << exponent;
    return true;
}

static bool widget(const gi_param *row, gi_value *value)
{
    char text[64];
    ui_range range = { .min = row->min, .max = row->max, .logarithmic = spans(row) };
    int index = (int) value->i, count = 0;
    bool on = value->i != 0;
    bool changed;
    switch (row->type) {
    case GI_INT:
        if (row->power_of_two)
            return power_slider(row, value);
        range.format = format_of(row, "%lld", text, sizeof text);
        return ui_slider_int("##value", &value->i, &range);
    case GI_FLOAT:
        range.format = format_of(row, "%.4g", text, sizeof text);
        return ui_slider_float("##value", &value->f, &range);
    case GI_BOOL:
        changed = ui_checkbox("##value", &on);
        value->i = on;
        return changed;
    case GI_ENUM:
        while (row->choices[count])
            ++count;
        changed = ui_combo("##value", &index, row->choices, count);
        value->i = index;
        return changed;
    }
    return false;
}

static bool is_default(const gi_param *row, const gi_value *value)
{
    return row->type == GI_FLOAT ? value->f == row->def : value->i == (int64_t) row->def;
}

// Help, range, unit and default.
static const char *explain(const gi_param *row, char *text, size_t size)
{
    const char *unit = row->unit && strcmp(row->unit, "1") != 0 ? row->unit : "";
    const char *help = row->help ? row->help : "";
    if (row->type == GI_ENUM)
        snprintf(text, size, "%s\n\n%s; default %s", row->name, help, row->choices[(int) row->def]);
    else if (row->type == GI_BOOL)
        snprintf(text, size, "%s\n\n%s; default %s", row->name, help, row->def != 0 ? "on" : "off");
    else
        snprintf(text, size, "%s\n\n%s; %.6g to %.6g %s%s; default %.6g\nCtrl+click: type it",
                 row->name, help, row->min, row->max, unit,
                 row->power_of_two ? ", a power of two" : "", row->def);
    return text;
}

static bool param_row(const gi_param *row, gi_value *value)
{
    char text[512];
    ui_push(row->name);
    ui_table_next();
    ui_text(is_default(row, value) ? UI_PLAIN : UI_ACCENT, row->name);
    ui_tooltip(explain(row, text, sizeof text));
    ui_table_next();
    bool changed = widget(row, value);
    ui_tooltip(text);
    ui_table_next();
    if (!is_default(row, value) && ui_button("x")) {
        if (row->type == GI_FLOAT)
            value->f = row->def;
        else
            value->i = (int64_t) row->def;
        changed = true;
    } else if (!is_default(row, value)) {
        ui_tooltip("back to the default");
    }
    ui_pop();
    return changed;
}

static void params(view *v, int side)
{
    setting *s = &v->gi.slots[v->gi.side[side]].s;
    char title[128];
    if (!s->plugin || !gi_params_count(s->plugin))
        return;
    snprintf(title, sizeof title, "Parameters of %s###params%d", s->plugin->name, side);
    if (!ui_header(title, side == 0))
        return;
    const float em = ui_unit(), widths[] = { 8 * em, 0, 1.5f * em };
    bool changed = false;
    ui_push(title + strlen(title) - 1);
    if (ui_table_begin("params", widths, FG_COUNT(widths))) {
        for (int i = 0; i < gi_params_count(s->plugin); ++i)
            changed |= param_row(&s->plugin->params[i], &s->values[i]);
        ui_table_end();
    }
    if (ui_button("All to defaults")) {
        gi_params_default(s->plugin, s->values);
        changed = true;
    }
    ui_pop();
    if (changed)
        view_gi_touch(v);
}

// ---- what is shown ---------------------------------------------------------------------------

static void name_cell(const char *name, const char *help)
{
    ui_table_next();
    ui_text(UI_PLAIN, name);
    ui_tooltip(help);
    ui_table_next();
}

static void plugin_rows(view *v)
{
    int slot = v->gi.side[0];
    bool split = v->gi.split;
    const gi_plugin *p = view_gi_slot(v, 0)->s.plugin;
    name_cell("plugin", "N and P go through them");
    if (ui_combo("##plugin", &slot, v->gi.names, v->gi.count))
        view_gi_want(v, 0, slot);
    ui_tooltip(p ? p->summary : "direct light alone");
    name_cell("split", "X: another plugin on the right; drag the line between");
    if (ui_checkbox("##split", &split))
        view_gi_split(v, split);
    if (!split)
        return;
    slot = v->gi.side[1];
    name_cell("right", "Shift+N and Shift+P go through them");
    if (ui_combo("##right", &slot, v->gi.names, v->gi.count))
        view_gi_want(v, 1, slot);
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
    const gi_plugin *p = view_gi_slot(v, 0)->s.plugin;
    if (p && layer >= LAYER_COUNT && layer < count)
        ui_tooltip(p->layers[layer - LAYER_COUNT].help);
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

// ---- the windows -----------------------------------------------------------------------------

static void messages(const view *v)
{
    for (int i = 0; i < v->messages.count; ++i) {
        const view_message *m = &v->messages.list[i];
        const ui_color color = m->level == FG_LOG_ERROR  ? UI_BAD
                               : m->level == FG_LOG_WARN ? UI_WARN
                                                         : UI_ACCENT;
        ui_text_wrapped(color, m->text);
    }
}

static void main_panel(view *v)
{
    const float em = ui_unit(), edge = 0.6f * em;
    const float wide = 30 * em, most = 0.9f * (float) v->window.width;
    const ui_window window = {
        .title = "afterglow",
        .x = edge,
        .y = edge,
        .width = wide < most ? wide : most,
        .height = (float) v->window.height - 2 * edge,
        .flags = UI_FIXED,
    };
    const float widths[] = { 8 * em, 0 };
    if (ui_window_begin(&window, NULL)) {
        messages(v);
        if (ui_table_begin("view", widths, FG_COUNT(widths))) {
            plugin_rows(v);
            layer_row(v);
            scale_row(v);
            camera_rows(v);
            ui_table_end();
        }
        clock_line(v);
        params(v, 0);
        if (v->gi.split && v->gi.side[1] != v->gi.side[0])
            params(v, 1);
        view_stats_panel(v);
        if (ui_header("Files", true))
            files(v);
    }
    ui_window_end();
}

static void help_window(view *v)
{
    const float em = ui_unit(), widths[] = { 9 * em, 36 * em };
    const ui_window window = {
        .title = "Keys",
        .x = 0.5f * (float) v->window.width - 23 * em,
        .y = 3 * em,
        .width = 46 * em,
        .height = 46 * em,
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
static void notice(view *v)
{
    char text[256];
    const view_slot *left = view_gi_slot(v, 0), *right = view_gi_slot(v, 1);
    if (v->gi.split)
        snprintf(text, sizeof text, "preparing %s and %s ...", left->name, right->name);
    else
        snprintf(text, sizeof text, "preparing %s ...", left->name);
    const ui_window window = {
        .title = "##notice",
        .x = 0.5f * ((float) v->window.width - ui_text_width(text)),
        .y = (float) v->window.height - 4 * ui_unit(),
        .flags = UI_FITTED,
    };
    if (ui_window_begin(&window, NULL))
        ui_text(UI_ACCENT, text);
    ui_window_end();
}

void view_panel(view *v)
{
    if (v->panel)
        main_panel(v);
    if (v->help)
        help_window(v);
    if (v->gi.wanted)
        notice(v);
}
