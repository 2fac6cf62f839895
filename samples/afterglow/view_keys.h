// SPDX-License-Identifier: MIT
#ifndef VIEW_KEYS_H
#define VIEW_KEYS_H

// What can be asked of the viewer, and by which key. `shift` and `control` must be held; the
// words stand in `afterglow view --help` and in the help window.
//
// ROW(action, key of GLFW, modifiers, name of the key, padded to ten, what it does)
#define VIEW_KEYS(ROW)                                                                             \
    ROW(VIEW_HELP, F1, 0, "F1, H     ", "this list")                                               \
    ROW(VIEW_PANEL, TAB, 0, "Tab       ", "show or hide the panel")                                \
    ROW(VIEW_GRAPH, G, 0, "G         ", "the graph: passes, lifetimes, memory")                    \
    ROW(VIEW_NEXT_PLUGIN, N, 0, "N         ", "next plugin")                                       \
    ROW(VIEW_PREVIOUS_PLUGIN, P, 0, "P         ", "previous plugin")                               \
    ROW(VIEW_NEXT_SECOND, N, SHIFT, "Shift+N   ", "next plugin on the right of the split")         \
    ROW(VIEW_PREVIOUS_SECOND, P, SHIFT, "Shift+P   ", "previous plugin on the right")              \
    ROW(VIEW_SPLIT, X, 0, "X         ", "split: two plugins side by side")                         \
    ROW(VIEW_NEXT_LAYER, L, 0, "L         ", "next layer")                                         \
    ROW(VIEW_PREVIOUS_LAYER, K, 0, "K         ", "previous layer")                                 \
    ROW(VIEW_PAUSE, SPACE, 0, "Space     ", "stop or start the clock")                             \
    ROW(VIEW_STEP, PERIOD, 0, ".         ", "one step of 1/60 s")                                  \
    ROW(VIEW_RESET, R, 0, "R         ", "clock to 0, the plugin begins anew")                      \
    ROW(VIEW_NEXT_CAMERA, C, 0, "C         ", "next camera of the scene")                          \
    ROW(VIEW_ORBIT, O, 0, "O         ", "orbit around what is in the middle, or fly again")        \
    ROW(VIEW_CAPTURE, M, 0, "M         ", "the mouse looks around; again or Esc: it points")       \
    ROW(VIEW_BRIGHTER, EQUAL, 0, "=         ", "exposure times 2^(1/3)")                           \
    ROW(VIEW_DARKER, MINUS, 0, "-         ", "exposure over 2^(1/3)")                              \
    ROW(VIEW_COARSER, LEFT_BRACKET, 0, "[         ", "render scale halved, down to 1/4")           \
    ROW(VIEW_FINER, RIGHT_BRACKET, 0, "]         ", "render scale doubled, up to 1")               \
    ROW(VIEW_SHOT, F5, 0, "F5        ", "PNG of the frame, without panel, at the frame's size")    \
    ROW(VIEW_WINDOW_SHOT, F6, 0, "F6        ", "PNG of the window as it is")                       \
    ROW(VIEW_SAVE, F7, 0, "F7        ", "save the parameter set")                                  \
    ROW(VIEW_LOAD, F8, 0, "F8        ", "load the parameter set")                                  \
    ROW(VIEW_CLOSE, ESCAPE, 0, "Esc       ", "close help and graph, let the mouse go")             \
    ROW(VIEW_QUIT, Q, CONTROL, "Ctrl+Q    ", "quit")

typedef enum view_action {
    VIEW_NOTHING = 0,
#define VIEW_KEY_ID(id, key, mods, name, help) id,
    VIEW_KEYS(VIEW_KEY_ID)
#undef VIEW_KEY_ID
        VIEW_ACTIONS,
} view_action;

// Held keys, and what the mouse does.
#define VIEW_MOTIONS(ROW)                                                                          \
    ROW("W A S D   ", "fly; Q and E down and up; Shift: four times as fast")                       \
    ROW("right drag", "look around; in orbit: turn around the point")                              \
    ROW("wheel     ", "speed of flight; in orbit: distance")                                       \
    ROW("left drag ", "moves the divider of a split")

typedef struct view_key_help {
    const char *key, *help;
} view_key_help;

// The whole list; NULL past the end.
const view_key_help *view_key_list(int i);

// GLFW's key and modifiers. VIEW_NOTHING for any other.
view_action view_key_action(int key, int mods);

// The letters that fly, as bits of what is held.
enum {
    VIEW_MOVE_FORWARD = 1 << 0,
    VIEW_MOVE_BACK = 1 << 1,
    VIEW_MOVE_LEFT = 1 << 2,
    VIEW_MOVE_RIGHT = 1 << 3,
    VIEW_MOVE_UP = 1 << 4,
    VIEW_MOVE_DOWN = 1 << 5,
    VIEW_MOVE_FAST = 1 << 6,
};
unsigned view_key_move(int key); // 0: none

#endif // VIEW_KEYS_H
