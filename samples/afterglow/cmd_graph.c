// SPDX-License-Identifier: MIT
#include "file.h"
#include "host.h"

#include <string.h>

static int choose_format(cli *c, const options *o, fg_dump *format)
{
    static const char *const names[] = { "text", "dot", "json", "trace" };
    *format = FG_DUMP_TEXT;
    for (int i = 0; o->format && i < FG_COUNT(names); ++i)
        if (!strcmp(o->format, names[i])) {
            *format = (fg_dump) i;
            return EXIT_DONE;
        }
    if (o->format)
        return cli_fail(c, EXIT_USAGE, "--format: is '%s', must be text, dot, json or trace",
                        o->format);
    return EXIT_DONE;
}

static int dump(host *h, const setting *s, fg_dump format)
{
    const int width = h->o->width ? h->o->width : 512, height = h->o->height ? h->o->height : 512;
    const renderer_desc desc = host_renderer_desc(h, s, width, height);
    renderer *r = NULL;
    int code;
    // A frame has to run: graphs are compiled by frames, and a trace needs times.
    fg_status status = host_renderer(h, &desc, &r);
    if (status == FG_OK)
        status = host_frame(h, r, 0);
    if (status == FG_OK)
        status = fg_gl_finish(h->device);
    char *text = status == FG_OK ? fg_graph_dump(renderer_graph(r), format) : NULL;
    if (text)
        code = cli_print(h->c, h->o->output, text);
    else
        code = cli_status(h->c, status == FG_OK ? FG_ERR_MEMORY : status);
    if (text)
        fg_dump_free(renderer_graph(r), text);
    renderer_destroy(r);
    return code;
}

static int run(cli *c, const options *o)
{
    host h;
    setting settings[CLI_MAX_GI];
    int count = 0;
    fg_dump format;
    host_init(&h, c, o);
    int code = choose_format(c, o, &format);
    if (code == EXIT_DONE && o->gi_count > 1)
        code = cli_fail(c, EXIT_USAGE, "--gi: graph takes one plugin, %d are given", o->gi_count);
    if (code == EXIT_DONE && o->output)
        code = host_check_output(c, o, false);
    if (code == EXIT_DONE)
        code = host_open(&h, settings, &count);
    if (code == EXIT_DONE)
        code = dump(&h, &settings[0], format);
    for (int i = 0; i < count; ++i)
        setting_finish(&settings[i]);
    host_finish(&h);
    return code;
}

const command command_graph = {
    .name = "graph",
    .operands = "SCENE",
    .summary = "Prints the compiled graph of a frame",
    .help =
        "Passes in order, lifetimes, memory with and without sharing, what was left out and why.\n"
        "Formats: text (default), dot, json, trace (Chrome trace events of one frame).",
    .option_names = OPTIONS_SCENE OPTIONS_GPU OPTIONS_FRAME " --format --output ",
    .min_operands = 1,
    .max_operands = 1,
    .run = run,
};
