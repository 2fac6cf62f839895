// SPDX-License-Identifier: MIT
// How a map of reciprocal distances over a hemisphere is looked up (passes/shading/paraboloid.glsl has
// its texels): filtered over 2x2 of them, each against the receiver's plane. Everything is in scene
// units.
#include "passes/shading/paraboloid.glsl"

// A receiver as a map's eye sees it.
struct hemisphere_view {
    vec3 p, n;      // place and unit normal in the frame of the eye; p.z >= 0
    float r;        // distance
    vec2 low, part; // of the 2x2 texels the lowest; how far in between
    vec4 u, v;      // their middles in [-1, 1], as textureGather has them: (0, 1), (1, 1), (1, 0), (0, 0)
};

// `d` is from the eye to the receiver. Receivers below the horizon, which the eye does not light, get
// that of the horizon above them.
hemisphere_view hemisphere_look(vec3 d, vec3 n, vec3 tangent, vec3 bitangent, vec3 normal, float size)
{
    hemisphere_view h;
    float texel = 1.0 / size;
    h.p = vec3(dot(d, tangent), dot(d, bitangent), max(dot(d, normal), 0.0));
    h.n = vec3(dot(n, tangent), dot(n, bitangent), dot(n, normal));
    h.r = max(length(h.p), 1e-12);
    vec2 at = clamp(paraboloid_texel(h.p, h.r, size) - 0.5, vec2(0.0), vec2(size - 1.0));
    h.low = min(floor(at), vec2(size - 2.0));
    h.part = at - h.low;
    h.u = vec4(h.low.x, h.low.x + 1.0, h.low.x + 1.0, h.low.x) * (2.0 * texel) + (texel - 1.0);
    h.v = vec4(h.low.y + 1.0, h.low.y + 1.0, h.low.y, h.low.y) * (2.0 * texel) + (texel - 1.0);
    return h;
}

// The angle of a texel there.
float hemisphere_texel_angle(hemisphere_view h, float size)
{
    return 2.0 * (1.0 / size) * (1.0 + h.p.z / h.r);
}

// How much of the eye's light arrives, 0 .. 1. `nearest`: what the map has at the four texels. One
// hides the receiver where something is nearer than the receiver itself and than its plane along the
// texel's ray, so that no plane hides itself, by more than `slack` of the distance. The receiver's plane
// goes through the eye where it is seen from its edge; it counts within the ratio `range`.
float hemisphere_lit(hemisphere_view h, vec4 nearest, float slack, float range)
{
    vec4 s = h.u * h.u + h.v * h.v; // paraboloid_ray() of the four, without the length 1 + s
    vec4 plane = (2.0 * (h.n.x * h.u + h.n.y * h.v) + h.n.z * (1.0 - s)) / (1.0 + s);
    float height = -dot(h.n, h.p); // the receiver sees the eye: not below 0
    plane = clamp(plane * (-1.0 / max(height, 1e-6 * h.r)), 1.0 / h.r, range / h.r);
    vec4 lit = vec4(lessThanEqual(nearest, plane * (1.0 + slack)));
    vec2 row = mix(lit.wx, lit.zy, h.part.x);
    return mix(row.x, row.y, h.part.y);
}
