#version 450 core
// SPDX-License-Identifier: MIT
// Out: r32f array, 100 x (1 + layer).
layout(local_size_x = 4, local_size_y = 4) in;
layout(r32f, binding = 0) uniform writeonly image2DArray to;

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID);
    imageStore(to, at, vec4(100 * (1 + at.z)));
}
