#version 450 core
// SPDX-License-Identifier: MIT
// What paraboloid maps say of many receivers.
// In:  a VPL's index; vec4[]: position in render space, unit normal, alternating
// Out: float[]: visibility
#include "passes/paraboloid/visibility.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer receiver_buffer
{
    vec4 receivers[];
};
layout(std430, binding = 1) writeonly buffer answer_buffer
{
    float answers[];
};
layout(location = 0) uniform ivec2 asked; // x: VPL; y: receivers

void main()
{
    int i = int(gl_GlobalInvocationID.x);
    if (i >= asked.y)
        return;
    paraboloid_map map = paraboloid_open(asked.x);
    answers[i] = paraboloid_visibility(map, receivers[2 * i].xyz * view.scale.x,
                                       receivers[2 * i + 1].xyz);
}
