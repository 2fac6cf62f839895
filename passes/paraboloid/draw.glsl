// SPDX-License-Identifier: MIT
// Triangles as the eye of a paraboloid map sees them.
//
// A direction is inside of a triangle where it is on the inner side of the three planes through the eye
// and the edges. Two triangles that share an edge get planes of opposite signs, equal to the bit, so
// that no ray goes between them: hence `precise`, and sums and differences of corners in their
// products.
// Source: of the products: Davidovic et al. 3D Rasterization: A Bridge between Rasterization and Ray
//         Casting. GI 2012.
//
// Buffers are read as textures: where a CPU renders, that costs a quarter of a storage block's loads.
#include "passes/include/pass/paraboloid_shared.h"
#include "passes/paraboloid/draw_shared.h"

layout(binding = 0) uniform samplerBuffer triangle_texels; // shadow_triangle[]
layout(binding = 1) uniform samplerBuffer eye_texels;      // shadow_eye[]

// An eye that is nearer to a triangle's plane than this does not know by its numbers on which side it
// is: places are known to some 2^-24. The triangle is taken to be so far behind its front, and larger
// by twice that all around: in a corner, of two walls that both recede, nothing is seen in between.
const float near_plane = 1.0 / 1048576.0;
// Lookups reach so many texels beyond the horizon.
const float reach = 1.5;
// Half floats end at 65504.
const float most = 65504.0;

shadow_triangle fetch_triangle(int i)
{
    return shadow_triangle(texelFetch(triangle_texels, 3 * i), texelFetch(triangle_texels, 3 * i + 1),
                           texelFetch(triangle_texels, 3 * i + 2));
}

shadow_eye fetch_eye(int i)
{
    return shadow_eye(texelFetch(eye_texels, 3 * i), texelFetch(eye_texels, 3 * i + 1),
                      texelFetch(eye_texels, 3 * i + 2));
}

// Corners in the frame of the eye, and the sense in which they go round.
struct seen {
    vec3 a, b, c;
    float turn;  // 1: counter-clockwise from the eye; -1
    vec3 margin; // what it is larger by; 0 where the eye is far from its plane
};

vec3 turned(vec3 p, shadow_eye e, vec3 bitangent)
{
    precise vec3 q = vec3(dot(p, e.tangent.xyz), dot(p, bitangent), dot(p, e.normal.xyz));
    return q;
}

seen see(shadow_triangle t, shadow_eye e)
{
    precise vec3 a = t.a.xyz - e.position.xyz, b = t.b.xyz - e.position.xyz,
                 c = t.c.xyz - e.position.xyz;
    vec3 n = cross(t.b.xyz - t.a.xyz, t.c.xyz - t.a.xyz);
    // The eye goes to the side that its surface shows, or, where the triangle is across that, to the
    // triangle's front.
    float n2 = max(dot(n, n), 1e-37), height = -dot(n, a), along = dot(n, e.normal.xyz);
    float side = along * along > 0.25 * n2 ? sign(along) : 1.0;
    bool is_near = height * height < near_plane * near_plane * n2;
    float wanted = is_near ? side * near_plane * sqrt(n2) : height;
    precise vec3 shift = is_near ? n * ((height - wanted) / n2) : vec3(0.0);
    vec3 bitangent = cross(e.normal.xyz, e.tangent.xyz);
    vec3 margin = is_near ? n * (4.0 * near_plane * inversesqrt(n2)) : vec3(0.0);
    return seen(turned(a + shift, e, bitangent), turned(b + shift, e, bitangent),
                turned(c + shift, e, bitangent), wanted < 0.0 ? 1.0 : -1.0,
                turned(margin, e, bitangent));
}

// Normals of the planes through the eye and the edges opposite of a, b, c; inside is above 0.
struct edges {
    vec3 a, b, c;
};

vec3 edge(vec3 p, vec3 q, vec3 margin)
{
    precise vec3 sum = p + q, difference = q - p;
    precise vec3 n = vec3(sum.y * difference.z - sum.z * difference.y,
                          sum.z * difference.x - sum.x * difference.z,
                          sum.x * difference.y - sum.y * difference.x);
    // To the edge's distance at the point met, d: n.ray = 2 |q - p| d h / t, h / t = |normal.ray|.
    n += margin * length(difference);
    return n;
}

edges edges_of(seen s)
{
    return edges(s.turn * edge(s.b, s.c, s.margin), s.turn * edge(s.c, s.a, s.margin),
                 s.turn * edge(s.a, s.b, s.margin));
}

// The ray of a texel, of length 1 + s, w. That is 0 where no lookup comes.
vec4 ray_of(ivec2 texel, float size)
{
    vec2 u = (vec2(texel) + 0.5) * (2.0 / size) - 1.0;
    float s = dot(u, u), rim = 1.0 + reach * 2.0 / size;
    u *= min(paraboloid_horizon * inversesqrt(max(s, 0.25)), 1.0);
    float t = dot(u, u);
    return vec4(2.0 * u, 1.0 - t, s > rim * rim ? 0.0 : 1.0 + t);
}

// Barycentrics of where a ray meets the triangle, not yet normalized; none below 0 where it does.
vec3 weights_of(edges n, vec4 ray)
{
    precise vec3 w = vec3(dot(n.a, ray.xyz), dot(n.b, ray.xyz), dot(n.c, ray.xyz));
    return w;
}

// Reciprocal distance of the triangle along a ray, 0 where it is not met. The point met is a mean of
// the corners, so that a triangle however thin has it within its bounds.
float meet(seen s, vec4 ray, vec3 w)
{
    float sum = w.x + w.y + w.z;
    float far = w.x * dot(s.a, ray.xyz) + w.y * dot(s.b, ray.xyz) + w.z * dot(s.c, ray.xyz);
    bool met = ray.w > 0.0 && min(min(w.x, w.y), w.z) >= 0.0 && sum > 0.0 && far > 0.0;
    return met ? min(ray.w * sum / max(far, 1e-37), most) : 0.0;
}
