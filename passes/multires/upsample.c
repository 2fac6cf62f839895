// SPDX-License-Identifier: MIT
#include <pass/multires.h>

#include "push_comp.h"
#include "upsample_comp.h"

#include <epoxy/gl.h>
#include <stdio.h>

enum { FLAGS = 0, TILES = 1, BASE = 0, LEVELS = 1, LEVEL = 2, LIMITS = 2, TILES_ACROSS = 3 };

// One dispatch for each of the levels from `from` to `to`, either way.
static fg_status run_levels(const fg_run *run, const ag_upsample_pass *pass, const char *defines,
                            int from, int to)
{
    const ag_multires_pass *m = pass->multires;
    const fg_gl_program_desc desc = { .shaders = { &push_comp }, .defines = defines };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    const int step = from <= to ? 1 : -1;
    glUseProgram(program);
    glProgramUniform2i(program, BASE, m->pyramid.base[0], m->pyramid.base[1]);
    glProgramUniform1i(program, LEVELS, m->pyramid.levels);
    for (int level = from; level != to + step; level += step) {
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
        glProgramUniform1i(program, LEVEL, level);
        fg_gl_dispatch_2d(m->pyramid.base[0] >> level, m->pyramid.base[1] >> level, 8, 8);
    }
    return FG_OK;
}

// Gives every texel that holds no edge a value, on all levels that pixels are interpolated from.
static fg_status run_push(const fg_run *run, void *user)
{
    const ag_upsample_pass *pass = user;
    const ag_multires_pass *m = pass->multires;
    const int finest = m->share > 0 ? m->share : 1, coarsest = m->pyramid.levels - 1;
    fg_gl_storage(run, FLAGS, m->flags);
    fg_gl_image(run, 0, pass->image, 0, GL_READ_WRITE, FG_RGBA32F);
    fg_status status = FG_OK;
    if (finest + 1 <= coarsest)
        status = run_levels(run, pass, "PULL=1", finest + 1, coarsest);
    if (status == FG_OK && finest <= coarsest - 1)
        status = run_levels(run, pass, "", coarsest - 1, finest);
    return status;
}

static int cell_of(fg_device *device, int share)
{
    return share == 3 ? (fg_gl_software(device) ? 4 : 2) : share == 1 ? 1 : 2;
}

static const char *permutation(int share, int cell)
{
    static const char *const defines[4] = { "SHARE=0", "SHARE=1;CELL=1", "SHARE=2;CELL=2",
                                            "SHARE=3;CELL=2" };
    return cell == 4 ? "SHARE=3;CELL=4" : defines[share];
}

static fg_status run_upsample(const fg_run *run, void *user)
{
    const ag_upsample_pass *pass = user;
    const ag_multires_pass *m = pass->multires;
    fg_device *device = fg_run_device(run);
    const int cell = cell_of(device, m->share);
    const fg_gl_program_desc desc = {
        .shaders = { &upsample_comp },
        .defines = permutation(m->share, cell),
    };
    const uint32_t program = fg_gl_program(device, &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, m->scene.view);
    fg_gl_storage(run, FLAGS, m->flags);
    fg_gl_image(run, 0, pass->image, 0, GL_READ_ONLY, FG_RGBA32F);
    fg_gl_image(run, 1, pass->out, 0, GL_WRITE_ONLY, FG_RGBA32F);
    glProgramUniform2i(program, BASE, m->pyramid.base[0], m->pyramid.base[1]);
    if (m->share > 0) {
        fg_gl_storage(run, TILES, m->tiles);
        fg_gl_sample(run, 0, m->position, FG_GL_NEAREST);
        fg_gl_sample(run, 1, m->normal, FG_GL_NEAREST);
        glProgramUniform2f(program, LIMITS, m->limit_depth, m->limit_normal);
        glProgramUniform1i(program, TILES_ACROSS, (m->width + 7) / 8);
    }
    glUseProgram(program);
    fg_gl_dispatch_2d(m->width, m->height, 8 * cell, 8 * cell);
    return FG_OK;
}

void ag_upsample_declare(ag_upsample_pass *pass, fg_graph *g, const ag_multires_pass *multires,
                         fg_res image, const char *prefix)
{
    char push_name[64], name[64], texture[64];
    *pass = (ag_upsample_pass){ .multires = multires, .image = fg_next(image) };
    snprintf(push_name, sizeof push_name, "%s.push", prefix);
    snprintf(name, sizeof name, "%s.upsample", prefix);
    snprintf(texture, sizeof texture, "%s.indirect", prefix);
    pass->out = fg_texture(g, texture, &(fg_tex_desc){ .format = FG_RGBA32F });
    const fg_pass_desc passes[] = {
        {
            .name = push_name,
            .kind = FG_KIND_COMPUTE,
            .reads = { { image, FG_USE_IMAGE }, { multires->flags } },
            .writes = { { pass->image, FG_USE_IMAGE } },
            .run = run_push,
            .user = pass,
        },
        {
            .name = name,
            .kind = FG_KIND_COMPUTE,
            .reads = { { multires->scene.view, FG_USE_UNIFORM },
                       { pass->image, FG_USE_IMAGE },
                       { multires->flags },
                       { multires->tiles },
                       { multires->position },
                       { multires->normal } },
            .writes = { { pass->out, FG_USE_IMAGE, FG_LOAD_DISCARD } },
            .run = run_upsample,
            .user = pass,
        },
    };
    fg_passes(g, passes, FG_COUNT(passes));
}
