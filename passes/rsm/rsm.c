// SPDX-License-Identifier: MIT
#include <pass/rsm.h>

#include "rsm_frag.h"

#include <stdio.h>
#include <string.h>

static fg_status run_face(const fg_run *run, void *user)
{
    const ag_face_user *face = user;
    const ag_rsm_pass *pass = face->owner;
    const ag_scene_draw draw = {
        .fragment = &rsm_frag,
        .features = AG_FEATURE_TEXTURES | AG_FEATURE_ALPHA_MASK | AG_FEATURE_GLOSSY,
        .defines = pass->equal_solid_angle ? "FACE=1;EQUAL=1" : "FACE=1",
        .integers = { face->face, pass->size },
        .integer_count = 2,
    };
    if (!(ag_gpu_scene_face_power(pass->gpu, face->face) > 0)) // cleared, as a dark face is
        return FG_OK;
    fg_gl_storage(run, 2, pass->scene.faces);
    fg_gl_storage(run, 3, pass->scene.lights);
    return ag_gpu_scene_draw(pass->gpu, run, &pass->scene, &draw);
}

static fg_res layer_texture(fg_graph *g, const ag_rsm_desc *desc, const char *what,
                            fg_format format, int layers)
{
    char name[64];
    const fg_tex_desc tex = {
        .format = format,
        .width = desc->size,
        .height = desc->size,
        .layers = layers,
    };
    snprintf(name, sizeof name, "%s.%s", desc->prefix, what);
    return fg_texture(g, name, &tex);
}

static fg_io layer_of(fg_res res, fg_use use, int layer)
{
    return (fg_io){ res, use, FG_LOAD_CLEAR, .layer = (uint16_t) layer, .layers = 1 };
}

void ag_rsm_declare(ag_rsm_pass *pass, fg_graph *g, const ag_gpu_scene *gpu,
                    const ag_scene_res *scene, const ag_rsm_desc *desc)
{
    // Without lights one pass is declared all the same, so that the graph can say why it is not
    // there.
    const int count = ag_gpu_scene_face_count(gpu), faces = count > 0 ? count : 1;
    memset(pass, 0, sizeof *pass);
    pass->gpu = gpu;
    pass->scene = *scene;
    pass->size = desc->size;
    pass->face_count = faces;
    pass->equal_solid_angle = desc->equal_solid_angle;
    if (desc->size < 1 || desc->size > 1024) {
        fg_fail(g, "%s: size is %d, must lie in [1, 1024]", desc->prefix, desc->size);
        return;
    }
    fg_res depth = layer_texture(g, desc, "depth", FG_DEPTH32F, faces);
    fg_res position = layer_texture(g, desc, "position", FG_RGBA32F, faces);
    fg_res normal = layer_texture(g, desc, "normal", FG_RGBA16F, faces);
    fg_res flux = layer_texture(g, desc, "flux", FG_RGBA32F, faces);
    for (int i = 0; i < faces; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s.face%d", desc->prefix, i);
        pass->faces[i] = (ag_face_user){ pass, i };
        const fg_pass_desc draw = {
            .name = name,
            .reads = { AG_SCENE_DRAW_READS(*scene),
                       { scene->faces, FG_USE_STORAGE },
                       { scene->lights, FG_USE_STORAGE } },
            .writes = { layer_of(depth, FG_USE_DEPTH, i), layer_of(position, FG_USE_COLOR, i),
                        layer_of(normal, FG_USE_COLOR, i), layer_of(flux, FG_USE_COLOR, i) },
            .needs = AG_FEATURE_LIGHT | AG_FEATURE_GEOMETRY,
            .run = run_face,
            .user = &pass->faces[i],
        };
        fg_passes(g, &draw, 1);
        pass->depth = depth;
        pass->position = position;
        pass->normal = normal;
        pass->flux = flux;
        depth = fg_next(depth);
        position = fg_next(position);
        normal = fg_next(normal);
        flux = fg_next(flux);
    }
}
