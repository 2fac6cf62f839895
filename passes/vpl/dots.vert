#version 450 core
// SPDX-License-Identifier: MIT
// A square about each VPL that is seen, an instance each, four vertices.
// In:  ag_vpl[], count; depth DEPTH32F
// Out: offset from the middle, pixels; radius; colour
#include "passes/include/pass/view_shared.h"
#include "passes/include/pass/vpl_shared.h"

layout(std430, binding = 0) readonly buffer vpl_buffer
{
    ag_vpl vpls[];
};
layout(std430, binding = 1) readonly buffer count_buffer
{
    uvec4 count;
};
layout(binding = 0) uniform sampler2D depth_map;
layout(location = 0) uniform float power; // of all lights, W

layout(location = 0) out vec2 offset;
layout(location = 1) flat out float radius;
layout(location = 2) flat out vec3 colour;

// A patch of a bent surface has its mean a little below it.
bool is_hidden(vec2 pixel, float depth)
{
    if (any(lessThan(pixel, vec2(0.0))) || any(greaterThanEqual(pixel, vec2(view.size.xy))))
        return false; // its rim may still be seen
    float seen = texelFetch(depth_map, ivec2(pixel), 0).x;
    return view.forward.w > 0.5 ? depth < seen - 0.01 : depth < 0.98 * seen;
}

void main()
{
    offset = vec2(0.0);
    radius = 0.0;
    colour = vec3(0.0);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // not in view
    if (uint(gl_InstanceID) >= count.x)
        return;
    ag_vpl v = vpls[gl_InstanceID];
    vec4 clip = view.view_proj * vec4(v.position_area.xyz, 1.0);
    if (!(clip.w > 0.0))
        return;
    vec2 size = vec2(view.size.xy), pixel = (clip.xy / clip.w * 0.5 + 0.5) * size;
    if (is_hidden(pixel, clip.z / clip.w))
        return;
    float share = (v.flux.r + v.flux.g + v.flux.b) / (3.0 * max(power, 1e-37));
    radius = clamp(0.1 * size.y * sqrt(share), 1.0, 0.1 * size.y);
    offset = (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0) * (radius + 1.0);
    colour = v.flux.rgb / max(max(v.flux.r, v.flux.g), max(v.flux.b, 1e-37));
    gl_Position = vec4((pixel + offset) / size * 2.0 - 1.0, 0.5, 1.0);
}
