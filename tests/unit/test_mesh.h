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

// A scene's triangles as shown, in world space, for rays that try every one of them: slow, and
// sharing nothing with the code that it checks.
typedef struct soup {
    size_t count;
    double (*corners)[3][3]; // free() it; NULL: out of memory
} soup;

size_t scene_triangles(const ag_scene *s); // as shown, instances counted
soup soup_of(const ag_scene *s);
// Distance to the nearest triangle beyond 1e-6, in units of |direction|, or `limit`.
double soup_nearest(const soup *s, const double from[3], const double direction[3], double limit);
// Whether some light of the scene reaches a point, which is not on a surface, with more than
// `least` W/m^2 of red.
bool scene_lit(const ag_scene *s, const soup *w, const double at[3], float least);

#endif // TEST_MESH_H
