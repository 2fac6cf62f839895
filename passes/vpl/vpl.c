// SPDX-License-Identifier: MIT
#include <pass/vpl.h>
#include <pass/vpl_shared.h>

#include "vpl_build_comp.h"
#include "vpl_pack_comp.h"

#include <assert.h>
#include <epoxy/gl.h>
#include <stdio.h>

static_assert(sizeof(ag_vpl) == 48, "std430 layout of ag_vpl");

enum {
    GROUP = 256,        // VPLs of one work group, both shaders
    MAX_GROUPS = 65535, // along one axis, as every device has them
    WIDE_BLOCK = 16,    // texels along the edge of a block from which on a work group sums it
};

static bool is_wide(const ag_vpl_pass *pass)
{
    return pass->block >= WIDE_BLOCK;
}

// A work group a VPL; more than fit along one axis fill rows.
static void dispatch_wide(const fg_run *run, const ag_vpl_pass *pass)
{
    const uint32_t zero = 0;
    const int row = pass->capacity < MAX_GROUPS ? pass->capacity : MAX_GROUPS;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // shaders of the last frame wrote there
    glClearNamedBufferData(fg_run_object(run, pass->groups), GL_R32UI, GL_RED_INTEGER,
                           GL_UNSIGNED_INT, &zero);
    fg_gl_dispatch_2d(row, (pass->capacity + row - 1) / row, 1, 1);
}

static fg_status run_build(const fg_run *run, void *user)
{
    const ag_vpl_pass *pass = user;
    const fg_gl_program_desc desc = {
        .shaders = { &vpl_build_comp },
        .defines = is_wide(pass) ? "WIDE=1" : "",
    };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_sample(run, 0, pass->position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, pass->normal, FG_GL_NEAREST);
    fg_gl_sample(run, 2, pass->flux, FG_GL_NEAREST);
    fg_gl_storage(run, 0, pass->blocks);
    fg_gl_storage(run, 1, pass->groups);
    fg_gl_storage(run, 2, pass->faces);
    glProgramUniform4i(program, 0, pass->grid, pass->block, pass->capacity,
                       pass->pattern == AG_VPL_STRATIFIED);
    glProgramUniform1ui(program, 1, pass->seed);
    glUseProgram(program);
    if (is_wide(pass))
        dispatch_wide(run, pass);
    else
        fg_gl_dispatch_2d(pass->capacity, 1, GROUP, 1);
    return FG_OK;
}

static fg_status run_pack(const fg_run *run, void *user)
{
    const ag_vpl_pass *pass = user;
    const fg_gl_program_desc desc = { .shaders = { &vpl_pack_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_storage(run, 0, pass->blocks);
    fg_gl_storage(run, 1, pass->groups);
    fg_gl_storage(run, 2, pass->vpls);
    fg_gl_storage(run, 3, pass->count);
    glProgramUniform1i(program, 0, pass->capacity);
    glUseProgram(program);
    fg_gl_dispatch_2d(pass->capacity, 1, GROUP, 1);
    return FG_OK;
}

static fg_res named_buffer(fg_graph *g, const char *prefix, const char *what, uint64_t size)
{
    char name[64];
    snprintf(name, sizeof name, "%s.%s", prefix, what);
    return fg_buffer(g, name, &(fg_buf_desc){ .size = size });
}

static void declare_passes(ag_vpl_pass *pass, fg_graph *g, const char *prefix)
{
    char build[64], pack[64];
    snprintf(build, sizeof build, "%s.build", prefix);
    snprintf(pack, sizeof pack, "%s.pack", prefix);
    const fg_pass_desc passes[] = {
        {
            .name = build,
            .kind = FG_KIND_COMPUTE,
            .reads = { { pass->position },
                       { pass->normal },
                       { pass->flux },
                       { pass->faces, FG_USE_STORAGE } },
            .writes = { { pass->blocks, FG_USE_STORAGE, FG_LOAD_DISCARD },
                        { pass->groups, FG_USE_STORAGE, FG_LOAD_DISCARD } },
            .run = run_build,
            .user = pass,
        },
        {
            .name = pack,
            .kind = FG_KIND_COMPUTE,
            .reads = { { pass->blocks }, { pass->groups } },
            .writes = { { pass->vpls, FG_USE_STORAGE, FG_LOAD_DISCARD },
                        { pass->count, FG_USE_STORAGE, FG_LOAD_DISCARD } },
            .run = run_pack,
            .user = pass,
        },
    };
    fg_passes(g, passes, FG_COUNT(passes));
}

// False, and said to the graph, where one buffer or one dispatch cannot take all VPLs.
static bool fits_device(const ag_vpl_pass *pass, fg_graph *g, const char *prefix)
{
    const int64_t vpls = pass->capacity, bytes = vpls * (int64_t) sizeof(ag_vpl);
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    const int64_t fit = most / (int64_t) sizeof(ag_vpl);
    const int64_t flat = (int64_t) MAX_GROUPS * GROUP, limit = fit < flat ? fit : flat;
    if (vpls <= limit)
        return true;
    fg_fail(g, "%s: %lld VPLs in %.0f MiB, the device takes %lld", prefix, (long long) vpls,
            (double) bytes / 1048576, (long long) limit);
    return false;
}

void ag_vpl_declare(ag_vpl_pass *pass, fg_graph *g, const ag_rsm_pass *rsm, const ag_vpl_desc *desc)
{
    const int grid = desc->pattern == AG_VPL_ALL ? rsm->size : desc->grid;
    *pass = (ag_vpl_pass){
        .position = rsm->position,
        .normal = rsm->normal,
        .flux = rsm->flux,
        .faces = rsm->scene.faces,
        .pattern = desc->pattern,
        .seed = desc->seed,
        .grid = grid,
    };
    if (grid < 1 || grid > rsm->size || rsm->size % grid != 0) {
        fg_fail(g, "%s: a grid of %d VPLs does not divide %d texels", desc->prefix, grid,
                rsm->size);
        return;
    }
    pass->block = rsm->size / grid;
    pass->capacity = grid * grid * rsm->face_count;
    if (!fits_device(pass, g, desc->prefix))
        return;
    const uint64_t bytes = (uint64_t) pass->capacity * sizeof(ag_vpl);
    const uint64_t groups = ((uint64_t) pass->capacity + GROUP - 1) / GROUP;
    pass->blocks = named_buffer(g, desc->prefix, "blocks", bytes);
    pass->groups = named_buffer(g, desc->prefix, "groups", groups * sizeof(uint32_t));
    pass->vpls = named_buffer(g, desc->prefix, "vpls", bytes);
    pass->count = named_buffer(g, desc->prefix, "count", 4 * sizeof(uint32_t));
    declare_passes(pass, g, desc->prefix);
}
