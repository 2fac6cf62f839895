// SPDX-License-Identifier: MIT
#include "scene_priv.h"

#include <math.h>
#include <pass/math.h>
#include <string.h>

bool ag_path_of_material(ag_path path)
{
    return path == AG_PATH_EMISSIVE || path == AG_PATH_UV_OFFSET;
}

int ag_path_size(ag_path path)
{
    return path == AG_PATH_ROTATION ? 4 : path == AG_PATH_UV_OFFSET ? 2 : 3;
}

// The last key at or before `t`; t is within the keys.
static int key_before(const ag_channel *c, float t)
{
    int low = 0, high = c->key_count - 1;
    while (low < high) {
        int middle = (low + high + 1) / 2;
        if (c->times[middle] <= t)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

static void load(const float *v, int n, double out[4])
{
    for (int i = 0; i < n; i++)
        out[i] = (double) v[i];
}

// Hermite spline of glTF's CUBICSPLINE: tangents are per second.
static void cubic(const ag_channel *c, int key, int n, double s, double out[4])
{
    double step = (double) c->times[key + 1] - (double) c->times[key];
    const float *k0 = c->values + (size_t) key * 3 * (size_t) n, *k1 = k0 + 3 * (size_t) n;
    double s2 = s * s, s3 = s2 * s;
    for (int i = 0; i < n; i++) {
        double p0 = (double) k0[n + i], m0 = step * (double) k0[2 * n + i];
        double p1 = (double) k1[n + i], m1 = step * (double) k1[i];
        out[i] = (2 * s3 - 3 * s2 + 1) * p0 + (s3 - 2 * s2 + s) * m0 + (3 * s2 - 2 * s3) * p1 +
                 (s3 - s2) * m1;
    }
}

static void between(const ag_channel *c, int key, int n, double seconds, double out[4])
{
    double t0 = (double) c->times[key], t1 = (double) c->times[key + 1];
    double s = (seconds - t0) / (t1 - t0), a[4], b[4];
    if (c->interpolation == AG_INTERPOLATE_CUBIC) {
        cubic(c, key, n, s, out);
        return;
    }
    load(c->values + (size_t) key * (size_t) n, n, a);
    load(c->values + (size_t) (key + 1) * (size_t) n, n, b);
    if (c->path == AG_PATH_ROTATION)
        ag_quat_slerp(a, b, s, out);
    else
        for (int i = 0; i < n; i++)
            out[i] = a[i] + s * (b[i] - a[i]);
}

void ag_channel_sample(const ag_channel *c, double seconds, double out[4])
{
    int n = ag_path_size(c->path), last = c->key_count - 1;
    size_t stride = (size_t) n * (c->interpolation == AG_INTERPOLATE_CUBIC ? 3 : 1);
    size_t middle = c->interpolation == AG_INTERPOLATE_CUBIC ? (size_t) n : 0;
    // Held before the first key and from the last one on.
    bool early = seconds <= (double) c->times[0], late = seconds >= (double) c->times[last];
    int key = early ? 0 : late ? last : key_before(c, (float) seconds);
    // Rounding to float may have reached the next key.
    if (!early && (double) c->times[key] > seconds)
        key--;
    if (early || late || c->interpolation == AG_INTERPOLATE_STEP)
        load(c->values + (size_t) key * stride + middle, n, out);
    else
        between(c, key, n, seconds, out);
    if (c->path != AG_PATH_ROTATION)
        return;
    double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2] + out[3] * out[3]);
    for (int i = 0; i < 4; i++)
        out[i] = length > 0 ? out[i] / length : i == 3;
}

static void pose_node(ag_trs *pose, ag_path path, const double value[4])
{
    if (path == AG_PATH_TRANSLATION)
        memcpy(pose->translation, value, sizeof pose->translation);
    else if (path == AG_PATH_ROTATION)
        memcpy(pose->rotation, value, sizeof pose->rotation);
    else
        memcpy(pose->scale, value, sizeof pose->scale);
}

static void pose_material(ag_material_drive *drive, ag_path path, const double value[4])
{
    if (path == AG_PATH_EMISSIVE)
        memcpy(drive->emissive, value, sizeof drive->emissive);
    else
        memcpy(drive->offset, value, sizeof drive->offset);
}

void ag_animate(ag_scene_private *p, double seconds)
{
    ag_node *nodes = p->nodes.data;
    ag_material_drive *drives = p->drives.data;
    const ag_channel *channels = p->channels.data;
    const double *lengths = p->lengths.data;
    for (size_t i = 0; i < p->channels.count; i++) {
        const ag_channel *c = &channels[i];
        double length = lengths[c->animation], value[4];
        ag_channel_sample(c, length > 0 ? fmod(seconds, length) : 0, value);
        if (ag_path_of_material(c->path))
            pose_material(&drives[c->target], c->path, value);
        else
            pose_node(&nodes[c->target].pose, c->path, value);
    }
}
