// SPDX-License-Identifier: MIT
#include "report.h"

#include "file.h"

#include <string.h>

static int check(cli *c, const options *o)
{
    static const char *const folders[] = { "images", "graphs", "plots" };
    char path[4096];
    if (o->budget && strcmp(o->budget, "quick") != 0 && strcmp(o->budget, "full") != 0)
        return cli_fail(c, EXIT_USAGE, "--budget: is '%s', must be quick or full", o->budget);
    if (o->merge && !o->operand_count)
        return cli_fail(c, EXIT_USAGE, "--merge: the folders to join are missing");
    for (int i = 0; i < o->operand_count && !o->merge; ++i)
        for (int k = 0; k < i; ++k)
            if (!strcmp(o->operands[i], o->operands[k]))
                return cli_fail(c, EXIT_USAGE, "%s: is given twice", o->operands[i]);
    int code = host_check_folder(c, o);
    for (int i = 0; i < FG_COUNT(folders) && code == EXIT_DONE; ++i) {
        snprintf(path, sizeof path, "%s/%s", o->output, folders[i]);
        code = cli_status(c, file_make_folder(&c->log, path));
    }
    return code;
}

static int run(cli *c, const options *o)
{
    cJSON *doc = NULL;
    int code = check(c, o);
    if (code == EXIT_DONE)
        code = o->merge ? report_merge(c, o, &doc) : report_measure(c, o, &doc);
    if (code == EXIT_DONE)
        code = report_write(c, o->output, doc);
    if (code == EXIT_DONE)
        printf("%s/report.html\n", o->output);
    cJSON_Delete(doc);
    return code;
}

const command command_report = {
    .name = "report",
    .operands = "[SCENE]...",
    .summary = "Measures error against run time, for every plugin over its quality parameters",
    .help =
        "Scenes: cornell and atrium where none is named. Writes report.html (one self-contained\n"
        "page), report.json, report.csv, plots/, images/ and graphs/ to the folder that -o names.\n"
        "Truths: path1, one indirect bounce path-traced, and path1_unshadowed, the same with\n"
        "nothing hidden along a bounce. Compared is the indirect light at time 0, of the first\n"
        "frame (quick) or the eighth (full). Times: whole frames of the running animation, "
        "settings\n"
        "in turns, each frame waited for; slow ones fewer times.\n"
        "quick: 256x256, each quality parameter alone over its cheapest values. full: 1024x1024,\n"
        "all combinations of quality parameters (beyond 200: each alone). --set fixes a "
        "parameter.\n"
        "full runs the studies too, figures of the papers drawn again: time and error over a\n"
        "parameter or along a path, cost by stage. --study NAME runs that one and no sweep; a "
        "wrong name lists "
        "them.\n"
        "report --merge DIR... -o DIR joins what --shard I/N runs have written.",
    .option_names = OPTIONS_SCENE OPTIONS_GPU
    " --gi --set --size --seed --shadow-size --shadow-taps --budget --study --spp --shard --merge "
    "--output ",
    .max_operands = -1,
    .run = run,
};
