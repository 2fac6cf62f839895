// SPDX-License-Identifier: MIT
#ifndef GI_REGISTRY_H
#define GI_REGISTRY_H

#include <gi/plugin.h>

FG_BEGIN

// Finds plugins by name: those linked in, then shared modules `gi_NAME.so` in the plugin
// path: the folders given, AFTERGLOW_PLUGIN_PATH (colon-separated), the build's or the
// installed one. The first of a name wins.
typedef struct gi_registry gi_registry;

typedef struct gi_registry_desc {
    const fg_log *log;       // borrowed
    const char *const *dirs; // ends at NULL; may be NULL
    bool only_dirs;          // leave the environment and the default folder out
} gi_registry_desc;

FG_API FG_NODISCARD fg_status gi_registry_create(const gi_registry_desc *desc, gi_registry **out);
FG_API void gi_registry_destroy(gi_registry *r); // accepts NULL; unloads modules

// Loads the module on first use. NULL, with a log line that says why: unknown, not
// loadable, no GI_PLUGIN_SYMBOL, another ABI, a broken table, a name that is not its file's.
FG_API const gi_plugin *gi_find(gi_registry *r, const char *name);

// Names there are, sorted; NULL past the end. Nothing is loaded.
FG_API const char *gi_name(gi_registry *r, int i);

// How many debug layers the plugin states.
FG_API int gi_layers_count(const gi_plugin *p);

// ---- parameter values ----------------------------------------------------------------

FG_API int gi_params_count(const gi_plugin *p);
FG_API void gi_params_default(const gi_plugin *p, gi_value *values); // [gi_params_count()]

// Parses "key=value" into `values`. FG_ERR_INVALID with a line that names plugin, key, value
// and range; `values` is then unchanged.
FG_API FG_NODISCARD fg_status gi_params_set(const fg_log *log, const gi_plugin *p, gi_value *values,
                                            const char *assignment);
// Writes value i as text that gi_params_set() takes; returns as snprintf.
FG_API int gi_params_print(const gi_plugin *p, const gi_value *values, int i, char *text,
                           size_t size);

FG_END

#endif // GI_REGISTRY_H
