// SPDX-License-Identifier: MIT
// A hemisphere on a square: the direction d about +z at (d.x, d.y) / (1 + d.z) in [-1, 1].
// Source: Heidrich, Seidel. View-independent Environment Maps. Graphics Hardware 1998. Its
//         paraboloid reflects a parallel beam into all directions of a hemisphere.

// Texels of a map of `size`, not whole: where `p` at distance `r` falls; p.z >= 0, r > 0.
vec2 paraboloid_texel(vec3 p, float r, float size)
{
    return (0.5 + 0.5 * p.xy / (r + p.z)) * size;
}

// The unit direction at the middle of a texel; beyond the horizon in the map's corners.
vec3 paraboloid_ray(vec2 texel, float size)
{
    vec2 a = (texel + 0.5) * (2.0 / size) - 1.0;
    float s = dot(a, a);
    return vec3(2.0 * a, 1.0 - s) / (1.0 + s);
}
