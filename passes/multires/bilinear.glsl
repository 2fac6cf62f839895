// SPDX-License-Identifier: MIT
// `f` of the way from `mine` to the others. Equal ones give exactly what they are.
vec4 bilinear(vec4 mine, vec4 x, vec4 y, vec4 corner, vec2 f)
{
    return mine + (x - mine) * f.x + (y - mine) * f.y + (corner - x - y + mine) * (f.x * f.y);
}
