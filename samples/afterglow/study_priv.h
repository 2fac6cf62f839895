// SPDX-License-Identifier: MIT
#ifndef STUDY_PRIV_H
#define STUDY_PRIV_H

#include "study.h"

// A study on a scene while it is measured.

enum { STUDY_POINTS = STUDY_CURVES * STUDY_VALUES };

typedef struct point {
    char text[256]; // the whole setting
    int curve;
    const char *value; // of x; NULL: none is swept
} point;

typedef struct course {
    const studies_desc *d;
    const study *s;
    baselines *baselines;
    tour tour; // at time 0 where the study is of no path
    cJSON *points_json;
    int count;
    point points[STUDY_POINTS];
    job jobs[STUDY_POINTS];
    batch batch;
} course;

// The picture that point k is compared with at a time of the tour; NULL: there is none.
FG_NODISCARD fg_status study_baseline(course *c, int k, int baseline, double time,
                                      const image **out);
// Says of a record what point it is, and hands it over.
void study_take_point(course *c, int k, cJSON *record);
// Points along a path.
FG_NODISCARD fg_status study_walk(course *c);

#endif // STUDY_PRIV_H
