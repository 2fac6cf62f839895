// SPDX-License-Identifier: MIT
#include "program_priv.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_INCLUDE_DEPTH = 32, MAX_PATH = 1024, MAX_SOURCE = 1 << 24 };

typedef struct text {
    char *bytes;
    size_t length, capacity;
    bool failed; // out of memory
} text;

typedef struct reader {
    const char *dir;
    const fg_log *log;
    source_files *files;
    int first; // of `files` that belong to this shader
    text out;
} reader;

static void append(text *t, const char *bytes, size_t length)
{
    if (t->failed)
        return;
    if (!t->bytes || t->length + length + 1 > t->capacity) {
        const size_t capacity = 2 * (t->length + length + 1);
        char *more = realloc(t->bytes, capacity);
        if (!more) {
            t->failed = true;
            return;
        }
        t->bytes = more;
        t->capacity = capacity;
    }
    memcpy(t->bytes + t->length, bytes, length);
    t->length += length;
    t->bytes[t->length] = '\0';
}

static void append_line_number(text *t, int number)
{
    char line[32];
    append(t, line, (size_t) snprintf(line, sizeof line, "#line %d\n", number));
}

// ---- files ----------------------------------------------------------------------

void source_files_clear(source_files *f)
{
    for (int i = 0; i < f->count; ++i)
        free(f->files[i].path);
    free(f->files);
    *f = (source_files){ 0 };
}

static bool differs(const source_file *f, const struct stat *now)
{
    return f->device != now->st_dev || f->inode != now->st_ino || f->size != now->st_size ||
           f->time.tv_sec != now->st_mtim.tv_sec || f->time.tv_nsec != now->st_mtim.tv_nsec;
}

bool source_files_changed(const source_files *f)
{
    for (int i = 0; i < f->count; ++i) {
        struct stat now = { 0 };
        if (stat(f->files[i].path, &now))
            now = (struct stat){ 0 }; // gone: a change only if it was there
        if (differs(&f->files[i], &now))
            return true;
    }
    return false;
}

// Notes `path` as it is now.
static bool note(source_files *f, const char *path)
{
    struct stat now = { 0 };
    if (f->count == f->capacity) {
        const int capacity = f->capacity ? 2 * f->capacity : 8;
        source_file *more = realloc(f->files, (size_t) capacity * sizeof *more);
        if (!more)
            return false;
        f->files = more;
        f->capacity = capacity;
    }
    source_file *to = &f->files[f->count];
    if (stat(path, &now))
        now = (struct stat){ 0 };
    *to = (source_file){ .path = strdup(path),
                         .device = now.st_dev,
                         .inode = now.st_ino,
                         .size = now.st_size,
                         .time = now.st_mtim };
    f->count += to->path != NULL;
    return to->path != NULL;
}

static bool seen(const reader *r, const char *path)
{
    struct stat now;
    if (stat(path, &now))
        return false;
    for (int i = r->first; i < r->files->count; ++i)
        if (r->files->files[i].device == now.st_dev && r->files->files[i].inode == now.st_ino)
            return true;
    return false;
}

static char *read_all(const char *path)
{
    FILE *f = fopen(path, "rb");
    if (!f)
        return NULL;
    struct stat now;
    char *bytes = NULL;
    if (!fstat(fileno(f), &now) && S_ISREG(now.st_mode) && now.st_size <= MAX_SOURCE)
        bytes = malloc((size_t) now.st_size + 1);
    if (bytes)
        bytes[fread(bytes, 1, (size_t) now.st_size, f)] = '\0';
    fclose(f);
    return bytes;
}

// ---- includes -------------------------------------------------------------------

static bool expand(reader *r, const char *path, int depth);

// The name in an #include line, or NULL if the line is none.
static const char *include_name(const char *line, size_t length, size_t *name_length)
{
    const char *at = line + strspn(line, " \t"), *end = line + length;
    if (at + 8 > end || strncmp(at, "#include", 8) != 0)
        return NULL;
    at += 8;
    const char *quote = at + strspn(at, " \t");
    if (quote == at || quote >= end || *quote != '"')
        return NULL;
    const char *close = memchr(quote + 1, '"', (size_t) (end - quote - 1));
    if (!close || close == quote + 1)
        return NULL;
    *name_length = (size_t) (close - quote - 1);
    return quote + 1;
}

// Beside the including file, then below the root.
static bool find_include(const reader *r, const char *from, const char *name, int length,
                         char path[MAX_PATH])
{
    struct stat there;
    const char *slash = strrchr(from, '/');
    snprintf(path, MAX_PATH, "%.*s/%.*s", (int) (slash - from), from, length, name);
    if (!stat(path, &there))
        return true;
    snprintf(path, MAX_PATH, "%s/%.*s", r->dir, length, name);
    return !stat(path, &there);
}

static bool include(reader *r, const char *from, int number, const char *name, int length,
                    int depth)
{
    char path[MAX_PATH];
    if (!find_include(r, from, name, length, path)) {
        fg_logf(r->log, FG_LOG_ERROR, "%s:%d: no file %.*s", from, number, length, name);
        return false;
    }
    if (seen(r, path))
        return true;
    append_line_number(&r->out, 1);
    if (!expand(r, path, depth + 1))
        return false;
    append_line_number(&r->out, number + 1);
    return true;
}

static bool expand_lines(reader *r, const char *path, const char *bytes, int depth)
{
    int number = 0;
    while (*bytes) {
        const size_t length = strcspn(bytes, "\n");
        size_t name_length;
        const char *name = include_name(bytes, length, &name_length);
        ++number;
        if (!name) {
            append(&r->out, bytes, length);
            append(&r->out, "\n", 1);
        } else if (!include(r, path, number, name, (int) name_length, depth)) {
            return false;
        }
        bytes += length + (bytes[length] == '\n');
    }
    return true;
}

static bool expand(reader *r, const char *path, int depth)
{
    bool done = false;
    const bool noted = note(r->files, path);
    char *bytes = noted && depth < MAX_INCLUDE_DEPTH ? read_all(path) : NULL;
    if (bytes)
        done = expand_lines(r, path, bytes, depth);
    else
        fg_logf(r->log, FG_LOG_ERROR, "%s: cannot be read", path);
    free(bytes);
    return done;
}

bool source_exists(const char *dir, const char *name)
{
    char path[MAX_PATH];
    struct stat there;
    snprintf(path, sizeof path, "%s/%s", dir, name);
    return stat(path, &there) == 0;
}

char *source_read(const char *dir, const char *name, source_files *files, const fg_log *log)
{
    static const char version[] = "#version 450 core\n";
    char path[MAX_PATH];
    reader r = { .dir = dir, .log = log, .files = files, .first = files->count };

    snprintf(path, sizeof path, "%s/%s", dir, name);
    if (!expand(&r, path, 0))
        goto fail;
    if (r.out.failed || !r.out.bytes) {
        fg_logf(log, FG_LOG_ERROR, "%s: %s", path, r.out.failed ? "out of memory" : "is empty");
        goto fail;
    }
    if (strncmp(r.out.bytes, version, sizeof version - 1) != 0) {
        fg_logf(log, FG_LOG_ERROR, "%s:1: the first line must be \"#version 450 core\"", path);
        goto fail;
    }
    return r.out.bytes;

fail:
    free(r.out.bytes);
    return NULL;
}
