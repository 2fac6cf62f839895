// SPDX-License-Identifier: MIT
// Visibility of VPLs by paraboloid shadow maps (pass/paraboloid.h). ag_paraboloid_bind() binds what is
// read here: texture 4 and storage 4. Everything is in scene units: render space times view.scale.x.
#include "passes/include/pass/paraboloid_shared.h"
#include "passes/include/pass/view_shared.h"
#include "passes/shading/hemisphere.glsl"

layout(binding = 4) uniform sampler2DArray paraboloid_maps;
layout(std430, binding = 4) readonly buffer paraboloid_eye_buffer
{
    ivec4 paraboloid_layout; // x: texels along a map's edge
    ag_paraboloid_eye_block paraboloid_eyes[];
};

// A map made ready for several receivers.
struct paraboloid_map {
    vec3 eye, tangent, bitangent, normal;
    vec3 place; // of the map: first column and row, layer
    float size, texel, unit; // texels along its edge; 1 / texels of a layer's; of what it holds
};

// The map of VPL j.
paraboloid_map paraboloid_open(int j)
{
    ag_paraboloid_eye_block e = paraboloid_eyes[j];
    return paraboloid_map(e.position.xyz * view.scale.x, e.tangent.xyz, e.bitangent.xyz, e.normal.xyz,
                          vec3(e.tangent.w, e.bitangent.w, e.normal.w), float(paraboloid_layout.x),
                          1.0 / float(textureSize(paraboloid_maps, 0).x), e.position.w * view.scale.y);
}

// A texel hides the receiver by more than so many texels' angle: surfaces are exact, but normals are
// smoothed, and beside an edge texels see the other wall. Against rays none is better: with less, edges
// lose light, with more, what stands on a surface does not shadow it at its foot. Half floats may be
// cut, by 2^-10, and places are known to less.
const float paraboloid_bias = 0.5;
const float paraboloid_rounding = 0.002;
// 1.41 of the widest texels of 256 across are an angle of 0.022: planes do not hide themselves down to
// a seventh of that, 0.2 degrees.
const float paraboloid_plane_range = 8.0;

// How much of a VPL's light arrives at `position` on a surface of unit `normal`, 0 .. 1, filtered over
// 2x2 texels.
float paraboloid_visibility(paraboloid_map m, vec3 position, vec3 normal)
{
    hemisphere_view h = hemisphere_look(position - m.eye, normal, m.tangent, m.bitangent, m.normal,
                                        m.size);
    vec4 nearest =
        m.unit * textureGather(paraboloid_maps, vec3((m.place.xy + h.low + 1.0) * m.texel, m.place.z));
    vec4 inside = min(paraboloid_horizon * inversesqrt(max(h.u * h.u + h.v * h.v, 0.25)), 1.0);
    h.u *= inside;
    h.v *= inside;
    float angle = hemisphere_texel_angle(h, m.size);
    return hemisphere_lit(h, nearest, max(paraboloid_bias * angle, paraboloid_rounding), paraboloid_plane_range);
}
