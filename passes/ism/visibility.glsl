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

// A texel hides the receiver where something is nearer than the receiver's plane along the texel's
// ray, so that no plane hides itself, by more than this part of a texel's angle: curved surfaces
// lie nearer than their planes, and discs stand out over them.
const float ism_bias = 1.0;
// That plane goes through the eye where it is seen from its edge; it counts within this ratio.
const float ism_plane_range = 2.0;

// How much of a VPL's light arrives at `position` on a surface of unit `normal`, 0 .. 1, filtered
// over 2x2 texels. Receivers below the VPL's horizon, which it does not light, get that of the
// horizon above them.
float ism_visibility(int map, vec3 position, vec3 normal)
{
    int size = textureSize(ism_maps, 0).x;
    vec3 t = ism_eyes[map].tangent.xyz, b = ism_eyes[map].bitangent.xyz,
         m = ism_eyes[map].normal.xyz, d = position - ism_eyes[map].position.xyz;
    vec3 p = vec3(dot(d, t), dot(d, b), max(dot(d, m), 0.0));
    vec3 n = vec3(dot(normal, t), dot(normal, b), dot(normal, m));
    float r = max(length(p), 1e-12);
    vec2 at = clamp(paraboloid_texel(p, r, size) - 0.5, vec2(0.0), vec2(size) - 1.0);
    vec2 low = min(floor(at), vec2(size) - 2.0), part = at - low;
    // Gathered: (0, 1), (1, 1), (1, 0), (0, 0).
    vec4 nearest = textureGather(ism_maps, vec3((low + 1.0) / float(size), map));
    vec4 plane = vec4(dot(n, paraboloid_ray(low + vec2(0.0, 1.0), size)),
                      dot(n, paraboloid_ray(low + vec2(1.0, 1.0), size)),
                      dot(n, paraboloid_ray(low + vec2(1.0, 0.0), size)),
                      dot(n, paraboloid_ray(low, size)));
    float height = -dot(n, p); // the receiver sees the eye: not below 0
    plane = clamp(-plane / max(height, 1e-6 * r), 1.0 / r, ism_plane_range / r);
    vec4 lit = vec4(lessThanEqual(nearest, plane * (1.0 + ism_bias * 4.0 / float(size))));
    vec2 row = mix(lit.wx, lit.zy, part.x);
    return mix(row.x, row.y, part.y);
}
