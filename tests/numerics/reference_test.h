// SPDX-License-Identifier: MIT
#ifndef REFERENCE_TEST_H
#define REFERENCE_TEST_H

#include "../shapes.h"
#include "reference.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <stdio.h>

static const double test_pi = 3.14159265358979;
static char test_message[1024];

static inline void test_remember(void *user, fg_log_level level, const char *msg)
{
    (void) user;
    (void) level;
    snprintf(test_message, sizeof test_message, "%s", msg);
}

static const fg_log test_log = { .fn = test_remember, .level = FG_LOG_ERROR };

static inline ag_scene *test_scene(shapes *s)
{
    ag_scene *scene = shapes_end(s);
    if (!scene)
        fail_msg("%s", test_message);
    return scene;
}

static inline image test_render(reference_desc desc, const ag_scene *scene, const ag_camera *camera)
{
    image img;
    desc.log = &test_log;
    desc.scene = scene;
    desc.camera = camera;
    if (reference_render(&desc, &img) != FG_OK)
        fail_msg("%s", test_message);
    return img;
}

static inline double test_value(const image *img, int column, int row, int channel)
{
    return (double) img->rgb[(ptrdiff_t) 3 * (row * img->width + column) + channel];
}

// Of the red channel.
static inline double test_mean(const image *img)
{
    double sum = 0;
    for (int j = 0; j < img->height; ++j)
        for (int i = 0; i < img->width; ++i)
            sum += test_value(img, i, j, 0);
    return sum / (img->width * img->height);
}

static inline void test_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g (+- %.3g)", value, expected, tolerance);
}

// Looks straight down at [0, 1]^2 at height 0 from height `height`; column i and row j of
// n x n pixels see x = (i + 0.5) / n, y = 1 - (j + 0.5) / n.
static inline ag_camera test_camera_down(double height)
{
    return (ag_camera){ .world = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0.5, height, 1 },
                        .orthographic = true,
                        .half_height = 0.5f,
                        .znear = 0,
                        .zfar = 100 };
}

static inline void test_unit_floor(shapes *s, int material)
{
    shapes_quad(s, s->node, material, (float[]){ 0, 0, 0 }, (float[]){ 1, 0, 0 },
                (float[]){ 0, 1, 0 });
}

#endif // REFERENCE_TEST_H
