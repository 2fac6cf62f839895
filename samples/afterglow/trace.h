// SPDX-License-Identifier: MIT
#ifndef TRACE_H
#define TRACE_H

#include "renderer.h"

FG_BEGIN

// --trace FILE: every frame as a Chrome or Perfetto trace (fg/trace.h), written as it comes.
//
//     status = trace_create(log, path, &t);          // path NULL: t is NULL, and all below do
//     nothing
//     ... renderer_frame(r, time); trace_frame(t, r) ...
//     status = trace_finish(t, device, r, true);      // the file is there only now
typedef struct trace trace;

// Errors: FG_ERR_IO names the file; FG_ERR_MEMORY.
FG_NODISCARD fg_status trace_create(const fg_log *log, const char *path, trace **out);

// After each frame of one renderer. Says which plugins it shows.
void trace_frame(trace *t, renderer *r);

// An instant event: "resized".
void trace_mark(trace *t, const char *name);

// Waits for the GPU's times of the last frames (`r` NULL: there is none), puts the file in its
// place if `keep`, and destroys.
FG_NODISCARD fg_status trace_finish(trace *t, fg_device *device, renderer *r, bool keep);

FG_END

#endif // TRACE_H
