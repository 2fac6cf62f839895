// SPDX-License-Identifier: MIT
// Incremental instant radiosity in figures that take frames: what it saves against making all VPLs
// anew, how far off it is, along a path too, how it flickers.
//
//     bench_iir [--size N|WxH] [--scene NAME] [--camera NAME] [--set KEY=VALUE]...
//               [--pictures FOLDER] [--least] [--verbose] [FIGURE]...
//
// 1024 x 768 where no size is given; figures against a truth take less of it. E.g.
// `bench_iir --scene cornell --set tiles=1 iir.rmse_rms_256` for an error's part.
#include "bench_iir.h"

#include <string.h>

bool bench_iir_judges(const bench *b)
{
    return b->wanted_scene || strcmp(b->scene_name, "sponza") != 0;
}

int main(int argc, char **argv)
{
    static const bench_part parts[] = { bench_iir_times, bench_iir_errors, bench_iir_path, NULL };
    const bench_program program = {
        .name = "bench_iir",
        .size = { 1024, 768 },
        .subject = "iir",
        .parts = parts,
    };
    return bench_main(&program, argc, argv);
}
