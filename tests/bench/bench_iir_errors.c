// SPDX-License-Identifier: MIT
// How far indirect light is off from one bounce by the reference renderer, without the noise of the
// latter, over the number of VPLs; and what of that the tiles and the shadow maps make.
//
// A still light: kept VPLs and new ones are the same.
#include "bench_iir.h"

#include <string.h>

// The reference takes minutes for more: pixels along an edge, samples of a pixel. What the tiles
// make depends on the size: the fewer pixels a surface has, the more of it lies at an edge.
enum { EDGE = 512, SPP = 128 };

static const int counts[] = { 64, 256, 1024, 4096 };

typedef struct variant {
    const char *figure; // "_64" and so on follow
    const char *values;
    bool unshadowed; // against the truth in which nothing hides anything from VPLs
    const char *energy;
} variant;

static const variant variants[] = {
    { "iir.rmse_rms", "", false, "iir.energy_ratio" },
    { "iir.rmse_rms_tiles1", "tiles=1", false, NULL },
    { "iir.rmse_rms_without_maps", "visibility=none", false, NULL },
    { "iir.rmse_rms_without_maps_of_unshadowed", "visibility=none", true,
      "iir.energy_ratio_without_maps_of_unshadowed" },
};

// A figure of so many VPLs.
typedef struct named {
    char text[64];
} named;

static named figure_of(const char *figure, int count)
{
    named n;
    snprintf(n.text, sizeof n.text, "%s_%d", figure, count);
    return n;
}

static bool wants(const bench *b, const variant *v, int count)
{
    return bench_wants(b, figure_of(v->figure, count).text) ||
           (v->energy && bench_wants(b, figure_of(v->energy, count).text));
}

static bool wants_truth(const bench *b, bool unshadowed)
{
    for (int i = 0; i < FG_COUNT(variants); i++)
        for (int k = 0; k < FG_COUNT(counts); k++)
            if (variants[i].unshadowed == unshadowed && wants(b, &variants[i], counts[k]))
                return true;
    return false;
}

static fg_status judge(const bench *b, const variant *v, int count, const truth *t, side *s)
{
    image picture = { 0 };
    truth_error e;
    const int size[2] = { t->picture.width, t->picture.height };
    const named name = figure_of(v->figure, count);
    fg_status status = side_picture(s, &picture);
    if (status == FG_OK)
        status = truth_compare(b, t, &picture, &e);
    if (status == FG_OK) {
        bench_print(b, name.text, size, 100 * e.rmse_rms, "%");
        if (v->energy)
            bench_print(b, figure_of(v->energy, count).text, size, e.m.energy_ratio, "x");
        if (b->verbose)
            fprintf(stderr, "%s: %s: of the maximum %.3g %%, smape %.3g, p99 %.3g of the RMS\n",
                    b->label, name.text, 100 * e.m.rmse_max, e.m.smape, e.m.p99 / t->rms);
        side_list_counters(b, s);
        status = truth_write(b, t, &picture, name.text);
    }
    image_finish(&picture);
    return status;
}

static fg_status run_count(const bench *b, const variant *v, int count, const truth *t)
{
    char values[96];
    const int size[2] = { t->picture.width, t->picture.height };
    side s = { .plugin = "iir", .values = values, .picture = true };
    snprintf(values, sizeof values, "delay=0 max_lights=%d%s%s", count, v->values[0] ? " " : "",
             v->values);
    fg_status status = side_open(b, &s, size);
    if (status == FG_OK)
        status = side_frame(b, &s, b->scene->time);
    if (status == FG_OK)
        status = judge(b, v, count, t, &s);
    side_close(&s);
    return status;
}

// All that is held against one truth.
static fg_status run_truth(const bench *b, bool unshadowed)
{
    truth t = { 0 };
    truth_desc desc = { .spp = SPP, .unshadowed = unshadowed };
    bench_fit(b, EDGE, desc.size);
    fg_status status = truth_render(b, &desc, &t);
    if (status == FG_OK && b->verbose)
        fprintf(stderr, "%s: truth%s: noise %.3g %% of its RMS\n", b->label,
                unshadowed ? " without shadows" : "", 100 * t.noise / t.rms);
    if (status == FG_OK)
        status = truth_write(b, &t, &t.picture, unshadowed ? "truth_unshadowed" : "truth");
    for (int i = 0; i < FG_COUNT(variants) && status == FG_OK; i++)
        for (int k = 0; k < FG_COUNT(counts) && status == FG_OK; k++)
            if (variants[i].unshadowed == unshadowed && wants(b, &variants[i], counts[k]))
                status = run_count(b, &variants[i], counts[k], &t);
    truth_finish(&t);
    return status;
}

fg_status bench_iir_errors(const bench *b)
{
    fg_status status = FG_OK;
    if (!bench_iir_judges(b))
        return FG_OK;
    for (int i = 0; i < 2 && status == FG_OK; i++)
        if (wants_truth(b, i == 1))
            status = run_truth(b, i == 1);
    return status == FG_ERR_UNSUPPORTED ? FG_OK : status;
}
