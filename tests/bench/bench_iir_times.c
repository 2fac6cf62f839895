// SPDX-License-Identifier: MIT
// Frames that keep VPLs and their shadow maps against frames that make all of them anew, as in the
// paper's table 1: light and camera move. `_indirect` is without what a frame takes with direct
// light alone.
#include "bench_iir.h"

#include <string.h>

enum { HOST, INCREMENTAL, ANEW, SIDES };
// Kept VPLs take some frames to get as uneven as they will.
enum { WARM = 2, WARM_KEPT = 10, LEAST = 3, MOST = 15 };
static const double patience_ms = 20e3; // after that, LEAST frames have to do

typedef struct row {
    const char *values[2]; // kept, anew
    const char *frame, *indirect, *ms, *anew_ms;
} row;

static const row rows[] = {
    { { "max_lights=256", "max_lights=256 mode=anew" },
      "iir.anew_over_incremental_256",
      "iir.anew_over_incremental_256_indirect",
      "iir.frame_ms_256",
      "iir.frame_ms_anew_256" },
    { { "max_lights=1024", "max_lights=1024 mode=anew" },
      "iir.anew_over_incremental_1024",
      "iir.anew_over_incremental_1024_indirect",
      "iir.frame_ms_1024",
      "iir.frame_ms_anew_1024" },
};

typedef struct times {
    side sides[SIDES];
    motion motion;
    int frame;
} times;

static fg_status run_turn(const bench *b, times *t, int sides)
{
    fg_status status = motion_round(&t->motion, t->frame);
    if (status == FG_OK)
        status = motion_camera(&t->motion, t->frame);
    for (int k = 0; k < sides && status == FG_OK; k++)
        status = side_frame(b, &t->sides[k], b->scene->time);
    t->frame++;
    return status;
}

static fg_status run_turns(const bench *b, times *t)
{
    fg_status status = FG_OK;
    for (int i = 0; i < WARM && status == FG_OK; i++)
        status = run_turn(b, t, SIDES);
    for (int i = 0; i < WARM_KEPT && status == FG_OK; i++)
        status = run_turn(b, t, ANEW);
    for (int k = 0; k < SIDES; k++)
        side_forget(&t->sides[k]);
    const double start = bench_now_ms();
    for (int i = 0; i < MOST && status == FG_OK; i++)
        if (i < LEAST || bench_now_ms() - start < patience_ms)
            status = run_turn(b, t, SIDES);
    return status;
}

static void print_all(const bench *b, times *t, const row *r)
{
    const double host = samples_typical(&t->sides[HOST].frame),
                 kept = samples_typical(&t->sides[INCREMENTAL].frame),
                 anew = samples_typical(&t->sides[ANEW].frame);
    for (int k = 0; k < SIDES; k++)
        side_list(b, &t->sides[k]);
    side_list_counters(b, &t->sides[INCREMENTAL]);
    side_list_counters(b, &t->sides[ANEW]);
    bench_print(b, r->frame, b->size, anew / kept, "x");
    bench_print(b, r->indirect, b->size, (anew - host) / (kept - host), "x");
    bench_print(b, r->ms, b->size, kept, "ms");
    bench_print(b, r->anew_ms, b->size, anew, "ms");
}

static fg_status run_row(const bench *b, const row *r)
{
    static times t;
    t = (times){ .motion = motion_begin(b) };
    fg_status status = side_open(b, &t.sides[HOST], b->size);
    for (int k = 0; k < 2 && status == FG_OK; k++) {
        t.sides[INCREMENTAL + k] = (side){ .plugin = "iir", .values = r->values[k] };
        status = side_open(b, &t.sides[INCREMENTAL + k], b->size);
    }
    if (status == FG_OK)
        status = run_turns(b, &t);
    if (status == FG_OK)
        print_all(b, &t, r);
    for (int k = 0; k < SIDES; k++)
        side_close(&t.sides[k]);
    const fg_status ended = motion_end(&t.motion);
    return status == FG_OK ? ended : status;
}

fg_status bench_iir_times(const bench *b)
{
    fg_status status = FG_OK;
    for (int i = 0; i < FG_COUNT(rows) && status == FG_OK; i++) {
        const row *r = &rows[i];
        const char *const figures[] = { r->frame, r->indirect, r->ms, r->anew_ms, NULL };
        if (bench_wants_any(b, figures))
            status = run_row(b, r);
    }
    return status == FG_ERR_UNSUPPORTED ? FG_OK : status;
}
