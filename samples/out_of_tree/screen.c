// SPDX-License-Identifier: MIT
// Technique "screen": one diffuse bounce of the surfaces that the screen shows, within reach.
#include <gi/plugin.h>

#include "screen_comp.h"

#include <epoxy/gl.h>
#include <fg/gl.h>
#include <math.h>
#include <stdlib.h>

enum { RAYS, REACH, PARAM_COUNT };

static const double rays_sweep[] = { 4, 16, 64, (double) NAN };
static const gi_param params[] = {
    [RAYS] = { .name = "rays",
               .type = GI_INT,
               .unit = "1",
               .min = 1,
               .max = 1024,
               .def = 32,
               .quality = true,
               .sweep = rays_sweep,
               .help = "directions that each pixel looks into" },
    [REACH] = { .name = "reach",
                .type = GI_FLOAT,
                .unit = "m",
                .min = 1e-3,
                .max = 1e4,
                .def = 1,
                .help = "how far away a surface may be" },
    [PARAM_COUNT] = { .name = NULL },
};

enum { OPEN, LAYER_COUNT };
static const gi_layer layers[] = {
    [OPEN] = { .name = "open", .help = "share of directions that met nothing" },
    [LAYER_COUNT] = { .name = NULL },
};

typedef struct screen { // what the passes' callbacks point to
    int rays;
    float reach;
    int width, height;
    fg_res view, position, normal, face, direct;
    fg_res light, open;
} screen;

static fg_status set(void *self, const gi_value *values)
{
    screen *s = self;
    s->rays = (int) values[RAYS].i;
    s->reach = (float) values[REACH].f;
    return FG_OK;
}

static fg_status create(const gi_env *env, const gi_value *values, void **self)
{
    *self = calloc(1, sizeof(screen));
    if (!*self) {
        fg_logf(env->log, FG_LOG_ERROR, "screen: out of memory");
        return FG_ERR_MEMORY;
    }
    return set(*self, values);
}

static void destroy(void *self)
{
    free(self);
}

static fg_status march(const fg_run *run, const screen *s, bool open)
{
    const fg_gl_program_desc desc = { .shaders = { &screen_comp },
                                      .defines = open ? "OPEN=1" : NULL };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, s->view);
    fg_gl_sample(run, 0, s->position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, s->normal, FG_GL_NEAREST);
    fg_gl_sample(run, 2, s->face, FG_GL_NEAREST);
    if (!open)
        fg_gl_sample(run, 3, s->direct, FG_GL_NEAREST);
    fg_gl_image(run, 0, open ? s->open : s->light, 0, GL_WRITE_ONLY,
                open ? FG_RGBA16F : FG_RGBA32F);
    glProgramUniform1i(program, 0, s->rays);
    glProgramUniform1f(program, 1, s->reach);
    glUseProgram(program);
    fg_gl_dispatch_2d(s->width, s->height, 8, 8);
    return FG_OK;
}

static fg_status run_light(const fg_run *run, void *user)
{
    return march(run, user, false);
}

static fg_status run_open(const fg_run *run, void *user)
{
    return march(run, user, true);
}

static void declare(void *self, fg_graph *g, const gi_inputs *in, gi_outputs *out)
{
    screen *s = self;
    s->width = in->width;
    s->height = in->height;
    s->view = in->scene.view;
    s->position = in->gbuffer.position;
    s->normal = in->gbuffer.normal;
    s->face = in->gbuffer.face;
    s->direct = in->direct;
    s->light = fg_texture(g, "screen.indirect", &(fg_tex_desc){ .format = FG_RGBA32F });
    s->open = fg_texture(g, "screen.open", &(fg_tex_desc){ .format = FG_RGBA16F });
    const fg_pass_desc passes[] = {
        { .name = "screen.march",
          .kind = FG_KIND_COMPUTE,
          .reads = { { s->view, FG_USE_UNIFORM },
                     { s->position },
                     { s->normal },
                     { s->face },
                     { s->direct } },
          .writes = { { s->light, .load = FG_LOAD_DISCARD } },
          .run = run_light,
          .user = s },
        { .name = "screen.look", // nobody reads it but `--layer open`: else it is left out
          .kind = FG_KIND_COMPUTE,
          .reads = { { s->view, FG_USE_UNIFORM }, { s->position }, { s->normal }, { s->face } },
          .writes = { { s->open, .load = FG_LOAD_DISCARD } },
          .run = run_open,
          .user = s },
    };
    fg_passes(g, passes, FG_COUNT(passes));
    out->indirect = s->light;
    out->layers[OPEN] = s->open;
}

static int counters(void *self, gi_counter *out, int max)
{
    const screen *s = self;
    if (max > 0)
        out[0] = (gi_counter){ "rays", s->rays };
    return 1;
}

static const gi_plugin plugin = {
    .abi = GI_PLUGIN_ABI,
    .name = "screen",
    .source = "Ritschel, Grosch, Seidel. Approximating Dynamic Global Illumination in Image Space. "
              "I3D 2009",
    .summary = "one diffuse bounce of the surfaces that the screen shows, within reach; leaves out "
               "what it does not show",
    .params = params,
    .layers = layers,
    .needs = AG_FEATURE_GEOMETRY,
    .create = create,
    .set = set,
    .declare = declare,
    .counters = counters,
    .destroy = destroy,
};

GI_PLUGIN_ENTRY(screen)
{
    return &plugin;
}
