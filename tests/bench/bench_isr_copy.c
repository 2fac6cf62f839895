// SPDX-License-Identifier: MIT
// The unit of what a full-screen pass costs.
#include "bench_isr.h"

#include "bench_isr_copy_comp.h"
#include "bench_isr_copy_frag.h"
#include "fullscreen_vert.h"

#include <epoxy/gl.h>
#include <stdlib.h>
#include <string.h>

static fg_status run_compute(const fg_run *run, void *user)
{
    const copy *c = user;
    const fg_gl_program_desc desc = { .shaders = { &bench_isr_copy_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    int size[3];
    if (!program)
        return FG_ERR_SHADER;
    fg_run_size(run, c->to[0], 0, size);
    fg_gl_sample(run, 0, c->from, FG_GL_NEAREST);
    fg_gl_image(run, 0, c->to[0], 0, GL_WRITE_ONLY, FG_RGBA16F);
    glUseProgram(program);
    fg_gl_dispatch_2d(size[0], size[1], 8, 8);
    return FG_OK;
}

static fg_status run_raster(const fg_run *run, void *user)
{
    const copy *c = user;
    const fg_gl_program_desc desc = { .shaders = { &fullscreen_vert, &bench_isr_copy_frag } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_sample(run, 0, c->from, FG_GL_NEAREST);
    glUseProgram(program);
    glDisable(GL_DEPTH_TEST);
    fg_gl_fullscreen(run);
    return FG_OK;
}

// Noise, so that nothing is the same in all texels.
static fg_status make_source(copy *c, const int size[2])
{
    const size_t count = 4 * (size_t) size[0] * (size_t) size[1];
    float *values = malloc(count * sizeof *values);
    uint32_t state = 1;
    if (!values)
        return FG_ERR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        state = state * 1664525u + 1013904223u;
        values[i] = (float) (state >> 8) * 0x1p-24f;
    }
    glCreateTextures(GL_TEXTURE_2D, 1, &c->source);
    glTextureStorage2D(c->source, 1, GL_RGBA16F, size[0], size[1]);
    glTextureSubImage2D(c->source, 0, 0, 0, size[0], size[1], GL_RGBA, GL_FLOAT, values);
    free(values);
    return FG_OK;
}

fg_status copy_open(const bench *b, copy *c)
{
    const fg_tex_desc source = { .format = FG_RGBA16F, .width = b->size[0], .height = b->size[1] };
    const fg_tex_desc frame = { .format = FG_RGBA16F };
    const fg_status status = make_source(c, b->size);
    if (status != FG_OK)
        return status;
    c->graph = fg_graph_create(&(fg_graph_desc){ .device = b->device, .log = &b->log });
    if (!c->graph)
        return FG_ERR_MEMORY;
    fg_graph_begin(c->graph, &(fg_frame_desc){ .width = b->size[0], .height = b->size[1] });
    c->from = fg_import_texture(c->graph, "copy.source", &source, c->source);
    c->to[0] = fg_texture(c->graph, "copy.by_compute", &frame);
    c->to[1] = fg_texture(c->graph, "copy.by_raster", &frame);
    const fg_pass_desc passes[] = {
        {
            .name = "copy.compute",
            .kind = FG_KIND_COMPUTE,
            .reads = { { c->from } },
            .writes = { { c->to[0], .load = FG_LOAD_DISCARD } },
            .run = run_compute,
            .user = c,
        },
        {
            .name = "copy.raster",
            .reads = { { c->from } },
            .writes = { { c->to[1], .load = FG_LOAD_DISCARD } },
            .run = run_raster,
            .user = c,
        },
    };
    fg_passes(c->graph, passes, FG_COUNT(passes));
    fg_export(c->graph, c->to[0]);
    fg_export(c->graph, c->to[1]);
    return fg_graph_compile(c->graph);
}

void copy_close(copy *c)
{
    fg_graph_destroy(c->graph);
    glDeleteTextures(1, &c->source);
    *c = (copy){ 0 };
}

fg_status copy_frame(const bench *b, copy *c)
{
    fg_timing t;
    fg_status status = fg_graph_run(c->graph);
    if (status == FG_OK)
        status = fg_gl_finish(b->device);
    for (int i = 0; status == FG_OK && fg_graph_timing(c->graph, i, &t); i++)
        if (t.gpu_ms >= 0)
            samples_add(&c->ms[!strcmp(t.pass, "copy.raster")], t.gpu_ms);
    return status;
}
