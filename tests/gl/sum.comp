#version 450 core
// SPDX-License-Identifier: MIT
// In: two r32f textures. Out: r32f, the first minus twice the second.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D a;
layout(binding = 1) uniform sampler2D b;
layout(r32f, binding = 0) uniform writeonly image2D to;

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, imageSize(to))))
        imageStore(to, at, vec4(texelFetch(a, at, 0).x - 2 * texelFetch(b, at, 0).x));
}
