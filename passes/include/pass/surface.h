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

// The scene's base colours and metallic factors as they are from afar, for light sources that stand
// for more of a surface than the point they sit on.
//
//     ag_blur *blur;
//     if (ag_blur_create(log, scene, 16, &blur) == FG_OK)
//         ag_blur_albedo(blur, primitive->material, hit.uv, hit.color, albedo);
//     ag_blur_destroy(blur);
//
// Of each texture a copy is kept, of at most `texels` along its longer edge and in proportion along
// the other; a smaller one as it is. Each texel of it is the mean, in linear light, of what it
// covers; of a texture that masks, of what is there of it. Lookups are bilinear, also of textures
// that are not. Where an animation moves the texture the lookup is its mean over all texels, at any
// time: what asks outlives the motion.
//
// Owner:  materials and textures of the scene are borrowed while this lives.
// Errors: FG_ERR_INVALID for less than one texel; FG_ERR_MEMORY.
// Thread: lookups on any number at once, beside ag_scene_set_time() too.
typedef struct ag_blur ag_blur;
FG_API FG_NODISCARD fg_status ag_blur_create(const fg_log *log, const ag_scene *scene, int texels,
                                             ag_blur **out);
FG_API void ag_blur_destroy(ag_blur *b); // accepts NULL

// Base colour x (1 - metallic), [0, 1]. `material` is a number of the scene's.
FG_API void ag_blur_albedo(const ag_blur *b, int material, const float uv[2][2],
                           const float color[4], float albedo[3]);

// Irradiance on a plane that faces the light at `point` (world), before shadow and cosine:
// E / cos. `to_light` is unit; `distance` is infinite for directional lights. A point on the
// light itself gets 0.
FG_API void ag_light_eval(const ag_light *light, const double point[3], float e[3],
                          float to_light[3], double *distance);

FG_END

#endif // PASS_SURFACE_H
