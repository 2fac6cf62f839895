// SPDX-License-Identifier: MIT
#ifndef TEST_MESH_H
#define TEST_MESH_H

#include <pass/scene.h>

// Facts about a triangle mesh, for tests of what makes meshes.
typedef struct mesh {
    const ag_vertex *vertices;
    size_t vertex_count;
    const uint32_t *indices;
    size_t index_count;
} mesh;

// Directed edges, between positions, that no face passes the other way: 0 of a closed surface.
int mesh_open_edges(const mesh *m);
// Faces that wind against one of their vertices' normals.
int mesh_faces_against_normals(const mesh *m);
// The least cosine between a face and a normal of its vertices.
double mesh_worst_agreement(const mesh *m);
// The largest |length - 1| of a normal.
double mesh_worst_normal(const mesh *m);
// Enclosed volume; negative where the faces look inwards.
double mesh_volume(const mesh *m);
// Area of the faces that look down, projected on the ground.
double mesh_area_from_below(const mesh *m);
void mesh_bounds(const mesh *m, float lo[3], float hi[3]);

#endif // TEST_MESH_H
