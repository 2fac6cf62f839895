// SPDX-License-Identifier: MIT
#include "scenes.h"

#include "builtin.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// What every one of them has: triangles, a light that moves and parts that do.
enum {
    LIVE = AG_FEATURE_GEOMETRY | AG_FEATURE_LIGHT | AG_FEATURE_MOVING_LIGHT |
           AG_FEATURE_MOVING_GEOMETRY,
};

enum {
    ROOM_FEATURES = AG_FEATURE_SPOT_LIGHT | AG_FEATURE_SEVERAL_LIGHTS | AG_FEATURE_TEXTURES |
                    AG_FEATURE_TEXTURE_TRANSFORM | AG_FEATURE_MOVING_MATERIAL |
                    AG_FEATURE_EMISSIVE | AG_FEATURE_AREA_LIGHT | AG_FEATURE_GLOSSY |
                    AG_FEATURE_VERTEX_COLOR,
    FACTORY_FEATURES = AG_FEATURE_SPOT_LIGHT | AG_FEATURE_POINT_LIGHT | AG_FEATURE_SEVERAL_LIGHTS |
                       AG_FEATURE_TEXTURES | AG_FEATURE_TEXTURE_TRANSFORM |
                       AG_FEATURE_MOVING_MATERIAL | AG_FEATURE_EMISSIVE | AG_FEATURE_AREA_LIGHT |
                       AG_FEATURE_GLOSSY,
    GARDEN_FEATURES = AG_FEATURE_DIRECTIONAL_LIGHT | AG_FEATURE_SPOT_LIGHT |
                      AG_FEATURE_SEVERAL_LIGHTS | AG_FEATURE_TEXTURES | AG_FEATURE_ALPHA_MASK,
};

static const builtin_scene table[] = {
    { "cornell", "the Cornell box as measured, with a spot under its ceiling",
      LIVE | AG_FEATURE_SPOT_LIGHT, cornell_build },
    { "atrium", "a two-storey court in bays with cloths, jars and plants, under a moving light",
      LIVE | AG_FEATURE_SPOT_LIGHT | AG_FEATURE_TEXTURES | AG_FEATURE_ALPHA_MASK, atrium_build },
    { "living-room",
      "an evening room: sun through a window, lamps, a television whose picture changes",
      LIVE | ROOM_FEATURES, living_room_build },
    { "maze", "a winding corridor around a statue, lit through one opening: light around corners",
      LIVE | AG_FEATURE_SPOT_LIGHT | AG_FEATURE_TEXTURES, maze_build },
    { "garden",
      "a walled garden of masked leaves under the moon: trees, hedges, a pond, a pavilion",
      LIVE | GARDEN_FEATURES, garden_build },
    { "factory", "a hall of boxes under many lights, with belts, robots and a crane that run",
      LIVE | FACTORY_FEATURES, factory_build },
};

const builtin_scene *scenes_builtin(int i)
{
    return i >= 0 && i < FG_COUNT(table) ? &table[i] : NULL;
}

static bool is_file(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0 && S_ISREG(st.st_mode);
}

static bool ends_in(const char *name, const char *ending)
{
    const size_t length = strlen(name), tail = strlen(ending);
    return length > tail && !strcmp(name + length - tail, ending);
}

// The directory's first file by name that ends so; its path in `out`, or false.
static bool first_file(const char *folder, const char *ending, char *out, size_t size)
{
    char best[256] = "";
    DIR *dir = opendir(folder);
    if (!dir)
        return false;
    for (const struct dirent *e = readdir(dir); e; e = readdir(dir)) {
        const size_t length = strlen(e->d_name);
        if (ends_in(e->d_name, ending) && length < sizeof best &&
            (!best[0] || strcmp(e->d_name, best) < 0))
            memcpy(best, e->d_name, length + 1);
    }
    closedir(dir);
    const int written = snprintf(out, size, "%s/%s", folder, best);
    return best[0] && written > 0 && (size_t) written < size && is_file(out);
}

// NAME, NAME.gltf, NAME.glb, NAME/*.gltf, NAME/*.glb below `root`.
static bool find_below(const char *root, const char *name, char *out, size_t size)
{
    static const char *const endings[] = { "", ".gltf", ".glb" };
    for (int i = 0; i < FG_COUNT(endings); ++i) {
        const int written = snprintf(out, size, "%s/%s%s", root, name, endings[i]);
        if (written > 0 && (size_t) written < size && is_file(out))
            return true;
    }
    char folder[2048];
    const int written = snprintf(folder, sizeof folder, "%s/%s", root, name);
    if (written < 0 || (size_t) written >= sizeof folder)
        return false;
    return first_file(folder, ".gltf", out, size) || first_file(folder, ".glb", out, size);
}

fg_status scenes_open(const fg_log *log, const char *name, ag_scene **out)
{
    *out = NULL;
    if (!name[0]) {
        fg_logf(log, FG_LOG_ERROR, "scene: the name is empty");
        return FG_ERR_INPUT;
    }
    for (int i = 0; scenes_builtin(i); ++i) {
        if (!strcmp(name, scenes_builtin(i)->name))
            return scenes_builtin(i)->build(log, out);
    }
    if (is_file(name))
        return ag_scene_load(log, name, out);
    char path[2304];
    const char *root = getenv("AFTERGLOW_SCENES");
    if (root && root[0] && find_below(root, name, path, sizeof path))
        return ag_scene_load(log, path, out);
    struct stat st;
    if (stat(name, &st) == 0)
        fg_logf(log, FG_LOG_ERROR, "%.200s: %s, must be a .gltf or .glb file", name,
                S_ISDIR(st.st_mode) ? "is a folder" : "is no regular file");
    else if (root && root[0])
        fg_logf(log, FG_LOG_ERROR,
                "%.200s: no such scene: no built-in one, no file, no .gltf or .glb below "
                "AFTERGLOW_SCENES (%.300s)",
                name, root);
    else
        fg_logf(log, FG_LOG_ERROR,
                "%.200s: no such scene: no built-in one, no file, and AFTERGLOW_SCENES is not set",
                name);
    return FG_ERR_INPUT;
}
