// SPDX-License-Identifier: MIT
#ifndef PLOT_H
#define PLOT_H

#include "file.h"

#include <cjson/cJSON.h>

// Pictures by other programs: gnuplot scripts and what runs them.
//
//     plot p;
//     if (plot_begin(log, folder, "plots/cornell_path1", 480, &p) == FG_OK) {
//         fprintf(p.out.stream, "plot x\n");
//         status = plot_end(log, &p, true, doc);       // plots/cornell_path1.svg
//     }
typedef struct plot {
    char script[4096], svg[4096];
    file out; // the script: terminal, output, border, grid and tics stand already
} plot;

// An SVG of an earlier run must not stand for this one.
void plot_remove(const char *folder, const char *stem);
// Removes it, too. Errors as file_begin().
FG_NODISCARD fg_status plot_begin(const fg_log *log, const char *folder, const char *stem,
                                  int height, plot *out);
// Runs gnuplot, if `keep`. Where it is missing or fails a note is added to the report `doc`.
FG_NODISCARD fg_status plot_end(const fg_log *log, plot *p, bool keep, cJSON *doc);

// Text in double quotes; a file's name in single ones, whatever its letters.
void plot_text(FILE *f, const char *text);
void plot_path(FILE *f, const char *path);
// Colour `i`; they tell apart for most eyes.
const char *plot_colour(int i);

// Runs a program without output. False where it is missing or fails, with a note that says so
// and `lacking`, what the report lacks therefore.
bool plot_program(const char *const *argv, const char *lacking, cJSON *doc);

#endif // PLOT_H
