// SPDX-License-Identifier: MIT
#ifndef GI_MODULE_PRIV_H
#define GI_MODULE_PRIV_H

#include <fg/base.h>

#include <sys/types.h>
#include <time.h>

// A shared module's file, and what of it is in memory.

// How a file looks from outside. All zero: it is not there.
typedef struct module_stamp {
    dev_t device;
    ino_t inode;
    off_t size;
    struct timespec modified, changed;
} module_stamp;

module_stamp module_look(const char *path);
bool module_same(const module_stamp *a, const module_stamp *b);

// Whether the file has been as it is for so long that nobody is writing it any more. `since` is
// when it was first seen like this, by module_now(): file systems' clocks may be wrong.
bool module_settled(const module_stamp *stamp, int64_t since);
int64_t module_now(void); // ns, of a clock that only goes on

// Opens the module; `stamp` is the file that was read. With `copy` from a copy of its own, whose
// name is gone again on return. NULL, with a line that names plugin and file: it is not there, no
// shared object, cut short, being written, or the loader refuses it.
void *module_open(const fg_log *log, const char *name, const char *path, bool copy,
                  module_stamp *stamp);

#endif // GI_MODULE_PRIV_H
