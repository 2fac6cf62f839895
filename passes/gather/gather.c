// SPDX-License-Identifier: MIT
#include <pass/gather.h>

#include "fullscreen_vert.h"
#include "gather_comp.h"
#include "gather_frag.h"

#include <epoxy/gl.h>
#include <stdio.h>

// More receivers an invocation share each VPL's load. A CPU's vector unit gains up to 16; a GPU
// runs out of registers first.
static int suitable_block(fg_device *device)
{
    return fg_gl_software(device) ? 16 : 4;
}

static bool by_stencil(const ag_gather_pass *pass)
{
    return pass->multires && pass->multires->cull == AG_CULL_STENCIL;
}

static bool is_bounded(const ag_gather_pass *pass)
{
    return pass->clamp == AG_CLAMP_IRRADIANCE || pass->clamp == AG_CLAMP_GEOMETRY;
}

static int block_of(fg_device *device, const ag_gather_pass *pass)
{
    return by_stencil(pass) ? 1 : pass->block ? pass->block : suitable_block(device);
}

static uint32_t gather_program(fg_device *device, const ag_gather_pass *pass)
{
    static const int clamps[] = { 3, 1, 0, 2, 4, 4 }; // by ag_clamp, as gather.glsl numbers them
    const char *visibility = pass->visibility   ? ";VISIBILITY=1"
                             : pass->paraboloid ? ";VISIBILITY=2"
                                                : "";
    char defines[96];
    const int block = block_of(device, pass), edge = block == 16 ? 4 : block == 4 ? 2 : 1;
    fg_gl_program_desc desc = { .shaders = { &gather_comp }, .defines = defines };
    if (by_stencil(pass)) {
        desc.shaders[0] = &fullscreen_vert;
        desc.shaders[1] = &gather_frag;
        snprintf(defines, sizeof defines, "CLAMP=%d%s", clamps[pass->clamp], visibility);
    } else {
        snprintf(defines, sizeof defines, "BLOCK_X=%d;BLOCK_Y=%d;CLAMP=%d%s%s%s", edge, edge,
                 clamps[pass->clamp],
                 pass->multires ? ";LIST=1"
                 : pass->split  ? ";SPLIT=1"
                                : "",
                 pass->far_only ? ";FAR=1" : "", visibility);
    }
    return fg_gl_program(device, &desc);
}

// VPLs of one dispatch. Mesa's software renderer leaves every loop of an invocation for good after
// 65535 rounds of all of them together; a VPL takes at most 2, and 6 for each of its 16 receivers.
// A GPU gets as much as keeps its watchdog still.
static int suitable_span(fg_device *device)
{
    return fg_gl_software(device) ? 640 : 16384;
}

// Most VPLs that a receiver has.
static int longest_run(const ag_gather_pass *pass)
{
    const int tiles = pass->split ? pass->split->tiles * pass->split->tiles : 1;
    return (pass->capacity + tiles - 1) / tiles;
}

static void dispatch_tiles(const ag_split_pass *split, uint32_t program, int edge)
{
    glProgramUniform3i(program, 3, split->tile[0], split->tile[1], split->tiles);
    glDispatchCompute((GLuint) ((split->tile[0] + edge - 1) / edge),
                      (GLuint) ((split->tile[1] + edge - 1) / edge),
                      (GLuint) (split->tiles * split->tiles));
}

static void dispatch_spans(const fg_run *run, const ag_gather_pass *pass, uint32_t program,
                           int block)
{
    const int edge = block == 16 ? 32 : block == 4 ? 16 : 8; // pixels of one work group
    const int offset = block == 16  ? 48
                       : block == 4 ? 32
                                    : 16; // of its dispatch in multires->count
    const int step = suitable_span(fg_run_device(run)), end = longest_run(pass);
    int size[3];
    fg_run_size(run, pass->out, 0, size);
    for (int first = 0; first < end; first += step) {
        const bool last = first + step >= end;
        if (first > 0)
            glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
        glProgramUniform3i(program, 2, first, last ? end : first + step, last);
        if (by_stencil(pass))
            fg_gl_fullscreen(run);
        else if (pass->multires)
            glDispatchComputeIndirect(offset);
        else if (pass->split)
            dispatch_tiles(pass->split, program, edge);
        else
            fg_gl_dispatch_2d(size[0], size[1], edge, edge);
    }
}

static void bind_texels(const fg_run *run, const ag_multires_pass *m, uint32_t program)
{
    glProgramUniform2i(program, 3, m->pyramid.base[0], m->pyramid.base[1]);
    if (m->cull == AG_CULL_STENCIL) {
        glDepthFunc(GL_ALWAYS);
        glEnable(GL_STENCIL_TEST);
        glStencilFunc(GL_EQUAL, 1, 0xff);
        glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
        return;
    }
    fg_gl_storage(run, 2, m->texels);
    fg_gl_storage(run, 3, m->count);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, fg_run_object(run, m->count));
}

static fg_status run_gather(const fg_run *run, void *user)
{
    const ag_gather_pass *pass = user;
    fg_device *device = fg_run_device(run);
    const uint32_t program = gather_program(device, pass);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, pass->scene.view);
    fg_gl_sample(run, 0, pass->position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, pass->normal, FG_GL_NEAREST);
    fg_gl_storage(run, 0, pass->vpls);
    fg_gl_storage(run, 1, pass->count);
    fg_gl_image(run, 0, pass->out, 0, GL_READ_WRITE, FG_RGBA32F);
    if (pass->clamp == AG_CLAMP_CONSTANT)
        glProgramUniform1f(program, 0, pass->bound);
    else if (pass->clamp == AG_CLAMP_FOOTPRINT)
        glProgramUniform1i(program, 0, pass->on_surface);
    else if (is_bounded(pass))
        glProgramUniform2f(program, 0, pass->bound, pass->clamp == AG_CLAMP_GEOMETRY ? 1 : 0);
    if (pass->multires)
        bind_texels(run, pass->multires, program);
    const int block = block_of(device, pass);
    if (pass->visibility)
        ag_ism_bind(run, pass->visibility);
    if (pass->paraboloid)
        ag_paraboloid_bind(run, pass->paraboloid);
    glUseProgram(program);
    dispatch_spans(run, pass, program, block);
    return FG_OK;
}

static float bound_of(const ag_gather_desc *desc)
{
    return desc->clamp == AG_CLAMP_IRRADIANCE ? desc->clamp_e
           : desc->clamp == AG_CLAMP_GEOMETRY ? desc->clamp_g
                                              : desc->clamp_d2;
}

static bool check(const ag_gather_pass *pass, fg_graph *g, const ag_gather_desc *desc)
{
    const bool sparse = desc->multires || desc->visibility;
    if (desc->block != 0 && desc->block != 1 && desc->block != 4 && desc->block != 16)
        fg_fail(g, "%s: block is %d, must be 1, 4 or 16", desc->prefix, desc->block);
    else if (is_bounded(pass) && !(pass->bound > 0))
        fg_fail(g, "%s: clamp of a VPL is %g, must be above 0", desc->prefix, (double) pass->bound);
    else if (sparse && is_bounded(pass))
        fg_fail(g, "%s: a clamp of irradiance or geometry goes with neither multires nor ism",
                desc->prefix);
    else if (sparse && desc->split)
        fg_fail(g, "%s: a split frame goes with neither multires nor ism", desc->prefix);
    else if (sparse && desc->paraboloid)
        fg_fail(g, "%s: paraboloid maps go with neither multires nor ism", desc->prefix);
    else
        return true;
    return false;
}

static fg_res light_texture(const ag_gather_pass *pass, fg_graph *g, const char *prefix)
{
    char name[64];
    const char *const what = pass->multires ? "illumination"
                             : pass->split  ? "split_indirect"
                                            : "indirect";
    const int *size = pass->multires ? pass->multires->pyramid.size
                      : pass->split  ? pass->split->size
                                     : NULL;
    const fg_tex_desc tex = {
        .format = FG_RGBA32F,
        .width = size ? size[0] : 0, // 0: the frame's
        .height = size ? size[1] : 0,
    };
    snprintf(name, sizeof name, "%s.%s", prefix, what);
    return fg_texture(g, name, &tex);
}

void ag_gather_declare(ag_gather_pass *pass, fg_graph *g, const ag_scene_res *scene,
                       const ag_gbuffer *gbuffer, const ag_vpl_pass *vpls,
                       const ag_gather_desc *desc)
{
    char name[64];
    *pass = (ag_gather_pass){
        .scene = *scene,
        .position = gbuffer->position,
        .normal = gbuffer->normal,
        .vpls = vpls->vpls,
        .count = vpls->count,
        .capacity = vpls->capacity,
        .clamp = desc->clamp,
        .bound = bound_of(desc),
        .on_surface = desc->on_surface,
        .block = desc->block,
        .visibility = desc->visibility,
        .multires = desc->multires,
        .paraboloid = desc->paraboloid,
        .split = desc->split && desc->split->tiles > 1 ? desc->split : NULL,
    };
    if (!check(pass, g, desc))
        return;
    pass->far_only = desc->far_only && pass->split && pass->clamp == AG_CLAMP_FOOTPRINT;
    if (pass->split) {
        pass->position = pass->split->position;
        pass->normal = pass->split->normal;
    }
    snprintf(name, sizeof name, "%s.gather", desc->prefix);
    const ag_multires_pass every_pixel = { 0 }, *m = desc->multires ? desc->multires : &every_pixel;
    const ag_multires_pass listed = by_stencil(pass) ? every_pixel : *m;
    const ag_ism_pass unshadowed = { 0 }, *ism = desc->visibility ? desc->visibility : &unshadowed;
    const ag_paraboloid_pass none = { 0 }, *drawn = desc->paraboloid ? desc->paraboloid : &none;
    pass->out = light_texture(pass, g, desc->prefix);
    const fg_load load = pass->multires ? FG_LOAD_KEEP : FG_LOAD_DISCARD;
    const fg_pass_desc gather = {
        .name = name,
        .kind = by_stencil(pass) ? FG_KIND_RASTER : FG_KIND_COMPUTE,
        .reads = {
            { scene->view, FG_USE_UNIFORM },
            { pass->position },
            { pass->normal },
            { pass->vpls },
            { pass->count },
            { ism->maps, .optional = true },
            { ism->eyes, .optional = true },
            { drawn->maps, .optional = !desc->paraboloid },
            { drawn->eyes, .optional = !desc->paraboloid },
            { listed.texels, .optional = true },
            { listed.count, .optional = true },
            { listed.count, FG_USE_INDIRECT, .optional = true },
            { m->stencil, FG_USE_DEPTH, .optional = true },
        },
        .writes = { { pass->out, FG_USE_IMAGE, load } },
        .run = run_gather,
        .user = pass,
    };
    fg_passes(g, &gather, 1);
}
