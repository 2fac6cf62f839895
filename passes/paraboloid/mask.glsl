// SPDX-License-Identifier: MIT
// Alpha tests as ag_surface_masked() has them: bilinear at level 0. Triangles of MASK are the last.
layout(std430, binding = 4) readonly buffer corner_buffer
{
    shadow_corner corners[];
};
layout(std430, binding = 5) readonly buffer texture_buffer
{
    ivec4 textures[]; // x: first byte; yz: width, height; w: wrap u, v << 2, nearest << 4
};
layout(std430, binding = 6) readonly buffer alpha_buffer
{
    uint alphas[]; // bytes
};
layout(location = 1) uniform int first_masked;

int wrap(float at, int size, int mode)
{
    float edge = float(size), period = mode == 2 ? 2.0 * edge : edge;
    float inside = clamp(at - period * floor(at / period), 0.0, period - 1.0);
    float found = inside < edge ? inside : period - 1.0 - inside;
    return int(mode == 1 ? clamp(at, 0.0, edge - 1.0) : found);
}

float alpha_at(ivec4 t, vec2 at)
{
    int i = t.x + wrap(at.y, t.z, t.w >> 2 & 3) * t.y + wrap(at.x, t.y, t.w & 3);
    return float(alphas[i >> 2] >> 8 * (i & 3) & 255u) / 255.0;
}

float alpha_of(ivec4 t, vec2 uv)
{
    vec2 at = uv * vec2(t.yz);
    if ((t.w & 16) != 0)
        return alpha_at(t, floor(at));
    vec2 low = floor(at - 0.5), part = at - 0.5 - low;
    vec4 a = vec4(alpha_at(t, low), alpha_at(t, low + vec2(1.0, 0.0)), alpha_at(t, low + vec2(0.0, 1.0)),
                  alpha_at(t, low + 1.0));
    vec2 row = mix(a.xz, a.yw, part.x);
    return mix(row.x, row.y, part.y);
}

bool mask_is_there(int triangle, vec3 weights)
{
    int first = 3 * (triangle - first_masked);
    vec3 w = weights / max(weights.x + weights.y + weights.z, 1e-37);
    vec4 uv = corners[first].uv * w.x + corners[first + 1].uv * w.y + corners[first + 2].uv * w.z;
    int t = int(corners[first].uv.w);
    float alpha = uv.z;
    if (t >= 0)
        alpha *= alpha_of(textures[t], uv.xy);
    return clamp(alpha, 0.0, 1.0) >= corners[first + 1].uv.w;
}
