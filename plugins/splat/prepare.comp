#version 450 core
// SPDX-License-Identifier: MIT
// What a splat needs of its VPL, and the indirect draw of all of them.
// In:  ag_vpl[], count; patches
// Out: splat_light[], lengths in units of about the scene; draw command: a point a patch, an instance
//      a VPL
// Source: the bound: Dachsbacher, Stamminger. Splatting Indirect Illumination. I3D 2006, sec. 3.
#include "passes/include/pass/view_shared.h"
#include "passes/include/pass/vpl_shared.h"
#include "plugins/splat/splat_shared.h"

const uint group = 256;
const float pi = 3.14159265358979;

layout(local_size_x = group) in;

layout(std430, binding = 0) readonly buffer vpl_buffer
{
    ag_vpl vpls[];
};
layout(std430, binding = 1) readonly buffer count_buffer
{
    uvec4 count;
};
layout(std430, binding = 2) readonly buffer patch_buffer
{
    uint patches;
};
layout(std430, binding = 3) writeonly buffer light_buffer
{
    splat_light lights[];
};
layout(std430, binding = 4) writeonly buffer draw_buffer
{
    uvec4 draw; // count, instances, first, first instance
};
layout(location = 0) uniform float reach;

shared vec2 sums[group];

float largest(vec3 v)
{
    return max(v.r, max(v.g, v.b));
}

// Radiosity of all that the light lights, in the mean; the largest channel's.
float mean_radiosity(float unit)
{
    uint me = gl_LocalInvocationIndex;
    vec2 sum = vec2(0.0);
    for (uint j = me; j < count.x; j += group)
        sum += vec2(largest(vpls[j].flux.rgb), vpls[j].position_area.w * unit * unit);
    sums[me] = sum;
    for (uint half_ = group / 2; half_ > 0; half_ /= 2) {
        barrier();
        if (me < half_)
            sums[me] += sums[me + half_];
    }
    barrier();
    return min(sums[0].x, 3.0e38) / max(sums[0].y, 1e-30);
}

void main()
{
    float unit = view.scale.x; // a power of two: the scaling rounds nothing
    float least = reach > 0.0 ? min(reach * mean_radiosity(unit), 3.0e38) : 0.0;
    for (uint j = gl_LocalInvocationIndex; j < count.x; j += group) {
        vec4 p = vpls[j].position_area;
        float area = p.w * unit * unit;
        // A splat brings flux / A_j at most, and all together stay finite.
        vec3 flux = vpls[j].flux.rgb;
        float bound = largest(flux) > 0.0 ? min(least / largest(flux), 3.0e38) : 3.0e38;
        flux = min(flux * (unit * unit / pi), area * (3.0e38 / float(count.x)));
        lights[j] = splat_light(vec4(p.xyz * unit, area), vec4(vpls[j].normal.xyz, bound),
                                vec4(flux, 0.0));
    }
    if (gl_LocalInvocationIndex == 0)
        draw = uvec4(patches, count.x, 0u, 0u);
}
