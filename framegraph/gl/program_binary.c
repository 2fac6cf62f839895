// SPDX-License-Identifier: MIT
#include "program_priv.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// A driver may crash on a binary that is not what it wrote: the sum guards it.
typedef struct header {
    char magic[8];
    uint64_t key[2];
    uint64_t sum; // program_hash() of the bytes that follow
    uint32_t format, length;
} header;
_Static_assert(sizeof(header) == 40, "no padding");

static const char magic[8] = "FGPROG1";

enum { MAX_BINARY = 1 << 28, MAX_PATH = 1024 };

static bool path_of(char path[MAX_PATH], const char *dir, program_key key)
{
    const int length = snprintf(path, MAX_PATH, "%s/%016llx%016llx.bin", dir,
                                (unsigned long long) key.half[0], (unsigned long long) key.half[1]);
    return length < MAX_PATH;
}

static bool takes_format(GLenum format)
{
    GLint formats[64] = { 0 }, count = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
    if (count > FG_COUNT(formats))
        return false;
    glGetIntegerv(GL_PROGRAM_BINARY_FORMATS, formats);
    for (int i = 0; i < count; ++i)
        if (formats[i] == (GLint) format)
            return true;
    return false;
}

// The bytes after the header, or NULL if anything in the file is not as it was written.
static void *read_file(FILE *f, program_key key, header *h)
{
    if (fread(h, sizeof *h, 1, f) != 1 || memcmp(h->magic, magic, sizeof magic) != 0 ||
        h->key[0] != key.half[0] || h->key[1] != key.half[1] || h->length == 0 ||
        h->length > MAX_BINARY)
        return NULL;
    void *bytes = malloc(h->length);
    const bool whole = bytes && fread(bytes, 1, h->length, f) == h->length && fgetc(f) == EOF;
    if (whole && program_hash(PROGRAM_HASH_SEED, bytes, h->length) == h->sum)
        return bytes;
    free(bytes);
    return NULL;
}

GLuint binary_load(const char *dir, program_key key, const fg_log *log)
{
    char path[MAX_PATH];
    header h;
    GLint done = 0;
    if (!path_of(path, dir, key))
        return 0;
    FILE *f = fopen(path, "rb");
    if (!f)
        return 0;
    void *bytes = read_file(f, key, &h);
    fclose(f);
    GLuint program = 0;
    if (bytes && takes_format(h.format)) {
        program = glCreateProgram();
        glProgramBinary(program, h.format, bytes, (GLsizei) h.length);
        glGetProgramiv(program, GL_LINK_STATUS, &done);
    }
    free(bytes);
    if (done)
        return program;
    glDeleteProgram(program);
    fg_logf(log, FG_LOG_INFO, "%s: not a program of this driver, built anew", path);
    return 0;
}

static bool write_file(const char *path, const header *h, const void *bytes)
{
    FILE *f = fopen(path, "wb");
    if (!f)
        return false;
    bool done = fwrite(h, sizeof *h, 1, f) == 1 && fwrite(bytes, 1, h->length, f) == h->length;
    done = fclose(f) == 0 && done;
    return done;
}

void binary_save(const char *dir, program_key key, GLuint program, const fg_log *log)
{
    char path[MAX_PATH], beside[MAX_PATH + 32];
    header h = { .key = { key.half[0], key.half[1] } };
    GLint size = 0;
    GLsizei length = 0;
    GLenum format = 0;

    glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
    if (size <= 0 || size > MAX_BINARY || !path_of(path, dir, key))
        return;
    void *bytes = malloc((size_t) size);
    if (!bytes)
        return;
    glGetProgramBinary(program, size, &length, &format, bytes);
    memcpy(h.magic, magic, sizeof magic);
    h.format = format;
    h.length = (uint32_t) length;
    h.sum = program_hash(PROGRAM_HASH_SEED, bytes, h.length);
    snprintf(beside, sizeof beside, "%s.%ld", path, (long) getpid());

    const bool folder = mkdir(dir, 0777) == 0 || errno == EEXIST;
    if (!folder || !write_file(beside, &h, bytes) || rename(beside, path)) {
        fg_logf(log, FG_LOG_WARN, "%s: cannot be written: %s", path, strerror(errno));
        unlink(beside);
    }
    free(bytes);
}
