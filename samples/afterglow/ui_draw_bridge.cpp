// SPDX-License-Identifier: MIT
#include "ui_bridge.h"

#include <imgui.h>

#include <cmath>

// Free drawing in the windows of ui_bridge.cpp, and behind them.

static ImDrawList *canvas;
static ImVec2 origin;

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
    list()->AddLine(at(x0, y0), at(x1, y1), packed(color), std::floor(ui_unit() / 13));
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
