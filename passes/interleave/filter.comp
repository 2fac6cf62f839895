#version 450 core
// SPDX-License-Identifier: MIT
// Mean over those of the n x n pixels about each that belong to its surface.
// In:  position RGBA32F, normal RGBA16F; light RGBA32F
// Out: light RGBA32F; a 1; all 0 where nothing is
// DISTANCE: the paper's metric of position; else the distance from the pixel's plane.
// Source: Laine, Saransaari, Kontkanen, Lehtinen, Aila 2007, fig. 5.
//         Departs from it: a tile whose pixel in the window does not count is looked for n pixels on,
//         and at the image's border the window is shifted inwards, so that the pattern goes up to
//         edges; what is not finite does not count; DISTANCE aside, the metric.
#include "passes/include/pass/view_shared.h"

// Four pixels of an invocation share what they fetch.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D light_map;
layout(binding = 0, rgba32f) writeonly uniform image2D result;
layout(location = 0) uniform ivec4 frame;  // xy: pixels, n at least; z: n
layout(location = 1) uniform vec2 limit;   // alpha, beta

// How far a half float's normal can be from unit length's: each component by 2^-12.
const float normal_error = 1.7321 / 4096.0;
const float down = 1.0 / 256.0; // so that n^2 values of any size have a sum

struct pixel {
    ivec2 first; // of its window
    bool there;
    vec3 p, n;
    float reach;
    vec4 sum; // w: how many
};

pixel pixel_at(ivec2 at)
{
    at = min(at, frame.xy - 1);
    vec4 q = texelFetch(position_map, at, 0);
    vec3 p = q.xyz, n = texelFetch(normal_map, at, 0).xyz;
#ifdef DISTANCE
    float reach = limit.x;
#else
    float reach = limit.x * (view.forward.w > 0.5 ? view.scale.y : length(p));
#endif
    // With an even n the window is half a pixel off; sec. 5.2.
    ivec2 first = clamp(at - frame.z / 2, ivec2(0), frame.xy - frame.z);
    return pixel(first, q.w > 0.5, p, n / max(length(n), 1e-6), reach, vec4(0.0));
}

bool of_one_surface(pixel a, vec4 q, vec3 m)
{
    vec3 d = q.xyz - a.p;
#ifdef DISTANCE
    bool near = length(d) < a.reach;
#else
    bool near = abs(dot(d, a.n)) < a.reach + normal_error * length(d);
#endif
    return near && q.w > 0.5 && dot(m, a.n) > limit.y * length(m);
}

// w 0: does not count.
vec4 light_at(ivec2 at)
{
    vec3 e = texelFetch(light_map, at, 0).rgb;
    return any(isnan(e)) || any(isinf(e)) ? vec4(0.0) : vec4(e * down, 1.0);
}

void add(inout pixel a, ivec2 me, ivec2 at, vec4 q, vec3 m, vec4 light)
{
    bool in_window = all(greaterThanEqual(at, a.first)) && all(lessThan(at, a.first + frame.z));
    if (in_window && (at == me || of_one_surface(a, q, m)))
        a.sum += light;
}

// The same of a pixel that need not be one of the image.
vec4 light_of(pixel a, ivec2 me, ivec2 at)
{
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, frame.xy)))
        return vec4(0.0);
    vec4 q = texelFetch(position_map, at, 0);
    vec3 m = texelFetch(normal_map, at, 0).xyz;
    return at == me || of_one_surface(a, q, m) ? light_at(at) : vec4(0.0);
}

void store(pixel a, ivec2 at)
{
    vec3 mean = min(a.sum.rgb / (max(a.sum.w, 1.0) * down), vec3(3.0e38));
    if (all(lessThan(at, frame.xy)))
        imageStore(result, at, a.there ? vec4(mean, 1.0) : vec4(0.0));
}

// Whether some of the pixel's tiles do not count.
bool lacks_tiles(pixel a, ivec2 at)
{
    return a.there && a.sum.w < float(frame.z * frame.z) && all(lessThan(at, frame.xy));
}

// Where else the tile of a pixel of the window is met, i 1 to 5: n pixels on, to the other side of
// the pixel in the middle, along x, y or both; then to this side.
ivec2 elsewhere(ivec2 at, ivec2 me, int i)
{
    ivec2 across = frame.z * (1 - 2 * ivec2(greaterThan(at, me)));
    if (i > 3)
        across = -across;
    return at + across * ivec2(i != 2 && i != 5, i != 1 && i != 4);
}

// Does those of an invocation's pixels again that lack tiles, bits of `todo`, and looks for their tiles
// elsewhere. Few pixels need it: a loop on its own takes no time where none of the neighbours does,
// and a round of it is one pixel looked at.
void complete(uint todo, ivec2 corner)
{
    ivec2 me, at;
    pixel a;
    int i = -1; // which of the places of a tile is next; below 0: a pixel begins
    while (todo != 0u) {
        if (i < 0) {
            int which = findLSB(todo);
            me = corner + ivec2(which & 1, which >> 1);
            a = pixel_at(me);
            at = a.first;
            i = 0;
        }
        vec4 light = light_of(a, me, i == 0 ? at : elsewhere(at, me, i));
        a.sum += light;
        i = light.w > 0.0 ? 6 : i + 1;
        if (i == 6) {
            at = at.x + 1 < a.first.x + frame.z ? at + ivec2(1, 0) : ivec2(a.first.x, at.y + 1);
            i = 0;
        }
        if (at.y == a.first.y + frame.z) {
            store(a, me);
            todo &= todo - 1u;
            i = -1;
        }
    }
}

void main()
{
    ivec2 me = ivec2(gl_GlobalInvocationID.xy) * 2;
    ivec2 right = me + ivec2(1, 0), above = me + ivec2(0, 1), last = me + 1;
    if (any(greaterThanEqual(me, frame.xy)))
        return;
    pixel a = pixel_at(me), b = pixel_at(right), c = pixel_at(above), d = pixel_at(last);
    ivec2 end = d.first + frame.z;
    for (int y = a.first.y; y < end.y; y++)
        for (int x = a.first.x; x < end.x; x++) {
            ivec2 at = ivec2(x, y);
            vec4 q = texelFetch(position_map, at, 0);
            vec3 m = texelFetch(normal_map, at, 0).xyz;
            vec4 light = light_at(at);
            add(a, me, at, q, m, light);
            add(b, right, at, q, m, light);
            add(c, above, at, q, m, light);
            add(d, last, at, q, m, light);
        }
    store(a, me);
    store(b, right);
    store(c, above);
    store(d, last);
    bvec4 lacking =
        bvec4(lacks_tiles(a, me), lacks_tiles(b, right), lacks_tiles(c, above), lacks_tiles(d, last));
    uvec4 bits = uvec4(lacking) << uvec4(0, 1, 2, 3);
    complete(bits.x | bits.y | bits.z | bits.w, me);
}
