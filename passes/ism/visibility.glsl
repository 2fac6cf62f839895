// SPDX-License-Identifier: MIT
// Visibility of VPLs by imperfect shadow maps (pass/ism.h). ag_ism_bind() binds what is read here.
// Everything is in scene units: render space times view.scale.x.
#include "passes/include/pass/ism_shared.h"
#include "passes/ism/paraboloid.glsl"

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

// A texel hides the receiver where something is nearer than the receiver itself and than its plane
// along the texel's ray, so that no plane hides itself, by more than so many texels' angle and more
// than a disc's radius. The farthest of the 2x2 texels is 1.41 away: a wall that meets the receiver's
// at an edge, and turns to the eye by up to 45 degrees, does not hide it there. A disc stands out
// past an edge, and over a curved surface, by its radius at most.
const float ism_bias = 1.5;
// That plane goes through the eye where it is seen from its edge; it counts within this ratio.
const float ism_plane_range = 2.0;

// How much of a VPL's light arrives at `position` on a surface of unit `normal`, 0 .. 1, filtered
// over 2x2 texels. Receivers below the VPL's horizon, which it does not light, get that of the
// horizon above them.
float ism_visibility(ism_map m, vec3 position, vec3 normal)
{
    vec3 d = position - m.eye;
    vec3 p = vec3(dot(d, m.tangent), dot(d, m.bitangent), max(dot(d, m.normal), 0.0));
    vec3 n = vec3(dot(normal, m.tangent), dot(normal, m.bitangent), dot(normal, m.normal));
    float r = max(length(p), 1e-12);
    vec2 at = clamp(paraboloid_texel(p, r, m.size) - 0.5, vec2(0.0), vec2(m.size - 1.0));
    vec2 low = min(floor(at), vec2(m.size - 2.0)), part = at - low;
    // Gathered: (0, 1), (1, 1), (1, 0), (0, 0).
    vec4 nearest = textureGather(ism_maps, vec3((low + 1.0) * m.texel, m.layer));
    vec4 u = vec4(low.x, low.x + 1.0, low.x + 1.0, low.x) * (2.0 * m.texel) + (m.texel - 1.0);
    vec4 v = vec4(low.y + 1.0, low.y + 1.0, low.y, low.y) * (2.0 * m.texel) + (m.texel - 1.0);
    vec4 s = u * u + v * v; // paraboloid_ray() of the four, without the length 1 + s
    vec4 plane = (2.0 * (n.x * u + n.y * v) + n.z * (1.0 - s)) / (1.0 + s);
    float height = -dot(n, p); // the receiver sees the eye: not below 0
    plane = clamp(plane * (-1.0 / max(height, 1e-6 * r)), 1.0 / r, ism_plane_range / r);
    float angle = 2.0 * m.texel * (1.0 + p.z / r); // of a texel there
    vec4 lit = vec4(lessThanEqual(nearest, plane * (1.0 + max(ism_bias * angle, m.disc / r))));
    vec2 row = mix(lit.wx, lit.zy, part.x);
    return mix(row.x, row.y, part.y);
}

float ism_visibility(int map, vec3 position, vec3 normal)
{
    return ism_visibility(ism_open(map), position, normal);
}
