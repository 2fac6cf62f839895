#version 450 core
// SPDX-License-Identifier: MIT
// One bounce of what the screen shows: the mean, over directions with the density of the cosine, of the
// radiance of the surface that a direction meets; that is E / pi.
// In:  position RGBA32F, normal RGBA16F, face RG16; direct light RGBA32F, W/(m^2 sr)
// Out: E / pi RGBA32F, W/(m^2 sr); a 1; 0 where nothing is
//      OPEN: RGBA16F, the share of directions that met nothing
// Source: Ritschel, Grosch, Seidel 2009, sec. 3; rays are marched, not the samples' own depth compared.
#include "passes/include/pass/view_shared.h"
#include "passes/shading/octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D face_map;
layout(binding = 3) uniform sampler2D direct_map;
#ifdef OPEN
layout(binding = 0, rgba16f) writeonly uniform image2D result;
#else
layout(binding = 0, rgba32f) writeonly uniform image2D result;
#endif
layout(location = 0) uniform int rays;
layout(location = 1) uniform float reach; // m

const int steps = 16, halvings = 8;
const float golden_angle = 2.39996323;
const float thickness = 0.05; // of a surface, over the way to it

// Direction i on a spiral with the cosine's density.
vec3 direction(int i, vec3 n)
{
    float radius2 = (float(i) + 0.5) / float(rays), angle = float(i) * golden_angle;
    vec3 side = abs(n.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    vec3 t = normalize(cross(side, n)), b = cross(n, t);
    vec2 disc = sqrt(radius2) * vec2(cos(angle), sin(angle));
    return t * disc.x + b * disc.y + n * sqrt(1.0 - radius2);
}

// How far q is behind the surface that the screen shows there, from its plane, m; `at` is the pixel, x -1 where
// q falls beside the screen. Where nothing is q is in front.
float behind(vec3 q, out ivec2 at)
{
    vec4 clip = view.view_proj * vec4(q, 1.0);
    at = ivec2(-1);
    if (clip.w <= 0.0 || any(greaterThan(abs(clip.xy), vec2(clip.w))))
        return 0.0;
    at = min(ivec2((clip.xy / clip.w * 0.5 + 0.5) * vec2(view.size.xy)), view.size.xy - 1);
    vec4 s = texelFetch(position_map, at, 0);
    vec3 m = octahedral_decode(texelFetch(face_map, at, 0).xy);
    return s.w > 0.5 ? dot(s.xyz - q, m) : -1.0;
}

// The pixel that shows what the ray from p along d meets within reach; x -1: none.
ivec2 meet(vec3 p, vec3 d)
{
    ivec2 at = ivec2(-1), there;
    float near = 0.0, far = 0.0, depth = 0.0;
    for (int k = 1; k <= steps && depth <= 0.0; k++) {
        near = far;
        far = reach * float(k * k) / float(steps * steps);
        depth = behind(p + d * far, at);
        if (at.x < 0)
            return at; // it has left the screen
    }
    for (int k = 0; k < halvings && depth > 0.0; k++) { // where it went behind
        float middle = 0.5 * (near + far), d_middle = behind(p + d * middle, there);
        if (d_middle > 0.0) {
            far = middle;
            depth = d_middle;
            at = there;
        } else {
            near = middle;
        }
    }
    // More than thickness: it passes behind something, and how thick that is nobody knows.
    return depth > 0.0 && depth < thickness * far ? at : ivec2(-1);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, view.size.xy)))
        return;
    vec4 p = texelFetch(position_map, at, 0);
    vec3 n = texelFetch(normal_map, at, 0).xyz;
    float len = length(n); // half floats are not quite unit
    if (p.w < 0.5 || len <= 0.0) {
        imageStore(result, at, vec4(0.0));
        return;
    }
    n /= len;
    vec3 sum = vec3(0.0);
    int none = 0;
    for (int i = 0; i < rays; i++) {
        ivec2 met = meet(p.xyz, direction(i, n));
        if (met.x < 0)
            none++;
        else
            sum += min(texelFetch(direct_map, met, 0).rgb, vec3(1.0e30)) / float(rays);
    }
#ifdef OPEN
    imageStore(result, at, vec4(vec3(float(none) / float(rays)), 1.0));
#else
    imageStore(result, at, vec4(sum, 1.0));
#endif
}
