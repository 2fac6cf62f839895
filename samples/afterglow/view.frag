#version 450 core
// SPDX-License-Identifier: MIT
// Shows a layer, or two of them with a divider between, in a window.
// In:  left, right: textures with linear values, rows from the bottom up
// Out: display values as a PNG has them; the framebuffer takes them as they are
// Source: IEC 61966-2-1.
layout(binding = 0) uniform sampler2D left_map;
layout(binding = 1) uniform sampler2D right_map;
layout(location = 0) uniform vec4 left_area;  // x, y, width, height in the window, pixels
layout(location = 1) uniform vec4 right_area;
layout(location = 2) uniform float divider; // pixels: right of it, the right one
layout(location = 3) uniform int data;      // 1: values in [-1, 1], shown as value / 2 + 1 / 2
layout(location = 4) uniform vec3 origin;   // added where w is 1
layout(location = 0) out vec4 display;

vec3 encode(vec3 x)
{
    return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

void main()
{
    bool is_right = gl_FragCoord.x >= divider;
    vec4 area = is_right ? right_area : left_area;
    vec2 uv = (gl_FragCoord.xy - area.xy) / area.zw;
    bool inside = all(greaterThanEqual(uv, vec2(0.0))) && all(lessThan(uv, vec2(1.0)));
    vec4 value = is_right ? textureLod(right_map, uv, 0.0) : textureLod(left_map, uv, 0.0);
    value.rgb += value.a > 0.5 ? origin : vec3(0.0);
    if (data != 0)
        value.rgb = value.rgb * 0.5 + 0.5;
    // NaN is black, as image_write() has it.
    vec3 shown = mix(clamp(value.rgb, 0.0, 1.0), vec3(0.0), isnan(value.rgb));
    display = vec4(inside ? (data != 0 ? shown : encode(shown)) : vec3(0.0), 1.0);
}
