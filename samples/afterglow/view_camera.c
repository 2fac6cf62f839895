// SPDX-License-Identifier: MIT
#include "view_camera.h"

#include "view_keys.h"

#include <math.h>
#include <string.h>

static const double steepest = 0.49 * M_PI;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void forward(const view_camera *c, double out[3])
{
    out[0] = -sin(c->yaw) * cos(c->pitch);
    out[1] = sin(c->pitch);
    out[2] = -cos(c->yaw) * cos(c->pitch);
}

void view_camera_take(view_camera *c, const ag_camera *from)
{
    const double *back = from->world + 8, *up = from->world + 4;
    c->lens = *from;
    c->lens.moving = false;
    memcpy(c->eye, from->world + 12, sizeof c->eye);
    c->pitch = asin(fmax(-1, fmin(1, -back[1])));
    if (fabs(back[1]) < 0.9999)
        c->yaw = atan2(back[0], back[2]);
    else // straight up or down: the top of the picture says where ahead is
        c->yaw = back[1] > 0 ? atan2(-up[0], -up[2]) : atan2(up[0], up[2]);
    c->pitch = fmax(-steepest, fmin(steepest, c->pitch));
}

ag_camera view_camera_get(const view_camera *c)
{
    ag_camera camera = c->lens;
    double ahead[3];
    forward(c, ahead);
    const double right[3] = { cos(c->yaw), 0, -sin(c->yaw) };
    const double up[3] = { right[2] * -ahead[1], right[2] * ahead[0] - right[0] * ahead[2],
                           right[0] * ahead[1] };
    memset(camera.world, 0, sizeof camera.world);
    for (int i = 0; i < 3; ++i) {
        camera.world[i] = right[i];
        camera.world[4 + i] = up[i];
        camera.world[8 + i] = -ahead[i];
        camera.world[12 + i] = c->eye[i];
    }
    camera.world[15] = 1;
    return camera;
}

void view_camera_point(const view_camera *c, double point[3])
{
    double ahead[3];
    forward(c, ahead);
    for (int i = 0; i < 3; ++i)
        point[i] = c->eye[i] + c->distance * ahead[i];
}

// Puts the eye where it sees `point` in the middle, `distance` away.
static void stand_off(view_camera *c, const double point[3])
{
    double ahead[3];
    forward(c, ahead);
    for (int i = 0; i < 3; ++i)
        c->eye[i] = point[i] - c->distance * ahead[i];
}

void view_camera_turn(view_camera *c, double left, double up)
{
    double point[3];
    view_camera_point(c, point);
    c->yaw = remainder(c->yaw + left, 2 * M_PI);
    c->pitch = fmax(-steepest, fmin(steepest, c->pitch + up));
    if (c->orbiting)
        stand_off(c, point);
}

bool view_camera_move(view_camera *c, unsigned keys, double seconds)
{
    const double side = (keys & VIEW_MOVE_RIGHT ? 1 : 0) - (keys & VIEW_MOVE_LEFT ? 1 : 0);
    const double rise = (keys & VIEW_MOVE_UP ? 1 : 0) - (keys & VIEW_MOVE_DOWN ? 1 : 0);
    const double ahead = (keys & VIEW_MOVE_FORWARD ? 1 : 0) - (keys & VIEW_MOVE_BACK ? 1 : 0);
    const double length = sqrt(side * side + rise * rise + ahead * ahead);
    if (!(length > 0))
        return false;
    const double step = c->speed * (keys & VIEW_MOVE_FAST ? 4 : 1) * seconds / length;
    double along[3];
    forward(c, along);
    c->eye[0] += step * (ahead * along[0] + side * cos(c->yaw));
    c->eye[1] += step * (ahead * along[1] + rise);
    c->eye[2] += step * (ahead * along[2] - side * sin(c->yaw));
    return true;
}

void view_camera_wheel(view_camera *c, double steps)
{
    double point[3];
    view_camera_point(c, point);
    const double factor = pow(1.1, steps);
    if (!c->orbiting) {
        c->speed = fmax(1e-3, fmin(1e6, c->speed * factor));
        return;
    }
    c->distance = fmax(1e-3, fmin(1e9, c->distance / factor));
    stand_off(c, point);
}

void view_camera_orbit(view_camera *c, double distance)
{
    c->orbiting = true;
    c->distance = distance > 1e-3 ? distance : 1e-3;
}

// ---- what is in the middle -------------------------------------------------------------------

typedef struct ray {
    double from[3], along[3];
} ray;

// The ray in the space of a matrix without perspective: distances keep their measure.
static ray to_local(const ray *r, const double m[16])
{
    const double a[3] = { m[0], m[1], m[2] }, b[3] = { m[4], m[5], m[6] };
    const double c[3] = { m[8], m[9], m[10] };
    const double bc[3] = { b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2],
                           b[0] * c[1] - b[1] * c[0] };
    const double ca[3] = { c[1] * a[2] - c[2] * a[1], c[2] * a[0] - c[0] * a[2],
                           c[0] * a[1] - c[1] * a[0] };
    const double ab[3] = { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                           a[0] * b[1] - a[1] * b[0] };
    const double det = dot(a, bc);
    const double from[3] = { r->from[0] - m[12], r->from[1] - m[13], r->from[2] - m[14] };
    if (!(fabs(det) > 0))
        return (ray){ { 0 }, { 0 } }; // flat: it has no inside to be hit in
    return (ray){
        { dot(bc, from) / det, dot(ca, from) / det, dot(ab, from) / det },
        { dot(bc, r->along) / det, dot(ca, r->along) / det, dot(ab, r->along) / det },
    };
}

// Moeller and Trumbore. Returns the distance in units of |along|, or `far`.
static double meet(const ray *r, const ag_vertex *v[3], double far)
{
    double e1[3], e2[3], s[3];
    for (int i = 0; i < 3; ++i) {
        e1[i] = (double) v[1]->position[i] - (double) v[0]->position[i];
        e2[i] = (double) v[2]->position[i] - (double) v[0]->position[i];
        s[i] = r->from[i] - (double) v[0]->position[i];
    }
    const double p[3] = { r->along[1] * e2[2] - r->along[2] * e2[1],
                          r->along[2] * e2[0] - r->along[0] * e2[2],
                          r->along[0] * e2[1] - r->along[1] * e2[0] };
    const double q[3] = { s[1] * e1[2] - s[2] * e1[1], s[2] * e1[0] - s[0] * e1[2],
                          s[0] * e1[1] - s[1] * e1[0] };
    const double det = dot(e1, p);
    if (!(fabs(det) > 0))
        return far;
    const double u = dot(s, p) / det, w = dot(r->along, q) / det, t = dot(e2, q) / det;
    return u >= 0 && w >= 0 && u + w <= 1 && t > 0 && t < far ? t : far;
}

double view_camera_pick(const ag_scene *scene, const ag_camera *camera)
{
    const ray world = {
        { camera->world[12], camera->world[13], camera->world[14] },
        { -camera->world[8], -camera->world[9], -camera->world[10] },
    };
    double nearest = HUGE_VAL;
    for (int i = 0; i < scene->instance_count; ++i) {
        const ag_primitive *p = &scene->primitives[scene->instances[i].primitive];
        const ag_vertex *vertices = scene->vertices + p->first_vertex;
        const uint32_t *index = scene->indices + p->first_index;
        const ray r = p->skinned ? world : to_local(&world, scene->instances[i].world);
        for (uint32_t k = 0; k < p->index_count; k += 3) {
            const ag_vertex *corner[3] = { vertices + index[k], vertices + index[k + 1],
                                           vertices + index[k + 2] };
            nearest = meet(&r, corner, nearest);
        }
    }
    return nearest < HUGE_VAL ? nearest : 0;
}
