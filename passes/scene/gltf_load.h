// SPDX-License-Identifier: MIT
// From a glTF file to a builder: the parts of ag_scene_load().
#ifndef GLTF_LOAD_H
#define GLTF_LOAD_H

#include "gltf_model.h"
#include "scene_priv.h"

typedef struct ag_load_desc {
    const fg_log *log;
    const char *label; // begins every message
    const char *name;  // of the scene
    const uint8_t *bytes;
    size_t size;
    const char *folder;    // where files beside it are; NULL: there are none
    uint64_t max_pixels;   // of all textures together; 0: 256 M
    uint64_t max_elements; // of vertices, indices, keys together; 0: 4 M and 64 a byte of input
} ag_load_desc;

// ag_scene_load() of a file that is in memory already.
fg_status ag_scene_load_memory(const ag_load_desc *desc, ag_scene **out);

// What loading one file carries along.
typedef struct gltf_loader {
    ag_builder *b;
    const gltf_model *m;
    const char *image_fault; // of the first image that could not be read; ""
    uint64_t elements_left, pixels_left;
    int *parents;           // by node of the file, -1: root
    bool *in_scene;         // by node: below the scene's roots
    int *nodes;             // by node: the builder's
    int *materials;         // by material: the builder's
    int metal;              // glTF's default material in the builder, -1: not needed yet
    int *skins;             // by skin: the builder's
    ag_array slots, stamps; // uint32_t by vertex: see number_vertices()
    uint32_t stamp;
    int lines_skipped, blends, unlits, normal_maps, ranges, unplayed; // for one message each
} gltf_loader;

// All the functions below: false after a refusal.

// Everything that refers to something refers to what is there; ranges lie in their buffers;
// nodes form trees. Fills `parents` and `in_scene`.
bool gltf_check(gltf_loader *l);
bool gltf_check_nodes(gltf_loader *l);
bool gltf_check_meshes(gltf_loader *l);
bool gltf_check_animations(gltf_loader *l);
// `index` is -1 or below `count`. "WHAT i: FIELD index does not exist (there are count)".
bool gltf_refers(gltf_loader *l, const char *what, int i, const char *field, int index, int count);
// Takes `n` from what the file's size allows to be read in all.
bool gltf_spend(gltf_loader *l, size_t n, const char *what, int i);

bool gltf_no_memory(gltf_loader *l); // false

// Materials with their textures, decoded on several threads.
bool gltf_load_materials(gltf_loader *l);
bool gltf_load_nodes(gltf_loader *l); // with lights, cameras, and the skins' joints
bool gltf_load_animations(gltf_loader *l);
bool gltf_load_shows(gltf_loader *l); // the meshes that the scene shows
// The builder's first primitive of a mesh (they follow each other, as many as it has that are
// kept in `count`), -1 after a refusal. `weights` are those of the node or none.
int gltf_load_mesh(gltf_loader *l, int mesh, gltf_numbers weights, int *count);

// ---- accessors --------------------------------------------------------------------

// An accessor that gltf_check() has passed, for reading in any order.
typedef struct gltf_reader {
    const uint8_t *data; // NULL: zeros
    size_t count, stride;
    size_t column_stride; // bytes
    int component_type, columns, rows;
    bool normalized;
    const uint8_t *indices, *values; // sparse
    size_t sparse_count, value_stride;
    int index_type;
} gltf_reader;

// Bytes of a component; 0: not one of glTF's.
size_t gltf_component_size(int component_type);
// Bytes of an element, columns of matrices at multiples of 4; and without the last one's padding.
size_t gltf_element_size(const gltf_accessor *a);
size_t gltf_element_extent(const gltf_accessor *a);
gltf_reader gltf_reader_open(const gltf_model *m, int accessor);
// columns x rows values of element `i`, below `count`.
void gltf_read_floats(const gltf_reader *r, size_t i, float *out);
// The first component as an unsigned integer.
uint32_t gltf_read_uint(const gltf_reader *r, size_t i);
// Sparse index number `k`.
uint32_t gltf_read_sparse_index(const gltf_reader *r, size_t k);

#endif // GLTF_LOAD_H
