// SPDX-License-Identifier: MIT
#include "hisr.h"

#include "hisr_gather_comp.h"
#include "hisr_shared.h"

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

static int block_of(fg_device *device, const hisr_gather_desc *desc)
{
    return desc->block ? desc->block : suitable_block(device);
}

static uint32_t gather_program(fg_device *device, const hisr_gather_desc *desc)
{
    static const int clamps[] = { 3, 1, 0, 2 }; // by ag_clamp, as gather.comp numbers them
    char defines[64];
    snprintf(defines, sizeof defines, "BLOCK=%d;CLAMP=%d;BOUND=%d", block_of(device, desc),
             clamps[desc->clamp], desc->bound == HISR_BOUND_PAPER);
    const fg_gl_program_desc program = { .shaders = { &gather_comp }, .defines = defines };
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
    fg_gl_storage(run, 2, multires->texels);
    fg_gl_storage(run, 3, multires->count);
    fg_gl_storage(run, 4, gather->progress);
    fg_gl_storage(run, 5, gather->visited);
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
    const uint32_t program = gather_program(device, desc);
    if (!program)
        return FG_ERR_SHADER;
    bind_gather(run, gather);
    const int steps = suitable_steps(device), nodes = hisr_tree_nodes(gather->tree, desc->finest);
    const ag_pyramid *pyramid = &gather->multires->pyramid;
    glProgramUniform1f(program, 1, desc->tau);
    if (desc->clamp == AG_CLAMP_CONSTANT)
        glProgramUniform1f(program, 2, desc->clamp_d2);
    glProgramUniform2i(program, 3, pyramid->base[0], pyramid->base[1]);
    glUseProgram(program);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, fg_run_object(run, gather->multires->count));
    const int block = block_of(device, desc);
    const int offset = block == 16 ? 48 : block == 4 ? 32 : 16; // of its dispatch in the counts
    for (int first = 0; first < nodes; first += steps) {
        if (first > 0)
            glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
        glProgramUniform4i(program, 0, gather->tree->roots, desc->finest, steps, first > 0);
        glDispatchComputeIndirect(offset);
    }
    return FG_OK;
}

void hisr_gather_declare(hisr_gather *gather, fg_graph *g, const hisr_tree *tree,
                         const ag_multires_pass *multires, const hisr_gather_desc *desc)
{
    *gather = (hisr_gather){ .tree = tree, .multires = multires, .desc = *desc };
    const ag_pyramid *pyramid = &multires->pyramid;
    const fg_tex_desc image = {
        .format = FG_RGBA32F,
        .width = pyramid->size[0],
        .height = pyramid->size[1],
    };
    const fg_buf_desc words = { .size = (uint64_t) multires->capacity * sizeof(uint32_t) };
    gather->out = fg_texture(g, "hisr.illumination", &image);
    gather->progress = fg_buffer(g, "hisr.progress", &words);
    gather->visited = fg_buffer(g, "hisr.visited", &(fg_buf_desc){ .size = 2 * sizeof(uint32_t) });
    const fg_pass_desc pass = {
        .name = "hisr.gather",
        .kind = FG_KIND_COMPUTE,
        .reads = { { multires->scene.view, FG_USE_UNIFORM },
                   { multires->position },
                   { multires->normal },
                   { tree->nodes },
                   { tree->total },
                   { multires->texels },
                   { multires->count },
                   { multires->count, FG_USE_INDIRECT } },
        .writes = { { gather->out, FG_USE_IMAGE, FG_LOAD_DISCARD },
                    { gather->progress, FG_USE_STORAGE, FG_LOAD_DISCARD },
                    { gather->visited, FG_USE_STORAGE, FG_LOAD_DISCARD } },
        .run = run_gather,
        .user = gather,
    };
    fg_passes(g, &pass, 1);
}
