// SPDX-License-Identifier: MIT
#include <pass/vpl.h>

#include "dots_frag.h"
#include "dots_vert.h"
#include "fullscreen_vert.h"
#include "tone_frag.h"

#include <epoxy/gl.h>
#include <stdio.h>

static double power_of_lights(const ag_gpu_scene *gpu)
{
    double sum = 0;
    for (int i = 0; i < ag_gpu_scene_face_count(gpu); i++)
        sum += ag_gpu_scene_face_power(gpu, i);
    return sum;
}

static fg_status run_dots(const fg_run *run, void *user)
{
    const ag_vpl_dots_pass *pass = user;
    fg_device *device = fg_run_device(run);
    const fg_gl_program_desc tone = { .shaders = { &fullscreen_vert, &tone_frag } };
    const fg_gl_program_desc dots = { .shaders = { &dots_vert, &dots_frag } };
    const uint32_t background = fg_gl_program(device, &tone);
    const uint32_t program = fg_gl_program(device, &dots);
    if (!background || !program)
        return FG_ERR_SHADER;
    fg_gl_sample(run, 0, pass->direct, FG_GL_NEAREST);
    glProgramUniform1f(background, 0, 1);
    glUseProgram(background);
    fg_gl_fullscreen(run);
    fg_gl_uniform(run, 0, pass->view);
    fg_gl_storage(run, 0, pass->vpls);
    fg_gl_storage(run, 1, pass->count);
    fg_gl_sample(run, 0, pass->depth, FG_GL_NEAREST);
    glProgramUniform1f(program, 0, (float) power_of_lights(pass->gpu));
    glUseProgram(program);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, pass->capacity);
    return FG_OK;
}

void ag_vpl_dots_declare(ag_vpl_dots_pass *pass, fg_graph *g, const ag_gpu_scene *gpu,
                         const ag_vpl_pass *vpls, const ag_vpl_dots_desc *desc)
{
    char name[64];
    snprintf(name, sizeof name, "%s.vpls_layer", desc->prefix);
    *pass = (ag_vpl_dots_pass){
        .gpu = gpu,
        .view = desc->scene->view,
        .direct = desc->direct,
        .depth = desc->gbuffer->depth,
        .vpls = vpls->vpls,
        .count = vpls->count,
        .capacity = vpls->capacity,
        .out = fg_texture(g, name, &(fg_tex_desc){ .format = FG_RGBA16F }),
    };
    const fg_pass_desc dots = {
        .name = name,
        .reads = { { pass->view, FG_USE_UNIFORM },
                   { pass->direct },
                   { pass->depth },
                   { pass->vpls, FG_USE_STORAGE },
                   { pass->count, FG_USE_STORAGE } },
        .writes = { { pass->out, FG_USE_COLOR, FG_LOAD_DISCARD } },
        .run = run_dots,
        .user = pass,
    };
    fg_passes(g, &dots, 1);
}
