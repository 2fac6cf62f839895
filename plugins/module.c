// SPDX-License-Identifier: MIT
#include "module_priv.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// What links a module writes it in pieces, but not with longer pauses than this.
static const int64_t settle_ns = 250000000;

static int64_t to_ns(struct timespec t)
{
    return (int64_t) t.tv_sec * 1000000000 + t.tv_nsec;
}

static module_stamp stamp_of(const struct stat *st)
{
    return (module_stamp){ st->st_dev, st->st_ino, st->st_size, st->st_mtim, st->st_ctim };
}

module_stamp module_look(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0 ? stamp_of(&st) : (module_stamp){ 0 };
}

bool module_same(const module_stamp *a, const module_stamp *b)
{
    return a->device == b->device && a->inode == b->inode && a->size == b->size &&
           to_ns(a->modified) == to_ns(b->modified) && to_ns(a->changed) == to_ns(b->changed);
}

int64_t module_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return to_ns(t);
}

bool module_settled(const module_stamp *stamp, int64_t since)
{
    struct timespec wall;
    if (module_now() - since >= settle_ns)
        return true;
    clock_gettime(CLOCK_REALTIME, &wall);
    return stamp->inode && to_ns(wall) - to_ns(stamp->changed) >= settle_ns;
}

// ---- what the loader would not survive -----------------------------------------------

static bool within(uint64_t offset, uint64_t size, off_t file)
{
    return offset <= (uint64_t) file && size <= (uint64_t) file - offset;
}

// The loader maps what the headers say and dies on pages that the file does not have. NULL, or
// what is wrong.
static const char *check_elf(int fd, off_t size)
{
    ElfW(Ehdr) head;
    if (pread(fd, &head, sizeof head, 0) != (ssize_t) sizeof head ||
        memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 || head.e_type != ET_DYN ||
        head.e_ident[EI_CLASS] != (sizeof(void *) == 8 ? ELFCLASS64 : ELFCLASS32) ||
        head.e_phentsize != sizeof(ElfW(Phdr)))
        return "is no shared object of this machine";
    // The table of sections stands last: a file that has it was written to its end.
    if (!within(head.e_shoff, (uint64_t) head.e_shnum * head.e_shentsize, size))
        return "is cut short";
    for (int i = 0; i < head.e_phnum; ++i) {
        ElfW(Phdr) part;
        const uint64_t at = head.e_phoff + (uint64_t) i * sizeof part;
        if (!within(at, sizeof part, size) ||
            pread(fd, &part, sizeof part, (off_t) at) != (ssize_t) sizeof part ||
            (part.p_type == PT_LOAD && !within(part.p_offset, part.p_filesz, size)))
            return "is cut short";
    }
    return NULL;
}

// ---- a copy --------------------------------------------------------------------------

// NULL, or what failed, with errno. A file that grows or shrinks meanwhile gives a copy that is
// found to be none.
static const char *copy_bytes(int from, int to)
{
    char buffer[65536];
    ssize_t n;
    for (off_t at = 0; (n = pread(from, buffer, sizeof buffer, at)) != 0; at += n) {
        if (n < 0)
            return "cannot be read";
        for (ssize_t done = 0, some; done < n; done += some)
            if ((some = write(to, buffer + done, (size_t) (n - done))) < 0)
                return "cannot be copied";
    }
    return NULL;
}

// A new file beside the module, so that $ORIGIN means the same; where that folder cannot be
// written, in the folder for temporary files. A name starting with '.' is no plugin's.
static int create_copy(const char *path, char **copy)
{
    const char *slash = strrchr(path, '/');
    const int folder = slash ? (int) (slash - path) + 1 : 0;
    const char *temporary = getenv("TMPDIR");
    if (asprintf(copy, "%.*s.%s.XXXXXX", folder, path, path + folder) < 0) {
        *copy = NULL;
        return -1;
    }
    int fd = mkostemp(*copy, O_CLOEXEC);
    if (fd >= 0)
        return fd;
    free(*copy);
    if (asprintf(copy, "%s/gi_module.XXXXXX", temporary && *temporary ? temporary : "/tmp") < 0) {
        *copy = NULL;
        return -1;
    }
    fd = mkostemp(*copy, O_CLOEXEC);
    return fd;
}

// ---- opening -------------------------------------------------------------------------

static void refuse(const fg_log *log, const char *name, const char *path, const char *why)
{
    fg_logf(log, FG_LOG_ERROR, "plugin %s: cannot be loaded: %.600s %s%s%s", name, path, why,
            errno ? ": " : "", errno ? strerror(errno) : "");
}

// The loader's own words, in which the copy has the name of what it is a copy of.
static void *load(const fg_log *log, const char *name, const char *path, const char *copy)
{
    void *module = dlopen(copy ? copy : path, RTLD_NOW | RTLD_LOCAL);
    if (module)
        return module;
    const char *why = dlerror();
    const size_t length = copy ? strlen(copy) : 0;
    const bool named = length && why && !strncmp(why, copy, length);
    fg_logf(log, FG_LOG_ERROR, "plugin %s: cannot be loaded: %.600s%s", name, named ? path : "",
            why ? why + (named ? length : 0) : "");
    return NULL;
}

static void *load_copy(const fg_log *log, const char *name, const char *path, int from,
                       const module_stamp *stamp)
{
    struct stat before, after;
    char *copy = NULL;
    void *module = NULL;
    errno = 0;
    const int to = create_copy(path, &copy);
    const char *why = to >= 0 ? copy_bytes(from, to) : "cannot be copied";
    if (!why) {
        errno = 0;
        why = fstat(to, &after) ? "cannot be copied" : check_elf(to, after.st_size);
    }
    if (!why && fstat(from, &before) == 0) {
        const module_stamp now = stamp_of(&before);
        why = module_same(stamp, &now) ? NULL : "is being written";
    }
    if (why)
        refuse(log, name, path, why);
    else
        module = load(log, name, path, copy);
    if (to >= 0) {
        close(to);
        unlink(copy);
    }
    free(copy);
    return module;
}

void *module_open(const fg_log *log, const char *name, const char *path, bool copy,
                  module_stamp *stamp)
{
    struct stat st;
    void *module = NULL;
    *stamp = (module_stamp){ 0 };
    errno = 0;
    const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); // a pipe would wait
    if (fd < 0 || fstat(fd, &st)) {
        refuse(log, name, path, "cannot be read");
        if (fd >= 0)
            close(fd);
        return NULL;
    }
    *stamp = stamp_of(&st);
    const char *why = S_ISREG(st.st_mode) ? check_elf(fd, st.st_size) : "is no regular file";
    if (why)
        refuse(log, name, path, why);
    else
        module = copy ? load_copy(log, name, path, fd, stamp) : load(log, name, path, NULL);
    close(fd);
    return module;
}
