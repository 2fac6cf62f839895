// SPDX-License-Identifier: MIT
#include <pass/math.h>
#include <pass/vpl.h>
#include <pass/vpl_shared.h>

#include <math.h>
#include <string.h>

// To the nearest half float, ties to even; for |value| below 65520.
static uint32_t to_half(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    const uint32_t sign = bits >> 16 & 0x8000, size = bits & 0x7fffffff;
    if (size < 0x38800000) // below 2^-14, where half floats are multiples of 2^-24
        return sign | (uint32_t) lrintf(fabsf(value) * 0x1p24f);
    return sign | (size - (112u << 23) + 0xfff + (size >> 13 & 1)) >> 13;
}

// pack_edge() of patch.glsl.
static float pack_edge(const float edge[3], const double t[3], const double b[3], double scale)
{
    double e[2] = { 0, 0 };
    for (int k = 0; k < 3; k++) {
        e[0] += (double) edge[k] * t[k];
        e[1] += (double) edge[k] * b[k];
    }
    uint32_t bits = 0;
    for (int i = 0; i < 2; i++)
        bits |= to_half((float) fmin(fmax(e[i] * scale, -1e3), 1e3)) << 16 * i;
    float packed;
    memcpy(&packed, &bits, sizeof packed);
    return packed;
}

void ag_vpl_from_host(const ag_vpl_patch *patch, struct ag_vpl *out)
{
    const double n[3] = { (double) patch->normal[0], (double) patch->normal[1],
                          (double) patch->normal[2] };
    double t[3], b[3];
    ag_frame_about(n, t, b);
    const double scale = patch->area > 0 ? 1 / sqrt((double) patch->area) : 0;
    memcpy(out->position_area, patch->position, sizeof patch->position);
    memcpy(out->normal, patch->normal, sizeof patch->normal);
    memcpy(out->flux, patch->flux, sizeof patch->flux);
    out->position_area[3] = fmaxf(patch->area, 0);
    out->normal[3] = pack_edge(patch->edges[0], t, b, scale);
    out->flux[3] = pack_edge(patch->edges[1], t, b, scale);
}
