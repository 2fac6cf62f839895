#version 450 core
// SPDX-License-Identifier: MIT
// Puts the samples of the scene where their triangles are in this frame.
// In:  ag_ism_sample[]; the scene's vertices and instances
// Out: ag_ism_point[], scene units
// Source: Ritschel et al. 2008, sec. 4.1: triangle and barycentrics, so that the scene may move.
#include "passes/include/pass/ism_shared.h"
#include "passes/include/pass/scene_shared.h"
#include "passes/include/pass/view_shared.h"

layout(local_size_x = 256) in;

layout(std430, binding = 0) readonly buffer sample_buffer
{
    ag_ism_sample samples[];
};
layout(std430, binding = 1) readonly buffer vertex_buffer
{
    vec4 vertices[]; // four of each ag_vertex; xyz of the first: position
};
layout(std430, binding = 2) readonly buffer instance_buffer
{
    ag_gpu_instance instances[];
};
layout(std430, binding = 3) writeonly buffer point_buffer
{
    ag_ism_point points[];
};
layout(location = 0) uniform int count;

vec3 corner(int vertex, int instance)
{
    vec4 p = vec4(vertices[4 * vertex].xyz, 1.0);
    return view.scale.x * vec3(dot(instances[instance].rows[0], p), dot(instances[instance].rows[1], p),
                               dot(instances[instance].rows[2], p));
}

ag_ism_point place(ag_ism_sample s)
{
    vec3 a = corner(s.corners.x, s.corners.w);
    vec3 b = corner(s.corners.y, s.corners.w);
    vec3 c = corner(s.corners.z, s.corners.w);
    // By the longest edge, so that the square of a small triangle's area stays in range.
    vec3 u = b - a, v = c - a;
    float longest = max(length(u), length(v));
    if (!(longest > 1e-15))
        return ag_ism_point(vec4(0.0), vec4(0.0));
    vec3 n = cross(u / longest, v / longest);
    float doubled = length(n);
    if (!(doubled > 1e-12))
        return ag_ism_point(vec4(0.0), vec4(0.0));
    vec3 p = a * s.weights.x + b * s.weights.y + c * s.weights.z;
    float area = 0.5 * doubled * longest * longest * s.weights.w;
    return ag_ism_point(vec4(p, area), vec4(n / doubled, 0.0));
}

void main()
{
    int i = int(gl_GlobalInvocationID.x);
    if (i >= count)
        return;
    ag_ism_point none = ag_ism_point(vec4(0.0), vec4(0.0));
    points[i] = none;
    if (samples[i].corners.w >= 0)
        points[i] = place(samples[i]);
}
