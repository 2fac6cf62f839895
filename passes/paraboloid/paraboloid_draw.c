// SPDX-License-Identifier: MIT
#include "paraboloid_priv.h"

#include "shadow_large_comp.h"
#include "shadow_list_comp.h"
#include "shadow_medium_comp.h"
#include "shadow_plan_comp.h"
#include "shadow_store_comp.h"

#include <epoxy/gl.h>

enum { GROUP = 64, STORE_X = 16, STORE_Y = 4 };

// [1]: MASK
typedef struct programs {
    uint32_t list[2], medium[2], large[2], plan, store;
} programs;

static uint32_t program_of(fg_device *device, const fg_gl_shader *shader, bool masked)
{
    const fg_gl_program_desc desc = { .shaders = { shader }, .defines = masked ? "MASK=1" : NULL };
    return fg_gl_program(device, &desc);
}

static bool find_programs(fg_device *device, const ag_paraboloid_maps *m, programs *p)
{
    p->plan = program_of(device, &shadow_plan_comp, false);
    p->store = program_of(device, &shadow_store_comp, false);
    for (int i = 0; i < 2; i++) {
        const bool masked = i == 1 && m->opaque < m->triangles;
        p->list[i] = program_of(device, &shadow_list_comp, masked);
        p->medium[i] = program_of(device, &shadow_medium_comp, masked);
        p->large[i] = program_of(device, &shadow_large_comp, masked);
        if (!p->list[i] || !p->medium[i] || !p->large[i])
            return false;
    }
    return p->plan && p->store;
}

static void bind(const ag_paraboloid_maps *m, int binding, paraboloid_buffer which)
{
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, (GLuint) binding, m->buffers[which]);
}

// What of the maps is drawn together.
typedef struct batch {
    int first, count; // of the fresh ones
} batch;

static void use(const ag_paraboloid_maps *m, uint32_t program, const batch *b, bool masked)
{
    glProgramUniform2i(program, 0, m->size, b->first);
    if (masked)
        glProgramUniform1i(program, 1, m->opaque);
    glUseProgram(program);
}

static void list_triangles(const ag_paraboloid_maps *m, const programs *p, const batch *b,
                           const int span[3])
{
    const uint32_t zero = 0;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    glClearNamedBufferData(m->buffers[PARABOLOID_COUNTS], GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT,
                           &zero);
    bind(m, 0, PARABOLOID_LISTS);
    use(m, p->list[span[2]], b, span[2]);
    glProgramUniform4i(p->list[span[2]], 2, span[0], span[1], b->count, m->list);
    fg_gl_dispatch_2d(span[1] - span[0], 1, GROUP, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    bind(m, 0, PARABOLOID_GROUPS);
    glUseProgram(p->plan);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_COMMAND_BARRIER_BIT);
}

static void draw_listed(const ag_paraboloid_maps *m, const programs *p, const batch *b, bool masked)
{
    for (int i = 0; i < PARABOLOID_CLASSES; i++) {
        const bool large = i == PARABOLOID_CLASSES - 1;
        const uint32_t program = large ? p->large[masked] : p->medium[masked];
        use(m, program, b, masked);
        glProgramUniform2i(program, 2, i, i * m->list);
        glDispatchComputeIndirect((GLintptr) i * 16);
    }
}

// So many triangles at a time that the lists hold all of them in all maps.
static void draw_range(const ag_paraboloid_maps *m, const programs *p, const batch *b, bool masked)
{
    const int past = masked ? m->triangles : m->opaque, step = m->list / b->count;
    for (int first = masked ? m->opaque : 0; first < past; first += step) {
        const int span[3] = { first, past - first < step ? past : first + step, masked };
        list_triangles(m, p, b, span);
        draw_listed(m, p, b, masked);
    }
}

static void store(const ag_paraboloid_maps *m, const programs *p, const batch *b)
{
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    use(m, p->store, b, false);
    glDispatchCompute((GLuint) (m->size / STORE_X), (GLuint) (m->size / STORE_Y),
                      (GLuint) b->count);
}

static void bind_all(const ag_paraboloid_maps *m)
{
    glBindTextures(0, PARABOLOID_VIEWS, m->views);
    bind(m, 1, PARABOLOID_COUNTS);
    bind(m, 2, PARABOLOID_SCRATCH);
    bind(m, 4, PARABOLOID_CORNERS);
    bind(m, 5, PARABOLOID_TEXTURES);
    bind(m, 6, PARABOLOID_ALPHAS);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, m->buffers[PARABOLOID_GROUPS]);
    glBindImageTexture(0, m->texture, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_R16F);
}

fg_status paraboloid_draw(const fg_run *run, ag_paraboloid_maps *m)
{
    programs p;
    if (!find_programs(fg_run_device(run), m, &p))
        return FG_ERR_SHADER;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    glNamedBufferSubData(m->buffers[PARABOLOID_DRAWN], 0,
                         (GLsizeiptr) ((size_t) m->fresh_count * sizeof *m->fresh), m->fresh);
    bind_all(m);
    for (int first = 0; first < m->fresh_count; first += m->batch) {
        const int left = m->fresh_count - first;
        const batch b = { first, left < m->batch ? left : m->batch };
        draw_range(m, &p, &b, false);
        draw_range(m, &p, &b, true);
        store(m, &p, &b);
    }
    return FG_OK;
}
