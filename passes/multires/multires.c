// SPDX-License-Identifier: MIT
#include <pass/multires.h>

#include "fullscreen_vert.h"
#include "list_comp.h"
#include "refine_comp.h"
#include "share_comp.h"
#include "stencil_frag.h"
#include "valid_comp.h"

#include <epoxy/gl.h>
#include <stdio.h>

enum { TILE = 8, GROUP = 256 }; // pixels along a tile's edge; tiles of one work group of list.comp

static int tiles_across(const ag_multires_pass *pass)
{
    return (pass->width + TILE - 1) / TILE;
}

static int tiles_down(const ag_multires_pass *pass)
{
    return (pass->height + TILE - 1) / TILE;
}

static int tile_groups(const ag_multires_pass *pass)
{
    return (tiles_across(pass) * tiles_down(pass) + GROUP - 1) / GROUP;
}

static int finest_flags(const ag_multires_pass *pass)
{
    return pass->share > 0 ? pass->share : 1;
}

static fg_status run_refine(const fg_run *run, void *user)
{
    const ag_multires_pass *pass = user;
    const fg_gl_program_desc desc = { .shaders = { &refine_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    const int *base = pass->pyramid.base;
    fg_gl_sample(run, 0, pass->variation.change, FG_GL_NEAREST);
    fg_gl_storage(run, 0, pass->flags);
    glProgramUniform2f(program, 2, pass->limit_depth, pass->limit_normal);
    glUseProgram(program);
    for (int level = finest_flags(pass); level < pass->pyramid.levels; level++) {
        if (level > finest_flags(pass))
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        glProgramUniform4i(program, 0, level, pass->variation.first, pass->width, pass->height);
        glProgramUniform4i(program, 1, base[0], base[1], !pass->unbalanced,
                           level == finest_flags(pass));
        fg_gl_dispatch_2d(base[0] >> level, base[1] >> level, 8, 8);
    }
    return FG_OK;
}

static fg_status run_valid(const fg_run *run, void *user)
{
    const ag_multires_pass *pass = user;
    const fg_gl_program_desc desc = { .shaders = { &valid_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    const GLuint head[4] = { 0, 1, 1, 0 };
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // shaders of the last frame wrote there
    glClearNamedBufferSubData(fg_run_object(run, pass->shared), GL_RGBA32UI, 0, sizeof head,
                              GL_RGBA_INTEGER, GL_UNSIGNED_INT, head);
    fg_gl_uniform(run, 0, pass->scene.view);
    fg_gl_sample(run, 1, pass->normal, FG_GL_NEAREST);
    fg_gl_storage(run, 0, pass->flags);
    fg_gl_storage(run, 1, pass->marked);
    fg_gl_storage(run, 2, pass->shared);
    glProgramUniform4i(program, 0, pass->pyramid.levels, pass->share, tiles_across(pass),
                       tiles_down(pass));
    glProgramUniform2i(program, 1, pass->pyramid.base[0], pass->pyramid.base[1]);
    glUseProgram(program);
    fg_gl_dispatch_2d(tiles_across(pass), tiles_down(pass), 8, 8);
    return FG_OK;
}

static fg_status run_share(const fg_run *run, void *user)
{
    const ag_multires_pass *pass = user;
    const fg_gl_program_desc desc = { .shaders = { &share_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, pass->scene.view);
    fg_gl_sample(run, 0, pass->position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, pass->normal, FG_GL_NEAREST);
    fg_gl_storage(run, 1, pass->tiles);
    fg_gl_storage(run, 2, pass->shared);
    glProgramUniform2i(program, 0, pass->share, tiles_across(pass));
    glProgramUniform2f(program, 2, pass->limit_depth, pass->limit_normal);
    glUseProgram(program);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, fg_run_object(run, pass->shared));
    glDispatchComputeIndirect(0);
    return FG_OK;
}

static fg_status run_list(const fg_run *run, void *user)
{
    const ag_multires_pass *pass = user;
    fg_gl_storage(run, 0, pass->tiles);
    fg_gl_storage(run, 1, pass->sums);
    fg_gl_storage(run, 2, pass->texels);
    fg_gl_storage(run, 3, pass->count);
    for (int i = 0; i < 2; i++) {
        const fg_gl_program_desc desc = {
            .shaders = { &list_comp },
            .defines = i == 0 ? "SUM=1" : "",
        };
        const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
        if (!program)
            return FG_ERR_SHADER;
        glProgramUniform2i(program, 0, tiles_across(pass), tiles_down(pass));
        if (i > 0)
            glProgramUniform1i(program, 1, pass->pyramid.levels);
        glUseProgram(program);
        glDispatchCompute((GLuint) tile_groups(pass), 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    }
    return FG_OK;
}

static fg_status run_stencil(const fg_run *run, void *user)
{
    const ag_multires_pass *pass = user;
    const fg_gl_program_desc desc = { .shaders = { &fullscreen_vert, &stencil_frag } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_storage(run, 0, pass->tiles);
    glProgramUniform4i(program, 0, pass->pyramid.base[0], pass->pyramid.base[1],
                       pass->pyramid.levels, tiles_across(pass));
    glProgramUniform1i(program, 1, tiles_down(pass));
    glUseProgram(program);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_ALWAYS);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 1, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    fg_gl_fullscreen(run);
    return FG_OK;
}

int ag_multires_levels(int width, int height, int coarsest)
{
    const int longer = width > height ? width : height;
    int level = 1;
    while (level < AG_MAX_LEVELS && ((longer - 1) >> level) + 1 > coarsest)
        level++;
    return level + 1;
}

int ag_multires_flag_start(const ag_multires_pass *pass, int level)
{
    int start = 0;
    for (int l = 1; l < level; l++)
        start += (pass->pyramid.base[0] >> l) * (pass->pyramid.base[1] >> l);
    return start;
}

static fg_res buffer(fg_graph *g, const char *prefix, const char *what, uint64_t bytes)
{
    char name[64];
    snprintf(name, sizeof name, "%s.%s", prefix, what);
    return fg_buffer(g, name, &(fg_buf_desc){ .size = bytes });
}

static void declare_buffers(ag_multires_pass *pass, fg_graph *g, const char *prefix)
{
    const uint64_t tiles = (uint64_t) tiles_across(pass) * (uint64_t) tiles_down(pass);
    const uint64_t flags = (uint64_t) ag_multires_flag_start(pass, pass->pyramid.levels);
    pass->flags = buffer(g, prefix, "flags", flags * sizeof(uint32_t));
    pass->marked = buffer(g, prefix, "tiles", tiles * 4 * sizeof(uint32_t));
    pass->tiles = pass->share > 0 ? fg_next(pass->marked) : pass->marked;
    // One word a block, at least one block, after four of its dispatch.
    const int *base = pass->pyramid.base;
    const uint64_t blocks =
        (uint64_t) (base[0] >> pass->share) * (uint64_t) (base[1] >> pass->share);
    pass->shared =
        buffer(g, prefix, "shared", (4 + (pass->share > 0 ? blocks : 1)) * sizeof(uint32_t));
    pass->sums = buffer(g, prefix, "tile_sums", (uint64_t) tile_groups(pass) * sizeof(uint32_t));
    pass->texels = buffer(g, prefix, "texels", (uint64_t) pass->capacity * sizeof(uint32_t));
    pass->count = buffer(g, prefix, "texel_count", 16 * sizeof(uint32_t));
}

static void declare_stencil(ag_multires_pass *pass, fg_graph *g, const char *prefix)
{
    char name[64];
    const fg_tex_desc tex = {
        .format = FG_DEPTH24_STENCIL8,
        .width = pass->pyramid.size[0],
        .height = pass->pyramid.size[1],
    };
    snprintf(name, sizeof name, "%s.stencil", prefix);
    pass->stencil = fg_texture(g, name, &tex);
    const fg_pass_desc mark = {
        .name = name,
        .reads = { { pass->tiles } },
        .writes = { { pass->stencil, FG_USE_DEPTH, FG_LOAD_CLEAR } },
        .run = run_stencil,
        .user = pass,
    };
    fg_passes(g, &mark, 1);
}

static void declare_valid(ag_multires_pass *pass, fg_graph *g, const char *prefix)
{
    char valid[64], share[64];
    snprintf(valid, sizeof valid, "%s.valid", prefix);
    snprintf(share, sizeof share, "%s.share", prefix);
    const fg_pass_desc passes[] = {
        {
            .name = valid,
            .kind = FG_KIND_COMPUTE,
            .reads = { { pass->scene.view, FG_USE_UNIFORM }, { pass->flags }, { pass->normal } },
            .writes = { { pass->marked, FG_USE_STORAGE, FG_LOAD_DISCARD },
                        { pass->shared, FG_USE_STORAGE, FG_LOAD_DISCARD } },
            .run = run_valid,
            .user = pass,
        },
        {
            .name = share,
            .kind = FG_KIND_COMPUTE,
            .reads = { { pass->scene.view, FG_USE_UNIFORM },
                       { pass->position },
                       { pass->normal },
                       { pass->shared },
                       { pass->shared, FG_USE_INDIRECT } },
            .writes = { { pass->tiles, FG_USE_STORAGE } },
            .run = run_share,
            .user = pass,
        },
    };
    fg_passes(g, passes, pass->share > 0 ? 2 : 1);
}

static void declare_passes(ag_multires_pass *pass, fg_graph *g, const char *prefix)
{
    char refine[64], list[64];
    snprintf(refine, sizeof refine, "%s.refine", prefix);
    snprintf(list, sizeof list, "%s.list", prefix);
    const fg_pass_desc mark = {
        .name = refine,
        .kind = FG_KIND_COMPUTE,
        .reads = { { pass->variation.change } },
        .writes = { { pass->flags, FG_USE_STORAGE, FG_LOAD_DISCARD } },
        .run = run_refine,
        .user = pass,
    };
    fg_passes(g, &mark, 1);
    declare_valid(pass, g, prefix);
    const fg_pass_desc gather = {
        .name = list,
        .kind = FG_KIND_COMPUTE,
        .reads = { { pass->tiles } },
        .writes = { { pass->sums, FG_USE_STORAGE, FG_LOAD_DISCARD },
                    { pass->texels, FG_USE_STORAGE, FG_LOAD_DISCARD },
                    { pass->count, FG_USE_STORAGE, FG_LOAD_DISCARD } },
        .run = run_list,
        .user = pass,
    };
    fg_passes(g, &gather, 1);
}

static bool check(fg_graph *g, const ag_multires_desc *desc)
{
    const char *prefix = desc->prefix;
    if (desc->width < 1 || desc->height < 1 || desc->width > 16384 || desc->height > 16384)
        fg_fail(g, "%s: %d x %d pixels, must lie in [1, 16384]", prefix, desc->width, desc->height);
    else if (desc->coarsest < 0)
        fg_fail(g, "%s: coarsest is %d, must be at least 1", prefix, desc->coarsest);
    else if (!(desc->depth >= 0) || !(desc->normal >= 0))
        fg_fail(g, "%s: thresholds of depth %g and normal %g, must be at least 0", prefix,
                (double) desc->depth, (double) desc->normal);
    else if (desc->share < 0 || desc->share > 3)
        fg_fail(g, "%s: share is %d, must lie in [0, 3]", prefix, desc->share);
    else
        return true;
    return false;
}

void ag_multires_declare(ag_multires_pass *pass, fg_graph *g, const ag_scene_res *scene,
                         const ag_gbuffer *gbuffer, const ag_multires_desc *desc)
{
    char eye[64];
    *pass = (ag_multires_pass){
        .scene = *scene,
        .position = gbuffer->position,
        .normal = gbuffer->normal,
        .width = desc->width,
        .height = desc->height,
        .capacity = desc->width * desc->height,
        .limit_depth = desc->depth,
        .limit_normal = desc->normal,
        .cull = desc->cull,
        .unbalanced = desc->unbalanced,
    };
    if (!check(g, desc))
        return;
    const int levels =
        ag_multires_levels(desc->width, desc->height, desc->coarsest ? desc->coarsest : 64);
    pass->pyramid = ag_pyramid_of(desc->width, desc->height, levels);
    pass->share = desc->share < levels - 1 ? desc->share : levels - 1;
    snprintf(eye, sizeof eye, "%s.eye", desc->prefix);
    const ag_variation_desc variation = {
        .prefix = eye,
        .depth = gbuffer->depth,
        .normal = gbuffer->normal,
        .width = desc->width,
        .height = desc->height,
        .levels = levels - 1,
        .first = finest_flags(pass),
        .metric = desc->metric,
    };
    ag_variation_declare(&pass->variation, g, scene, &variation);
    declare_buffers(pass, g, desc->prefix);
    declare_passes(pass, g, desc->prefix);
    if (desc->cull == AG_CULL_STENCIL)
        declare_stencil(pass, g, desc->prefix);
}
