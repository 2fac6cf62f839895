// SPDX-License-Identifier: MIT
// The patch that a VPL stands for. Needs scene_shared.h, vpl_shared.h.

// An edge of the patch as ag_vpl packs it.
float pack_edge(vec3 edge, vec3 t, vec3 b)
{
    vec2 e = clamp(vec2(dot(edge, t), dot(edge, b)), -1e3, 1e3);
    return uintBitsToFloat(packHalf2x16(e));
}

// The patch that a texel at `p` with normal `n` stands for: how the point where its ray meets the
// plane moves with the texel, brought to area 1.
void pack_edges(ag_gpu_face f, vec3 p, vec3 n, inout ag_vpl v)
{
    vec3 du = f.right.xyz * f.right.w, dv = f.up.xyz * f.up.w; // over half the map
    vec3 ray = f.forward.xyz;
    if (f.eye.w < 0.5) {
        ray = p - f.eye.xyz;
        float along = dot(ray, f.forward.xyz);
        du *= along;
        dv *= along;
    }
    float across = dot(ray, n);
    across = abs(across) < 1e-6 * length(ray) ? -1e-6 * length(ray) : across;
    du -= ray * (dot(du, n) / across);
    dv -= ray * (dot(dv, n) / across);
    vec3 t, b;
    vpl_frame(n, t, b);
    float largest = max(length(du), length(dv));
    du /= max(largest, 1e-30);
    dv /= max(largest, 1e-30);
    float to_unit = inversesqrt(max(length(cross(du, dv)), 1e-6));
    v.normal.w = pack_edge(du * to_unit, t, b);
    v.flux.w = pack_edge(dv * to_unit, t, b);
}
