// SPDX-License-Identifier: MIT
#include "hisr.h"

#include "hisr_gather_comp.h"
#include "hisr_gather_frag.h"
#include "hisr_shared.h"
#include "passes/fullscreen_vert.h"

#include <epoxy/gl.h>
#include <stdio.h>

// As in passes/gather/gather.c.
static int suitable_block(fg_device *device)
{
    return fg_gl_software(device) ? 16 : 4;
}

// Nodes that an invocation looks at in one dispatch; the next goes on where it stopped. Mesa's
// software renderer leaves every loop of an invocation for good after 65535 rounds of all of them
// together, and a node takes 17 at most: its own and one for each receiver that it is near to. A
// GPU gets as much as keeps its watchdog still.
static int suitable_steps(fg_device *device)
{
    return fg_gl_software(device) ? 3800 : 16384;
}

static bool by_stencil(const hisr_gather *gather)
{
    return gather->multires->cull == AG_CULL_STENCIL;
}

static int block_of(fg_device *device, const hisr_gather *gather)
{
    return gather->desc.block ? gather->desc.block : suitable_block(device);
}

static uint32_t gather_program(fg_device *device, const hisr_gather *gather)
{
    static const int clamps[] = { 3, 1, 0, 2 }; // by ag_clamp, as gather.glsl numbers them
    const hisr_gather_desc *desc = &gather->desc;
    char what[32], defines[64];
    fg_gl_program_desc program = { .shaders = { &gather_comp }, .defines = defines };
    if (desc->cut)
        snprintf(what, sizeof what, "CUT=1");
    else
        snprintf(what, sizeof what, "CLAMP=%d%s", clamps[desc->clamp],
                 desc->visibility ? ";VISIBILITY=1" : "");
    snprintf(defines, sizeof defines, "BOUND=%d;%s;BLOCK=%d", desc->bound == HISR_BOUND_PAPER, what,
             block_of(device, gather));
    if (by_stencil(gather)) {
        program.shaders[0] = &fullscreen_vert;
        program.shaders[1] = &gather_frag;
        snprintf(defines, sizeof defines, "BOUND=%d;%s", desc->bound == HISR_BOUND_PAPER, what);
    }
    return fg_gl_program(device, &program);
}

static void bind_gather(const fg_run *run, const hisr_gather *gather)
{
    const hisr_tree *tree = gather->tree;
    const ag_multires_pass *multires = gather->multires;
    const uint32_t zero = 0;
    fg_gl_uniform(run, 0, multires->scene.view);
    fg_gl_sample(run, 0, multires->position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, multires->normal, FG_GL_NEAREST);
    fg_gl_storage(run, 0, tree->nodes);
    fg_gl_storage(run, 1, tree->total);
    if (by_stencil(gather)) {
        glDepthFunc(GL_ALWAYS);
        glEnable(GL_STENCIL_TEST);
        glStencilFunc(GL_EQUAL, 1, 0xff);
        glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    } else {
        fg_gl_storage(run, 2, multires->texels);
        fg_gl_storage(run, 3, multires->count);
        glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, fg_run_object(run, multires->count));
    }
    fg_gl_storage(run, 5, gather->progress);
    fg_gl_storage(run, 6, gather->visited);
    fg_gl_image(run, 0, gather->out, 0, GL_READ_WRITE, FG_RGBA32F);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // shaders of the last frame wrote there
    glClearNamedBufferData(fg_run_object(run, gather->visited), GL_R32UI, GL_RED_INTEGER,
                           GL_UNSIGNED_INT, &zero);
}

static fg_status run_gather(const fg_run *run, void *user)
{
    const hisr_gather *gather = user;
    const hisr_gather_desc *desc = &gather->desc;
    fg_device *device = fg_run_device(run);
    const uint32_t program = gather_program(device, gather);
    if (!program)
        return FG_ERR_SHADER;
    bind_gather(run, gather);
    const int steps = suitable_steps(device), nodes = hisr_tree_nodes(gather->tree, desc->finest);
    const ag_pyramid *pyramid = &gather->multires->pyramid;
    glProgramUniform1f(program, 1, desc->tau);
    if (desc->clamp == AG_CLAMP_CONSTANT && !desc->cut)
        glProgramUniform1f(program, 2, desc->clamp_d2);
    if (desc->visibility) {
        ag_ism_bind(run, desc->visibility);
        glProgramUniform2i(program, 4, gather->tree->eye_level, gather->tree->eye_count);
    }
    glProgramUniform2i(program, 3, pyramid->base[0], pyramid->base[1]);
    glUseProgram(program);
    const int block = block_of(device, gather);
    const int offset = block == 16 ? 48 : block == 4 ? 32 : 16; // of its dispatch in the counts
    for (int first = 0; first < nodes; first += steps) {
        if (first > 0)
            glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
        glProgramUniform4i(program, 0, gather->tree->roots, desc->finest, steps, first > 0);
        if (by_stencil(gather))
            fg_gl_fullscreen(run);
        else
            glDispatchComputeIndirect(offset);
    }
    return FG_OK;
}

static fg_res named_buffer(fg_graph *g, const char *prefix, const char *what, uint64_t size)
{
    char name[64];
    snprintf(name, sizeof name, "%s.%s", prefix, what);
    return fg_buffer(g, name, &(fg_buf_desc){ .size = size });
}

void hisr_gather_declare(hisr_gather *gather, fg_graph *g, const hisr_tree *tree,
                         const ag_multires_pass *multires, const hisr_gather_desc *desc)
{
    *gather = (hisr_gather){ .tree = tree, .multires = multires, .desc = *desc };
    const int *size = multires->pyramid.size;
    const fg_tex_desc image = { .format = FG_RGBA32F, .width = size[0], .height = size[1] };
    const bool stencil = by_stencil(gather);
    const uint64_t receivers =
        stencil ? (uint64_t) size[0] * size[1] : (uint64_t) multires->capacity;
    char illumination[64], name[64];
    snprintf(illumination, sizeof illumination, "%s.illumination", desc->prefix);
    snprintf(name, sizeof name, "%s.gather", desc->prefix);
    gather->out = fg_texture(g, illumination, &image);
    gather->progress = named_buffer(g, desc->prefix, "progress", receivers * sizeof(uint32_t));
    gather->visited = named_buffer(g, desc->prefix, "visited", 4 * sizeof(uint32_t));
    const ag_ism_pass unshadowed = { 0 }, *ism = desc->visibility ? desc->visibility : &unshadowed;
    const fg_res none = { 0 }, texels = stencil ? none : multires->texels,
                 count = stencil ? none : multires->count;
    const fg_pass_desc pass = {
        .name = name,
        .kind = stencil ? FG_KIND_RASTER : FG_KIND_COMPUTE,
        .reads = { { multires->scene.view, FG_USE_UNIFORM },
                   { multires->position },
                   { multires->normal },
                   { tree->nodes },
                   { tree->total },
                   { ism->maps, .optional = true },
                   { ism->eyes, .optional = true },
                   { texels, .optional = true },
                   { count, .optional = true },
                   { count, FG_USE_INDIRECT, .optional = true },
                   { multires->stencil, FG_USE_DEPTH, .optional = true } },
        .writes = { { gather->out, FG_USE_IMAGE },
                    { gather->progress, FG_USE_STORAGE, FG_LOAD_DISCARD },
                    { gather->visited, FG_USE_STORAGE, FG_LOAD_DISCARD } },
        .run = run_gather,
        .user = gather,
    };
    fg_passes(g, &pass, 1);
}
