// SPDX-License-Identifier: MIT
#include "../shapes.h"
#include "last_log.h"

#include <pass/rays.h>

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

static const fg_log logger = { .fn = remember, .level = FG_LOG_ERROR };
static const float far_away = 1e30f;

static ag_rays *rays_of(const ag_scene *scene)
{
    ag_rays *rays;
    if (!scene)
        fail_msg("%s", last);
    const ag_rays_desc desc = { .log = &logger, .scene = scene, .threads = 1 };
    assert_int_equal(ag_rays_create(&desc, &rays), FG_OK);
    return rays;
}

static void near_by(const float *a, const float *b, int count, float tolerance)
{
    for (int i = 0; i < count; ++i)
        if (!(fabsf(a[i] - b[i]) <= tolerance))
            fail_msg("[%d] %.9g is not %.9g", i, (double) a[i], (double) b[i]);
}

static float random_float(uint32_t *state) // [0, 1)
{
    *state = *state * 1664525u + 1013904223u;
    return (float) (*state >> 8) * 0x1p-24f;
}

static void random_direction(uint32_t *state, float out[3])
{
    float length;
    do {
        length = 0;
        for (int k = 0; k < 3; ++k) {
            out[k] = 2 * random_float(state) - 1;
            length += out[k] * out[k];
        }
    } while (length > 1 || length < 0.01f);
    for (int k = 0; k < 3; ++k)
        out[k] /= sqrtf(length);
}

static void unit_quad(shapes *s, int material, float z)
{
    shapes_quad(s, s->node, material, (float[]){ 0, 0, z }, (float[]){ 1, 0, 0 },
                (float[]){ 0, 1, 0 });
}

// Interpolation rounds a few times: some units in the last place of 1.
static const float rounding = 1e-6f;

static void a_hit_says_where_it_is(void **state)
{
    (void) state;
    ag_hit hit;
    shapes s = shapes_begin(&logger);
    unit_quad(&s, -1, 2);
    ag_scene *scene = shapes_end(&s);
    ag_rays *rays = rays_of(scene);
    const float from[] = { 0.25f, 0.75f, 5 }, down[] = { 0, 0, -2 };
    assert_true(ag_rays_nearest(rays, from, down, 0, far_away, &hit));
    near_by(&hit.distance, (float[]){ 1.5f }, 1, rounding); // in units of |direction| = 2
    near_by(hit.position, (float[]){ 0.25f, 0.75f, 2 }, 3, rounding);
    near_by(hit.face_normal, (float[]){ 0, 0, 1 }, 3, rounding);
    near_by(hit.normal, (float[]){ 0, 0, 1 }, 3, rounding);
    near_by(hit.uv[0], (float[]){ 0.25f, 0.75f, 0.25f, 0.75f }, 4, rounding);
    near_by(hit.color, (float[]){ 1, 1, 1, 1 }, 4, rounding);
    assert_true(hit.front);
    assert_int_equal(hit.instance, 0);
    assert_int_equal(hit.triangle, 1); // of (0 1 2), (0 2 3) the one left of the diagonal

    const float below[] = { 0.25f, 0.75f, 0 }, up[] = { 0, 0, 1 };
    assert_true(ag_rays_nearest(rays, below, up, 0, far_away, &hit));
    assert_false(hit.front);
    near_by(hit.normal, (float[]){ 0, 0, 1 }, 3, rounding); // not turned
    assert_false(ag_rays_nearest(rays, from, up, 0, far_away, &hit));
    ag_rays_destroy(rays);
    ag_scene_destroy(scene);
}

static void the_interval_bounds_what_is_seen(void **state)
{
    (void) state;
    ag_hit hit;
    shapes s = shapes_begin(&logger);
    unit_quad(&s, -1, 2);
    ag_scene *scene = shapes_end(&s);
    ag_rays *rays = rays_of(scene);
    const float from[] = { 0.25f, 0.75f, 5 }, down[] = { 0, 0, -1 };
    assert_true(ag_rays_blocked(rays, from, down, 0, far_away));
    assert_true(ag_rays_blocked(rays, from, down, 2.99f, 3.01f));
    assert_false(ag_rays_blocked(rays, from, down, 0, 2.99f));
    assert_false(ag_rays_blocked(rays, from, down, 3.01f, far_away));
    assert_false(ag_rays_nearest(rays, from, down, 0, 2.99f, &hit));
    assert_false(ag_rays_nearest(rays, from, down, 3.01f, far_away, &hit));
    assert_int_equal(ag_rays_all(rays, from, down, 2.99f, NULL, 0), 0);
    ag_rays_destroy(rays);
    ag_scene_destroy(scene);
}

static void a_mirrored_instance_keeps_its_front(void **state)
{
    (void) state;
    ag_hit hit;
    shapes s = shapes_begin(&logger);
    const ag_node_desc mirror = { .name = "mirror", .parent = -1, .scale = { -1, 1, 1 } };
    const int node = ag_builder_node(s.builder, &mirror);
    shapes_quad(&s, node, -1, (float[]){ 0, 0, 0 }, (float[]){ 1, 0, 0 }, (float[]){ 0, 1, 0 });
    ag_scene *scene = shapes_end(&s);
    ag_rays *rays = rays_of(scene);
    assert_true(ag_rays_nearest(rays, (float[]){ -0.5f, 0.5f, 1 }, (float[]){ 0, 0, -1 }, 0,
                                far_away, &hit));
    assert_true(hit.front);
    near_by(hit.face_normal, (float[]){ 0, 0, 1 }, 3, rounding);
    near_by(hit.normal, (float[]){ 0, 0, 1 }, 3, rounding);
    ag_rays_destroy(rays);
    ag_scene_destroy(scene);
}

// A 2 x 1 texture, the left half absent, looked up without filtering.
static int mask_material(shapes *s)
{
    const uint8_t texels[8] = { 255, 255, 255, 0, 255, 255, 255, 255 };
    const ag_texture texture = { .name = "mask",
                                 .width = 2,
                                 .height = 1,
                                 .rgba = texels,
                                 .srgb = true,
                                 .nearest = true,
                                 .wrap_u = AG_WRAP_CLAMP,
                                 .wrap_v = AG_WRAP_CLAMP };
    ag_material m = ag_default_material();
    m.base_color_tex.texture = ag_builder_texture(s->builder, &texture);
    m.alpha = AG_ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    return ag_builder_material(s->builder, &m);
}

static void masked_texels_are_not_there(void **state)
{
    (void) state;
    ag_hit hit, hits[4];
    shapes s = shapes_begin(&logger);
    const int mask = mask_material(&s);
    unit_quad(&s, mask, 1);
    unit_quad(&s, -1, 0);
    ag_scene *scene = shapes_end(&s);
    ag_rays *rays = rays_of(scene);
    const float hole[] = { 0.3f, 0.6f, 2 }, solid[] = { 0.7f, 0.6f, 2 }, down[] = { 0, 0, -1 };
    assert_true(ag_rays_nearest(rays, hole, down, 0, far_away, &hit));
    near_by(hit.position + 2, (float[]){ 0 }, 1, rounding);
    assert_true(ag_rays_nearest(rays, solid, down, 0, far_away, &hit));
    near_by(hit.position + 2, (float[]){ 1 }, 1, rounding);
    assert_false(ag_rays_blocked(rays, hole, down, 0, 1.5f));
    assert_true(ag_rays_blocked(rays, solid, down, 0, 1.5f));
    assert_int_equal(ag_rays_all(rays, hole, down, far_away, hits, 4), 1);
    assert_int_equal(ag_rays_all(rays, solid, down, far_away, hits, 4), 2);
    ag_rays_destroy(rays);
    ag_scene_destroy(scene);
}

static void all_hits_come_nearest_first(void **state)
{
    (void) state;
    ag_hit hits[8];
    const float heights[5] = { 2, 0, 4, 1, 3 };
    shapes s = shapes_begin(&logger);
    for (int i = 0; i < 5; ++i)
        unit_quad(&s, -1, heights[i]);
    ag_scene *scene = shapes_end(&s);
    ag_rays *rays = rays_of(scene);
    const float from[] = { 0.3f, 0.6f, 9 }, down[] = { 0, 0, -1 };
    assert_int_equal(ag_rays_all(rays, from, down, far_away, hits, 8), 5);
    for (int i = 0; i < 5; ++i)
        near_by(hits[i].position, (float[]){ 0.3f, 0.6f, 4 - (float) i }, 3, rounding);
    memset(hits, 0, sizeof hits);
    assert_int_equal(ag_rays_all(rays, from, down, far_away, hits, 3), 5);
    for (int i = 0; i < 3; ++i)
        near_by(hits[i].position + 2, (float[]){ 4 - (float) i }, 1, rounding);
    assert_true(hits[3].distance == 0); // untouched
    assert_int_equal(ag_rays_all(rays, from, down, far_away, NULL, 0), 5);
    ag_rays_destroy(rays);
    ag_scene_destroy(scene);
}

// Looks at the quad from its back, a tenth of its size away, then leaves what it sees in any
// direction. Returns how often that met something.
static int leave_quad(const ag_rays *rays, const float corner[3], const float a[3],
                      const float b[3], uint32_t *random)
{
    float direction[3], start[3], side = 0, length = 0;
    const float u = 0.4f + 0.1f * random_float(random), v = 0.4f + 0.1f * random_float(random);
    ag_hit hit;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        direction[k] = a[i] * b[j] - a[j] * b[i];
        length += a[k] * a[k];
    }
    for (int k = 0; k < 3; ++k)
        start[k] = corner[k] + u * a[k] + v * b[k] - 0.1f * direction[k] / sqrtf(length);
    assert_true(ag_rays_nearest(rays, start, direction, 0, far_away, &hit));
    random_direction(random, direction);
    for (int k = 0; k < 3; ++k)
        side += direction[k] * hit.face_normal[k];
    for (int k = 0; k < 3; ++k)
        hit.face_normal[k] *= side < 0 ? -1.0f : 1.0f;
    ag_rays_offset(hit.position, hit.face_normal, start);
    return ag_rays_blocked(rays, start, direction, 0, far_away) +
           ag_rays_nearest(rays, start, direction, 0, far_away, &hit);
}

// Slanted triangles of every size around points near the origin of the casts: a position is
// rounded by units of its own size, Embree's arithmetic by units of the triangle's.
static void an_offset_start_never_meets_its_own_plane(void **state)
{
    (void) state;
    uint32_t random = 1;
    for (int size = -3; size <= 4; ++size) {
        shapes s = shapes_begin(&logger);
        const float scale = powf(10, (float) size);
        float a[3], b[3], corner[3];
        random_direction(&random, a);
        random_direction(&random, b);
        for (int k = 0; k < 3; ++k) {
            a[k] *= scale;
            b[k] *= scale;
            corner[k] = 0.5f - 0.45f * a[k] - 0.45f * b[k];
        }
        shapes_quad(&s, s.node, -1, corner, a, b);
        ag_scene *scene = shapes_end(&s);
        ag_rays *rays = rays_of(scene);
        int hits = 0;
        for (int i = 0; i < 2000; ++i)
            hits += leave_quad(rays, corner, a, b, &random);
        assert_int_equal(hits, 0);
        ag_rays_destroy(rays);
        ag_scene_destroy(scene);
    }
}

static void an_offset_is_invisible(void **state)
{
    (void) state;
    const float p[] = { 3, -70, 0.5f }, n[] = { 0, 1, 0 };
    float out[3];
    ag_rays_offset(p, n, out);
    assert_true(out[0] == p[0] && out[2] == p[2] && out[1] > p[1]);
    near_by(out + 1, p + 1, 1, 70 * 1e-6f);
}

// Rays from the middle through every vertex and edge of a tessellated sphere.
static void a_closed_mesh_has_no_leak(void **state)
{
    (void) state;
    enum { RINGS = 24 };
    shapes s = shapes_begin(&logger);
    shapes_sphere_inside(&s, -1, 1, RINGS);
    ag_scene *scene = shapes_end(&s);
    ag_rays *rays = rays_of(scene);
    const float from[] = { 0.1f, -0.2f, 0.05f };
    int leaks = 0, outside = 0;
    for (size_t i = 0; i + 1 < scene->index_count; ++i)
        for (int half = 0; half < 2; ++half) {
            const float *p = scene->vertices[scene->indices[i]].position;
            const float *q = scene->vertices[scene->indices[i + 1]].position;
            float direction[3];
            ag_hit hit;
            for (int k = 0; k < 3; ++k)
                direction[k] = (half ? 0.5f * (p[k] + q[k]) : p[k]) - from[k];
            leaks += !ag_rays_nearest(rays, from, direction, 0, far_away, &hit);
            outside += !hit.front;
        }
    assert_int_equal(leaks, 0);
    assert_int_equal(outside, 0);
    ag_rays_destroy(rays);
    ag_scene_destroy(scene);
}

// A millimetre is 1/62 of a float's step at 10^6 m; relative to the camera it is exact.
static void far_from_the_origin_nothing_is_lost(void **state)
{
    (void) state;
    shapes s = shapes_begin(&logger);
    const ag_node_desc away = { .name = "away",
                                .parent = -1,
                                .translation = { 1e6 + 0.001, -1e6, 1e6 },
                                .scale = { 0.001, 0.001, 0.001 } };
    const int node = ag_builder_node(s.builder, &away);
    shapes_quad(&s, node, -1, (float[]){ 0, 0, 0 }, (float[]){ 1, 0, 0 }, (float[]){ 0, 1, 0 });
    ag_scene *scene = shapes_end(&s);
    ag_rays *rays;
    ag_hit hit;
    const ag_rays_desc desc = { .log = &logger, .scene = scene, .origin = { 1e6, -1e6, 1e6 } };
    assert_int_equal(ag_rays_create(&desc, &rays), FG_OK);
    const float from[] = { 0.00125f, 0.00075f, 1 }, down[] = { 0, 0, -1 };
    assert_true(ag_rays_nearest(rays, from, down, 0, far_away, &hit));
    // 10^6 + 0.001 as a double is off by up to 6e-11.
    near_by(hit.position, (float[]){ 0.00125f, 0.00075f, 0 }, 3, 1e-9f);
    near_by(hit.uv[0], (float[]){ 0.25f, 0.75f }, 2, 1e-6f);
    ag_rays_destroy(rays);
    ag_scene_destroy(scene);
}

static void moving_instances_can_be_left_out(void **state)
{
    (void) state;
    shapes s = shapes_begin(&logger);
    const int node = ag_builder_node(s.builder, &(ag_node_desc){ .name = "moves", .parent = -1 });
    const float times[] = { 0, 1 }, values[] = { 0, 0, 0, 1, 0, 0 };
    const ag_channel_desc channel = {
        .node = node, .key_count = 2, .times = times, .values = values
    };
    shapes_quad(&s, node, -1, (float[]){ 0, 0, 1 }, (float[]){ 1, 0, 0 }, (float[]){ 0, 1, 0 });
    unit_quad(&s, -1, 0);
    ag_builder_channel(s.builder, &channel);
    ag_scene *scene = shapes_end(&s);
    const float from[] = { 0.3f, 0.6f, 9 }, down[] = { 0, 0, -1 };
    for (int still = 0; still < 2; ++still) {
        ag_rays *rays;
        const ag_rays_desc desc = { .log = &logger, .scene = scene, .static_only = still };
        assert_int_equal(ag_rays_create(&desc, &rays), FG_OK);
        assert_int_equal(ag_rays_all(rays, from, down, far_away, NULL, 0), still ? 1 : 2);
        ag_rays_destroy(rays);
    }
    ag_scene_destroy(scene);
}

// ---- streams ------------------------------------------------------------------------

enum { STREAM_RAYS = 4099 };

// A sphere with 60 quads in it, every other one with holes.
static ag_scene *cluttered_scene(void)
{
    uint32_t random = 7;
    shapes s = shapes_begin(&logger);
    const int mask = mask_material(&s);
    shapes_sphere_inside(&s, -1, 3, 4);
    for (int i = 0; i < 60; ++i) {
        float corner[3], a[3], b[3];
        random_direction(&random, corner);
        random_direction(&random, a);
        random_direction(&random, b);
        shapes_quad(&s, s.node, i % 2 ? mask : -1, corner, a, b);
    }
    return shapes_end(&s);
}

// Some at vertices and edges, some from a surface, some that end or begin on one.
static void many_rays(const ag_scene *scene, ag_ray *out)
{
    uint32_t random = 8;
    for (int i = 0; i < STREAM_RAYS; ++i) {
        ag_ray *ray = out + i;
        const size_t at = (size_t) i % (scene->index_count - 1);
        const float *p = scene->vertices[scene->indices[at]].position;
        const float *q = scene->vertices[scene->indices[at + 1]].position;
        random_direction(&random, ray->from);
        random_direction(&random, ray->direction);
        ray->tnear = i % 7 == 0 ? random_float(&random) : 0;
        ray->tfar = i % 5 == 0 ? far_away : 4 * random_float(&random);
        for (int k = 0; k < 3 && i % 3 > 0; ++k)
            ray->direction[k] = (i % 3 == 1 ? p[k] : 0.5f * (p[k] + q[k])) - ray->from[k];
        if (i % 11 == 0)
            memcpy(ray->from, p, sizeof ray->from);
        if (i % 11 == 1)
            ray->tfar = 1;
    }
}

// Returns how many are blocked.
static int expect_as_alone(const ag_rays *rays, const ag_ray *cast, int count, const bool *blocked)
{
    int some = 0;
    for (int i = 0; i < count; ++i) {
        const ag_ray *ray = cast + i;
        const bool alone = ag_rays_blocked(rays, ray->from, ray->direction, ray->tnear, ray->tfar);
        if (blocked[i] != alone)
            fail_msg("ray %d of %d is %sblocked alone", i, count, alone ? "" : "not ");
        some += alone;
    }
    return some;
}

static void a_stream_answers_as_its_rays_do_alone(void **state)
{
    (void) state;
    static const int counts[] = { 0, 1, 2, 3, 7, 127, 128, 129, STREAM_RAYS };
    static ag_ray cast[STREAM_RAYS];
    static bool blocked[STREAM_RAYS + 1];
    ag_scene *scene = cluttered_scene();
    ag_rays *rays = rays_of(scene);
    int some = 0;
    many_rays(scene, cast);
    for (size_t c = 0; c < sizeof counts / sizeof *counts; ++c) {
        unsigned char after;
        memset(blocked, 2, sizeof blocked);
        ag_rays_blocked_many(rays, cast, counts[c], blocked);
        some = expect_as_alone(rays, cast, counts[c], blocked);
        memcpy(&after, blocked + counts[c], 1);
        assert_int_equal(after, 2); // nothing beyond is touched
    }
    assert_in_range(some, STREAM_RAYS / 5, STREAM_RAYS * 4 / 5);
    ag_rays_destroy(rays);
    ag_scene_destroy(scene);
}

static void a_stream_sees_through_masked_texels(void **state)
{
    (void) state;
    enum { COUNT = 200 };
    ag_ray cast[COUNT];
    bool blocked[COUNT];
    shapes s = shapes_begin(&logger);
    unit_quad(&s, mask_material(&s), 1);
    ag_scene *scene = shapes_end(&s);
    ag_rays *rays = rays_of(scene);
    for (int i = 0; i < COUNT; ++i) // the left half is a hole
        cast[i] = (ag_ray){ { ((float) i + 0.5f) / COUNT, 0.4f, 2 }, { 0, 0, -1 }, 0, far_away };
    ag_rays_blocked_many(rays, cast, COUNT, blocked);
    for (int i = 0; i < COUNT; ++i)
        assert_int_equal(blocked[i], i >= COUNT / 2);
    ag_rays_destroy(rays);
    ag_scene_destroy(scene);
}

typedef struct beside {
    const ag_rays *rays;
    const ag_ray *cast;
    atomic_bool go_on;
    int rounds, differences;
} beside;

static void *cast_beside(void *user)
{
    static bool first[STREAM_RAYS], again[STREAM_RAYS];
    beside *b = user;
    ag_rays_blocked_many(b->rays, b->cast, STREAM_RAYS, first);
    while (atomic_load(&b->go_on) || b->rounds < 4) {
        ag_hit hit;
        ag_rays_blocked_many(b->rays, b->cast, STREAM_RAYS, again);
        b->differences += memcmp(first, again, sizeof first) != 0;
        for (int i = 0; i < 100; ++i)
            (void) ag_rays_nearest(b->rays, b->cast[i].from, b->cast[i].direction, 0, 9, &hit);
        ++b->rounds;
    }
    return NULL;
}

// Half of the quads move, and the ray's quads share materials with them. To be run under the
// thread sanitizer too.
static void static_casts_may_run_beside_set_time(void **state)
{
    (void) state;
    static ag_ray cast[STREAM_RAYS];
    uint32_t random = 9;
    shapes s = shapes_begin(&logger);
    const int mask = mask_material(&s);
    const int node = ag_builder_node(s.builder, &(ag_node_desc){ .name = "moves", .parent = -1 });
    const float times[] = { 0, 1 }, values[] = { 0, 0, 0, 1, 0, 0 };
    const ag_channel_desc channel = {
        .node = node, .key_count = 2, .times = times, .values = values
    };
    for (int i = 0; i < 40; ++i) {
        float corner[3], a[3], b[3];
        random_direction(&random, corner);
        random_direction(&random, a);
        random_direction(&random, b);
        shapes_quad(&s, i % 2 ? node : s.node, mask, corner, a, b);
    }
    ag_builder_channel(s.builder, &channel);
    ag_scene *scene = shapes_end(&s);
    const ag_rays_desc desc = { .log = &logger, .scene = scene, .static_only = true };
    ag_rays *rays;
    assert_int_equal(ag_rays_create(&desc, &rays), FG_OK);
    many_rays(scene, cast);
    beside b = { .rays = rays, .cast = cast, .go_on = true };
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, cast_beside, &b), 0);
    for (int i = 0; i < 2000; ++i)
        ag_scene_set_time(scene, 0.001 * i);
    atomic_store(&b.go_on, false);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_int_equal(b.differences, 0);
    ag_rays_destroy(rays);
    ag_scene_destroy(scene);
}

static void an_empty_scene_hits_nothing(void **state)
{
    (void) state;
    ag_hit hit;
    shapes s = shapes_begin(&logger);
    ag_scene *scene = shapes_end(&s);
    ag_rays *rays = rays_of(scene);
    const float from[] = { 0, 0, 0 }, down[] = { 0, 0, -1 };
    assert_false(ag_rays_nearest(rays, from, down, 0, far_away, &hit));
    assert_false(ag_rays_blocked(rays, from, down, 0, far_away));
    assert_int_equal(ag_rays_all(rays, from, down, far_away, NULL, 0), 0);
    ag_rays_destroy(rays);
    ag_rays_destroy(NULL);
    ag_scene_destroy(scene);
}

static void mistakes_are_refused(void **state)
{
    (void) state;
    ag_rays *rays;
    assert_int_equal(ag_rays_create(&(ag_rays_desc){ .log = &logger }, &rays), FG_ERR_INVALID);
    assert_null(rays);
    assert_string_equal(last, "rays: there is no scene");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hit_says_where_it_is),
        cmocka_unit_test(the_interval_bounds_what_is_seen),
        cmocka_unit_test(a_mirrored_instance_keeps_its_front),
        cmocka_unit_test(masked_texels_are_not_there),
        cmocka_unit_test(all_hits_come_nearest_first),
        cmocka_unit_test(an_offset_start_never_meets_its_own_plane),
        cmocka_unit_test(an_offset_is_invisible),
        cmocka_unit_test(a_closed_mesh_has_no_leak),
        cmocka_unit_test(far_from_the_origin_nothing_is_lost),
        cmocka_unit_test(moving_instances_can_be_left_out),
        cmocka_unit_test(a_stream_answers_as_its_rays_do_alone),
        cmocka_unit_test(a_stream_sees_through_masked_texels),
        cmocka_unit_test(static_casts_may_run_beside_set_time),
        cmocka_unit_test(an_empty_scene_hits_nothing),
        cmocka_unit_test(mistakes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
