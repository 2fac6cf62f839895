// SPDX-License-Identifier: MIT
#include "view.h"

// In a build without GLFW or Dear ImGui.
int view_run(host *h, const view_start *start)
{
    (void) start;
    return cli_fail(h->c, EXIT_FAILED,
                    "view: this build has no window: GLFW 3 or Dear ImGui was not there");
}
