// SPDX-License-Identifier: MIT
#include <pass/multires.h>

#include "cells_comp.h"
#include "push_comp.h"
#include "upsample_blocks_comp.h"
#include "upsample_edges_comp.h"
#include "upsample_pixels_comp.h"

#include <epoxy/gl.h>
#include <stdio.h>

enum { CELL_WORDS = 4, EDGES_GROUP = 64 }; // of cell_buffer's head; invocations of a work group

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
    glProgramUniform2i(program, 0, m->pyramid.base[0], m->pyramid.base[1]);
    for (int level = from; level != to + step; level += step) {
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
        glProgramUniform1i(program, 2, level);
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
    fg_gl_storage(run, 0, m->flags);
    fg_gl_image(run, 0, pass->image, 0, GL_READ_WRITE, FG_RGBA32F);
    fg_status status = FG_OK;
    if (finest + 1 <= coarsest)
        status = run_levels(run, pass, "PULL=1", finest + 1, coarsest);
    if (status == FG_OK && finest <= coarsest - 1)
        status = run_levels(run, pass, "", coarsest - 1, finest);
    return status;
}

// Pixels along the edge of what one invocation interpolates by pieces: a CPU gains from more.
static int part_of(fg_device *device, int share)
{
    const int cell = (1 << share) / 2;
    return cell > 2 && !fg_gl_software(device) ? 2 : cell;
}

static fg_status run_cells(const fg_run *run, void *user)
{
    const ag_upsample_pass *pass = user;
    const ag_multires_pass *m = pass->multires;
    fg_device *device = fg_run_device(run);
    const fg_gl_program_desc desc = { .shaders = { &cells_comp } };
    const uint32_t program = fg_gl_program(device, &desc);
    if (!program)
        return FG_ERR_SHADER;
    const GLuint head[CELL_WORDS] = { 0, 1, 1, 0 };
    const int parts = (1 << m->share) / 2 / part_of(device, m->share);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // shaders of the last frame wrote there
    glClearNamedBufferSubData(fg_run_object(run, pass->cells), GL_RGBA32UI, 0, sizeof head,
                              GL_RGBA_INTEGER, GL_UNSIGNED_INT, head);
    fg_gl_storage(run, 0, m->flags);
    fg_gl_storage(run, 1, pass->blocks);
    fg_gl_storage(run, 2, pass->cells);
    const int *base = m->pyramid.base;
    glProgramUniform2i(program, 0, base[0], base[1]);
    glProgramUniform4i(program, 1, m->share, ag_multires_flag_start(m, m->share), parts * parts, 0);
    glProgramUniform2i(program, 2, m->width, m->height);
    glUseProgram(program);
    fg_gl_dispatch_2d(base[0] >> m->share, base[1] >> m->share, 8, 8);
    return FG_OK;
}

static fg_status run_pixels(const fg_run *run, const ag_upsample_pass *pass)
{
    const ag_multires_pass *m = pass->multires;
    const fg_gl_program_desc desc = { .shaders = { &upsample_pixels_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_storage(run, 0, m->flags);
    glProgramUniform2i(program, 0, m->pyramid.base[0], m->pyramid.base[1]);
    glUseProgram(program);
    fg_gl_dispatch_2d(m->width, m->height, 16, 16);
    return FG_OK;
}

static uint32_t shared_program(const fg_run *run, const ag_upsample_pass *pass,
                               const fg_gl_shader *shader, int part)
{
    const ag_multires_pass *m = pass->multires;
    char defines[32];
    snprintf(defines, sizeof defines, part > 0 ? "SHARE=%d;PART=%d" : "SHARE=%d", m->share, part);
    const fg_gl_program_desc desc = { .shaders = { shader }, .defines = defines };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return 0;
    int origin[2];
    ag_pyramid_origin(&m->pyramid, m->share, origin);
    glProgramUniform4i(program, 0, m->pyramid.base[0] >> m->share, m->pyramid.base[1] >> m->share,
                       origin[0], origin[1]);
    return program;
}

static fg_status run_shared(const fg_run *run, const ag_upsample_pass *pass)
{
    const ag_multires_pass *m = pass->multires;
    const int part = part_of(fg_run_device(run), m->share), cell = (1 << m->share) / 2;
    const uint32_t smooth = shared_program(run, pass, &upsample_blocks_comp, 0);
    const uint32_t edges = shared_program(run, pass, &upsample_edges_comp, part);
    if (!smooth || !edges)
        return FG_ERR_SHADER;
    fg_gl_storage(run, 0, m->tiles);
    fg_gl_storage(run, 1, pass->blocks);
    fg_gl_storage(run, 2, pass->cells);
    fg_gl_sample(run, 0, m->position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, m->normal, FG_GL_NEAREST);
    glUseProgram(smooth);
    fg_gl_dispatch_2d(m->width, m->height, 8 * cell, 8 * cell);
    glProgramUniform2f(edges, 1, m->limit_depth, m->limit_normal);
    glProgramUniform1i(edges, 2, (m->width + 7) / 8);
    glUseProgram(edges);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, fg_run_object(run, pass->cells));
    glDispatchComputeIndirect(0);
    return FG_OK;
}

static fg_status run_upsample(const fg_run *run, void *user)
{
    const ag_upsample_pass *pass = user;
    fg_gl_uniform(run, 0, pass->multires->scene.view);
    fg_gl_sample(run, 2, pass->image, FG_GL_NEAREST);
    fg_gl_image(run, 1, pass->out, 0, GL_WRITE_ONLY, FG_RGBA32F);
    return pass->multires->share > 0 ? run_shared(run, pass) : run_pixels(run, pass);
}

static fg_res buffer(fg_graph *g, const char *prefix, const char *what, uint64_t words)
{
    char name[64];
    snprintf(name, sizeof name, "%s.%s", prefix, what);
    return fg_buffer(g, name, &(fg_buf_desc){ .size = words * sizeof(uint32_t) });
}

static void declare_cells(ag_upsample_pass *pass, fg_graph *g, const char *prefix)
{
    const ag_multires_pass *m = pass->multires;
    char name[64];
    const uint64_t blocks =
        (uint64_t) (m->pyramid.base[0] >> m->share) * (uint64_t) (m->pyramid.base[1] >> m->share);
    pass->blocks = buffer(g, prefix, "blocks_about", blocks);
    pass->cells = buffer(g, prefix, "edge_cells", CELL_WORDS + 4 * blocks);
    snprintf(name, sizeof name, "%s.cells", prefix);
    const fg_pass_desc sort = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = { { m->flags } },
        .writes = { { pass->blocks, FG_USE_STORAGE, FG_LOAD_DISCARD },
                    { pass->cells, FG_USE_STORAGE, FG_LOAD_DISCARD } },
        .run = run_cells,
        .user = pass,
    };
    fg_passes(g, &sort, 1);
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
    if (multires->share > 0)
        declare_cells(pass, g, prefix);
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
                       { pass->image },
                       { multires->flags },
                       { multires->tiles },
                       { multires->position },
                       { multires->normal },
                       { pass->blocks, .optional = true },
                       { pass->cells, .optional = true },
                       { pass->cells, FG_USE_INDIRECT, .optional = true } },
            .writes = { { pass->out, FG_USE_IMAGE, FG_LOAD_DISCARD } },
            .run = run_upsample,
            .user = pass,
        },
    };
    fg_passes(g, passes, FG_COUNT(passes));
}
