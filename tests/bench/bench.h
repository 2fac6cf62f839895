// SPDX-License-Identifier: MIT
#ifndef BENCH_H
#define BENCH_H

#include "metrics.h"
#include "renderer.h"

#include <stdio.h>

// What the benchmarks of techniques share: scenes, techniques at their settings ("sides") that run
// frames in turn in one process, and figures, which are printed as
// `BENCH name scene size value unit`:
//
//     int main(int argc, char **argv)
//     {
//         static const bench_part parts[] = { bench_times, bench_errors, NULL };
//         const bench_program program = { .name = "bench_isr", .size = { 1024, 1024 },
//                                         .parts = parts };
//         return bench_main(&program, argc, argv);
//     }
//
// The command: NAME [--size N|WxH] [--scene NAME] [--least] [--verbose] [FIGURE]..., of a program
// with a subject also [--camera NAME] [--set KEY=VALUE]... [--pictures FOLDER].
//
// --scene: cornell, atrium or sponza (all that are there; Sponza is found below AFTERGLOW_SCENES).
// --least: the least of each time instead of the median. --verbose: what a figure is made of on
// stderr. FIGURE: the figures that begin so alone. --camera: another than the scene's first.
// --set: a parameter of all sides of the subject. --pictures: what the errors are of, as PNG.
//
// Sponza has no light: a spot of 25 to 35 degrees hangs 10 m above its court, 600 W/sr.
enum { MAX_NAMES = 16, MAX_SET = 16, MAX_FRAMES = 32, MAX_PASSES = 48 };

typedef struct bench bench;
typedef fg_status (*bench_part)(const bench *b);

typedef struct bench_program {
    const char *name;        // before its lines on stderr
    int size[2];             // of frames where --size is not given
    bool builtin;            // all built-in scenes instead; takes --gi NAME
    const char *subject;     // the plugin that it is about, without which it does nothing; or NULL
    const bench_part *parts; // run in order in each scene; ends at NULL
} bench_program;

struct bench {
    const bench_program *program;
    fg_log log;
    fg_gl_context *context;
    fg_device *device;
    gi_registry *registry;
    ag_scene *scene;
    const char *scene_name;
    char label[64]; // of the scene, and of the camera where it was chosen
    int camera;     // of the scene's
    int size[2];    // pixels
    bool verbose;
    const char *wanted_scene, *wanted_camera; // NULL: all; the first
    const char *pictures;                     // NULL: none
    const char *set[MAX_SET];
    int set_count;
    const char *techniques[MAX_NAMES]; // by --gi
    int technique_count;
    const char *names[MAX_NAMES]; // figures asked for, or how they begin; none: all
    int name_count;
};

int bench_main(const bench_program *program, int argc, char **argv); // the exit code

bool bench_wants(const bench *b, const char *figure);
// Whether any figure of a list that ends at NULL is wanted.
bool bench_wants_any(const bench *b, const char *const *figures);
// Prints a figure that is wanted. A value that is not finite is a line on stderr instead.
void bench_print(const bench *b, const char *figure, const int size[2], double value,
                 const char *unit);
// The bench's size, made smaller until no edge is longer than `edge`.
void bench_fit(const bench *b, int edge, int size[2]);
double bench_now_ms(void);

// ---- samples of a time -----------------------------------------------------------------------

typedef struct samples {
    double ms[MAX_FRAMES];
    int count;
} samples;

void samples_add(samples *s, double ms); // beyond MAX_FRAMES: the oldest goes
// Their median, or the least once samples_take_least() was called; NAN without any.
double samples_typical(const samples *s);
void samples_take_least(void);

// ---- a technique at its settings -------------------------------------------------------------

typedef struct pass_time {
    char name[64];
    samples ms;
} pass_time;

typedef struct side {
    const char *plugin; // NULL: direct light alone
    const char *values; // "vpls=256 share=0": what departs from the defaults
    bool picture;       // its indirect layer is to be read
    bool needs_all;     // nothing that the scene does not need is left out
    const gi_plugin *table;
    gi_value *set;
    renderer *r;
    samples frame;
    pass_time passes[MAX_PASSES];
    int pass_count;
} side;

bool side_plugin_exists(const bench *b, const char *plugin); // else a line on stderr
// Finds the plugin and makes a renderer of the bench's scene. FG_ERR_UNSUPPORTED, with a line on
// stderr: there is no such plugin, or it has no such parameter.
fg_status side_open(const bench *b, side *s, const int size[2]);
void side_close(side *s); // accepts a zeroed one
// The same with other values; the plugin stays.
fg_status side_set(const bench *b, side *s, const char *values);
// Runs a frame, waits for it, notes its time and those of its passes.
fg_status side_frame(const bench *b, side *s, double time);
void side_forget(side *s); // all times so far
// The indirect layer of the last frame.
fg_status side_picture(side *s, image *out);
double side_counter(side *s, const char *name); // NAN where there is none yet
// Sum of the times of those passes of the plugin for whose names after "PLUGIN." `wanted` holds.
double side_sum(const side *s, bool (*wanted)(const char *step));
void side_list(const bench *b, const side *s);    // a table on stderr
void side_list_counters(const bench *b, side *s); // a line there

bool step_is_gather(const char *step);
bool step_is_map(const char *step);   // draws a reflective shadow map
bool step_is_fixed(const char *step); // neither of both

// ---- moving light ----------------------------------------------------------------------------

// Where an animation of the scene moves the light (atrium: 26 mm a frame), that goes on at 30
// frames a second; in the others the first light goes as far here. So it does in cornell, 5 mm a
// frame, whose own light goes in a circle: else all of the box rests.
typedef struct motion {
    ag_scene *scene;
    bool by_itself;
    double step;    // m a frame
    ag_light light; // at rest
    ag_camera camera;
} motion;

motion motion_begin(const bench *b);
fg_status motion_line(motion *m, int frame, double steps); // `steps` steps along x
// To and fro around where it rests, swinging; at most a step a frame.
fg_status motion_round(motion *m, int frame);
fg_status motion_camera(motion *m, int frame); // the camera likewise, to its right and left
fg_status motion_end(motion *m);               // back at rest

// How pictures change along the motion beside how they should.
typedef struct changes {
    double change; // sum over the frames of mean |dI|, dI = now - before
    double excess; // and of mean |dI - dT|, T the truth
    int count;
} changes;

// Pictures of before and now: its own, and the truth.
void changes_add(changes *c, const image picture[2], const image due[2]);

// ---- truth -----------------------------------------------------------------------------------

// Indirect light of one bounce by the reference renderer at the scene's time.
typedef struct truth {
    image picture;
    double rms, noise; // RMS of what noise is left in it
} truth;

typedef struct truth_error {
    metrics m;
    double rmse_rms; // without the truth's noise; NAN where that is all
} truth_error;

typedef struct truth_desc {
    int size[2];
    int spp;
    uint64_t seed;
    bool unshadowed; // every surface along a bounce ray counts
} truth_desc;

fg_status truth_render(const bench *b, const truth_desc *desc, truth *out);
void truth_finish(truth *t);
fg_status truth_compare(const bench *b, const truth *t, const image *picture, truth_error *out);
// With --pictures: FOLDER/NAME.png, and FOLDER/NAME_error.png with full colour at half the truth's
// RMS.
fg_status truth_write(const bench *b, const truth *t, const image *picture, const char *name);

#endif // BENCH_H
