// SPDX-License-Identifier: MIT
#ifndef BENCH_ISR_H
#define BENCH_ISR_H

#include "bench.h"

fg_status bench_times(const bench *b);
fg_status bench_errors(const bench *b);
fg_status bench_pairs(const bench *b);
fg_status bench_hisr(const bench *b);
fg_status bench_flicker(const bench *b);

// ---- a full-screen copy ----------------------------------------------------------------------

// One RGBA16F texel read, one written, by compute and by raster, as passes of a graph.
typedef struct copy {
    fg_graph *graph;
    uint32_t source;
    fg_res from, to[2];
    samples ms[2]; // compute, raster
} copy;

fg_status copy_open(const bench *b, copy *c);
void copy_close(copy *c); // accepts a zeroed one
fg_status copy_frame(const bench *b, copy *c);

#endif // BENCH_ISR_H
