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
// A camera at `eye` that looks at `target`, `yfov` in radians.
void kit_camera(kit *k, const char *name, const double eye[3], const double target[3], float yfov);

// The quaternion (xyzw) that turns -Z into `direction` and keeps +X horizontal; `direction` is
// not vertical.
void kit_aim(const double direction[3], double rotation[4]);

// The quaternion of a turn of `angle` radians around axis 0, 1 or 2.
void kit_turn(int axis, double angle, double rotation[4]);

FG_END

#endif // KIT_H
