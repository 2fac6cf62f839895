// SPDX-License-Identifier: MIT
// How a technique flickers while a light moves. A frame's change has a part that it should have and
// that the full gather of all texels of the map shows, too; what exceeds it is flicker:
//
//     flicker = mean |dI_t - dR_t|,  dI_t = I_t - I_(t-1), R the full gather
//
// over that of rsm with 256 VPLs. The plain figures are mean |dI_t| - mean |dR_t| over the same of
// rsm instead; there a change in the wrong place makes up for one that is missing.
//
// Atrium moves by itself, 26 mm a frame at 30 frames a second; in the others the light goes along
// x.
#include "bench_isr.h"

#include <math.h>
#include <string.h>

// The full gather of the path is long: at most so many pixels along an edge.
enum { EDGE = 192, FRAMES = 10 };
enum { FULL, RSM_256, RSM_4096, ISR, HISR, SIDES };

static const char *const figures[SIDES][2] = {
    [RSM_4096] = { "rsm_4096.flicker", "rsm_4096.flicker_plain" },
    [ISR] = { "isr.flicker", "isr.flicker_plain" },
    [HISR] = { "hisr.flicker", "hisr.flicker_plain" },
};
static const char over_4096[] = "hisr.flicker_over_rsm_4096";

typedef struct path {
    side sides[SIDES];
    bool there[SIDES];
    image now[SIDES], before[SIDES];
    double excess[SIDES], change[SIDES]; // sums over the frames of means over the pixels
    ag_scene scene;                      // shallow copy, where the light is moved here
    ag_light light;
    double start;
} path;

static double step_of(const bench *b)
{
    return !strcmp(b->scene_name, "cornell") ? 0.005 : 0.026; // m a frame
}

static bool moves_itself(const bench *b)
{
    return (b->scene->features & AG_FEATURE_MOVING_LIGHT) != 0;
}

static double pose(const bench *b, path *p, int frame)
{
    if (moves_itself(b))
        return frame / 30.0;
    p->light.position[0] = p->start + step_of(b) * (frame - 0.5 * (FRAMES - 1));
    p->scene.light_revision++;
    return 0;
}

static bool wants_side(const bench *b, int k)
{
    if (!figures[k][0])
        return true;
    return bench_wants(b, figures[k][0]) || bench_wants(b, figures[k][1]) ||
           ((k == HISR || k == RSM_4096) && bench_wants(b, over_4096));
}

static fg_status open_all(const bench *b, path *p, int size)
{
    static const char *const settings[SIDES][2] = {
        [FULL] = { "rsm", "pattern=all rsm_size=256" },
        [RSM_256] = { "rsm", "vpls=256" },
        [RSM_4096] = { "rsm", "vpls=4096" },
        [ISR] = { "isr", "" },
        [HISR] = { "hisr", "" },
    };
    fg_status status = FG_OK;
    for (int k = 0; k < SIDES && status == FG_OK; k++) {
        p->sides[k] = (side){ .plugin = settings[k][0], .values = settings[k][1], .picture = true };
        if (!wants_side(b, k))
            continue;
        status = side_open(b, &p->sides[k], moves_itself(b) ? b->scene : &p->scene, size);
        p->there[k] = status == FG_OK;
        if (status == FG_ERR_UNSUPPORTED)
            status = FG_OK;
    }
    return status;
}

static void add_changes(path *p, int k)
{
    const size_t count = 3 * (size_t) p->now[k].width * (size_t) p->now[k].height;
    double excess = 0, change = 0;
    for (size_t i = 0; i < count; i++) {
        const double own = (double) p->now[k].rgb[i] - (double) p->before[k].rgb[i];
        const double full = (double) p->now[FULL].rgb[i] - (double) p->before[FULL].rgb[i];
        excess += fabs(own - full);
        change += fabs(own);
    }
    p->excess[k] += excess / (double) count;
    p->change[k] += change / (double) count;
}

static fg_status run_frame(const bench *b, path *p, int frame)
{
    const double time = pose(b, p, frame);
    fg_status status = FG_OK;
    for (int k = 0; k < SIDES && status == FG_OK; k++) {
        if (!p->there[k])
            continue;
        image_finish(&p->before[k]);
        p->before[k] = p->now[k];
        p->now[k] = (image){ 0 };
        status = side_frame(b, &p->sides[k], time);
        if (status == FG_OK)
            status = side_picture(&p->sides[k], &p->now[k]);
    }
    for (int k = 0; k < SIDES && frame && status == FG_OK; k++)
        if (p->there[k])
            add_changes(p, k);
    return status;
}

static void print_all(const bench *b, const path *p, int size)
{
    const double base = p->excess[RSM_256], moved = p->change[FULL];
    for (int k = 0; k < SIDES; k++) {
        if (b->verbose && p->there[k])
            fprintf(stderr, "%s: %s %s: change %.4g, of the full gather %.4g; in excess %.4g\n",
                    b->scene_name, p->sides[k].plugin, p->sides[k].values,
                    p->change[k] / (FRAMES - 1), moved / (FRAMES - 1), p->excess[k] / (FRAMES - 1));
        if (!p->there[k] || !figures[k][0])
            continue;
        bench_print(b, figures[k][0], size, p->excess[k] / base, "x");
        bench_print(b, figures[k][1], size, (p->change[k] - moved) / (p->change[RSM_256] - moved),
                    "x");
    }
    if (p->there[HISR] && p->there[RSM_4096])
        bench_print(b, over_4096, size, p->excess[HISR] / p->excess[RSM_4096], "x");
}

fg_status bench_flicker(const bench *b)
{
    static path p;
    const int size = b->size < EDGE ? b->size : EDGE;
    if (!wants_side(b, RSM_4096) && !wants_side(b, ISR) && !wants_side(b, HISR))
        return FG_OK;
    p = (path){ .scene = *b->scene, .light = b->scene->lights[0] };
    p.scene.lights = &p.light;
    p.scene.light_count = 1;
    p.start = p.light.position[0];
    fg_status status = open_all(b, &p, size);
    for (int i = 0; i < FRAMES && status == FG_OK; i++)
        status = run_frame(b, &p, i);
    if (status == FG_OK)
        print_all(b, &p, size);
    for (int k = 0; k < SIDES; k++) {
        side_close(&p.sides[k]);
        image_finish(&p.now[k]);
        image_finish(&p.before[k]);
    }
    ag_scene_set_time(b->scene, 0);
    return status;
}
