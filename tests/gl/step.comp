#version 450 core
// SPDX-License-Identifier: MIT
// In: r32f, or r32ui with FROM_UINT. Out: r32f, or r32ui with TO_UINT.
#include "step.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
#ifdef TO_UINT
layout(r32ui, binding = 0) uniform writeonly uimage2D to;
#define NUMBER uvec4
#else
layout(r32f, binding = 0) uniform writeonly image2D to;
#define NUMBER vec4
#endif

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, imageSize(to))))
        imageStore(to, at, NUMBER(step_number(at)));
}
