// SPDX-License-Identifier: MIT
// Unit vectors in two numbers of [0, 1]: the octahedron unfolded on a square.
vec2 octahedral_encode(vec3 n)
{
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0)
        p = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return p * 0.5 + 0.5;
}

vec3 octahedral_decode(vec2 e)
{
    vec2 p = e * 2.0 - 1.0;
    float z = 1.0 - abs(p.x) - abs(p.y);
    if (z < 0.0)
        p = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return normalize(vec3(p, z));
}
