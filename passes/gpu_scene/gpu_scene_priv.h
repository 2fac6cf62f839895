// SPDX-License-Identifier: MIT
#ifndef GPU_SCENE_PRIV_H
#define GPU_SCENE_PRIV_H

#include <pass/frame.h>
#include <pass/gpu_scene.h>
#include <pass/scene_shared.h>
#include <pass/view_shared.h>

#include <assert.h>

static_assert(sizeof(ag_vertex) == 64, "interleaved as the vertex array reads it");
static_assert(sizeof(ag_gpu_instance) == 112, "std430 layout of ag_gpu_instance");
static_assert(sizeof(ag_gpu_material) == 192, "std430 layout of ag_gpu_material");
static_assert(sizeof(ag_gpu_light) == 64, "std430 layout of ag_gpu_light");
static_assert(sizeof(ag_gpu_face) == 144, "std430 layout of ag_gpu_face");
static_assert(sizeof(ag_view_block) == 176, "std140 layout of ag_view_block");

#define REQUIRE(cond, err, ...)                                                                    \
    do {                                                                                           \
        if (!(cond)) {                                                                             \
            fg_logf(log, FG_LOG_ERROR, __VA_ARGS__);                                               \
            status = (err);                                                                        \
            goto fail;                                                                             \
        }                                                                                          \
    } while (0)

typedef struct draw_command { // as glMultiDrawElementsIndirect reads it
    uint32_t count, instance_count, first_index;
    int32_t base_vertex;
    uint32_t base_instance;
} draw_command;

// Textures of one size and colour space, the layers of one array.
typedef struct texture_bin {
    int width, height, layers;
    bool srgb, nearest;
    uint32_t texture, sampler;
} texture_bin;

typedef struct texture_set {
    texture_bin bins[AG_MAX_TEXTURE_BINS];
    int bin_count;
    int (*places)[2]; // [scene->texture_count] bin and layer
    uint64_t bytes;
} texture_set;

// Errors as ag_gpu_scene_create(). On failure what was made is in `*set`, to be finished.
fg_status texture_set_init(const fg_log *log, const ag_scene *scene, texture_set *set);
void texture_set_finish(texture_set *set);

enum {
    BUFFER_VIEW,
    BUFFER_VERTICES,
    BUFFER_INDICES,
    BUFFER_DRAW_IDS,
    BUFFER_DRAWS,
    BUFFER_INSTANCES,
    BUFFER_MATERIALS,
    BUFFER_LIGHTS,
    BUFFER_FACES,
    BUFFER_COUNT,
};

struct ag_gpu_scene {
    const fg_log *log;
    fg_device *device;
    const ag_scene *scene;
    uint64_t features;
    uint32_t buffers[BUFFER_COUNT];
    uint64_t sizes[BUFFER_COUNT];
    uint32_t vertex_array;
    int opaque_count; // draws without MASK, which come first
    texture_set textures;

    // What the GPU holds now.
    bool uploaded;
    double origin[3];
    uint64_t geometry_revision, light_revision, material_revision;
    ag_view_block view;
    ag_gpu_material *materials; // as the scene's

    ag_gpu_instance *instances; // scratch of update()
    ag_gpu_light *lights;
    ag_gpu_face *faces;
    double *face_power; // of the last update
    int light_count, face_count;
};

// Faces that a light needs.
int light_face_count(const ag_light *light);

// Half the width and height of a directional light's face, m.
void light_cross_section(const ag_scene *scene, const ag_light *light, double half[2]);

// Lights and their faces in the render space of `origin`; arrays as long as the scene's.
void lights_to_gpu(const ag_scene *scene, const double origin[3], ag_gpu_light *lights,
                   ag_gpu_face *faces);

// Power of each face as ag_gpu_scene_face_power() has it, W; as long as the scene's faces.
void lights_to_power(const ag_scene *scene, double *power);

#endif // GPU_SCENE_PRIV_H
