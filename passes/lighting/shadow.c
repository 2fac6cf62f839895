// SPDX-License-Identifier: MIT
#include <pass/lighting.h>

#include "shadow_frag.h"

#include <stdio.h>
#include <string.h>

static fg_status run_face(const fg_run *run, void *user)
{
    const ag_face_user *face = user;
    const ag_shadow_pass *pass = face->owner;
    const ag_scene_draw draw = {
        .fragment = &shadow_frag,
        .features = AG_FEATURE_ALPHA_MASK | AG_FEATURE_TEXTURES,
        .defines = "FACE=1",
        .integers = { face->face },
        .integer_count = 1,
    };
    fg_gl_storage(run, 2, pass->scene.faces);
    return ag_gpu_scene_draw(pass->gpu, run, &pass->scene, &draw);
}

static int default_size(int faces)
{
    return faces <= 4 ? 2048 : faces <= 24 ? 1024 : 512;
}

void ag_shadow_declare(ag_shadow_pass *pass, fg_graph *g, const ag_gpu_scene *gpu,
                       const ag_scene_res *scene, int size)
{
    // Without lights one pass is declared all the same, so that the graph can say why it is not
    // there.
    const int count = ag_gpu_scene_face_count(gpu), faces = count > 0 ? count : 1;
    memset(pass, 0, sizeof *pass);
    pass->gpu = gpu;
    pass->scene = *scene;
    pass->size = size ? size : default_size(faces);
    if (size < 0 || size > 8192) {
        fg_fail(g, "shadow: size is %d, must lie in [1, 8192] or be 0", size);
        return;
    }
    const fg_tex_desc maps = {
        .format = FG_DEPTH32F,
        .width = pass->size,
        .height = pass->size,
        .layers = faces,
    };
    fg_res version = fg_texture(g, "shadow.maps", &maps);
    for (int i = 0; i < faces; i++) {
        char name[32];
        snprintf(name, sizeof name, "shadow.face%d", i);
        pass->faces[i] = (ag_face_user){ pass, i };
        pass->maps = version;
        version = fg_next(version);
        const fg_pass_desc draw = {
            .name = name,
            .reads = { AG_SCENE_DRAW_READS(*scene), { scene->faces, FG_USE_STORAGE } },
            .writes = {
                { pass->maps, FG_USE_DEPTH, FG_LOAD_CLEAR, .layer = (uint16_t) i, .layers = 1 },
            },
            .needs = AG_FEATURE_LIGHT | AG_FEATURE_GEOMETRY,
            .run = run_face,
            .user = &pass->faces[i],
        };
        fg_passes(g, &draw, 1);
    }
}
