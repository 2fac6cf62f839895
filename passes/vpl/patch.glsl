// SPDX-License-Identifier: MIT
// The patch that a VPL stands for. Needs scene_shared.h, vpl_shared.h.

// An edge of the patch as ag_vpl packs it.
float pack_edge(vec3 edge, vec3 t, vec3 b)
{
    vec2 e = clamp(vec2(dot(edge, t), dot(edge, b)), -1e3, 1e3);
    return uintBitsToFloat(packHalf2x16(e));
}

// The patch that a parallelogram of the map about a point at `p` with normal `n` stands for, brought to
// area 1: how the point where its ray meets the plane moves along the edges. `edges`: columns, in the
// map, of any size.
void pack_parallelogram(ag_gpu_face f, vec3 p, vec3 n, mat2 edges, inout ag_vpl v)
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
    vec3 along_u = du * edges[0].x + dv * edges[0].y;
    dv = du * edges[1].x + dv * edges[1].y;
    du = along_u;
    vec3 t, b;
    vpl_frame(n, t, b);
    float largest = max(length(du), length(dv));
    du /= max(largest, 1e-30);
    dv /= max(largest, 1e-30);
    float to_unit = inversesqrt(max(length(cross(du, dv)), 1e-6));
    v.normal.w = pack_edge(du * to_unit, t, b);
    v.flux.w = pack_edge(dv * to_unit, t, b);
}

// The patch of a texel.
void pack_edges(ag_gpu_face f, vec3 p, vec3 n, inout ag_vpl v)
{
    pack_parallelogram(f, p, n, mat2(1.0), v);
}
