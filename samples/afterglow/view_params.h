// SPDX-License-Identifier: MIT
#ifndef VIEW_PARAMS_H
#define VIEW_PARAMS_H

#include <cjson/cJSON.h>
#include <gi/registry.h>

// A parameter set: what the viewer shows, as a JSON file that can be loaded again. No window.
//
//     { "afterglow": "view", "scene": "cornell", "plugin": "rsm", "params": { "vpls": 256 },
//       "layer": "final", "exposure": 1,
//       "camera": { "eye": [0, 1, 4], "yaw": 0, "pitch": -5, "yfov": 40 },
//       "second": { "plugin": "hisr", "params": {} }, "divider": 0.5 }
//
// All but "afterglow" may be missing. The camera is { "name": "path" } where the scene's own is
// followed. Angles in degrees, lengths in metres.

enum { VIEW_NAME = 64, VIEW_SET_MAX_BYTES = 1 << 20 };

typedef struct view_set_side {
    char plugin[VIEW_NAME]; // "none": direct light alone; "": not said
    cJSON *params;          // owned; NULL: none given
} view_set_side;

typedef struct view_set {
    char scene[VIEW_NAME];  // for whom it was made: a note
    view_set_side sides[2]; // the second: with a split alone
    char layer[VIEW_NAME];  // "final", "hisr.level"; "": not said
    double exposure;        // 0: not said
    double divider;         // of the split, (0, 1); 0: not said
    char camera[VIEW_NAME]; // of the scene; "": the pose below, if has_pose
    bool has_pose;
    double eye[3], yaw, pitch, yfov; // m, degrees
} view_set;

void view_set_finish(view_set *s); // accepts a zeroed one

// The parameters as a set holds them: by name, in the terms of the plugin's table.
cJSON *view_set_params(const gi_plugin *p, const gi_value *values); // NULL: out of memory

// JSON text, to be freed; NULL: out of memory.
char *view_set_print(const view_set *s);

// `name` is the file's, for messages. FG_ERR_INPUT: no JSON, a key that is unknown, of the wrong
// kind or out of range; `*out` is zeroed then.
FG_NODISCARD fg_status view_set_parse(const fg_log *log, const char *name, const char *text,
                                      view_set *out);

// Sets `values` [gi_params_count()] to the defaults and what the set says. FG_ERR_INPUT: a
// parameter that the plugin does not have or take; `values` is unchanged then.
FG_NODISCARD fg_status view_set_values(const fg_log *log, const char *name, const cJSON *params,
                                       const gi_plugin *p, gi_value *values);

FG_NODISCARD fg_status view_set_save(const fg_log *log, const char *path, const view_set *s);
FG_NODISCARD fg_status view_set_load(const fg_log *log, const char *path, view_set *out);

#endif // VIEW_PARAMS_H
