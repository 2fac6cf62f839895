// SPDX-License-Identifier: MIT
#ifndef VIEW_H
#define VIEW_H

#include "host.h"

// The window of `afterglow view`. The library and the scene are the host's, everything that moves
// is the viewer's: view_window (what the user does), view_camera and view_state (pure),
// view_gi (which plugins, with what values), view_present (layers on the screen), view_panel,
// view_stats and view_graph (what is shown of them), view_set (files), view.c (the loop).

typedef struct view_start {
    const setting *settings; // plugins to begin with, the first of them first; borrowed
    int count;
    const char *params; // file of a parameter set, NULL: none
    double started_ms;  // now_ms() when the command began
} view_start;

// Runs until the window is closed. The host has registry and scene, and gets its device here.
// Returns an exit code; what failed is noted.
int view_run(host *h, const view_start *start);

#endif // VIEW_H
