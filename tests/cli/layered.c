// SPDX-License-Identifier: MIT
// A plugin with debug layers: one of the frame's size and one larger, dark but for the row at the
// bottom; one that it never hands out; one of a format that cannot be shown.
#include <gi/plugin.h>

#include <epoxy/gl.h>

enum { HALF, WIDE, ABSENT, ODD, COUNT };
static fg_res wide, half, odd;

static fg_status create(const gi_env *env, const gi_value *values, void **self)
{
    (void) env;
    (void) values;
    *self = &wide;
    return FG_OK;
}

static fg_status run(const fg_run *r, void *res)
{
    static const float green[] = { 0.25f, 1, 0.5f, 1 };
    int size[3];
    fg_run_size(r, *(fg_res *) res, 0, size);
    glClearTexSubImage(fg_run_object(r, *(fg_res *) res), 0, 0, 0, 0, size[0], 1, 1, GL_RGBA,
                       GL_FLOAT, green);
    return FG_OK;
}

static void declare(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    (void) self;
    half = fg_texture(g, "layered.half", &(fg_tex_desc){ .format = FG_RGBA16F });
    wide = fg_texture(
        g, "layered.wide",
        &(fg_tex_desc){ .format = FG_RGBA32F, .width = 3 * in->width, .height = 2 * in->height });
    odd = fg_texture(g, "layered.odd", &(fg_tex_desc){ .format = FG_R32F });
    const fg_pass_desc passes[] = {
        { .name = "layered.half",
          .writes = { { half, .use = FG_USE_COPY, .load = FG_LOAD_CLEAR } },
          .run = run,
          .user = &half },
        { .name = "layered.wide",
          .writes = { { wide, .use = FG_USE_COPY, .load = FG_LOAD_CLEAR } },
          .run = run,
          .user = &wide },
        { .name = "layered.odd",
          .writes = { { odd, .use = FG_USE_COPY, .load = FG_LOAD_CLEAR } },
          .run = run,
          .user = &odd },
    };
    fg_passes(g, passes, FG_COUNT(passes));
    out->layers[HALF] = half;
    out->layers[WIDE] = wide;
    out->layers[ODD] = odd;
}

static void destroy(void *self)
{
    (void) self;
}

static const gi_param no_params[] = { { .name = NULL } };
static const gi_layer layers[] = {
    [HALF] = { "half", "of the frame's size" },
    [WIDE] = { "wide", "three times as wide and twice as high" },
    [ABSENT] = { "absent", "never there" },
    [ODD] = { "odd", "of one channel" },
    [COUNT] = { 0 },
};
static const gi_plugin plugin = {
    .abi = GI_PLUGIN_ABI,
    .name = "layered",
    .source = "none",
    .summary = "for tests",
    .params = no_params,
    .layers = layers,
    .create = create,
    .declare = declare,
    .destroy = destroy,
};

FG_API const gi_plugin *gi_plugin_entry(void);
const gi_plugin *gi_plugin_entry(void)
{
    return &plugin;
}
