// SPDX-License-Identifier: MIT
#include <pass/gather.h>

#include "near_patches_comp.h"

#include <epoxy/gl.h>
#include <stdio.h>

static fg_status run_near(const fg_run *run, void *user)
{
    const ag_near_pass *pass = user;
    const fg_gl_program_desc desc = {
        .shaders = { &near_patches_comp },
        .defines = pass->paraboloid ? "VISIBILITY=2" : "",
    };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, pass->scene.view);
    fg_gl_sample(run, 0, pass->position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, pass->normal, FG_GL_NEAREST);
    fg_gl_sample(run, 2, pass->in, FG_GL_NEAREST);
    fg_gl_storage(run, 0, pass->vpls);
    fg_gl_storage(run, 1, pass->count);
    fg_gl_image(run, 0, pass->out, 0, GL_WRITE_ONLY, FG_RGBA32F);
    if (pass->paraboloid)
        ag_paraboloid_bind(run, pass->paraboloid);
    int size[3];
    fg_run_size(run, pass->out, 0, size);
    glUseProgram(program);
    fg_gl_dispatch_2d(size[0], size[1], 16, 16);
    return FG_OK;
}

void ag_near_declare(ag_near_pass *pass, fg_graph *g, const ag_scene_res *scene,
                     const ag_gbuffer *gbuffer, const ag_vpl_pass *vpls, const ag_near_desc *desc)
{
    char name[64], texture[64];
    snprintf(name, sizeof name, "%s.near", desc->prefix);
    snprintf(texture, sizeof texture, "%s.with_near", desc->prefix);
    *pass = (ag_near_pass){
        .scene = *scene,
        .position = gbuffer->position,
        .normal = gbuffer->normal,
        .vpls = vpls->vpls,
        .count = vpls->count,
        .in = desc->in,
        .out = fg_texture(g, texture, &(fg_tex_desc){ .format = FG_RGBA32F }),
        .paraboloid = desc->paraboloid,
    };
    const ag_paraboloid_pass none = { 0 }, *maps = desc->paraboloid ? desc->paraboloid : &none;
    const fg_pass_desc near = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = {
            { scene->view, FG_USE_UNIFORM },
            { pass->position },
            { pass->normal },
            { pass->in },
            { pass->vpls },
            { pass->count },
            { maps->maps, .optional = !desc->paraboloid },
            { maps->eyes, .optional = !desc->paraboloid },
        },
        .writes = { { pass->out, FG_USE_IMAGE, FG_LOAD_DISCARD } },
        .run = run_near,
        .user = pass,
    };
    fg_passes(g, &near, 1);
}
