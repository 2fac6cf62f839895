// SPDX-License-Identifier: MIT
#include "domain_layer.h"

#include <fg/gl.h>

#include "iir_domain_comp.h"

#include <epoxy/gl.h>
#include <stdlib.h>

enum { EDGE = 512 };

fg_status iir_domain_layer_init(iir_domain_layer *l, int capacity)
{
    *l = (iir_domain_layer){ .capacity = capacity };
    l->dots = calloc((size_t) capacity, sizeof *l->dots);
    return l->dots ? FG_OK : FG_ERR_MEMORY;
}

void iir_domain_layer_finish(iir_domain_layer *l)
{
    free(l->dots);
    *l = (iir_domain_layer){ 0 };
}

static void set_colour(iir_dot *dot, const iir_result *result, int vpl)
{
    static const float sky[] = { 0.15f, 0.25f, 0.6f };
    const float *from = vpl < 0 ? sky : result->vpls[vpl].albedo;
    for (int k = 0; k < 3; k++)
        dot->colour[k] = from[k];
}

static void list_dots(iir_domain_layer *l)
{
    const iir_result *result = l->result;
    l->count = 0;
    for (int i = 0; i < result->point_count && l->count < l->capacity; i++) {
        const iir_point *point = result->points + i;
        if (point->light != result->points[0].light)
            break; // points of a light follow each other
        iir_dot *dot = l->dots + l->count++;
        for (int k = 0; k < 3; k++)
            dot->place[k] = (float) point->place[k];
        dot->place[3] = point->fresh;
        l->on_sphere = point->space == IIR_SPHERE;
        set_colour(dot, result, point->vpl);
    }
}

static fg_status run_layer(const fg_run *run, void *user)
{
    iir_domain_layer *l = user;
    const fg_gl_program_desc desc = { .shaders = { &domain_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    list_dots(l);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT); // shaders may have used the memory before
    if (l->count > 0)
        glNamedBufferSubData(fg_run_object(run, l->buffer), 0,
                             (GLsizeiptr) ((size_t) l->count * sizeof *l->dots), l->dots);
    fg_gl_storage(run, 0, l->buffer);
    fg_gl_image(run, 0, l->out, 0, GL_WRITE_ONLY, FG_RGBA16F);
    glProgramUniform1i(program, 0, l->count);
    glProgramUniform1i(program, 1, l->on_sphere);
    glUseProgram(program);
    fg_gl_dispatch_2d(EDGE, EDGE, 8, 8);
    return FG_OK;
}

void iir_domain_layer_declare(iir_domain_layer *l, fg_graph *g, const iir_result *result)
{
    l->result = result;
    const fg_tex_desc picture = { .format = FG_RGBA16F, .width = EDGE, .height = EDGE };
    const fg_buf_desc dots = { .size = (uint64_t) l->capacity * sizeof(iir_dot) };
    l->buffer = fg_buffer(g, "iir.domain_dots", &dots);
    l->out = fg_texture(g, "iir.domain_layer", &picture);
    const fg_pass_desc pass = {
        .name = "iir.domain_layer",
        .kind = FG_KIND_COMPUTE,
        .writes = { { l->buffer, FG_USE_STORAGE }, { l->out, FG_USE_IMAGE, FG_LOAD_DISCARD } },
        .run = run_layer,
        .user = l,
    };
    fg_passes(g, &pass, 1);
}
