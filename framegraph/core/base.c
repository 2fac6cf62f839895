// SPDX-License-Identifier: MIT
#include <fg/base.h>
#include <stdarg.h>
#include <stdio.h>

const char *fg_status_name(fg_status status)
{
    switch (status) {
    case FG_OK: return "success";
    case FG_ERR_INVALID: return "invalid use";
    case FG_ERR_MEMORY: return "out of memory";
    case FG_ERR_SHADER: return "shader does not build";
    case FG_ERR_UNSUPPORTED: return "not supported here";
    case FG_ERR_INPUT: return "input refused";
    case FG_ERR_IO: return "cannot read or write";
    case FG_ERR_DEVICE: return "device failed";
    case FG_ERR_EMPTY: return "nothing to run";
    }
    return "unknown status";
}

void fg_logf(const fg_log *log, fg_log_level level, const char *fmt, ...)
{
    if (!log || !log->fn || level > log->level || level == FG_LOG_NONE)
        return;
    char msg[1024];
    va_list args;
    va_start(args, fmt);
    vsnprintf(msg, sizeof msg, fmt, args);
    va_end(args);
    log->fn(log->user, level, msg);
}
