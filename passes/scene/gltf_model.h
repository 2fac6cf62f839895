// SPDX-License-Identifier: MIT
// A glTF file as plain C: what gltf_mirror_bridge.cpp copies out of tinygltf's model, nothing
// checked yet. Strings, ints and numbers point into that model; arrays are the mirror's own.
// An index that a file leaves out is -1.
#ifndef GLTF_MODEL_H
#define GLTF_MODEL_H

#include <fg/base.h>

FG_BEGIN

typedef struct gltf_ints {
    const int *v;
    int count;
} gltf_ints;

typedef struct gltf_numbers {
    const double *v;
    int count; // 0: not given
} gltf_numbers;

typedef struct gltf_buffer {
    const uint8_t *data;
    size_t size;
} gltf_buffer;

typedef struct gltf_view {
    int buffer;
    size_t offset, length, stride; // bytes; stride 0: packed
} gltf_view;

typedef struct gltf_accessor {
    int view;             // -1: zeros
    size_t offset, count; // bytes, elements
    int component_type;   // 5120 byte ... 5126 float
    int columns, rows;    // a vector is one column
    bool normalized;
    bool sparse;
    int sparse_count;
    int index_view, index_offset, index_type;
    int value_view, value_offset;
} gltf_accessor;

typedef struct gltf_attribute {
    const char *name;
    int accessor;
} gltf_attribute;

typedef struct gltf_attributes {
    gltf_attribute *v;
    int count;
} gltf_attributes;

typedef struct gltf_primitive {
    gltf_attributes attributes;
    gltf_attributes *targets;
    int target_count;
    int material, indices, mode;
} gltf_primitive;

typedef struct gltf_mesh {
    const char *name;
    gltf_primitive *primitives;
    int primitive_count;
    gltf_numbers weights;
} gltf_mesh;

typedef struct gltf_node {
    const char *name;
    gltf_ints children;
    int mesh, camera, skin, light;
    gltf_numbers translation, rotation, scale, matrix, weights;
} gltf_node;

typedef struct gltf_scene {
    const char *name;
    gltf_ints nodes;
} gltf_scene;

typedef struct gltf_skin {
    const char *name;
    gltf_ints joints;
    int inverse_bind;
} gltf_skin;

typedef struct gltf_channel {
    int sampler, node;
    const char *path;
} gltf_channel;

typedef struct gltf_curve { // an animation's sampler
    int input, output;
    const char *interpolation;
} gltf_curve;

typedef struct gltf_animation {
    const char *name;
    gltf_channel *channels;
    int channel_count;
    gltf_curve *curves;
    int curve_count;
} gltf_animation;

typedef struct gltf_camera {
    const char *name, *type;
    double yfov, znear, zfar;                 // perspective
    double xmag, ymag, ortho_near, ortho_far; // orthographic
} gltf_camera;

typedef struct gltf_light {
    const char *name, *type, *profile; // profile: of the extras, "" where there is none
    gltf_numbers color;
    double intensity, range, inner, outer;
} gltf_light;

typedef struct gltf_texture_info {
    int texture, uv;
    double offset[2], rotation, scale[2]; // KHR_texture_transform
} gltf_texture_info;

typedef struct gltf_material {
    const char *name, *alpha_mode;
    gltf_numbers base_color, emissive;
    double metallic, roughness, emissive_strength, alpha_cutoff;
    bool double_sided, unlit;
    gltf_texture_info base_color_tex, metallic_roughness_tex, emissive_tex, normal_tex,
        occlusion_tex;
} gltf_material;

typedef struct gltf_sampler {
    int mag_filter, wrap_s, wrap_t; // GL enumerants; -1: not given
} gltf_sampler;

typedef struct gltf_texture {
    const char *name;
    int sampler, image;
} gltf_texture;

typedef struct gltf_image {
    const char *name, *uri;
    int view;
    const uint8_t *data; // the encoded file where it is not in a view
    size_t size;
} gltf_image;

typedef struct gltf_model {
    gltf_buffer *buffers;
    gltf_view *views;
    gltf_accessor *accessors;
    gltf_mesh *meshes;
    gltf_node *nodes;
    gltf_scene *scenes;
    gltf_skin *skins;
    gltf_animation *animations;
    gltf_camera *cameras;
    gltf_light *lights;
    gltf_material *materials;
    gltf_sampler *samplers;
    gltf_texture *textures;
    gltf_image *images;
    int buffers_count, views_count, accessors_count, meshes_count, nodes_count, scenes_count,
        skins_count, animations_count, cameras_count, lights_count, materials_count, samplers_count,
        textures_count, images_count;
    const char *version, *min_version; // "" where it is not given
    int default_scene;
    struct gltf_block *blocks; // the mirror's memory
} gltf_model;

// `count` zeroed items that live as long as the model; NULL: out of memory.
void *gltf_model_alloc(gltf_model *m, size_t count, size_t item_size);
void gltf_model_finish(gltf_model *m);

FG_END

#endif // GLTF_MODEL_H
