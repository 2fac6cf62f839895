// SPDX-License-Identifier: MIT
#ifndef FG_BASE_H
#define FG_BASE_H

// What every header of the project shares: status, log, allocator, linkage.

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define FG_BEGIN extern "C" {
#define FG_END }
#else
#define FG_BEGIN
#define FG_END
#endif

#if defined(__GNUC__)
#define FG_API __attribute__((visibility("default")))
#define FG_PRINTF(fmt, args) __attribute__((format(printf, fmt, args)))
#define FG_NODISCARD __attribute__((warn_unused_result))
#else
#define FG_API
#define FG_PRINTF(fmt, args)
#define FG_NODISCARD
#endif

#define FG_COUNT(array) ((int) (sizeof(array) / sizeof *(array)))

FG_BEGIN

// Outcome of every call that can fail. Zero is success; the reason, with the
// name of the thing at fault, its value and the rule, goes to the log.
typedef enum fg_status {
    FG_OK = 0,
    FG_ERR_INVALID,     // the caller broke a documented requirement
    FG_ERR_MEMORY,      // host or device allocation failed
    FG_ERR_SHADER,      // GLSL did not compile or link
    FG_ERR_UNSUPPORTED, // the driver or this build lacks a required feature
    FG_ERR_INPUT,       // a file or other outside input is broken and was refused
    FG_ERR_IO,          // the operating system could not read or write
    FG_ERR_DEVICE,      // the GPU context was lost or raised an error
    FG_ERR_EMPTY,       // nothing is left to run: every pass was culled
} fg_status;

// A static English phrase, e.g. "out of memory". Never NULL.
FG_API const char *fg_status_name(fg_status status);

typedef enum fg_log_level {
    FG_LOG_NONE = 0,
    FG_LOG_ERROR,
    FG_LOG_WARN,
    FG_LOG_INFO,
    FG_LOG_DEBUG,
} fg_log_level;

// Where messages go. Zero-initialised means silent. `msg` has no newline and
// is valid only during the call.
typedef struct fg_log {
    void (*fn)(void *user, fg_log_level level, const char *msg);
    void *user;
    fg_log_level level; // messages above this level are dropped
} fg_log;

// `log` may be NULL. Messages are cut at 1023 bytes.
FG_API void fg_logf(const fg_log *log, fg_log_level level, const char *fmt, ...) FG_PRINTF(3, 4);

// Host memory, in the manner of realloc: `size` 0 frees `ptr` and returns NULL,
// a NULL `ptr` allocates. Returns NULL on failure and leaves `ptr` as it was.
// A NULL `fn` means the C library's.
typedef struct fg_allocator {
    void *(*fn)(void *user, void *ptr, size_t size);
    void *user;
} fg_allocator;

FG_END

#endif // FG_BASE_H
