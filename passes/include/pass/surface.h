// SPDX-License-Identifier: MIT
#ifndef PASS_SURFACE_H
#define PASS_SURFACE_H

#include <pass/scene.h>

FG_BEGIN

// Material and light evaluation on the host, for the reference renderer and for
// techniques that place light sources on the CPU. The shaders' own versions are in
// passes/shading; tests hold the two against each other.

// Albedo, emission and the like where a ray met a triangle.
typedef struct ag_surface {
    float albedo[3];   // base colour x (1 - metallic), [0, 1]
    float emission[3]; // W/(m^2 sr), as seen from the front face
    float base_color[3];
    float metallic, roughness;
    float alpha;
} ag_surface;

// Bilinear lookup of level 0 with the texture's wrap modes; linear RGBA out.
FG_API void ag_texture_sample(const ag_texture *texture, float u, float v, float rgba[4]);

// `uv` and `color` are interpolated over the triangle.
FG_API void ag_surface_eval(const ag_scene *scene, const ag_material *material,
                            const float uv[2][2], const float color[4], ag_surface *out);

// Whether MASK makes the surface absent here.
FG_API bool ag_surface_masked(const ag_scene *scene, const ag_material *material,
                              const float uv[2][2], const float color[4]);

// Irradiance on a plane that faces the light at `point` (world), before shadow and cosine:
// E / cos. `to_light` is unit; `distance` is infinite for directional lights. A point on the
// light itself gets 0.
FG_API void ag_light_eval(const ag_light *light, const double point[3], float e[3],
                          float to_light[3], double *distance);

FG_END

#endif // PASS_SURFACE_H
