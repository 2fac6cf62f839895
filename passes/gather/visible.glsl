// SPDX-License-Identifier: MIT
// How much of a VPL's light arrives, by the shadow maps there are. VISIBILITY: 1 imperfect ones, 2
// paraboloid ones. Places are in scene units, normals unit. Included by gather.glsl.
#include "passes/shading/hemisphere.glsl"
#if VISIBILITY == 1
#include "passes/ism/visibility.glsl"
#define vpl_map ism_map

// Of VPL j of `count`.
vpl_map vpl_open(int j, int count)
{
    return ism_open(ism_map_of(j, count));
}

float vpl_visibility(vpl_map m, vec3 position, vec3 normal)
{
    return ism_visibility(m, position, normal);
}
#else
#include "passes/paraboloid/visibility.glsl"
#define vpl_map paraboloid_map

vpl_map vpl_open(int j, int count)
{
    return paraboloid_open(j);
}

float vpl_visibility(vpl_map m, vec3 position, vec3 normal)
{
    return paraboloid_visibility(m, position, normal);
}
#endif
