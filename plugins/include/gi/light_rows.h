// SPDX-License-Identifier: MIT
#ifndef GI_LIGHT_ROWS_H
#define GI_LIGHT_ROWS_H

#include <gi/plugin.h>

FG_BEGIN

// Rows of a plugin's parameter table for reflective shadow maps and for what bounds a near VPL, the
// same in every technique that has them:
//
//     enum { RSM_SIZE, ..., CLAMP, CLAMP_D2, SOLID_ANGLE, PARAM_COUNT };
//     static const gi_param params[] = {
//         GI_RSM_SIZE_PARAM(RSM_SIZE),
//         ...
//         GI_CLAMP_PARAMS(CLAMP, CLAMP_D2, "VPL"),
//         GI_SOLID_ANGLE_PARAM(SOLID_ANGLE),
//         { .name = NULL },
//     };
//
// Values: solid_angle as ag_rsm_desc.equal_solid_angle, clamp as ag_clamp (pass/gather.h).
static const char *const gi_clamp_names[] = { "footprint", "disc", "none", "constant", NULL };
static const char *const gi_solid_angle_names[] = { "exact", "equal", NULL };

// clang-format off
#define GI_RSM_SIZE_PARAM(row)                                                                     \
    [row] = { .name = "rsm_size", .type = GI_INT, .unit = "texels", .min = 1, .max = 1024,         \
        .def = 256, .power_of_two = true, .help = "edge of a reflective shadow map" }

#define GI_SOLID_ANGLE_PARAM(row)                                                                  \
    [row] = { .name = "solid_angle", .type = GI_ENUM, .unit = "1",                                 \
        .choices = gi_solid_angle_names,                                                           \
        .help = "of a texel: its own, or the paper's equal share (eq. 4)" }

// `what`: stands for a patch of light, "VPL".
#define GI_CLAMP_PARAMS(clamp, clamp_d2, what)                                                     \
    [clamp] = { .name = "clamp", .type = GI_ENUM, .unit = "1", .choices = gi_clamp_names,          \
        .help = "what bounds a near " what ": its patch, exactly; a disc of its area; nothing; "   \
                "clamp_d2" },                                                                      \
    [clamp_d2] = { .name = "clamp_d2", .type = GI_FLOAT, .unit = "m^2", .min = 1e-12, .max = 1e12, \
        .def = 1, .help = "least squared distance, with clamp=constant" }
// clang-format on

FG_END

#endif // GI_LIGHT_ROWS_H
