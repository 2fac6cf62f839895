// SPDX-License-Identifier: MIT
// Shadow lookup. Needs scene_shared.h, `faces[]` and `shadow_maps` (sampler2DArray, DEPTH32F).
//
// Percentage closer filtering over the 2 x 2 texels around the point, weighted bilinearly. Each
// texel is compared with the depth that the receiver's own plane has at that texel's centre: in both
// projections depth is affine over the map for a plane, so a plane cannot shadow itself at
// any slope. What is left for the bias is another surface that meets the receiver's within the
// 2 x 2 texels, as in the corner of a room: it rises above the plane by as many texels as the
// tangents of both angles to the light say. The receiver's is known; 4 stands for the other's, 76
// degrees. Light leaks below blockers no thicker than that.
const float shadow_bias_texels = 4.0;
const float shadow_bias_slope = 8.0; // the largest tangent that counts

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
    for (int i = 0; i < 4; i++) {
        vec2 corner = vec2(i & 1, i >> 1);
        vec2 texel = clamp(base + corner, vec2(0.0), vec2(size - 1.0));
        float plane = shadow_plane_depth(f, d, n, (texel + 0.5) / size * 2.0 - 1.0);
        // At grazing angles the plane runs away within a texel; it may not leave the light's half.
        plane = clamp(plane, 0.0, 2.0 * z);
        vec2 weight = mix(1.0 - frac, frac, corner);
        float stored = texelFetch(shadow_maps, ivec3(texel, face), 0).x;
        lit += plane + bias >= stored ? weight.x * weight.y : 0.0;
    }
    return lit;
}
