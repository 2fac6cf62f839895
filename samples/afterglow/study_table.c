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
        .path = true,
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
    char known[256];
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

// ---- stages ----------------------------------------------------------------------------------

enum {
    STAGE_REST,
    STAGE_MAP,
    STAGE_VPLS,
    STAGE_MIPMAPS,
    STAGE_REFINE,
    STAGE_VISIBILITY,
    STAGE_LIGHT,
    STAGE_UPSAMPLE,
    STAGE_OTHER
};
const char *const study_stages[] = {
    [STAGE_REST] = "direct light and the rest",
    [STAGE_MAP] = "RSM",
    [STAGE_VPLS] = "VPLs",
    [STAGE_MIPMAPS] = "mipmaps",
    [STAGE_REFINE] = "stencil, refinement",
    [STAGE_VISIBILITY] = "visibility",
    [STAGE_LIGHT] = "gather, splat",
    [STAGE_UPSAMPLE] = "upsampling",
    [STAGE_OTHER] = "other",
    NULL,
};

// By how the name goes on after the plugin's; the first that fits.
static const struct {
    const char *start;
    int stage;
} pass_stages[] = {
    { "face", STAGE_MAP },
    { "build", STAGE_MAP },
    { "pack", STAGE_VPLS },
    { "count_vpls", STAGE_VPLS },
    { "count_nodes", STAGE_VPLS },
    { "light", STAGE_VPLS },
    { "sum", STAGE_VPLS },
    { "choose", STAGE_VPLS },
    { "cluster", STAGE_VPLS },
    { "tree", STAGE_VPLS },
    { "vpl", STAGE_VPLS },
    { "eye_variation", STAGE_MIPMAPS },
    { "variation", STAGE_MIPMAPS },
    { "refine", STAGE_REFINE },
    { "stencil", STAGE_REFINE },
    { "valid", STAGE_REFINE },
    { "count_texels", STAGE_REFINE },
    { "count_patches", STAGE_REFINE },
    { "share", STAGE_REFINE },
    { "list", STAGE_REFINE },
    { "eyes", STAGE_VISIBILITY },
    { "ism", STAGE_VISIBILITY },
    { "gather", STAGE_LIGHT },
    { "splat", STAGE_LIGHT },
    { "cells", STAGE_UPSAMPLE },
    { "push", STAGE_UPSAMPLE },
    { "upsample", STAGE_UPSAMPLE },
};

static int stage_of(const char *step)
{
    for (int i = 0; i < FG_COUNT(pass_stages); ++i)
        if (!strncmp(step, pass_stages[i].start, strlen(pass_stages[i].start)))
            return pass_stages[i].stage;
    return STAGE_OTHER;
}

void study_add_stages(cJSON *record)
{
    double ms[STAGE_OTHER + 1] = { 0 };
    double rest = json_number(cJSON_GetObjectItem(record, "frame_ms"), "median");
    const char *plugin = json_text(record, "plugin");
    const size_t length = strlen(plugin);
    const cJSON *pass;
    cJSON_ArrayForEach(pass, cJSON_GetObjectItem(record, "passes"))
    {
        const char *name = json_text(pass, "name");
        const double own = report_pass_ms(pass);
        if (strncmp(name, plugin, length) != 0 || name[length] != '.' || !(own > 0))
            continue;
        ms[stage_of(name + length + 1)] += own;
        rest -= own;
    }
    ms[STAGE_REST] = rest > 0 ? rest : 0;
    cJSON *stages = cJSON_AddArrayToObject(record, "stages");
    for (int i = 0; i <= STAGE_OTHER; ++i) {
        cJSON *stage = cJSON_CreateObject();
        cJSON_AddStringToObject(stage, "stage", study_stages[i]);
        cJSON_AddNumberToObject(stage, "ms", ms[i]);
        cJSON_AddItemToArray(stages, stage);
    }
}

double study_own_ms(const cJSON *point)
{
    const cJSON *stages = cJSON_GetObjectItem(point, "stages"), *stage;
    double sum = 0;
    cJSON_ArrayForEach(stage, stages)
    {
        const char *name = json_text(stage, "stage");
        if (strcmp(name, study_stages[STAGE_REST]) != 0 &&
            strcmp(name, study_stages[STAGE_MAP]) != 0)
            sum += json_number(stage, "ms");
    }
    return sum;
}
