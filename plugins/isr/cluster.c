// SPDX-License-Identifier: MIT
#include "cluster.h"

#include "isr_cluster_choose_comp.h"
#include "isr_cluster_sum_comp.h"

#include <epoxy/gl.h>
#include <math.h>
#include <pass/vpl_shared.h>
#include <stdio.h>
#include <string.h>

enum {
    REGION = 8, // blocks along the edge of what a work group takes
    REGION_BLOCKS = 64,
    MOST_LEVELS = 3,   // REGION is 2 to the power of it
    MOST_PARTS = 3,    // of a block
    PART_BYTES = 64,   // plugins/isr/cluster.glsl
    MOST_TEXELS = 128, // along the edge of one of the finest blocks
};

const isr_clusters_desc isr_clusters_default = {
    .initial = 32,
    .coarsest = 8,
    .depth = 0.05f,
    .normal = 0.3f,
    .least_flux = 0.01f,
};

static int log2_of(int n)
{
    int l = 0;
    while (n >> (l + 1))
        l++;
    return l;
}

// Which faces have how many of the finest blocks, as the lights are now. Returns the rows.
static int plan(isr_clusters *c)
{
    double power[AG_MAX_FACES];
    int grid[AG_MAX_FACES], rows = 0, blocks = 0, groups = 0;
    for (int i = 0; i < c->face_count; i++)
        power[i] = ag_gpu_scene_face_power(c->gpu, i);
    ag_vpl_split(power, c->face_count, (int64_t) c->coarsest * c->coarsest, c->coarsest, grid);
    for (int i = 0; i < c->face_count; i++) {
        const int fine = grid[i] << c->levels, least = c->size / MOST_TEXELS;
        const int edge = fine > least ? fine : least;
        const int32_t row[4] = { i, blocks, groups, edge };
        if (grid[i] == 0)
            continue;
        memcpy(c->rows[++rows], row, sizeof row);
        blocks += edge * edge;
        groups += ((edge + REGION - 1) / REGION) * ((edge + REGION - 1) / REGION);
    }
    const int32_t header[4] = { rows, groups, c->size, c->levels };
    memcpy(c->rows[0], header, sizeof header);
    c->vpl->total = MOST_PARTS * blocks;
    return rows;
}

static fg_status run_sum(const fg_run *run, void *user)
{
    isr_clusters *c = user;
    const fg_gl_program_desc desc = { .shaders = { &cluster_sum_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    const size_t rows = 1 + (size_t) plan(c);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // shaders may have written there
    glNamedBufferSubData(fg_run_object(run, c->table), 0, (GLsizeiptr) (rows * sizeof c->rows[0]),
                         c->rows);
    fg_gl_sample(run, 0, c->position, FG_GL_NEAREST);
    fg_gl_sample(run, 1, c->normal, FG_GL_NEAREST);
    fg_gl_sample(run, 2, c->flux, FG_GL_NEAREST);
    fg_gl_storage(run, 0, c->parts);
    fg_gl_storage(run, 1, c->sums);
    fg_gl_storage(run, 3, c->table);
    glUseProgram(program);
    if (c->rows[0][1] > 0)
        glDispatchCompute((GLuint) c->rows[0][1], 1, 1);
    return FG_OK;
}

static fg_status run_choose(const fg_run *run, void *user)
{
    const isr_clusters *c = user;
    const ag_variation_pass *v = &c->variation;
    const uint32_t zero = 0;
    const fg_gl_program_desc desc = { .shaders = { &cluster_choose_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glClearNamedBufferData(fg_run_object(run, c->vpl->groups), GL_R32UI, GL_RED_INTEGER,
                           GL_UNSIGNED_INT, &zero);
    fg_gl_sample(run, 0, v->change, FG_GL_NEAREST);
    fg_gl_storage(run, 0, c->parts);
    fg_gl_storage(run, 1, c->sums);
    fg_gl_storage(run, 2, c->faces);
    fg_gl_storage(run, 3, c->table);
    fg_gl_storage(run, 4, c->vpl->blocks);
    fg_gl_storage(run, 5, c->vpl->groups);
    glProgramUniform4i(program, 0, v->pyramid.base[0], v->pyramid.base[1], v->first, v->levels);
    glProgramUniform3f(program, 1, c->limit_depth, c->limit_normal, c->least_flux);
    glUseProgram(program);
    if (c->rows[0][1] > 0)
        glDispatchCompute((GLuint) c->rows[0][1], 1, 1);
    return FG_OK;
}

static bool is_power_of_two(int n)
{
    return n > 0 && (n & (n - 1)) == 0;
}

// False, and said to the graph, where the descriptor is wrong.
static bool is_sound(const isr_clusters_desc *desc, fg_graph *g, int size)
{
    if (!is_power_of_two(size))
        fg_fail(g, "%s: a map of %d texels, clusters need a power of two", desc->prefix, size);
    else if (!is_power_of_two(desc->initial) || desc->initial > 1024)
        fg_fail(g, "%s: initial is %d, must be a power of two in [1, 1024]", desc->prefix,
                desc->initial);
    else if (!is_power_of_two(desc->coarsest) || desc->coarsest > desc->initial ||
             desc->coarsest << MOST_LEVELS < desc->initial)
        fg_fail(g, "%s: coarsest is %d, must be a power of two in [%d, %d]", desc->prefix,
                desc->coarsest, (desc->initial + 7) >> MOST_LEVELS, desc->initial);
    else if (!(desc->depth >= 0) || !(desc->normal >= 0) || !(desc->least_flux >= 0))
        fg_fail(g, "%s: thresholds are %g, %g and %g, must not be negative", desc->prefix,
                (double) desc->depth, (double) desc->normal, (double) desc->least_flux);
    else
        return true;
    return false;
}

// False, and said to the graph, where a buffer or a dispatch cannot take so many blocks.
static bool fits_device(fg_graph *g, const char *prefix, int64_t blocks)
{
    const int64_t bytes = blocks * MOST_PARTS * PART_BYTES; // a VPL is as large
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    if (bytes <= most && blocks * MOST_PARTS <= (int64_t) 65535 * 256)
        return true;
    fg_fail(g, "%s: clusters of %lld blocks in %.0f MiB are beyond the device", prefix,
            (long long) blocks, (double) bytes / 1048576);
    return false;
}

static fg_res named_buffer(fg_graph *g, const char *prefix, const char *what, uint64_t size)
{
    char name[64];
    snprintf(name, sizeof name, "%s.%s", prefix, what);
    return fg_buffer(g, name, &(fg_buf_desc){ .size = size });
}

// Of all faces, however the light is split over them. Faces too faint for a block of their own have
// one beyond the grid that the others share.
static int64_t most_blocks(const isr_clusters *c, int initial)
{
    const int64_t edge = c->size / MOST_TEXELS, least = edge * edge;
    const int64_t children = (int64_t) 1 << 2 * c->levels;
    const int64_t each = children > least ? children : least;
    const int64_t some = ((int64_t) c->coarsest * c->coarsest + c->face_count) * each;
    const int64_t all = (int64_t) initial * initial * c->face_count;
    return some < all ? some : all;
}

// On one level no more than 1 / least_flux patches can carry least_flux of all flux, and be divided
// into four; one more for the rounding of sums.
static int64_t most_patches(const isr_clusters *c, int64_t blocks)
{
    const double divided = c->levels * (1 / fmax((double) c->least_flux, 1e-6) + 1);
    const double bound = (double) (blocks >> 2 * c->levels) + 3 * divided;
    return bound < (double) blocks ? (int64_t) bound + 1 : blocks;
}

static void declare_passes(isr_clusters *c, fg_graph *g, const char *prefix)
{
    char sum[64], choose[64];
    snprintf(sum, sizeof sum, "%s.sum", prefix);
    snprintf(choose, sizeof choose, "%s.choose", prefix);
    const fg_pass_desc passes[] = {
        {
            .name = sum,
            .kind = FG_KIND_COMPUTE,
            .reads = { { c->position }, { c->normal }, { c->flux } },
            .writes = { { c->table, FG_USE_STORAGE, FG_LOAD_DISCARD },
                        { c->parts, FG_USE_STORAGE, FG_LOAD_DISCARD },
                        { c->sums, FG_USE_STORAGE, FG_LOAD_DISCARD } },
            .run = run_sum,
            .user = c,
        },
        {
            .name = choose,
            .kind = FG_KIND_COMPUTE,
            .reads = { { c->variation.change },
                       { c->parts },
                       { c->sums },
                       { c->faces, FG_USE_STORAGE },
                       { c->table } },
            .writes = { { c->vpl->blocks, FG_USE_STORAGE, FG_LOAD_DISCARD },
                        { c->vpl->groups, FG_USE_STORAGE, FG_LOAD_DISCARD } },
            .run = run_choose,
            .user = c,
        },
    };
    fg_passes(g, passes, FG_COUNT(passes));
}

static void declare_variation(isr_clusters *c, fg_graph *g, const ag_rsm_pass *rsm, int initial,
                              const char *prefix)
{
    char name[64];
    const int texels = log2_of(rsm->size / initial), whole = log2_of(rsm->size);
    const int first = texels + 1 < AG_MAX_LEVELS ? texels + 1 : AG_MAX_LEVELS;
    const int last = whole < AG_MAX_LEVELS ? whole : AG_MAX_LEVELS;
    snprintf(name, sizeof name, "%s.light", prefix);
    const ag_variation_desc desc = {
        .prefix = name,
        .depth = rsm->depth,
        .normal = rsm->normal,
        .width = rsm->size,
        .height = rsm->size,
        .layers = rsm->face_count,
        .first = first,
        .levels = last > first ? last : first,
    };
    ag_variation_declare(&c->variation, g, &rsm->scene, &desc);
}

void isr_clusters_declare(isr_clusters *c, ag_vpl_pass *vpl, fg_graph *g, const ag_rsm_pass *rsm,
                          const isr_clusters_desc *desc)
{
    *c = (isr_clusters){
        .gpu = rsm->gpu,
        .vpl = vpl,
        .position = rsm->position,
        .normal = rsm->normal,
        .flux = rsm->flux,
        .faces = rsm->scene.faces,
        .size = rsm->size,
        .face_count = rsm->face_count,
        .limit_depth = desc->depth,
        .limit_normal = desc->normal,
        .least_flux = desc->least_flux,
    };
    *vpl = (ag_vpl_pass){ 0 };
    if (!is_sound(desc, g, rsm->size))
        return;
    const int initial = desc->initial < rsm->size ? desc->initial : rsm->size;
    c->coarsest = desc->coarsest < initial ? desc->coarsest : initial;
    c->levels = log2_of(initial / c->coarsest);
    const int64_t blocks = most_blocks(c, initial);
    if (!fits_device(g, desc->prefix, blocks))
        return;
    vpl->capacity = MOST_PARTS * (int) most_patches(c, blocks);
    const uint64_t slots = MOST_PARTS * (uint64_t) blocks;
    declare_variation(c, g, rsm, initial, desc->prefix);
    c->table =
        named_buffer(g, desc->prefix, "table", (1 + (uint64_t) c->face_count) * sizeof c->rows[0]);
    c->parts = named_buffer(g, desc->prefix, "parts", slots * PART_BYTES);
    const uint64_t groups = (uint64_t) blocks / REGION_BLOCKS + (uint64_t) c->face_count;
    c->sums = named_buffer(g, desc->prefix, "sums", groups * sizeof(float));
    vpl->blocks = named_buffer(g, desc->prefix, "blocks", slots * sizeof(ag_vpl));
    vpl->groups = named_buffer(g, desc->prefix, "groups", (slots + 255) / 256 * sizeof(uint32_t));
    declare_passes(c, g, desc->prefix);
    ag_vpl_pack_declare(vpl, g, desc->prefix);
}
