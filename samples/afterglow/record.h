// SPDX-License-Identifier: MIT
#ifndef RECORD_H
#define RECORD_H

#include "host.h"
#include "metrics.h"

// Run records: what --stats and report.json hold of one plugin at one setting on one scene.

// Times of frames. Grows by timing_run(); all in milliseconds.
enum { TIMING_MAX_PASSES = 128 };
typedef struct timing {
    struct trace *trace; // trace.h: gets the frames, too; borrowed, may be NULL
    int capacity, count;
    double *frame; // [capacity] from before the frame to after the GPU has done it
    double *cpu;   // [capacity] of renderer_frame() alone
    int pass_count;
    char pass[TIMING_MAX_PASSES][64];
    double *gpu[TIMING_MAX_PASSES];  // [capacity] by GPU timers; NAN where there was no such pass
    double *call[TIMING_MAX_PASSES]; // [capacity] in the pass's callback; likewise
} timing;

FG_NODISCARD fg_status timing_create(int capacity, timing *out);
void timing_finish(timing *t); // accepts a zeroed one

// One frame at `time`, bracketed by waits for the GPU; nothing where there is no room.
FG_NODISCARD fg_status timing_frame(timing *t, fg_device *device, renderer *r, double time);
// Runs `frames` frames of the animation after `frame`, 1/60 s apart, each bracketed by waits for
// the GPU. One more goes before them to warm up.
FG_NODISCARD fg_status timing_run(timing *t, fg_device *device, renderer *r, int frame, int frames);
double timing_quantile(const double *values, int count, double q); // NANs left out; NAN if none

double now_ms(void); // a monotonic clock

// Everything but the error, which is null. NULL: out of memory.
cJSON *record_create(const host *h, renderer *r, const setting *s, const timing *t, int width,
                     int height);
// { "reference": ..., "rmse": ..., ... }
cJSON *record_error(const char *reference, const metrics *m);
cJSON *record_device(const host *h);
cJSON *record_params(const setting *s);
cJSON *record_features(uint64_t features); // the names of ag_feature bits
FG_NODISCARD fg_status record_write(const fg_log *log, const cJSON *json, const char *path);

#endif // RECORD_H
