// SPDX-License-Identifier: MIT
#include <pass/gbuffer.h>

#include "gbuffer_frag.h"

static fg_status run_gbuffer(const fg_run *run, void *user)
{
    const ag_gbuffer_pass *pass = user;
    const ag_scene_draw draw = {
        .fragment = &gbuffer_frag,
        .features =
            AG_FEATURE_TEXTURES | AG_FEATURE_ALPHA_MASK | AG_FEATURE_GLOSSY | AG_FEATURE_EMISSIVE,
    };
    return ag_gpu_scene_draw(pass->gpu, run, &pass->scene, &draw);
}

void ag_gbuffer_declare(ag_gbuffer_pass *pass, fg_graph *g, const ag_gpu_scene *gpu,
                        const ag_scene_res *scene)
{
    const uint64_t features = ag_gpu_scene_features(gpu);
    ag_gbuffer out = {
        .depth = fg_texture(g, "gbuffer.depth", &(fg_tex_desc){ .format = FG_DEPTH32F }),
        .normal = fg_texture(g, "gbuffer.normal", &(fg_tex_desc){ .format = FG_RGBA16F }),
        .position = fg_texture(g, "gbuffer.position", &(fg_tex_desc){ .format = FG_RGBA32F }),
        .albedo = fg_texture(g, "gbuffer.albedo", &(fg_tex_desc){ .format = FG_RGBA16F }),
        .face = fg_texture(g, "gbuffer.face", &(fg_tex_desc){ .format = FG_RG16 }),
    };
    if (features & AG_FEATURE_GLOSSY)
        out.material = fg_texture(g, "gbuffer.material", &(fg_tex_desc){ .format = FG_RGBA8 });
    if (features & AG_FEATURE_EMISSIVE)
        out.emissive = fg_texture(g, "gbuffer.emissive", &(fg_tex_desc){ .format = FG_RGBA32F });
    *pass = (ag_gbuffer_pass){ .gpu = gpu, .scene = *scene, .out = out };

    fg_pass_desc draw = {
        .name = "gbuffer.draw",
        .reads = { AG_SCENE_DRAW_READS(*scene) },
        .writes = {
            { out.depth, FG_USE_DEPTH, FG_LOAD_CLEAR },
            { out.normal, FG_USE_COLOR, FG_LOAD_CLEAR },
            { out.position, FG_USE_COLOR, FG_LOAD_CLEAR },
            { out.albedo, FG_USE_COLOR, FG_LOAD_CLEAR },
            { out.face, FG_USE_COLOR, FG_LOAD_CLEAR },
        },
        .run = run_gbuffer,
        .user = pass,
    };
    int n = 5;
    if (out.material.id)
        draw.writes[n++] = (fg_io){ out.material, FG_USE_COLOR, FG_LOAD_CLEAR };
    if (out.emissive.id)
        draw.writes[n++] = (fg_io){ out.emissive, FG_USE_COLOR, FG_LOAD_CLEAR };
    fg_passes(g, &draw, 1);
}
