// SPDX-License-Identifier: MIT
// Image-space radiosity in figures: what it costs against what it replaces, how far off it is, how
// it flickers. Both sides of a ratio run in turn, warmed up; a ratio is one of medians.
//
//     bench_isr [--size N|WxH] [--scene NAME] [--least] [--verbose] [FIGURE]...
//
// E.g. isr.fixed_over_copy, or all of hisr. 1024 x 1024 where no size is given.
#include "bench_isr.h"

int main(int argc, char **argv)
{
    static const bench_part parts[] = { bench_times, bench_pairs,   bench_errors,
                                        bench_hisr,  bench_flicker, NULL };
    const bench_program program = {
        .name = "bench_isr",
        .size = { 1024, 1024 },
        .parts = parts,
    };
    return bench_main(&program, argc, argv);
}
