#version 450 core
// SPDX-License-Identifier: MIT
// Fills the G-buffer; formats and meaning in pass/frame.h (ag_gbuffer).
// GLOSSY, EMISSIVE: their targets are there.
#include "passes/include/pass/view_shared.h"
#include "passes/gpu_scene/material.glsl"
#include "passes/shading/octahedral.glsl"

layout(location = 0) out vec4 out_normal;
layout(location = 1) out vec4 out_position;
layout(location = 2) out vec4 out_albedo;
layout(location = 3) out vec4 out_face;
#ifdef GLOSSY
layout(location = 4) out vec4 out_material;
#endif
#ifdef EMISSIVE
#ifdef GLOSSY
layout(location = 5) out vec4 out_emissive;
#else
layout(location = 4) out vec4 out_emissive;
#endif
#endif

void main()
{
    surface s = surface_here(view_to_eye(position));
    out_normal = vec4(s.normal, 1.0);
    out_position = vec4(position, 1.0);
    out_albedo = vec4(surface_albedo(s), 1.0);
    out_face = vec4(octahedral_encode(s.face_normal), 0.0, 1.0);
#ifdef GLOSSY
    out_material = vec4(s.metallic, s.roughness, 0.0, 1.0);
#endif
#ifdef EMISSIVE
    out_emissive = vec4(s.emission, 1.0);
#endif
}
