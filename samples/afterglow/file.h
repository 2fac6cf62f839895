// SPDX-License-Identifier: MIT
#ifndef FILE_H
#define FILE_H

#include <fg/base.h>
#include <stdio.h>

FG_BEGIN

// Files that are either whole or not there: written beside, then renamed.
//
//     file out;
//     if (file_begin(log, "report.json", &out) == FG_OK) {
//         fputs(text, out.stream);
//         status = file_end(log, &out, true);
//     }
//
// Symbolic links are followed; one that leads nowhere is replaced. What is there and no regular
// file (a pipe, /dev/null) is written to directly.
typedef struct file {
    FILE *stream;        // read and write, binary
    char *path, *beside; // beside NULL: written directly
} file;

// Errors: FG_ERR_IO names path and reason; FG_ERR_MEMORY.
FG_NODISCARD fg_status file_begin(const fg_log *log, const char *path, file *out);

// Closes; puts the file in its place if `keep` and all was written, else removes it.
FG_NODISCARD fg_status file_end(const fg_log *log, file *f, bool keep);

// Whether `path` could be written now; leaves nothing behind. Errors as file_begin().
FG_NODISCARD fg_status file_check(const fg_log *log, const char *path);

FG_NODISCARD fg_status file_write(const fg_log *log, const char *path, const void *data,
                                  size_t size);
// A text made by malloc(), which is freed; NULL, where there was no memory for it, is
// FG_ERR_MEMORY.
FG_NODISCARD fg_status file_write_text(const fg_log *log, const char *path, char *text);

// The whole of a regular file of at most `max` bytes with a zero byte appended; free() it.
// FG_ERR_INPUT names path and reason.
FG_NODISCARD fg_status file_read(const fg_log *log, const char *path, size_t max, char **text,
                                 size_t *size);

// Makes the folder and those above it; one that is there will do. FG_ERR_IO.
FG_NODISCARD fg_status file_make_folder(const fg_log *log, const char *path);

FG_NODISCARD fg_status file_copy(const fg_log *log, const char *from, const char *to);

FG_END

#endif // FILE_H
