// SPDX-License-Identifier: MIT
// VPLs that are kept against VPLs made anew along 300 frames of a moving light: which error they
// have, and how they flicker.
//
// The truth of a frame is the reference renderer's, whose noise is taken out of the errors. Flicker
// is
//
//     mean |dI_t - dT_t|,  dI_t = I_t - I_(t-1), T the truth,
//
// and plain mean |dI_t| - mean |dT_t|, where a change in the wrong place makes up for one that is
// missing. dT_t is the slope of a line through the truths of 2 WINDOW frames about the change, each
// of its own seed: the light goes smoothly, the noise does not. Its noise is that of a frame over
// sqrt(WINDOW (4 WINDOW^2 - 1) / 6) = 18.
//
// Without the frame of delay that both have by default, which would be most of their error; and
// without tiles, which on pictures as small as these would be.
#include "bench_iir.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { KEPT, ANEW, SIDES };
// 300 truths take long: pixels along an edge, samples of a pixel.
enum { EDGE = 80, SPP = 128, FRAMES = 300, FIRST = 10, WINDOW = 8 };

static const char worst[] = "iir.path_error_ratio";
static const char upper[] = "iir.path_error_ratio_p95";
static const char median[] = "iir.path_error_ratio_median";
static const char flicker[] = "iir.flicker_ratio";
static const char plain[] = "iir.flicker_ratio_plain";
static const char *const figures[] = { worst, upper, median, flicker, plain, NULL };

typedef struct path {
    side sides[SIDES];
    motion motion;
    int size[2];
    int every; // of so many frames two are judged: making VPLs anew is slow in large scenes
    image truths[FRAMES], pictures[SIDES][FRAMES];
    double ratio[FRAMES];
    int ratios;
    changes changes[SIDES], due; // `due`: of the truth itself
} path;

static bool is_judged(const path *p, int frame)
{
    return frame >= FIRST - 1 && (frame - FIRST + 1) % p->every < 2;
}

// ---- frames ----------------------------------------------------------------------------------

static void note_errors(const bench *b, path *p, int frame, const double *error, double noise)
{
    const double ratio = error[KEPT] / error[ANEW];
    if (b->verbose)
        fprintf(stderr, "%s: frame %d: kept %.4f, anew %.4f, truth's noise %.4f\n", b->label, frame,
                error[KEPT], error[ANEW], noise);
    side_list_counters(b, &p->sides[KEPT]);
    if (isfinite(ratio))
        p->ratio[p->ratios++] = ratio;
    else
        fprintf(stderr, "%s: %s: frame %d: the error is not above the truth's noise\n",
                b->program->name, b->label, frame);
}

static fg_status judge(const bench *b, path *p, int frame, const truth *t)
{
    double error[SIDES];
    fg_status status = FG_OK;
    for (int k = 0; k < SIDES && status == FG_OK; k++) {
        image *picture = &p->pictures[k][frame];
        truth_error e = { .rmse_rms = (double) NAN };
        status = side_picture(&p->sides[k], picture);
        if (status == FG_OK)
            status = truth_compare(b, t, picture, &e);
        error[k] = e.rmse_rms;
    }
    if (status == FG_OK && frame >= FIRST)
        note_errors(b, p, frame, error, t->noise / t->rms);
    return status;
}

static fg_status run_frame(const bench *b, path *p, int frame)
{
    truth t;
    const truth_desc desc = { { p->size[0], p->size[1] }, SPP, (uint64_t) frame, false };
    const bool judged = is_judged(p, frame);
    fg_status status = motion_round(&p->motion, frame);
    if (status == FG_OK)
        status = side_frame(b, &p->sides[KEPT], b->scene->time);
    if (status == FG_OK && judged)
        status = side_frame(b, &p->sides[ANEW], b->scene->time);
    if (status == FG_OK)
        status = truth_render(b, &desc, &t);
    if (status != FG_OK)
        return status;
    p->truths[frame] = t.picture;
    return judged ? judge(b, p, frame, &t) : FG_OK;
}

// ---- changes ---------------------------------------------------------------------------------

// The truth's change from the frame before to this one.
static fg_status fit_slope(const bench *b, const path *p, int frame, image *out)
{
    const double squares = WINDOW * (4.0 * WINDOW * WINDOW - 1) / 6;
    const size_t count = 3 * (size_t) p->size[0] * (size_t) p->size[1];
    const fg_status status = image_create(&b->log, p->size[0], p->size[1], out);
    for (size_t i = 0; i < count && status == FG_OK; i++) {
        double sum = 0;
        for (int k = -WINDOW; k < WINDOW; k++)
            sum += (k + 0.5) * (double) p->truths[frame + k].rgb[i];
        out->rgb[i] = (float) (sum / squares);
    }
    return status;
}

static fg_status add_change(const bench *b, path *p, int frame)
{
    image due[2] = { { 0 } }; // nothing, and the change
    fg_status status = image_create(&b->log, p->size[0], p->size[1], &due[0]);
    if (status == FG_OK)
        status = fit_slope(b, p, frame, &due[1]);
    if (status == FG_OK) {
        changes_add(&p->changes[KEPT], &p->pictures[KEPT][frame - 1], due);
        changes_add(&p->changes[ANEW], &p->pictures[ANEW][frame - 1], due);
        changes_add(&p->due, due, due);
    }
    image_finish(&due[0]);
    image_finish(&due[1]);
    return status;
}

static fg_status add_changes(const bench *b, path *p)
{
    fg_status status = FG_OK;
    for (int i = FIRST; i + WINDOW <= FRAMES && status == FG_OK; i++)
        if (is_judged(p, i) && is_judged(p, i - 1))
            status = add_change(b, p, i);
    return status;
}

// ---- figures ---------------------------------------------------------------------------------

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

static void print_ratios(const bench *b, path *p)
{
    const int last = p->ratios - 1;
    qsort(p->ratio, (size_t) p->ratios, sizeof *p->ratio, ascending);
    bench_print(b, worst, p->size, last < 0 ? (double) NAN : p->ratio[last], "x");
    bench_print(b, upper, p->size, last < 0 ? (double) NAN : p->ratio[last * 95 / 100], "x");
    bench_print(b, median, p->size, last < 0 ? (double) NAN : p->ratio[last / 2], "x");
}

static void print_flicker(const bench *b, const path *p)
{
    const changes *kept = &p->changes[KEPT], *anew = &p->changes[ANEW];
    const double due = p->due.change, n = p->due.count;
    if (b->verbose)
        fprintf(
            stderr,
            "%s: mean change %.4g kept, %.4g anew, %.4g truth; in excess %.4g kept, %.4g anew\n",
            b->label, kept->change / n, anew->change / n, due / n, kept->excess / n,
            anew->excess / n);
    bench_print(b, flicker, p->size, kept->excess / anew->excess, "x");
    bench_print(b, plain, p->size, (kept->change - due) / (anew->change - due), "x");
}

static fg_status run_path(const bench *b, path *p)
{
    static const char *const values[SIDES] = { "delay=0 tiles=1", "delay=0 tiles=1 mode=anew" };
    fg_status status = FG_OK;
    for (int k = 0; k < SIDES && status == FG_OK; k++) {
        p->sides[k] = (side){ .plugin = "iir", .values = values[k], .picture = true };
        status = side_open(b, &p->sides[k], p->size);
    }
    for (int i = 0; i < FRAMES && status == FG_OK; i++)
        status = run_frame(b, p, i);
    if (status == FG_OK)
        status = add_changes(b, p);
    return status;
}

static void finish(path *p)
{
    for (int k = 0; k < SIDES; k++)
        side_close(&p->sides[k]);
    for (int i = 0; i < FRAMES; i++) {
        image_finish(&p->truths[i]);
        image_finish(&p->pictures[KEPT][i]);
        image_finish(&p->pictures[ANEW][i]);
    }
}

fg_status bench_iir_path(const bench *b)
{
    static path p;
    if (!bench_iir_judges(b) || !bench_wants_any(b, figures))
        return FG_OK;
    p = (path){ .motion = motion_begin(b), .every = strcmp(b->scene_name, "cornell") ? 10 : 1 };
    bench_fit(b, EDGE, p.size);
    fg_status status = run_path(b, &p);
    if (status == FG_OK) {
        print_ratios(b, &p);
        print_flicker(b, &p);
    }
    finish(&p);
    const fg_status ended = motion_end(&p.motion);
    if (status == FG_ERR_UNSUPPORTED)
        status = FG_OK;
    return status == FG_OK ? ended : status;
}
