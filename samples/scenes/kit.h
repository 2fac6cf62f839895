// SPDX-License-Identifier: MIT
#ifndef KIT_H
#define KIT_H

#include "patterns.h"
#include "shapes.h"

FG_BEGIN

// What the built-in scenes are assembled with: a builder that remembers a failed allocation, so
// that a scene is written down without a check at every line.
typedef struct kit {
    const fg_log *log;
    ag_builder *builder; // owned
    bool failed;         // out of memory, here or in a shape
    int motions;         // each is an animation of its own, so that lengths may differ
} kit;

// False: out of memory, said in the log.
bool kit_begin(kit *k, const fg_log *log, const char *name);
// Builds and frees all. Errors: the builder's; FG_ERR_MEMORY.
FG_NODISCARD fg_status kit_end(kit *k, ag_scene **out);

// Where a node stands under its parent: metres, radians around +Y.
typedef struct place {
    double x, y, z;
    double yaw;
} place;

int kit_node(kit *k, const char *name, int parent, place at);
// Turns the shape into a primitive and frees it.
int kit_part(kit *k, const char *name, shape *s, int material);
// A node that shows `part`. Returns the node.
int kit_show(kit *k, const char *name, int part, int parent, place at);
int kit_texture(kit *k, const char *name, pattern what, int size);
// What a thing is made of.
typedef struct kit_look {
    const char *name;
    int texture;     // a pattern, -1: none; of the emission where there is some, else the colour
    float color[3];  // linear, times the texture
    float roughness; // 0: 1
    float metallic;
    float emissive[3]; // W/(m^2 sr)
    int size;          // of the texture, texels along an edge; 0: 256
} kit_look;
// One material a look; those of one pattern share the texture that the first of them paints.
void kit_materials(kit *k, const kit_look *looks, int count, int *material);

// A camera at `eye` that looks at `target`, `yfov` in radians.
void kit_camera(kit *k, const char *name, const double eye[3], const double target[3], float yfov);

// ---- what moves (kit_motion.c) ------------------------------------------------------

// What drives a node or a material: a curve over t in [0, 1], sampled at even distances and
// followed in straight lines (of rotations: arcs) between. It loops: a curve that ends as it begins
// does not jump.
typedef struct kit_motion {
    int node; // or, by the path, `material`
    int material;
    ag_path path;
    int keys;      // >= 2, both ends counted
    float seconds; // of a round
    // As many values as the path has: ag_path.
    void (*curve)(const void *user, float t, float out[4]);
    const void *user;
} kit_motion;
void kit_move(kit *k, const kit_motion *m);

// To and fro around an axis: a swing of `amplitude` radians, `count` times in `seconds`, from
// `phase` (in swings) on.
typedef struct kit_swing_desc {
    int axis;
    float amplitude, phase, seconds;
    int count;
} kit_swing_desc;
void kit_swing(kit *k, int node, const kit_swing_desc *desc);

// A point of an oval around the origin, `way` metres along it from (-half, -radius): two straights
// along x of 2 `half`, and two half rings. `at` is x and z; returns the yaw of what goes there with
// -z ahead.
float kit_oval(float half, float radius, float way, float *const at[2]);

// A camera that goes smoothly from stop to stop and back to the first, within `seconds`; the way
// from one to the next takes longer the further the eye goes and the target turns away.
typedef struct kit_stop {
    double eye[3], target[3]; // not above each other
} kit_stop;
typedef struct kit_walk_desc {
    const char *name;
    const kit_stop *stops;
    int count;     // >= 3; no two in a row are the same
    float seconds; // of a round
    float yfov;    // radians
} kit_walk_desc;
void kit_walk(kit *k, const kit_walk_desc *desc);

// The quaternion (xyzw) that turns -Z into `direction` and keeps +X horizontal; `direction` is
// not vertical.
void kit_aim(const double direction[3], double rotation[4]);
// The same for the curve of a kit_motion.
void kit_aim_curve(const double direction[3], float out[4]);

// The quaternion of a turn of `angle` radians around axis 0, 1 or 2.
void kit_turn(int axis, double angle, double rotation[4]);

FG_END

#endif // KIT_H
