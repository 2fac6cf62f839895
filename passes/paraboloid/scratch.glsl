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

void put(int triangle, int map, ivec2 texel, float w, vec3 weights)
{
#ifdef MASK
    w = w > 0.0 && mask_is_there(triangle, weights) ? w : 0.0;
#endif
    int at = (map * frame.x + texel.y) * frame.x + texel.x;
    uint bits = floatBitsToUint(w);
    // Most of what is drawn is behind what is there: looking first saves the costly atomic.
    if (bits > scratch[at])
        atomicMax(scratch[at], bits);
}

// Draws a triangle by one invocation. Texels beside it are passed over in a loop of their own, so that
// where a CPU runs neighbours in step, all of them have something to put.
void draw_box(int triangle, int map, seen s, ivec2 low, ivec2 extent)
{
    edges n = edges_of(s);
    ivec2 at = ivec2(0);
    while (at.y < extent.y) {
        vec4 ray = ray_of(low + at, float(frame.x));
        vec3 w = weights_of(n, ray);
        while (min(min(w.x, w.y), w.z) < 0.0 && at.y < extent.y) {
            at = at.x + 1 < extent.x ? at + ivec2(1, 0) : ivec2(0, at.y + 1);
            ray = ray_of(low + at, float(frame.x));
            w = weights_of(n, ray);
        }
        if (at.y < extent.y)
            put(triangle, map, low + at, meet(s, ray, w), w);
        at = at.x + 1 < extent.x ? at + ivec2(1, 0) : ivec2(0, at.y + 1);
    }
}
