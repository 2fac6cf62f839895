// SPDX-License-Identifier: MIT
#include "splat_priv.h"

#include "splat_refine_comp.h"

#include <epoxy/gl.h>
#include <stdio.h>

enum { GROUP = 128, ROW = 1024 }; // invocations of a work group, work groups of a row

// All texels of the coarsest level are the first patches.
static void dispatch_first(uint32_t program, const ag_multires_pass *m, const splat_round *round)
{
    const int texels = (m->pyramid.base[0] >> round->level) * (m->pyramid.base[1] >> round->level);
    const int groups = (texels + GROUP - 1) / GROUP;
    const int row = groups < ROW ? groups : ROW;
    glProgramUniform4i(program, 0, round->level, 0, texels, 1);
    glDispatchCompute((GLuint) row, (GLuint) ((groups + row - 1) / row), 1);
}

static fg_status run_refine(const fg_run *run, void *user)
{
    const splat_round *round = user;
    const splat_refine_pass *pass = round->pass;
    const ag_multires_pass *m = pass->multires;
    const bool shares = m->share > 0 && round->level == 0;
    const fg_gl_program_desc desc = {
        .shaders = { &refine_comp },
        .defines = shares ? "SHARE=1" : "",
    };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, m->scene.view);
    fg_gl_sample(run, 0, m->position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, m->normal, FG_GL_NEAREST);
    fg_gl_storage(run, 0, m->flags);
    fg_gl_storage(run, 1, round->queue);
    if (!round->first)
        fg_gl_storage(run, 2, round->parents);
    fg_gl_storage(run, 3, round->refined);
    fg_gl_storage(run, 4, round->patches);
    if (shares)
        fg_gl_storage(run, 5, m->tiles);
    fg_gl_image(run, 0, round->positions, 0, GL_WRITE_ONLY, FG_RGBA32F);
    fg_gl_image(run, 1, round->normals, 0, GL_WRITE_ONLY, FG_RGBA32F);
    glProgramUniform4i(program, 1, m->pyramid.base[0], m->pyramid.base[1], m->pyramid.size[0],
                       m->pyramid.size[1]);
    glUseProgram(program);
    if (round->first) {
        dispatch_first(program, m, round);
        return FG_OK;
    }
    glProgramUniform4i(program, 0, round->level, round->along, -1, 0);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, fg_run_object(run, round->parents));
    glDispatchComputeIndirect(0);
    return FG_OK;
}

static void declare_round(fg_graph *g, splat_round *round)
{
    const ag_multires_pass *m = round->pass->multires;
    const bool shares = m->share > 0 && round->level == 0;
    char name[32], refined[32];
    snprintf(name, sizeof name, "splat.refine%d", round->level);
    snprintf(refined, sizeof refined, "splat.refined%d", round->level);
    round->refined = fg_buffer(g, refined, &(fg_buf_desc){ .size = 16 });
    const fg_pass_desc refine = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = { { m->scene.view, FG_USE_UNIFORM },
                   { m->position },
                   { m->normal },
                   { m->flags },
                   { shares ? m->tiles : (fg_res){ 0 }, .optional = true },
                   { round->parents, FG_USE_STORAGE, .optional = true },
                   { round->parents, FG_USE_INDIRECT, .optional = true } },
        .writes = { { round->queue, FG_USE_STORAGE },
                    { round->refined, FG_USE_STORAGE, FG_LOAD_CLEAR },
                    { round->patches, FG_USE_STORAGE },
                    { round->positions, FG_USE_IMAGE },
                    { round->normals, FG_USE_IMAGE } },
        .run = run_refine,
        .user = round,
    };
    fg_passes(g, &refine, 1);
}

void splat_refine_declare(splat_refine_pass *pass, fg_graph *g, const ag_multires_pass *multires)
{
    const ag_multires_pass *m = multires;
    const int rows = (m->capacity + SPLAT_ROW - 1) / SPLAT_ROW, levels = m->pyramid.levels;
    const fg_tex_desc list = {
        .format = FG_RGBA32F,
        .width = m->capacity < SPLAT_ROW ? m->capacity : SPLAT_ROW,
        .height = rows,
    };
    int texels = 1; // of all levels but the finest
    for (int l = 1; l < levels; l++)
        texels += (m->pyramid.base[0] >> l) * (m->pyramid.base[1] >> l);
    splat_round next = {
        .pass = pass,
        .level = levels - 1,
        .first = true,
        .queue = fg_buffer(g, "splat.queue", &(fg_buf_desc){ .size = 4 * (uint64_t) texels }),
        .patches = fg_buffer(g, "splat.patches", &(fg_buf_desc){ .size = 16 }),
        .positions = fg_texture(g, "splat.positions", &list),
        .normals = fg_texture(g, "splat.normals", &list),
    };
    *pass = (splat_refine_pass){ .multires = m };
    // Where pixels share a patch, they are looked at all at once.
    const int finest = levels == 1 ? 0 : m->share > 1 ? m->share : 1;
    for (bool more = true; more; pass->rounds++) {
        splat_round *round = &pass->round[pass->rounds];
        *round = next;
        declare_round(g, round);
        more = round->level > 0;
        next.first = false;
        next.along = round->level > finest ? 1 : finest;
        next.level = round->level - next.along;
        next.parents = round->refined;
        next.queue = fg_next(round->queue);
        next.positions = fg_next(round->positions);
        next.normals = fg_next(round->normals);
        next.patches = fg_next(round->patches);
    }
    const splat_round *last = &pass->round[pass->rounds - 1];
    pass->positions = last->positions;
    pass->normals = last->normals;
    pass->patches = last->patches;
}
