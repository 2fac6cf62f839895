// SPDX-License-Identifier: MIT
// Textures, materials and animation channels of a builder.
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
    ag_material *copy = ag_builder_push(b, &b->p->materials, sizeof *copy, "materials");
    if (!copy)
        return -1;
    *copy = m;
    return (int) b->p->materials.count - 1;
}

// ---- animation channels -----------------------------------------------------------

static const char *const path_names[] = { "translation", "rotation", "scale" };

static int values_per_key(const ag_channel_desc *d)
{
    return (d->path == AG_PATH_ROTATION ? 4 : 3) *
           (d->interpolation == AG_INTERPOLATE_CUBIC ? 3 : 1);
}

static const char *channel_fault(const ag_channel_desc *d)
{
    if (d->interpolation < AG_INTERPOLATE_LINEAR || d->interpolation > AG_INTERPOLATE_CUBIC)
        return "its interpolation does not exist";
    if (d->animation < 0 || d->animation >= AG_MAX_SCENE_ANIMATIONS)
        return "its animation number is out of range";
    if (d->key_count < 1 || d->key_count > AG_MAX_SCENE_ITEMS)
        return "it has no keys, or absurdly many";
    for (int i = 0; i < d->key_count; i++) {
        if (!isfinite(d->times[i]) || d->times[i] < 0)
            return "a key's time is negative or not finite";
        if (i > 0 && d->times[i] <= d->times[i - 1])
            return "its keys' times do not increase";
    }
    size_t values = (size_t) d->key_count * (size_t) values_per_key(d);
    for (size_t i = 0; i < values; i++)
        if (!isfinite(d->values[i]))
            return "a value is not finite";
    return NULL;
}

// Quaternions of every key unit; one of no length becomes the identity.
static void normalize_rotations(ag_channel *c)
{
    bool cubic = c->interpolation == AG_INTERPOLATE_CUBIC;
    for (int k = 0; k < c->key_count; k++) {
        float *q = c->values + (size_t) k * (cubic ? 12 : 4) + (cubic ? 4 : 0);
        double length2 = 0;
        for (int i = 0; i < 4; i++)
            length2 += (double) q[i] * (double) q[i];
        for (int i = 0; i < 4; i++)
            q[i] = length2 > 0 ? (float) ((double) q[i] / sqrt(length2)) : (float) (i == 3);
    }
}

// Whether the channel's value is not the same at all times.
static bool varies(const ag_channel *c)
{
    size_t n = c->path == AG_PATH_ROTATION ? 4 : 3;
    bool cubic = c->interpolation == AG_INTERPOLATE_CUBIC;
    for (int k = 1; k < c->key_count; k++) {
        const float *v = c->values + (size_t) k * n * (cubic ? 3 : 1);
        if (memcmp(v + (cubic ? n : 0), c->values + (cubic ? n : 0), n * sizeof *v) != 0)
            return true;
        for (size_t i = 0; cubic && i < n; i++)
            if (v[i] != 0 || (v - n)[i] != 0)
                return true;
    }
    return false;
}

static bool lengthen(ag_builder *b, const ag_channel *c)
{
    ag_array *lengths = &b->p->lengths;
    size_t missing = (size_t) c->animation + 1;
    missing = missing > lengths->count ? missing - lengths->count : 0;
    if (missing > 0 && !ag_array_push(lengths, missing, sizeof(double)))
        return false;
    double *length = (double *) lengths->data + c->animation;
    *length = fmax(*length, (double) c->times[c->key_count - 1]);
    return true;
}

void ag_builder_channel(ag_builder *b, const ag_channel_desc *desc)
{
    if (!ag_builder_open(b))
        return;
    ag_array *nodes = &b->p->nodes;
    if (desc->node < 0 || desc->node >= (int) nodes->count || desc->path < AG_PATH_TRANSLATION ||
        desc->path > AG_PATH_SCALE) {
        ag_builder_refuse(b, FG_ERR_INVALID, "channel: node %d or path %d does not exist",
                          desc->node, (int) desc->path);
        return;
    }
    ag_node *node = (ag_node *) nodes->data + desc->node;
    const char *path = path_names[desc->path];
    const char *fault = node->has_matrix ? "the node has a matrix" : channel_fault(desc);
    if (fault) {
        ag_builder_refuse(b, FG_ERR_INVALID, "channel: %s of node %d '%s': %s", path, desc->node,
                          node->name, fault);
        return;
    }
    if (node->driven_paths & (1 << desc->path)) {
        ag_builder_warn(b, "channel: %s of node %d '%s' is driven already; this one is left out",
                        path, desc->node, node->name);
        return;
    }
    size_t keys = (size_t) desc->key_count, values = keys * (size_t) values_per_key(desc);
    ag_channel *c = ag_builder_push(b, &b->p->channels, sizeof *c, "channels");
    if (!c)
        return;
    *c = (ag_channel){
        .node = desc->node,
        .path = desc->path,
        .interpolation = desc->interpolation,
        .animation = desc->animation,
        .key_count = desc->key_count,
        .times = malloc((keys + values) * sizeof(float)),
    };
    if (!c->times) {
        ag_builder_refuse(b, FG_ERR_MEMORY, "channels: out of memory");
        return;
    }
    c->values = c->times + keys;
    memcpy(c->times, desc->times, keys * sizeof(float));
    memcpy(c->values, desc->values, values * sizeof(float));
    if (c->path == AG_PATH_ROTATION)
        normalize_rotations(c);
    if (!lengthen(b, c)) {
        ag_builder_refuse(b, FG_ERR_MEMORY, "channels: out of memory");
        return;
    }
    node->driven = true;
    node->driven_paths |= (uint8_t) (1 << desc->path);
    node->moving = node->moving || varies(c);
}
