// SPDX-License-Identifier: MIT
#include <pass/pyramid.h>

ag_pyramid ag_pyramid_of(int width, int height, int levels)
{
    const int unit = 1 << (levels - 1);
    ag_pyramid p = { .levels = levels };
    p.base[0] = (width + unit - 1) / unit * unit;
    p.base[1] = (height + unit - 1) / unit * unit;
    p.size[0] = levels > 1 ? p.base[0] + p.base[0] / 2 : p.base[0];
    p.size[1] = p.base[1];
    return p;
}

void ag_pyramid_origin(const ag_pyramid *p, int k, int out[2])
{
    out[0] = k == 0 ? 0 : p->base[0];
    out[1] = k == 0 ? 0 : p->base[1] - (p->base[1] >> (k - 1));
}
