// SPDX-License-Identifier: MIT
#include "ism_priv.h"

#include "ism_maps_comp.h"
#include "ism_place_comp.h"

#include <epoxy/gl.h>
#include <fg/gl.h>
#include <stdio.h>

enum {
    PLACE_GROUP = 256,
    DEFAULT_SIZE = 64,
    DEFAULT_POINTS = 8192,
    DEFAULT_MAPS = 1024,
    MAX_MAPS = 2048, // layers of an array that every device has
    MIN_POINTS = 256,
    // One work group splats a map, and a loop of an invocation may not have more rounds on every
    // device: see ism_maps.comp.
    MAX_POINTS = 32768,
    UNIT = 4,
    EYES = 4,
};

static fg_status run_place(const fg_run *run, void *user)
{
    const ag_ism_pass *pass = user;
    const fg_gl_program_desc desc = { .shaders = { &ism_place_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, pass->scene.view);
    fg_gl_storage(run, 0, pass->samples);
    fg_gl_storage(run, 1, pass->scene.vertices);
    fg_gl_storage(run, 2, pass->scene.instances);
    fg_gl_storage(run, 3, pass->points);
    glProgramUniform1i(program, 0, pass->sample_count);
    glUseProgram(program);
    fg_gl_dispatch_2d(pass->sample_count, 1, PLACE_GROUP, 1);
    return FG_OK;
}

static fg_status run_maps(const fg_run *run, void *user)
{
    const ag_ism_pass *pass = user;
    const fg_gl_program_desc desc = { .shaders = { &ism_maps_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, pass->scene.view);
    fg_gl_storage(run, 0, pass->points);
    fg_gl_storage(run, 1, pass->vpls);
    fg_gl_storage(run, 2, pass->count);
    fg_gl_storage(run, 3, pass->eyes);
    fg_gl_image(run, 0, pass->maps, 0, GL_WRITE_ONLY, FG_R32F);
    glProgramUniform4i(program, 0, pass->size, pass->map_count, pass->point_count,
                       pass->sample_count / pass->point_count);
    glUseProgram(program);
    fg_gl_dispatch_2d(pass->map_count, 1, 1, 1);
    return FG_OK;
}

static void declare_passes(ag_ism_pass *pass, fg_graph *g, const char *prefix)
{
    char place[64], maps[64];
    snprintf(place, sizeof place, "%s.ism_place", prefix);
    snprintf(maps, sizeof maps, "%s.ism_maps", prefix);
    const fg_pass_desc passes[] = {
        {
            .name = place,
            .kind = FG_KIND_COMPUTE,
            .reads = { { pass->scene.view, FG_USE_UNIFORM },
                       { pass->samples },
                       { pass->scene.vertices, FG_USE_STORAGE },
                       { pass->scene.instances, FG_USE_STORAGE } },
            .writes = { { pass->points, FG_USE_STORAGE, FG_LOAD_DISCARD } },
            .needs = AG_FEATURE_LIGHT | AG_FEATURE_GEOMETRY,
            .run = run_place,
            .user = pass,
        },
        {
            .name = maps,
            .kind = FG_KIND_COMPUTE,
            .reads = { { pass->scene.view, FG_USE_UNIFORM },
                       { pass->points },
                       { pass->vpls },
                       { pass->count } },
            .writes = { { pass->maps, FG_USE_IMAGE, FG_LOAD_DISCARD },
                        { pass->eyes, FG_USE_STORAGE, FG_LOAD_DISCARD } },
            .run = run_maps,
            .user = pass,
        },
    };
    fg_passes(g, passes, FG_COUNT(passes));
}

static bool is_power_of_two(int x)
{
    return x > 0 && (x & (x - 1)) == 0;
}

static bool check(const ag_ism_pass *pass, fg_graph *g, const ag_ism_desc *desc)
{
    const int most = pass->sample_count < MAX_POINTS ? pass->sample_count : MAX_POINTS;
    if (!is_power_of_two(pass->size) || pass->size < 8 || pass->size > 64)
        fg_fail(g, "%s: ism size is %d, must be 8, 16, 32 or 64", desc->prefix, pass->size);
    else if (!is_power_of_two(pass->point_count) || pass->point_count < MIN_POINTS ||
             pass->point_count > most)
        fg_fail(g, "%s: ism points is %d, must be a power of two in [%d, %d]", desc->prefix,
                pass->point_count, MIN_POINTS, most);
    else if (desc->maps < 0 || desc->maps > MAX_MAPS)
        fg_fail(g, "%s: ism maps is %d, must lie in [1, %d] or be 0", desc->prefix, desc->maps,
                MAX_MAPS);
    else if (desc->capacity < 1)
        fg_fail(g, "%s: ism capacity is %d, must be at least 1", desc->prefix, desc->capacity);
    else
        return true;
    return false;
}

static fg_res named_buffer(fg_graph *g, const char *prefix, const char *what, uint64_t size)
{
    char name[64];
    snprintf(name, sizeof name, "%s.%s", prefix, what);
    return fg_buffer(g, name, &(fg_buf_desc){ .size = size });
}

void ag_ism_declare(ag_ism_pass *pass, fg_graph *g, const ag_ism_samples *samples,
                    const ag_scene_res *scene, const ag_ism_desc *desc)
{
    char name[64];
    const int maps = desc->maps ? desc->maps : DEFAULT_MAPS;
    *pass = (ag_ism_pass){
        .scene = *scene,
        .vpls = desc->vpls,
        .count = desc->count,
        .sample_count = samples->count,
        .size = desc->size ? desc->size : DEFAULT_SIZE,
        .point_count = desc->points ? desc->points : DEFAULT_POINTS,
        .map_count = maps < desc->capacity ? maps : desc->capacity,
    };
    if (!check(pass, g, desc))
        return;
    const uint64_t sample_count = (uint64_t) pass->sample_count;
    const fg_buf_desc sample_buffer = { .size = sample_count * sizeof(ag_ism_sample) };
    snprintf(name, sizeof name, "%s.ism_samples", desc->prefix);
    pass->samples = fg_import_buffer(g, name, &sample_buffer, samples->buffer);
    pass->points = named_buffer(g, desc->prefix, "ism_points", sample_count * sizeof(ag_ism_point));
    pass->eyes =
        named_buffer(g, desc->prefix, "ism_eyes", (uint64_t) pass->map_count * sizeof(ag_ism_eye));
    snprintf(name, sizeof name, "%s.ism", desc->prefix);
    const fg_tex_desc texture = {
        .format = FG_R32F,
        .width = pass->size,
        .height = pass->size,
        .layers = pass->map_count,
    };
    pass->maps = fg_texture(g, name, &texture);
    declare_passes(pass, g, desc->prefix);
}

void ag_ism_bind(const fg_run *run, const ag_ism_pass *pass)
{
    fg_gl_sample(run, UNIT, pass->maps, FG_GL_NEAREST);
    fg_gl_storage(run, EYES, pass->eyes);
}
