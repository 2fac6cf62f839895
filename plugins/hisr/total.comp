#version 450 core
// SPDX-License-Identifier: MIT
// What the roots of the VPL tree hold together. One work group.
// In:  hisr_node[]
// Out: hisr_total
#include "plugins/hisr/hisr_shared.h"

layout(local_size_x = 256) in;

layout(std430, binding = 0) readonly buffer node_buffer
{
    hisr_node nodes[];
};
layout(std430, binding = 1) writeonly buffer total_buffer
{
    hisr_total total;
};
layout(location = 0) uniform int roots;

shared vec4 parts[256];

void main()
{
    int me = int(gl_LocalInvocationIndex);
    parts[me] = vec4(0.0);
    for (int i = me; i < roots; i += 256)
        parts[me] += vec4(nodes[i].vpl.flux.rgb, nodes[i].vpl.position_area.w);
    for (int half_ = 128; half_ > 0; half_ /= 2) {
        barrier();
        if (me < half_)
            parts[me] += parts[me + half_];
    }
    if (me == 0)
        total.flux_area = min(parts[0], vec4(3.0e38));
}
