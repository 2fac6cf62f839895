// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static void keep(void *user, fg_log_level level, const char *msg)
{
    fixture *f = user;
    const size_t used = strlen(f->said);
    (void) level;
    snprintf(f->said + used, sizeof f->said - used, "%s\n", msg);
}

void fixture_open(fixture *f, const fg_gl_device_desc *desc)
{
    *f = (fixture){ .log = { keep, f, FG_LOG_WARN } };
    fg_gl_device_desc with_log = desc ? *desc : (fg_gl_device_desc){ 0 };
    with_log.log = &f->log;
    const fg_gl_context_desc context = { .log = &f->log, .debug = true };
    if (fg_gl_context_create(&context, &f->context))
        fail_msg("no GL context: %s", f->said);
    if (fg_gl_device_create(&with_log, &f->device))
        fail_msg("no gl device: %s", f->said);
}

void fixture_close(fixture *f)
{
    const int errors = fg_gl_error_count(f->device);
    const GLenum error = glGetError();
    fg_device_destroy(f->device);
    fg_gl_context_destroy(f->context);
    assert_string_equal(f->said, "");
    assert_int_equal(error, GL_NO_ERROR);
    assert_int_equal(errors, f->provoked);
}

int open_gl(void **state)
{
    fixture *f = malloc(sizeof *f);
    assert_non_null(f);
    fixture_open(f, NULL);
    *state = f;
    return 0;
}

int close_gl(void **state)
{
    fixture_close(*state);
    free(*state);
    return 0;
}

void log_takes(fixture *f, const char *text)
{
    if (!strstr(f->said, text))
        fail_msg("the log has no \"%s\" but: %s", text, f->said);
    f->said[0] = '\0';
}

fg_graph *open_graph(fixture *f, unsigned debug, uint64_t seed)
{
    const fg_graph_desc desc = {
        .device = f->device,
        .log = &f->log,
        .debug = debug,
        .seed = seed,
    };
    fg_graph *g = fg_graph_create(&desc);
    assert_non_null(g);
    return g;
}

fg_status use_program(const fg_run *run, const fg_gl_program_desc *desc)
{
    const uint32_t program = fg_gl_program(fg_run_device(run), desc);
    glUseProgram(program);
    return program ? FG_OK : FG_ERR_SHADER;
}

static int framebuffers;
static PFNGLDELETEFRAMEBUFFERSPROC real_delete;

static void GLAPIENTRY counting_delete(GLsizei n, const GLuint *names)
{
    framebuffers += n;
    real_delete(n, names);
}

void count_deleted_framebuffers(void)
{
    glDeleteFramebuffers(0, NULL); // libepoxy's pointer finds the real one in its first call
    real_delete = epoxy_glDeleteFramebuffers;
    epoxy_glDeleteFramebuffers = counting_delete;
    framebuffers = 0;
}

int deleted_framebuffers(void)
{
    epoxy_glDeleteFramebuffers = real_delete;
    return framebuffers;
}

void read_floats(uint32_t texture, float *to, int count)
{
    assert_int_not_equal(texture, 0);
    glGetTextureImage(texture, 0, GL_RED, GL_FLOAT, (GLsizei) ((size_t) count * sizeof *to), to);
}

void make_folder(char path[256])
{
    const char *base = getenv("TMPDIR");
    snprintf(path, 256, "%s/fg-gl-test-XXXXXX", base ? base : P_tmpdir);
    assert_non_null(mkdtemp(path));
}

void remove_folder(const char *path)
{
    char name[600];
    DIR *folder = opendir(path);
    for (struct dirent *e = folder ? readdir(folder) : NULL; e; e = readdir(folder)) {
        if (e->d_name[0] == '.')
            continue;
        snprintf(name, sizeof name, "%s/%s", path, e->d_name);
        if (unlink(name))
            remove_folder(name);
    }
    if (folder)
        closedir(folder);
    rmdir(path);
}

void write_text(const char *folder, const char *name, const char *text)
{
    char path[600];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_true(fputs(text, f) >= 0);
    assert_int_equal(fclose(f), 0);
}
