// SPDX-License-Identifier: MIT
// One broken or sound plugin module, by MODULE_KIND.
#include "stub.h"

#include <math.h>

#define SOUND 0
#define WRONG_ABI 1
#define NO_SYMBOL 2
#define WRONG_NAME 3
#define NO_CREATE 4
#define BAD_DEFAULT 5
#define NO_TABLE 6
#define TWIN_LAYERS 7
#define MANY_LAYERS 8
#define DOTTED_LAYER 9
#define MUTE_LAYER 10

static const char *const colours[] = { "red", "green", "blue", NULL };
static const gi_param params[] = {
    { .name = "size",
      .unit = "texels",
      .min = 1,
      .max = 1024,
      .def = MODULE_KIND == BAD_DEFAULT ? 2048 : 256,
      .power_of_two = true },
    { .name = "count", .unit = "1", .min = -3, .max = 7, .def = 0 },
    { .name = "reach", .type = GI_FLOAT, .unit = "m", .min = 0, .max = 10, .def = 0.1 },
    { .name = "shadows", .type = GI_BOOL, .def = 1 },
    { .name = "colour", .type = GI_ENUM, .choices = colours, .def = 1 },
    { .name = NULL },
};

#define LAYER(text)                                                                                \
    {                                                                                              \
        .name = text, .help = "for tests"                                                          \
    }
static const gi_layer layers[] = {
    { .name = "level", .help = MODULE_KIND == MUTE_LAYER ? NULL : "for tests" },
    LAYER(MODULE_KIND == DOTTED_LAYER ? "a.b" : "b"),
    LAYER(MODULE_KIND == TWIN_LAYERS ? "level" : "c"),
    LAYER("d"),
    LAYER("e"),
    LAYER("f"),
    LAYER("g"),
    LAYER("h"),
    LAYER(MODULE_KIND == MANY_LAYERS ? "i" : NULL),
    { .name = NULL },
};

static const gi_plugin plugin = {
    .abi = MODULE_KIND == WRONG_ABI ? GI_PLUGIN_ABI + 1 : GI_PLUGIN_ABI,
    .name = MODULE_KIND == WRONG_NAME ? "else" : MODULE_NAME,
    .source = "none",
    .summary = "for tests",
    .params = params,
    .layers = layers,
    .create = MODULE_KIND == NO_CREATE ? NULL : create,
    .declare = declare,
    .destroy = destroy,
};

#if MODULE_KIND == NO_SYMBOL
FG_API const gi_plugin *another_name(void);
FG_API const gi_plugin *another_name(void)
#else
#undef GI_PLUGINS_LINKED
GI_PLUGIN_ENTRY(module)
#endif
{
    return MODULE_KIND == NO_TABLE ? NULL : &plugin;
}
