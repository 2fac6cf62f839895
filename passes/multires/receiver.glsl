// SPDX-License-Identifier: MIT
// What a texel of the multiresolution buffer receives light by: the G-buffer at its middle.
// The includer has declared the G-buffer's position_map and normal_map.
#include "passes/multires/texel.glsl"

// The middle lies between four pixels, all of the image and, within a texel that needs no refinement,
// of one surface. `normal` is not of unit length where it bends.
void multires_receiver(multires_texel t, out vec3 position, out vec3 normal)
{
    ivec2 at = t.at << t.level;
    if (t.level == 0) {
        position = texelFetch(position_map, at, 0).xyz;
        normal = texelFetch(normal_map, at, 0).xyz;
        return;
    }
    at += (1 << (t.level - 1)) - 1;
    position = vec3(0.0);
    normal = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 texel = at + ivec2(i & 1, i >> 1);
        position += texelFetch(position_map, texel, 0).xyz;
        normal += texelFetch(normal_map, texel, 0).xyz;
    }
    position *= 0.25;
    normal *= 0.25;
}
