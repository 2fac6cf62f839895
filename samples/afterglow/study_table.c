// SPDX-License-Identifier: MIT
#include "study.h"

#include <string.h>

// Nichols, Shopf, Wyman. Hierarchical Image-Space Radiosity for Interactive Global Illumination.
// EGSR 2009. Its curves are scenes and thresholds; ours are settings, a scene at a time.
const study studies[] = {
    {
        .name = "stages",
        .title = "Table 1: cost of a frame by stage, 256 VPLs",
        .curves = { { "isr source=regular vpls=256", "isr" },
                    { "splat vpls=256", "splat" },
                    { "rsm vpls=256", "rsm" } },
        .panels = { { PANEL_STAGES, PANEL_MS,
                      "As in the paper the first stage is direct light and all other overhead. "
                      "Each pass by its GPU timer, or by the time in its callback where that is "
                      "longer." } },
    },
    {
        .name = "eye_depth",
        .title = "Figure 9: error of the eye hierarchy against its depth threshold",
        .curves = { { "isr source=regular vpls=256", "as by default" },
                    { "isr source=regular vpls=256 share=0", "share=0" },
                    { "isr source=regular vpls=256 share=0 metric=slope", "the paper's: slope" } },
        .x = "depth",
        .x_label = "depth threshold, derivative over the distance",
        .values = { "0", "0.001", "0.002", "0.005", "0.01", "0.02", "0.05", "0.1" },
        .baselines = { "rsm vpls=256" },
        .panels = { { PANEL_LINES, 0, "Against the full gather of the same 256 VPLs." },
                    { PANEL_LINES, PANEL_MS, "What each threshold costs." } },
    },
    {
        .name = "eye_normal",
        .title = "Figure 9: error of the eye hierarchy against its normal threshold",
        .curves = { { "isr source=regular vpls=256", "as by default" },
                    { "isr source=regular vpls=256 share=0", "share=0" },
                    { "isr source=regular vpls=256 share=0 metric=slope", "the paper's: slope" } },
        .x = "normal",
        .x_label = "normal threshold, extent of a component",
        .values = { "0", "0.05", "0.1", "0.25", "0.5", "1", "2" },
        .baselines = { "rsm vpls=256" },
        .panels = { { PANEL_LINES, 0, "Against the full gather of the same 256 VPLs." },
                    { PANEL_LINES, PANEL_MS, "What each threshold costs." } },
    },
    {
        .name = "path",
        .title = "Figure 10: frame time while the scene moves",
        .curves = { { "isr source=clusters", "isr" },
                    { "hisr tau=0.0003", "hisr tau=0.0003" },
                    { "hisr tau=0.001", "hisr tau=0.001" },
                    { "hisr tau=0.01", "hisr tau=0.01" },
                    { "rsm vpls=256", "rsm vpls=256" } },
        .panels = { { PANEL_PATH, PANEL_MS,
                      "Once through the scene's animation; the median of several passes." } },
        .path = { .frames = { 12, 48 } },
    },
    {
        .name = "initial",
        .title = "Figure 11: time against the initial resolution of the VPLs",
        .curves = { { "isr source=clusters", "as by default" },
                    { "isr source=clusters light_flux=0", "light_flux=0" },
                    { "isr source=clusters light_flux=0 light_normal=4 light_depth=0.05",
                      "by depth alone, 0.05" },
                    { "isr source=clusters light_flux=0 light_normal=4 light_depth=0.5",
                      "by depth alone, 0.5" } },
        .x = "light_initial",
        .x_label = "initial VPL resolution, texels along an edge",
        .x_log = true,
        .values = { "8", "16", "32", "64" },
        .baselines = { "rsm pattern=all" },
        .panels = { { PANEL_LINES, PANEL_MS,
                      "Lower thresholds make more light patches. The paper splits whatever flux a "
                      "patch has." },
                    { PANEL_LINES, 0, "Against the full gather of every texel of the same map." } },
    },
    {
        .name = "tau",
        .title = "Figures 12 and 13: time and error against tau, by maximal traversal depth",
        .curves = { { "hisr finest=32", "32 x 32" },
                    { "hisr finest=64", "64 x 64" },
                    { "hisr finest=128", "128 x 128" },
                    { "hisr finest=256", "256 x 256" } },
        .x = "tau",
        .x_label = "tau, over the mean radiosity of what is lit",
        .x_log = true,
        .values = { "0.0001", "0.0003", "0.001", "0.003", "0.01", "0.03", "0.1" },
        .baselines = { "isr source=regular rsm_size=1024 vpls=1048576",
                       "rsm rsm_size=1024 pattern=all" },
        .panels = { { PANEL_LINES, PANEL_MS,
                      "Figure 12: a coarse finest level ends the traversal early." },
                    { PANEL_LINES, 0,
                      "Figure 13: of the light hierarchy alone. Compared is the multiresolution "
                      "gather of a million VPLs." },
                    { PANEL_LINES, 1,
                      "In all: compared is a million VPLs gathered at every pixel." } },
    },
    {
        .name = "vpls",
        .title = "Full gather: time and error against the number of VPLs",
        .curves = { { "rsm pattern=regular", "regular" },
                    { "rsm pattern=stratified", "stratified" } },
        .x = "vpls",
        .x_label = "VPLs",
        .x_log = true,
        .values = { "16", "64", "256", "1024", "4096" },
        .baselines = { "rsm pattern=all" },
        .panels = { { PANEL_LINES, 0, "Against every texel of the same map." },
                    { PANEL_LINES, PANEL_MS,
                      "What the hierarchies are there to save: each VPL at every pixel." } },
    },
    {
        .name = "solid_angle",
        .title = "Texels of equal solid angle (eq. 4) against their own",
        .curves = { { "isr", "isr" }, { "hisr", "hisr" }, { "splat", "splat" }, { "rsm", "rsm" } },
        .x = "solid_angle",
        .values = { "exact", "equal" },
        .baselines = { "self solid_angle=exact", "path1_unshadowed" },
        .panels = { { PANEL_BARS, 0, "What the shortcut changes: against the same at exact." },
                    { PANEL_BARS, 1, "Both against the truth that no surface hides." } },
    },
    {
        .name = "visibility",
        .title = "Against the shadowed truth, with and without imperfect shadow maps",
        .curves = { { "isr", "isr" }, { "hisr", "hisr" }, { "rsm vpls=256", "rsm vpls=256" } },
        .x = "visibility",
        .values = { "none", "ism" },
        .baselines = { "path1", "path1_unshadowed" },
        .panels = { { PANEL_BARS, 0, "Against one bounce with shadows." },
                    { PANEL_BARS, PANEL_MS, "What visibility costs." } },
    },

    // Laine, Saransaari, Kontkanen, Lehtinen, Aila. Incremental Instant Radiosity for Real-Time
    // Indirect Illumination. EGSR 2007. What follows its tables the paper does not show.
    {
        .name = "iir_tables",
        .title = "Tables 1 and 2: incremental against anew, 256 VPLs, cost of a frame by stage",
        .curves = { { "iir max_lights=256", "incremental", .speed = 4 },
                    { "iir max_lights=256 mode=anew", "anew", .speed = 4 },
                    { "iir max_lights=256", "1.56 x, incr.", .speed = 4, .scale = 1.5625 },
                    { "iir max_lights=256 mode=anew", "1.56 x, anew", .speed = 4,
                      .scale = 1.5625 } },
        .panels = { { PANEL_STAGES, PANEL_MS,
                      "While light and camera move. The paper's sizes, 1024 x 768 and 1600 x 1200, "
                      "are as 1 to 1.56 along an edge." },
                    { PANEL_PATH, PANEL_MS, "The frame's time along the path." } },
        .path = { .frames = { 8, 60 },
                  .rate = 60,
                  .tour = true,
                  .counters = { "shadow_maps", "manage_ms" } },
        .joined = true,
    },
    {
        .name = "iir_recalc",
        .title = "Error against the budget of new VPLs, by the speed of the light",
        .curves = { { "iir", "as it is", .speed = 1 },
                    { "iir", "8 times as fast", .speed = 8 },
                    { "iir", "64 times as fast", .speed = 64 } },
        .x = "recalc_max",
        .x_label = "new VPLs a frame, at most",
        .x_log = true,
        .values = { "1", "2", "4", "8", "16", "32", "64" },
        .baselines = { "iir mode=anew max_lights=4096 delay=0" },
        .panels = { { PANEL_LINES, 0,
                      "Mean along the path, against 4096 VPLs anew. What is compared is a "
                      "frame late, which a fast light shows whatever the budget." },
                    { PANEL_LINES, PANEL_MS, "What the budget costs." } },
        .path = { .frames = { 6, 60 }, .rate = 60, .tour = true, .compared = { 1, 4 } },
    },
    {
        .name = "iir_path",
        .title = "Along a path: dispersion, new VPLs and error",
        .curves = { { "iir", "incremental, 4 to 8", .speed = 4 },
                    { "iir recalc_min=0", "0 to 8", .speed = 4 },
                    { "iir recalc_min=16 recalc_max=32", "16 to 32", .speed = 4 },
                    { "iir mode=anew", "anew", .speed = 4 } },
        .baselines = { "iir mode=anew max_lights=4096 delay=0" },
        .panels = { { PANEL_PATH, PANEL_COUNTER,
                      "Dispersion over that of as many points in a hexagonal lattice: 1 is best.",
                      "dispersion", "dispersion" },
                    { PANEL_PATH, PANEL_COUNTER, "VPLs that light no longer reaches, a frame.",
                      "invalid", "invalid VPLs" },
                    { PANEL_PATH, 0, "Against 4096 VPLs anew." } },
        .path = { .frames = { 12, 120 },
                  .rate = 60,
                  .tour = true,
                  .compared = { 2, 6 },
                  .counters = { "dispersion", "invalid", "new_vpls", "shadow_maps" } },
    },
    {
        .name = "iir_vpls",
        .title = "Error against the number of VPLs, with and without shadow maps",
        .curves = { { "iir delay=0", "with shadow maps" },
                    { "iir delay=0 visibility=none", "without" } },
        .x = "max_lights",
        .x_label = "VPLs",
        .x_log = true,
        .values = { "64", "256", "1024", "4096" },
        .baselines = { "path1", "path1_unshadowed" },
        .panels = { { PANEL_LINES, 0, "Against one bounce with shadows." },
                    { PANEL_LINES, 1, "Against one bounce that nothing hides." },
                    { PANEL_LINES, PANEL_MS, "What they cost, frame after frame." } },
    },
    { .name = NULL },
};

const study *study_find(const char *name)
{
    for (const study *s = studies; s->name; ++s)
        if (!strcmp(s->name, name))
            return s;
    return NULL;
}

int study_truth(const char *name)
{
    for (int i = 0; i < REPORT_TRUTHS; ++i)
        if (!strcmp(name, truth_names[i]))
            return i;
    return -1;
}

// ---- what is to be run -----------------------------------------------------------------------

int studies_check(cli *c, const options *o)
{
    char known[512];
    size_t used = 0;
    for (const study *s = studies; s->name && used < sizeof known; ++s)
        used += (size_t) snprintf(known + used, sizeof known - used, "%s%s",
                                  s == studies ? "" : ", ", s->name);
    for (int i = 0; i < o->study_count; ++i)
        if (!study_find(o->study[i]))
            return cli_fail(c, EXIT_USAGE, "--study: is '%s', must be one of %s", o->study[i],
                            known);
    return EXIT_DONE;
}

bool study_wanted(const options *o, bool full, const study *s)
{
    for (int i = 0; i < o->study_count; ++i)
        if (!strcmp(o->study[i], s->name))
            return true;
    return full && !o->study_count;
}

bool studies_need_truths(const options *o, bool full)
{
    for (const study *s = studies; s->name; ++s)
        for (int i = 0; s->baselines[i]; ++i)
            if (study_wanted(o, full, s) && study_truth(s->baselines[i]) >= 0)
                return true;
    return false;
}
