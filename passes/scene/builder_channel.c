// SPDX-License-Identifier: MIT
// Animation channels of a builder.
#include "scene_priv.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const path_names[] = { "translation", "rotation", "scale", "emission",
                                          "UV offset" };

// ---- what may be driven ---------------------------------------------------------------

static int values_per_key(const ag_channel_desc *d)
{
    return ag_path_size(d->path) * (d->interpolation == AG_INTERPOLATE_CUBIC ? 3 : 1);
}

static const char *keys_fault(const ag_channel_desc *d)
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

// Of a cubic's three values a key the middle one is the value; tangents may be negative.
static const char *emission_fault(const ag_channel_desc *d)
{
    int n = ag_path_size(d->path), stride = values_per_key(d);
    const float *middle = d->values + (stride > n ? n : 0);
    for (int k = 0; k < d->key_count; k++)
        for (int i = 0; i < n; i++)
            if (middle[(size_t) k * (size_t) stride + (size_t) i] < 0)
                return "a value is negative";
    return NULL;
}

// What a channel aims at: its name, which of its paths are driven, and what speaks against it.
typedef struct aim {
    const char *kind, *name;
    int number;
    uint8_t *driven_paths;
    const char *fault;
} aim;

// False after a refusal: there is no such thing.
static bool find_aim(ag_builder *b, const ag_channel_desc *d, aim *out)
{
    const bool known = d->path >= AG_PATH_TRANSLATION && d->path <= AG_PATH_UV_OFFSET;
    const bool of_material = known && ag_path_of_material(d->path);
    const ag_array *all = of_material ? &b->p->materials : &b->p->nodes;
    const char *kind = of_material ? "material" : "node";
    const int number = of_material ? d->material : d->node;
    if (!known || number < 0 || number >= (int) all->count) {
        ag_builder_refuse(b, FG_ERR_INVALID, "channel: %s %d or path %d does not exist", kind,
                          number, (int) d->path);
        return false;
    }
    *out = (aim){ .kind = kind, .number = number, .fault = keys_fault(d) };
    if (of_material) {
        out->name = ((const ag_material *) all->data)[number].name;
        out->driven_paths = &((ag_material_drive *) b->p->drives.data)[number].driven_paths;
        if (!out->fault && d->path == AG_PATH_EMISSIVE)
            out->fault = emission_fault(d);
    } else {
        ag_node *node = (ag_node *) all->data + number;
        out->name = node->name;
        out->driven_paths = &node->driven_paths;
        out->fault = node->has_matrix ? "the node has a matrix" : out->fault;
    }
    return true;
}

// ---- what it means for that -------------------------------------------------------------

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
    size_t n = (size_t) ag_path_size(c->path);
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

// The most that the channel reaches of its value's `i`th number. Of a cubic, of the Bezier
// polygon that it lies within.
static float peak(const ag_channel *c, int i)
{
    int n = ag_path_size(c->path);
    bool cubic = c->interpolation == AG_INTERPOLATE_CUBIC;
    double most = 0;
    for (int k = 0; k < c->key_count; k++) {
        const float *v = c->values + (size_t) k * (size_t) n * (cubic ? 3 : 1);
        double value = (double) v[(cubic ? n : 0) + i];
        most = fmax(most, value);
        if (cubic && k > 0)
            most = fmax(most, value - (double) v[i] / 3 *
                                          ((double) c->times[k] - (double) c->times[k - 1]));
        if (cubic && k + 1 < c->key_count)
            most = fmax(most, value + (double) v[2 * n + i] / 3 *
                                          ((double) c->times[k + 1] - (double) c->times[k]));
    }
    return (float) fmin(most, (double) FLT_MAX);
}

static void drive_material(ag_scene_private *p, const ag_channel *c)
{
    ag_material_drive *drive = (ag_material_drive *) p->drives.data + c->target;
    ag_material *m = (ag_material *) p->materials.data + c->target;
    ag_texture_ref *refs[3];
    bool seen = c->path == AG_PATH_EMISSIVE; // an offset of no texture moves nothing
    ag_material_refs(m, refs);
    for (int i = 0; i < 3; i++)
        seen = seen || refs[i]->texture >= 0;
    m->moving = m->moving || (seen && varies(c));
    if (c->path == AG_PATH_UV_OFFSET)
        drive->uv_moves = varies(c);
    for (int i = 0; i < 3 && c->path == AG_PATH_EMISSIVE; i++)
        drive->peak[i] = peak(c, i);
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

// NULL after a refusal.
static const ag_channel *store(ag_builder *b, const ag_channel_desc *desc, int target)
{
    size_t keys = (size_t) desc->key_count, values = keys * (size_t) values_per_key(desc);
    ag_channel *c = ag_builder_push(b, &b->p->channels, sizeof *c, "channels");
    if (!c)
        return NULL;
    *c = (ag_channel){
        .target = target,
        .path = desc->path,
        .interpolation = desc->interpolation,
        .animation = desc->animation,
        .key_count = desc->key_count,
        .times = malloc((keys + values) * sizeof(float)),
    };
    if (c->times) {
        c->values = c->times + keys;
        memcpy(c->times, desc->times, keys * sizeof(float));
        memcpy(c->values, desc->values, values * sizeof(float));
        if (c->path == AG_PATH_ROTATION)
            normalize_rotations(c);
    }
    if (c->times && lengthen(b, c))
        return c;
    ag_builder_refuse(b, FG_ERR_MEMORY, "channels: out of memory");
    return NULL;
}

void ag_builder_channel(ag_builder *b, const ag_channel_desc *desc)
{
    aim at;
    if (!ag_builder_open(b) || !find_aim(b, desc, &at))
        return;
    const char *path = path_names[desc->path];
    if (at.fault) {
        ag_builder_refuse(b, FG_ERR_INVALID, "channel: %s of %s %d '%s': %s", path, at.kind,
                          at.number, at.name, at.fault);
        return;
    }
    if (*at.driven_paths & (1 << desc->path)) {
        ag_builder_warn(b, "channel: %s of %s %d '%s' is driven already; this one is left out",
                        path, at.kind, at.number, at.name);
        return;
    }
    const ag_channel *c = store(b, desc, at.number);
    if (!c)
        return;
    *at.driven_paths |= (uint8_t) (1 << desc->path);
    if (ag_path_of_material(desc->path)) {
        drive_material(b->p, c);
        return;
    }
    ag_node *node = (ag_node *) b->p->nodes.data + at.number;
    node->driven = true;
    node->moving = node->moving || varies(c);
}
