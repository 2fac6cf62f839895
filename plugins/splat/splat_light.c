// SPDX-License-Identifier: MIT
#include "splat_priv.h"
#include "splat_shared.h"

#include "splat_prepare_comp.h"
#include "splat_splat_frag.h"
#include "splat_splat_vert.h"

#include <assert.h>
#include <epoxy/gl.h>

static_assert(sizeof(splat_light) == 48, "std430 layout of splat_light");

// A VPL is an instance's attributes.
void splat_light_init(splat_light_pass *pass)
{
    glCreateVertexArrays(1, &pass->vertex_array);
    for (GLuint i = 0; i < 3; i++) {
        glEnableVertexArrayAttrib(pass->vertex_array, i);
        glVertexArrayAttribFormat(pass->vertex_array, i, 4, GL_FLOAT, GL_FALSE, 16 * i);
        glVertexArrayAttribBinding(pass->vertex_array, i, 0);
    }
    glVertexArrayBindingDivisor(pass->vertex_array, 0, 1);
}

void splat_light_finish(splat_light_pass *pass)
{
    glDeleteVertexArrays(1, &pass->vertex_array); // ignores 0
}

static fg_status run_prepare(const fg_run *run, void *user)
{
    const splat_light_pass *pass = user;
    const fg_gl_program_desc desc = { .shaders = { &prepare_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, pass->scene.view);
    fg_gl_storage(run, 0, pass->vpls);
    fg_gl_storage(run, 1, pass->count);
    fg_gl_storage(run, 2, pass->refine->patches);
    fg_gl_storage(run, 3, pass->lights);
    fg_gl_storage(run, 4, pass->draw);
    glProgramUniform1f(program, 0, pass->reach);
    glUseProgram(program);
    glDispatchCompute(1, 1, 1);
    return FG_OK;
}

static fg_status run_splat(const fg_run *run, void *user)
{
    const splat_light_pass *pass = user;
    const fg_gl_program_desc desc = { .shaders = { &splat_vert, &splat_frag } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_sample(run, 0, pass->refine->positions, FG_GL_NEAREST);
    fg_gl_sample(run, 1, pass->refine->normals, FG_GL_NEAREST);
    glVertexArrayVertexBuffer(pass->vertex_array, 0, fg_run_object(run, pass->lights), 0,
                              sizeof(splat_light));
    glBindVertexArray(pass->vertex_array);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, fg_run_object(run, pass->draw));
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
    glDisable(GL_PROGRAM_POINT_SIZE);
    glPointSize(1);
    glUseProgram(program);
    glDrawArraysIndirect(GL_POINTS, NULL);
    glDisable(GL_BLEND);
    glBindVertexArray(0);
    return FG_OK;
}

void splat_light_declare(splat_light_pass *pass, fg_graph *g, const splat_refine_pass *refine,
                         const ag_vpl_pass *vpls, float reach)
{
    const ag_pyramid *pyramid = &refine->multires->pyramid;
    const uint64_t bytes = (uint64_t) vpls->capacity * sizeof(splat_light);
    const fg_tex_desc image = {
        .format = FG_RGBA32F,
        .width = pyramid->size[0],
        .height = pyramid->size[1],
    };
    *pass = (splat_light_pass){
        .scene = refine->multires->scene,
        .refine = refine,
        .vpls = vpls->vpls,
        .count = vpls->count,
        .lights = fg_buffer(g, "splat.lights", &(fg_buf_desc){ .size = bytes }),
        .draw = fg_buffer(g, "splat.draw", &(fg_buf_desc){ .size = 16 }),
        .out = fg_texture(g, "splat.image", &image),
        .reach = reach,
        .vertex_array = pass->vertex_array,
    };
    const fg_pass_desc passes[] = {
        {
            .name = "splat.vpl_splats",
            .kind = FG_KIND_COMPUTE,
            .reads = { { pass->scene.view, FG_USE_UNIFORM },
                       { pass->vpls },
                       { pass->count },
                       { refine->patches } },
            .writes = { { pass->lights, FG_USE_STORAGE, FG_LOAD_DISCARD },
                        { pass->draw, FG_USE_STORAGE, FG_LOAD_DISCARD } },
            .run = run_prepare,
            .user = pass,
        },
        {
            .name = "splat.splat",
            .reads = { { refine->positions },
                       { refine->normals },
                       { pass->lights, FG_USE_VERTEX },
                       { pass->draw, FG_USE_INDIRECT } },
            .writes = { { pass->out, FG_USE_COLOR, FG_LOAD_CLEAR } },
            .run = run_splat,
            .user = pass,
        },
    };
    fg_passes(g, passes, FG_COUNT(passes));
}
