// SPDX-License-Identifier: MIT
#ifndef BENCH_ISR_LOOP_H
#define BENCH_ISR_LOOP_H

#include <fg/base.h>
#include <pass/vpl_shared.h>

// The gather as a plain loop in C, for a compiler to vectorise, on all cores: the arithmetic of
// passes/gather/gather.comp, a pair of receiver and VPL
//
//     d = q - p;  d2 = d.d;  ci = max(n.d, 0);  cj = max(-m.d, 0)
//     share = ci cj / max(d2 (pi d2 + A), 1e-36);  sum += flux share
//
// which is 3 dot products, 1 division, 3 maxima and about 12 more; with `footprint` besides the
// test for near VPLs, and for those the patch's form factor of passes/gather/near.glsl. 64
// receivers at a time, x, y, z in arrays of their own; VPLs are the outer loop.
enum { LOOP_BLOCK = 64 };

typedef struct loop {
    int receivers;      // a multiple of LOOP_BLOCK
    float *position[3]; // scaled by `unit`
    float *normal[3];   // unit
    float *sum[3];      // out: E / pi
    const struct ag_vpl *vpls;
    int vpl_count;
    float unit;
    bool footprint;
} loop;

// `times` over, so that starting the threads takes no part.
void loop_run(const loop *l, int threads, int times);

#endif // BENCH_ISR_LOOP_H
