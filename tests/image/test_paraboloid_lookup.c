// SPDX-License-Identifier: MIT
// What lookups in paraboloid maps say: against rays, of planes seen flat, beside what stands on
// them, behind walls, from cameras that move.
#include "paraboloid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 256 };

static double dot(const double a[3], const float b[3])
{
    return a[0] * (double) b[0] + a[1] * (double) b[1] + a[2] * (double) b[2];
}

// Whether a ray gets from the eye to the receiver; -1 where one of them does not face the other.
static int by_ray(const maps_host *h, const ag_paraboloid_eye *eye, const maps_receiver *r)
{
    float from[3], d[3];
    double to[3];
    for (int k = 0; k < 3; k++)
        to[k] = r->position[k] - eye->position[k];
    const double length = sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
    if (dot(to, eye->normal) < 0.02 * length || dot(to, r->normal) > -0.02 * length)
        return -1;
    for (int k = 0; k < 3; k++) {
        from[k] = (float) (eye->position[k] - h->centre[k]);
        d[k] = (float) to[k];
    }
    return ag_rays_blocked(h->rays, from, d, 1e-4f, 1 - 1e-4f) ? 0 : 1;
}

// Means over pairs of an eye and a receiver that face each other: of what is off, and of its sum.
typedef struct errors {
    double off, lost;
} errors;

static errors against_rays(const char *name, int eyes)
{
    enum { RECEIVERS = 4000 };
    static maps_receiver receivers[RECEIVERS];
    maps_host h;
    uint32_t seed = 3;
    double wrong = 0, lost = 0, all = 0, hidden = 0;
    maps_init(&h, maps_scene(name), SIZE, eyes);
    ag_paraboloid_eye *set = calloc((size_t) eyes, sizeof *set);
    assert_non_null(set);
    for (int i = 0; i < eyes; i++)
        set[i] = maps_eye(&h, &seed, i);
    for (int i = 0; i < RECEIVERS; i++) {
        const ag_paraboloid_eye e = maps_eye(&h, &seed, 0);
        memcpy(receivers[i].position, e.position, sizeof e.position);
        memcpy(receivers[i].normal, e.normal, sizeof e.normal);
    }
    assert_int_equal(maps_draw(&h, set, eyes), FG_OK);
    for (int i = 0; i < eyes; i++) {
        float *said = maps_look_up(&h, i, receivers, RECEIVERS);
        for (int k = 0; k < RECEIVERS; k++) {
            const int truth = by_ray(&h, &set[i], &receivers[k]);
            if (truth < 0)
                continue;
            all++;
            hidden += 1 - truth;
            wrong += fabs((double) said[k] - truth);
            lost += truth - (double) said[k];
        }
        free(said);
    }
    print_message("%s: %.0f pairs, %.4f hidden; off %.5f, lost %.5f\n", name, all, hidden / all,
                  wrong / all, lost / all);
    free(set);
    maps_finish(&h);
    return (errors){ wrong / all, fabs(lost / all) };
}

// Borders of shadows are blurred over 2x2 texels, of 0.008 to 0.016 of the distance each: about
// half of what lies within one texel of a border is off. Cornell's two boxes have some 3 of length
// around per unit of area of its walls, the atrium's columns and leaves some 20.
static void lookups_say_what_rays_say(void **state)
{
    (void) state;
    const errors cornell = against_rays("cornell", 24), atrium = against_rays("atrium", 24);
    assert_true(cornell.off < 0.01 && cornell.lost < 0.002);
    assert_true(atrium.off < 0.05 && atrium.lost < 0.01);
}

// ---- planes -------------------------------------------------------------------------------------

// A plane of 2 m about the origin, and away from it a speck that makes the scene's box a cube.
static ag_scene *plane_scene(void)
{
    static const double at[3] = { -1, 0, -1 }, x[3] = { 2, 0, 0 }, z[3] = { 0, 0, 2 };
    static const double up[3] = { 0, 1.99, 0 }, dx[3] = { 0.01, 0, 0 }, dz[3] = { 0, 0, 0.01 };
    ag_builder *b = ag_builder_create(test_log(), "plane");
    add_quad(b, -1, at, z, x);
    add_quad(b, -1, up, dx, dz);
    return finish_scene(b);
}

static bool is_lit(const ag_paraboloid_eye *eye, const maps_receiver *r)
{
    double d[3], r2 = 0;
    for (int k = 0; k < 3; k++) {
        d[k] = r->position[k] - eye->position[k];
        r2 += d[k] * d[k];
    }
    return dot(d, eye->normal) > 0 && -d[1] >= 0.0035 * sqrt(r2);
}

// At any angle down to 0.2 degrees, from 1 mm above to 1.5 m, whichever way the eye looks: nothing
// is lost at all.
static void a_lit_plane_does_not_shadow_itself(void **state)
{
    enum { EYES = 64, RECEIVERS = 2000 };
    static maps_receiver receivers[RECEIVERS];
    static ag_paraboloid_eye eyes[EYES];
    uint32_t seed = 9;
    maps_host h;
    int lit = 0;
    (void) state;
    maps_init(&h, plane_scene(), SIZE, EYES);
    for (int i = 0; i < EYES; i++) {
        ag_paraboloid_eye *e = &eyes[i];
        const double height = 1e-3 * pow(1500, feed_random(&seed));
        const double up = feed_random(&seed) - 0.6, around = 6.28 * feed_random(&seed);
        *e = (ag_paraboloid_eye){ .position = { 0, height, 0 }, .slot = i, .fresh = true };
        e->normal[0] = (float) (sqrt(1 - up * up) * cos(around));
        e->normal[1] = (float) up;
        e->normal[2] = (float) (sqrt(1 - up * up) * sin(around));
    }
    for (int i = 0; i < RECEIVERS; i++) {
        const double far = pow(feed_random(&seed), 2), around = 6.28 * feed_random(&seed);
        receivers[i] =
            (maps_receiver){ .position = { 0.99 * far * cos(around), 0, 0.99 * far * sin(around) },
                             .normal = { 0, 1, 0 } };
    }
    assert_int_equal(maps_draw(&h, eyes, EYES), FG_OK);
    for (int i = 0; i < EYES; i++) {
        float *said = maps_look_up(&h, i, receivers, RECEIVERS);
        for (int k = 0; k < RECEIVERS; k++) {
            if (!is_lit(&eyes[i], &receivers[k]))
                continue;
            assert_true(said[k] == 1);
            lit++;
        }
        free(said);
    }
    assert_true(lit > EYES * RECEIVERS / 8);
    maps_finish(&h);
}

// ---- contact ------------------------------------------------------------------------------------

// A wall of 1 m stands across a floor, and an eye 1 m before it and 0.7 m up looks down: behind the
// wall it is dark from the wall's foot on, to a texel's angle; before it, it is lit.
static void what_stands_on_a_floor_shadows_its_foot(void **state)
{
    enum { STEPS = 400 };
    static const double at[3] = { -2, 0, -2 }, x[3] = { 4, 0, 0 }, z[3] = { 0, 0, 4 },
                        foot[3] = { 0, 0, -2 }, up[3] = { 0, 1, 0 };
    static maps_receiver receivers[STEPS];
    maps_host h;
    const ag_paraboloid_eye eye = { .position = { -1, 0.7, 0.1 },
                                    .normal = { 0, -1, 0 },
                                    .fresh = true };
    (void) state;
    ag_builder *b = ag_builder_create(test_log(), "contact");
    add_quad(b, -1, at, z, x);
    add_quad(b, -1, foot, z, up);
    maps_init(&h, finish_scene(b), SIZE, 1);
    for (int i = 0; i < STEPS; i++)
        receivers[i] = (maps_receiver){ .position = { (i - 0.5 * STEPS + 0.5) * 1e-3, 0, 0.137 },
                                        .normal = { 0, 1, 0 } };
    assert_int_equal(maps_draw(&h, &eye, 1), FG_OK);
    float *said = maps_look_up(&h, 0, receivers, STEPS);
    // The foot is 1.22 m away under 55 degrees. A texel there has an angle of 0.0123 and is as long
    // as 1.22 * 0.0123 / cos 55 = 0.026 on the floor; the filter reaches one of them to either
    // side, and half a texel's worth of the bias, 0.0075 of height, is as much as 0.011 of the
    // floor.
    const double texel = 0.026, bias = 0.011;
    double most = 0, least = 1;
    for (int i = 0; i < STEPS; i++) {
        const double off = receivers[i].position[0];
        if (off < -texel)
            least = fmin(least, (double) said[i]);
        if (off > texel + bias)
            most = fmax(most, (double) said[i]);
    }
    print_message("before the wall at least %.4f, behind it at most %.4f\n", least, most);
    assert_true(least == 1);
    assert_true(most == 0);
    free(said);
    maps_finish(&h);
}

// ---- walls --------------------------------------------------------------------------------------

// Rooms side by side: of eyes in one, also at its very corners, no light comes into the other.
static void no_light_goes_through_a_wall(void **state)
{
    enum { EYES = 5, RECEIVERS = 500 };
    static const double at[3] = { 0, -0.5, -0.5 }, y[3] = { 0, 1, 0 }, z[3] = { 0, 0, 1 };
    static maps_receiver receivers[RECEIVERS];
    ag_paraboloid_eye eyes[EYES];
    uint32_t seed = 4;
    maps_host h;
    (void) state;
    const room_desc room = { 0 };
    ag_builder *b = room_builder(&room);
    add_quad(b, -1, at, z, y); // its front is to -x
    maps_init(&h, finish_scene(b), SIZE, EYES);
    for (int i = 0; i < EYES; i++) {
        static const double from_wall[EYES] = { 1e-1, 1e-3, 1e-6, 0, -2e-7 };
        eyes[i] = (ag_paraboloid_eye){ .position = { -from_wall[i], -0.5, i == 4 ? -0.5 : 0.1 },
                                       .normal = { 0, 1, 0 },
                                       .slot = i,
                                       .fresh = true };
    }
    for (int i = 0; i < RECEIVERS; i++)
        receivers[i] = (maps_receiver){ .position = { 0.01 + 0.48 * feed_random(&seed), 0.5,
                                                      0.98 * feed_random(&seed) - 0.49 },
                                        .normal = { 0, -1, 0 } };
    assert_int_equal(maps_draw(&h, eyes, EYES), FG_OK);
    for (int i = 0; i < EYES; i++) {
        float *said = maps_look_up(&h, i, receivers, RECEIVERS);
        for (int k = 0; k < RECEIVERS; k++) {
            const double d =
                receivers[k].position[0]; // of the wall; the filter reaches over its edge
            if (d > 0.03)
                assert_true(said[k] == 0);
        }
        free(said);
    }
    maps_finish(&h);
}

// ---- cameras ------------------------------------------------------------------------------------

// Maps are kept in places of the scene's own: another camera rounds the receiver and the eye anew,
// by 1e-7, which moves the filter's weights by 1e-4 and tips a comparison seldom.
static void cameras_do_not_change_lookups(void **state)
{
    enum { RECEIVERS = 2000 };
    static maps_receiver receivers[RECEIVERS];
    uint32_t seed = 6;
    maps_host h;
    int tipped = 0;
    (void) state;
    maps_init(&h, maps_scene("cornell"), SIZE, 1);
    ag_paraboloid_eye eye = maps_eye(&h, &seed, 0);
    for (int i = 0; i < RECEIVERS; i++) {
        const ag_paraboloid_eye e = maps_eye(&h, &seed, 0);
        memcpy(receivers[i].position, e.position, sizeof e.position);
        memcpy(receivers[i].normal, e.normal, sizeof e.normal);
    }
    assert_int_equal(maps_draw(&h, &eye, 1), FG_OK);
    float *before = maps_look_up(&h, 0, receivers, RECEIVERS);
    eye.fresh = false;
    for (int k = 0; k < 3; k++)
        h.view.origin[k] += 0.3 + k;
    assert_int_equal(maps_draw(&h, &eye, 1), FG_OK);
    assert_int_equal(ag_paraboloid_drawn(h.maps), 0);
    float *after = maps_look_up(&h, 0, receivers, RECEIVERS);
    for (int i = 0; i < RECEIVERS; i++)
        tipped += fabs((double) before[i] - (double) after[i]) > 1e-3;
    print_message("%d of %d tipped\n", tipped, RECEIVERS);
    assert_true(tipped <= RECEIVERS / 200);
    free(before);
    free(after);
    maps_finish(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lookups_say_what_rays_say),
        cmocka_unit_test(a_lit_plane_does_not_shadow_itself),
        cmocka_unit_test(what_stands_on_a_floor_shadows_its_foot),
        cmocka_unit_test(no_light_goes_through_a_wall),
        cmocka_unit_test(cameras_do_not_change_lookups),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
