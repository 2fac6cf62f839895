// SPDX-License-Identifier: MIT
#include "file.h"
#include "host.h"
#include "trace.h"

#include <string.h>

static fg_status write_frame(host *h, renderer *r, renderer_layer layer, int frame)
{
    char path[4096];
    image picture = { 0 };
    const char *format = h->o->format ? h->o->format : "png";
    snprintf(path, sizeof path, "%s/frame_%04d.%s", h->o->output, frame, format);
    fg_status status = renderer_read(r, layer, &picture);
    if (status == FG_OK)
        status = image_write(&h->c->log, path, &picture, host_layer_kind(layer));
    image_finish(&picture);
    return status;
}

// A plugin that was at fault has no more turns: direct light takes them.
static void rest(host *h, setting *s)
{
    const renderer_layer layer = s->layer;
    if (!h->fell_back)
        return;
    setting_finish(s);
    s->layer = layer;
    h->fell_back = false;
}

// One frame to its file. Its picture waits for the GPU anyway, so that its times are there before
// the next plugin's.
static fg_status run_frame(host *h, renderer *r, const setting *s, trace *events, int frame)
{
    fg_status status = renderer_set_layers(r, 1u << s->layer);
    if (status == FG_OK)
        status = host_frame(h, r, frame / 60.0);
    if (status == FG_OK)
        status = write_frame(h, r, s->layer, frame);
    if (status == FG_OK && events)
        status = fg_gl_finish(h->device);
    if (status == FG_OK)
        trace_frame(events, r);
    return status;
}

static int render(host *h, setting *settings, int count)
{
    const int width = h->o->width ? h->o->width : 512, height = h->o->height ? h->o->height : 512;
    renderer *r = NULL;
    trace *events = NULL;
    renderer_desc desc = host_renderer_desc(h, &settings[0], width, height);
    desc.layers = 1u << settings[0].layer;
    fg_status status = trace_create(&h->c->log, h->o->trace, &events);
    if (status == FG_OK)
        status = host_renderer(h, &desc, &r);
    for (int i = 0; i < h->o->frames && status == FG_OK; ++i) {
        setting *s = &settings[i % count];
        if (i > 0 && count > 1)
            status = host_switch(h, r, s);
        if (status == FG_OK)
            status = run_frame(h, r, s, events, i);
        rest(h, s);
        cli_progress("frames", (i + 1.0) / h->o->frames);
    }
    const fg_status written = trace_finish(events, h->device, r, status == FG_OK);
    renderer_destroy(r);
    return cli_status(h->c, status != FG_OK ? status : written);
}

static int check(host *h)
{
    const char *format = h->o->format;
    if (!h->o->frames)
        return cli_fail(h->c, EXIT_USAGE, "--frames: is missing");
    if (format && strcmp(format, "png") != 0 && strcmp(format, "exr") != 0 &&
        strcmp(format, "pfm") != 0)
        return cli_fail(h->c, EXIT_USAGE, "--format: is '%s', must be png, exr or pfm", format);
    const int code = host_check_folder(h->c, h->o);
    return code == EXIT_DONE ? host_check_trace(h->c, h->o) : code;
}

static int run(cli *c, const options *o)
{
    host h;
    setting settings[CLI_MAX_GI];
    int count = 0;
    host_init(&h, c, o);
    int code = check(&h);
    if (code == EXIT_DONE)
        code = host_open(&h, settings, &count);
    if (code == EXIT_DONE)
        code = render(&h, settings, count);
    for (int i = 0; i < count; ++i)
        setting_finish(&settings[i]);
    host_finish(&h);
    return code;
}

const command command_sequence = {
    .name = "sequence",
    .operands = "SCENE",
    .summary = "Renders frames of the animation, 1/60 s apart",
    .help =
        "Writes FILE/frame_0000.png and on (--format png, exr or pfm). Several --gi take turns,\n"
        "frame by frame, in one process. --layer takes what 'afterglow plugins' lists of the\n"
        "plugins, too: LAYER or NAME.LAYER.",
    .option_names =
        OPTIONS_SCENE OPTIONS_GPU OPTIONS_FRAME " --frames --layer --format --trace --output ",
    .min_operands = 1,
    .max_operands = 1,
    .run = run,
};
