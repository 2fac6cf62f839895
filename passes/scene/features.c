// SPDX-License-Identifier: MIT
#include "scene_priv.h"

#include <math.h>
#include <pass/math.h>
#include <pass/surface.h>

#define PI 3.14159265358979323846

const char *const ag_feature_names[AG_FEATURE_COUNT] = {
    "textures",          "alpha mask",   "glossy",          "emissive",     "area light",
    "moving geometry",   "moving light", "several lights",  "point light",  "spot light",
    "directional light", "skins",        "second uv",       "vertex color", "texture transform",
    "geometry",          "light",        "moving material",
};

// ---- flux -------------------------------------------------------------------------

static double largest(const float rgb[3])
{
    return (double) fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
}

// W, of the strongest colour. Directional lights: what falls on the scene's bounding sphere.
static double light_flux(const ag_scene *s, const ag_light *light)
{
    double intensity = largest(light->intensity), diagonal2 = 0;
    if (light->kind == AG_LIGHT_POINT)
        return 4 * PI * intensity;
    if (light->kind == AG_LIGHT_SPOT && light->cosine)
        return PI * intensity;
    if (light->kind == AG_LIGHT_SPOT) {
        double in = (double) light->cos_inner, out = (double) light->cos_outer;
        return 2 * PI * intensity * ((1 - in) + (in - out) / 3); // the squared ramp's integral
    }
    for (int k = 0; k < 3; k++)
        diagonal2 += (s->box_max[k] - s->box_min[k]) * (s->box_max[k] - s->box_min[k]);
    return isfinite(diagonal2) ? PI * intensity * diagonal2 / 4 : 0;
}

// m^2, of the primitive as the instance shows it.
static double area(const ag_scene *s, const ag_instance *instance)
{
    const ag_primitive *p = &s->primitives[instance->primitive];
    const uint32_t *index = s->indices + p->first_index;
    const ag_vertex *v = s->vertices + p->first_vertex;
    double normal[9], sum = 0;
    ag_mat_normal(instance->world, normal); // cofactors turn areas: a' = |C a|
    for (uint32_t i = 0; i < p->index_count; i += 3) {
        double e[3], f[3], n[3] = { 0 };
        for (int k = 0; k < 3; k++) {
            e[k] = (double) v[index[i + 1]].position[k] - (double) v[index[i]].position[k];
            f[k] = (double) v[index[i + 2]].position[k] - (double) v[index[i]].position[k];
        }
        double a[3] = { e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2],
                        e[0] * f[1] - e[1] * f[0] };
        for (int k = 0; k < 9; k++)
            n[k % 3] += normal[k] * a[k / 3];
        sum += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
    }
    return sum;
}

// The strongest colour's mean over the texture, from a lattice of at most 64 x 64 texels.
static double texture_mean(const ag_texture *t)
{
    double sum[3] = { 0 };
    int nx = t->width < 64 ? t->width : 64, ny = t->height < 64 ? t->height : 64;
    for (int y = 0; y < ny; y++)
        for (int x = 0; x < nx; x++) {
            float rgba[4];
            ag_texture_sample(t, ((float) x + 0.5f) / (float) nx, ((float) y + 0.5f) / (float) ny,
                              rgba);
            for (int k = 0; k < 3; k++)
                sum[k] += (double) rgba[k] / (nx * ny);
        }
    return fmax(sum[0], fmax(sum[1], sum[2]));
}

static const ag_material_drive *drive_of(const ag_scene *s, int material)
{
    return (const ag_material_drive *) s->priv->drives.data + material;
}

static double surface_flux(const ag_scene *s, const ag_instance *instance)
{
    const int material = s->primitives[instance->primitive].material;
    const ag_material *m = &s->materials[material];
    double radiance = largest(drive_of(s, material)->peak);
    if (radiance > 0 && m->emissive_tex.texture >= 0)
        radiance *= texture_mean(&s->textures[m->emissive_tex.texture]);
    if (!(radiance > 0))
        return 0;
    return PI * radiance * area(s, instance) * (m->double_sided ? 2 : 1);
}

static bool has_area_light(const ag_scene *s)
{
    double total = 0, strongest = 0;
    for (int i = 0; i < s->light_count; i++)
        total += light_flux(s, &s->lights[i]);
    for (int i = 0; i < s->instance_count; i++) {
        double flux = surface_flux(s, &s->instances[i]);
        total += flux;
        strongest = fmax(strongest, flux);
    }
    return strongest > 0 && strongest >= 0.01 * total;
}

// ---- the mask ---------------------------------------------------------------------

static uint64_t material_features(const ag_scene *s, int material)
{
    const ag_material *m = &s->materials[material];
    const ag_material_drive *drive = drive_of(s, material);
    const ag_texture_ref *refs[3] = { &m->base_color_tex, &m->metallic_roughness_tex,
                                      &m->emissive_tex };
    uint64_t f = 0;
    for (int i = 0; i < 3; i++) {
        const float *t = refs[i]->transform;
        if (refs[i]->texture < 0)
            continue;
        f |= AG_FEATURE_TEXTURES;
        if (refs[i]->uv == 1)
            f |= AG_FEATURE_SECOND_UV;
        if (drive->uv_moves || t[0] != 1 || t[1] != 0 || t[2] != 0 || t[3] != 0 || t[4] != 1 ||
            t[5] != 0)
            f |= AG_FEATURE_TEXTURE_TRANSFORM;
    }
    if (m->alpha == AG_ALPHA_MASK)
        f |= AG_FEATURE_ALPHA_MASK;
    if (m->metallic > 0 || m->roughness < 1 || m->metallic_roughness_tex.texture >= 0)
        f |= AG_FEATURE_GLOSSY;
    if (largest(drive->peak) > 0)
        f |= AG_FEATURE_EMISSIVE;
    if (m->moving)
        f |= AG_FEATURE_MOVING_MATERIAL;
    return f;
}

static uint64_t primitive_features(const ag_scene *s, const ag_primitive *p)
{
    uint64_t f = material_features(s, p->material) | AG_FEATURE_GEOMETRY;
    if (p->skinned)
        f |= AG_FEATURE_SKINS;
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        const float *c = s->vertices[p->first_vertex + i].color;
        if (c[0] != 1 || c[1] != 1 || c[2] != 1 || c[3] != 1)
            return f | AG_FEATURE_VERTEX_COLOR;
    }
    return f;
}

static uint64_t light_features(const ag_light *light)
{
    static const uint64_t kinds[] = {
        [AG_LIGHT_POINT] = AG_FEATURE_POINT_LIGHT,
        [AG_LIGHT_SPOT] = AG_FEATURE_SPOT_LIGHT,
        [AG_LIGHT_DIRECTIONAL] = AG_FEATURE_DIRECTIONAL_LIGHT,
    };
    return AG_FEATURE_LIGHT | kinds[light->kind] | (light->moving ? AG_FEATURE_MOVING_LIGHT : 0u);
}

uint64_t ag_scene_features(const ag_scene *s)
{
    uint64_t f = 0;
    for (int i = 0; i < s->instance_count; i++) {
        const ag_primitive *p = &s->primitives[s->instances[i].primitive];
        if (p->index_count == 0)
            continue;
        f |= primitive_features(s, p);
        if (s->instances[i].moving)
            f |= AG_FEATURE_MOVING_GEOMETRY;
    }
    for (int i = 0; i < s->light_count; i++)
        f |= light_features(&s->lights[i]);
    if (s->light_count > 1)
        f |= AG_FEATURE_SEVERAL_LIGHTS;
    if (f & AG_FEATURE_EMISSIVE && has_area_light(s))
        f |= AG_FEATURE_AREA_LIGHT;
    return f;
}
