// SPDX-License-Identifier: MIT
#include <pass/multires.h>

#include "debug_comp.h"

#include <epoxy/gl.h>
#include <stdio.h>

static fg_status run_debug(const fg_run *run, const ag_multires_debug *pass, fg_res out,
                           const char *defines)
{
    const ag_multires_pass *m = pass->multires;
    const fg_gl_program_desc desc = { .shaders = { &debug_comp }, .defines = defines };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    int size[3];
    fg_run_size(run, out, 0, size);
    fg_gl_storage(run, 0, m->flags);
    fg_gl_storage(run, 1, m->tiles);
    fg_gl_image(run, 0, out, 0, GL_WRITE_ONLY, FG_RGBA16F);
    glProgramUniform4i(program, 0, m->pyramid.base[0], m->pyramid.base[1], m->pyramid.levels,
                       (m->width + 7) / 8);
    glProgramUniform4i(program, 1, size[0], size[1], (m->height + 7) / 8, m->share);
    glUseProgram(program);
    fg_gl_dispatch_2d(size[0], size[1], 8, 8);
    return FG_OK;
}

static fg_status run_levels(const fg_run *run, void *user)
{
    const ag_multires_debug *pass = user;
    return run_debug(run, pass, pass->levels, "LEVELS=1");
}

static fg_status run_validity(const fg_run *run, void *user)
{
    const ag_multires_debug *pass = user;
    return run_debug(run, pass, pass->validity, "");
}

void ag_multires_debug_declare(ag_multires_debug *pass, fg_graph *g,
                               const ag_multires_pass *multires, const char *prefix)
{
    char level[64], validity[64];
    const fg_tex_desc flat = {
        .format = FG_RGBA16F,
        .width = multires->pyramid.size[0],
        .height = multires->pyramid.size[1],
    };
    *pass = (ag_multires_debug){ .multires = multires };
    snprintf(level, sizeof level, "%s.level_layer", prefix);
    snprintf(validity, sizeof validity, "%s.validity_layer", prefix);
    pass->levels = fg_texture(g, level, &(fg_tex_desc){ .format = FG_RGBA16F });
    pass->validity = fg_texture(g, validity, &flat);
    const fg_pass_desc passes[] = {
        {
            .name = level,
            .kind = FG_KIND_COMPUTE,
            .reads = { { multires->flags }, { multires->tiles } },
            .writes = { { pass->levels, FG_USE_IMAGE, FG_LOAD_DISCARD } },
            .run = run_levels,
            .user = pass,
        },
        {
            .name = validity,
            .kind = FG_KIND_COMPUTE,
            .reads = { { multires->flags }, { multires->tiles } },
            .writes = { { pass->validity, FG_USE_IMAGE, FG_LOAD_DISCARD } },
            .run = run_validity,
            .user = pass,
        },
    };
    fg_passes(g, passes, FG_COUNT(passes));
}
