#version 450 core
// SPDX-License-Identifier: MIT
// Drawn maps go to where they are kept, and what they were drawn in is cleared.
// In:  scratch, shadow_eye[]
// Out: maps R16F, reciprocal distance; scratch, 0
layout(local_size_x = 16, local_size_y = 4) in;

layout(binding = 1) uniform samplerBuffer eye_texels; // shadow_eye[]
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
    int eye = 3 * (frame.y + map);
    ivec3 place = ivec3(texelFetch(eye_texels, eye).w + float(texel.x),
                        texelFetch(eye_texels, eye + 1).w + float(texel.y),
                        texelFetch(eye_texels, eye + 2).w);
    int at = (map * frame.x + texel.y) * frame.x + texel.x;
    imageStore(maps, place, vec4(uintBitsToFloat(scratch[at])));
    scratch[at] = 0u;
}
