#version 450 core
// SPDX-License-Identifier: MIT
// From where imperfect shadow maps are seen: for each node of one level of the VPL tree a texel
// within it, by way of the strongest child, since a node's own position may lie on no surface.
// In:  hisr_node[]
// Out: ag_vpl[], in the order of the nodes; count: x how many
// A node where nothing is lit takes the place of its parent's strongest child: coarser nodes look
// up the map of the first node below them.
#include "plugins/hisr/hisr_shared.h"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer node_buffer
{
    hisr_node nodes[];
};
layout(std430, binding = 1) writeonly buffer eye_buffer
{
    ag_vpl eyes[];
};
layout(std430, binding = 2) writeonly buffer count_buffer
{
    uvec4 count;
};
layout(location = 0) uniform ivec4 layout_; // x: roots; y: level of the eyes; z: the last level; w:
                                            // how many eyes

bool is_lit(int level, int i)
{
    return nodes[HISR_LEVEL_START(layout_.x, level) + i].vpl.position_area.w > 0.0;
}

int strongest_child(int level, int i)
{
    int first = HISR_LEVEL_START(layout_.x, level + 1) + 4 * i, best = 0;
    float most = -1.0;
    for (int k = 0; k < 4; k++) {
        vec3 flux = nodes[first + k].vpl.flux.rgb;
        float all = flux.r + flux.g + flux.b;
        best = all > most ? k : best;
        most = max(most, all);
    }
    return 4 * i + best;
}

void main()
{
    int i = int(gl_GlobalInvocationID.x), at = i, level = layout_.y;
    if (i == 0)
        count = uvec4(uint(layout_.w), 0u, 0u, 0u);
    if (i >= layout_.w)
        return;
    while (level > 0 && !is_lit(level, at)) {
        level--;
        at /= 4;
    }
    for (; level < layout_.z; level++)
        at = strongest_child(level, at);
    ag_vpl eye = nodes[HISR_LEVEL_START(layout_.x, level) + at].vpl;
    if (eye.position_area.w <= 0.0)
        eye.normal.xyz = vec3(0.0, 0.0, 1.0); // nobody looks there, but the map has a frame
    eyes[i] = eye;
}
