// SPDX-License-Identifier: MIT
#include "plot.h"

#include "report.h"

#include <errno.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

static const char *const palette[] = { "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                       "#56b4e9", "#7f3c8d", "#a5aa00", "#666666", "#00429d" };

// ---- programs --------------------------------------------------------------------------------

// Runs a program without output. 0, ENOENT where there is no such program, -1 where it failed.
static int run_program(const char *const *argv)
{
    posix_spawn_file_actions_t actions;
    pid_t child;
    int state;
    if (posix_spawn_file_actions_init(&actions))
        return -1;
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", 0, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", 1, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", 1, 0);
    const int error = posix_spawnp(&child, argv[0], &actions, NULL, (char *const *) argv, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error)
        return error == ENOENT ? ENOENT : -1;
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR)
            return -1;
    return WIFEXITED(state) && WEXITSTATUS(state) == 0 ? 0 : -1;
}

bool plot_program(const char *const *argv, const char *lacking, cJSON *doc)
{
    const int result = run_program(argv);
    if (result)
        report_note(doc, "%s %s: %s", argv[0], result == ENOENT ? "is not installed" : "failed",
                    lacking);
    return !result;
}

// ---- gnuplot scripts -------------------------------------------------------------------------

void plot_text(FILE *f, const char *text)
{
    fputc('"', f);
    for (; *text; ++text)
        fputc(*text == '"' || *text == '\\' || *text == '`' || (unsigned char) *text < 0x20 ? '\''
                                                                                            : *text,
              f);
    fputc('"', f);
}

// In single quotes only they themselves are special.
void plot_path(FILE *f, const char *path)
{
    fputc('\'', f);
    for (; *path; ++path) {
        if (*path == '\'')
            fputc('\'', f);
        fputc(*path, f);
    }
    fputc('\'', f);
}

const char *plot_colour(int i)
{
    return palette[i % FG_COUNT(palette)];
}

static void write_head(FILE *f, const char *svg, int height)
{
    fprintf(f,
            "set terminal svg size 860,%d font 'Helvetica,13' noenhanced background '#ffffff'\n"
            "set output ",
            height);
    plot_path(f, svg);
    fprintf(f, "\nset border lc rgb '#444444'\nset grid lc rgb '#dddddd' lw 1\n"
               "set tics textcolor rgb '#222222'\n");
}

void plot_remove(const char *folder, const char *stem)
{
    char svg[4096];
    snprintf(svg, sizeof svg, "%s/%s.svg", folder, stem);
    unlink(svg);
}

fg_status plot_begin(const fg_log *log, const char *folder, const char *stem, int height, plot *out)
{
    snprintf(out->script, sizeof out->script, "%s/%s.gp", folder, stem);
    snprintf(out->svg, sizeof out->svg, "%s/%s.svg", folder, stem);
    plot_remove(folder, stem);
    const fg_status status = file_begin(log, out->script, &out->out);
    if (status == FG_OK)
        write_head(out->out.stream, out->svg, height);
    return status;
}

fg_status plot_end(const fg_log *log, plot *p, bool keep, cJSON *doc)
{
    const char *const argv[] = { "gnuplot", p->script, NULL };
    const fg_status status = file_end(log, &p->out, keep);
    if (status == FG_OK && keep && !plot_program(argv, "no plots", doc))
        unlink(p->svg);
    return status;
}
