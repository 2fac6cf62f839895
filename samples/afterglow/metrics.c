// SPDX-License-Identifier: MIT
#include "metrics.h"

#include <math.h>
#include <stdlib.h>

// What the passes over the pictures share. `values` holds one number a channel, twice `count`
// long: |d| first, then the relative squared errors.
typedef struct tally {
    const image *a, *b;
    size_t count; // channels of pixels that are finite in both
    double sum_a, sum_b, sum_d2, sum_b2, max_b, sum_smape;
    double *absolute, *relative;
} tally;

static bool same_size(const fg_log *log, const image *a, const image *b)
{
    if (a->width == b->width && a->height == b->height)
        return true;
    fg_logf(log, FG_LOG_ERROR, "compare: sizes differ: %d x %d and %d x %d", a->width, a->height,
            b->width, b->height);
    return false;
}

static bool finite_pixel(const float *rgb)
{
    return isfinite(rgb[0]) && isfinite(rgb[1]) && isfinite(rgb[2]);
}

static double quotient(double over, double under)
{
    if (under != 0)
        return over / under;
    return over == 0 ? 0 : HUGE_VAL;
}

static void add_channel(tally *t, double a, double b)
{
    const double d = a - b, size = fabs(a) + fabs(b);
    t->absolute[t->count++] = fabs(d);
    t->sum_a += a;
    t->sum_b += b;
    t->sum_d2 += d * d;
    t->sum_b2 += b * b;
    t->max_b = fmax(t->max_b, fabs(b));
    t->sum_smape += size > 0 ? 2 * fabs(d) / size : 0;
}

// First pass: the sums. Returns how many pixels are not finite.
static long add_up(tally *t)
{
    const size_t pixels = (size_t) t->a->width * (size_t) t->a->height;
    long nonfinite = 0;
    for (size_t i = 0; i < 3 * pixels; i += 3) {
        if (!finite_pixel(t->a->rgb + i) || !finite_pixel(t->b->rgb + i)) {
            ++nonfinite;
            continue;
        }
        for (size_t c = i; c < i + 3; ++c)
            add_channel(t, (double) t->a->rgb[c], (double) t->b->rgb[c]);
    }
    return nonfinite;
}

// Second pass, which needs the reference's mean: d^2 / (b^2 + 0.01 mean(b)^2).
static void fill_relative(tally *t, double mean_b)
{
    const size_t pixels = (size_t) t->a->width * (size_t) t->a->height;
    size_t n = 0;
    for (size_t i = 0; i < 3 * pixels; i += 3) {
        if (!finite_pixel(t->a->rgb + i) || !finite_pixel(t->b->rgb + i))
            continue;
        for (size_t c = i; c < i + 3; ++c) {
            const double b = (double) t->b->rgb[c], d = (double) t->a->rgb[c] - b;
            t->relative[n++] = quotient(d * d, b * b + 0.01 * mean_b * mean_b);
        }
    }
}

static void swap(double *a, double *b)
{
    const double t = *a;
    *a = *b;
    *b = t;
}

// Reorders so that v[k] is what sorting would put there, nothing larger before it and nothing
// smaller after it. Hoare's selection, the middle element as pivot.
static double select_kth(double *v, size_t count, size_t k)
{
    size_t low = 0, high = count - 1;
    while (low < high) {
        const double pivot = v[low + (high - low) / 2];
        size_t i = low, j = high;
        for (;; ++i, --j) {
            while (v[i] < pivot)
                ++i;
            while (v[j] > pivot)
                --j;
            if (i >= j)
                break;
            swap(v + i, v + j);
        }
        if (k <= j)
            high = j;
        else
            low = j + 1;
    }
    return v[k];
}

static double trimmed_mean(double *v, size_t count, double trimmed_share)
{
    const size_t kept = count - (size_t) ((double) count * trimmed_share);
    double sum = 0;
    select_kth(v, count, kept - 1);
    for (size_t i = 0; i < kept; ++i)
        sum += v[i];
    return sum / (double) kept;
}

static void finish(tally *t, metrics *out)
{
    const double n = (double) t->count;
    out->rmse = sqrt(t->sum_d2 / n);
    out->rmse_rms = quotient(out->rmse, sqrt(t->sum_b2 / n));
    out->rmse_max = quotient(out->rmse, t->max_b);
    out->smape = t->sum_smape / n;
    out->bias = (t->sum_a - t->sum_b) / n;
    out->energy_ratio = t->sum_a == 0 && t->sum_b == 0 ? 1 : quotient(t->sum_a, t->sum_b);
    out->p99 = select_kth(t->absolute, t->count, (size_t) ceil(0.99 * n) - 1);
    fill_relative(t, t->sum_b / n);
    out->relmse = trimmed_mean(t->relative, t->count, 0.001);
}

fg_status metrics_compare(const fg_log *log, const image *a, const image *b, metrics *out)
{
    const double nan = (double) NAN;
    *out = (metrics){ nan, nan, nan, nan, nan, nan, nan, nan, 0 };
    if (!same_size(log, a, b))
        return FG_ERR_INVALID;
    const size_t channels = 3 * (size_t) a->width * (size_t) a->height;
    tally t = { .a = a, .b = b };
    t.absolute = calloc(channels, 2 * sizeof *t.absolute);
    if (!t.absolute) {
        fg_logf(log, FG_LOG_ERROR, "compare: out of memory for %d x %d", a->width, a->height);
        return FG_ERR_MEMORY;
    }
    t.relative = t.absolute + channels;
    out->nonfinite = add_up(&t);
    if (t.count)
        finish(&t, out);
    free(t.absolute);
    return FG_OK;
}

// Signed, of the channel that is farthest off.
static double worst_difference(const float *a, const float *b)
{
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        const double d = (double) a[c] - (double) b[c];
        if (fabs(d) > fabs(worst))
            worst = d;
    }
    return worst;
}

fg_status metrics_error_map(const fg_log *log, const image *a, const image *b, double scale,
                            image *out)
{
    *out = (image){ 0 };
    if (!same_size(log, a, b))
        return FG_ERR_INVALID;
    if (!(scale > 0) || !isfinite(scale)) {
        fg_logf(log, FG_LOG_ERROR, "compare: scale of the error map is %g, must be above 0", scale);
        return FG_ERR_INVALID;
    }
    const fg_status status = image_create(log, a->width, a->height, out);
    if (status != FG_OK)
        return status;
    const size_t channels = 3 * (size_t) a->width * (size_t) a->height;
    for (size_t i = 0; i < channels; i += 3) {
        float *rgb = out->rgb + i;
        rgb[1] = 1;
        if (!finite_pixel(a->rgb + i) || !finite_pixel(b->rgb + i))
            continue;
        const double d = worst_difference(a->rgb + i, b->rgb + i) / scale;
        const float fade = (float) (1 - fmin(fabs(d), 1));
        rgb[0] = d >= 0 ? 1 : fade;
        rgb[1] = fade;
        rgb[2] = d <= 0 ? 1 : fade;
    }
    return FG_OK;
}

double metrics_without_noise(const metrics *m, double rms, double noise)
{
    const double square = m->rmse * m->rmse - noise * noise, under = rms * rms - noise * noise;
    return square > 0 && under > 0 ? sqrt(square / under) : (double) NAN;
}
