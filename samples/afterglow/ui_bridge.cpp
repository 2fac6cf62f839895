// SPDX-License-Identifier: MIT
#include "ui_bridge.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <cmath>

// Dear ImGui throws nothing and allocates by malloc(): no exception can come out of here.

static float scale = 1;

static ImVec4 rgb(unsigned hex, float alpha = 1)
{
    return ImVec4((hex >> 16 & 255) / 255.f, (hex >> 8 & 255) / 255.f, (hex & 255) / 255.f, alpha);
}

static void set_style()
{
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = style.FrameRounding = style.GrabRounding = 3;
    style.WindowBorderSize = 0;
    style.ItemSpacing = ImVec2(6, 4);
    style.Colors[ImGuiCol_Text] = rgb(0xe8e6e1);
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
    const ImVec2 pivot = w->flags & UI_FITTED ? ImVec2(0.5f, 1) : ImVec2(0, 0);
    ImGui::SetNextWindowPos(ImVec2(w->x, w->y), when, pivot);
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
