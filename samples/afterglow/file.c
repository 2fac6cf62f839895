// SPDX-License-Identifier: MIT
#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static fg_status cannot(const fg_log *log, const char *path, const char *what, int error)
{
    fg_logf(log, FG_LOG_ERROR, "%.600s: cannot %s: %s", path, what, strerror(error));
    return error == ENOMEM ? FG_ERR_MEMORY : FG_ERR_IO;
}

// A new file of its own name beside `f->path`.
static int open_beside(file *f)
{
    enum { TRIES = 100 };
    const size_t size = strlen(f->path) + 48;
    f->beside = malloc(size);
    if (!f->beside) {
        errno = ENOMEM;
        return -1;
    }
    for (int i = 0; i < TRIES; ++i) {
        snprintf(f->beside, size, "%s.%ld.%d.tmp", f->path, (long) getpid(), i);
        const int fd = open(f->beside, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0 || errno != EEXIST)
            return fd;
    }
    return -1;
}

static int open_target(const char *path, file *out)
{
    struct stat st;
    const bool there = stat(path, &st) == 0;
    if (there && S_ISDIR(st.st_mode)) {
        errno = EISDIR;
        return -1;
    }
    const bool regular = !there || S_ISREG(st.st_mode);
    out->path = there && regular ? realpath(path, NULL) : strdup(path);
    if (!out->path)
        return -1;
    return regular ? open_beside(out) : open(path, O_WRONLY | O_CLOEXEC);
}

static void forget(file *f)
{
    free(f->path);
    free(f->beside);
    *f = (file){ 0 };
}

fg_status file_begin(const fg_log *log, const char *path, file *out)
{
    *out = (file){ 0 };
    const int fd = open_target(path, out);
    if (fd >= 0)
        out->stream = fdopen(fd, out->beside ? "w+b" : "wb");
    if (out->stream)
        return FG_OK;
    const fg_status status = cannot(log, path, "write", errno);
    if (fd >= 0) {
        close(fd);
        if (out->beside)
            unlink(out->beside);
    }
    forget(out);
    return status;
}

fg_status file_end(const fg_log *log, file *f, bool keep)
{
    fg_status status = FG_OK;
    const bool failed = ferror(f->stream) != 0;
    errno = 0;
    bool written = fclose(f->stream) == 0 && !failed;
    if (f->beside) {
        written = keep && written && rename(f->beside, f->path) == 0;
        if (!written) {
            const int error = errno;
            unlink(f->beside);
            errno = error;
        }
    }
    if (keep && !written)
        status = cannot(log, f->path, "write", errno ? errno : EIO);
    forget(f);
    return status;
}

fg_status file_check(const fg_log *log, const char *path)
{
    file f;
    struct stat st;
    // Who reads a pipe would take its being opened and closed for an empty result.
    if (stat(path, &st) == 0 && S_ISFIFO(st.st_mode))
        return access(path, W_OK) == 0 ? FG_OK : cannot(log, path, "write", errno);
    const fg_status status = file_begin(log, path, &f);
    return status != FG_OK ? status : file_end(log, &f, false);
}

fg_status file_write(const fg_log *log, const char *path, const void *data, size_t size)
{
    file f;
    const fg_status status = file_begin(log, path, &f);
    if (status != FG_OK)
        return status;
    fwrite(data, 1, size, f.stream);
    return file_end(log, &f, true);
}

fg_status file_write_text(const fg_log *log, const char *path, char *text)
{
    fg_status status = FG_ERR_MEMORY;
    if (text)
        status = file_write(log, path, text, strlen(text));
    else
        fg_logf(log, FG_LOG_ERROR, "%s: out of memory", path);
    free(text);
    return status;
}

static fg_status refuse(const fg_log *log, const char *path, const char *why)
{
    fg_logf(log, FG_LOG_ERROR, "%.600s: cannot read: %s", path, why);
    return FG_ERR_INPUT;
}

fg_status file_read(const fg_log *log, const char *path, size_t max, char **text, size_t *size)
{
    struct stat st;
    fg_status status = FG_OK;
    *text = NULL;
    FILE *f = fopen(path, "rbe");
    if (!f)
        return refuse(log, path, strerror(errno));
    if (fstat(fileno(f), &st) || !S_ISREG(st.st_mode))
        status = refuse(log, path, "not a regular file");
    else if (st.st_size < 0 || (uint64_t) st.st_size > max)
        status = refuse(log, path, "too large");
    else if (!(*text = malloc((size_t) st.st_size + 1)))
        status = FG_ERR_MEMORY;
    if (status == FG_OK) {
        *size = fread(*text, 1, (size_t) st.st_size, f);
        (*text)[*size] = 0;
        if (ferror(f)) {
            status = refuse(log, path, "read error");
            free(*text);
            *text = NULL;
        }
    }
    fclose(f);
    return status;
}

fg_status file_make_folder(const fg_log *log, const char *path)
{
    struct stat st;
    char part[PATH_MAX];
    const size_t length = strlen(path);
    if (!length || length >= sizeof part)
        return cannot(log, length ? path : "(empty name)", "make folder",
                      length ? ENAMETOOLONG : ENOENT);
    memcpy(part, path, length + 1);
    for (size_t i = 1; i <= length; ++i) {
        if (part[i] != '/' && part[i])
            continue;
        part[i] = 0;
        if (mkdir(part, 0777) && errno != EEXIST)
            return cannot(log, path, "make folder", errno);
        part[i] = path[i];
    }
    if (stat(path, &st) || !S_ISDIR(st.st_mode))
        return cannot(log, path, "make folder", ENOTDIR);
    return FG_OK;
}

fg_status file_copy(const fg_log *log, const char *from, const char *to)
{
    enum { MAX = 1 << 30 };
    char *data;
    size_t size;
    fg_status status = file_read(log, from, MAX, &data, &size);
    if (status != FG_OK)
        return status;
    status = file_write(log, to, data, size);
    free(data);
    return status;
}
