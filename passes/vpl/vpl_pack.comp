#version 450 core
// SPDX-License-Identifier: MIT
// Moves the valid VPLs to the front in their order, so that the gather meets no empty ones and
// sums in the same order every time.
// In:  ag_vpl[]; valid VPLs of each group of 256
// Out: ag_vpl[], valid ones first; count: x valid, y in all
#include "passes/include/pass/vpl_shared.h"

const uint group = 256;
layout(local_size_x = group) in;

layout(std430, binding = 0) readonly buffer vpl_buffer
{
    ag_vpl vpls[];
};
layout(std430, binding = 1) readonly buffer group_buffer
{
    uint valid_in_group[];
};
layout(std430, binding = 2) writeonly buffer packed_buffer
{
    ag_vpl packed_vpls[];
};
layout(std430, binding = 3) writeonly buffer count_buffer
{
    uvec4 count;
};
layout(location = 0) uniform int total;

#include "passes/shading/scan.glsl"

void main()
{
    uint me = gl_LocalInvocationIndex;
    uint index = gl_GlobalInvocationID.x;
    uint earlier = 0;
    for (uint g = me; g < gl_WorkGroupID.x; g += 256)
        earlier += valid_in_group[g];
    uint base, here;
    scan(earlier, base);

    uint valid = 0;
    if (index < uint(total))
        valid = vpls[index].position_area.w > 0.0 ? 1 : 0;
    uint place = base + scan(valid, here);
    if (valid != 0)
        packed_vpls[place] = vpls[index];
    if (me == 0 && gl_WorkGroupID.x == gl_NumWorkGroups.x - 1)
        count = uvec4(base + here, uint(total), 0, 0);
}
