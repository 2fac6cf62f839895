// SPDX-License-Identifier: MIT
#ifndef TESTS_SHAPES_H
#define TESTS_SHAPES_H

#include <pass/scene.h>

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Scenes by hand, for tests: parallelograms and spheres at one node.
typedef struct shapes {
    ag_builder *builder;
    int node;
} shapes;

static inline shapes shapes_begin(const fg_log *log)
{
    shapes s = { .builder = ag_builder_create(log, "shapes") };
    s.node = ag_builder_node(s.builder, &(ag_node_desc){ .name = "node", .parent = -1 });
    return s;
}

// NULL where the builder refused something.
static inline ag_scene *shapes_end(shapes *s)
{
    ag_scene *scene = NULL;
    if (ag_scene_build(s->builder, &scene) != FG_OK)
        scene = NULL;
    ag_builder_destroy(s->builder);
    return scene;
}

// A parallelogram from `corner` along `a` and `b`; its front is where a x b points. uv is 0..1
// along a and b. Returns the primitive, shown at `node`.
static inline int shapes_quad(shapes *s, int node, int material, const float corner[3],
                              const float a[3], const float b[3])
{
    ag_vertex v[4];
    const uint32_t order[6] = { 0, 1, 2, 0, 2, 3 };
    memset(v, 0, sizeof v);
    for (int i = 0; i < 4; ++i) {
        const float u = i == 1 || i == 2, w = i >= 2;
        v[i].uv[0][0] = v[i].uv[1][0] = u;
        v[i].uv[0][1] = v[i].uv[1][1] = w;
        for (int k = 0; k < 3; ++k)
            v[i].position[k] = corner[k] + u * a[k] + w * b[k];
        for (int k = 0; k < 4; ++k)
            v[i].color[k] = 1;
    }
    const ag_primitive_desc desc = { .name = "quad",
                                     .vertices = v,
                                     .vertex_count = 4,
                                     .indices = order,
                                     .index_count = 6,
                                     .material = material };
    const int primitive = ag_builder_primitive(s->builder, &desc);
    ag_builder_show(s->builder, node, primitive, -1);
    return primitive;
}

// An axis-aligned box of which the inner faces are the front.
static inline void shapes_room(shapes *s, int material, const float low[3], const float high[3])
{
    for (int axis = 0; axis < 3; ++axis) {
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        float a[3] = { 0 }, b[3] = { 0 }, far_corner[3];
        a[i] = high[i] - low[i];
        b[j] = high[j] - low[j];
        memcpy(far_corner, low, sizeof far_corner);
        far_corner[axis] = high[axis];
        shapes_quad(s, s->node, material, low, a, b);
        shapes_quad(s, s->node, material, far_corner, b, a);
    }
}

// A sphere of `rings` x 2 `rings` facets around the origin with smooth normals that point in,
// as do the fronts. At each pole the facets are triangles.
static inline void shapes_sphere_inside(shapes *s, int material, float radius, int rings)
{
    const int columns = 2 * rings, row = columns + 1;
    ag_vertex *v = calloc((size_t) (row * (rings + 1)), sizeof *v);
    uint32_t *order = calloc((size_t) (6 * columns * rings), sizeof *order);
    size_t count = 0;
    assert(v && order);
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j <= columns; ++j) {
            ag_vertex *at = v + i * row + j;
            const double theta = 3.14159265358979 * i / rings;
            const double phi = 2 * 3.14159265358979 * (j % columns) / columns;
            const double n[3] = { sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi) };
            for (int k = 0; k < 3; ++k) {
                at->position[k] = radius * (float) n[k];
                at->normal[k] = (float) -n[k];
            }
            for (int k = 0; k < 4; ++k)
                at->color[k] = 1;
        }
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < columns; ++j) {
            const uint32_t a = (uint32_t) (i * row + j), b = a + (uint32_t) row;
            const uint32_t two[6] = { a, b, b + 1, a, b + 1, a + 1 };
            if (i < rings - 1)
                memcpy(order + count, two, 3 * sizeof *two), count += 3;
            if (i > 0)
                memcpy(order + count, two + 3, 3 * sizeof *two), count += 3;
        }
    const ag_primitive_desc desc = { .name = "sphere",
                                     .vertices = v,
                                     .vertex_count = (size_t) (row * (rings + 1)),
                                     .indices = order,
                                     .index_count = count,
                                     .material = material };
    ag_builder_show(s->builder, s->node, ag_builder_primitive(s->builder, &desc), -1);
    free(v);
    free(order);
}

// Rough and dielectric: albedo is the grey base colour.
static inline int shapes_diffuse(shapes *s, float albedo, float emission)
{
    ag_material m = ag_default_material();
    for (int k = 0; k < 3; ++k) {
        m.base_color[k] = albedo;
        m.emissive[k] = emission;
    }
    return ag_builder_material(s->builder, &m);
}

// A camera at `eye` that looks at `target`; `up` must not be parallel to the view.
static inline ag_camera shapes_camera(const double eye[3], const double target[3],
                                      const double up[3], double yfov)
{
    ag_camera camera = { .yfov = (float) yfov, .znear = 1e-3f };
    double back[3], right[3], top[3], lengths[2] = { 0 };
    for (int k = 0; k < 3; ++k) {
        back[k] = eye[k] - target[k];
        lengths[0] += back[k] * back[k];
    }
    for (int k = 0; k < 3; ++k)
        back[k] /= sqrt(lengths[0]);
    for (int k = 0; k < 3; ++k) {
        right[k] = up[(k + 1) % 3] * back[(k + 2) % 3] - up[(k + 2) % 3] * back[(k + 1) % 3];
        lengths[1] += right[k] * right[k];
    }
    for (int k = 0; k < 3; ++k)
        right[k] /= sqrt(lengths[1]);
    for (int k = 0; k < 3; ++k)
        top[k] = back[(k + 1) % 3] * right[(k + 2) % 3] - back[(k + 2) % 3] * right[(k + 1) % 3];
    memcpy(camera.world, right, sizeof right);
    memcpy(camera.world + 4, top, sizeof top);
    memcpy(camera.world + 8, back, sizeof back);
    memcpy(camera.world + 12, eye, 3 * sizeof *eye);
    camera.world[15] = 1;
    return camera;
}

#endif // TESTS_SHAPES_H
