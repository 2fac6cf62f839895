// SPDX-License-Identifier: MIT
// The last message of a log, and how many there were, for tests that ask for one at a time.
#ifndef LAST_LOG_H
#define LAST_LOG_H

#include <fg/base.h>

#include <stdio.h>

static char last[1024];
static int lines;

static void remember(void *user, fg_log_level level, const char *msg)
{
    (void) user;
    (void) level;
    ++lines;
    snprintf(last, sizeof last, "%s", msg);
}

#endif // LAST_LOG_H
