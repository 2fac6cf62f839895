// SPDX-License-Identifier: MIT
// Maps while they are drawn: bits of reciprocal distances, which order as the numbers do.
layout(std430, binding = 2) buffer scratch_buffer
{
    uint scratch[];
};
layout(location = 0) uniform ivec2 frame; // x: texels along a map's edge; y: the first map's eye

#ifdef MASK
#include "passes/paraboloid/mask.glsl"
#endif

void draw_texel(int triangle, int map, seen s, edges n, ivec2 texel)
{
    vec4 ray = ray_of(texel, float(frame.x));
    vec3 weights;
    float w = ray.w > 0.0 ? meet(s, n, ray, weights) : 0.0;
#ifdef MASK
    w = w > 0.0 && mask_is_there(triangle, weights) ? w : 0.0;
#endif
    int at = (map * frame.x + texel.y) * frame.x + texel.x;
    uint bits = floatBitsToUint(w);
    // Most of what is drawn is behind what is there: looking first saves the costly atomic.
    if (bits > scratch[at])
        atomicMax(scratch[at], bits);
}
