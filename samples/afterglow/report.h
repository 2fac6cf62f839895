// SPDX-License-Identifier: MIT
#ifndef REPORT_H
#define REPORT_H

#include "record.h"

// Error against run time. A report is one JSON document from first to last: measuring and merging
// make it, and all that is written (CSV, plots, the page) is drawn from it.
//
//   { "afterglow": version, "budget", "size": [w, h], "seed", "shard": [i, n] or null,
//     "shadow": [size or 0, taps] of direct light, "notes": [],
//     "scenes": [ { "name", "triangles", "exposure",
//                   "references": [ { "name": "path1", "spp", "noise", "rms", "mean", "image" } ],
//                   "not_served": [ { "plugin", "lacks" } ],
//                   "graphs": [ { "plugin", "dot" } ] } ],
//     "records": [ run records with "index", "label", "errors": [one per reference, with "noise"
//     and "rmse_rms_corrected"],
//                  "images": { "result", "error": [one per reference] } } ],
//     "studies": [ see study.h ] }
//
// File names in it are relative to the report's folder.

// One thing to measure: a plugin at a setting. `label` says what differs from its base.
typedef struct job {
    setting s;
    bool base; // as --set and defaults have it
    char label[96];
} job;

typedef struct job_list {
    job *jobs;
    int count, capacity;
} job_list;

// Appends direct light alone and every setting of every plugin that the budget allows; the order
// depends on nothing else. FG_ERR_MEMORY.
FG_NODISCARD fg_status jobs_build(const options *o, const setting *plugins, int count, bool full,
                                  job_list *out);
void jobs_finish(job_list *jobs);

// What a scene is measured against.
enum { REPORT_TRUTHS = 2 };
typedef struct truths {
    image picture[REPORT_TRUTHS];
    double noise[REPORT_TRUTHS]; // RMS of what noise is left in them
    double rms[REPORT_TRUTHS];
    double exposure;             // what pictures are multiplied by to be looked at
    double scale[REPORT_TRUTHS]; // full colour of error maps
} truths;
extern const char *const truth_names[REPORT_TRUTHS]; // "path1", "path1_unshadowed"

typedef struct truths_desc {
    const char *folder; // where their pictures go
    cJSON *scene_json;  // what they are added to
    int width, height;
    int spp[REPORT_TRUTHS];
} truths_desc;

// Renders them and writes their pictures. Exit codes from here on.
int truths_render(host *h, const truths_desc *desc, truths *out);
void truths_finish(truths *t);
// The metrics of a picture against a truth, with "noise" and "rmse_rms_corrected".
cJSON *truth_error(const truths *t, int truth, const metrics *e);

int report_measure(cli *c, const options *o, cJSON **doc);
int report_merge(cli *c, const options *o, cJSON **doc);

// report.json, report.csv, plots/, report.html in `folder`.
int report_write(cli *c, const char *folder, cJSON *doc);
FG_NODISCARD fg_status report_csv(const fg_log *log, const char *folder, const cJSON *doc);
// Plots and graphs as SVG files. Where gnuplot or dot is missing or fails, a note is added.
FG_NODISCARD fg_status report_plots(const fg_log *log, const char *folder, cJSON *doc);
FG_NODISCARD fg_status report_html(const fg_log *log, const char *folder, const cJSON *doc);

// Reading the document: a missing member is "" or NAN.
const char *json_text(const cJSON *object, const char *name);
double json_number(const cJSON *object, const char *name);
// Adds a note for the reader of the report, once, and warns.
void report_note(cJSON *doc, const char *fmt, ...) FG_PRINTF(2, 3);
// Relative file names: "cornell" and "rsm" as they are; what loses its folder or has odd letters
// replaced carries a hash, so that two names stay two.
void report_file_name(char *out, size_t size, const char *text);
// Whether no other record of the scene is both faster and nearer to truth `truth`.
bool report_on_front(const cJSON *doc, const cJSON *record, int truth);
// Relative RMSE against the truth with the truth's own noise taken out; NAN where that is all.
double report_error_of(const cJSON *record, int truth);
// Time of a pass: its GPU timer's, or its callback's where that is longer, as on a software device,
// which runs compute there.
double report_pass_ms(const cJSON *pass);

#endif // REPORT_H
