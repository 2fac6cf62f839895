// SPDX-License-Identifier: MIT
// What isr costs, against splatting and against gathering at every pixel.
#include "bench_isr.h"

#include <math.h>
#include <string.h>

// isr by the pattern, so that its VPLs are those of the others; and as it is by default.
enum { ISR, ISR_DEFAULT, RSM, SPLAT, SIDES };
enum { WARM = 2, LEAST = 5, MOST = 15 };
static const double patience_ms = 15e3; // after that, LEAST frames have to do

static const char over_gather[] = "isr.splat_over_gather";
static const char over_frame[] = "isr.splat_over_isr_frame";
static const char over_passes[] = "isr.splat_over_isr_passes"; // those of the techniques alone
static const char rsm_over_gather[] = "isr.rsm_over_isr_gather";
static const char over_texels[] = "isr.rsm_over_isr_gather_a_texel";
static const char pixels_over_texels[] = "isr.pixels_over_texels";
static const char fixed[] = "isr.fixed_over_copy";
static const char fixed_image[] = "isr.fixed_without_vpls_over_copy";
static const char fixed_default[] = "isr.fixed_over_copy_default";
static const char lit[] = "isr.lit_percent";
static const char *const all_figures[] = { over_gather,   over_frame,
                                           over_passes,   rsm_over_gather,
                                           over_texels,   pixels_over_texels,
                                           fixed,         fixed_image,
                                           fixed_default, lit,
                                           NULL };

typedef struct times {
    side sides[SIDES];
    bool there[SIDES];
    copy copy;
} times;

static bool step_is_of_image(const char *step)
{
    static const char *const of_vpls[] = {
        "build", "pack", "light", "sum", "choose", "count_vpls"
    };
    for (int i = 0; i < FG_COUNT(of_vpls); i++)
        if (!strncmp(step, of_vpls[i], strlen(of_vpls[i])))
            return false;
    return step_is_fixed(step);
}

static bool step_is_splat(const char *step)
{
    return !strncmp(step, "splat", 5);
}

static bool step_is_any(const char *step)
{
    (void) step;
    return true;
}

static bool is_needed(const bench *b, int k)
{
    switch (k) {
    case ISR_DEFAULT: return bench_wants(b, fixed_default);
    case RSM: return bench_wants(b, rsm_over_gather) || bench_wants(b, over_texels);
    case SPLAT:
        return bench_wants(b, over_gather) || bench_wants(b, over_frame) ||
               bench_wants(b, over_passes);
    default: return true;
    }
}

static fg_status open_all(const bench *b, times *t)
{
    static const char *const settings[SIDES][2] = {
        [ISR] = { "isr", "source=regular vpls=256" },
        [ISR_DEFAULT] = { "isr", "" },
        [RSM] = { "rsm", "vpls=256" },
        [SPLAT] = { "splat", "vpls=256" },
    };
    fg_status status = copy_open(b, &t->copy);
    for (int k = 0; k < SIDES && status == FG_OK; k++) {
        t->sides[k] = (side){ .plugin = settings[k][0], .values = settings[k][1] };
        if (!is_needed(b, k))
            continue;
        status = side_open(b, &t->sides[k], b->size);
        t->there[k] = status == FG_OK;
        if (status == FG_ERR_UNSUPPORTED)
            status = FG_OK;
    }
    return status;
}

static fg_status run_turn(const bench *b, times *t)
{
    fg_status status = copy_frame(b, &t->copy);
    for (int k = 0; k < SIDES && status == FG_OK; k++)
        if (t->there[k])
            status = side_frame(b, &t->sides[k], 0);
    return status;
}

static fg_status run_turns(const bench *b, times *t)
{
    fg_status status = FG_OK;
    for (int i = 0; i < WARM && status == FG_OK; i++)
        status = run_turn(b, t);
    for (int k = 0; k < SIDES; k++)
        side_forget(&t->sides[k]);
    t->copy.ms[0].count = t->copy.ms[1].count = 0;
    const double start = bench_now_ms();
    for (int i = 0; i < MOST && status == FG_OK; i++)
        if (i < LEAST || bench_now_ms() - start < patience_ms)
            status = run_turn(b, t);
    return status;
}

static void print_ratios(const bench *b, times *t)
{
    const side *isr = &t->sides[ISR], *rsm = &t->sides[RSM], *splat = &t->sides[SPLAT];
    const double gather = side_sum(isr, step_is_gather);
    const double pixels = (double) b->size[0] * b->size[1];
    const double texels = side_counter(&t->sides[ISR], "samples");
    if (t->there[SPLAT]) {
        bench_print(b, over_gather, b->size, side_sum(splat, step_is_splat) / gather, "x");
        bench_print(b, over_frame, b->size,
                    samples_typical(&splat->frame) / samples_typical(&isr->frame), "x");
        bench_print(b, over_passes, b->size,
                    side_sum(splat, step_is_any) / side_sum(isr, step_is_any), "x");
    }
    if (t->there[RSM]) {
        const double ratio = side_sum(rsm, step_is_gather) / gather;
        bench_print(b, rsm_over_gather, b->size, ratio, "x");
        bench_print(b, pixels_over_texels, b->size, pixels / texels, "x");
        bench_print(b, over_texels, b->size, ratio * texels / pixels, "x");
    }
    bench_print(b, lit, b->size, 100 * texels / pixels, "%");
}

static void print_fixed(const bench *b, const times *t)
{
    const double compute = samples_typical(&t->copy.ms[0]),
                 raster = samples_typical(&t->copy.ms[1]);
    const double unit = fmin(compute, raster);
    if (b->verbose)
        fprintf(stderr, "%s: copy of the screen: %.3f ms by compute, %.3f ms by raster\n",
                b->scene_name, compute, raster);
    bench_print(b, fixed, b->size, side_sum(&t->sides[ISR], step_is_fixed) / unit, "x");
    bench_print(b, fixed_image, b->size, side_sum(&t->sides[ISR], step_is_of_image) / unit, "x");
    if (t->there[ISR_DEFAULT])
        bench_print(b, fixed_default, b->size,
                    side_sum(&t->sides[ISR_DEFAULT], step_is_fixed) / unit, "x");
}

fg_status bench_times(const bench *b)
{
    static times t;
    t = (times){ .copy = { 0 } };
    if (!bench_wants_any(b, all_figures))
        return FG_OK;
    fg_status status = open_all(b, &t);
    if (status == FG_OK)
        status = run_turns(b, &t);
    for (int k = 0; k < SIDES && status == FG_OK; k++)
        if (t.there[k])
            side_list(b, &t.sides[k]);
    if (status == FG_OK && t.there[ISR]) {
        print_ratios(b, &t);
        print_fixed(b, &t);
    }
    for (int k = 0; k < SIDES; k++)
        side_close(&t.sides[k]);
    copy_close(&t.copy);
    return status;
}
