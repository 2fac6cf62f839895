// SPDX-License-Identifier: MIT
// Whether what is seen at q with normal m lies on the surface seen at p with normal n: the normals
// differ by less than limits.y, and p lies by less than limits.x of its distance off q's plane.
// Positions are in render space, the eye at the origin.
bool surface_is_same(vec3 q, vec3 m, vec3 p, vec3 n, vec2 limits)
{
    vec3 d = p - q, bend = m - n;
    float off = abs(dot(d, m));
    return dot(bend, bend) < limits.y * limits.y && off * off < limits.x * limits.x * dot(p, p);
}
