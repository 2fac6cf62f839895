#version 450 core
// SPDX-License-Identifier: MIT
// Which triangles may cover a texel's middle in which map. Those of few texels are drawn at once, the
// others go to lists.
// In:  shadow_triangle[], shadow_eye[]; MASK: corners, textures
// Out: scratch; uvec4[]: triangle, map, box; a list a class; their counts
#include "passes/paraboloid/draw.glsl"
#include "passes/paraboloid/list.glsl"
#include "passes/paraboloid/scratch.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) writeonly buffer list_buffer
{
    uvec4 list[];
};
layout(std430, binding = 1) buffer count_buffer
{
    uint counts[4];
};
layout(location = 2) uniform ivec4 span; // triangles from x to before y; z: maps; w: room of a list

// A corner this near, or a crossing of the horizon, has no direction to speak of.
const float no_direction = 1.0 / 4096.0;

void add(inout vec4 box, vec2 u, bool counts_)
{
    box = counts_ ? vec4(min(box.xy, u), max(box.zw, u)) : box;
}

// Where an edge goes through the horizon.
void add_crossing(inout vec4 box, vec3 p, vec3 q, inout bool unsure)
{
    bool crosses = (p.z < 0.0) != (q.z < 0.0);
    float rise = q.z - p.z;
    vec2 at = (p.xy * q.z - q.xy * p.z) * sign(rise);
    float far = length(at);
    add(box, at / max(far, 1e-37), crosses);
    unsure = unsure || (crosses && far < no_direction * abs(rise));
}

// Texels whose middle may be covered: first in xy, last in zw.
ivec4 bounds(seen s)
{
    float size = float(frame.x);
    vec3 far = vec3(length(s.a), length(s.b), length(s.c));
    bool unsure = min(min(far.x, far.y), far.z) < no_direction || dot(s.margin, s.margin) > 0.0;
    vec4 box = vec4(2.0, 2.0, -2.0, -2.0);
    add(box, s.a.xy / max(far.x + s.a.z, 1e-37), s.a.z >= 0.0);
    add(box, s.b.xy / max(far.y + s.b.z, 1e-37), s.b.z >= 0.0);
    add(box, s.c.xy / max(far.z + s.c.z, 1e-37), s.c.z >= 0.0);
    add_crossing(box, s.a, s.b, unsure);
    add_crossing(box, s.b, s.c, unsure);
    add_crossing(box, s.c, s.a, unsure);
    float lowest = min(min(s.a.z, s.b.z), s.c.z), highest = max(max(s.a.z, s.b.z), s.c.z);
    box = unsure ? vec4(-1.0, -1.0, 1.0, 1.0) : box;
    // Edges, and the horizon between two crossings, are arcs of circles of radius 1 and more: one
    // leaves its chord of length l by l^2 / 4 at most.
    vec2 extent = box.zw - box.xy;
    float bulge = 0.25 * dot(extent, extent) + (lowest < 0.0 ? 0.25 : 0.002) / size;
    vec2 outmost = max(abs(box.xy), abs(box.zw)) + bulge;
    float inner = 1.0 - 4.0 / size;
    float rim = dot(outmost, outmost) > inner * inner ? (reach + 0.1) * 2.0 / size : 0.0;
    box += vec4(-1.0, -1.0, 1.0, 1.0) * (bulge + rim);
    vec4 texels = (0.5 + 0.5 * box) * size - 0.5;
    ivec4 found = ivec4(ceil(clamp(texels.xy, 0.0, size)), floor(clamp(texels.zw, -1.0, size - 1.0)));
    return highest > 0.0 ? found : ivec4(0, 0, -1, -1);
}

void main()
{
    int i = span.x + int(gl_GlobalInvocationID.x);
    if (i >= span.y)
        return;
    shadow_triangle t = fetch_triangle(i);
    for (int map = 0; map < span.z; map++) {
        seen s = see(t, fetch_eye(frame.y + map));
        ivec4 box = bounds(s);
        ivec2 extent = max(box.zw - box.xy + 1, ivec2(0));
        int texels = extent.x * extent.y;
        if (texels > area.x) {
            int which = texels > area.z ? 2 : texels > area.y ? 1 : 0;
            uint at = atomicAdd(counts[which], 1u);
            list[uint(which * span.w) + at] =
                uvec4(i, map, box.x | box.y << 16, extent.x | extent.y << 16);
        }
        draw_box(i, map, s, box.xy, texels > area.x || texels <= 0 ? ivec2(0) : extent);
    }
}
