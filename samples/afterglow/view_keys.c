// SPDX-License-Identifier: MIT
#include "view_keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <stddef.h>

enum { HELD_NOTHING = 0, HELD_SHIFT = GLFW_MOD_SHIFT, HELD_CONTROL = GLFW_MOD_CONTROL };
#define HELD_0 HELD_NOTHING

static const view_key_help list[] = {
#define KEY_HELP(id, key, mods, name, help) { name, help },
    VIEW_KEYS(KEY_HELP)
#define MOTION_HELP(name, help) { name, help },
        VIEW_MOTIONS(MOTION_HELP)
};

static const struct {
    view_action action;
    int key, mods;
} bound[] = {
#define KEY_BOUND(id, key, mods, name, help) { id, GLFW_KEY_##key, HELD_##mods },
    VIEW_KEYS(KEY_BOUND){ VIEW_HELP, GLFW_KEY_H, 0 },
    { VIEW_BRIGHTER, GLFW_KEY_KP_ADD, 0 },
    { VIEW_DARKER, GLFW_KEY_KP_SUBTRACT, 0 },
};

static const struct {
    int key;
    unsigned move;
} moves[] = {
    { GLFW_KEY_W, VIEW_MOVE_FORWARD },
    { GLFW_KEY_S, VIEW_MOVE_BACK },
    { GLFW_KEY_A, VIEW_MOVE_LEFT },
    { GLFW_KEY_D, VIEW_MOVE_RIGHT },
    { GLFW_KEY_E, VIEW_MOVE_UP },
    { GLFW_KEY_Q, VIEW_MOVE_DOWN },
    { GLFW_KEY_LEFT_SHIFT, VIEW_MOVE_FAST },
    { GLFW_KEY_RIGHT_SHIFT, VIEW_MOVE_FAST },
};

const view_key_help *view_key_list(int i)
{
    return i >= 0 && (size_t) i < sizeof list / sizeof *list ? &list[i] : NULL;
}

view_action view_key_action(int key, int mods)
{
    mods &= GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT;
    for (size_t i = 0; i < sizeof bound / sizeof *bound; ++i)
        if (bound[i].key == key && bound[i].mods == mods)
            return bound[i].action;
    return VIEW_NOTHING;
}

unsigned view_key_move(int key)
{
    for (size_t i = 0; i < sizeof moves / sizeof *moves; ++i)
        if (moves[i].key == key)
            return moves[i].move;
    return 0;
}
