// SPDX-License-Identifier: MIT
#include "host.h"

#include <math.h>
#include <stdlib.h>

static const char *const type_names[] = { "int", "float", "bool", "enum" };

static void print_param(const gi_param *p, const char *def)
{
    printf("  %-16s %-5s default %s", p->name, type_names[p->type], def);
    if (p->type == GI_INT || p->type == GI_FLOAT)
        printf(", %.9g to %.9g%s", p->min, p->max, p->power_of_two ? ", a power of two" : "");
    for (int k = 0; p->type == GI_ENUM && p->choices[k]; ++k)
        printf("%s%s", k ? "|" : ", ", p->choices[k]);
    if (p->unit && (p->unit[0] != '1' || p->unit[1]))
        printf(" [%s]", p->unit);
    printf("%s\n  %16s %s\n", p->quality ? ", swept by report" : "", "", p->help ? p->help : "");
}

static bool print_plugin(const gi_plugin *plugin)
{
    const int count = gi_params_count(plugin);
    gi_value *values = calloc((size_t) (count > 0 ? count : 1), sizeof *values);
    if (!values)
        return false;
    gi_params_default(plugin, values);
    printf("%s\n  %s\n  %s\n", plugin->name, plugin->summary ? plugin->summary : "",
           plugin->source ? plugin->source : "");
    for (int i = 0; i < count; ++i) {
        char text[64];
        gi_params_print(plugin, values, i, text, sizeof text);
        print_param(&plugin->params[i], text);
    }
    for (int i = 0; i < gi_layers_count(plugin); ++i)
        printf("  --layer %s.%s\n  %16s %s\n", plugin->name, plugin->layers[i].name, "",
               plugin->layers[i].help);
    free(values);
    return true;
}

// The value of a row as JSON has it; `value` is in the terms of the table.
static cJSON *value_json(const gi_param *p, double value)
{
    if (p->type == GI_BOOL)
        return cJSON_CreateBool(value != 0);
    if (p->type == GI_ENUM)
        return cJSON_CreateString(p->choices[(int) value]);
    return cJSON_CreateNumber(value);
}

static cJSON *param_json(const gi_param *p)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "name", p->name);
    cJSON_AddStringToObject(object, "type", type_names[p->type]);
    cJSON_AddStringToObject(object, "unit", p->unit ? p->unit : "1");
    cJSON_AddItemToObject(object, "default", value_json(p, p->def));
    if (p->type == GI_INT || p->type == GI_FLOAT) {
        cJSON_AddNumberToObject(object, "min", p->min);
        cJSON_AddNumberToObject(object, "max", p->max);
    }
    if (p->type == GI_INT)
        cJSON_AddBoolToObject(object, "power_of_two", p->power_of_two);
    if (p->type == GI_ENUM) {
        cJSON *choices = cJSON_AddArrayToObject(object, "choices");
        for (int k = 0; p->choices[k]; ++k)
            cJSON_AddItemToArray(choices, cJSON_CreateString(p->choices[k]));
    }
    cJSON_AddStringToObject(object, "help", p->help ? p->help : "");
    cJSON_AddBoolToObject(object, "quality", p->quality);
    cJSON *sweep = cJSON_AddArrayToObject(object, "sweep");
    for (int k = 0; p->sweep && !isnan(p->sweep[k]); ++k)
        cJSON_AddItemToArray(sweep, value_json(p, p->sweep[k]));
    return object;
}

static cJSON *plugin_json(const gi_plugin *plugin)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "name", plugin->name);
    cJSON_AddStringToObject(object, "summary", plugin->summary ? plugin->summary : "");
    cJSON_AddStringToObject(object, "source", plugin->source ? plugin->source : "");
    cJSON_AddNumberToObject(object, "abi", plugin->abi);
    cJSON *needs = cJSON_AddArrayToObject(object, "needs");
    for (int i = 0; i < AG_FEATURE_COUNT; ++i)
        if (plugin->needs >> i & 1)
            cJSON_AddItemToArray(needs, cJSON_CreateString(ag_feature_names[i]));
    cJSON *params = cJSON_AddArrayToObject(object, "params");
    for (int i = 0; i < gi_params_count(plugin); ++i)
        cJSON_AddItemToArray(params, param_json(&plugin->params[i]));
    cJSON *layers = cJSON_AddArrayToObject(object, "layers");
    for (int i = 0; i < gi_layers_count(plugin); ++i) {
        cJSON *layer = cJSON_CreateObject();
        cJSON_AddStringToObject(layer, "name", plugin->layers[i].name);
        cJSON_AddStringToObject(layer, "help", plugin->layers[i].help);
        cJSON_AddItemToArray(layers, layer);
    }
    return object;
}

static int list(host *h)
{
    const char *name;
    bool memory = true;
    cJSON *array = cJSON_CreateArray();
    for (int i = 0; (name = gi_name(h->registry, i)); ++i) {
        const gi_plugin *plugin = gi_find(h->registry, name);
        if (!plugin)
            cli_forgive(h->c);
        else if (h->o->json)
            cJSON_AddItemToArray(array, plugin_json(plugin));
        else
            memory = memory && print_plugin(plugin);
    }
    char *text = h->o->json ? cJSON_Print(array) : NULL;
    if (text)
        printf("%s\n", text);
    else if (h->o->json)
        memory = false;
    free(text);
    cJSON_Delete(array);
    return memory ? EXIT_DONE : cli_status(h->c, FG_ERR_MEMORY);
}

static int run(cli *c, const options *o)
{
    host h;
    host_init(&h, c, o);
    int code = host_open_registry(&h);
    if (code == EXIT_DONE)
        code = list(&h);
    host_finish(&h);
    return code;
}

const command command_plugins = {
    .name = "plugins",
    .operands = "",
    .summary = "Lists the plugins that are installed, with their parameters and layers",
    .option_names = " --json --plugin-dir ",
    .run = run,
};
