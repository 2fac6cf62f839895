// SPDX-License-Identifier: MIT
// Shadow lookup. Needs scene_shared.h, `faces[]` and `shadow_maps` (sampler2DArray, DEPTH32F).
//
// Percentage closer filtering (Reeves, Salesin, Cook. Rendering Antialiased Shadows with Depth Maps.
// SIGGRAPH 1987) over the TAPS texels around the point, 2 x 2 or 4 x 4: a box of 1 or 3 texels' edge,
// of which the outer texels have the share that lies in it. Each texel is compared with the depth that
// the receiver's own plane has at that texel's centre: in both projections depth is affine over the
// map for a plane, so a plane cannot shadow itself at any slope. What is left for the bias is another
// surface that meets the receiver's within the filter, as in the corner of a room: per texel of
// distance from the point it rises above the plane by as many texels as the tangents of both angles to
// the light say. The receiver's is known; 4 stands for the other's, 76 degrees. Light leaks below
// blockers no thicker than that.
#ifndef TAPS
#define TAPS 4
#endif
const int shadow_side = TAPS == 16 ? 4 : 2; // texels
const float shadow_bias_texels = 4.0;
// The largest tangent that counts. Whatever the tangent, the bias is less than a texel off the
// receiver's plane. A limit keeps light from leaking far down below a ledge, and costs false shadow
// where a wall that the light grazes meets a floor, which the wide filter would spread twice as high.
const float shadow_bias_slope = TAPS == 16 ? 32.0 : 8.0;

int shadow_pick_face(ag_gpu_light light, vec3 p)
{
    int best = light.info.y;
    float most = -1e38;
    for (int i = light.info.y; i < light.info.y + light.info.z; i++) {
        float along = dot(faces[i].forward.xyz, p - faces[i].eye.xyz);
        if (along > most) {
            most = along;
            best = i;
        }
    }
    return best;
}

// Depth of the plane through `d` with normal `n` at the map's position `st` in [-1, 1]^2; larger
// is nearer to the light. `d`: from the face's eye.
float shadow_plane_depth(ag_gpu_face f, vec3 d, vec3 n, vec2 st)
{
    vec3 across = f.right.xyz * (f.right.w * st.x) + f.up.xyz * (f.up.w * st.y);
    if (f.eye.w > 0.5) {
        float slope = dot(n, f.forward.xyz);
        return 1.0 - (dot(n, d - across) / slope) * f.forward.w;
    }
    return f.forward.w * dot(n, f.forward.xyz + across) / dot(n, d);
}

// Depth by which a surface may be nearer to the light without being a blocker.
float shadow_bias(ag_gpu_face f, float size, float z, float cosine)
{
    float slope = sqrt(max(1.0 - cosine * cosine, 0.0)) / max(cosine, 1e-3);
    float texels = shadow_bias_texels + min(slope, shadow_bias_slope);
    return texels * 2.0 * f.right.w / size * (f.eye.w > 0.5 ? f.forward.w : z);
}

// Of a box filter about the point, per axis and before normalising; `frac`: [0, 1), how far the point
// is between the two middle texels.
float shadow_weight(float frac, int i)
{
    return i == 0 ? 1.0 - frac : i == shadow_side - 1 ? frac : 1.0;
}

// Whether the plane through `d` is lit at a texel. `z`: depth of `d`.
bool shadow_texel_lit(int face, ag_gpu_face f, vec3 d, vec3 n, vec2 texel, float z, float bias)
{
    float size = float(textureSize(shadow_maps, 0).x);
    float plane = shadow_plane_depth(f, d, n, (texel + 0.5) / size * 2.0 - 1.0);
    // At grazing angles the plane runs away within a texel; it may not leave the light's half.
    plane = clamp(plane, 0.0, 2.0 * z);
    return plane + bias >= texelFetch(shadow_maps, ivec3(texel, face), 0).x;
}

#if TAPS == 16
// The same of the texel of another face that lies where this one would have `texel`, beyond its rim:
// up to half a texel from there along each axis, hence 2.5 x sqrt(2) from the point.
const float seam_reach = 3.6;
bool shadow_beyond_seam(ag_gpu_light light, ag_gpu_face f, vec3 d, vec3 n, vec2 texel, float cosine)
{
    float size = float(textureSize(shadow_maps, 0).x);
    vec2 st = (texel + 0.5) / size * 2.0 - 1.0;
    vec3 away = f.forward.xyz + f.right.xyz * (f.right.w * st.x) + f.up.xyz * (f.up.w * st.y);
    int face = shadow_pick_face(light, f.eye.xyz + away);
    ag_gpu_face g = faces[face];
    st = vec2(dot(away, g.right.xyz) / g.right.w, dot(away, g.up.xyz) / g.up.w) /
         dot(away, g.forward.xyz);
    texel = clamp(floor((st * 0.5 + 0.5) * size), vec2(0.0), vec2(size - 1.0));
    float z = g.forward.w / max(dot(d, g.forward.xyz), g.forward.w);
    return shadow_texel_lit(face, g, d, n, texel, z, seam_reach * shadow_bias(g, size, z, cosine));
}
#endif

// Fraction of light that arrives, [0, 1]. `n`: face normal, facing the light.
float shadow_visibility(ag_gpu_light light, vec3 p, vec3 n)
{
    int face = shadow_pick_face(light, p);
    ag_gpu_face f = faces[face];
    vec3 d = p - f.eye.xyz;
    float along = dot(d, f.forward.xyz);
    if (f.eye.w < 0.5 && along <= f.forward.w)
        return 1.0; // between the light and its near plane: nothing can stand before it
    float size = float(textureSize(shadow_maps, 0).x);
    float w = f.eye.w > 0.5 ? 1.0 : along;
    vec2 st = vec2(dot(d, f.right.xyz) / f.right.w, dot(d, f.up.xyz) / f.up.w) / w;
    vec2 at = (st * 0.5 + 0.5) * size - 0.5;
    vec2 base = floor(at);
    vec2 frac = at - base;
    float z = f.eye.w > 0.5 ? 1.0 - along * f.forward.w : f.forward.w / along;
    float cosine = abs(dot(n, f.eye.w > 0.5 ? f.forward.xyz : normalize(d)));
    float bias = shadow_bias(f, size, z, cosine);
    float lit = 0.0;
    for (int i = 0; i < TAPS; i++) {
        ivec2 corner = ivec2(i % shadow_side, i / shadow_side);
        vec2 wanted = base + vec2(corner - (shadow_side / 2 - 1));
        vec2 texel = clamp(wanted, vec2(0.0), vec2(size - 1.0));
        float weight = shadow_weight(frac.x, corner.x) * shadow_weight(frac.y, corner.y);
#if TAPS == 16
        float reach = max(length(wanted - at), 1.0);
        bool is_lit = texel != wanted && light.info.z > 1
                          ? shadow_beyond_seam(light, f, d, n, wanted, cosine)
                          : shadow_texel_lit(face, f, d, n, texel, z, bias * reach);
#else
        bool is_lit = shadow_texel_lit(face, f, d, n, texel, z, bias);
#endif
        lit += is_lit ? weight : 0.0;
    }
    return lit / float((shadow_side - 1) * (shadow_side - 1));
}
