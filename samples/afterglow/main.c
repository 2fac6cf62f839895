// SPDX-License-Identifier: MIT
#include "cli.h"

#include <fcntl.h>
#include <string.h>
#include <unistd.h>

static const command *const commands[] = {
    &command_render,  &command_sequence,  &command_reference, &command_compare,
    &command_report,  &command_stability, &command_graph,     &command_view,
    &command_plugins, &command_scenes,    &command_info,      NULL,
};

static const command *find_command(const char *name)
{
    for (int i = 0; commands[i]; ++i)
        if (!strcmp(commands[i]->name, name))
            return commands[i];
    return NULL;
}

static void print_help(void)
{
    printf("afterglow %s: indirect light as plugins of a frame graph\n\n"
           "usage: afterglow COMMAND [OPTION]... [OPERAND]...\n\ncommands:\n",
           AFTERGLOW_VERSION);
    for (int i = 0; commands[i]; ++i)
        printf("  %-10s %s\n", commands[i]->name, commands[i]->summary);
    printf(
        "\n'afterglow COMMAND --help' says more. SCENE is a built-in name (afterglow scenes), a\n"
        ".gltf or .glb file, or a name below the folder in AFTERGLOW_SCENES.\n"
        "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 input refused.\n");
}

static int unknown_command(cli *c, const char *name)
{
    if (!name[0])
        return cli_fail(c, EXIT_USAGE, "command: its name is empty");
    return cli_fail(c, EXIT_USAGE, "%s: unknown command; 'afterglow --help' lists them", name);
}

static int run_help(cli *c, int argc, char **argv)
{
    if (argc < 1) {
        print_help();
        return EXIT_DONE;
    }
    const command *cmd = find_command(argv[0]);
    if (!cmd)
        return unknown_command(c, argv[0]);
    options_help(stdout, cmd);
    return EXIT_DONE;
}

static int run(cli *c, int argc, char **argv)
{
    options o;
    if (argc < 2)
        return cli_fail(c, EXIT_USAGE, "command: none given; 'afterglow --help' lists them");
    if (!strcmp(argv[1], "--version")) {
        printf("afterglow %s\n", AFTERGLOW_VERSION);
        return EXIT_DONE;
    }
    if (!strcmp(argv[1], "--help") || !strcmp(argv[1], "-h") || !strcmp(argv[1], "help"))
        return run_help(c, argc - 2, argv + 2);
    const command *cmd = find_command(argv[1]);
    if (!cmd)
        return unknown_command(c, argv[1]);
    const int code = options_parse(c, cmd, argc - 2, argv + 2, &o);
    if (code != EXIT_DONE)
        return code;
    if (o.help) {
        options_help(stdout, cmd);
        return EXIT_DONE;
    }
    c->verbose = o.verbose;
    c->log.level = o.verbose ? FG_LOG_INFO : FG_LOG_WARN;
    return cmd->run(c, &o);
}

// A stream that the caller closed would be the next file that is opened, and a warning a line in
// a picture. What stands in its place cannot be written to, so that lost results are noticed.
static void occupy_streams(void)
{
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd)
        if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", O_RDONLY) < 0)
            return;
}

int main(int argc, char **argv)
{
    cli c;
    occupy_streams();
    cli_init(&c);
    int code = run(&c, argc, argv);
    if (code == EXIT_DONE && (fflush(stdout) || ferror(stdout)))
        code = cli_fail(&c, EXIT_FAILED, "stdout: cannot write");
    return cli_end(&c, code);
}
