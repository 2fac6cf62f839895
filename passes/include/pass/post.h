// SPDX-License-Identifier: MIT
#ifndef PASS_POST_H
#define PASS_POST_H

#include <pass/frame.h>

FG_BEGIN

// out = direct + albedo x indirect + glossy, RGBA32F of the frame's size, W/(m^2 sr). Inputs that
// are null or were left out count as nothing.
typedef struct ag_compose_pass {
    fg_res view, direct, albedo, indirect, glossy;
    fg_res out;
} ag_compose_pass;

// Fill the inputs before. `name` and `texture`, e.g. "frame.compose" and "frame.radiance".
FG_API void ag_compose_declare(ag_compose_pass *pass, fg_graph *g, const char *name,
                               const char *texture);

// Exposure and filmic curve: RGBA16F, linear display values in [0, 1].
typedef struct ag_tone_pass {
    fg_res radiance;
    float exposure; // factor on radiance, > 0; may change between frames
    fg_res out;
} ag_tone_pass;

// Fill radiance and exposure before. `name` and `texture`, e.g. "frame.tone" and "frame.display".
FG_API void ag_tone_declare(ag_tone_pass *pass, fg_graph *g, const char *name, const char *texture);

FG_END

#endif // PASS_POST_H
