// SPDX-License-Identifier: MIT
// Textures and materials of a builder.
#include "scene_priv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- textures ---------------------------------------------------------------------

int ag_builder_texture_take(ag_builder *b, const ag_texture *texture, uint8_t *rgba)
{
    ag_texture *copy = NULL;
    if (!ag_builder_open(b))
        goto fail;
    ag_array *textures = &b->p->textures;
    if (texture->width < 1 || texture->height < 1 || texture->width > AG_MAX_SCENE_TEXTURE_SIDE ||
        texture->height > AG_MAX_SCENE_TEXTURE_SIDE) {
        ag_builder_refuse(b, FG_ERR_INVALID,
                          "texture %zu '%.63s': size is %dx%d, must be 1 to %d a side",
                          textures->count, texture->name, texture->width, texture->height,
                          AG_MAX_SCENE_TEXTURE_SIDE);
        goto fail;
    }
    copy = ag_builder_push(b, textures, sizeof *copy, "textures");
    if (!copy)
        goto fail;
    *copy = *texture;
    copy->rgba = rgba;
    return (int) textures->count - 1;

fail:
    free(rgba);
    return -1;
}

int ag_builder_texture(ag_builder *b, const ag_texture *texture)
{
    if (!ag_builder_open(b))
        return -1;
    if (!texture->rgba)
        return ag_builder_refuse(b, FG_ERR_INVALID, "texture %zu '%.63s': it has no pixels",
                                 b->p->textures.count, texture->name);
    // Sizes out of range are refused below; they must not decide how much is copied.
    bool sized = texture->width > 0 && texture->height > 0 &&
                 texture->width <= AG_MAX_SCENE_TEXTURE_SIDE &&
                 texture->height <= AG_MAX_SCENE_TEXTURE_SIDE;
    size_t bytes = sized ? (size_t) texture->width * (size_t) texture->height * 4 : 1;
    uint8_t *pixels = malloc(bytes);
    if (!pixels)
        return ag_builder_refuse(b, FG_ERR_MEMORY, "texture '%.63s': out of memory", texture->name);
    memcpy(pixels, texture->rgba, sized ? bytes : 0);
    return ag_builder_texture_take(b, texture, pixels);
}

// ---- materials --------------------------------------------------------------------

static const ag_texture_ref no_texture = { .texture = -1, .transform = { 1, 0, 0, 0, 1, 0 } };

ag_material ag_default_material(void)
{
    return (ag_material){
        .base_color = { 1, 1, 1, 1 },
        .roughness = 1,
        .base_color_tex = no_texture,
        .metallic_roughness_tex = no_texture,
        .emissive_tex = no_texture,
        .alpha_cutoff = 0.5f,
    };
}

static bool texture_ref(ag_builder *b, ag_texture_ref *ref, const ag_material *m, const char *what)
{
    size_t count = b->p->textures.count;
    if (ref->texture < -1 || ref->texture >= (int) count) {
        ag_builder_refuse(b, FG_ERR_INVALID,
                          "material '%.63s': %s texture %d does not exist (textures: %zu)", m->name,
                          what, ref->texture, count);
        return false;
    }
    if (ref->texture == -1) {
        *ref = no_texture;
        return true;
    }
    if (ref->uv < 0 || ref->uv > 1) {
        ag_builder_refuse(b, FG_ERR_INVALID, "material '%.63s': %s uses UV set %d, must be 0 or 1",
                          m->name, what, ref->uv);
        return false;
    }
    bool unset = true;
    for (int i = 0; i < 6; i++)
        unset = unset && ref->transform[i] == 0;
    for (int i = 0; i < 6; i++) {
        if (unset)
            ref->transform[i] = no_texture.transform[i];
        if (!isfinite(ref->transform[i])) {
            ag_builder_refuse(b, FG_ERR_INVALID,
                              "material '%.63s': %s has a texture transform that is not finite",
                              m->name, what);
            return false;
        }
    }
    return true;
}

// False when not a number. Counts what had to be clamped.
static bool unit_range(float *v, int n, int *clamped)
{
    for (int i = 0; i < n; i++) {
        if (isnan(v[i]))
            return false;
        float inside = fminf(fmaxf(v[i], 0), 1);
        *clamped += inside != v[i];
        v[i] = inside;
    }
    return true;
}

static int store_material(ag_builder *b, const ag_material *m)
{
    ag_material *copy = ag_builder_push(b, &b->p->materials, sizeof *copy, "materials");
    ag_material_drive *drive =
        copy ? ag_builder_push(b, &b->p->drives, sizeof *drive, "materials") : NULL;
    ag_texture_ref *refs[3];
    if (!drive)
        return -1;
    *copy = *m;
    copy->moving = false;
    memcpy(drive->peak, copy->emissive, sizeof drive->peak);
    ag_material_refs(copy, refs);
    for (int i = 0; i < 3; i++) {
        drive->rest_offset[i][0] = refs[i]->transform[2];
        drive->rest_offset[i][1] = refs[i]->transform[5];
    }
    return (int) b->p->materials.count - 1;
}

int ag_builder_material(ag_builder *b, const ag_material *material)
{
    if (!ag_builder_open(b))
        return -1;
    ag_material m = *material;
    ag_name_copy(m.name, material->name);
    if (!texture_ref(b, &m.base_color_tex, &m, "base colour") ||
        !texture_ref(b, &m.metallic_roughness_tex, &m, "metallic-roughness") ||
        !texture_ref(b, &m.emissive_tex, &m, "emissive"))
        return -1;
    int clamped = 0;
    if (!unit_range(m.base_color, 4, &clamped) || !unit_range(&m.metallic, 1, &clamped) ||
        !unit_range(&m.roughness, 1, &clamped) || isnan(m.alpha_cutoff))
        return ag_builder_refuse(b, FG_ERR_INVALID, "material '%s': a factor is not a number",
                                 m.name);
    for (int i = 0; i < 3; i++)
        if (!isfinite(m.emissive[i]) || m.emissive[i] < 0)
            return ag_builder_refuse(b, FG_ERR_INVALID,
                                     "material '%s': emission is %g, must be finite and not "
                                     "negative",
                                     m.name, (double) m.emissive[i]);
    if (m.alpha < AG_ALPHA_OPAQUE || m.alpha > AG_ALPHA_MASK)
        return ag_builder_refuse(b, FG_ERR_INVALID, "material '%s': alpha mode %d does not exist",
                                 m.name, (int) m.alpha);
    if (clamped > 0)
        ag_builder_warn(b, "material '%s': %d factors outside of [0, 1] are clamped", m.name,
                        clamped);
    return store_material(b, &m);
}
