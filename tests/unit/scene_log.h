// SPDX-License-Identifier: MIT
// What the tests of scenes share: a log that remembers, and shapes.
#ifndef SCENE_LOG_H
#define SCENE_LOG_H

#include <pass/scene.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
// cmocka needs those before it.
#include <cmocka.h>

typedef struct lines {
    int errors, warnings, infos;
    char error[1024], warning[1024], info[1024]; // the last of each
} lines;

static inline void remember(void *user, fg_log_level level, const char *msg)
{
    lines *l = user;
    char *to = level == FG_LOG_ERROR ? l->error : level == FG_LOG_WARN ? l->warning : l->info;
    *(level == FG_LOG_ERROR ? &l->errors : level == FG_LOG_WARN ? &l->warnings : &l->infos) += 1;
    snprintf(to, sizeof l->error, "%s", msg);
}

static inline fg_log log_to(lines *l)
{
    *l = (lines){ 0 };
    return (fg_log){ .fn = remember, .user = l, .level = FG_LOG_INFO };
}

static inline void assert_has(const char *text, const char *part)
{
    if (!strstr(text, part))
        fail_msg("'%s' is not in '%s'", part, text);
}

#define assert_near(is, want, tolerance) near_or_fail((double) (is), want, tolerance)

static inline void near_or_fail(double is, double want, double tolerance)
{
    double off = is - want;
    if (!(off <= tolerance && off >= -tolerance))
        fail_msg("is %.9g, should be %.9g within %g", is, want, tolerance);
}

static inline ag_vertex vertex(float x, float y, float z)
{
    return (ag_vertex){ .position = { x, y, z }, .color = { 1, 1, 1, 1 } };
}

// A right triangle in the plane z = 0, counter-clockwise seen from +Z, without normals.
static inline int add_triangle(ag_builder *b, int material)
{
    ag_vertex v[3] = { vertex(0, 0, 0), vertex(1, 0, 0), vertex(0, 1, 0) };
    ag_primitive_desc desc = { .vertices = v, .vertex_count = 3, .material = material };
    return ag_builder_primitive(b, &desc);
}

static inline int add_node(ag_builder *b, int parent, double x, double y, double z)
{
    return ag_builder_node(b, &(ag_node_desc){ .parent = parent, .translation = { x, y, z } });
}

static inline ag_scene *build(ag_builder *b)
{
    ag_scene *scene;
    assert_int_equal(ag_scene_build(b, &scene), FG_OK);
    ag_builder_destroy(b);
    return scene;
}

#endif // SCENE_LOG_H
