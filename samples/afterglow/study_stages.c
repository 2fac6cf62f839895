// SPDX-License-Identifier: MIT
#include "study.h"

#include <string.h>

enum {
    STAGE_REST,
    STAGE_MAP,
    STAGE_VPLS,
    STAGE_MIPMAPS,
    STAGE_REFINE,
    STAGE_SPLIT,
    STAGE_VISIBILITY,
    STAGE_LIGHT,
    STAGE_UPSAMPLE,
    STAGE_COMBINE,
    STAGE_FILTER,
    STAGE_OTHER
};
const char *const study_stages[] = {
    [STAGE_REST] = "direct light and the rest",
    [STAGE_MAP] = "RSM",
    [STAGE_VPLS] = "VPLs",
    [STAGE_MIPMAPS] = "mipmaps",
    [STAGE_REFINE] = "stencil, refinement",
    [STAGE_SPLIT] = "split",
    [STAGE_VISIBILITY] = "visibility",
    [STAGE_LIGHT] = "gather, splat",
    [STAGE_UPSAMPLE] = "upsampling",
    [STAGE_COMBINE] = "combine",
    [STAGE_FILTER] = "filter",
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
    { "upload", STAGE_VPLS },
    { "eye_variation", STAGE_MIPMAPS },
    { "variation", STAGE_MIPMAPS },
    { "refine", STAGE_REFINE },
    { "stencil", STAGE_REFINE },
    { "valid", STAGE_REFINE },
    { "count_texels", STAGE_REFINE },
    { "count_patches", STAGE_REFINE },
    { "share", STAGE_REFINE },
    { "list", STAGE_REFINE },
    { "split", STAGE_SPLIT },
    { "eyes", STAGE_VISIBILITY },
    { "ism", STAGE_VISIBILITY },
    { "shadow", STAGE_VISIBILITY },
    { "gather", STAGE_LIGHT },
    { "near", STAGE_LIGHT },
    { "splat", STAGE_LIGHT },
    { "cells", STAGE_UPSAMPLE },
    { "push", STAGE_UPSAMPLE },
    { "upsample", STAGE_UPSAMPLE },
    { "combine", STAGE_COMBINE },
    { "compensate", STAGE_COMBINE },
    { "filter", STAGE_FILTER },
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

double study_stage_ms(const cJSON *point, const char *stage)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(point, "stages"))
    {
        if (!strcmp(json_text(item, "stage"), stage))
            return json_number(item, "ms");
    }
    return 0;
}

bool study_has_stage(const cJSON *points, const char *stage)
{
    const cJSON *point;
    cJSON_ArrayForEach(point, points)
    {
        if (study_stage_ms(point, stage) > 0)
            return true;
    }
    return false;
}

double study_own_ms(const cJSON *point)
{
    double sum = 0;
    for (int i = 0; study_stages[i]; ++i)
        if (i != STAGE_REST && i != STAGE_MAP)
            sum += study_stage_ms(point, study_stages[i]);
    return sum;
}
