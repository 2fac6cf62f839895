// SPDX-License-Identifier: MIT
#include <pass/variation.h>

#include "variation_comp.h"

#include <epoxy/gl.h>
#include <stdio.h>

enum { REGION = 64 }; // texels along the edge of what one work group reduces: 2^AG_MAX_LEVELS

static fg_status run_variation(const fg_run *run, void *user)
{
    const ag_variation_pass *pass = user;
    char defines[64];
    snprintf(defines, sizeof defines, "%s%s%s", pass->layers > 0 ? ";LIGHT=1" : "",
             pass->metric == AG_DEPTH_SLOPE ? ";SLOPE=1" : "", pass->range.id ? ";RANGE=1" : "");
    const fg_gl_program_desc desc = { .shaders = { &variation_comp }, .defines = defines };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_sample(run, 0, pass->depth, FG_GL_NEAREST);
    fg_gl_sample(run, 1, pass->normal, FG_GL_NEAREST);
    fg_gl_image(run, 0, pass->change, 0, GL_WRITE_ONLY, FG_RGBA16F);
    if (pass->range.id)
        fg_gl_image(run, 1, pass->range, 0, GL_WRITE_ONLY, FG_RG32F);
    if (pass->layers > 0)
        fg_gl_storage(run, 0, pass->scene.faces);
    else
        fg_gl_uniform(run, 0, pass->scene.view);
    glProgramUniform4i(program, 0, pass->width, pass->height, pass->first, pass->levels);
    glProgramUniform2i(program, 1, pass->pyramid.base[0], pass->pyramid.base[1]);
    glUseProgram(program);
    glDispatchCompute((GLuint) (pass->width + REGION - 1) / REGION,
                      (GLuint) (pass->height + REGION - 1) / REGION,
                      pass->layers > 0 ? (GLuint) pass->layers : 1);
    return FG_OK;
}

static bool check(fg_graph *g, const ag_variation_desc *desc)
{
    if (desc->levels < 1 || desc->levels > AG_MAX_LEVELS || desc->first < 0 ||
        desc->first > desc->levels) {
        fg_fail(g, "%s: levels %d to %d, must lie in [1, %d]", desc->prefix, desc->first,
                desc->levels, AG_MAX_LEVELS);
        return false;
    }
    if (desc->width < 1 || desc->height < 1 || desc->layers < 0) {
        fg_fail(g, "%s: variation of %d x %d x %d texels", desc->prefix, desc->width, desc->height,
                desc->layers);
        return false;
    }
    return true;
}

static fg_res pyramid_texture(fg_graph *g, const ag_variation_pass *pass, const char *prefix,
                              const char *what, fg_format format)
{
    char name[64];
    const fg_tex_desc tex = {
        .format = format,
        .width = pass->pyramid.size[0],
        .height = pass->pyramid.size[1],
        .layers = pass->layers,
    };
    snprintf(name, sizeof name, "%s.%s", prefix, what);
    return fg_texture(g, name, &tex);
}

void ag_variation_declare(ag_variation_pass *pass, fg_graph *g, const ag_scene_res *scene,
                          const ag_variation_desc *desc)
{
    char name[64];
    *pass = (ag_variation_pass){
        .depth = desc->depth,
        .normal = desc->normal,
        .scene = *scene,
        .width = desc->width,
        .height = desc->height,
        .layers = desc->layers,
        .levels = desc->levels,
        .first = desc->first > 0 ? desc->first : 1,
        .metric = desc->metric,
    };
    if (!check(g, desc))
        return;
    const int first = pass->first, block = 1 << first;
    pass->pyramid = ag_pyramid_of((desc->width + block - 1) / block,
                                  (desc->height + block - 1) / block, desc->levels - first + 1);
    pass->change = pyramid_texture(g, pass, desc->prefix, "change", FG_RGBA16F);
    if (desc->range)
        pass->range = pyramid_texture(g, pass, desc->prefix, "range", FG_RG32F);
    snprintf(name, sizeof name, "%s_variation", desc->prefix);
    fg_pass_desc reduce = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = { { pass->depth }, { pass->normal }, { scene->view, FG_USE_UNIFORM } },
        .writes = { { pass->change, FG_USE_IMAGE }, { pass->range, FG_USE_IMAGE } },
        .needs = AG_FEATURE_GEOMETRY,
        .run = run_variation,
        .user = pass,
    };
    if (desc->layers > 0) {
        reduce.reads[2] = (fg_io){ scene->faces, FG_USE_STORAGE };
        reduce.needs |= AG_FEATURE_LIGHT;
    }
    fg_passes(g, &reduce, 1);
}
