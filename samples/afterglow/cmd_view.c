// SPDX-License-Identifier: MIT
#include "record.h"
#include "view.h"
#include "view_keys.h"

#include <string.h>

// Hierarchical instant radiosity where there is it, else the first by name; none at all is direct
// light alone.
static const char *default_plugin(const host *h)
{
    return host_has_plugin(h, "hisr") ? "hisr" : gi_name(h->registry, 0);
}

static int check(cli *c, const options *o)
{
    const int code = o->output ? host_check_folder(c, o) : EXIT_DONE;
    return code == EXIT_DONE ? host_check_trace(c, o) : code;
}

static int open_inputs(host *h, options *o, setting *settings, int *count)
{
    int code = host_open_registry(h);
    if (code == EXIT_DONE && !o->gi_count && default_plugin(h))
        o->gi[o->gi_count++] = default_plugin(h);
    if (code == EXIT_DONE)
        code = host_settings(h, false, settings, count);
    return code == EXIT_DONE ? host_open_scene(h, o->operands[0]) : code;
}

static int run(cli *c, const options *given)
{
    host h;
    options o = *given;
    setting settings[CLI_MAX_GI];
    view_start start = { .settings = settings, .params = o.params, .started_ms = now_ms() };
    host_init(&h, c, &o);
    h.hot = true;
    int code = check(c, &o);
    if (code == EXIT_DONE)
        code = open_inputs(&h, &o, settings, &start.count);
    if (code == EXIT_DONE)
        code = view_run(&h, &start);
    for (int i = 0; i < start.count; ++i)
        setting_finish(&settings[i]);
    host_finish(&h);
    return code;
}

#define KEY_LINE(id, key, mods, name, help) "  " name "  " help "\n"
#define MOTION_LINE(name, help) "  " name "  " help "\n"

const command command_view = {
    .name = "view",
    .operands = "SCENE",
    .summary = "Shows the scene in a window",
    .help =
        "One plugin or two side by side, their parameters, times and memory. Without --gi hisr\n"
        "is shown; with several, the keys go through these, and a split begins with the first\n"
        "two. Pictures go to the folder --output. --frames ends after so many frames, each\n"
        "1/60 s of the clock. --verbose: a debug context, times of the first frames, and what\n"
        "is done.\n\nkeys:\n" VIEW_KEYS(KEY_LINE) VIEW_MOTIONS(MOTION_LINE),
    .option_names = OPTIONS_SCENE " --shader-dir --plugin-dir --debug" OPTIONS_FRAME
                                  " --layer --frames --params --render-scale --trace --output ",
    .min_operands = 1,
    .max_operands = 1,
    .run = run,
};
