// SPDX-License-Identifier: MIT
#include "gpu_scene_priv.h"

#include <pass/math.h>

#include <math.h>
#include <string.h>

// A spot wider than 60 degrees from axis to rim would waste most of one face on its rim.
static const float one_face_cos = 0.5f;

// Walls and floors run along the world's axes, and so would a map's rows if it followed them: a
// whole row at once would then fall on one side of a seam, and the power of a wall be off by half a
// row. Turned by an angle whose tangent, the golden section, no short fraction comes near, rows
// meet seams at every phase and the errors cancel.
static const double turn_cos = 0.85065080835203993, turn_sin = 0.52573111211913361;

// Up is the axis least along `direction`: a stable choice for lights that do not say what is up.
static void axes_of_light(const ag_light *light, double axes[3][3])
{
    static const double origin[3] = { 0 };
    const double d[3] = { (double) light->direction[0], (double) light->direction[1],
                          (double) light->direction[2] };
    int least = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(d[i]) < fabs(d[least]))
            least = i;
    const double up[3] = { least == 0, least == 1, least == 2 };
    double look[16];
    ag_mat_look_to(origin, d, up, look);
    const bool turned = light->kind != AG_LIGHT_DIRECTIONAL; // a turned box would need a larger map
    const double c = turned ? turn_cos : 1, s = turned ? turn_sin : 0;
    for (int i = 0; i < 3; i++) {
        axes[0][i] = c * look[4 * (size_t) i] + s * look[4 * i + 1];
        axes[1][i] = c * look[4 * i + 1] - s * look[4 * (size_t) i];
        axes[2][i] = -look[4 * i + 2];
    }
}

int light_face_count(const ag_light *light)
{
    if (light->kind == AG_LIGHT_DIRECTIONAL)
        return 1;
    if (light->kind == AG_LIGHT_POINT)
        return 6;
    if (light->cosine)
        return 5;
    return light->cos_outer >= one_face_cos ? 1 : light->cos_outer >= 0 ? 5 : 6;
}

// A frustum from `eye` along `forward`, as `proj` has it.
static void set_face(const double eye[3], const double forward[3], const double up[3],
                     const double proj[16], ag_gpu_face *out)
{
    double look[16], clip[16];
    memset(out, 0, sizeof *out);
    ag_mat_look_to(eye, forward, up, look);
    ag_mat_mul(proj, look, clip);
    ag_mat_to_float(clip, out->view_proj);
    for (int i = 0; i < 3; i++) {
        out->right[i] = (float) look[4 * (size_t) i];
        out->up[i] = (float) look[4 * i + 1];
        out->forward[i] = (float) -look[4 * i + 2];
        out->eye[i] = (float) eye[i];
    }
}

// Face 0 looks along the axis, 1 to 4 sideways with the axis up, 5 back.
static void perspective_face(double axes[3][3], const double eye[3], int face, double tangent,
                             double znear, ag_gpu_face *out)
{
    const double *axis = face == 1 || face == 3 ? axes[0] : axes[1];
    const double *up = face == 0 || face == 5 ? axes[1] : axes[2];
    const double sign = face == 0 || face == 1 || face == 2 ? 1 : -1;
    double forward[3], proj[16];
    for (int i = 0; i < 3; i++)
        forward[i] = sign * (face == 0 || face == 5 ? axes[2][i] : axis[i]);
    ag_mat_perspective(2 * atan(tangent), 1, znear, (double) INFINITY, proj);
    set_face(eye, forward, up, proj, out);
    out->right[3] = out->up[3] = (float) tangent;
    out->forward[3] = (float) znear;
}

// Half of how far a box with edges 2 `half` reaches along each axis.
static void extent_along(double axes[3][3], const double half[3], double extent[3])
{
    const double diagonal = sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
    for (int a = 0; a < 3; a++) {
        extent[a] = 0;
        for (int i = 0; i < 3; i++)
            extent[a] += fabs(axes[a][i]) * half[i];
        // A margin for rounding; a flat scene keeps a width.
        extent[a] = extent[a] * 1.001 + 1e-4 * (diagonal > 0 ? diagonal : 1);
    }
}

// Half the edges of the scene's box; 0 of an empty one.
static void half_edges(const ag_scene *scene, double half[3])
{
    for (int i = 0; i < 3; i++)
        half[i] = scene->box_min[0] <= scene->box_max[0]
                      ? 0.5 * (scene->box_max[i] - scene->box_min[i])
                      : 0;
}

void light_cross_section(const ag_scene *scene, const ag_light *light, double half[2])
{
    double axes[3][3], edges[3], extent[3];
    axes_of_light(light, axes);
    half_edges(scene, edges);
    extent_along(axes, edges, extent);
    half[0] = extent[0];
    half[1] = extent[1];
}

// Holds the box, given by its centre and half its edges, as seen along axes[2].
static void orthographic_face(double axes[3][3], const double centre[3], const double half[3],
                              ag_gpu_face *out)
{
    double extent[3], eye[3], proj[16];
    extent_along(axes, half, extent);
    for (int i = 0; i < 3; i++)
        eye[i] = centre[i] - axes[2][i] * extent[2];
    ag_mat_orthographic(extent[0], extent[1], 0, 2 * extent[2], proj);
    set_face(eye, axes[2], axes[1], proj, out);
    out->right[3] = (float) extent[0];
    out->up[3] = (float) extent[1];
    out->forward[3] = (float) (0.5 / extent[2]);
    out->eye[3] = 1;
}

static void light_to_gpu(const ag_light *light, const double eye[3], ag_gpu_light *out)
{
    const float ramp = light->cos_inner - light->cos_outer;
    for (int i = 0; i < 3; i++) {
        out->position[i] = (float) eye[i];
        out->direction[i] = light->direction[i];
        out->intensity[i] = light->intensity[i];
    }
    out->position[3] = 1 / (ramp > 1e-3f ? ramp : 1e-3f);
    out->direction[3] = light->cos_outer;
    out->info[0] = light->kind == AG_LIGHT_POINT         ? AG_GPU_POINT
                   : light->kind == AG_LIGHT_DIRECTIONAL ? AG_GPU_DIRECTIONAL
                   : light->cosine                       ? AG_GPU_COSINE_SPOT
                                                         : AG_GPU_SPOT;
}

// Tangent of the half angle that one face of a light spans.
static double face_tangent(const ag_light *light, int faces)
{
    if (faces > 1)
        return 1;
    const double c = fmin((double) light->cos_outer, 1);
    return fmax(sqrt(1 - c * c) / c, 1e-3); // a spot of no width keeps a frustum
}

void lights_to_gpu(const ag_scene *scene, const double origin[3], ag_gpu_light *lights,
                   ag_gpu_face *faces)
{
    double centre[3] = { 0 }, half[3];
    half_edges(scene, half);
    for (int i = 0; i < 3 && scene->box_min[0] <= scene->box_max[0]; i++)
        centre[i] = 0.5 * (scene->box_min[i] + scene->box_max[i]) - origin[i];
    const double diagonal = 2 * sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
    const double znear = diagonal > 0 ? 1e-5 * diagonal : 1e-5;
    int face = 0;
    for (int l = 0; l < scene->light_count; l++) {
        const ag_light *light = &scene->lights[l];
        const int count = light_face_count(light);
        double axes[3][3], eye[3];
        axes_of_light(light, axes);
        for (int i = 0; i < 3; i++)
            eye[i] = light->position[i] - origin[i];
        memset(&lights[l], 0, sizeof lights[l]);
        light_to_gpu(light, eye, &lights[l]);
        lights[l].info[1] = face;
        lights[l].info[2] = count;
        for (int i = 0; i < count; i++, face++) {
            if (light->kind == AG_LIGHT_DIRECTIONAL)
                orthographic_face(axes, centre, half, &faces[face]);
            else
                perspective_face(axes, eye, i, face_tangent(light, count), znear, &faces[face]);
            faces[face].info[0] = l;
        }
    }
}
