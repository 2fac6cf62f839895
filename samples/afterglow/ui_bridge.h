// SPDX-License-Identifier: MIT
#ifndef UI_BRIDGE_H
#define UI_BRIDGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// Dear ImGui for C: what a panel is composed of, drawn anew each frame.
//
//     ui_create(window);                              // a GLFW window, its context current
//     while (...) {
//         ui_frame_begin();
//         if (ui_window_begin(&(ui_window){ .title = "panel", .width = 300, .height = 200 }, NULL))
//             ui_slider_float("exposure", &exposure, &(ui_range){ .min = 0.1, .max = 10 });
//         ui_window_end();
//         ui_frame_end();                             // into the framebuffer that is bound
//     }
//     ui_destroy();
//
// There is one at a time. Widgets are known by their label and the ids around them; what stands
// after "##" in a label is not shown. Widgets return whether the user has just changed something.
//
// Units: framebuffer pixels from the top left; ui_unit() is the height of the letters.
// Thread: the one that has the window's context.

struct GLFWwindow;

// Calls the window's own callbacks, set before, and its own. False: OpenGL could not be loaded.
bool ui_create(struct GLFWwindow *window);
void ui_destroy(void); // accepts that there is none
// Size of fonts and widgets, > 0; 1: letters of 13 pixels.
void ui_set_scale(float scale);
float ui_unit(void);

void ui_frame_begin(void);
void ui_frame_end(void);
bool ui_wants_mouse(void); // as of the last frame: the pointer is over a window, or drags in one
bool ui_wants_keyboard(void);

enum {
    UI_FIXED = 1 << 0,    // neither moved nor sized by the user
    UI_FITTED = 1 << 1,   // as large as what stands in it, fixed, without a title
    UI_SIDEWAYS = 1 << 2, // scrolls sideways too
};
typedef struct ui_window {
    const char *title;
    float x, y, width, height; // where it is put at first; always, if fixed
    unsigned flags;
} ui_window;
// ui_window_end() follows in any case. False: nothing of it shows. `open`: NULL, or cleared by
// the close button.
bool ui_window_begin(const ui_window *w, bool *open);
void ui_window_end(void);
float ui_width(void); // of what is left of the line

typedef enum ui_color {
    UI_PLAIN = 0,
    UI_DIM,
    UI_ACCENT,
    UI_WARN,
    UI_BAD,
} ui_color;

void ui_text(ui_color color, const char *text);
void ui_text_wrapped(ui_color color, const char *text, float width); // 0: the window's
void ui_separator(void);
void ui_same_line(void);
void ui_tooltip(const char *text); // of the widget before; NULL: none
void ui_hint(const char *text);    // the same, of what the caller knows to be under the pointer
void ui_push(const char *id);      // widgets up to ui_pop() are this one's
void ui_pop(void);

bool ui_header(const char *label, bool open); // a section that folds; `open` at first
bool ui_button(const char *label);
bool ui_checkbox(const char *label, bool *value);
bool ui_combo(const char *label, int *index, const char *const *items, int count);
bool ui_input(const char *label, char *text, size_t size);

typedef struct ui_range {
    double min, max;
    const char *format; // printf's for a double or an int64_t ("%lld"); NULL: a default. A text
                        // without a % stands for the value, which then cannot be typed
    bool logarithmic;
} ui_range;
bool ui_slider_float(const char *label, double *value, const ui_range *range);
bool ui_slider_int(const char *label, int64_t *value, const ui_range *range);

// A bar of [0, 1] of the line's width, or what `width` says, with a text on it.
void ui_bar(double fraction, float width, const char *text);
// A curve of values from 0 to `max`; `first` is the oldest.
typedef struct ui_curve {
    const float *values;
    int count, first;
    float max, height;
    const char *text;
} ui_curve;
void ui_plot(const ui_curve *curve);

// Columns of the given widths; 0 shares what is left. ui_table_end() follows only if true.
bool ui_table_begin(const char *id, const float *widths, int count);
void ui_table_next(void); // the next cell
void ui_table_end(void);

// Free drawing: colours are 0xRRGGBBAA. Between ui_canvas_begin() and ui_canvas_end() from the
// top left of an area of that size in the window; else behind all windows, from the top left.
void ui_canvas_begin(float width, float height);
void ui_canvas_end(void);
void ui_draw_rect(float x, float y, float width, float height, uint32_t color);
void ui_draw_line(float x0, float y0, float x1, float y1, uint32_t color);
void ui_draw_text(float x, float y, uint32_t color, const char *text);
float ui_text_width(const char *text);
// Whether the pointer is over this part of the canvas.
bool ui_canvas_over(float x, float y, float width, float height);

#ifdef __cplusplus
}
#endif

#endif // UI_BRIDGE_H
