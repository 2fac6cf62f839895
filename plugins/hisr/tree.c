// SPDX-License-Identifier: MIT
#include "hisr.h"

#include "hisr_eyes_comp.h"
#include "hisr_shared.h"
#include "hisr_total_comp.h"
#include "hisr_tree_comp.h"

#include <assert.h>
#include <epoxy/gl.h>

static_assert(sizeof(hisr_node) == 64, "std430 layout of hisr_node");

enum { GROUP = 64, MAX_GROUPS = 65535, MAX_EYES = 1024 };

int hisr_tree_nodes(const hisr_tree *tree, int level)
{
    return HISR_LEVEL_START(tree->roots, level + 1);
}

static fg_status run_level(const fg_run *run, const hisr_tree *tree, int level)
{
    const bool leaf = level == tree->levels - 1;
    const fg_gl_program_desc desc = {
        .shaders = { &tree_comp },
        .defines = leaf ? "LEAF=1" : "",
    };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    const int count = tree->roots << 2 * level;
    if (!program)
        return FG_ERR_SHADER;
    if (!leaf)
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    glProgramUniform4i(program, 0, count, count / tree->face_count,
                       HISR_LEVEL_START(tree->roots, level),
                       HISR_LEVEL_START(tree->roots, level + 1));
    glUseProgram(program);
    fg_gl_dispatch_2d(count, 1, GROUP, 1);
    return FG_OK;
}

static fg_status run_total(const fg_run *run, const hisr_tree *tree)
{
    const fg_gl_program_desc desc = { .shaders = { &total_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_storage(run, 1, tree->total);
    glProgramUniform1i(program, 0, tree->roots);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    glUseProgram(program);
    glDispatchCompute(1, 1, 1);
    return FG_OK;
}

static fg_status run_tree(const fg_run *run, void *user)
{
    const hisr_tree *tree = user;
    fg_status status = FG_OK;
    fg_gl_sample(run, 0, tree->position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, tree->normal, FG_GL_NEAREST);
    fg_gl_sample(run, 2, tree->flux, FG_GL_NEAREST);
    fg_gl_storage(run, 0, tree->nodes);
    fg_gl_storage(run, 1, tree->faces);
    for (int level = tree->levels - 1; level >= 0 && status == FG_OK; level--)
        status = run_level(run, tree, level);
    return status == FG_OK ? run_total(run, tree) : status;
}

// False, and said to the graph, where one buffer or one dispatch cannot take all nodes.
static bool fits_device(fg_graph *g, int64_t nodes)
{
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    const int64_t fit = most / (int64_t) sizeof(hisr_node);
    const int64_t flat = (int64_t) MAX_GROUPS * GROUP, limit = fit < flat ? fit : flat;
    if (nodes <= limit)
        return true;
    fg_fail(g, "hisr: a tree of %lld nodes in %.0f MiB, the device takes %lld", (long long) nodes,
            (double) nodes * sizeof(hisr_node) / 1048576, (long long) limit);
    return false;
}

void hisr_tree_declare(hisr_tree *tree, fg_graph *g, const ag_rsm_pass *rsm)
{
    const int edge = rsm->size < HISR_ROOTS ? rsm->size : HISR_ROOTS;
    *tree = (hisr_tree){
        .position = rsm->position,
        .normal = rsm->normal,
        .flux = rsm->flux,
        .faces = rsm->scene.faces,
        .roots = edge * edge * rsm->face_count,
        .levels = 1,
        .face_count = rsm->face_count,
    };
    while (edge << (tree->levels - 1) < rsm->size)
        tree->levels++;
    // At most 256 faces of 1024 x 1024 texels: 3.6e8 nodes.
    const int nodes = hisr_tree_nodes(tree, tree->levels - 1);
    if (!fits_device(g, nodes))
        return;
    const fg_buf_desc buffer = { .size = (uint64_t) nodes * sizeof(hisr_node) };
    tree->nodes = fg_buffer(g, "hisr.nodes", &buffer);
    tree->total = fg_buffer(g, "hisr.total", &(fg_buf_desc){ .size = sizeof(hisr_total) });
    const fg_pass_desc pass = {
        .name = "hisr.tree",
        .kind = FG_KIND_COMPUTE,
        .reads = { { tree->position },
                   { tree->normal },
                   { tree->flux },
                   { tree->faces, FG_USE_STORAGE } },
        .writes = { { tree->nodes, FG_USE_STORAGE, FG_LOAD_DISCARD },
                    { tree->total, FG_USE_STORAGE, FG_LOAD_DISCARD } },
        .run = run_tree,
        .user = tree,
    };
    fg_passes(g, &pass, 1);
}

static fg_status run_eyes(const fg_run *run, void *user)
{
    const hisr_tree *tree = user;
    const fg_gl_program_desc desc = { .shaders = { &eyes_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_storage(run, 0, tree->nodes);
    fg_gl_storage(run, 1, tree->eyes);
    fg_gl_storage(run, 2, tree->count);
    glProgramUniform4i(program, 0, tree->roots, tree->eye_level, tree->levels - 1, tree->eye_count);
    glUseProgram(program);
    fg_gl_dispatch_2d(tree->eye_count, 1, GROUP, 1);
    return FG_OK;
}

void hisr_eyes_declare(hisr_tree *tree, fg_graph *g)
{
    tree->eye_level = 0;
    while (tree->eye_level + 1 < tree->levels &&
           tree->roots << 2 * (tree->eye_level + 1) <= MAX_EYES)
        tree->eye_level++;
    tree->eye_count = tree->roots << 2 * tree->eye_level;
    const fg_buf_desc eyes = { .size = (uint64_t) tree->eye_count * sizeof(ag_vpl) };
    tree->eyes = fg_buffer(g, "hisr.eyes", &eyes);
    tree->count = fg_buffer(g, "hisr.eye_count", &(fg_buf_desc){ .size = 4 * sizeof(uint32_t) });
    const fg_pass_desc pass = {
        .name = "hisr.eyes",
        .kind = FG_KIND_COMPUTE,
        .reads = { { tree->nodes } },
        .writes = { { tree->eyes, FG_USE_STORAGE, FG_LOAD_DISCARD },
                    { tree->count, FG_USE_STORAGE, FG_LOAD_DISCARD } },
        .run = run_eyes,
        .user = tree,
    };
    fg_passes(g, &pass, 1);
}
