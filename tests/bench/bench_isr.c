// SPDX-License-Identifier: MIT
// Image-space radiosity in figures: what it costs against what it replaces, how far off it is, how
// it flickers. Both sides of a ratio run in turn, warmed up; a ratio is one of medians.
//
//     bench_isr [--size N] [--scene NAME] [--least] [--verbose] [FIGURE]...
//
// --size: pixels along an edge (1024). --scene: cornell, atrium or sponza (all that are there;
// Sponza is found below AFTERGLOW_SCENES). --verbose: medians of all passes on stderr. FIGURE: the
// figures that begin so alone, e.g. isr.fixed_over_copy, or hisr.
//
// Sponza has no light: a spot of 25 to 35 degrees hangs 10 m above its court, 600 W/sr.
#include "bench_isr.h"

#include "scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void print(void *user, fg_log_level level, const char *msg)
{
    (void) user, (void) level;
    fprintf(stderr, "bench_isr: %s\n", msg);
}

// ---- scenes ----------------------------------------------------------------------------------

static const char *const scene_names[] = { "cornell", "atrium", "sponza", NULL };

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
    b->camera = ag_default_camera();
    const double world[16] = { 0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, -9.5, 2, 0.4, 1 };
    memcpy(b->camera.world, world, sizeof world);
    b->camera.yfov = 1.1f;
    b->has_camera = true;
    return ag_scene_add_light(b->scene, &spot);
}

static fg_status open_scene(bench *b, const char *name)
{
    const bool sponza = !strcmp(name, "sponza");
    ag_scene_destroy(b->scene);
    b->scene = NULL;
    b->scene_name = name;
    b->has_camera = false;
    fg_status status =
        scenes_open(&b->log, sponza ? "sponza-dabrovic/sponza.gltf" : name, &b->scene);
    if (status == FG_OK && sponza)
        status = furnish_sponza(b);
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

void bench_print(const bench *b, const char *figure, int size, double value, const char *unit)
{
    if (!bench_wants(b, figure))
        return;
    if (!isfinite(value)) {
        fprintf(stderr, "bench_isr: %s: %s could not be measured\n", b->scene_name, figure);
        return;
    }
    printf("BENCH %s %s %dx%d %.4g %s\n", figure, b->scene_name, size, size, value, unit);
    fflush(stdout);
}

static fg_status run_scene(const bench *b)
{
    static fg_status (*const parts[])(const bench *) = {
        bench_times, bench_pairs, bench_errors, bench_hisr, bench_flicker,
    };
    fg_status status = FG_OK;
    for (int i = 0; i < FG_COUNT(parts) && status == FG_OK; i++)
        status = parts[i](b);
    return status;
}

// ---- the command -----------------------------------------------------------------------------

static int usage(void)
{
    fprintf(stderr,
            "usage: bench_isr [--size N] [--scene NAME] [--least] [--verbose] [FIGURE]...\n");
    return 2;
}

static bool parse(bench *b, int argc, char **argv, const char **scene)
{
    b->size = 1024;
    for (int i = 1; i < argc; i++) {
        const bool more = i + 1 < argc;
        if (!strcmp(argv[i], "--verbose"))
            b->verbose = true;
        else if (!strcmp(argv[i], "--least"))
            samples_take_least();
        else if (!strcmp(argv[i], "--size") && more)
            b->size = atoi(argv[++i]);
        else if (!strcmp(argv[i], "--scene") && more)
            *scene = argv[++i];
        else if (argv[i][0] == '-' || b->name_count == MAX_NAMES)
            return false;
        else
            b->names[b->name_count++] = argv[i];
    }
    for (int i = 0; *scene && scene_names[i]; i++)
        if (!strcmp(*scene, scene_names[i]))
            return b->size > 0;
    return !*scene && b->size > 0;
}

static fg_status create(bench *b)
{
    static const char *const dirs[] = { BENCH_PLUGIN_DIR, NULL };
    b->log = (fg_log){ .fn = print, .level = FG_LOG_WARN };
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

int main(int argc, char **argv)
{
    bench b = { 0 };
    const char *scene = NULL;
    if (!parse(&b, argc, argv, &scene))
        return usage();
    fg_status status = create(&b);
    for (int i = 0; scene_names[i] && status == FG_OK; i++) {
        if (scene && strcmp(scene, scene_names[i]) != 0)
            continue;
        if (!scene && !strcmp(scene_names[i], "sponza") && !getenv("AFTERGLOW_SCENES"))
            continue;
        status = open_scene(&b, scene_names[i]);
        if (status == FG_ERR_INPUT) { // not there
            status = FG_OK;
            continue;
        }
        if (status == FG_OK)
            status = run_scene(&b);
    }
    if (status != FG_OK)
        fprintf(stderr, "bench_isr: %s\n", fg_status_name(status));
    destroy(&b);
    return status == FG_OK ? 0 : 1;
}
