// SPDX-License-Identifier: MIT
#include "bench.h"

#include "scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void print(void *user, fg_log_level level, const char *msg)
{
    const bench *b = user;
    (void) level;
    fprintf(stderr, "%s: %s\n", b->program->name, msg);
}

// ---- scenes ----------------------------------------------------------------------------------

// The i-th scene of the program's list; NULL past its end.
static const char *scene_name(const bench_program *program, int i)
{
    static const char *const names[] = { "cornell", "atrium", "sponza", NULL };
    const builtin_scene *const scene = program->builtin ? scenes_builtin(i) : NULL;
    return program->builtin ? scene ? scene->name : NULL : names[i];
}

// Along the court at the height of a tall man's eyes; and the light.
static fg_status furnish_sponza(bench *b)
{
    const ag_light spot = {
        .name = "spot",
        .kind = AG_LIGHT_SPOT,
        .position = { -2, 10, 0 },
        .direction = { 0.33f, -0.94f, 0.1f },
        .intensity = { 600, 560, 480 }, // W/sr
        .cos_inner = 0.9063f,
        .cos_outer = 0.8192f,
    };
    ag_camera camera = ag_default_camera();
    const double world[16] = { 0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, -9.5, 2, 0.4, 1 };
    memcpy(camera.world, world, sizeof world);
    camera.yfov = 1.1f;
    snprintf(camera.name, sizeof camera.name, "court");
    fg_status status = ag_scene_add_camera(b->scene, &camera);
    b->camera = ag_scene_find_camera(b->scene, camera.name);
    if (status == FG_OK)
        status = ag_scene_add_light(b->scene, &spot);
    return status;
}

static fg_status choose_camera(bench *b)
{
    snprintf(b->label, sizeof b->label, "%s", b->scene_name);
    if (!b->wanted_camera)
        return FG_OK;
    b->camera = ag_scene_find_camera(b->scene, b->wanted_camera);
    snprintf(b->label, sizeof b->label, "%s/%s", b->scene_name, b->wanted_camera);
    if (b->camera >= 0)
        return FG_OK;
    fprintf(stderr, "%s: %s has no camera %s\n", b->program->name, b->scene_name, b->wanted_camera);
    return FG_ERR_INPUT;
}

static fg_status open_scene(bench *b, const char *name)
{
    const bool sponza = !strcmp(name, "sponza");
    ag_scene_destroy(b->scene);
    b->scene = NULL;
    b->scene_name = name;
    b->camera = 0;
    fg_status status =
        scenes_open(&b->log, sponza ? "sponza-dabrovic/sponza.gltf" : name, &b->scene);
    if (status == FG_OK && sponza)
        status = furnish_sponza(b);
    return status == FG_OK ? choose_camera(b) : status;
}

static fg_status run_scene(const bench *b)
{
    fg_status status = FG_OK;
    for (int i = 0; b->program->parts[i] && status == FG_OK; i++)
        status = b->program->parts[i](b);
    return status;
}

static fg_status run_scenes(bench *b)
{
    fg_status status = FG_OK;
    const char *name;
    for (int i = 0; (name = scene_name(b->program, i)) && status == FG_OK; i++) {
        if (b->wanted_scene && strcmp(b->wanted_scene, name) != 0)
            continue;
        if (!b->wanted_scene && !strcmp(name, "sponza") && !getenv("AFTERGLOW_SCENES"))
            continue;
        status = open_scene(b, name);
        if (status == FG_OK)
            status = run_scene(b);
        else if (status == FG_ERR_INPUT) // not there
            status = FG_OK;
    }
    return status;
}

// ---- figures ---------------------------------------------------------------------------------

bool bench_wants(const bench *b, const char *figure)
{
    for (int i = 0; i < b->name_count; i++)
        if (!strncmp(figure, b->names[i], strlen(b->names[i])))
            return true;
    return !b->name_count;
}

bool bench_wants_any(const bench *b, const char *const *figures)
{
    for (int i = 0; figures[i]; i++)
        if (bench_wants(b, figures[i]))
            return true;
    return false;
}

void bench_print(const bench *b, const char *figure, const int size[2], double value,
                 const char *unit)
{
    if (!bench_wants(b, figure))
        return;
    if (!isfinite(value)) {
        fprintf(stderr, "%s: %s: %s could not be measured\n", b->program->name, b->label, figure);
        return;
    }
    printf("BENCH %s %s %dx%d %.4g %s\n", figure, b->label, size[0], size[1], value, unit);
    fflush(stdout);
}

void bench_fit(const bench *b, int edge, int size[2])
{
    const int longest = b->size[0] > b->size[1] ? b->size[0] : b->size[1];
    for (int i = 0; i < 2; i++) {
        size[i] = longest > edge ? (b->size[i] * edge + longest / 2) / longest : b->size[i];
        size[i] = size[i] > 1 ? size[i] : 1;
    }
}

// ---- the command -----------------------------------------------------------------------------

static int usage(const bench *b)
{
    fprintf(stderr,
            "usage: %s [--size N|WxH] [--scene NAME] [--least] [--verbose]%s%s [FIGURE]...\n",
            b->program->name, b->program->builtin ? " [--gi NAME]..." : "",
            b->program->subject ? " [--camera NAME] [--set KEY=VALUE]... [--pictures FOLDER]" : "");
    return 2;
}

static bool parse_size(const char *text, int size[2])
{
    char *end;
    const long width = strtol(text, &end, 10);
    const long height = *end == 'x' ? strtol(end + 1, &end, 10) : width;
    if (*end || width < 1 || height < 1 || width > 16384 || height > 16384)
        return false;
    size[0] = (int) width;
    size[1] = (int) height;
    return true;
}

static bool parse_value(bench *b, const char *option, const char *value)
{
    const bool subject = b->program->subject != NULL;
    if (!strcmp(option, "--size"))
        return parse_size(value, b->size);
    if (!strcmp(option, "--scene"))
        b->wanted_scene = value;
    else if (!strcmp(option, "--gi") && b->program->builtin && b->technique_count < MAX_NAMES)
        b->techniques[b->technique_count++] = value;
    else if (!strcmp(option, "--camera") && subject)
        b->wanted_camera = value;
    else if (!strcmp(option, "--pictures") && subject)
        b->pictures = value;
    else if (!strcmp(option, "--set") && subject && b->set_count < MAX_SET)
        b->set[b->set_count++] = value;
    else
        return false;
    return true;
}

static bool parse(bench *b, int argc, char **argv)
{
    memcpy(b->size, b->program->size, sizeof b->size);
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--verbose"))
            b->verbose = true;
        else if (!strcmp(argv[i], "--least"))
            samples_take_least();
        else if (argv[i][0] == '-' && i + 1 < argc && parse_value(b, argv[i], argv[i + 1]))
            i++;
        else if (argv[i][0] != '-' && b->name_count < MAX_NAMES)
            b->names[b->name_count++] = argv[i];
        else
            return false;
    }
    const char *name;
    for (int i = 0; b->wanted_scene && (name = scene_name(b->program, i)); i++)
        if (!strcmp(b->wanted_scene, name))
            return true;
    return !b->wanted_scene;
}

static fg_status create(bench *b)
{
    static const char *const dirs[] = { BENCH_PLUGIN_DIR, NULL };
    b->log = (fg_log){ .fn = print, .user = b, .level = FG_LOG_WARN };
    fg_status status = fg_gl_context_create(&(fg_gl_context_desc){ .log = &b->log }, &b->context);
    if (status == FG_OK)
        status = fg_gl_device_create(&(fg_gl_device_desc){ .log = &b->log }, &b->device);
    if (status == FG_OK)
        status =
            gi_registry_create(&(gi_registry_desc){ .log = &b->log, .dirs = dirs }, &b->registry);
    return status;
}

static void destroy(bench *b)
{
    ag_scene_destroy(b->scene);
    gi_registry_destroy(b->registry);
    fg_device_destroy(b->device);
    fg_gl_context_destroy(b->context);
}

int bench_main(const bench_program *program, int argc, char **argv)
{
    bench b = { .program = program };
    if (!parse(&b, argc, argv))
        return usage(&b);
    fg_status status = create(&b);
    if (status == FG_OK && (!program->subject || side_plugin_exists(&b, program->subject)))
        status = run_scenes(&b);
    if (status != FG_OK)
        fprintf(stderr, "%s: %s\n", program->name, fg_status_name(status));
    destroy(&b);
    return status == FG_OK ? 0 : 1;
}
