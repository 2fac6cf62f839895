// SPDX-License-Identifier: MIT
#include "vpl_priv.h"

#include <pass/vpl_shared.h>

#include "vpl_build_comp.h"
#include "vpl_pack_comp.h"

#include <assert.h>
#include <epoxy/gl.h>
#include <stdio.h>

static_assert(sizeof(ag_vpl) == 48, "std430 layout of ag_vpl");

enum { MAX_GROUPS = 65535 }; // along one axis, as every device has them

static void upload_plan(const fg_run *run, const ag_vpl_pass *pass, int rows)
{
    const uint32_t zero = 0;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // shaders may have written there
    glNamedBufferSubData(fg_run_object(run, pass->table), 0,
                         (GLsizeiptr) ((size_t) (1 + rows) * sizeof pass->rows[0]), pass->rows);
    glClearNamedBufferData(fg_run_object(run, pass->groups), GL_R32UI, GL_RED_INTEGER,
                           GL_UNSIGNED_INT, &zero);
}

static fg_status run_build(const fg_run *run, void *user)
{
    ag_vpl_pass *pass = user;
    const fg_gl_program_desc desc = { .shaders = { &vpl_build_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    const int wide = vpl_wide_block(fg_gl_software(fg_run_device(run)));
    upload_plan(run, pass, vpl_plan(pass, wide));
    fg_gl_sample(run, 0, pass->position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, pass->normal, FG_GL_NEAREST);
    fg_gl_sample(run, 2, pass->flux, FG_GL_NEAREST);
    fg_gl_storage(run, 0, pass->blocks);
    fg_gl_storage(run, 1, pass->groups);
    fg_gl_storage(run, 2, pass->faces);
    fg_gl_storage(run, 3, pass->table);
    glProgramUniform1ui(program, 0, pass->seed);
    glProgramUniform1i(program, 1, wide);
    glUseProgram(program);
    // More groups than fit along one axis fill rows.
    const int groups = pass->rows[0][1], along = groups < MAX_GROUPS ? groups : MAX_GROUPS;
    if (groups > 0)
        fg_gl_dispatch_2d(along, (groups + along - 1) / along, 1, 1);
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
    glProgramUniform1i(program, 0, pass->total);
    glUseProgram(program);
    fg_gl_dispatch_2d(pass->total > 0 ? pass->total : 1, 1, VPL_GROUP, 1); // none are counted too
    return FG_OK;
}

static fg_res named_buffer(fg_graph *g, const char *prefix, const char *what, uint64_t size)
{
    char name[64];
    snprintf(name, sizeof name, "%s.%s", prefix, what);
    return fg_buffer(g, name, &(fg_buf_desc){ .size = size });
}

static void declare_build(ag_vpl_pass *pass, fg_graph *g, const char *prefix)
{
    char name[64];
    snprintf(name, sizeof name, "%s.build", prefix);
    const fg_pass_desc build = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = { { pass->position },
                   { pass->normal },
                   { pass->flux },
                   { pass->faces, FG_USE_STORAGE } },
        .writes = { { pass->table, FG_USE_STORAGE, FG_LOAD_DISCARD },
                    { pass->blocks, FG_USE_STORAGE, FG_LOAD_DISCARD },
                    { pass->groups, FG_USE_STORAGE, FG_LOAD_DISCARD } },
        .run = run_build,
        .user = pass,
    };
    fg_passes(g, &build, 1);
}

void ag_vpl_pack_declare(ag_vpl_pass *pass, fg_graph *g, const char *prefix)
{
    char name[64];
    snprintf(name, sizeof name, "%s.pack", prefix);
    pass->vpls = named_buffer(g, prefix, "vpls", (uint64_t) pass->capacity * sizeof(ag_vpl));
    pass->count = named_buffer(g, prefix, "count", 4 * sizeof(uint32_t));
    const fg_pass_desc pack = {
        .name = name,
        .kind = FG_KIND_COMPUTE,
        .reads = { { pass->blocks }, { pass->groups } },
        .writes = { { pass->vpls, FG_USE_STORAGE, FG_LOAD_DISCARD },
                    { pass->count, FG_USE_STORAGE, FG_LOAD_DISCARD } },
        .run = run_pack,
        .user = pass,
    };
    fg_passes(g, &pack, 1);
}

// False, and said to the graph, where one buffer or one dispatch cannot take all VPLs.
static bool fits_device(const ag_vpl_pass *pass, fg_graph *g, const char *prefix)
{
    const int64_t vpls = pass->capacity, bytes = vpls * (int64_t) sizeof(ag_vpl);
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    const int64_t fit = most / (int64_t) sizeof(ag_vpl);
    const int64_t flat = (int64_t) MAX_GROUPS * VPL_GROUP, limit = fit < flat ? fit : flat;
    if (vpls <= limit)
        return true;
    fg_fail(g, "%s: %lld VPLs in %.0f MiB, the device takes %lld", prefix, (long long) vpls,
            (double) bytes / 1048576, (long long) limit);
    return false;
}

// False, and said to the graph, where the descriptor is wrong.
static bool is_sound(const ag_vpl_pass *pass, fg_graph *g, const char *prefix)
{
    if (pass->grid == 0 && pass->budget < 1)
        fg_fail(g, "%s: a budget of %d VPLs, must be at least 1", prefix, pass->budget);
    else if (pass->grid < 0 || pass->grid > pass->size ||
             (pass->grid > 0 && pass->size % pass->grid != 0))
        fg_fail(g, "%s: a grid of %d VPLs does not divide %d texels", prefix, pass->grid,
                pass->size);
    else
        return true;
    return false;
}

// What the frames' lights may come to need.
static int capacity_of(const ag_vpl_pass *pass)
{
    const int most = pass->grid ? pass->grid : pass->size;
    const int all = most * most * pass->face_count; // below 2^28
    return pass->grid || all - pass->face_count < pass->budget ? all
                                                               : pass->budget + pass->face_count;
}

void ag_vpl_declare(ag_vpl_pass *pass, fg_graph *g, const ag_rsm_pass *rsm, const ag_vpl_desc *desc)
{
    *pass = (ag_vpl_pass){
        .gpu = rsm->gpu,
        .position = rsm->position,
        .normal = rsm->normal,
        .flux = rsm->flux,
        .faces = rsm->scene.faces,
        .size = rsm->size,
        .face_count = rsm->face_count,
        .pattern = desc->pattern,
        .grid = desc->pattern == AG_VPL_ALL ? rsm->size : desc->grid,
        .budget = desc->budget,
        .seed = desc->seed,
    };
    if (!is_sound(pass, g, desc->prefix))
        return;
    pass->capacity = capacity_of(pass);
    if (!fits_device(pass, g, desc->prefix))
        return;
    const uint64_t groups = ((uint64_t) pass->capacity + VPL_GROUP - 1) / VPL_GROUP;
    pass->table = named_buffer(g, desc->prefix, "table",
                               (1 + (uint64_t) pass->face_count) * sizeof pass->rows[0]);
    pass->blocks =
        named_buffer(g, desc->prefix, "blocks", (uint64_t) pass->capacity * sizeof(ag_vpl));
    pass->groups = named_buffer(g, desc->prefix, "groups", groups * sizeof(uint32_t));
    declare_build(pass, g, desc->prefix);
    ag_vpl_pack_declare(pass, g, desc->prefix);
}
