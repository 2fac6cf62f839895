// SPDX-License-Identifier: MIT
// The surface at a fragment: material, textures, mask, normals. For fragment shaders behind
// scene.vert. MASK, TEXTURES, GLOSSY, EMISSIVE are permutations.
#include "passes/include/pass/scene_shared.h"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 uv;
layout(location = 3) in vec4 color;
layout(location = 4) flat in ivec2 info;

layout(std430, binding = 1) readonly buffer material_buffer
{
    ag_gpu_material materials[];
};

#ifdef TEXTURES
#ifndef BINS
#define BINS 16 // AG_MAX_TEXTURE_BINS
#endif
layout(binding = 0) uniform sampler2DArray bins[BINS];

struct footprint {
    vec4 dx, dy; // of uv
};

// Gradients, taken where all of a quad runs; the lookups behind branches need them.
footprint uv_footprint()
{
    return footprint(dFdx(uv), dFdy(uv));
}

// Clamp (1) and mirror (2) within half a texel of the coarser mip that the lookup blends, since the
// sampler itself repeats.
float wrap(float x, int mode, float half_texel)
{
    if (mode == 0)
        return x;
    x = mode == 1 ? x : 1.0 - abs(1.0 - mod(x, 2.0));
    return clamp(x, half_texel, 1.0 - half_texel);
}

#define AG_BIN(n)                                                                                  \
    case n:                                                                                        \
        size = vec2(textureSize(bins[n], 0).xy);                                                   \
        lod = max(log2(max(max(length(dx * size), length(dy * size)), 1e-20)), 0.0);               \
        h = min(0.5 * exp2(ceil(lod)) / size, vec2(0.5));                                          \
        at.x = wrap(st.x, t.place.w & 3, h.x);                                                     \
        at.y = wrap(st.y, t.place.w >> 2, h.y);                                                    \
        return textureGrad(bins[n], vec3(at, t.place.y), dx, dy);

// White where there is no texture.
vec4 lookup(ag_gpu_texture_ref t, footprint f)
{
    vec3 at0 = vec3(t.place.z == 0 ? uv.xy : uv.zw, 1.0);
    vec2 st = vec2(dot(t.row_u.xyz, at0), dot(t.row_v.xyz, at0));
    vec2 gx = t.place.z == 0 ? f.dx.xy : f.dx.zw;
    vec2 gy = t.place.z == 0 ? f.dy.xy : f.dy.zw;
    vec2 dx = vec2(dot(t.row_u.xy, gx), dot(t.row_v.xy, gx));
    vec2 dy = vec2(dot(t.row_u.xy, gy), dot(t.row_v.xy, gy));
    vec2 size, h, at;
    float lod;
    switch (t.place.x) { // a constant index each: neighbours may want different bins
        AG_BIN(0)
#if BINS > 1
        AG_BIN(1)
#endif
#if BINS > 2
        AG_BIN(2)
#endif
#if BINS > 3
        AG_BIN(3)
#endif
#if BINS > 4
        AG_BIN(4)
#endif
#if BINS > 5
        AG_BIN(5)
#endif
#if BINS > 6
        AG_BIN(6)
#endif
#if BINS > 7
        AG_BIN(7)
#endif
#if BINS > 8
        AG_BIN(8)
#endif
#if BINS > 9
        AG_BIN(9)
#endif
#if BINS > 10
        AG_BIN(10)
#endif
#if BINS > 11
        AG_BIN(11)
#endif
#if BINS > 12
        AG_BIN(12)
#endif
#if BINS > 13
        AG_BIN(13)
#endif
#if BINS > 14
        AG_BIN(14)
#endif
#if BINS > 15
        AG_BIN(15)
#endif
    default: return vec4(1.0);
    }
}
#endif

struct surface {
    vec3 base_color;
    float alpha;
    float metallic, roughness;
    vec3 emission;    // towards the viewer of this fragment
    vec3 normal;      // unit, interpolated, on the side that is seen
    vec3 face_normal; // unit, of the triangle, on the side that is seen
};

// `to_viewer`: from the fragment to the eye or to the light that draws it, any length. Discards
// where MASK says that nothing is there.
surface surface_here(vec3 to_viewer)
{
    ag_gpu_material m = materials[info.x];
    vec3 cross_normal = cross(dFdx(position), dFdy(position));
    surface s;
    vec4 base = m.base_color * color;
#ifdef TEXTURES
    footprint f = uv_footprint();
    base *= lookup(m.base_color_tex, f);
#endif
    s.base_color = base.rgb;
    s.alpha = base.a;
#ifdef MASK
    if (s.alpha < m.emissive.a)
        discard;
#endif
    s.metallic = m.factors.x;
    s.roughness = m.factors.y;
#if defined(TEXTURES) && defined(GLOSSY)
    vec4 mr = lookup(m.metallic_roughness_tex, f);
    s.metallic *= mr.b;
    s.roughness *= mr.g;
#endif
    bool front = gl_FrontFacing != (info.y != 0);
    s.emission = vec3(0.0);
#ifdef EMISSIVE
    if (front || m.factors.z > 0.5) {
        s.emission = m.emissive.rgb;
#ifdef TEXTURES
        s.emission *= lookup(m.emissive_tex, f).rgb;
#endif
    }
#endif
    float len = length(normal);
    s.normal = (front ? 1.0 : -1.0) * (len > 0.0 ? normal / len : vec3(0.0));
    // A triangle so thin that its derivatives vanish keeps the vertex normal.
    vec3 a = abs(cross_normal);
    float largest = max(a.x, max(a.y, a.z));
    s.face_normal = largest > 0.0 ? normalize(cross_normal / largest) : s.normal;
    s.face_normal *= dot(s.face_normal, to_viewer) < 0.0 ? -1.0 : 1.0;
    return s;
}

// Diffuse albedo, [0, 1].
vec3 surface_albedo(surface s)
{
    return clamp(s.base_color * (1.0 - s.metallic), 0.0, 1.0);
}
