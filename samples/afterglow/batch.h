// SPDX-License-Identifier: MIT
#ifndef BATCH_H
#define BATCH_H

#include "report.h"

// Settings measured on the scene at hand: first the picture of each, then times, in turns.

typedef struct budget {
    int size;
    int spp_small, spp_large; // of the truth, in scenes below and from SMALL triangles on
    int error_frames;         // the picture that is compared is the n-th at time 0
    int visits, frames;       // of the timing loop: every setting in turn, so often
    double slow_ms;           // settings slower than this are timed once a visit
    double too_slow_ms;       // and slower than this in the first visit only
} budget;

typedef struct batch {
    // For the caller to fill.
    host *h;
    const budget *budget;
    int width, height;
    const job *jobs; // borrowed
    int count;
    int first_index;  // "index" of the first record
    const char *what; // for the progress line
    // Looks at the indirect light of job k and adds to records[k] what it thinks of it.
    fg_status (*judge)(void *user, int k, renderer *r, image *picture);
    void *user;

    cJSON **records;  // one a job; NULL: not to be measured
    timing *timings;  // one a job
    double *estimate; // one a job: ms of the last frame of its picture
} batch;

// The arrays, with a record for every job: delete and clear those that are not to be measured.
FG_NODISCARD fg_status batch_create(batch *b);
// Afterwards records have all that record_create() gives, "index" and "label", then what judge()
// has added.
FG_NODISCARD fg_status batch_run(batch *b);
void batch_finish(batch *b); // deletes what records are left

#endif // BATCH_H
