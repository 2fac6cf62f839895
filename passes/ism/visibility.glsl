// SPDX-License-Identifier: MIT
// Visibility of VPLs by imperfect shadow maps (pass/ism.h). ag_ism_bind() binds what is read here.
// Everything is in scene units: render space times view.scale.x.
#include "passes/include/pass/ism_shared.h"
#include "passes/shading/hemisphere.glsl"

layout(binding = 4) uniform sampler2DArray ism_maps;
layout(std430, binding = 4) readonly buffer ism_eye_buffer
{
    ag_ism_eye ism_eyes[];
};

// The map of VPL j of `count`.
int ism_map_of(int j, int count)
{
    return ism_map_of(j, count, textureSize(ism_maps, 0).z);
}

// A map made ready for several receivers.
struct ism_map {
    vec3 eye, tangent, bitangent, normal;
    int layer;
    float size, texel, disc; // texels along an edge; 1 / size; the largest disc's radius
};

ism_map ism_open(int layer)
{
    float size = float(textureSize(ism_maps, 0).x);
    return ism_map(ism_eyes[layer].position.xyz, ism_eyes[layer].tangent.xyz,
                   ism_eyes[layer].bitangent.xyz, ism_eyes[layer].normal.xyz, layer, size, 1.0 / size,
                   ism_eyes[layer].position.w);
}

// A texel hides the receiver by more than so many texels' angle and more than a disc's radius. The
// farthest of the 2x2 texels is 1.41 away: a wall that meets the receiver's at an edge, and turns to
// the eye by up to 45 degrees, does not hide it there. A disc stands out past an edge, and over a
// curved surface, by its radius at most.
const float ism_bias = 1.5;
const float ism_plane_range = 2.0;

// How much of a VPL's light arrives at `position` on a surface of unit `normal`, 0 .. 1.
float ism_visibility(ism_map m, vec3 position, vec3 normal)
{
    hemisphere_view h = hemisphere_look(position - m.eye, normal, m.tangent, m.bitangent, m.normal,
                                        m.size);
    vec4 nearest = textureGather(ism_maps, vec3((h.low + 1.0) * m.texel, m.layer));
    float angle = hemisphere_texel_angle(h, m.size);
    return hemisphere_lit(h, nearest, max(ism_bias * angle, m.disc / h.r), ism_plane_range);
}

float ism_visibility(int map, vec3 position, vec3 normal)
{
    return ism_visibility(ism_open(map), position, normal);
}
