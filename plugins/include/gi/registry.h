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
    bool hot; // gi_reload() can be used: modules are loaded from a copy of their file, with no name
              // of its own, so that writing to the file harms nobody
} gi_registry_desc;

FG_API FG_NODISCARD fg_status gi_registry_create(const gi_registry_desc *desc, gi_registry **out);
FG_API void gi_registry_destroy(gi_registry *r); // accepts NULL; unloads modules

// Loads the module on first use. NULL, with a log line that says why: unknown, not
// loadable, no GI_PLUGIN_SYMBOL, another ABI, a broken table, a name that is not its file's.
FG_API const gi_plugin *gi_find(gi_registry *r, const char *name);

// Names there are, sorted; NULL past the end. Nothing is loaded. A name stays where it is as
// long as the registry, its index only until gi_rescan().
FG_API const char *gi_name(gi_registry *r, int i);

// ---- modules that change while a host runs --------------------------------------------

//     if (gi_changed(r, "rsm") && gi_reload(r, "rsm") != FG_ERR_INPUT)
//         plugin = gi_find(r, "rsm");       // another one: parameters, layers, all may differ;
//                                           // NULL: refused, direct light goes on alone
//
// What was loaded stays mapped until the registry is destroyed, so that what still points into
// it keeps its meaning: a gi_plugin, an instance, a counter's name, a graph's callbacks, and the
// shaders by whose address fg_gl_program() knows its programs. Each reload costs the module's
// size. State of the module's own starts anew, but for what C++ makes unique in a process
// (inline variables): that is shared with the old one.

// Whether the file was replaced, has appeared or is gone since it was last opened, and nobody has
// written to it for a quarter of a second. Never loads; costs a stat(): ask in each frame. false
// for what nobody has asked for yet, what is linked in, and where the registry is not hot.
FG_API bool gi_changed(gi_registry *r, const char *name);

// Loads the module again. Errors, each with a line that says why, after each of which
// gi_changed() waits for another file:
// FG_ERR_INPUT: there is no file, or none that can be loaded (no module, half written, a symbol
//               missing): the module before stays, and gi_find() gives it.
// FG_ERR_UNSUPPORTED: it was loaded and refused, as gi_find() refuses: there is none any more.
// FG_ERR_INVALID: unknown, linked in, or the registry is not hot. FG_ERR_MEMORY: nothing changes.
FG_API FG_NODISCARD fg_status gi_reload(gi_registry *r, const char *name);

// Looks for modules anew, in the same places. What has appeared gets a name; what is gone keeps
// it. Where another folder has a module now, or one before the others, gi_changed() says so.
// Reads folders: not in each frame.
FG_API FG_NODISCARD fg_status gi_rescan(gi_registry *r);

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
