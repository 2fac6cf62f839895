// SPDX-License-Identifier: MIT
#include "kit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const float tau = 6.28318531f;

static int values_of(ag_path path)
{
    return path == AG_PATH_ROTATION ? 4 : path == AG_PATH_UV_OFFSET ? 2 : 3;
}

void kit_move(kit *k, const kit_motion *m)
{
    const int n = values_of(m->path);
    float *times = malloc((size_t) m->keys * (size_t) (n + 1) * sizeof *times);
    if (!times) {
        k->failed = true;
        return;
    }
    float *values = times + m->keys;
    for (int i = 0; i < m->keys; ++i) {
        const float t = (float) i / (float) (m->keys - 1);
        float out[4] = { 0 };
        m->curve(m->user, t, out);
        times[i] = m->seconds * t;
        memcpy(values + (ptrdiff_t) n * i, out, (size_t) n * sizeof *out);
    }
    const ag_channel_desc channel = { .node = m->node,
                                      .material = m->material,
                                      .path = m->path,
                                      .interpolation = AG_INTERPOLATE_LINEAR,
                                      .key_count = m->keys,
                                      .times = times,
                                      .values = values,
                                      .animation = k->motions++ };
    ag_builder_channel(k->builder, &channel);
    free(times);
}

static void swing(const void *user, float t, float out[4])
{
    const kit_swing_desc *d = user;
    double q[4];
    const float turns = (float) d->count * t + d->phase;
    kit_turn(d->axis, (double) (d->amplitude * sinf(tau * turns)), q);
    for (int i = 0; i < 4; ++i)
        out[i] = (float) q[i];
}

void kit_swing(kit *k, int node, const kit_swing_desc *desc)
{
    const kit_motion m = { .node = node,
                           .path = AG_PATH_ROTATION,
                           .keys = 16 * desc->count + 1,
                           .seconds = desc->seconds,
                           .curve = swing,
                           .user = desc };
    kit_move(k, &m);
}

float kit_oval(float half, float radius, float way, float *const at[2])
{
    const float bend = 0.5f * tau * radius, straight = 2.0f * half,
                length = 2.0f * (bend + straight);
    way -= length * floorf(way / length);
    const bool back = way >= bend + straight;
    way -= back ? bend + straight : 0.0f;
    const float angle = way > straight ? (way - straight) / radius : 0.0f;
    const float along = way < straight ? way : straight;
    // Along +x at -z, then around the end; the other half is the same turned by 180 degrees.
    const float x = along - half + radius * sinf(angle), z = -radius * cosf(angle);
    *at[0] = back ? -x : x;
    *at[1] = back ? -z : z;
    return -0.25f * tau - angle + (back ? 0.5f * tau : 0.0f);
}

// ---- walks ---------------------------------------------------------------------------

enum { STOPS_MAX = 64 };

typedef struct walk {
    const kit_walk_desc *d;
    double at[STOPS_MAX + 1]; // when the camera is at a stop, [0, 1]; the last is the first again
} walk;

static double distance(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

static void time_stops(walk *w)
{
    const int n = w->d->count;
    for (int i = 0; i < n; ++i) {
        const kit_stop *from = &w->d->stops[i], *to = &w->d->stops[(i + 1) % n];
        w->at[i + 1] =
            w->at[i] + distance(from->eye, to->eye) + 0.25 * distance(from->target, to->target);
    }
    for (int i = 1; i <= n; ++i)
        w->at[i] /= w->at[n];
}

// The stop before or after the round as well: when, as if the round went on.
static double stop_time(const walk *w, int i)
{
    const int n = w->d->count;
    return i < 0 ? w->at[i + n] - 1.0 : i > n ? 1.0 + w->at[i - n] : w->at[i];
}

static const double *stop_point(const walk *w, int i, bool target)
{
    const int n = w->d->count;
    const kit_stop *s = &w->d->stops[(i + n) % n];
    return target ? s->target : s->eye;
}

// A cubic between two stops, at each of them as fast as a straight line between its neighbours.
static void follow(const walk *w, float t, bool target, double out[3])
{
    int i = 0;
    while (i + 1 < w->d->count && w->at[i + 1] <= (double) t)
        ++i;
    const double step = w->at[i + 1] - w->at[i], s = ((double) t - w->at[i]) / step;
    const double s2 = s * s, s3 = s2 * s;
    const double *p[4];
    for (int j = 0; j < 4; ++j)
        p[j] = stop_point(w, i - 1 + j, target);
    const double before = stop_time(w, i + 1) - stop_time(w, i - 1);
    const double after = stop_time(w, i + 2) - stop_time(w, i);
    for (int k = 0; k < 3; ++k) {
        const double m0 = step * (p[2][k] - p[0][k]) / before;
        const double m1 = step * (p[3][k] - p[1][k]) / after;
        out[k] = (2 * s3 - 3 * s2 + 1) * p[1][k] + (s3 - 2 * s2 + s) * m0 +
                 (3 * s2 - 2 * s3) * p[2][k] + (s3 - s2) * m1;
    }
}

static void walk_eye(const void *user, float t, float out[4])
{
    double eye[3];
    follow(user, t, false, eye);
    for (int k = 0; k < 3; ++k)
        out[k] = (float) eye[k];
}

static void walk_aim(const void *user, float t, float out[4])
{
    double eye[3], target[3], direction[3];
    follow(user, t, false, eye);
    follow(user, t, true, target);
    for (int k = 0; k < 3; ++k)
        direction[k] = target[k] - eye[k];
    kit_aim_curve(direction, out);
}

void kit_walk(kit *k, const kit_walk_desc *desc)
{
    walk w = { .d = desc };
    ag_camera camera = ag_default_camera();
    camera.yfov = desc->yfov;
    strncpy(camera.name, desc->name, sizeof camera.name - 1);
    time_stops(&w);
    const int node = kit_node(k, desc->name, -1, (place){ 0 });
    kit_motion m = { .node = node,
                     .path = AG_PATH_TRANSLATION,
                     .keys = 12 * (int) desc->seconds + 1,
                     .seconds = desc->seconds,
                     .curve = walk_eye,
                     .user = &w };
    kit_move(k, &m);
    m.path = AG_PATH_ROTATION;
    m.curve = walk_aim;
    kit_move(k, &m);
    ag_builder_camera(k->builder, node, &camera);
}
