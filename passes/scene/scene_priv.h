// SPDX-License-Identifier: MIT
// What a scene is made of behind ag_scene, and what builder and scene share.
#ifndef SCENE_PRIV_H
#define SCENE_PRIV_H

#include <pass/scene.h>

enum {
    AG_MAX_SCENE_ITEMS = 1 << 24,    // materials, nodes, instances, ... of each kind
    AG_MAX_SCENE_VERTICES = 1 << 28, // so that 32-bit byte offsets of a 16-byte item suffice
    AG_MAX_SCENE_INDICES = 1 << 30,
    AG_MAX_SCENE_TEXTURE_SIDE = 16384, // texels
    AG_MAX_SCENE_ANIMATIONS = 1000000,
    AG_MAX_SCENE_WARNINGS = 30, // a broken file may need thousands of repairs
};

// A growing array of one type.
typedef struct ag_array {
    void *data;
    size_t count, capacity;
} ag_array;

// Room for `more` items at the end, which are counted and zeroed; NULL: out of memory, and
// nothing has changed.
void *ag_array_push(ag_array *a, size_t more, size_t item_size);
void ag_array_finish(ag_array *a);

typedef struct ag_trs {
    double translation[3], rotation[4], scale[3];
} ag_trs;

typedef struct ag_node {
    char name[64];
    int parent; // -1 or below its own index
    bool has_matrix;
    bool driven;          // some channel aims at it
    bool moving;          // it or a parent changes with time
    uint8_t driven_paths; // bit per ag_path
    ag_trs rest, pose;
    double matrix[16];
    double world[16];
    double first_world[16]; // at time 0, finite; what stands in where an animation overflows
} ag_node;

// What a channel drives of a material, beside it.
typedef struct ag_material_drive {
    uint8_t driven_paths;          // bit per ag_path
    bool uv_moves;                 // its textures are elsewhere at other times
    float peak[3];                 // W/(m^2 sr), at least the most that it ever emits
    float rest_offset[3][2];       // t2 and t5 of its references, without what drives them
    double emissive[3], offset[2]; // as posed
} ag_material_drive;

typedef struct ag_channel {
    int target; // a node or, for paths of materials, a material
    ag_path path;
    ag_interpolation interpolation;
    int animation;
    int key_count;
    float *times, *values; // one block, owned
} ag_channel;

typedef struct ag_skin {
    int *joints;
    double *inverse_bind; // [16 * count]
    int count;
} ag_skin;

// What a vertex of a skinned primitive is computed from.
typedef struct ag_influence {
    uint16_t joint[4];
    float weight[4]; // sum 1
} ag_influence;

typedef struct ag_rest_vertex {
    float position[3], normal[3];
    ag_influence influence;
} ag_rest_vertex;

// One skinned primitive of the scene.
typedef struct ag_skinned {
    int primitive, skin;
    bool moving;       // some joint does
    size_t first_rest; // of `rest`; as many as the primitive has vertices
} ag_skinned;

// Where a builder's primitive keeps its joints until the build.
typedef struct ag_staged_skin {
    size_t first_influence;
    bool has_influences;
    int highest_joint;
    int skin; // with which it is shown, -1: none, -2: not shown yet
} ag_staged_skin;

struct ag_scene_private {
    ag_array vertices;       // ag_vertex
    ag_array indices;        // uint32_t
    ag_array primitives;     // ag_primitive
    ag_array staged;         // ag_staged_skin, as primitives
    ag_array influences;     // ag_influence
    ag_array instances;      // ag_instance
    ag_array instance_skins; // int, -1: none
    ag_array materials;      // ag_material
    ag_array drives;         // ag_material_drive, as materials
    ag_array textures;
    ag_array lights, light_nodes;   // ag_light, int (-1: no node)
    ag_array cameras, camera_nodes; // ag_camera, int
    ag_array nodes;                 // ag_node
    ag_array channels;              // ag_channel
    ag_array lengths;               // double seconds, by animation number
    ag_array skins;                 // ag_skin
    ag_array skinned;               // ag_skinned
    ag_array rest;                  // ag_rest_vertex
    double *joint_worlds;           // scratch for skinning: [16] and [9] a joint
    fg_log log;
    char *label; // begins every message: the file or the scene's name
};

struct ag_builder {
    ag_scene_private *p;
    fg_status status;
    bool built;
    int warnings;
    char name[64];
};

void ag_scene_private_destroy(ag_scene_private *p);

// Copies at most 63 bytes, cut between characters; NULL is empty.
void ag_name_copy(char out[64], const char *name);

// Begins every later message with `label` instead of the scene's name.
fg_status ag_builder_set_label(ag_builder *b, const char *label);
// Logs the first refusal and keeps its status. Always -1.
int ag_builder_refuse(ag_builder *b, fg_status status, const char *fmt, ...) FG_PRINTF(3, 4);
// Counts a repair, and logs the first AG_MAX_SCENE_WARNINGS.
void ag_builder_warn(ag_builder *b, const char *fmt, ...) FG_PRINTF(2, 3);
// What is as it should be and still worth a line.
void ag_builder_info(ag_builder *b, const char *fmt, ...) FG_PRINTF(2, 3);
// Whether a call may go on: nothing refused yet, not built yet.
bool ag_builder_open(ag_builder *b);
// A new item at the end of an array of at most AG_MAX_SCENE_ITEMS, or NULL after a refusal.
void *ag_builder_push(ag_builder *b, ag_array *a, size_t item_size, const char *what);

// As ag_builder_texture(), but `rgba` came from malloc() and is taken over, refused or not.
int ag_builder_texture_take(ag_builder *b, const ag_texture *texture, uint8_t *rgba);

// NULL, or what is wrong with it.
const char *ag_light_fault(const ag_light *light, bool placed);
void ag_light_normalize(ag_light *light);
const char *ag_camera_fault(const ag_camera *camera, bool placed);

// Whether the path is one of materials, not of nodes.
bool ag_path_of_material(ag_path path);
// Numbers in a value of the path: 2 to 4.
int ag_path_size(ag_path path);
// The channel's value at `seconds`: ag_path_size() numbers, a rotation unit.
void ag_channel_sample(const ag_channel *c, double seconds, double out[4]);
// The pose of every driven node and material at `seconds`.
void ag_animate(ag_scene_private *p, double seconds);
// Worlds of the moving nodes, or of all when they are computed for the first time.
void ag_worlds_update(ag_scene_private *p, bool first);
// Everything that hangs on nodes, after their worlds.
void ag_scene_follow(ag_scene *scene, bool first);
// Rewrites the vertices of every skinned primitive that moves, `first` of all; true if any changed.
bool ag_skin_all(ag_scene_private *p, bool first);
// The texture references of a material, in the order of ag_material_drive.rest_offset.
void ag_material_refs(ag_material *m, ag_texture_ref *refs[3]);
// Brings the materials that move, or `first` all that are driven, to their pose; true if any
// changed.
bool ag_materials_follow(ag_scene_private *p, bool first);
// Whether the material's textures are elsewhere at other times.
bool ag_scene_uv_moves(const ag_scene *scene, int material);
void ag_primitive_bounds(const ag_scene_private *p, ag_primitive *primitive);
// Pointers and counts of the public arrays, from the private ones.
void ag_scene_publish(ag_scene *scene);
uint64_t ag_scene_features(const ag_scene *scene);

#endif // SCENE_PRIV_H
