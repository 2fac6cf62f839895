// SPDX-License-Identifier: MIT
#include <pass/compensate.h>
#include <pass/interleave.h>

#include "compensate_comp.h"

#include <epoxy/gl.h>
#include <fg/gl.h>
#include <stdio.h>

enum { GROUP = 16, DEFAULT_SAMPLES = 32, MAX_SAMPLES = 256 };

static fg_status run_compensate(const fg_run *run, void *user)
{
    const ag_compensate_pass *pass = user;
    const fg_gl_program_desc desc = {
        .shaders = { &compensate_comp },
        .defines = pass->gbuffer.emissive.id ? "EMISSIVE=1" : NULL,
    };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, pass->scene.view);
    fg_gl_sample(run, 0, pass->gbuffer.position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, pass->gbuffer.normal, FG_GL_NEAREST);
    fg_gl_sample(run, 2, pass->gbuffer.face, FG_GL_NEAREST);
    fg_gl_sample(run, 3, pass->direct, FG_GL_NEAREST);
    if (pass->gbuffer.emissive.id)
        fg_gl_sample(run, 4, pass->gbuffer.emissive, FG_GL_NEAREST);
    fg_gl_sample(run, 5, pass->in, FG_GL_NEAREST);
    fg_gl_image(run, 0, pass->out, 0, GL_WRITE_ONLY, FG_RGBA32F);
    glProgramUniform4i(program, 0, pass->frame[0], pass->frame[1], pass->tiles, pass->samples);
    glProgramUniform1f(program, 1, pass->bound);
    glUseProgram(program);
    fg_gl_dispatch_2d(pass->frame[0], pass->frame[1], GROUP, GROUP);
    return FG_OK;
}

static bool check(fg_graph *g, const ag_compensate_desc *desc)
{
    if (!(desc->bound > 0))
        fg_fail(g, "%s: bound of the geometry term is %g, must be above 0", desc->prefix,
                (double) desc->bound);
    else if (desc->tiles < 1 || desc->tiles > AG_MAX_TILES)
        fg_fail(g, "%s: tiles is %d, must lie in [1, %d]", desc->prefix, desc->tiles, AG_MAX_TILES);
    else if (desc->samples < 0 || desc->samples > MAX_SAMPLES)
        fg_fail(g, "%s: samples is %d, must lie in [1, %d] or be 0", desc->prefix, desc->samples,
                MAX_SAMPLES);
    else
        return true;
    return false;
}

void ag_compensate_declare(ag_compensate_pass *pass, fg_graph *g, const ag_scene_res *scene,
                           const ag_gbuffer *gbuffer, const ag_compensate_desc *desc)
{
    char name[64], texture[64];
    *pass = (ag_compensate_pass){
        .scene = *scene,
        .gbuffer = *gbuffer,
        .direct = desc->direct,
        .in = desc->in,
        .bound = desc->bound,
        .frame = { desc->width, desc->height },
        .tiles = desc->tiles,
        .samples = desc->samples ? desc->samples : DEFAULT_SAMPLES,
    };
    if (!check(g, desc))
        return;
    const fg_tex_desc tex = { .format = FG_RGBA32F, .width = desc->width, .height = desc->height };
    snprintf(texture, sizeof texture, "%s.compensated", desc->prefix);
    snprintf(name, sizeof name, "%s.compensate", desc->prefix);
    pass->out = fg_texture(g, texture, &tex);
    const fg_pass_desc compensate = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = { { scene->view, FG_USE_UNIFORM },
                   { gbuffer->position },
                   { gbuffer->normal },
                   { gbuffer->face },
                   { pass->direct },
                   { gbuffer->emissive, .optional = true },
                   { pass->in } },
        .writes = { { pass->out, FG_USE_IMAGE, FG_LOAD_DISCARD } },
        .run = run_compensate,
        .user = pass,
    };
    fg_passes(g, &compensate, 1);
}
