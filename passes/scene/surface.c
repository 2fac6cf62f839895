// SPDX-License-Identifier: MIT
#include "surface_priv.h"

#include <math.h>
#include <pthread.h>

// ---- textures ---------------------------------------------------------------------

static float srgb_to_linear[256], unorm_to_float[256];
static pthread_once_t tables_once = PTHREAD_ONCE_INIT;

static void make_tables(void)
{
    for (int i = 0; i < 256; i++) {
        double v = i / 255.0;
        unorm_to_float[i] = (float) v;
        srgb_to_linear[i] = (float) (v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4));
    }
}

static int wrap(ag_wrap mode, double i, int size)
{
    if (mode == AG_WRAP_CLAMP)
        return (int) fmin(fmax(i, 0), size - 1);
    double period = mode == AG_WRAP_MIRROR ? 2.0 * size : size;
    double in = i - period * floor(i / period);
    // Far from the origin the division rounds; the texel stays in the image.
    in = fmin(fmax(in, 0), period - 1);
    return (int) (in < size ? in : period - 1 - in);
}

void ag_texel_linear(const ag_texture *t, size_t at, float rgba[4])
{
    pthread_once(&tables_once, make_tables);
    const uint8_t *texel = t->rgba + at * 4;
    const float *rgb_table = t->srgb ? srgb_to_linear : unorm_to_float;
    for (int i = 0; i < 3; i++)
        rgba[i] = rgb_table[texel[i]];
    rgba[3] = unorm_to_float[texel[3]];
}

static size_t texel_at(const ag_texture *t, const int size[2], double x, double y)
{
    return (size_t) wrap(t->wrap_v, y, size[1]) * (size_t) size[0] +
           (size_t) wrap(t->wrap_u, x, size[0]);
}

int ag_texture_taps(const ag_texture *t, const int size[2], const float uv[2], ag_tap taps[4])
{
    double x = isfinite(uv[0]) ? (double) uv[0] * size[0] : 0,
           y = isfinite(uv[1]) ? (double) uv[1] * size[1] : 0;
    double x0 = floor(x - 0.5), y0 = floor(y - 0.5);
    float fx = (float) (x - 0.5 - x0), fy = (float) (y - 0.5 - y0);
    taps[0] = (ag_tap){ texel_at(t, size, x0, y0), (1 - fx) * (1 - fy) };
    taps[1] = (ag_tap){ texel_at(t, size, x0 + 1, y0), fx * (1 - fy) };
    taps[2] = (ag_tap){ texel_at(t, size, x0, y0 + 1), (1 - fx) * fy };
    taps[3] = (ag_tap){ texel_at(t, size, x0 + 1, y0 + 1), fx * fy };
    return 4;
}

void ag_texture_sample(const ag_texture *t, float u, float v, float rgba[4])
{
    const int size[2] = { t->width, t->height };
    ag_tap taps[4] = { { .weight = 1 } };
    int count = 1;
    if (t->nearest)
        taps[0].at = texel_at(t, size, isfinite(u) ? floor((double) u * size[0]) : 0,
                              isfinite(v) ? floor((double) v * size[1]) : 0);
    else
        count = ag_texture_taps(t, size, (float[2]){ u, v }, taps);
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = 0;
    for (int k = 0; k < count; k++) {
        float texel[4];
        ag_texel_linear(t, taps[k].at, texel);
        for (int i = 0; i < 4; i++)
            rgba[i] += taps[k].weight * texel[i];
    }
}

// ---- surfaces ---------------------------------------------------------------------

void ag_texture_place(const ag_texture_ref *ref, const float uv[2][2], float at[2])
{
    const float *t = ref->transform, *in = uv[ref->uv];
    at[0] = t[0] * in[0] + t[1] * in[1] + t[2];
    at[1] = t[3] * in[0] + t[4] * in[1] + t[5];
}

static void sample_ref(const ag_scene *scene, const ag_texture_ref *ref, const float uv[2][2],
                       float rgba[4])
{
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = 1;
    if (ref->texture < 0)
        return;
    float at[2];
    ag_texture_place(ref, uv, at);
    ag_texture_sample(&scene->textures[ref->texture], at[0], at[1], rgba);
}

void ag_surface_eval(const ag_scene *scene, const ag_material *m, const float uv[2][2],
                     const float color[4], ag_surface *out)
{
    float base[4], mr[4], emission[4];
    sample_ref(scene, &m->base_color_tex, uv, base);
    sample_ref(scene, &m->metallic_roughness_tex, uv, mr);
    sample_ref(scene, &m->emissive_tex, uv, emission);
    out->metallic = clamp01(m->metallic * mr[2]);
    out->roughness = clamp01(m->roughness * mr[1]);
    out->alpha = clamp01(m->base_color[3] * base[3] * color[3]);
    for (int i = 0; i < 3; i++) {
        out->base_color[i] = clamp01(m->base_color[i] * base[i] * color[i]);
        out->albedo[i] = out->base_color[i] * (1 - out->metallic);
        out->emission[i] = m->emissive[i] * emission[i];
    }
}

bool ag_surface_masked(const ag_scene *scene, const ag_material *m, const float uv[2][2],
                       const float color[4])
{
    if (m->alpha != AG_ALPHA_MASK)
        return false;
    float base[4];
    sample_ref(scene, &m->base_color_tex, uv, base);
    return clamp01(m->base_color[3] * base[3] * color[3]) < m->alpha_cutoff;
}

// ---- lights -----------------------------------------------------------------------

static double spot_falloff(const ag_light *light, double cosine)
{
    if (light->cosine)
        return fmax(0, cosine);
    double in = (double) light->cos_inner, out = (double) light->cos_outer;
    double ramp = fmin(fmax((cosine - out) / fmax(1e-3, in - out), 0), 1);
    return ramp * ramp;
}

void ag_light_eval(const ag_light *light, const double point[3], float e[3], float to_light[3],
                   double *distance)
{
    double d[3], d2 = 0, scale = 1;
    for (int i = 0; i < 3; i++) {
        d[i] = light->kind == AG_LIGHT_DIRECTIONAL ? -(double) light->direction[i]
                                                   : light->position[i] - point[i];
        d2 += d[i] * d[i];
    }
    double length = sqrt(d2);
    *distance = light->kind == AG_LIGHT_DIRECTIONAL ? (double) INFINITY : length;
    if (light->kind != AG_LIGHT_DIRECTIONAL)
        scale = d2 > 0 ? 1 / d2 : 0;
    double cosine = 0;
    for (int i = 0; i < 3; i++) {
        to_light[i] = length > 0 ? (float) (d[i] / length) : (float) (i == 1);
        cosine -= length > 0 ? d[i] / length * (double) light->direction[i] : 0;
    }
    if (light->kind == AG_LIGHT_SPOT)
        scale *= spot_falloff(light, cosine);
    for (int i = 0; i < 3; i++)
        e[i] = (float) fmin((double) light->intensity[i] * scale, 3.4e38);
}
