// SPDX-License-Identifier: MIT
// The built-in scenes hold what they promise.
#include "test_builtin.h"

#include <pass/surface.h>
#include <scenes.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Calls `check` on every built-in scene.
static void for_all(void (*check)(const char *name, ag_scene *scene))
{
    for (int i = 0; scenes_builtin(i); ++i) {
        ag_scene *scene = open_scene(scenes_builtin(i)->name);
        check(scenes_builtin(i)->name, scene);
        ag_scene_destroy(scene);
    }
}

// ---- all ------------------------------------------------------------------------

static void table_ends_in_null(void **state)
{
    (void) state;
    int count = 0;
    while (scenes_builtin(count))
        ++count;
    assert_true(count >= 2);
    assert_string_equal(scenes_builtin(0)->name, "cornell");
    assert_string_equal(scenes_builtin(1)->name, "atrium");
    for (int i = 0; i < count; ++i) {
        assert_true(strlen(scenes_builtin(i)->purpose) > 10);
        assert_null(strchr(scenes_builtin(i)->purpose, '\n'));
    }
    assert_null(scenes_builtin(count));
    assert_null(scenes_builtin(-1));
}

static void check_sound(const char *name, ag_scene *s)
{
    assert_string_equal(s->name, name);
    assert_int_equal(s->warning_count, 0);
    for (int i = 0; i < s->primitive_count; ++i) {
        const mesh m = primitive_mesh(s, i);
        if (mesh_faces_against_normals(&m) || mesh_worst_normal(&m) > 1e-5)
            fail_msg("%s: primitive %d (%s) winds against its normals", name, i,
                     s->materials[s->primitives[i].material].name);
    }
    for (int i = 0; i < s->instance_count; ++i)
        assert_false(s->instances[i].mirrored);
}

static void faces_wind_as_their_normals_say_and_nothing_was_repaired(void **state)
{
    (void) state;
    for_all(check_sound);
}

static void check_features(const char *name, ag_scene *s)
{
    for (int i = 0; scenes_builtin(i); ++i)
        if (!strcmp(scenes_builtin(i)->name, name) && scenes_builtin(i)->features != s->features)
            fail_msg("%s: has the features %#llx, its table says %#llx", name,
                     (unsigned long long) s->features,
                     (unsigned long long) scenes_builtin(i)->features);
}

static void the_table_knows_the_features(void **state)
{
    (void) state;
    for_all(check_features);
}

static void assert_same(const char *what, const void *a, const void *b, size_t size)
{
    if (memcmp(a, b, size) != 0)
        fail_msg("%s differ between two builds", what);
}

static void check_same_twice(const char *name, ag_scene *a)
{
    ag_scene *b = open_scene(name);
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->index_count, b->index_count);
    assert_int_equal(a->instance_count, b->instance_count);
    assert_int_equal(a->texture_count, b->texture_count);
    assert_same("vertices", a->vertices, b->vertices, a->vertex_count * sizeof *a->vertices);
    assert_same("indices", a->indices, b->indices, a->index_count * sizeof *a->indices);
    for (int i = 0; i < a->instance_count; ++i)
        assert_same("worlds", a->instances[i].world, b->instances[i].world,
                    sizeof b->instances[i].world);
    for (int i = 0; i < a->texture_count; ++i)
        assert_same("textures", a->textures[i].rgba, b->textures[i].rgba,
                    (size_t) a->textures[i].width * (size_t) a->textures[i].height * 4);
    assert_same("light", a->lights[0].position, b->lights[0].position,
                sizeof b->lights[0].position);
    ag_scene_destroy(b);
}

static void two_builds_are_equal_byte_for_byte(void **state)
{
    (void) state;
    for_all(check_same_twice);
}

// ---- what the cameras see ------------------------------------------------------------

// The ray through (x, y) of the picture, both in (-1, 1).
static void camera_ray(const ag_camera *c, double x, double y, double from[3], double direction[3])
{
    const double t = tan(0.5 * (double) c->yfov);
    double d[3];
    for (int k = 0; k < 3; ++k) {
        from[k] = c->world[12 + k];
        d[k] = t * x * c->world[k] + t * y * c->world[4 + k] - c->world[8 + k];
    }
    const double length = length3(d);
    for (int k = 0; k < 3; ++k)
        direction[k] = d[k] / length;
}

// Of 5 x 5 rays of the camera, how many meet something within 100 m.
static int rays_that_hit(const soup *w, const ag_camera *c)
{
    int hits = 0;
    for (int k = 0; k < 25; ++k) {
        const int row = k / 5;
        double from[3], direction[3];
        camera_ray(c, 0.4 * (k % 5 - 2), 0.4 * (row - 2), from, direction);
        const double t = soup_nearest(w, from, direction, 1e9);
        hits += t < 100.0;
        if (t < (double) c->znear)
            fail_msg("camera %s stands in something", c->name);
    }
    return hits;
}

static void check_cameras(const char *name, ag_scene *s)
{
    const soup w = soup_of(s);
    assert_true(s->camera_count >= 3);
    for (int i = 0; i < s->camera_count; ++i) {
        const ag_camera *c = &s->cameras[i];
        const int hits = rays_that_hit(&w, c);
        if (hits < 18) // of 25: at most a strip of sky
            fail_msg("%s: camera %s sees something on %d of 25 rays", name, c->name, hits);
        assert_int_equal(ag_scene_find_camera(s, c->name), i);
    }
    free(w.corners);
}

static void every_camera_looks_at_the_scene(void **state)
{
    (void) state;
    for_all(check_cameras);
}

// Of 12 x 12 rays of the first camera: how many meet something, and how many of those points some
// light worth speaking of reaches.
static void lit_share(const ag_scene *s, int *seen, int *lit)
{
    const soup w = soup_of(s);
    *seen = *lit = 0;
    for (int k = 0; k < 144; ++k) {
        double from[3], direction[3], at[3];
        const int row = k / 12;
        camera_ray(&s->cameras[0], (k % 12 - 5.5) / 6.0, (row - 5.5) / 6.0, from, direction);
        const double t = soup_nearest(&w, from, direction, 1e6);
        if (t >= 1e6)
            continue;
        ++*seen;
        for (int i = 0; i < 3; ++i)
            at[i] = from[i] + (t - 1e-4) * direction[i];
        *lit += scene_lit(s, &w, at, 0.25f);
    }
    free(w.corners);
}

static void check_lit(const char *name, ag_scene *s)
{
    int seen, lit;
    lit_share(s, &seen, &lit);
    // Enough direct light for a picture, enough shadow for indirect light to show.
    if (lit < seen / 5 || lit > seen * 4 / 5)
        fail_msg("%s: light reaches %d of %d points", name, lit, seen);
}

static void light_reaches_a_good_part_of_the_first_view(void **state)
{
    (void) state;
    for_all(check_lit);
}

// The mean of the texture times the material's colour, linear.
static void mean_albedo(const ag_scene *s, const ag_material *m, double out[3])
{
    double weight = 0.0;
    memset(out, 0, 3 * sizeof *out);
    for (int i = 0; i < 64 * 64; ++i) {
        const int row = i / 64;
        const float u = ((float) (i % 64) + 0.5f) / 64.0f, v = ((float) row + 0.5f) / 64.0f;
        const float uv[2][2] = { { u, v } };
        const float white[4] = { 1, 1, 1, 1 };
        ag_surface surface;
        if (ag_surface_masked(s, m, uv, white))
            continue;
        ag_surface_eval(s, m, uv, white, &surface);
        weight += 1.0;
        for (int k = 0; k < 3; ++k)
            out[k] += (double) surface.albedo[k];
    }
    for (int k = 0; k < 3; ++k)
        out[k] /= weight;
}

static void check_albedo(const char *name, ag_scene *s)
{
    for (int i = 0; i < s->material_count; ++i) {
        double a[3];
        mean_albedo(s, &s->materials[i], a);
        const double y = 0.2126 * a[0] + 0.7152 * a[1] + 0.0722 * a[2];
        const double top = fmax(a[0], fmax(a[1], a[2]));
        // What paint, stone, wood and cloth have.
        if (y < 0.08 || top > 0.8)
            fail_msg("%s: %s has albedo %.2f %.2f %.2f", name, s->materials[i].name, a[0], a[1],
                     a[2]);
    }
}

static void albedos_are_those_of_real_surfaces(void **state)
{
    (void) state;
    for_all(check_albedo);
}

// ---- what moves ----------------------------------------------------------------------

static void check_moves(const char *name, ag_scene *s)
{
    const uint64_t both = AG_FEATURE_MOVING_LIGHT | AG_FEATURE_MOVING_GEOMETRY;
    const int path = ag_scene_find_camera(s, "path");
    if ((s->features & both) != both)
        fail_msg("%s: has no moving light or no moving part", name);
    assert_false(s->cameras[0].moving);
    assert_true(path > 0);
    assert_true(s->cameras[path].moving);
    assert_true(s->duration >= 4.0 && s->duration <= 120.0);
}

static void every_scene_has_a_camera_a_light_and_parts_that_move(void **state)
{
    (void) state;
    for_all(check_moves);
}

// The path camera at `count` even times of its round, which is as long as the whole animation.
static void sample_path(ag_scene *s, double (*at)[3], int count)
{
    const int path = ag_scene_find_camera(s, "path");
    for (int i = 0; i < count; ++i) {
        ag_scene_set_time(s, s->duration * i / (count - 1) * (1.0 - 1e-9));
        memcpy(at[i], s->cameras[path].world + 12, sizeof at[i]);
    }
    ag_scene_set_time(s, 0.0);
}

// It goes through nothing, keeps off what stands around, is never faster than a run and ends where
// it began.
static void check_path(const char *name, ag_scene *s)
{
    enum { COUNT = 193 };
    double at[COUNT][3];
    sample_path(s, at, COUNT);
    const soup w = soup_of(s);
    for (int i = 0; i + 1 < COUNT; ++i) {
        double step[3];
        for (int k = 0; k < 3; ++k)
            step[k] = at[i + 1][k] - at[i][k];
        const double length = length3(step);
        if (length * (COUNT - 1) / s->duration > 4.0)
            fail_msg("%s: the camera goes at %g m/s", name, length * (COUNT - 1) / s->duration);
        // Ahead of the step, too: nothing nearer than the near plane.
        const double ahead = 1.0 + (double) s->cameras[0].znear / fmax(length, 1e-6);
        if (soup_nearest(&w, at[i], step, ahead) < ahead)
            fail_msg("%s: the path goes through something at %.2f %.2f %.2f", name, at[i][0],
                     at[i][1], at[i][2]);
    }
    for (int k = 0; k < 3; ++k)
        assert_true(fabs(at[0][k] - at[COUNT - 1][k]) < 1e-3);
    free(w.corners);
}

static void every_path_is_clear_and_comes_back(void **state)
{
    (void) state;
    for_all(check_path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_ends_in_null),
        cmocka_unit_test(faces_wind_as_their_normals_say_and_nothing_was_repaired),
        cmocka_unit_test(the_table_knows_the_features),
        cmocka_unit_test(every_scene_has_a_camera_a_light_and_parts_that_move),
        cmocka_unit_test(every_path_is_clear_and_comes_back),
        cmocka_unit_test(two_builds_are_equal_byte_for_byte),
        cmocka_unit_test(every_camera_looks_at_the_scene),
        cmocka_unit_test(light_reaches_a_good_part_of_the_first_view),
        cmocka_unit_test(albedos_are_those_of_real_surfaces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
