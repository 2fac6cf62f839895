#version 450 core
// SPDX-License-Identifier: MIT
// The sampling points of a light and their Voronoi cells, to look at. Equal areas of the picture are
// equal areas of the domain: the disc as it is; the sphere by Lambert's azimuthal projection, the
// point below the light in the middle and the one above it along the rim.
// In:  iir_dot[]
// Out: display values RGBA16F
#include "plugins/iir/domain_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = 0) readonly buffer dot_buffer
{
    iir_dot dots[];
};
layout(location = 0) uniform int count;
layout(location = 1) uniform int on_sphere;
layout(binding = 0, rgba16f) writeonly uniform image2D picture;

const float margin = 1.04; // from the domain's rim to the picture's

// Where a pixel at `at` lies in the domain; |at| <= 1.
vec3 place_of(vec2 at)
{
    if (on_sphere == 0)
        return vec3(at, 0.0);
    float s = min(dot(at, at), 1.0); // (1 - cosine of the angle from below) / 2
    float across = 2.0 * sqrt(max(1.0 - s, 0.0));
    return vec3(at.x * across, 2.0 * s - 1.0, at.y * across);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(picture);
    if (any(greaterThanEqual(pixel, size)))
        return;
    float step = 2.0 * margin / float(size.x);
    vec2 at = (vec2(pixel) + 0.5) * step - margin;
    vec3 p = place_of(at), colour = vec3(0.0);
    float nearest = 1e9, second = 1e9;
    bool fresh = false;
    for (int i = 0; i < count; i++) {
        float d = distance(p, dots[i].place.xyz);
        second = min(second, max(d, nearest));
        if (d < nearest) {
            nearest = d;
            colour = dots[i].colour.rgb;
            fresh = dots[i].place.w > 0.5;
        }
    }
    colour *= second - nearest < 1.5 * step ? 0.4 : 1.0;
    if (nearest < 3.0 * step)
        colour = fresh ? vec3(1.0, 0.1, 0.05) : vec3(1.0);
    if (dot(at, at) > 1.0)
        colour = vec3(0.05);
    imageStore(picture, pixel, vec4(colour, 1.0));
}
