#version 450 core
// SPDX-License-Identifier: MIT
// Drawn maps go to where they are kept, and what they were drawn in is cleared.
// In:  scratch, shadow_eye[]
// Out: maps R16F, reciprocal distance; scratch, 0
#include "passes/paraboloid/draw_shared.h"

layout(local_size_x = 16, local_size_y = 4) in;

layout(std430, binding = 1) readonly buffer eye_buffer
{
    shadow_eye eyes[];
};
layout(std430, binding = 2) buffer scratch_buffer
{
    uint scratch[];
};
layout(location = 0) uniform ivec2 frame; // x: texels along a map's edge; y: the first map's eye
layout(binding = 0, r16f) writeonly uniform image2DArray maps;

void main()
{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    int map = int(gl_WorkGroupID.z);
    shadow_eye e = eyes[frame.y + map];
    int at = (map * frame.x + texel.y) * frame.x + texel.x;
    ivec3 place = ivec3(ivec2(e.tangent.w, e.bitangent.w) + texel, e.normal.w);
    imageStore(maps, place, vec4(uintBitsToFloat(scratch[at])));
    scratch[at] = 0u;
}
