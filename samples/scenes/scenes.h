// SPDX-License-Identifier: MIT
#ifndef SCENES_H
#define SCENES_H

#include <pass/scene.h>

FG_BEGIN

// Built-in scenes, made by code.
typedef struct builtin_scene {
    const char *name;
    const char *purpose; // one line: what it is for
    uint64_t features;   // ag_feature bits that the scene has once it is built
    fg_status (*build)(const fg_log *log, ag_scene **out);
} builtin_scene;

const builtin_scene *scenes_builtin(int i); // NULL past the end

// A built-in by name, else a .gltf or .glb by path, else NAME, NAME.gltf, NAME.glb or the first
// by name of NAME/*.gltf, failing that of NAME/*.glb, below AFTERGLOW_SCENES. Errors as
// ag_scene_load().
FG_NODISCARD fg_status scenes_open(const fg_log *log, const char *name, ag_scene **out);

FG_END

#endif // SCENES_H
