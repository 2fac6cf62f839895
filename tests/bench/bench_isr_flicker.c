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
    image pictures[SIDES][2]; // before, now
    changes changes[SIDES];
    motion motion;
} path;

static bool wants_side(const bench *b, int k)
{
    if (!figures[k][0])
        return true;
    return bench_wants(b, figures[k][0]) || bench_wants(b, figures[k][1]) ||
           ((k == HISR || k == RSM_4096) && bench_wants(b, over_4096));
}

static fg_status open_all(const bench *b, path *p, const int size[2])
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
        status = side_open(b, &p->sides[k], size);
        p->there[k] = status == FG_OK;
        if (status == FG_ERR_UNSUPPORTED)
            status = FG_OK;
    }
    return status;
}

static fg_status run_frame(const bench *b, path *p, int frame)
{
    fg_status status = motion_line(&p->motion, frame, frame - 0.5 * (FRAMES - 1));
    for (int k = 0; k < SIDES && status == FG_OK; k++) {
        image *pictures = p->pictures[k];
        if (!p->there[k])
            continue;
        image_finish(&pictures[0]);
        pictures[0] = pictures[1];
        pictures[1] = (image){ 0 };
        status = side_frame(b, &p->sides[k], b->scene->time);
        if (status == FG_OK)
            status = side_picture(&p->sides[k], &pictures[1]);
    }
    for (int k = 0; k < SIDES && frame && status == FG_OK; k++)
        if (p->there[k])
            changes_add(&p->changes[k], p->pictures[k], p->pictures[FULL]);
    return status;
}

static void print_all(const bench *b, const path *p, const int size[2])
{
    const changes *c = p->changes;
    const double base = c[RSM_256].excess, moved = c[FULL].change;
    for (int k = 0; k < SIDES; k++) {
        if (b->verbose && p->there[k])
            fprintf(stderr, "%s: %s %s: change %.4g, of the full gather %.4g; in excess %.4g\n",
                    b->scene_name, p->sides[k].plugin, p->sides[k].values,
                    c[k].change / (FRAMES - 1), moved / (FRAMES - 1), c[k].excess / (FRAMES - 1));
        if (!p->there[k] || !figures[k][0])
            continue;
        bench_print(b, figures[k][0], size, c[k].excess / base, "x");
        bench_print(b, figures[k][1], size, (c[k].change - moved) / (c[RSM_256].change - moved),
                    "x");
    }
    if (p->there[HISR] && p->there[RSM_4096])
        bench_print(b, over_4096, size, c[HISR].excess / c[RSM_4096].excess, "x");
}

fg_status bench_flicker(const bench *b)
{
    static path p;
    int size[2];
    if (!wants_side(b, RSM_4096) && !wants_side(b, ISR) && !wants_side(b, HISR))
        return FG_OK;
    bench_fit(b, EDGE, size);
    p = (path){ .motion = motion_begin(b) };
    fg_status status = open_all(b, &p, size);
    for (int i = 0; i < FRAMES && status == FG_OK; i++)
        status = run_frame(b, &p, i);
    if (status == FG_OK)
        print_all(b, &p, size);
    for (int k = 0; k < SIDES; k++) {
        side_close(&p.sides[k]);
        image_finish(&p.pictures[k][0]);
        image_finish(&p.pictures[k][1]);
    }
    const fg_status ended = motion_end(&p.motion);
    return status == FG_OK ? ended : status;
}
