// SPDX-License-Identifier: MIT
#ifndef BENCH_ISR_H
#define BENCH_ISR_H

#include "renderer.h"

#include <stdio.h>

// What bench_isr's files share: a scene, techniques at their settings ("sides") that run frames in
// turn in one process, and figures, which are printed as `BENCH name scene size value unit`.

enum { MAX_NAMES = 16, MAX_FRAMES = 32, MAX_PASSES = 48 };

typedef struct bench {
    fg_log log;
    fg_gl_context *context;
    fg_device *device;
    gi_registry *registry;
    ag_scene *scene;
    const char *scene_name;
    ag_camera camera; // where has_camera, else the scene's first
    bool has_camera;
    int size; // pixels along an edge
    bool verbose;
    const char *names[MAX_NAMES]; // figures asked for, or how they begin; none: all
    int name_count;
} bench;

bool bench_wants(const bench *b, const char *figure);
// Whether any figure of a list that ends at NULL is wanted.
bool bench_wants_any(const bench *b, const char *const *figures);
// Prints a figure that is wanted. A value that is not finite is a line on stderr instead.
void bench_print(const bench *b, const char *figure, int size, double value, const char *unit);
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
    const char *plugin;
    const char *values; // "vpls=256 share=0": what departs from the defaults
    bool picture;       // its indirect layer is to be read
    const gi_plugin *table;
    gi_value *set;
    renderer *r;
    samples frame;
    pass_time passes[MAX_PASSES];
    int pass_count;
} side;

// Finds the plugin and makes a renderer of the bench's scene. FG_ERR_UNSUPPORTED, with a line on
// stderr: there is no such plugin, or it has no such parameter.
fg_status side_open(const bench *b, side *s, ag_scene *scene, int size);
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
void side_list(const bench *b, const side *s); // a table on stderr

bool step_is_gather(const char *step);
bool step_is_map(const char *step);   // draws a reflective shadow map
bool step_is_fixed(const char *step); // neither of both

// ---- figures ---------------------------------------------------------------------------------

fg_status bench_times(const bench *b);
fg_status bench_errors(const bench *b);
fg_status bench_pairs(const bench *b);
fg_status bench_hisr(const bench *b);
fg_status bench_flicker(const bench *b);

// ---- a full-screen copy ----------------------------------------------------------------------

// One RGBA16F texel read, one written, by compute and by raster, as passes of a graph.
typedef struct copy {
    fg_graph *graph;
    uint32_t source;
    fg_res from, to[2];
    samples ms[2]; // compute, raster
} copy;

fg_status copy_open(const bench *b, copy *c);
void copy_close(copy *c); // accepts a zeroed one
fg_status copy_frame(const bench *b, copy *c);

#endif // BENCH_ISR_H
