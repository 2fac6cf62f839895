// SPDX-License-Identifier: MIT
// Where the k-th level of a flattened pyramid begins, 0 the finest: as pass/pyramid.h.
ivec2 pyramid_origin(ivec2 base, int k)
{
    return k == 0 ? ivec2(0) : ivec2(base.x, base.y - (base.y >> (k - 1)));
}
