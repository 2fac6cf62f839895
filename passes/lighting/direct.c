// SPDX-License-Identifier: MIT
#include <pass/lighting.h>

#include "direct_comp.h"

#include <epoxy/gl.h>
#include <string.h>

static fg_status run_direct(const fg_run *run, void *user)
{
    const ag_direct_pass *pass = user;
    const ag_gbuffer *in = &pass->gbuffer;
    const bool lit = pass->shadows.id && fg_run_object(run, pass->shadows);
    const bool emits = in->emissive.id != 0;
    static const char *const defines[2][3] = {
        { "", "LIGHTS=1", "LIGHTS=1;TAPS=16" },
        { "EMISSIVE=1", "LIGHTS=1;EMISSIVE=1", "LIGHTS=1;EMISSIVE=1;TAPS=16" },
    };
    const fg_gl_program_desc desc = {
        .shaders = { &direct_comp },
        .defines = defines[emits][lit ? 1 + (pass->taps == 16) : 0],
    };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, pass->scene.view);
    fg_gl_sample(run, 0, in->normal, FG_GL_NEAREST);
    fg_gl_sample(run, 1, in->position, FG_GL_NEAREST);
    fg_gl_sample(run, 2, in->albedo, FG_GL_NEAREST);
    fg_gl_sample(run, 3, in->face, FG_GL_NEAREST);
    if (emits)
        fg_gl_sample(run, 4, in->emissive, FG_GL_NEAREST);
    if (lit) {
        fg_gl_sample(run, 5, pass->shadows, FG_GL_NEAREST);
        fg_gl_storage(run, 0, pass->scene.lights);
        fg_gl_storage(run, 1, pass->scene.faces);
    }
    fg_gl_image(run, 0, pass->out, 0, GL_WRITE_ONLY, FG_RGBA32F);
    int size[3];
    fg_run_size(run, pass->out, 0, size);
    glUseProgram(program);
    fg_gl_dispatch_2d(size[0], size[1], 8, 8);
    return FG_OK;
}

void ag_direct_declare(ag_direct_pass *pass, fg_graph *g, const ag_gpu_scene *gpu,
                       const ag_direct_desc *desc)
{
    const ag_scene_res *scene = desc->scene;
    const ag_gbuffer *gbuffer = desc->gbuffer;
    *pass = (ag_direct_pass){
        .gpu = gpu,
        .scene = *scene,
        .gbuffer = *gbuffer,
        .shadows = desc->shadows,
        .taps = desc->taps,
        .out = fg_texture(g, "direct.radiance", &(fg_tex_desc){ .format = FG_RGBA32F }),
    };
    if (desc->taps != 0 && desc->taps != 4 && desc->taps != 16)
        fg_fail(g, "direct: taps is %d, must be 4 or 16", desc->taps);
    const fg_pass_desc light = {
        .name = "direct.light",
        .kind = FG_KIND_COMPUTE,
        .reads = {
            { scene->view, FG_USE_UNIFORM },
            { gbuffer->normal },
            { gbuffer->position },
            { gbuffer->albedo },
            { gbuffer->face },
            { scene->lights, FG_USE_STORAGE },
            { scene->faces, FG_USE_STORAGE },
            { gbuffer->emissive, .optional = true },
            { desc->shadows, .optional = true },
        },
        .writes = { { pass->out, FG_USE_IMAGE, FG_LOAD_DISCARD } },
        .run = run_direct,
        .user = pass,
    };
    fg_passes(g, &light, 1);
}
