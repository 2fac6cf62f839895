// SPDX-License-Identifier: MIT
// Point samples of a scene and what imperfect shadow maps are looked up with; read by C and GLSL
// (std430).
#ifndef PASS_ISM_SHARED_H
#define PASS_ISM_SHARED_H

#include "shared_types.h"

#ifndef GL_core_profile
typedef struct ag_ism_sample ag_ism_sample;
typedef struct ag_ism_point ag_ism_point;
typedef struct ag_ism_eye ag_ism_eye;
#endif

// A place on a triangle of the scene, wherever that goes.
struct ag_ism_sample {
    ag_ivec4 corners; // xyz: vertices of the scene's array; w: instance, -1: no sample
    ag_vec4 weights;  // xyz: barycentrics, sum 1; w: what one sample of all stands for, over the
                      // area of its triangle, both as they were when it was taken
};

// A sample in render space, in scene units: lengths times view.scale.x.
struct ag_ism_point {
    ag_vec4 position_area; // w: what one sample of all stands for now; 0: no sample
    ag_vec4 normal;        // xyz: unit, of the triangle, either side; w unused
};

// Where a map is seen from, in scene units. Its texels are directions of the hemisphere about
// `normal`: (x, y) / (1 + z) of the unit direction, -1 .. 1 over the map.
struct ag_ism_eye {
    ag_vec4 position;                   // xyz; w: radius of the largest disc in the map
    ag_vec4 tangent, bitangent, normal; // xyz; w unused
};

#ifdef GL_core_profile
// `count` VPLs share `maps` maps in runs of the list whose lengths differ by one at most.
// The map of VPL j, and the first VPL of a map.
int ism_map_of(int j, int count, int maps)
{
    int run = count / maps, longer = count % maps;
    int split = longer * (run + 1); // here the shorter runs begin; before it j < split has them all
    return j < split ? j / (run + 1) : longer + (j - split) / max(run, 1);
}

int ism_first_of(int map, int count, int maps)
{
    return map * (count / maps) + min(map, count % maps);
}
#endif

#endif // PASS_ISM_SHARED_H
