// SPDX-License-Identifier: MIT
#ifndef SHAPES_H
#define SHAPES_H

#include <pass/scene.h>

FG_BEGIN

// Triangle meshes made by code, for the built-in scenes.
//
//     shape s = { .tiling = 0.5f };
//     shape_box(&s, (float[3]){ -1, 0, -1 }, (float[3]){ 1, 2, 1 });
//     if (!s.failed) { ... s.vertices, s.indices ... }
//     shape_finish(&s);
//
// Every call appends. Units: metres. Normals are unit and point out of the solid (of a vault or
// a sheet: the way its comment says); triangles wind counter-clockwise seen from where the
// normals point. Texture coordinates are metres along the surface times `tiling`.
typedef struct shape {
    ag_vertex *vertices; // owned
    size_t vertex_count, vertex_capacity;
    uint32_t *indices; // owned; triangles
    size_t index_count, index_capacity;
    float tiling; // texture repeats a metre; 0: 1
    bool failed;  // out of memory; sticks, and later calls do nothing
} shape;

void shape_finish(shape *s); // leaves a zeroed shape

// `normal` need not be unit; u and v are metres. Returns the index.
uint32_t shape_vertex(shape *s, const float position[3], const float normal[3], float u, float v);
// Wound to agree with the vertices' normals; one without area is left out.
void shape_triangle(shape *s, uint32_t a, uint32_t b, uint32_t c);
// (nu + 1) x (nv + 1) vertices from `first` on, row by row.
void shape_lattice(shape *s, uint32_t first, int nu, int nv);

// A flat quad, corners in order around it; the normal is (p1 - p0) x (p3 - p0).
void shape_quad(shape *s, const float corners[4][3]);
void shape_box(shape *s, const float lo[3], const float hi[3]);
// One side of it: 2 x axis for the low one, and 1 for the high one.
void shape_box_face(shape *s, const float lo[3], const float hi[3], int face);

// A box with edges and corners rounded by `radius`, at most half the least side; each quarter turn
// of an edge has `segments` flats. Closed.
void shape_round_box(shape *s, const float lo[3], const float hi[3], float radius, int segments);
// Gives what was appended since `first_vertex` a colour, linear, times the material's.
void shape_paint(shape *s, size_t first_vertex, const float rgb[3]);

// A solid of revolution around +Y. The profile runs from the bottom upwards with the solid on
// its left; from axis to axis it makes a closed surface.
typedef struct shape_lathe_desc {
    const float (*profile)[2]; // radius >= 0, height
    int count;                 // >= 2
    int segments;              // around, >= 3; a multiple of `lobes`
    int lobes;                 // flutes or leaves around; 0: round
    float lobe_depth;          // of the radius, [0, 0.5): how deep they are cut
} shape_lathe_desc;
void shape_lathe(shape *s, const shape_lathe_desc *desc);
void shape_sphere(shape *s, const float centre[3], float radius, int segments);

// A round bar along a polyline, closed by flat ends.
typedef struct shape_tube_desc {
    const float (*path)[3];
    int count; // >= 2
    float radius;
    int segments; // >= 3
} shape_tube_desc;
void shape_tube(shape *s, const shape_tube_desc *desc);

// A sheet over the unit square; its normal is dp/du x dp/dv.
typedef struct shape_sheet_desc {
    void (*point)(const void *user, float u, float v, float p[3], float uv[2]); // uv in metres
    const void *user;
    int nu, nv;
} shape_sheet_desc;
void shape_sheet(shape *s, const shape_sheet_desc *desc);

// A curtain in the plane z = 0, centred on x = 0, hanging down from y = 0, folded by a sine.
typedef struct shape_cloth_desc {
    float width, height;
    int folds;
    float depth;  // of the folds at the hem, metres; a third of it at the rod
    float gather; // [0, 1): how much narrower it is at two thirds of its height
    float phase;  // of the first fold, radians
    int nu, nv;
} shape_cloth_desc;
void shape_cloth(shape *s, const shape_cloth_desc *desc);

// Moves what was appended since `first_vertex`: turned by `yaw` radians around +Y, then shifted.
void shape_move(shape *s, size_t first_vertex, const float offset[3], float yaw);

// ---- architecture (shapes_arch.c) -------------------------------------------------

// A wall along x, centred on the origin and on z = 0, pierced by one arch in the middle of every
// bay. Its foot is at the springing: `spring` metres high between the arches. Closed.
typedef struct shape_arcade_desc {
    int bays;
    float bay;         // width of one, metres
    float radius;      // half the opening's width, below bay / 2
    float rise;        // of the opening above the springing
    float spring, top; // heights
    float thickness;
    int segments; // of an arch
} shape_arcade_desc;
void shape_arcade(shape *s, const shape_arcade_desc *desc);

// A half ring of stones standing on the springing, of rectangular section. Closed.
typedef struct shape_archivolt_desc {
    float inner, outer; // radii
    float spring;       // height
    float thickness;    // along z
    int segments;
} shape_archivolt_desc;
void shape_archivolt(shape *s, const shape_archivolt_desc *desc);

// A ring around a rectangle of half sizes `half_x`, `half_z`, mitred at the corners: a moulding, a
// slab with a court left open, a wall. Closed.
typedef struct shape_frame_desc {
    float half_x, half_z;
    const float (*profile)[2]; // a closed polygon: offset outwards from the rectangle, height
    int count;                 // the last corner joins the first
} shape_frame_desc;
void shape_frame(shape *s, const shape_frame_desc *desc);

// The underside of a groin vault over a bay, centred on the origin; normals point down. Open.
typedef struct shape_vault_desc {
    float half_x, half_z;
    float spring, rise;
    int segments; // of one barrel
} shape_vault_desc;
void shape_vault(shape *s, const shape_vault_desc *desc);

// ---- plants (shapes_plants.c) -----------------------------------------------------
//
// Cards are quads that show one whole picture, u to the right, v downwards.

// A small deterministic generator: [0, 1).
float shape_draw(uint32_t *state);
// One card of side `size`, more or less, around `centre`, facing `normal` more or less.
void shape_card(shape *s, const float centre[3], const float normal[3], float size,
                uint32_t *state);

// Cards all over an ellipsoid: a bush, or the crown of a small tree.
typedef struct shape_crown_desc {
    float centre[3], radius[3];
    float size; // of a card
    int count;
    uint32_t seed;
} shape_crown_desc;
void shape_crown(shape *s, const shape_crown_desc *desc);

// A strip that rises from `foot` in the direction `yaw` and bends over: a frond, or with one piece
// and little reach a blade. Its normals lean up, so that it is as light as the ground around.
typedef struct shape_frond_desc {
    float foot[3];
    float yaw;           // radians around +Y: 0 bends over to +Z
    float width, length; // metres
    float rise;          // radians above the horizon at the foot
    float droop;         // how many radians it has bent down by the tip
    int pieces;          // >= 1
} shape_frond_desc;
void shape_frond(shape *s, const shape_frond_desc *desc);

// ---- fields (shapes_field.c) -----------------------------------------------------

// The surface of a solid given by a field, negative inside: one vertex in every cell of a grid that
// the surface goes through. Closed where the whole surface is inside of the box.
// Source: Gibson. Constrained Elastic Surface Nets. MICCAI 1998; unconstrained, vertices in the
//         middle of where the surface meets the cell's edges.
typedef struct shape_field_desc {
    float (*field)(const void *user, const float p[3]); // metres, about the distance
    const void *user;
    float lo[3], hi[3];
    float cell;     // metres
    float steepest; // the field changes by no more than so much a metre, >= 1
} shape_field_desc;
void shape_field(shape *s, const shape_field_desc *desc);

// What fields are put together from: the distance from `p` to a ball stretched to radii `r` (near
// it), to a bar from `a` to `b` whose radius goes from `ra` to `rb`; two solids joined, rounded off
// over `k` metres.
float field_ball(const float p[3], const float centre[3], const float r[3]);
float field_bar(const float p[3], const float a[3], const float b[3], float ra, float rb);
float field_join(float a, float b, float k);

// Normals of what was appended since: the mean of the faces around, none of which then winds
// against one of its vertices' normals.
void shape_smooth(shape *s, size_t first_vertex, size_t first_index);

FG_END

#endif // SHAPES_H
