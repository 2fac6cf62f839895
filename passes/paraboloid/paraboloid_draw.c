// SPDX-License-Identifier: MIT
#include "paraboloid_priv.h"

#include "shadow_large_comp.h"
#include "shadow_list_comp.h"
#include "shadow_plan_comp.h"
#include "shadow_small_comp.h"
#include "shadow_store_comp.h"

#include <epoxy/gl.h>

enum { GROUP = 64, STORE_X = 16, STORE_Y = 4 };

typedef struct programs {
    uint32_t list, plan, small[2], large[2], store; // [1]: MASK
} programs;

static uint32_t program_of(fg_device *device, const fg_gl_shader *shader, bool masked)
{
    const fg_gl_program_desc desc = { .shaders = { shader }, .defines = masked ? "MASK=1" : NULL };
    return fg_gl_program(device, &desc);
}

static bool find_programs(fg_device *device, const ag_paraboloid_maps *m, programs *p)
{
    p->list = program_of(device, &shadow_list_comp, false);
    p->plan = program_of(device, &shadow_plan_comp, false);
    p->store = program_of(device, &shadow_store_comp, false);
    for (int i = 0; i < 2; i++) {
        const bool masked = i == 1 && m->opaque < m->triangles;
        p->small[i] = program_of(device, &shadow_small_comp, masked);
        p->large[i] = program_of(device, &shadow_large_comp, masked);
        if (!p->small[i] || !p->large[i])
            return false;
    }
    return p->list && p->plan && p->store;
}

static void bind(const ag_paraboloid_maps *m, int binding, paraboloid_buffer which)
{
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, (GLuint) binding, m->buffers[which]);
}

// What of the maps is drawn together.
typedef struct batch {
    int first, count; // of the fresh ones
} batch;

static void list_triangles(const ag_paraboloid_maps *m, const programs *p, const batch *b,
                           const int span[2])
{
    const uint32_t zero = 0;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    glClearNamedBufferData(m->buffers[PARABOLOID_COUNTS], GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT,
                           &zero);
    bind(m, 2, PARABOLOID_SMALL);
    bind(m, 3, PARABOLOID_LARGE);
    bind(m, 4, PARABOLOID_COUNTS);
    glProgramUniform4i(p->list, 0, span[0], span[1], b->first, b->first + b->count);
    glProgramUniform1f(p->list, 1, (float) m->size);
    glUseProgram(p->list);
    fg_gl_dispatch_2d(span[1] - span[0], 1, GROUP, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    bind(m, 0, PARABOLOID_COUNTS);
    bind(m, 1, PARABOLOID_GROUPS);
    glUseProgram(p->plan);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

static void bind_drawn(const ag_paraboloid_maps *m)
{
    bind(m, 0, PARABOLOID_TRIANGLES);
    bind(m, 1, PARABOLOID_DRAWN);
}

static void draw_listed(const ag_paraboloid_maps *m, const programs *p, const batch *b, bool masked)
{
    const uint32_t use[2] = { p->small[masked], p->large[masked] };
    bind_drawn(m);
    bind(m, 2, PARABOLOID_SCRATCH);
    bind(m, 4, PARABOLOID_CORNERS);
    bind(m, 5, PARABOLOID_TEXTURES);
    bind(m, 6, PARABOLOID_ALPHAS);
    bind(m, 7, PARABOLOID_COUNTS);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, m->buffers[PARABOLOID_GROUPS]);
    for (int i = 0; i < 2; i++) {
        bind(m, 3, i == 0 ? PARABOLOID_SMALL : PARABOLOID_LARGE);
        glProgramUniform2i(use[i], 0, m->size, b->first);
        if (masked)
            glProgramUniform1i(use[i], 1, m->opaque);
        glUseProgram(use[i]);
        glDispatchComputeIndirect(i * 16);
    }
}

// So many triangles at a time that the lists hold all of them in all maps.
static void draw_range(const ag_paraboloid_maps *m, const programs *p, const batch *b, bool masked)
{
    const int past = masked ? m->triangles : m->opaque, step = m->list / b->count;
    for (int first = masked ? m->opaque : 0; first < past; first += step) {
        const int span[2] = { first, past - first < step ? past : first + step };
        bind_drawn(m);
        list_triangles(m, p, b, span);
        draw_listed(m, p, b, masked);
    }
}

static void store(const ag_paraboloid_maps *m, const programs *p, const batch *b)
{
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    bind(m, 1, PARABOLOID_DRAWN);
    bind(m, 2, PARABOLOID_SCRATCH);
    glBindImageTexture(0, m->texture, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_R16F);
    glProgramUniform2i(p->store, 0, m->size, b->first);
    glUseProgram(p->store);
    glDispatchCompute((GLuint) (m->size / STORE_X), (GLuint) (m->size / STORE_Y),
                      (GLuint) b->count);
}

fg_status paraboloid_draw(const fg_run *run, ag_paraboloid_maps *m)
{
    programs p;
    if (!find_programs(fg_run_device(run), m, &p))
        return FG_ERR_SHADER;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    glNamedBufferSubData(m->buffers[PARABOLOID_DRAWN], 0,
                         (GLsizeiptr) ((size_t) m->fresh_count * sizeof *m->fresh), m->fresh);
    for (int first = 0; first < m->fresh_count; first += m->batch) {
        const int left = m->fresh_count - first;
        const batch b = { first, left < m->batch ? left : m->batch };
        draw_range(m, &p, &b, false);
        draw_range(m, &p, &b, true);
        store(m, &p, &b);
    }
    return FG_OK;
}
