// SPDX-License-Identifier: MIT
#include <pass/interleave.h>

#include "combine_comp.h"
#include "filter_comp.h"
#include "split_comp.h"

#include <epoxy/gl.h>
#include <fg/gl.h>
#include <stdio.h>

enum {
    GROUP = 16,        // pixels along a work group's edge, of split and combine
    FILTER_GROUP = 16, // of filter, four an invocation
};

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static fg_res named_texture(fg_graph *g, const char *prefix, const char *what, fg_format format,
                            const int size[2])
{
    char name[64];
    const fg_tex_desc tex = { .format = format, .width = size[0], .height = size[1] };
    snprintf(name, sizeof name, "%s.%s", prefix, what);
    return fg_texture(g, name, &tex);
}

// The program, with the uniforms of tiles.glsl.
static uint32_t tiles_program(const fg_run *run, const ag_split_pass *split,
                              const fg_gl_shader *shader)
{
    const fg_gl_program_desc desc = { .shaders = { shader } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (program) {
        glProgramUniform4i(program, 0, split->frame[0], split->frame[1], split->tiles, 0);
        glProgramUniform2i(program, 1, split->tile[0], split->tile[1]);
        glUseProgram(program);
    }
    return program;
}

// ---- split --------------------------------------------------------------------------------------

static fg_status run_split(const fg_run *run, void *user)
{
    const ag_split_pass *pass = user;
    if (!tiles_program(run, pass, &split_comp))
        return FG_ERR_SHADER;
    fg_gl_sample(run, 0, pass->gbuffer.position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, pass->gbuffer.normal, FG_GL_NEAREST);
    fg_gl_image(run, 0, pass->position, 0, GL_WRITE_ONLY, FG_RGBA32F);
    fg_gl_image(run, 1, pass->normal, 0, GL_WRITE_ONLY, FG_RGBA16F);
    fg_gl_dispatch_2d(pass->size[0], pass->size[1], GROUP, GROUP);
    return FG_OK;
}

void ag_split_declare(ag_split_pass *pass, fg_graph *g, const ag_scene_res *scene,
                      const ag_gbuffer *gbuffer, const ag_split_desc *desc)
{
    char name[64];
    *pass = (ag_split_pass){
        .scene = *scene,
        .gbuffer = *gbuffer,
        .position = gbuffer->position,
        .normal = gbuffer->normal,
        .prefix = desc->prefix,
        .tiles = 1,
        .frame = { desc->width, desc->height },
        .size = { desc->width, desc->height },
        .tile = { desc->width, desc->height },
    };
    if (desc->tiles < 1 || desc->tiles > AG_MAX_TILES) {
        fg_fail(g, "%s: tiles is %d, must lie in [1, %d]", desc->prefix, desc->tiles, AG_MAX_TILES);
        return;
    }
    if (desc->width < 1 || desc->height < 1) {
        fg_fail(g, "%s: split of %d x %d pixels", desc->prefix, desc->width, desc->height);
        return;
    }
    // With more tiles than pixels along an edge some tiles would have none, and no pixel their
    // VPLs.
    pass->tiles = smaller(desc->tiles, smaller(desc->width, desc->height));
    if (pass->tiles == 1)
        return;
    for (int k = 0; k < 2; k++) {
        pass->tile[k] = (pass->frame[k] + pass->tiles - 1) / pass->tiles;
        pass->size[k] = pass->tile[k] * pass->tiles;
    }
    pass->position = named_texture(g, desc->prefix, "split_position", FG_RGBA32F, pass->size);
    pass->normal = named_texture(g, desc->prefix, "split_normal", FG_RGBA16F, pass->size);
    snprintf(name, sizeof name, "%s.split", desc->prefix);
    const fg_pass_desc split = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = { { gbuffer->position }, { gbuffer->normal } },
        .writes = { { pass->position, FG_USE_IMAGE, FG_LOAD_DISCARD },
                    { pass->normal, FG_USE_IMAGE, FG_LOAD_DISCARD } },
        .run = run_split,
        .user = pass,
    };
    fg_passes(g, &split, 1);
}

// ---- combine ------------------------------------------------------------------------------------

static fg_status run_combine(const fg_run *run, void *user)
{
    const ag_combine_pass *pass = user;
    const ag_split_pass *split = pass->split;
    if (!tiles_program(run, split, &combine_comp))
        return FG_ERR_SHADER;
    fg_gl_sample(run, 0, pass->in, FG_GL_NEAREST);
    fg_gl_image(run, 0, pass->out, 0, GL_WRITE_ONLY, FG_RGBA32F);
    fg_gl_dispatch_2d(split->frame[0], split->frame[1], GROUP, GROUP);
    return FG_OK;
}

void ag_combine_declare(ag_combine_pass *pass, fg_graph *g, const ag_split_pass *split, fg_res in)
{
    char name[64];
    *pass = (ag_combine_pass){ .split = split, .in = in, .out = in };
    if (split->tiles == 1)
        return;
    pass->out = named_texture(g, split->prefix, "combined", FG_RGBA32F, split->frame);
    snprintf(name, sizeof name, "%s.combine", split->prefix);
    const fg_pass_desc combine = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = { { in } },
        .writes = { { pass->out, FG_USE_IMAGE, FG_LOAD_DISCARD } },
        .run = run_combine,
        .user = pass,
    };
    fg_passes(g, &combine, 1);
}

// ---- filter -------------------------------------------------------------------------------------

static fg_status run_filter(const fg_run *run, void *user)
{
    const ag_box_filter_pass *pass = user;
    const ag_split_pass *split = pass->split;
    const fg_gl_program_desc desc = {
        .shaders = { &filter_comp },
        .defines = pass->metric == AG_BOX_DISTANCE ? "DISTANCE=1" : NULL,
    };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    if (pass->metric == AG_BOX_PLANE)
        fg_gl_uniform(run, 0, split->scene.view);
    fg_gl_sample(run, 0, split->gbuffer.position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, split->gbuffer.normal, FG_GL_NEAREST);
    fg_gl_sample(run, 2, pass->in, FG_GL_NEAREST);
    fg_gl_image(run, 0, pass->out, 0, GL_WRITE_ONLY, FG_RGBA32F);
    glProgramUniform4i(program, 0, split->frame[0], split->frame[1], split->tiles, 0);
    glProgramUniform2f(program, 1, pass->alpha, pass->beta);
    glUseProgram(program);
    fg_gl_dispatch_2d(split->frame[0], split->frame[1], FILTER_GROUP, FILTER_GROUP);
    return FG_OK;
}

void ag_box_filter_declare(ag_box_filter_pass *pass, fg_graph *g, const ag_split_pass *split,
                           fg_res in, const ag_box_filter_desc *desc)
{
    char name[64];
    *pass = (ag_box_filter_pass){
        .split = split,
        .in = in,
        .out = in,
        .metric = desc->metric,
        .alpha = desc->alpha,
        .beta = desc->beta,
    };
    if (!(desc->alpha >= 0)) {
        fg_fail(g, "%s: alpha is %g, must be at least 0", split->prefix, (double) desc->alpha);
        return;
    }
    if (!(desc->beta >= -1 && desc->beta <= 1)) {
        fg_fail(g, "%s: beta is %g, must lie in [-1, 1]", split->prefix, (double) desc->beta);
        return;
    }
    if (split->tiles == 1)
        return;
    pass->out = named_texture(g, split->prefix, "indirect", FG_RGBA32F, split->frame);
    snprintf(name, sizeof name, "%s.filter", split->prefix);
    const fg_pass_desc filter = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = { { split->gbuffer.position },
                   { split->gbuffer.normal },
                   { in },
                   { split->scene.view, FG_USE_UNIFORM } },
        .writes = { { pass->out, FG_USE_IMAGE, FG_LOAD_DISCARD } },
        .run = run_filter,
        .user = pass,
    };
    fg_passes(g, &filter, 1);
}
