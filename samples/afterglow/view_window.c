// SPDX-License-Identifier: MIT
#include "view_window.h"

#include "ui_bridge.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <stdio.h>
#include <string.h>

static view_window *failing; // whom GLFW's messages are for, which come without a window

static void on_error(int code, const char *text)
{
    (void) code;
    if (failing)
        snprintf(failing->error, sizeof failing->error, "%s", text);
}

// ---- what the user does ----------------------------------------------------------------------

static void on_key(GLFWwindow *handle, int key, int scancode, int action, int mods)
{
    view_window *w = glfwGetWindowUserPointer(handle);
    const unsigned move = view_key_move(key);
    const view_action wanted = view_key_action(key, mods);
    (void) scancode;
    if (action == GLFW_RELEASE) {
        w->in.moves &= ~move; // whoever has the keyboard: nothing must go on for ever
        return;
    }
    if (ui_wants_keyboard())
        return;
    if (!(mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)))
        w->in.moves |= move;
    if (wanted && w->in.action_count < VIEW_MAX_ACTIONS)
        w->in.actions[w->in.action_count++] = wanted;
}

static void on_button(GLFWwindow *handle, int button, int action, int mods)
{
    view_window *w = glfwGetWindowUserPointer(handle);
    const bool pressed = action == GLFW_PRESS && !ui_wants_mouse();
    (void) mods;
    if (button == GLFW_MOUSE_BUTTON_LEFT) {
        w->in.left = pressed;
        w->in.left_pressed = w->in.left_pressed || pressed;
        w->in.press_x = pressed ? w->in.x : w->in.press_x;
    } else if (button == GLFW_MOUSE_BUTTON_RIGHT) {
        w->in.right = pressed;
    }
}

static void on_cursor(GLFWwindow *handle, double x, double y)
{
    view_window *w = glfwGetWindowUserPointer(handle);
    x *= w->pixels_x;
    y *= w->pixels_y;
    if (w->in.right || w->captured) {
        w->in.dx += x - w->in.x;
        w->in.dy += y - w->in.y;
    }
    w->in.x = x;
    w->in.y = y;
}

static void on_wheel(GLFWwindow *handle, double x, double y)
{
    view_window *w = glfwGetWindowUserPointer(handle);
    (void) x;
    if (!ui_wants_mouse())
        w->in.wheel += y;
}

static void on_focus(GLFWwindow *handle, int focused)
{
    view_window *w = glfwGetWindowUserPointer(handle);
    w->focused = focused != 0;
    if (focused)
        return;
    w->in.moves = 0; // their release goes elsewhere
    w->in.left = w->in.right = false;
    view_window_capture(w, false);
}

static void measure(view_window *w)
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(w->handle, &w->width, &w->height);
    glfwGetWindowSize(w->handle, &width, &height);
    w->pixels_x = width > 0 ? (double) w->width / width : 1;
    w->pixels_y = height > 0 ? (double) w->height / height : 1;
    if (glfwGetWindowAttrib(w->handle, GLFW_ICONIFIED))
        w->width = w->height = 0;
}

static void on_scale(GLFWwindow *handle, float x, float y)
{
    view_window *w = glfwGetWindowUserPointer(handle);
    const float scale = x > y ? x : y;
    w->scale = scale >= 0.5f && scale <= 8 ? scale : 1; // what a broken screen says is no scale
    w->scale_changed = true;
}

// ---- life ------------------------------------------------------------------------------------

static void listen(view_window *w)
{
    float x = 1, y = 1;
    glfwSetWindowUserPointer(w->handle, w);
    glfwSetKeyCallback(w->handle, on_key);
    glfwSetMouseButtonCallback(w->handle, on_button);
    glfwSetCursorPosCallback(w->handle, on_cursor);
    glfwSetScrollCallback(w->handle, on_wheel);
    glfwSetWindowFocusCallback(w->handle, on_focus);
    glfwSetWindowContentScaleCallback(w->handle, on_scale);
    glfwGetWindowContentScale(w->handle, &x, &y);
    on_scale(w->handle, x, y);
    w->focused = glfwGetWindowAttrib(w->handle, GLFW_FOCUSED) != 0;
    measure(w);
    glfwGetCursorPos(w->handle, &w->in.x, &w->in.y);
}

// The system's own way to a context first (GLX, WGL), then EGL.
static void create(view_window *w, const view_window_desc *desc)
{
    static const int ways[] = { GLFW_NATIVE_CONTEXT_API, GLFW_EGL_CONTEXT_API };
    for (int i = 0; i < FG_COUNT(ways) && !w->handle; ++i) {
        glfwDefaultWindowHints();
        glfwWindowHint(GLFW_CONTEXT_CREATION_API, ways[i]);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, desc->debug);
        glfwWindowHint(GLFW_SCALE_TO_MONITOR, desc->enlarge);
        glfwWindowHint(GLFW_DEPTH_BITS, 0);
        glfwWindowHint(GLFW_STENCIL_BITS, 0);
        w->handle = glfwCreateWindow(desc->width, desc->height, desc->title, NULL, NULL);
    }
}

fg_status view_window_open(view_window *w, const view_window_desc *desc)
{
    *w = (view_window){ .scale = 1, .pixels_x = 1, .pixels_y = 1 };
    failing = w;
    glfwSetErrorCallback(on_error);
    if (!glfwInit()) {
        fg_logf(desc->log, FG_LOG_ERROR, "window: there is no display: %s",
                w->error[0] ? w->error : "no reason given");
        return FG_ERR_UNSUPPORTED;
    }
    w->glfw = true;
    create(w, desc);
    if (!w->handle) {
        fg_logf(desc->log, FG_LOG_ERROR, "window: no GPU, or one without OpenGL 4.5: %s",
                w->error[0] ? w->error : "no reason given");
        return FG_ERR_UNSUPPORTED;
    }
    glfwMakeContextCurrent(w->handle);
    glfwSwapInterval(desc->unthrottled ? 0 : 1);
    listen(w);
    return FG_OK;
}

void view_window_close(view_window *w)
{
    if (w->handle)
        glfwDestroyWindow(w->handle);
    if (w->glfw)
        glfwTerminate();
    failing = NULL;
    *w = (view_window){ 0 };
}

bool view_window_poll(view_window *w, double seconds)
{
    w->in.action_count = 0;
    w->in.dx = w->in.dy = w->in.wheel = 0;
    w->in.left_pressed = false;
    w->scale_changed = false;
    if (seconds > 0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
    measure(w);
    return !glfwWindowShouldClose(w->handle);
}

void view_window_show(view_window *w)
{
    glfwSwapBuffers(w->handle);
}

void view_window_capture(view_window *w, bool captured)
{
    if (captured == w->captured)
        return;
    w->captured = captured;
    glfwSetInputMode(w->handle, GLFW_CURSOR, captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    glfwGetCursorPos(w->handle, &w->in.x, &w->in.y); // it has jumped
    w->in.x *= w->pixels_x;
    w->in.y *= w->pixels_y;
}

void view_window_title(view_window *w, const char *title)
{
    glfwSetWindowTitle(w->handle, title);
}
