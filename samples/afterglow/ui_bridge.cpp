// SPDX-License-Identifier: MIT
#include "ui_bridge.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <cmath>
#include <cstring>

// Dear ImGui throws nothing and allocates by malloc(): no exception can come out of here.

static float scale = 1;
static ImDrawList *canvas;
static ImVec2 origin;

static ImVec4 rgb(unsigned hex, float alpha = 1)
{
    return ImVec4((hex >> 16 & 255) / 255.f, (hex >> 8 & 255) / 255.f, (hex & 255) / 255.f, alpha);
}

static ImVec4 shade(ui_color color)
{
    static const unsigned hex[] = { 0xe8e6e1, 0x98958e, 0xf2b15c, 0xffd24a, 0xff6a5c };
    return rgb(hex[color]);
}

static void set_style()
{
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = style.FrameRounding = style.GrabRounding = 3;
    style.WindowBorderSize = 0;
    style.ItemSpacing = ImVec2(6, 4);
    style.Colors[ImGuiCol_Text] = shade(UI_PLAIN);
    style.Colors[ImGuiCol_WindowBg] = rgb(0x191817, 0.92f);
    style.Colors[ImGuiCol_PopupBg] = rgb(0x262422, 0.98f);
    style.Colors[ImGuiCol_FrameBg] = rgb(0x3a3733);
    style.Colors[ImGuiCol_FrameBgHovered] = rgb(0x4a463f);
    style.Colors[ImGuiCol_FrameBgActive] = rgb(0x5a554c);
    style.Colors[ImGuiCol_Header] = rgb(0x3d3a36);
    style.Colors[ImGuiCol_HeaderHovered] = style.Colors[ImGuiCol_HeaderActive] = rgb(0x57524b);
    style.Colors[ImGuiCol_Button] = rgb(0x4a463f);
    style.Colors[ImGuiCol_ButtonHovered] = style.Colors[ImGuiCol_ButtonActive] = rgb(0x6b6458);
    style.Colors[ImGuiCol_SliderGrab] = style.Colors[ImGuiCol_SliderGrabActive] = rgb(0xa36a24);
    style.Colors[ImGuiCol_CheckMark] = style.Colors[ImGuiCol_PlotLines] = rgb(0xf2b15c);
    style.Colors[ImGuiCol_PlotHistogram] = rgb(0x8a6532);
    style.Colors[ImGuiCol_TitleBgActive] = rgb(0x3d3a36);
    style.ScaleAllSizes(scale);
    ImGui::GetStyle() = style;
}

bool ui_create(GLFWwindow *window)
{
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // no file appears where the user stands
    scale = 1;
    set_style();
    if (!ImGui_ImplGlfw_InitForOpenGL(window, true) || !ImGui_ImplOpenGL3_Init("#version 450 core"))
        return false;
    return true;
}

void ui_destroy(void)
{
    if (!ImGui::GetCurrentContext())
        return;
    if (ImGui::GetIO().BackendRendererUserData)
        ImGui_ImplOpenGL3_Shutdown();
    if (ImGui::GetIO().BackendPlatformUserData)
        ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void ui_set_scale(float wanted)
{
    ImFontAtlas *fonts = ImGui::GetIO().Fonts;
    ImFontConfig config;
    scale = wanted;
    config.SizePixels = std::floor(13 * scale);
    fonts->Clear();
    fonts->AddFontDefault(&config);
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
    set_style();
}

float ui_unit(void)
{
    return ImGui::GetFontSize();
}

void ui_frame_begin(void)
{
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    canvas = nullptr;
}

void ui_frame_end(void)
{
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool ui_wants_mouse(void)
{
    return ImGui::GetIO().WantCaptureMouse;
}

bool ui_wants_keyboard(void)
{
    return ImGui::GetIO().WantTextInput;
}

// ---- windows ---------------------------------------------------------------------------------

bool ui_window_begin(const ui_window *w, bool *open)
{
    const ImGuiCond when = w->flags & (UI_FIXED | UI_FITTED) ? ImGuiCond_Always : ImGuiCond_Once;
    ImGuiWindowFlags flags = ImGuiWindowFlags_NoNav;
    if (w->flags & UI_FIXED)
        flags |= ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse;
    if (w->flags & UI_FITTED)
        flags |= ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing;
    if (w->flags & UI_SIDEWAYS)
        flags |= ImGuiWindowFlags_HorizontalScrollbar;
    ImGui::SetNextWindowPos(ImVec2(w->x, w->y), when);
    if (!(w->flags & UI_FITTED))
        ImGui::SetNextWindowSize(ImVec2(w->width, w->height), when);
    return ImGui::Begin(w->title, open, flags);
}

void ui_window_end(void)
{
    ImGui::End();
}

float ui_width(void)
{
    return ImGui::GetContentRegionAvail().x;
}

// ---- widgets ---------------------------------------------------------------------------------

void ui_text(ui_color color, const char *text)
{
    ImGui::PushStyleColor(ImGuiCol_Text, shade(color));
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
}

void ui_text_wrapped(ui_color color, const char *text)
{
    ImGui::PushTextWrapPos(0);
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

void ui_image(uint32_t texture, float width, float height)
{
    ImGui::Image((ImTextureID) (intptr_t) texture, ImVec2(width, height), ImVec2(0, 1),
                 ImVec2(1, 0));
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

// ---- drawing ---------------------------------------------------------------------------------

static ImDrawList *list()
{
    return canvas ? canvas : ImGui::GetBackgroundDrawList();
}

static ImVec2 at(float x, float y)
{
    return canvas ? ImVec2(origin.x + x, origin.y + y) : ImVec2(x, y);
}

static ImU32 packed(uint32_t c)
{
    return IM_COL32(c >> 24, c >> 16 & 255, c >> 8 & 255, c & 255);
}

void ui_canvas_begin(float width, float height)
{
    canvas = ImGui::GetWindowDrawList();
    origin = ImGui::GetCursorScreenPos();
    ImGui::Dummy(ImVec2(width, height));
}

void ui_canvas_end(void)
{
    canvas = nullptr;
}

void ui_draw_rect(float x, float y, float width, float height, uint32_t color)
{
    list()->AddRectFilled(at(x, y), at(x + width, y + height), packed(color), 2);
}

void ui_draw_line(float x0, float y0, float x1, float y1, uint32_t color)
{
    list()->AddLine(at(x0, y0), at(x1, y1), packed(color), std::floor(scale > 1 ? scale : 1));
}

void ui_draw_text(float x, float y, uint32_t color, const char *text)
{
    list()->AddText(at(x, y), packed(color), text);
}

float ui_text_width(const char *text)
{
    return ImGui::CalcTextSize(text).x;
}

bool ui_canvas_over(float x, float y, float width, float height)
{
    return ImGui::IsWindowHovered() &&
           ImGui::IsMouseHoveringRect(at(x, y), at(x + width, y + height));
}
