// SPDX-License-Identifier: MIT
#ifndef PASS_GBUFFER_H
#define PASS_GBUFFER_H

#include <pass/frame.h>

FG_BEGIN

// Draws the scene into the G-buffer: pass "gbuffer.draw". No face is culled; the nearest surface
// that MASK leaves is what a pixel sees.
//
// Owner: the state is the caller's, and the callback's: it stays in place while the graph runs. The
//        same holds for the states of all passes of this folder.
typedef struct ag_gbuffer_pass {
    const ag_gpu_scene *gpu;
    ag_scene_res scene;
    ag_gbuffer out;
} ag_gbuffer_pass;

// Fills `pass`; what it makes is in pass->out.
FG_API void ag_gbuffer_declare(ag_gbuffer_pass *pass, fg_graph *g, const ag_gpu_scene *gpu,
                               const ag_scene_res *scene);

FG_END

#endif // PASS_GBUFFER_H
