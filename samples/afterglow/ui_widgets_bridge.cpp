// SPDX-License-Identifier: MIT
#include "ui_bridge.h"

#include <imgui.h>

#include <cstring>

// What stands in the windows of ui_bridge.cpp.

static ImVec4 shade(ui_color color)
{
    static const ImU32 packed[] = { IM_COL32(232, 230, 225, 255), IM_COL32(152, 149, 142, 255),
                                    IM_COL32(242, 177, 92, 255), IM_COL32(255, 210, 74, 255),
                                    IM_COL32(255, 106, 92, 255) };
    return ImGui::ColorConvertU32ToFloat4(packed[color]);
}

// ---- widgets ---------------------------------------------------------------------------------

void ui_text(ui_color color, const char *text)
{
    ImGui::PushStyleColor(ImGuiCol_Text, shade(color));
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
}

void ui_text_wrapped(ui_color color, const char *text, float width)
{
    ImGui::PushTextWrapPos(width);
    ui_text(color, text);
    ImGui::PopTextWrapPos();
}

void ui_separator(void)
{
    ImGui::Separator();
}

void ui_same_line(void)
{
    ImGui::SameLine();
}

void ui_tooltip(const char *text)
{
    if (text && text[0] && ImGui::IsItemHovered())
        ui_hint(text);
}

void ui_hint(const char *text)
{
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(30 * ui_unit());
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void ui_push(const char *id)
{
    ImGui::PushID(id);
}

void ui_pop(void)
{
    ImGui::PopID();
}

bool ui_header(const char *label, bool open)
{
    return ImGui::CollapsingHeader(label, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

bool ui_button(const char *label)
{
    return ImGui::Button(label);
}

bool ui_checkbox(const char *label, bool *value)
{
    return ImGui::Checkbox(label, value);
}

// A widget without a text of its own takes the line.
static void fill_line(const char *label)
{
    if (label[0] == '#')
        ImGui::SetNextItemWidth(-1);
}

bool ui_combo(const char *label, int *index, const char *const *items, int count)
{
    fill_line(label);
    return ImGui::Combo(label, index, items, count, count < 16 ? count : 16);
}

bool ui_input(const char *label, char *text, size_t size)
{
    fill_line(label);
    return ImGui::InputText(label, text, size);
}

static ImGuiSliderFlags slider_flags(const ui_range *range)
{
    ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
    if (range->logarithmic)
        flags |= ImGuiSliderFlags_Logarithmic;
    if (range->format && !std::strchr(range->format, '%'))
        flags |= ImGuiSliderFlags_NoInput;
    return flags;
}

bool ui_slider_float(const char *label, double *value, const ui_range *range)
{
    fill_line(label);
    return ImGui::SliderScalar(label, ImGuiDataType_Double, value, &range->min, &range->max,
                               range->format ? range->format : "%.4g", slider_flags(range));
}

bool ui_slider_int(const char *label, int64_t *value, const ui_range *range)
{
    const int64_t min = (int64_t) range->min, max = (int64_t) range->max;
    fill_line(label);
    return ImGui::SliderScalar(label, ImGuiDataType_S64, value, &min, &max,
                               range->format ? range->format : "%lld", slider_flags(range));
}

void ui_bar(double fraction, float width, const char *text)
{
    ImGui::ProgressBar((float) fraction, ImVec2(width > 0 ? width : -1, 0), text);
}

void ui_plot(const ui_curve *c)
{
    ImGui::PlotLines("##plot", c->values, c->count, c->first, c->text, 0, c->max,
                     ImVec2(ui_width(), c->height));
}

bool ui_table_begin(const char *id, const float *widths, int count)
{
    if (!ImGui::BeginTable(id, count, ImGuiTableFlags_SizingStretchSame))
        return false;
    for (int i = 0; i < count; ++i)
        ImGui::TableSetupColumn("",
                                widths[i] > 0 ? ImGuiTableColumnFlags_WidthFixed
                                              : ImGuiTableColumnFlags_WidthStretch,
                                widths[i]);
    return true;
}

void ui_table_next(void)
{
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
}

void ui_table_end(void)
{
    ImGui::EndTable();
}
