#version 450 core
// SPDX-License-Identifier: MIT
// Exposure and a filmic curve.
// In:  radiance RGBA32F
// Out: display values in [0, 1], still linear: whoever writes a file or window encodes them
// Source: Narkowicz. ACES Filmic Tone Mapping Curve. 2016: a rational fit, a channel at a time.
layout(binding = 0) uniform sampler2D radiance_map;
layout(location = 0) uniform float exposure;
layout(location = 0) out vec4 display;

void main()
{
    vec3 x = texelFetch(radiance_map, ivec2(gl_FragCoord.xy), 0).rgb * exposure;
    x = clamp(x, 0.0, 1e4); // the curve is flat long before; its squares stay finite
    display = vec4(clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0), 1.0);
}
