// SPDX-License-Identifier: MIT
#ifndef TESTS_GRAPH_RIG_H
#define TESTS_GRAPH_RIG_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <fg/device.h>
#include <stdlib.h>
#include <string.h>

// A graph on a recording null device, with all that it said and all that it ran.
typedef struct rig {
    fg_device *dev;
    fg_graph *g;
    fg_log log;
    char said[1 << 16];  // a line a message
    char trace[1 << 12]; // names of passes as they ran, each followed by a blank
} rig;

rig *rig_open(unsigned debug);
rig *rig_open_with(fg_graph_desc desc, const fg_null_desc *null); // device and log are set here
void rig_close(rig *r); // nothing may be left on the device

// A declaration for a frame of 64x64 with nothing special; forgets what was said and run.
void rig_begin(rig *r);
void rig_forget(rig *r);
fg_res rig_tex(rig *r, const char *name); // RGBA16F of the frame's size
fg_res rig_buf(rig *r, const char *name); // 256 bytes

fg_status rig_note(const fg_run *run, void *user); // callback; user: the rig

void rig_must_compile(rig *r);
void rig_must_run(rig *r); // forgets the trace and the device's log first
void rig_must_fail(rig *r, fg_status status, const char *text);
void rig_must_have_said(const rig *r, const char *text);
const char *rig_why(const rig *r, const char *pass); // why it was left out; NULL if it was not
char *rig_dump(const rig *r, fg_dump format);
int rig_count(const char *text, const char *part);

#define PASS(r, ...)                                                                               \
    {                                                                                              \
        .run = rig_note, .user = (r), .name = __VA_ARGS__                                          \
    }
#define SHOW .effect = FG_EFFECT_EXTERNAL
#define PASSES(r, ...)                                                                             \
    do {                                                                                           \
        const fg_pass_desc passes_[] = { __VA_ARGS__ };                                            \
        fg_passes((r)->g, passes_, FG_COUNT(passes_));                                             \
    } while (0)

#endif // TESTS_GRAPH_RIG_H
