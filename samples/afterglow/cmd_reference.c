// SPDX-License-Identifier: MIT
#include "file.h"
#include "host.h"

#include <string.h>

static int choose_layer(cli *c, const options *o, reference_layer *layer, image_kind *kind)
{
    static const char *const names[] = { "radiance", "direct", "indirect",
                                         "albedo",   "normal", "position" };
    *layer = REFERENCE_RADIANCE;
    for (int i = 0; o->layer && i < FG_COUNT(names); ++i)
        if (!strcmp(o->layer, names[i])) {
            *layer = (reference_layer) i;
            *kind = *layer >= REFERENCE_NORMAL ? IMAGE_DATA : IMAGE_LIGHT;
            return EXIT_DONE;
        }
    if (o->layer)
        return cli_fail(c, EXIT_USAGE,
                        "--layer: is '%s', must be radiance, direct, indirect, albedo, normal or "
                        "position",
                        o->layer);
    return EXIT_DONE;
}

static int choose_filter(cli *c, const options *o, reference_filter *filter)
{
    *filter = REFERENCE_POINT;
    if (!o->filter || !strcmp(o->filter, "point"))
        return EXIT_DONE;
    *filter = REFERENCE_BOX;
    if (!strcmp(o->filter, "box"))
        return EXIT_DONE;
    return cli_fail(c, EXIT_USAGE, "--filter: is '%s', must be point or box", o->filter);
}

static void show_progress(void *user, double fraction)
{
    cli_progress(user, fraction);
}

static int trace(host *h, reference_desc desc, image_kind kind)
{
    image picture = { 0 };
    int code = host_open_scene(h, h->o->operands[0]);
    if (code != EXIT_DONE)
        return code;
    if (h->o->frame > 0)
        ag_scene_set_time(h->scene, h->o->frame / 60.0);
    const ag_camera camera = host_camera(h);
    desc.scene = h->scene;
    desc.camera = &camera;
    fg_status status = reference_render(&desc, &picture);
    if (status == FG_OK)
        status = image_write(&h->c->log, h->o->output, &picture, kind);
    image_finish(&picture);
    return cli_status(h->c, status);
}

static int run(cli *c, const options *o)
{
    static char what[] = "reference";
    host h;
    image_kind kind = IMAGE_LIGHT;
    reference_desc desc = {
        .log = &c->log,
        .width = o->width ? o->width : 512,
        .height = o->height ? o->height : 512,
        .bounces = o->bounces < 0 ? 1 : o->bounces,
        .spp = o->spp < 0 ? 64 : o->spp,
        .seed = o->seed,
        .unshadowed_bounce = o->unshadowed_bounce,
        .threads = o->threads,
        .progress = show_progress,
        .progress_user = what,
    };
    host_init(&h, c, o);
    int code = choose_layer(c, o, &desc.layer, &kind);
    if (code == EXIT_DONE)
        code = choose_filter(c, o, &desc.filter);
    if (code == EXIT_DONE && desc.unshadowed_bounce && !desc.bounces)
        code = cli_fail(c, EXIT_USAGE, "--unshadowed-bounce: --bounces is 0, must be at least 1");
    if (code == EXIT_DONE)
        code = host_check_output(c, o, true);
    if (code == EXIT_DONE)
        code = trace(&h, desc, kind);
    cli_progress(what, 1);
    host_finish(&h);
    return code;
}

const command command_reference = {
    .name = "reference",
    .operands = "SCENE",
    .summary = "Path-traces the truth on the CPU",
    .help = "Layers: radiance (default), direct, indirect, albedo, normal, position. The same seed "
            "gives\n"
            "the same picture, whatever the number of threads.",
    .option_names = OPTIONS_SCENE
    " --size --frame --seed --layer --bounces --spp --threads --filter --unshadowed-bounce "
    "--output ",
    .min_operands = 1,
    .max_operands = 1,
    .run = run,
};
