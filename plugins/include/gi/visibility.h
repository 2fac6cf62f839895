// SPDX-License-Identifier: MIT
#ifndef GI_VISIBILITY_H
#define GI_VISIBILITY_H

#include <gi/plugin.h>

FG_BEGIN

// Rows of a plugin's parameter table for indirect visibility, the same in every technique that
// gathers from VPLs; pass/ism.h makes what they ask for:
//
//     enum { ..., VISIBILITY, ISM_SIZE, ISM_POINTS, PARAM_COUNT };
//     static const gi_param params[] = {
//         ...
//         GI_VISIBILITY_PARAMS(VISIBILITY, ISM_SIZE, ISM_POINTS),
//         { .name = NULL },
//     };
typedef enum gi_visibility {
    GI_VISIBILITY_NONE = 0,
    GI_VISIBILITY_ISM, // imperfect shadow maps
} gi_visibility;

static const char *const gi_visibility_names[] = { "none", "ism", NULL };

// clang-format off
#define GI_VISIBILITY_PARAMS(visibility, ism_size, ism_points)                                     \
    [visibility] = { .name = "visibility",                                                         \
                     .type = GI_ENUM,                                                              \
                     .unit = "1",                                                                  \
                     .def = GI_VISIBILITY_NONE,                                                    \
                     .choices = gi_visibility_names,                                               \
                     .help = "of a VPL from a pixel: always, or by imperfect shadow maps" },       \
    [ism_size] = { .name = "ism_size",                                                             \
                   .type = GI_INT,                                                                 \
                   .unit = "texels",                                                               \
                   .min = 8,                                                                       \
                   .max = 64,                                                                      \
                   .def = 64,                                                                      \
                   .power_of_two = true,                                                           \
                   .help = "edge of an imperfect shadow map, with visibility=ism" },               \
    [ism_points] = { .name = "ism_points",                                                         \
                     .type = GI_INT,                                                               \
                     .unit = "1",                                                                  \
                     .min = 256,                                                                   \
                     .max = 32768,                                                                 \
                     .def = 8192,                                                                  \
                     .power_of_two = true,                                                         \
                     .help = "point samples of the scene in each of them" }
// clang-format on

FG_END

#endif // GI_VISIBILITY_H
