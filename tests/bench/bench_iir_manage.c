// SPDX-License-Identifier: MIT
// VPL management in figures, without a GPU: what a step costs, how it grows, whether it stutters,
// and what the paper's tetrahedralization would cost.
//
//     bench_iir_manage [--scene NAME] [--verbose]
//
// --scene: cornell or atrium (both). --verbose: what the figures are made of, on stderr.
//
// A light goes round in the scene's middle half, 1/500 of the scene's diagonal a frame, where the
// number of VPLs counts 1/2000, so that all of 4096 are kept; 4 to 8 of them are remade in each, as
// in the paper. Times are of the step's thread by its CPU clock, so that what else runs on the
// machine counts for little; sizes are in VPLs.
#include "manage.h"
#include "scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 1000, WARM = 20 };

typedef struct bench {
    fg_log log;
    ag_scene *scene;
    const char *name;
    bool verbose;
} bench;

typedef struct side {
    const char *label;
    ag_light_kind kind;
    int size;
    double shift; // of the light, diagonals of the scene a frame
    iir_triangulation triangulation;
    iir_manager *manager;
    double ms[FRAMES], ray_ms[FRAMES], own_ms[FRAMES];
    int count;
    double rays, fresh;
} side;

static void print(void *user, fg_log_level level, const char *msg)
{
    (void) user, (void) level;
    fprintf(stderr, "bench_iir_manage: %s\n", msg);
}

static void figure(const bench *b, const char *name, int size, double value, const char *unit)
{
    printf("BENCH %s %s %d %.4g %s\n", name, b->name, size, value, unit);
    fflush(stdout);
}

// ---- times ------------------------------------------------------------------------------------

static int rising(const void *a, const void *b)
{
    const double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

static double quantile(const double *values, int count, double part)
{
    static double sorted[FRAMES];
    memcpy(sorted, values, (size_t) count * sizeof *sorted);
    qsort(sorted, (size_t) count, sizeof *sorted, rising);
    return sorted[(int) (part * (count - 1))];
}

// ---- a side: a manager at its settings --------------------------------------------------------

// `way`: since frame 0, diagonals of the scene.
static ag_light light_at(const bench *b, ag_light_kind kind, double way)
{
    const ag_scene *s = b->scene;
    double half[3], diagonal = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        half[k] = 0.5 * (s->box_max[k] - s->box_min[k]);
        diagonal += 4 * half[k] * half[k];
    }
    const double t = way * sqrt(diagonal) / (0.5 * fmax(half[0], half[2]));
    const double round[3] = { 0.5 * cos(t), 0.25 * sin(0.7 * t), 0.5 * sin(t) };
    const double down[3] = { 0.2 * cos(1.3 * t), -1, 0.2 * sin(1.1 * t) };
    ag_light light = ag_default_light();
    light.kind = kind;
    light.cosine = kind == AG_LIGHT_SPOT;
    for (int k = 0; k < 3; k++) {
        light.position[k] = s->box_min[k] + half[k] * (1 + round[k]);
        length += down[k] * down[k];
    }
    for (int k = 0; k < 3; k++)
        light.direction[k] = (float) (down[k] / sqrt(length));
    return light;
}

static fg_status side_open(const bench *b, side *s)
{
    const iir_manager_desc desc = { .log = &b->log,
                                    .scene = b->scene,
                                    .max_lights = s->size,
                                    .blur = 16,
                                    .triangulation = s->triangulation };
    s->count = 0;
    s->rays = s->fresh = 0;
    return iir_manager_create(&desc, &s->manager);
}

static fg_status side_frame(const bench *b, side *s, int frame)
{
    const ag_light light = light_at(b, s->kind, s->shift * frame);
    const iir_lights lights = { .lights = &light, .count = 1 };
    const iir_budget budget = { .max_lights = s->size,
                                .recalc_min = 4,
                                .rim = 0.35,
                                .recalc_max = 8,
                                .fill_first = true,
                                .settle = true,
                                .tiles = 4 };
    const iir_result *r;
    const fg_status status = iir_manager_step(s->manager, &lights, &budget, &r);
    if (status != FG_OK || frame < WARM)
        return status;
    s->ms[s->count] = r->ms;
    s->ray_ms[s->count] = r->ray_ms;
    s->own_ms[s->count++] = r->ms - r->ray_ms;
    s->rays += r->rays;
    s->fresh += r->fresh;
    return FG_OK;
}

static void side_close(const bench *b, side *s)
{
    iir_manager_destroy(s->manager);
    s->manager = NULL;
    if (!b->verbose || s->count == 0)
        return;
    fprintf(stderr, "%-8s %-6s %4d: median %.3f ms, of that rays %.3f; p99 %.3f, most %.3f; ",
            b->name, s->label, s->size, quantile(s->ms, s->count, 0.5),
            quantile(s->ray_ms, s->count, 0.5), quantile(s->ms, s->count, 0.99),
            quantile(s->ms, s->count, 1));
    fprintf(stderr, "%.1f rays, %.2f fresh a frame\n", s->rays / s->count, s->fresh / s->count);
}

// Runs sides in turn, frame by frame.
static fg_status run(const bench *b, side *sides, int count, int frames)
{
    fg_status status = FG_OK;
    for (int i = 0; i < count && status == FG_OK; i++)
        status = side_open(b, &sides[i]);
    for (int f = 0; f < WARM + frames && status == FG_OK; f++)
        for (int i = 0; i < count && status == FG_OK; i++)
            status = side_frame(b, &sides[i], f);
    for (int i = 0; i < count; i++)
        side_close(b, &sides[i]);
    return status;
}

static double median(const side *s)
{
    return quantile(s->ms, s->count, 0.5);
}

// ---- figures ----------------------------------------------------------------------------------

static void choose(side *s, const char *label, ag_light_kind kind, int size)
{
    *s = (side){ .label = label, .kind = kind, .size = size, .shift = 0.002 };
}

static fg_status bench_ms(const bench *b, side *pair)
{
    choose(&pair[0], "spot", AG_LIGHT_SPOT, 256);
    choose(&pair[1], "point", AG_LIGHT_POINT, 256);
    const fg_status status = run(b, pair, 2, 500);
    if (status != FG_OK)
        return status;
    figure(b, "iir.manage_ms_spot", 256, quantile(pair[0].own_ms, pair[0].count, 0.5), "ms");
    figure(b, "iir.manage_ms_point", 256, quantile(pair[1].own_ms, pair[1].count, 0.5), "ms");
    return FG_OK;
}

static fg_status stutter(const bench *b, side *s, const char *name)
{
    const fg_status status = run(b, s, 1, FRAMES);
    if (status == FG_OK)
        figure(b, name, s->size, quantile(s->ms, s->count, 0.99) / median(s), "times");
    return status;
}

static fg_status bench_stutter(const bench *b, side *pair)
{
    choose(&pair[0], "spot", AG_LIGHT_SPOT, 1024);
    choose(&pair[1], "point", AG_LIGHT_POINT, 1024);
    const fg_status status = stutter(b, &pair[0], "iir.manage_p99_over_median_spot");
    return status == FG_OK ? stutter(b, &pair[1], "iir.manage_p99_over_median_point") : status;
}

// The second side's time over the first's.
static fg_status ratio(const bench *b, side *pair, const char *name)
{
    const fg_status status = run(b, pair, 2, 200);
    if (status == FG_OK)
        figure(b, name, pair[1].size, median(&pair[1]) / median(&pair[0]), "times");
    return status;
}

static fg_status growth(const bench *b, side *pair, const char *label, ag_light_kind kind,
                        const char *name)
{
    choose(&pair[0], label, kind, 256);
    choose(&pair[1], label, kind, 4096);
    pair[0].shift = pair[1].shift = 0.0005;
    return ratio(b, pair, name);
}

static fg_status bench_growth(const bench *b, side *pair)
{
    const fg_status status = growth(b, pair, "spot", AG_LIGHT_SPOT, "iir.manage_growth_spot");
    return status == FG_OK ? growth(b, pair, "point", AG_LIGHT_POINT, "iir.manage_growth_point")
                           : status;
}

static fg_status bench_tetra(const bench *b, side *pair)
{
    static const char *const names[] = { "iir.tetra_over_sphere_256",
                                         "iir.tetra_over_sphere_1024" };
    const int sizes[] = { 256, 1024 };
    fg_status status = FG_OK;
    for (int i = 0; i < 2 && status == FG_OK; i++) {
        choose(&pair[0], "sphere", AG_LIGHT_POINT, sizes[i]);
        choose(&pair[1], "tetra", AG_LIGHT_POINT, sizes[i]);
        pair[1].triangulation = IIR_TRIANGULATION_TETRA;
        status = ratio(b, pair, names[i]);
    }
    return status;
}

int main(int argc, char **argv)
{
    static side pair[2];
    static fg_status (*const parts[])(const bench *, side *) = { bench_ms, bench_stutter,
                                                                 bench_growth, bench_tetra };
    static const char *const scenes[] = { "cornell", "atrium", NULL };
    const char *wanted = NULL;
    bench b = { .log = { .fn = print, .level = FG_LOG_WARN } };
    for (int i = 1; i < argc; i++) {
        if (!strcmp(argv[i], "--verbose")) {
            b.verbose = true;
        } else if (!strcmp(argv[i], "--scene") && i + 1 < argc) {
            wanted = argv[++i];
        } else {
            fprintf(stderr, "usage: bench_iir_manage [--scene NAME] [--verbose]\n");
            return 2;
        }
    }
    fg_status status = FG_OK;
    for (int i = 0; scenes[i] && status == FG_OK; i++) {
        b.name = scenes[i];
        if (wanted && strcmp(wanted, b.name) != 0)
            continue;
        status = scenes_open(&b.log, b.name, &b.scene);
        for (int k = 0; k < FG_COUNT(parts) && status == FG_OK; k++)
            status = parts[k](&b, pair);
        ag_scene_destroy(b.scene);
        b.scene = NULL;
    }
    return status == FG_OK ? 0 : 1;
}
