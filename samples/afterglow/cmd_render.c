// SPDX-License-Identifier: MIT
#include "file.h"
#include "host.h"
#include "record.h"
#include "trace.h"

#include <string.h>

// Frames 0 to `last`, 1/60 s apart.
static fg_status run_frames(host *h, renderer *r, trace *t, int last)
{
    fg_status status = FG_OK;
    for (int i = 0; i <= last && status == FG_OK; ++i) {
        status = host_frame(h, r, i / 60.0);
        if (status == FG_OK)
            trace_frame(t, r);
        if (last > 0)
            cli_progress("frames", (i + 1.0) / (last + 1.0));
    }
    return status;
}

// Those of the frames after `frame`, which the trace has then, too.
static fg_status write_stats(host *h, renderer *r, const renderer_desc *desc, trace *events)
{
    enum { TIMED = 5 };
    const int frames = h->o->timing_frames ? h->o->timing_frames : TIMED;
    const int frame = h->o->frame > 0 ? h->o->frame : 0;
    const setting s = { .plugin = desc->plugin, .values = (gi_value *) desc->values };
    timing t;
    cJSON *record = NULL;
    fg_status status = timing_create(frames, &t);
    t.trace = events;
    if (status == FG_OK)
        status = timing_run(&t, h->device, r, frame, frames);
    if (status == FG_OK && !h->fell_back && renderer_fault(r)) { // now they are of direct light
        cli_forgive(h->c);
        h->fell_back = true;
        timing_finish(&t);
        status = timing_create(frames, &t);
        t.trace = events;
        if (status == FG_OK)
            status = timing_run(&t, h->device, r, frame + 1 + frames, frames);
    }
    if (status == FG_OK) {
        record = record_create(h, r, &s, &t, desc->width, desc->height);
        status = record ? record_write(&h->c->log, record, h->o->stats) : FG_ERR_MEMORY;
    }
    cJSON_Delete(record);
    timing_finish(&t);
    return status;
}

static fg_status write_figures(host *h, renderer *r, const renderer_desc *desc, trace *events)
{
    const fg_status status = h->o->stats ? write_stats(h, r, desc, events) : FG_OK;
    const fg_status written = trace_finish(events, h->device, r, status == FG_OK);
    return status != FG_OK ? status : written;
}

static int render(host *h, const setting *s)
{
    const int width = h->o->width ? h->o->width : 512, height = h->o->height ? h->o->height : 512;
    renderer *r = NULL;
    trace *events = NULL;
    image picture = { 0 };
    renderer_desc desc = host_renderer_desc(h, s, width, height);
    desc.layers = 1u << s->layer;
    fg_status status = trace_create(&h->c->log, h->o->trace, &events);
    if (status == FG_OK)
        status = host_renderer(h, &desc, &r);
    if (status == FG_OK)
        status = run_frames(h, r, events, h->o->frame > 0 ? h->o->frame : 0);
    if (status == FG_OK)
        status = renderer_read(r, s->layer, &picture);
    // The picture is written last: with its figures or not at all.
    if (status == FG_OK)
        status = write_figures(h, r, &desc, events);
    else
        (void) !trace_finish(events, h->device, NULL, false);
    if (status == FG_OK)
        status = image_write(&h->c->log, h->o->output, &picture, host_layer_kind(s->layer));
    image_finish(&picture);
    renderer_destroy(r);
    return cli_status(h->c, status);
}

static int check(host *h)
{
    int code = EXIT_DONE;
    if (h->o->gi_count > 1)
        code = cli_fail(h->c, EXIT_USAGE, "--gi: render takes one plugin, %d are given",
                        h->o->gi_count);
    if (code == EXIT_DONE)
        code = host_check_output(h->c, h->o, true);
    if (code == EXIT_DONE && h->o->stats && !strcmp(h->o->stats, h->o->output))
        code = cli_fail(h->c, EXIT_USAGE, "--stats: is '%s', which is where the picture goes",
                        h->o->stats);
    if (code == EXIT_DONE && h->o->stats)
        code = cli_status(h->c, file_check(&h->c->log, h->o->stats));
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
        code = render(&h, &settings[0]);
    for (int i = 0; i < count; ++i)
        setting_finish(&settings[i]);
    host_finish(&h);
    return code;
}

const command command_render = {
    .name = "render",
    .operands = "SCENE",
    .summary = "Renders one frame without a window",
    .help =
        "FILE ends in .png (sRGB; normals and positions as value/2 + 1/2), .exr or .pfm (linear).\n"
        "--layer takes what 'afterglow plugins' lists of the plugin, too: LAYER or NAME.LAYER.\n"
        "--stats times a few more frames of the animation after the one that is taken; --trace "
        "has\n"
        "these, too.",
    .option_names = OPTIONS_SCENE OPTIONS_GPU OPTIONS_FRAME
    " --frame --layer --stats --trace --timing-frames --output ",
    .min_operands = 1,
    .max_operands = 1,
    .run = run,
};
