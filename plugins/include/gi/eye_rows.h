// SPDX-License-Identifier: MIT
#ifndef GI_EYE_ROWS_H
#define GI_EYE_ROWS_H

#include <gi/plugin.h>
#include <math.h>
#include <pass/multires.h>

FG_BEGIN

// The parameters of the multiresolution buffer, the same rows in every technique that lights one:
//
//     enum { RSM_SIZE, ..., EYE, AFTER_EYE = EYE + GI_EYE_ROWS, ... };
//     static const gi_param params[] = { ..., GI_EYE_PARAMS(EYE, 3), ... };
//     ag_multires_desc eye = gi_eye_desc("isr", values + EYE, width, height);
enum {
    GI_EYE_DEPTH,
    GI_EYE_NORMAL,
    GI_EYE_COARSEST,
    GI_EYE_SHARE,
    GI_EYE_METRIC,
    GI_EYE_BALANCED,
    GI_EYE_PATCH_ROWS, // GI_EYE_PATCH_PARAMS(): of who has no use for culling
    GI_EYE_CULL = GI_EYE_PATCH_ROWS,
    GI_EYE_ROWS,
};

static const char *const gi_eye_metrics[] = { "plane", "slope", NULL };
static const char *const gi_eye_culls[] = { "compact", "stencil", NULL };
static const double gi_eye_normal_sweep[] = { 2, 1, 0.5, 0.25, 0.1, 0, (double) NAN };

// clang-format off
#define GI_EYE_PATCH_PARAMS(first, share_default)                                                  \
    [(first) + GI_EYE_DEPTH] = { .name = "depth", .type = GI_FLOAT, .unit = "1", .min = 0,         \
        .max = 1e6, .def = 0.005,                                                                  \
        .help = "depth derivative, over the distance, from which on a texel is refined" },         \
    [(first) + GI_EYE_NORMAL] = { .name = "normal", .type = GI_FLOAT, .unit = "1", .min = 0,       \
        .max = 4, .def = 0.25, .quality = true, .sweep = gi_eye_normal_sweep,                      \
        .help = "extent of a component of the normal from which on a texel is refined" },          \
    [(first) + GI_EYE_COARSEST] = { .name = "coarsest", .type = GI_INT, .unit = "texels",          \
        .min = 1, .max = 16384, .def = 64,                                                         \
        .help = "texels along the longer edge of the coarsest level, about" },                     \
    [(first) + GI_EYE_SHARE] = { .name = "share", .type = GI_INT, .unit = "1", .min = 0, .max = 3, \
        .def = (share_default),                                                                    \
        .help = "level of the blocks in which each surface is lit at one pixel where there is an "  \
                "edge; 0: none, refined to pixels as in the paper" },                              \
    [(first) + GI_EYE_METRIC] = { .name = "metric", .type = GI_ENUM, .unit = "1",                  \
        .choices = gi_eye_metrics,                                                                 \
        .help = "depth derivative: departure from a plane, or the paper's slope" },                \
    [(first) + GI_EYE_BALANCED] = { .name = "balanced", .type = GI_BOOL, .unit = "1", .def = 1,    \
        .help = "levels of neighbours differ by one at most" }

#define GI_EYE_PARAMS(first, share_default)                                                        \
    GI_EYE_PATCH_PARAMS(first, share_default),                                                     \
    [(first) + GI_EYE_CULL] = { .name = "cull", .type = GI_ENUM, .unit = "1",                      \
        .choices = gi_eye_culls,                                                                   \
        .help = "what is not valid: left out of a list, or by the paper's stencil" }
// clang-format on

// `values`: from the row of GI_EYE_DEPTH on.
static inline ag_multires_desc gi_eye_patch_desc(const char *prefix, const gi_value *values,
                                                 int width, int height)
{
    ag_multires_desc desc = { 0 };
    desc.prefix = prefix;
    desc.width = width;
    desc.height = height;
    desc.depth = (float) values[GI_EYE_DEPTH].f;
    desc.normal = (float) values[GI_EYE_NORMAL].f;
    desc.coarsest = (int) values[GI_EYE_COARSEST].i;
    desc.share = (int) values[GI_EYE_SHARE].i;
    desc.metric = (ag_depth_metric) values[GI_EYE_METRIC].i;
    desc.unbalanced = values[GI_EYE_BALANCED].i == 0;
    return desc;
}

static inline ag_multires_desc gi_eye_desc(const char *prefix, const gi_value *values, int width,
                                           int height)
{
    ag_multires_desc desc = gi_eye_patch_desc(prefix, values, width, height);
    desc.cull = (ag_cull) values[GI_EYE_CULL].i;
    return desc;
}

FG_END

#endif // GI_EYE_ROWS_H
