// SPDX-License-Identifier: MIT
// The built-in scenes hold what they promise.
#include "test_mesh.h"

#include <pass/surface.h>
#include <scenes.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct record {
    int errors, others;
    char last[1024];
} record;

static void remember(void *user, fg_log_level level, const char *msg)
{
    record *r = user;
    r->errors += level == FG_LOG_ERROR;
    r->others += level != FG_LOG_ERROR;
    snprintf(r->last, sizeof r->last, "%s", msg);
}

static ag_scene *open_scene(const char *name)
{
    record r = { 0 };
    const fg_log log = { .fn = remember, .user = &r, .level = FG_LOG_INFO };
    ag_scene *scene = NULL;
    const fg_status status = scenes_open(&log, name, &scene);
    if (status != FG_OK)
        fail_msg("%s: %s", name, r.last);
    assert_int_equal(r.errors + r.others, 0);
    return scene;
}

// Calls `check` on every built-in scene.
static void for_all(void (*check)(const char *name, ag_scene *scene))
{
    for (int i = 0; scenes_builtin(i); ++i) {
        ag_scene *scene = open_scene(scenes_builtin(i)->name);
        check(scenes_builtin(i)->name, scene);
        ag_scene_destroy(scene);
    }
}

static mesh primitive_mesh(const ag_scene *s, int i)
{
    const ag_primitive *p = &s->primitives[i];
    return (mesh){ s->vertices + p->first_vertex, p->vertex_count, s->indices + p->first_index,
                   p->index_count };
}

// ---- both ------------------------------------------------------------------------

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

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The ray through (x, y) of the picture, both in (-1, 1).
static void camera_ray(const ag_camera *c, double x, double y, double from[3], double direction[3])
{
    const double t = tan(0.5 * (double) c->yfov);
    double d[3];
    for (int k = 0; k < 3; ++k) {
        from[k] = c->world[12 + k];
        d[k] = t * x * c->world[k] + t * y * c->world[4 + k] - c->world[8 + k];
    }
    const double length = sqrt(dot(d, d));
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
        const double length = sqrt(dot(step, step));
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

// ---- cornell -----------------------------------------------------------------------

// Whether `p`, in metres, is the point `mm`.
static bool is_corner(const float p[3], const float mm[3])
{
    bool same = true;
    for (int k = 0; k < 3; ++k)
        same = same && fabsf(p[k] - mm[k] / 1000.0f) < 1e-6f;
    return same;
}

static void cornell_has_the_published_coordinates(void **state)
{
    (void) state;
    // All distinct corners of the room, the short block and the tall one; millimetres.
    static const float corners[][3] = {
        { 552.8f, 0, 0 },      { 0, 0, 0 },           { 0, 0, 559.2f },
        { 549.6f, 0, 559.2f }, { 556.0f, 548.8f, 0 }, { 556.0f, 548.8f, 559.2f },
        { 0, 548.8f, 559.2f }, { 0, 548.8f, 0 },      { 130, 165, 65 },
        { 82, 165, 225 },      { 240, 165, 272 },     { 290, 165, 114 },
        { 130, 0, 65 },        { 82, 0, 225 },        { 240, 0, 272 },
        { 290, 0, 114 },       { 423, 330, 247 },     { 265, 330, 296 },
        { 314, 330, 456 },     { 472, 330, 406 },     { 423, 0, 247 },
        { 265, 0, 296 },       { 314, 0, 456 },       { 472, 0, 406 },
    };
    ag_scene *s = open_scene("cornell");
    int seen[FG_COUNT(corners)] = { 0 };
    const ag_primitive *last = &s->primitives[s->primitive_count - 1]; // moves: see below
    for (size_t v = 0; v < last->first_vertex; ++v) {
        int which = -1;
        for (int i = 0; i < FG_COUNT(corners) && which < 0; ++i)
            which = is_corner(s->vertices[v].position, corners[i]) ? i : -1;
        if (which < 0)
            fail_msg("vertex %zu is at no published corner", v);
        ++seen[which];
    }
    for (int i = 0; i < FG_COUNT(corners); ++i)
        assert_true(seen[i] > 0);
    // 5 sides and 2 x 5 faces of blocks.
    assert_int_equal(scene_triangles(s) - last->index_count / 3, 30);
    ag_scene_destroy(s);
}

// The tall block's corners are at 330 mm; what rises out of it is inside of it at time 0, and is
// all that moves.
static void cornell_rests_as_published_and_an_inner_block_rises_later(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    const int last = s->instance_count - 1;
    const ag_primitive *inner = &s->primitives[s->instances[last].primitive];
    const ag_primitive *tall = &s->primitives[s->instances[last - 1].primitive];
    for (int i = 0; i <= last; ++i)
        assert_int_equal(s->instances[i].moving, i == last);
    for (int k = 0; k < 16; ++k)
        assert_true(s->instances[last].world[k] == (k % 5 ? 0.0 : 1.0));
    for (int k = 0; k < 3; ++k) {
        assert_true(inner->box_min[k] > tall->box_min[k]);
        assert_true(inner->box_max[k] < tall->box_max[k]);
    }
    ag_scene_set_time(s, 10.0);
    const double top = (double) inner->box_max[1] + s->instances[last].world[13];
    const double foot = (double) inner->box_min[1] + s->instances[last].world[13];
    assert_true(top > (double) tall->box_max[1] + 0.05 && foot < (double) tall->box_max[1]);
    ag_scene_destroy(s);
}

static void cornell_lamp_goes_in_a_circle_below_the_ceiling(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    const double rest[3] = { 0.278, 0.5478, 0.2795 };
    assert_memory_equal(s->lights[0].position, rest, sizeof rest); // to the bit
    ag_scene_set_time(s, 4.0);                                     // half way round
    assert_true(fabs(s->lights[0].position[0] - (rest[0] - 2 * 0.0695)) < 1e-6);
    assert_true(fabs(s->lights[0].position[2] - rest[2]) < 1e-6);
    for (int i = 0; i < 16; ++i) {
        ag_scene_set_time(s, 0.5 * i);
        assert_true(s->lights[0].position[1] == rest[1]);
        assert_float_equal(s->lights[0].direction[1], -1.0f, 0.0f);
    }
    ag_scene_destroy(s);
}

static void cornell_camera_is_the_published_one(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    const ag_camera *c = &s->cameras[0];
    assert_string_equal(c->name, "front");
    // 35 mm lens, 25 mm film: 39.3 degrees.
    assert_true(fabs((double) c->yfov - 2.0 * atan(12.5 / 35.0)) < 1e-6);
    const double want[3] = { 0.278, 0.273, -0.8 }, forward[3] = { 0, 0, 1 };
    for (int k = 0; k < 3; ++k) {
        assert_true(fabs(c->world[12 + k] - want[k]) < 1e-12);
        assert_true(fabs(c->world[8 + k] + forward[k]) < 1e-12);
    }
    ag_scene_destroy(s);
}

static void cornell_walls_face_the_room(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    const double middle[3] = { 0.278, 0.45, 0.28 };    // above both blocks
    for (int i = 0; i + 1 < s->primitive_count; ++i) { // but the one that moves
        const mesh m = primitive_mesh(s, i);
        for (size_t k = 0; k < m.vertex_count && m.index_count == 6; ++k) {
            double side = 0.0;
            for (int j = 0; j < 3; ++j)
                side += (double) m.vertices[k].normal[j] *
                        (middle[j] - (double) m.vertices[k].position[j]);
            assert_true(side > 0.0);
        }
        if (m.index_count == 30) // a block: open below, so its volume is measured from the floor
            assert_true(mesh_volume(&m) > 0.001);
    }
    ag_scene_destroy(s);
}

static void cornell_is_open_in_front_alone(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    const soup w = soup_of(s);
    const double from[3] = { 0.278, 0.45, 0.28 };
    static const double ways[6][3] = { { 1, 0, 0 },  { -1, 0, 0 }, { 0, 1, 0 },
                                       { 0, -1, 0 }, { 0, 0, 1 },  { 0, 0, -1 } };
    for (int i = 0; i < 6; ++i)
        assert_int_equal(soup_nearest(&w, from, ways[i], 1e9) >= 1e9, i == 5);
    free(w.corners);
    ag_scene_destroy(s);
}

static void cornell_lamp_is_a_spot_below_the_ceiling(void **state)
{
    (void) state;
    ag_scene *s = open_scene("cornell");
    assert_int_equal(s->light_count, 1);
    const ag_light *l = &s->lights[0];
    assert_int_equal(l->kind, AG_LIGHT_SPOT);
    assert_float_equal(l->direction[1], -1.0f, 1e-6f);
    assert_true(l->position[1] < 0.5488 && l->position[1] > 0.54);
    // In the published lamp's opening.
    assert_true(l->position[0] > 0.213 && l->position[0] < 0.343);
    assert_true(l->position[2] > 0.227 && l->position[2] < 0.332);
    assert_true(l->cos_inner > l->cos_outer && l->cos_outer > 0.0f);
    ag_scene_destroy(s);
}

// ---- atrium ------------------------------------------------------------------------

static void atrium_has_about_100k_triangles(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    assert_in_range(scene_triangles(s), 90000, 120000);
    assert_int_equal(s->light_count, 1);
    assert_true(s->texture_count >= 6);
    for (int i = 0; i < s->texture_count; ++i) {
        assert_int_equal(s->textures[i].width, 512);
        assert_int_equal(s->textures[i].height, 512);
        assert_true(s->textures[i].srgb);
    }
    static const char *const names[] = { "court", "gallery", "aisle", "above" };
    for (int i = 0; i < FG_COUNT(names); ++i)
        assert_int_equal(ag_scene_find_camera(s, names[i]), i);
    ag_scene_destroy(s);
}

static void atrium_is_as_large_as_a_palace_court(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    // Court 18 x 9, galleries of 3 and walls of 0.58 with their coping; two storeys and a roof.
    assert_true(fabs(s->box_max[0] - s->box_min[0] - (18 + 2 * 3.58)) < 0.01);
    assert_true(fabs(s->box_max[2] - s->box_min[2] - (9 + 2 * 3.58)) < 0.01);
    assert_true(fabs(s->box_max[1] - 10.66) < 0.01);
    ag_scene_destroy(s);
}

static void atrium_court_is_open_to_the_sky_and_its_galleries_are_not(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    const soup w = soup_of(s);
    static const double up[3] = { 0, 1, 0 };
    const double court[3] = { 2.5, 0.5, 0.5 }, lower[3] = { 1, 1.7, 6 }, upper[3] = { 1, 6, 6 };
    assert_true(soup_nearest(&w, court, up, 1e9) >= 1e9);
    const double vault = 1.7 + soup_nearest(&w, lower, up, 1e9);
    const double ceiling = 6.0 + soup_nearest(&w, upper, up, 1e9);
    assert_true(vault > 3.5 && vault < 4.2);
    assert_true(ceiling > 8.3 && ceiling < 8.7);
    free(w.corners);
    ag_scene_destroy(s);
}

static double light_distance(const ag_light *a, const ag_light *b)
{
    double d[3];
    for (int k = 0; k < 3; ++k)
        d[k] = a->position[k] - b->position[k];
    return sqrt(dot(d, d));
}

static void atrium_light_sweeps_slowly_and_comes_back(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    const ag_light start = s->lights[0];
    assert_true(start.moving);
    ag_scene_set_time(s, 1.0);
    const double moved = light_distance(&start, &s->lights[0]);
    assert_true(moved > 0.1 && moved < 3.0); // metres in a second
    ag_scene_set_time(s, s->duration);
    assert_true(light_distance(&start, &s->lights[0]) < 1e-4);
    ag_scene_destroy(s);
}

static void atrium_lamps_swing_on_their_hooks(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    int moving = 0;
    double before[16][16] = { 0 };
    for (int i = 0; i < s->instance_count; ++i) {
        if (s->instances[i].moving && moving < 16)
            memcpy(before[moving++], s->instances[i].world, sizeof before[0]);
    }
    assert_int_equal(moving, 4);
    ag_scene_set_time(s, 0.6); // a quarter of a swing
    for (int i = 0, k = 0; i < s->instance_count; ++i) {
        if (!s->instances[i].moving)
            continue;
        double turned = 0.0;
        for (int j = 0; j < 12; ++j)
            turned = fmax(turned, fabs(s->instances[i].world[j] - before[k][j]));
        assert_true(turned > 0.02); // about the sine of the angle
        for (int j = 12; j < 15; ++j)
            assert_true(fabs(s->instances[i].world[j] - before[k][j]) < 1e-12);
        ++k;
    }
    ag_scene_destroy(s);
}

// Twice the area of a triangle in the world, and of its picture in the texture.
static void triangle_areas(const mesh *m, size_t first, double *in_world, double *in_texture)
{
    double e[2][3], f[2][2], area[3];
    const ag_vertex *v[3];
    for (size_t j = 0; j < 3; ++j)
        v[j] = &m->vertices[m->indices[first + j]];
    for (int j = 0; j < 2; ++j) {
        for (int c = 0; c < 3; ++c)
            e[j][c] = (double) (v[j + 1]->position[c] - v[0]->position[c]);
        for (int c = 0; c < 2; ++c)
            f[j][c] = (double) (v[j + 1]->uv[0][c] - v[0]->uv[0][c]);
    }
    for (int c = 0; c < 3; ++c) {
        const int x = (c + 1) % 3, y = (c + 2) % 3;
        area[c] = e[0][x] * e[1][y] - e[0][y] * e[1][x];
    }
    *in_world += sqrt(dot(area, area));
    *in_texture += fabs(f[0][0] * f[1][1] - f[0][1] * f[1][0]);
}

// No stretched or missing texture coordinates.
static void atrium_texture_density_is_even(void **state)
{
    (void) state;
    ag_scene *s = open_scene("atrium");
    for (int i = 0; i < s->primitive_count; ++i) {
        const ag_material *m = &s->materials[s->primitives[i].material];
        const mesh p = primitive_mesh(s, i);
        double in_world = 0.0, in_texture = 0.0;
        for (size_t k = 0; k < p.index_count; k += 3)
            triangle_areas(&p, k, &in_world, &in_texture);
        const double density = in_texture / in_world; // textures a square metre
        if (m->base_color_tex.texture >= 0 && (density < 0.1 || density > 20.0))
            fail_msg("%s: %g textures a square metre", m->name, density);
    }
    ag_scene_destroy(s);
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
        cmocka_unit_test(cornell_has_the_published_coordinates),
        cmocka_unit_test(cornell_rests_as_published_and_an_inner_block_rises_later),
        cmocka_unit_test(cornell_lamp_goes_in_a_circle_below_the_ceiling),
        cmocka_unit_test(cornell_camera_is_the_published_one),
        cmocka_unit_test(cornell_walls_face_the_room),
        cmocka_unit_test(cornell_is_open_in_front_alone),
        cmocka_unit_test(cornell_lamp_is_a_spot_below_the_ceiling),
        cmocka_unit_test(atrium_has_about_100k_triangles),
        cmocka_unit_test(atrium_is_as_large_as_a_palace_court),
        cmocka_unit_test(atrium_court_is_open_to_the_sky_and_its_galleries_are_not),
        cmocka_unit_test(atrium_light_sweeps_slowly_and_comes_back),
        cmocka_unit_test(atrium_lamps_swing_on_their_hooks),
        cmocka_unit_test(atrium_texture_density_is_even),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
