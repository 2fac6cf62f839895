// SPDX-License-Identifier: MIT
#ifndef VIEW_WINDOW_H
#define VIEW_WINDOW_H

#include "view_keys.h"

#include <fg/base.h>

// A window with an OpenGL 4.5 core context, and what the user does to it. GLFW stays behind this.
//
// Units: framebuffer pixels from the top left, whatever the screen's scale.
// Thread: the main one.

struct GLFWwindow;

enum { VIEW_MAX_ACTIONS = 32 };

// What has come in since view_window_poll() was last called, and what is held.
typedef struct view_input {
    view_action actions[VIEW_MAX_ACTIONS]; // in order; what is over is dropped
    int action_count;
    unsigned moves; // VIEW_MOVE_ bits of the keys that are held
    double x, y;    // the pointer
    double dx, dy;  // its way while the right button was held or it was captured, however short
    double wheel;
    bool left, right;  // buttons held that were pressed outside of the panel
    bool left_pressed; // since the last poll
    double press_x;    // where
} view_input;

typedef struct view_window {
    struct GLFWwindow *handle;
    int width, height;  // of the framebuffer; 0: minimised, nothing can be drawn
    float scale;        // of the screen: how much larger letters have to be
    bool scale_changed; // since the last poll
    bool focused, captured;
    view_input in;
    double pixels_x, pixels_y; // framebuffer pixels a unit of the window's coordinates
    char error[256];           // GLFW's last message
    bool glfw;                 // glfwInit() was called
} view_window;

typedef struct view_window_desc {
    const fg_log *log;
    const char *title;
    int width, height; // wanted, in the screen's units
    bool debug;        // a debug context
    bool enlarge;      // by the screen's scale
    bool unthrottled;  // do not wait for the screen between frames
} view_window_desc;

// The window, its context current. Errors: FG_ERR_UNSUPPORTED, with the reason in the log: no
// display, no OpenGL 4.5. view_window_close() is due in any case.
FG_NODISCARD fg_status view_window_open(view_window *w, const view_window_desc *desc);
void view_window_close(view_window *w); // accepts a zeroed one

// Takes in what has happened; waits up to `seconds` for something to, 0: not at all. False: the
// window is to be closed.
bool view_window_poll(view_window *w, double seconds);
void view_window_show(view_window *w); // what was drawn
void view_window_capture(view_window *w, bool captured);
void view_window_title(view_window *w, const char *title);

#endif // VIEW_WINDOW_H
