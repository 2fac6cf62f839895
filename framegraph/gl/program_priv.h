// SPDX-License-Identifier: MIT
#ifndef FG_PROGRAM_PRIV_H
#define FG_PROGRAM_PRIV_H

#include "gl_priv.h"

#include <sys/stat.h>
#include <sys/types.h>

enum { PROGRAM_STAGES = 3 };

// FNV-1a, 64 bits; `hash` continues an earlier one.
#define PROGRAM_HASH_SEED UINT64_C(14695981039346656037)
uint64_t program_hash(uint64_t hash, const void *bytes, size_t size);

// ---- source text from disk (development) ------------------------------------------

// A file as it was when it was read.
typedef struct source_file {
    char *path; // as it was opened
    dev_t device;
    ino_t inode; // both 0: it could not be read
    off_t size;
    struct timespec time;
} source_file;

// The files that a program was built from.
typedef struct source_files {
    source_file *files;
    int count, capacity;
} source_files;

void source_files_clear(source_files *f);
bool source_files_changed(const source_files *f); // since they were read

bool source_exists(const char *dir, const char *name);

// The text of shader `name` below `dir` with its includes expanded by the rules of
// embed_glsl.py; appends the files it consists of to `files`, on failure too. NULL
// with a line in the log if one is missing. The caller frees it.
char *source_read(const char *dir, const char *name, source_files *files, const fg_log *log);

// ---- binaries -----------------------------------------------------------------------

typedef struct program_key {
    uint64_t half[2];
} program_key;

// 0 if there is none, or none that this driver takes.
GLuint binary_load(const char *dir, program_key key, const fg_log *log);
void binary_save(const char *dir, program_key key, GLuint program, const fg_log *log);

#endif // FG_PROGRAM_PRIV_H
