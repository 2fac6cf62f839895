// SPDX-License-Identifier: MIT
#ifndef PASS_GPU_SCENE_H
#define PASS_GPU_SCENE_H

#include <fg/gl.h>
#include <pass/scene.h>

FG_BEGIN

// A scene's copy on the GPU, in render space (pass/frame.h), and how passes draw it.
//
//     ag_gpu_scene *gpu;
//     ag_gpu_scene_create(&(ag_gpu_scene_desc){ .device = dev, .scene = scene }, &gpu);
//     ag_scene_res res = ag_gpu_scene_import(gpu, g);       // once a declaration
//     ... pass: .reads = { { res.instances, FG_USE_STORAGE }, ... AG_SCENE_DRAW_READS(res) }
//     ag_gpu_scene_update(gpu, &view);                      // before every frame
//     ... callback: ag_gpu_scene_draw(gpu, run, &res, &(ag_scene_draw){ .fragment = &frag });
//     ag_gpu_scene_destroy(gpu);
//
// Layouts that shaders read are in pass/scene_shared.h.
// Thread: the one that has the context.
typedef struct ag_gpu_scene ag_gpu_scene;
typedef struct ag_view ag_view; // pass/frame.h

// Frusta through which lights see the scene: one for a spot up to 60 degrees from axis to rim and
// for a directional light, five for wider spots, six for point lights.
enum { AG_MAX_FACES = 256, AG_MAX_TEXTURE_BINS = 16 };

typedef struct ag_gpu_scene_desc {
    const fg_log *log;     // Optional. Borrowed, as all below.
    fg_device *device;     // a gl device, current
    const ag_scene *scene; // its topology, textures and how many materials and lights: read now
    uint64_t features; // counted as present beside the scene's own: permutations keep their code
} ag_gpu_scene_desc;

// Errors: FG_ERR_UNSUPPORTED, the lights need more than AG_MAX_FACES faces, or a texture is beyond
//         the device; FG_ERR_MEMORY.
FG_API FG_NODISCARD fg_status ag_gpu_scene_create(const ag_gpu_scene_desc *desc,
                                                  ag_gpu_scene **out);
FG_API void ag_gpu_scene_destroy(ag_gpu_scene *s); // accepts NULL

// Uploads what the view and the scene's revisions say has changed. Allocates nothing, waits for
// nothing. Instance matrices are brought to render space in double precision.
FG_API FG_NODISCARD fg_status ag_gpu_scene_update(ag_gpu_scene *s, const ag_view *view);

// The buffers as graph resources, all written already.
typedef struct ag_scene_res {
    fg_res view;      // uniform ag_view_block, pass/view_shared.h
    fg_res vertices;  // ag_vertex[], node space (skinned ones: world minus origin)
    fg_res indices;   // uint32_t[]
    fg_res draw_ids;  // uint32_t[], 0, 1, 2, ...: the vertex attribute that finds the instance
    fg_res draws;     // DrawElementsIndirectCommand[], one per instance, those with MASK last
    fg_res instances; // ag_gpu_instance[]
    fg_res materials; // ag_gpu_material[]
    fg_res lights;    // ag_gpu_lights: count, then ag_gpu_light[]
    fg_res faces;     // ag_gpu_face[]
} ag_scene_res;

FG_API ag_scene_res ag_gpu_scene_import(const ag_gpu_scene *s, fg_graph *g);

// What a pass that calls ag_gpu_scene_draw() must read, for its `reads` table.
#define AG_SCENE_DRAW_READS(res)                                                                   \
    { (res).view, FG_USE_UNIFORM }, { (res).vertices, FG_USE_VERTEX },                             \
        { (res).indices, FG_USE_INDEX }, { (res).draw_ids, FG_USE_VERTEX },                        \
        { (res).draws, FG_USE_INDIRECT }, { (res).instances, FG_USE_STORAGE },                     \
    {                                                                                              \
        (res).materials, FG_USE_STORAGE                                                            \
    }

FG_API uint64_t ag_gpu_scene_features(const ag_gpu_scene *s);

// How a pass draws the scene. `fragment` includes passes/gpu_scene/material.glsl; its permutation
// has TEXTURES, MASK, GLOSSY, EMISSIVE as far as the scene needs them and `features` asks for them.
typedef struct ag_scene_draw {
    const fg_gl_shader *fragment;
    uint64_t features;   // ag_feature bits
    const char *defines; // more; "FACE=1" draws through light face `integers[0]`. NULL: none.
    int integers[2];     // uniforms at locations 0, 1, as many as integer_count says
    int integer_count;
} ag_scene_draw;

// Draws every instance: those without MASK by one indirect multi-draw, then those with. No culling,
// depth test GREATER. Binds view (uniform 0), instances and materials (storage 0, 1), textures
// (units 0 .. AG_MAX_TEXTURE_BINS - 1); other bindings are the caller's.
//
// Errors: FG_ERR_SHADER, with a log line, if a permutation does not build.
FG_API FG_NODISCARD fg_status ag_gpu_scene_draw(const ag_gpu_scene *s, const fg_run *run,
                                                const ag_scene_res *res, const ag_scene_draw *draw);

// Faces of all lights, in the order of the lights; constant while `s` lives.
FG_API int ag_gpu_scene_face_count(const ag_gpu_scene *s);
FG_API int ag_gpu_scene_light_of_face(const ag_gpu_scene *s, int face);

// Power that a face's light sends through it as of the last update, W, mean of r, g and b, to 1e-3:
// 0 only where no light goes. Whether it meets anything is not asked; directional: over the whole
// cross-section of the face.
FG_API double ag_gpu_scene_face_power(const ag_gpu_scene *s, int face);

FG_API uint64_t ag_gpu_scene_bytes(const ag_gpu_scene *s); // device memory held

FG_END

#endif // PASS_GPU_SCENE_H
