// SPDX-License-Identifier: MIT
// Source: Laine et al. Incremental Instant Radiosity. EGSR 2007, sec. 4.6: the colour of a VPL.
#include "scene_priv.h"
#include "surface_priv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A small copy of a texture.
typedef struct copy {
    const ag_texture *of;
    int least_alpha; // [0, 256]: texels below are not there
    int size[2];
    float (*texel)[4]; // linear; w: how much of it is there, times which rgb is
    float mean[3];
} copy;

// How a material uses a texture. Of one that moves the reference is not looked at again: another
// thread may be writing it.
typedef struct lookup {
    int copy; // -1: no texture
    bool moves;
} lookup;

struct ag_blur {
    const ag_material *materials;
    copy *copies;
    int copy_count;
    lookup (*of_material)[2]; // base colour and metallic
};

// ---- copies -----------------------------------------------------------------------

// As ag_surface_masked() sees it with a vertex colour of 1.
static int least_alpha(const ag_material *m)
{
    int least = 0;
    while (m->alpha == AG_ALPHA_MASK && least < 256 &&
           fminf(m->base_color[3] * (float) (least / 255.0), 1) < m->alpha_cutoff)
        least++;
    return least;
}

static void small_size(const ag_texture *t, int texels, int size[2])
{
    const int longer = t->width > t->height ? t->width : t->height;
    const double scale = longer > texels ? (double) texels / longer : 1;
    size[0] = (int) fmax(round(t->width * scale), 1);
    size[1] = (int) fmax(round(t->height * scale), 1);
}

// Which cell of `to` a texel of `from` begins in, and what of it, over 1 / `to`, lies there and in
// the next.
static int share_out(int texel, int from, int to, int parts[2])
{
    const int begin = texel * to, cell = begin / from, bound = (cell + 1) * from;
    parts[0] = bound - begin < to ? bound - begin : to;
    parts[1] = to - parts[0];
    return cell;
}

static void add_texel(const copy *c, double (*sums)[4], const int at[2])
{
    int parts[2][2], cell[2];
    float rgba[4];
    const size_t from = (size_t) at[1] * (size_t) c->of->width + (size_t) at[0];
    if (c->of->rgba[4 * from + 3] < c->least_alpha)
        return;
    ag_texel_linear(c->of, from, rgba);
    cell[0] = share_out(at[0], c->of->width, c->size[0], parts[0]);
    cell[1] = share_out(at[1], c->of->height, c->size[1], parts[1]);
    for (int i = 0; i < 4; i++) {
        const double weight = (double) parts[0][i & 1] * parts[1][i >> 1];
        if (weight == 0)
            continue;
        double *sum = sums[(cell[1] + (i >> 1)) * c->size[0] + cell[0] + (i & 1)];
        for (int k = 0; k < 3; k++)
            sum[k] += weight * (double) rgba[k];
        sum[3] += weight;
    }
}

static bool fill(copy *c)
{
    const int count = c->size[0] * c->size[1];
    double(*sums)[4] = calloc((size_t) count, sizeof *sums), mean[4] = { 0 };
    c->texel = malloc((size_t) count * sizeof *c->texel);
    if (!sums || !c->texel) {
        free(sums);
        return false;
    }
    for (int y = 0; y < c->of->height; y++)
        for (int x = 0; x < c->of->width; x++)
            add_texel(c, sums, (int[2]){ x, y });
    const double cell = (double) c->of->width * c->of->height;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 4; k++) {
            c->texel[i][k] = (float) (sums[i][k] / cell);
            mean[k] += sums[i][k];
        }
    for (int k = 0; k < 3; k++)
        c->mean[k] = mean[3] > 0 ? (float) (mean[k] / mean[3]) : 0;
    free(sums);
    return true;
}

// The number of the copy that serves, made where there is none yet; -2: out of memory.
static int copy_of(ag_blur *b, const ag_texture *t, int least, int texels)
{
    for (int i = 0; i < b->copy_count; i++)
        if (b->copies[i].of == t && b->copies[i].least_alpha == least)
            return i;
    copy *c = b->copies + b->copy_count++;
    *c = (copy){ .of = t, .least_alpha = least };
    small_size(t, texels, c->size);
    return fill(c) ? b->copy_count - 1 : -2;
}

static bool fill_all(ag_blur *b, const ag_scene *scene, int texels)
{
    for (int i = 0; i < scene->material_count; i++) {
        const ag_material *m = scene->materials + i;
        const int texture[2] = { m->base_color_tex.texture, m->metallic_roughness_tex.texture };
        for (int k = 0; k < 2; k++) {
            const int least = k == 0 ? least_alpha(m) : 0;
            b->of_material[i][k] = (lookup){
                texture[k] < 0 ? -1 : copy_of(b, scene->textures + texture[k], least, texels),
                ag_scene_uv_moves(scene, i),
            };
            if (b->of_material[i][k].copy == -2)
                return false;
        }
    }
    return true;
}

fg_status ag_blur_create(const fg_log *log, const ag_scene *scene, int texels, ag_blur **out)
{
    *out = NULL;
    if (texels < 1) {
        fg_logf(log, FG_LOG_ERROR, "blur: texels is %d, must be at least 1", texels);
        return FG_ERR_INVALID;
    }
    const size_t materials = (size_t) scene->material_count;
    ag_blur *b = calloc(1, sizeof *b);
    if (b) {
        b->materials = scene->materials;
        b->of_material = malloc((materials + 1) * sizeof *b->of_material);
        b->copies = calloc(2 * materials + 1, sizeof *b->copies);
    }
    if (!b || !b->of_material || !b->copies || !fill_all(b, scene, texels)) {
        fg_logf(log, FG_LOG_ERROR, "blur: out of memory");
        ag_blur_destroy(b);
        return FG_ERR_MEMORY;
    }
    *out = b;
    return FG_OK;
}

void ag_blur_destroy(ag_blur *b)
{
    if (!b)
        return;
    for (int i = 0; b->copies && i < b->copy_count; i++)
        free(b->copies[i].texel);
    free(b->copies);
    free(b->of_material);
    free(b);
}

// ---- lookups ----------------------------------------------------------------------

static void look_up(const ag_blur *b, lookup from, const ag_texture_ref *ref, const float uv[2][2],
                    float rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 1;
    if (from.copy < 0)
        return;
    const copy *c = b->copies + from.copy;
    float at[2], sum[4] = { 0 };
    if (from.moves) {
        memcpy(rgb, c->mean, sizeof c->mean);
        return;
    }
    ag_tap taps[4];
    ag_texture_place(ref, uv, at);
    const int count = ag_texture_taps(c->of, c->size, at, taps);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 4; k++)
            sum[k] += taps[i].weight * c->texel[taps[i].at][k];
    for (int k = 0; k < 3; k++) // of what is hardly there the digits are gone
        rgb[k] = sum[3] > 1e-6f ? sum[k] / sum[3] : c->mean[k];
}

void ag_blur_albedo(const ag_blur *b, int material, const float uv[2][2], const float color[4],
                    float albedo[3])
{
    const ag_material *m = b->materials + material;
    const lookup *lookups = b->of_material[material];
    float base[3], rough_metal[3];
    look_up(b, lookups[0], &m->base_color_tex, uv, base);
    look_up(b, lookups[1], &m->metallic_roughness_tex, uv, rough_metal);
    const float metallic = clamp01(m->metallic * rough_metal[2]);
    for (int i = 0; i < 3; i++)
        albedo[i] = clamp01(m->base_color[i] * base[i] * color[i]) * (1 - metallic);
}
