// SPDX-License-Identifier: MIT
#include "view_priv.h"

#include "ui_bridge.h"

#include <math.h>
#include <string.h>

// A plugin's parameters as widgets, made from its table alone.

// "%.4g W/m^2" in `text`.
static const char *format_of(const gi_param *row, const char *number, char *text, size_t size)
{
    const bool pure = !row->unit || (row->unit[0] == '1' &&
                                     row->unit[1] != '/'); // "1 a frame" beside a number misleads
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

static bool reset(const gi_param *row, gi_value *value)
{
    if (is_default(row, value))
        return false;
    const bool wanted = ui_button("x");
    ui_tooltip("back to the default");
    if (wanted && row->type == GI_FLOAT)
        value->f = row->def;
    else if (wanted)
        value->i = (int64_t) row->def;
    return wanted;
}

static bool param_row(const gi_param *row, gi_value *value)
{
    char text[512];
    ui_push(row->name);
    ui_table_next();
    ui_text(is_default(row, value) ? UI_PLAIN : UI_ACCENT, row->name);
    ui_tooltip(explain(row, text, sizeof text));
    ui_table_next();
    const bool changed = widget(row, value);
    ui_tooltip(text);
    ui_table_next();
    const bool back = reset(row, value);
    ui_pop();
    return changed || back;
}

// A number is soon taken; another choice may mean other shaders.
static void changed_row(view *v, int side, const gi_param *row)
{
    if (row->type == GI_INT || row->type == GI_FLOAT)
        view_gi_nudge(v, 1u << side);
    else
        view_gi_touch(v, 1u << side);
}

void view_param_rows(view *v, int side)
{
    setting *s = view_gi_setting(v, side);
    char title[128];
    if (!s->plugin || !gi_params_count(s->plugin))
        return;
    snprintf(title, sizeof title, "Parameters of %s%s###params%d", s->plugin->name,
             !v->gi.split ? ""
             : side       ? ", right"
                          : ", left",
             side);
    if (!ui_header(title, true))
        return;
    const float em = ui_unit(), widths[] = { 8 * em, 0, 1.5f * em };
    ui_push(title + strlen(title) - 1);
    if (ui_table_begin("params", widths, FG_COUNT(widths))) {
        for (int i = 0; i < gi_params_count(s->plugin); ++i)
            if (param_row(&s->plugin->params[i], &s->values[i]))
                changed_row(v, side, &s->plugin->params[i]);
        ui_table_end();
    }
    if (ui_button("All to defaults")) {
        gi_params_default(s->plugin, s->values);
        view_gi_touch(v, 1u << side);
    }
    ui_pop();
}
