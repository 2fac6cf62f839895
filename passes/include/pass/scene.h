// SPDX-License-Identifier: MIT
#ifndef PASS_SCENE_H
#define PASS_SCENE_H

#include <fg/base.h>

FG_BEGIN

// A scene in host memory: what a glTF file or a generator gives, and what the
// GPU passes and the reference renderer both read.
//
//     ag_scene *scene;
//     if (ag_scene_load(&log, "sponza.gltf", &scene) == FG_OK) {
//         ag_scene_set_time(scene, frame / 60.0);
//         ... scene->instances[i].world, scene->lights[j].position ...
//     }
//     ag_scene_destroy(scene);
//
// Units: metres, right-handed, +Y up; linear RGB (Rec. 709), radiometric.
// The arrays are the scene's own and read-only to others. ag_scene_set_time()
// rewrites what can move, in place: worlds, lights, cameras, skinned vertices, and of
// a material that moves `emissive` and the offsets of its transforms; what does not
// move it leaves alone, so that other threads may read it meanwhile.

typedef struct ag_vertex { // interleaved as the GPU reads it: 64 bytes
    float position[3];
    float normal[3]; // unit; never zero
    float uv[2][2];  // TEXCOORD_0, TEXCOORD_1
    float color[4];  // COLOR_0, linear; 1 where there is none. Multiplies the base colour.
    uint32_t pad[2];
} ag_vertex;

// A run of triangles with one material. Vertices are in the space of the node
// that shows it; of a skinned primitive in world space, rewritten by set_time.
typedef struct ag_primitive {
    uint32_t first_index, index_count; // a multiple of 3; indices count from first_vertex
    uint32_t first_vertex, vertex_count;
    int material;                 // always valid
    float box_min[3], box_max[3]; // of the vertices as they stand
    bool skinned;
} ag_primitive;

// A primitive shown by a node.
typedef struct ag_instance {
    int primitive, node;
    double world[16]; // column-major, node to world
    bool mirrored;    // world has a negative determinant: front faces wind the other way
    bool moving; // an animation changes it: its transform, its skin or where its mask has holes
} ag_instance;

typedef struct ag_texture_ref {
    int texture;        // -1: none
    int uv;             // 0 or 1
    float transform[6]; // KHR_texture_transform: u' = t0 u + t1 v + t2, v' = t3 u + t4 v + t5;
                        // all zero means identity
} ag_texture_ref;

typedef enum ag_alpha {
    AG_ALPHA_OPAQUE = 0, // BLEND too, with a warning
    AG_ALPHA_MASK,       // a texel below `alpha_cutoff` is not there, for shadow rays too
} ag_alpha;

typedef struct ag_material {
    char name[64];
    float base_color[4]; // linear, [0, 1]
    float metallic, roughness;
    float emissive[3]; // emissiveFactor x emissiveStrength, W/(m^2 sr)
    ag_texture_ref base_color_tex, metallic_roughness_tex, emissive_tex; // G roughness, B metallic
    ag_alpha alpha;
    float alpha_cutoff;
    bool double_sided; // here: emits from both faces. Surfaces reflect from both anyway.
    bool moving;       // an animation changes `emissive` or its transforms' offsets, t2 and t5
} ag_material;

typedef enum ag_wrap {
    AG_WRAP_REPEAT = 0,
    AG_WRAP_CLAMP,
    AG_WRAP_MIRROR,
} ag_wrap;

typedef struct ag_texture {
    char name[64];
    int width, height;
    const uint8_t *rgba; // RGBA8, top row first as in glTF (v = 0 is the first row)
    bool srgb;           // rgb needs decoding to linear
    bool nearest;        // magnification filter; minification is trilinear or nearest alike
    ag_wrap wrap_u, wrap_v;
} ag_texture;

typedef enum ag_light_kind {
    AG_LIGHT_POINT = 0,
    AG_LIGHT_SPOT,
    AG_LIGHT_DIRECTIONAL,
} ag_light_kind;

// Point and spot: E = intensity cos / d^2, intensity in W/sr. Directional:
// E = intensity cos, W/m^2. A spot fades by the squared ramp
// clamp((cos - cos_outer) / max(1e-3, cos_inner - cos_outer), 0, 1)^2; a cosine
// spot (`extras.profile` = "cosine") has intensity * max(0, cos) over 180 degrees.
typedef struct ag_light {
    char name[64];
    ag_light_kind kind;
    bool cosine;
    double position[3]; // world
    float direction[3]; // unit, the way the light goes
    float intensity[3];
    float cos_inner, cos_outer;
    bool moving;
} ag_light;

typedef struct ag_camera {
    char name[64];
    double world[16]; // looks along -Z; rigid, scale removed
    bool orthographic;
    float yfov;        // radians, (0, pi)
    float half_height; // orthographic, metres
    float znear;       // > 0 for perspective. The far plane is at infinity for perspective cameras.
    float zfar;        // orthographic only
    bool moving;
} ag_camera;

// What a scene contains: the bits that fg_pass_desc.needs and shader
// permutations are held against. ag_feature_names[] has the words.
typedef enum ag_feature {
    AG_FEATURE_TEXTURES = 1 << 0,
    AG_FEATURE_ALPHA_MASK = 1 << 1,
    AG_FEATURE_GLOSSY = 1 << 2,     // some metallic > 0 or roughness < 1
    AG_FEATURE_EMISSIVE = 1 << 3,   // some surface emits, now or at another time
    AG_FEATURE_AREA_LIGHT = 1 << 4, // some emissive primitive gives at least 1 % of all flux, each
                                    // at its brightest
    AG_FEATURE_MOVING_GEOMETRY = 1 << 5,
    AG_FEATURE_MOVING_LIGHT = 1 << 6,
    AG_FEATURE_SEVERAL_LIGHTS = 1 << 7,
    AG_FEATURE_POINT_LIGHT = 1 << 8,
    AG_FEATURE_SPOT_LIGHT = 1 << 9,
    AG_FEATURE_DIRECTIONAL_LIGHT = 1 << 10,
    AG_FEATURE_SKINS = 1 << 11,
    AG_FEATURE_SECOND_UV = 1 << 12,
    AG_FEATURE_VERTEX_COLOR = 1 << 13,
    AG_FEATURE_TEXTURE_TRANSFORM = 1 << 14,
    AG_FEATURE_GEOMETRY = 1 << 15, // there is at least one triangle
    AG_FEATURE_LIGHT = 1 << 16,    // there is at least one punctual light
    AG_FEATURE_MOVING_MATERIAL = 1 << 17,
} ag_feature;
enum { AG_FEATURE_COUNT = 18 };
FG_API extern const char *const ag_feature_names[AG_FEATURE_COUNT];

typedef struct ag_scene_private ag_scene_private; // nodes, animations, skins

typedef struct ag_scene {
    char name[64];
    const ag_vertex *vertices;
    size_t vertex_count;
    const uint32_t *indices;
    size_t index_count;
    const ag_primitive *primitives;
    int primitive_count;
    const ag_instance *instances;
    int instance_count;
    const ag_material *materials;
    int material_count;
    const ag_texture *textures;
    int texture_count;
    const ag_light *lights;
    int light_count;
    const ag_camera *cameras;
    int camera_count;
    uint64_t features;             // ag_feature bits
    double box_min[3], box_max[3]; // world bounds at the current time; min > max when empty
    double duration;               // seconds of the longest animation, 0: none
    double time;                   // what set_time was last given
    uint64_t geometry_revision;    // changes when set_time moved a world or a vertex
    uint64_t light_revision;
    uint64_t material_revision; // changes when set_time changed a material
    int warning_count;          // repairs made while loading
    ag_scene_private *priv;
} ag_scene;

// Loads a .gltf or .glb file. Which camera and light stand in when there are none
// is the caller's business: the arrays may be empty.
//
// Errors: FG_ERR_INPUT, the file is missing, broken or needs an extension that is not
//         there: one line that names file and fault; FG_ERR_MEMORY. `*out` is NULL then.
FG_API FG_NODISCARD fg_status ag_scene_load(const fg_log *log, const char *path, ag_scene **out);

// Accepts NULL.
FG_API void ag_scene_destroy(ag_scene *scene);

// Puts the scene to `seconds` >= 0: every animation, looped over its own length,
// then worlds, bounds, lights, cameras, skins and materials. Deterministic: equal times give
// equal bits, whatever came before.
FG_API void ag_scene_set_time(ag_scene *scene, double seconds);

// -1 if there is no camera of that name.
FG_API int ag_scene_find_camera(const ag_scene *scene, const char *name);

// A perspective camera that has the whole scene in view; of an empty scene, one at
// the origin.
FG_API ag_camera ag_scene_framing_camera(const ag_scene *scene);

// Adds a light or camera from outside (command line, tests), or replaces the one of the same
// name. Errors: FG_ERR_INVALID, as ag_builder_light() refuses it; FG_ERR_MEMORY.
FG_API FG_NODISCARD fg_status ag_scene_add_light(ag_scene *scene, const ag_light *light);
FG_API FG_NODISCARD fg_status ag_scene_add_camera(ag_scene *scene, const ag_camera *camera);

// ---- building by code ------------------------------------------------------------
//
// The loader and the built-in scenes both go through the builder, so that both get
// the same checks. Indices returned are those of the scene's arrays; -1 is a refused call: the
// first refusal sticks, its message goes to the log, ag_scene_build() returns its status.

typedef struct ag_builder ag_builder;

FG_API ag_builder *ag_builder_create(const fg_log *log, const char *name); // NULL: out of memory
FG_API void ag_builder_destroy(ag_builder *b);                             // accepts NULL

// The default material: white, roughness 1, metallic 0, opaque, no textures.
FG_API ag_material ag_default_material(void);
// A point light at the origin, 1 W/sr, with a cone of 90 degrees where it is made a spot.
FG_API ag_light ag_default_light(void);
// At the origin, 45 degrees, znear 0.05.
FG_API ag_camera ag_default_camera(void);

// Pixels are copied. Width and height in [1, 16384].
FG_API int ag_builder_texture(ag_builder *b, const ag_texture *texture);
// Factors outside of [0, 1] are clamped with a warning; emission may not be negative. `moving` is
// ignored: channels decide it.
FG_API int ag_builder_material(ag_builder *b, const ag_material *material);

// A mesh primitive, not yet shown. Arrays are copied; `indices` may be NULL (0, 1, 2, ...).
// Normals of zero length are computed from the faces: where all are, each triangle gets
// vertices of its own (flat, as glTF asks); where some are, those get the mean by area, with
// a warning. Triangles with an index out of range refuse the call; ones of zero area or with
// non-finite vertices are dropped with a counted warning, and so are unused vertices (without
// one). Other non-finite values become 0 (colour: 1) with a warning.
typedef struct ag_primitive_desc {
    const char *name; // for messages
    const ag_vertex *vertices;
    size_t vertex_count;
    const uint32_t *indices;
    size_t index_count;
    int material;                // -1: the default one
    const uint16_t (*joints)[4]; // with `weights`: one per vertex, or both NULL
    const float (*weights)[4];
} ag_primitive_desc;
FG_API int ag_builder_primitive(ag_builder *b, const ag_primitive_desc *desc);

// A node; `parent` is -1 or an earlier node. Translation, quaternion (xyzw), scale.
typedef struct ag_node_desc {
    const char *name;
    int parent;
    double translation[3];
    double rotation[4];   // zero means identity
    double scale[3];      // zero means 1, 1, 1
    const double *matrix; // [16] column-major, instead of the three above; NULL: not used
} ag_node_desc;
FG_API int ag_builder_node(ag_builder *b, const ag_node_desc *desc);

// Shows a primitive at a node; `skin` -1 or from ag_builder_skin(). A primitive that is shown
// with several skins (or with and without) becomes several of the scene's; the first keeps
// the index.
FG_API void ag_builder_show(ag_builder *b, int node, int primitive, int skin);
// Joints are nodes; `inverse_bind` is float[16 * count] or NULL (identities).
FG_API int ag_builder_skin(ag_builder *b, const int *joints, int count, const float *inverse_bind);
// Puts a light or camera at a node, in the node's own -Z direction; position,
// direction and world of the argument are ignored. Node -1: taken as they are.
FG_API int ag_builder_light(ag_builder *b, int node, const ag_light *light);
FG_API int ag_builder_camera(ag_builder *b, int node, const ag_camera *camera);

typedef enum ag_path {
    AG_PATH_TRANSLATION = 0, // 3 values a key
    AG_PATH_ROTATION,        // 4, quaternions
    AG_PATH_SCALE,           // 3
    AG_PATH_EMISSIVE,  // 3, W/(m^2 sr), not negative: stands in for ag_material.emissive. Below 0,
                       // where a cubic may swing, is 0.
    AG_PATH_UV_OFFSET, // 2, added to t2 and t5 of every texture reference of the material
} ag_path;
typedef enum ag_interpolation {
    AG_INTERPOLATE_LINEAR = 0, // slerp for rotations
    AG_INTERPOLATE_STEP,
    AG_INTERPOLATE_CUBIC, // three values a key: in-tangent, value, out-tangent
} ag_interpolation;
typedef struct ag_channel_desc {
    int node; // of translations, rotations and scales
    ag_path path;
    ag_interpolation interpolation;
    int key_count;
    const float *times; // seconds, increasing, >= 0
    const float *values;
    int animation; // [0, 1000000): channels of one number loop over their longest together
    int material;  // of emission and offsets; `node` is ignored then
} ag_channel_desc;
// A path of a node or material that is driven already stays as it is, with a warning; a node with a
// matrix cannot be driven.
FG_API void ag_builder_channel(ag_builder *b, const ag_channel_desc *channel);

// Finishes: `*out` owns everything, the builder stays to be destroyed. The scene
// stands at time 0. Errors: the first refusal; FG_ERR_MEMORY.
FG_API FG_NODISCARD fg_status ag_scene_build(ag_builder *b, ag_scene **out);

FG_END

#endif // PASS_SCENE_H
