// SPDX-License-Identifier: MIT
#include <pass/post.h>

#include "compose_comp.h"
#include "fullscreen_vert.h"
#include "tone_frag.h"

#include <epoxy/gl.h>
#include <stdio.h>

static bool bind_if_there(const fg_run *run, int unit, fg_res res)
{
    if (!res.id || !fg_run_object(run, res))
        return false;
    fg_gl_sample(run, unit, res, FG_GL_NEAREST);
    return true;
}

static fg_status run_compose(const fg_run *run, void *user)
{
    static const char *const defines[8] = {
        "",
        "DIRECT=1",
        "INDIRECT=1",
        "DIRECT=1;INDIRECT=1",
        "GLOSSY_LIGHT=1",
        "DIRECT=1;GLOSSY_LIGHT=1",
        "INDIRECT=1;GLOSSY_LIGHT=1",
        "DIRECT=1;INDIRECT=1;GLOSSY_LIGHT=1",
    };
    const ag_compose_pass *pass = user;
    unsigned mix = 0;
    fg_gl_uniform(run, 0, pass->view);
    mix |= bind_if_there(run, 0, pass->direct) ? 1 : 0;
    mix |= bind_if_there(run, 1, pass->albedo) && bind_if_there(run, 2, pass->indirect) ? 2 : 0;
    mix |= bind_if_there(run, 3, pass->glossy) ? 4 : 0;
    fg_gl_image(run, 0, pass->out, 0, GL_WRITE_ONLY, FG_RGBA32F);
    const fg_gl_program_desc desc = { .shaders = { &compose_comp }, .defines = defines[mix] };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    int size[3];
    fg_run_size(run, pass->out, 0, size);
    glUseProgram(program);
    fg_gl_dispatch_2d(size[0], size[1], 8, 8);
    return FG_OK;
}

void ag_compose_declare(ag_compose_pass *pass, fg_graph *g, const char *name, const char *texture)
{
    pass->out = fg_texture(g, texture, &(fg_tex_desc){ .format = FG_RGBA32F });
    const fg_pass_desc compose = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = {
            { pass->view, FG_USE_UNIFORM },
            { pass->albedo },
            { pass->direct, .optional = true },
            { pass->indirect, .optional = true },
            { pass->glossy, .optional = true },
        },
        .writes = { { pass->out, FG_USE_IMAGE, FG_LOAD_DISCARD } },
        .run = run_compose,
        .user = pass,
    };
    fg_passes(g, &compose, 1);
}

static fg_status run_tone(const fg_run *run, void *user)
{
    const ag_tone_pass *pass = user;
    const fg_gl_program_desc desc = { .shaders = { &fullscreen_vert, &tone_frag } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_sample(run, 0, pass->radiance, FG_GL_NEAREST);
    glProgramUniform1f(program, 0, pass->exposure);
    glUseProgram(program);
    fg_gl_fullscreen(run);
    return FG_OK;
}

void ag_tone_declare(ag_tone_pass *pass, fg_graph *g, const char *name, const char *texture)
{
    pass->out = fg_texture(g, texture, &(fg_tex_desc){ .format = FG_RGBA16F });
    const fg_pass_desc tone = {
        .name = name,
        .reads = { { pass->radiance } },
        .writes = { { pass->out, FG_USE_COLOR, FG_LOAD_DISCARD } },
        .run = run_tone,
        .user = pass,
    };
    fg_passes(g, &tone, 1);
}
