// SPDX-License-Identifier: MIT
#ifndef TESTS_GL_FIXTURE_H
#define TESTS_GL_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <epoxy/gl.h>
#include <fg/device.h>
#include <fg/gl.h>
#include <string.h>

// A debug context and a gl device whose log is kept. No context is a failure, never a skip.

typedef struct fixture {
    fg_gl_context *context;
    fg_device *device;
    fg_log log;
    char said[8192]; // errors and warnings, a line each
    int provoked;    // GL errors that the test means to raise
} fixture;

// cmocka's setup and teardown; teardown fails on any GL error and on any error message
// that the test did not take with log_takes().
int open_gl(void **state);
int close_gl(void **state);

void fixture_open(fixture *f, const fg_gl_device_desc *desc); // `log` of desc is ignored
void fixture_close(fixture *f);

// Demands that the log holds `text` and empties it.
void log_takes(fixture *f, const char *text);

// A graph on the fixture's device.
fg_graph *open_graph(fixture *f, unsigned debug, uint64_t seed);

// Makes the program current; FG_ERR_SHADER if it does not build.
fg_status use_program(const fg_run *run, const fg_gl_program_desc *desc);

// Framebuffers deleted between the two calls.
void count_deleted_framebuffers(void);
int deleted_framebuffers(void);

// Mip 0 of a one-channel float texture.
void read_floats(uint32_t texture, float *to, int count);

// A new and empty folder below TMPDIR.
void make_folder(char path[256]);
void remove_folder(const char *path);
void write_text(const char *folder, const char *name, const char *text);

#endif // TESTS_GL_FIXTURE_H
