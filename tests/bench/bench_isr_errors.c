// SPDX-License-Identifier: MIT
// How far off the eye hierarchy is from a gather of the same VPLs at every pixel, and hisr from a
// gather of all texels of the map at every pixel; and what the latter saves.
#include "bench_isr.h"

// ---- isr -------------------------------------------------------------------------------------

typedef struct variant {
    const char *values;
    const char *rms, *max, *lit; // figures; `lit` NULL: printed with the times
} variant;

static const variant variants[] = {
    { "source=regular vpls=256", "isr.eye_rmse_rms", "isr.eye_rmse_max", NULL },
    { "source=regular vpls=256 share=0", "isr.eye_rmse_rms_unshared", "isr.eye_rmse_max_unshared",
      "isr.lit_percent_unshared" },
};

static fg_status take_picture(const bench *b, side *s, image *out)
{
    // A counter is of a frame before.
    fg_status status = FG_OK;
    for (int i = 0; i < 3 && status == FG_OK; i++)
        status = side_frame(b, s, 0);
    return status == FG_OK ? side_picture(s, out) : status;
}

static fg_status run_variant(const bench *b, const variant *v, const image *reference)
{
    side isr = { .plugin = "isr", .values = v->values, .picture = true };
    image picture = { 0 };
    metrics m;
    fg_status status = side_open(b, &isr, b->size);
    if (status == FG_OK)
        status = take_picture(b, &isr, &picture);
    if (status == FG_OK)
        status = metrics_compare(&b->log, &picture, reference, &m);
    if (status == FG_OK) {
        const double pixels = (double) b->size[0] * b->size[1];
        bench_print(b, v->rms, b->size, 100 * m.rmse_rms, "%");
        bench_print(b, v->max, b->size, 100 * m.rmse_max, "%");
        if (v->lit)
            bench_print(b, v->lit, b->size, 100 * side_counter(&isr, "samples") / pixels, "%");
    }
    image_finish(&picture);
    side_close(&isr);
    return status;
}

static bool wants_variant(const bench *b, const variant *v)
{
    return bench_wants(b, v->rms) || bench_wants(b, v->max) || (v->lit && bench_wants(b, v->lit));
}

fg_status bench_errors(const bench *b)
{
    side rsm = { .plugin = "rsm", .values = "vpls=256", .picture = true };
    image reference = { 0 };
    if (!wants_variant(b, &variants[0]) && !wants_variant(b, &variants[1]))
        return FG_OK;
    fg_status status = side_open(b, &rsm, b->size);
    if (status == FG_OK)
        status = side_frame(b, &rsm, 0);
    if (status == FG_OK)
        status = side_picture(&rsm, &reference);
    side_close(&rsm);
    for (int i = 0; i < FG_COUNT(variants) && status == FG_OK; i++)
        if (wants_variant(b, &variants[i]))
            status = run_variant(b, &variants[i], &reference);
    image_finish(&reference);
    return status == FG_ERR_UNSUPPORTED ? FG_OK : status;
}

// ---- hisr ------------------------------------------------------------------------------------

static const char *const hisr_figures[] = { "hisr.rmse_rms", "hisr.rmse_max", "hisr.speedup",
                                            "hisr.gather_speedup", NULL };

static bool step_is_not_map(const char *step)
{
    return !step_is_map(step);
}

// The full gather takes minutes where there is no GPU and so runs once, after one of few VPLs by
// the same program.
static fg_status run_full_gather(const bench *b, side *rsm, image *out)
{
    fg_status status = side_open(b, rsm, b->size);
    if (status == FG_OK)
        status = side_frame(b, rsm, 0);
    side_forget(rsm);
    if (status == FG_OK)
        status = side_set(b, rsm, "pattern=all rsm_size=256");
    if (status == FG_OK)
        status = side_frame(b, rsm, 0);
    return status == FG_OK ? side_picture(rsm, out) : status;
}

static fg_status run_hisr(const bench *b, side *hisr, image *out)
{
    enum { WARM = 2, FRAMES = 5 };
    fg_status status = FG_OK;
    for (int i = 0; i < WARM + FRAMES && status == FG_OK; i++) {
        if (i == WARM)
            side_forget(hisr);
        status = side_frame(b, hisr, 0);
    }
    return status == FG_OK ? side_picture(hisr, out) : status;
}

fg_status bench_hisr(const bench *b)
{
    side rsm = { .plugin = "rsm", .values = "vpls=16", .picture = true };
    side hisr = { .plugin = "hisr", .values = "rsm_size=256", .picture = true };
    image picture = { 0 }, reference = { 0 };
    metrics m;
    if (!bench_wants_any(b, hisr_figures))
        return FG_OK;
    fg_status status = side_open(b, &hisr, b->size);
    if (status == FG_OK)
        status = run_hisr(b, &hisr, &picture);
    if (status == FG_OK)
        status = run_full_gather(b, &rsm, &reference);
    if (status == FG_OK)
        status = metrics_compare(&b->log, &picture, &reference, &m);
    if (status == FG_OK) {
        const double full = side_sum(&rsm, step_is_gather);
        side_list(b, &hisr);
        side_list(b, &rsm);
        bench_print(b, "hisr.rmse_rms", b->size, 100 * m.rmse_rms, "%");
        bench_print(b, "hisr.rmse_max", b->size, 100 * m.rmse_max, "%");
        bench_print(b, "hisr.speedup", b->size, full / side_sum(&hisr, step_is_not_map), "x");
        bench_print(b, "hisr.gather_speedup", b->size, full / side_sum(&hisr, step_is_gather), "x");
    }
    image_finish(&picture);
    image_finish(&reference);
    side_close(&hisr);
    side_close(&rsm);
    return status == FG_ERR_UNSUPPORTED ? FG_OK : status;
}
