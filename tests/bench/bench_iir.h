// SPDX-License-Identifier: MIT
#ifndef BENCH_IIR_H
#define BENCH_IIR_H

#include "bench.h"

// Whether a scene has figures against a truth: the built-in ones, and others that --scene names.
bool bench_iir_judges(const bench *b);

fg_status bench_iir_times(const bench *b);
fg_status bench_iir_errors(const bench *b);
fg_status bench_iir_path(const bench *b);

#endif // BENCH_IIR_H
