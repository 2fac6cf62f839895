// SPDX-License-Identifier: MIT
#include "host.h"
#include "record.h"

#include <stdlib.h>

static int print_text(const metrics *m)
{
    printf("rmse          %.6g\n"
           "rmse_rms      %.6g\n"
           "rmse_max      %.6g\n"
           "relmse        %.6g\n"
           "smape         %.6g\n"
           "bias          %.6g\n"
           "energy_ratio  %.6g\n"
           "p99           %.6g\n"
           "nonfinite     %ld\n",
           m->rmse, m->rmse_rms, m->rmse_max, m->relmse, m->smape, m->bias, m->energy_ratio, m->p99,
           m->nonfinite);
    return EXIT_DONE;
}

static int print_json(cli *c, const metrics *m, const char *reference)
{
    cJSON *object = record_error(reference, m);
    char *text = object ? cJSON_Print(object) : NULL;
    cJSON_Delete(object);
    if (!text)
        return cli_status(c, FG_ERR_MEMORY);
    printf("%s\n", text);
    free(text);
    return EXIT_DONE;
}

static fg_status write_map(cli *c, const options *o, const image *a, const image *b,
                           const metrics *m)
{
    image map = { 0 };
    fg_status status = metrics_error_map(&c->log, a, b, m->p99 > 0 ? m->p99 : 1, &map);
    if (status == FG_OK)
        status = image_write(&c->log, o->output, &map, IMAGE_LIGHT);
    image_finish(&map);
    return status;
}

static int run(cli *c, const options *o)
{
    image a = { 0 }, b = { 0 };
    metrics m;
    int code = o->output ? host_check_output(c, o, true) : EXIT_DONE;
    if (code == EXIT_DONE)
        code = cli_status(c, image_read(&c->log, o->operands[0], &a));
    if (code == EXIT_DONE)
        code = cli_status(c, image_read(&c->log, o->operands[1], &b));
    if (code == EXIT_DONE && (a.width != b.width || a.height != b.height))
        code = cli_fail(c, EXIT_INPUT, "%s: is %d x %d, %s is %d x %d: sizes must be equal",
                        o->operands[0], a.width, a.height, o->operands[1], b.width, b.height);
    if (code == EXIT_DONE)
        code = cli_status(c, metrics_compare(&c->log, &a, &b, &m));
    if (code == EXIT_DONE && o->output)
        code = cli_status(c, write_map(c, o, &a, &b, &m));
    if (code == EXIT_DONE)
        code = o->json ? print_json(c, &m, o->operands[1]) : print_text(&m);
    image_finish(&a);
    image_finish(&b);
    return code;
}

const command command_compare = {
    .name = "compare",
    .operands = "A B",
    .summary = "Prints the error of picture A against the reference B",
    .help =
        "All in linear light, before any tone curve; pixels that are not finite are counted and\n"
        "left out. rmse_rms is over the RMS of B, rmse_max over its maximum, bias the mean of A - "
        "B,\n"
        "energy_ratio the sum of A over that of B. -o writes a signed map: red where A is too\n"
        "bright, blue where it is too dark, full colour at p99.",
    .option_names = " --json --output ",
    .min_operands = 2,
    .max_operands = 2,
    .run = run,
};
