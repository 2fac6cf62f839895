// SPDX-License-Identifier: MIT
#include "cli.h"

#include "file.h"

#include <stdarg.h>
#include <string.h>
#include <unistd.h>

static void one_line(char *text)
{
    for (; *text; ++text)
        if ((unsigned char) *text < 0x20)
            *text = ' ';
}

static void receive(void *user, fg_log_level level, const char *msg)
{
    cli *c = user;
    if (level == FG_LOG_ERROR)
        cli_fail(c, EXIT_FAILED, "%s", msg);
    else if (level == FG_LOG_WARN)
        cli_warn("%s", msg);
    else if (c->verbose)
        fprintf(stderr, "afterglow: %s\n", msg);
}

void cli_init(cli *c)
{
    *c = (cli){ .log = { .fn = receive, .user = c, .level = FG_LOG_WARN } };
}

int cli_fail(cli *c, int code, const char *fmt, ...)
{
    va_list args;
    if (c->error[0])
        return code;
    va_start(args, fmt);
    vsnprintf(c->error, sizeof c->error, fmt, args);
    va_end(args);
    one_line(c->error);
    return code;
}

void cli_warn(const char *fmt, ...)
{
    char text[1024];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    one_line(text);
    fprintf(stderr, "afterglow: warning: %s\n", text);
}

void cli_forgive(cli *c)
{
    if (c->error[0])
        cli_warn("%s", c->error);
    c->error[0] = 0;
}

int cli_status(cli *c, fg_status status)
{
    if (status == FG_OK)
        return EXIT_DONE;
    const int code = status == FG_ERR_INPUT ? EXIT_INPUT : EXIT_FAILED;
    return cli_fail(c, code, "afterglow: %s", fg_status_name(status));
}

int cli_end(cli *c, int code)
{
    if (code != EXIT_DONE)
        fprintf(stderr, "afterglow: error: %s\n",
                c->error[0] ? c->error : "unknown: no reason given");
    return code;
}

void cli_progress(const char *what, double fraction)
{
    if (!isatty(STDERR_FILENO))
        return;
    fprintf(stderr, "\r\033[K");
    if (fraction < 1)
        fprintf(stderr, "%s: %3.0f %%", what, 100 * fraction);
    fflush(stderr);
}

int cli_print(cli *c, const char *path, const char *text)
{
    if (path)
        return cli_status(c, file_write(&c->log, path, text, strlen(text)));
    fputs(text, stdout);
    return EXIT_DONE;
}
