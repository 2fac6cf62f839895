// SPDX-License-Identifier: MIT
// One version of a plugin that is loaded again, by HOT_VERSION and HOT_KIND.
#include "stub.h"

#define SOUND 0
#define OTHER_ABI 1
#define UNRESOLVED 2
#define UNIQUE 3

#if HOT_KIND == UNRESOLVED
FG_API int nobody_defines_this(void);
#elif HOT_KIND == UNIQUE
#include "hot_bridge.h"
#endif

// Large enough to fill pages that are read from the file when they are first touched.
static const int table[64 * 1024] = { [64 * 1024 - 1] = HOT_VERSION };

// "version" is the module's, "calls" how often this state was asked.
static int counters(void *self, gi_counter *out, int max)
{
    static int calls;
    (void) self;
    if (max < 2)
        return 0;
    out[0] = (gi_counter){ "version", table[64 * 1024 - 1] };
    out[1] = (gi_counter){ "calls", ++calls };
#if HOT_KIND == UNRESOLVED
    out[1].value = nobody_defines_this();
#elif HOT_KIND == UNIQUE
    out[1].value = hot_unique_calls();
#endif
    return 2;
}

static const gi_param params[] = {
    { .name = "first", .min = 0, .max = 8, .def = HOT_VERSION },
#if HOT_VERSION > 1
    { .name = "second", .min = 0, .max = 8, .def = HOT_VERSION },
#endif
    { .name = NULL },
};

static const gi_plugin plugin = {
    .abi = HOT_KIND == OTHER_ABI ? GI_PLUGIN_ABI + 1 : GI_PLUGIN_ABI,
    .name = HOT_NAME,
    .source = "none",
    .summary = HOT_VERSION == 1 ? "version 1" : "version 2",
    .params = params,
    .create = create,
    .declare = declare,
    .counters = counters,
    .destroy = destroy,
};

#undef GI_PLUGINS_LINKED
GI_PLUGIN_ENTRY(hot)
{
    return &plugin;
}
