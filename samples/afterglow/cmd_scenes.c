// SPDX-License-Identifier: MIT
#include "record.h"
#include "scenes.h"

#include <stdlib.h>

static int print_json(cli *c)
{
    const builtin_scene *scene;
    cJSON *array = cJSON_CreateArray();
    for (int i = 0; (scene = scenes_builtin(i)); ++i) {
        cJSON *object = cJSON_CreateObject();
        cJSON_AddStringToObject(object, "name", scene->name);
        cJSON_AddStringToObject(object, "purpose", scene->purpose);
        cJSON_AddItemToObject(object, "features", record_features(scene->features));
        cJSON_AddItemToArray(array, object);
    }
    char *text = cJSON_Print(array);
    cJSON_Delete(array);
    if (!text)
        return cli_status(c, FG_ERR_MEMORY);
    printf("%s\n", text);
    free(text);
    return EXIT_DONE;
}

static void print_features(uint64_t features)
{
    const char *separator = "";
    for (int i = 0; i < AG_FEATURE_COUNT; ++i) {
        if (!(features >> i & 1))
            continue;
        printf("%s%s", separator, ag_feature_names[i]);
        separator = ", ";
    }
    printf("\n");
}

static int run(cli *c, const options *o)
{
    const builtin_scene *scene;
    if (o->json)
        return print_json(c);
    for (int i = 0; (scene = scenes_builtin(i)); ++i) {
        printf("%-12s %s\n%12s ", scene->name, scene->purpose, "");
        print_features(scene->features);
    }
    return EXIT_DONE;
}

const command command_scenes = {
    .name = "scenes",
    .operands = "",
    .summary = "Lists the built-in scenes",
    .option_names = " --json ",
    .run = run,
};
