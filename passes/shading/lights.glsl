// SPDX-License-Identifier: MIT
// Punctual lights in render space. Needs scene_shared.h.

const float light_pi = 3.14159265358979;

// Radiant intensity of a point or spot light in the unit direction `away`, W/sr.
vec3 light_intensity(ag_gpu_light light, vec3 away)
{
    float c = dot(light.direction.xyz, away);
    if (light.info.x == AG_GPU_COSINE_SPOT)
        return light.intensity.rgb * max(c, 0.0);
    if (light.info.x == AG_GPU_SPOT) {
        float fade = clamp((c - light.direction.w) * light.position.w, 0.0, 1.0);
        return light.intensity.rgb * (fade * fade);
    }
    return light.intensity.rgb;
}

// Irradiance over cosine at `p`, and the unit direction to the light. 0 on the light itself.
vec3 light_irradiance(ag_gpu_light light, vec3 p, out vec3 to_light)
{
    if (light.info.x == AG_GPU_DIRECTIONAL) {
        to_light = -light.direction.xyz;
        return light.intensity.rgb;
    }
    vec3 d = light.position.xyz - p;
    float len = length(d);
    to_light = len > 0.0 ? d / len : vec3(0.0);
    return len > 0.0 ? light_intensity(light, -to_light) / (len * len) : vec3(0.0);
}
