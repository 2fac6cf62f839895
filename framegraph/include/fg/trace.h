// SPDX-License-Identifier: MIT
#ifndef FG_TRACE_H
#define FG_TRACE_H

#include <fg/graph.h>

FG_BEGIN

// The frames of a graph as a trace that Perfetto and chrome://tracing show: a track of the CPU and
// one of the GPU, an event a frame and within it one a pass, memory as a counter.
//
//     fg_trace *t = fg_trace_create(&(fg_trace_desc){ .log = &log, .process = "host" });
//     for each frame:
//         fg_graph_run(g);
//         fg_trace_frame(t, g, "rsm");
//         size_t size;
//         const char *text = fg_trace_text(t, &size);      // JSON that has come since
//         fwrite(text, 1, size, file);
//     fg_gl_finish(dev);                                   // the GPU's times of the last frames
//     fg_trace_frame(t, g, "rsm");
//     fg_trace_end(t); ... fg_trace_text() ...
//     fg_trace_destroy(t);
//
// Times are CLOCK_MONOTONIC's since fg_trace_create(), in microseconds. A GPU's clock was set
// against it once, when the device was created: one drifts from the other by some microseconds a
// second. Where the device says that it is software (fg/gl.h), the GPU's track is the same clock,
// with a glFinish() at either end of a pass.
// GPU times come some frames later. They are missing of frames that were under way when the graph
// compiled anew, and of those that went untimed because the GPU was too far behind.
//
// Thread: that of the graph. One trace is of one graph.
typedef struct fg_trace fg_trace;

typedef struct fg_trace_desc {
    const fg_log *log;      // Optional. Borrowed.
    fg_allocator allocator; // Zero means malloc.
    const char *process;    // name of the process in the trace; NULL: "frame graph"
} fg_trace_desc;

// NULL when out of memory (logged).
FG_API fg_trace *fg_trace_create(const fg_trace_desc *desc);
FG_API void fg_trace_destroy(fg_trace *t); // accepts NULL

// Adds the last frame that ran, unless it is there already, and what GPU times have come back.
// `label` says what the frame showed, e.g. a plugin; NULL: nothing to say. Where it is another
// than the frame before had, an instant event marks that.
FG_API void fg_trace_frame(fg_trace *t, const fg_graph *g, const char *label);

// An instant event now, across all tracks: "resized".
FG_API void fg_trace_mark(fg_trace *t, const char *name);

// A value of the counter `name` from now on.
FG_API void fg_trace_count(fg_trace *t, const char *name, double value);

// Closes the JSON. Nothing can be added after it.
FG_API void fg_trace_end(fg_trace *t);

// What was added since the last call, to be appended to what that gave; valid until the next call
// on the trace. NULL when out of memory (logged): the trace is lost.
FG_API const char *fg_trace_text(fg_trace *t, size_t *size);

FG_END

#endif // FG_TRACE_H
