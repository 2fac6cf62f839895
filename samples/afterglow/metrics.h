// SPDX-License-Identifier: MIT
#ifndef METRICS_H
#define METRICS_H

#include "image.h"

FG_BEGIN

// Error of `a` against the reference `b`, over all channels of all pixels, linear, before any
// tone curve. Non-finite pixels of either are counted and then left out. Sums in double.
// A quotient by zero is 0 where nothing is off and infinite elsewhere; where no pixel is left all
// is NaN but the count.
typedef struct metrics {
    double rmse;
    double rmse_rms;     // over the reference's RMS: what we call relative RMSE
    double rmse_max;     // over the reference's maximum
    double relmse;       // mean of d^2 / (b^2 + 0.01 mean(b)^2), the worst 0.1 % trimmed
    double smape;        // mean of 2 |d| / (|a| + |b|), 0 where both are 0
    double bias;         // mean of a - b
    double energy_ratio; // sum(a) / sum(b); 1 if both are 0, infinite if only b is
    double p99;          // 99th percentile of |d|: the least value that 99 % do not exceed
    long nonfinite;      // pixels
} metrics;

// FG_ERR_INVALID if the sizes differ; FG_ERR_MEMORY.
FG_NODISCARD fg_status metrics_compare(const fg_log *log, const image *a, const image *b,
                                       metrics *out);

// A signed error map on white: red where `a` is too bright, blue where too dark, full colour
// where the channel that is farthest off is off by `scale`; green where either is not finite.
//
// Units:  scale as the pictures; finite, > 0.
// Errors: FG_ERR_INVALID for another scale or sizes that differ; FG_ERR_MEMORY.
FG_NODISCARD fg_status metrics_error_map(const fg_log *log, const image *a, const image *b,
                                         double scale, image *out);

// Relative RMSE without the noise of a reference of RMS `rms`: as it is independent of result and
// truth, the noise's square is in the squares of both and is taken out of both. NAN where that
// leaves nothing.
double metrics_without_noise(const metrics *m, double rms, double noise);

FG_END

#endif // METRICS_H
