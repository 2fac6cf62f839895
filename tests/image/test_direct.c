// SPDX-License-Identifier: MIT
// Direct light against closed forms. In a convex room nothing is in shadow, so that every pixel
// has a known value: what differs is acne.
#include "fixture.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 192 };
static const double pi = 3.14159265358979;

// The irradiance of a light at a point of the room's walls, by the definitions in pass/scene.h.
static double irradiance(const ag_light *light, const double p[3], const double n[3])
{
    double d[3], len = 0, along = 0, facing = 0;
    for (int k = 0; k < 3; k++) {
        d[k] = light->kind == AG_LIGHT_DIRECTIONAL ? -(double) light->direction[k]
                                                   : light->position[k] - p[k];
        len += d[k] * d[k];
    }
    len = sqrt(len);
    for (int k = 0; k < 3; k++) {
        along -= d[k] / len * (double) light->direction[k];
        facing += d[k] / len * n[k];
    }
    double fade = 1;
    if (light->kind == AG_LIGHT_SPOT) {
        const double outer = (double) light->cos_outer, inner = (double) light->cos_inner;
        fade = fmin(fmax((along - outer) / fmax(1e-3, inner - outer), 0), 1);
        fade = light->cosine ? fmax(along, 0) : fade * fade;
    }
    const double square = light->kind == AG_LIGHT_DIRECTIONAL ? 1 : len * len;
    return (double) light->intensity[0] * fade * fmax(facing, 0) / square;
}

// Largest deviation of a pixel over the brightest value there is.
static double worst_deviation(ag_scene *scene)
{
    image albedo = render_layer(scene, SIZE, SIZE, LAYER_ALBEDO, NULL, NULL);
    image direct = render_layer(scene, SIZE, SIZE, LAYER_DIRECT, NULL, NULL);
    image position = render_layer(scene, SIZE, SIZE, LAYER_POSITION, NULL, NULL);
    image normal = render_layer(scene, SIZE, SIZE, LAYER_NORMAL, NULL, NULL);
    double worst = 0, brightest = 0;
    for (int i = 0; i < 3 * SIZE * SIZE; i += 3) {
        const double p[3] = { (double) position.rgb[i], (double) position.rgb[i + 1],
                              (double) position.rgb[i + 2] };
        const double n[3] = { (double) normal.rgb[i], (double) normal.rgb[i + 1],
                              (double) normal.rgb[i + 2] };
        const double want = (double) albedo.rgb[i] / pi * irradiance(&scene->lights[0], p, n);
        worst = fmax(worst, fabs((double) direct.rgb[i] - want));
        brightest = fmax(brightest, want);
    }
    image_finish(&direct);
    image_finish(&position);
    image_finish(&normal);
    image_finish(&albedo);
    assert_true(brightest > 0);
    return worst / brightest;
}

// Positions carry float rounding of 1e-7 of the room; a spot's ramp steepens that about tenfold.
// One acne pixel would be off by its whole value.
static const double bound = 2e-5;

static void expect_room(const ag_light *light, double edge)
{
    ag_light scaled = *light;
    for (int k = 0; k < 3; k++)
        scaled.intensity[k] *= (float) (edge * edge);
    const room_desc room = { .edge = edge };
    ag_scene *scene = room_scene(&room, &scaled);
    const double worst = worst_deviation(scene);
    if (worst > bound)
        fail_msg("edge %g: worst pixel is off by %g of the maximum", edge, worst);
    ag_scene_destroy(scene);
}

static void spot_in_an_empty_room_casts_no_shadow(void **state)
{
    (void) state;
    const ag_light narrow = ceiling_spot(35), wide = ceiling_spot(58), wider = ceiling_spot(80);
    expect_room(&narrow, 1);
    expect_room(&wide, 1);
    expect_room(&wider, 1);
}

static void cosine_spot_in_an_empty_room_casts_no_shadow(void **state)
{
    (void) state;
    ag_light light = ceiling_spot(90);
    light.cosine = true;
    expect_room(&light, 1);
}

static void point_light_in_an_empty_room_casts_no_shadow(void **state)
{
    (void) state;
    ag_light light = ceiling_spot(90);
    light.kind = AG_LIGHT_POINT;
    light.position[0] = 0.21;
    light.position[1] = -0.13;
    expect_room(&light, 1);
}

static void acne_does_not_come_with_scale(void **state)
{
    (void) state;
    const ag_light light = ceiling_spot(58);
    expect_room(&light, 1e-4);
    expect_room(&light, 1e4);
}

static void directional_light_on_a_floor_casts_no_shadow(void **state)
{
    (void) state;
    static const double p[3] = { -1, 0, -1 }, u[3] = { 0, 0, 2 }, v[3] = { 2, 0, 0 };
    for (int i = 0; i < 3; i++) {
        const float slope = (float[]){ 0, 1, 8 }[i]; // down to 7 degrees above the floor
        const float len = sqrtf(1 + slope * slope);
        ag_light light = { .name = "sun", .kind = AG_LIGHT_DIRECTIONAL };
        light.direction[0] = slope / len;
        light.direction[1] = -1 / len;
        for (int k = 0; k < 3; k++)
            light.intensity[k] = 3;
        ag_builder *b = ag_builder_create(test_log(), "floor");
        ag_material grey = ag_default_material();
        grey.base_color[0] = grey.base_color[1] = grey.base_color[2] = 0.5f;
        add_quad(b, ag_builder_material(b, &grey), p, u, v);
        ag_builder_light(b, -1, &light);
        ag_camera camera = { .name = "above", .yfov = 0.8f, .znear = 0.01f };
        // Looks down: x to the right, -z up.
        camera.world[0] = 1;
        camera.world[6] = -1;
        camera.world[9] = 1;
        camera.world[13] = 2;
        camera.world[15] = 1;
        ag_builder_camera(b, -1, &camera);
        ag_scene *scene = finish_scene(b);
        assert_true(worst_deviation(scene) <= bound);
        ag_scene_destroy(scene);
    }
}

// How far a pixel may lie from a shadow's edge and still be blended: one texel of the map and one
// pixel. Beyond, lit is lit and dark is dark.
static bool segment_meets_box(const double a[3], const double b[3], const double lo[3],
                              const double hi[3], double margin)
{
    double t0 = 0, t1 = 1;
    for (int k = 0; k < 3; k++) {
        const double d = b[k] - a[k];
        double n = (lo[k] - margin - a[k]) / d, f = (hi[k] + margin - a[k]) / d;
        if (n > f) {
            const double s = n;
            n = f;
            f = s;
        }
        t0 = fmax(t0, n);
        t1 = fmin(t1, f);
    }
    return t0 < t1;
}

// The blocks of room_builder().
static const double blocks[2][2][3] = {
    { { -0.35, -0.5, -0.35 }, { -0.05, 0.1, -0.1 } },
    { { 0.08, -0.5, 0.0 }, { 0.36, -0.22, 0.28 } },
};

static bool blocked(const double from[3], const double to[3], double margin)
{
    return segment_meets_box(from, to, blocks[0][0], blocks[0][1], margin) ||
           segment_meets_box(from, to, blocks[1][0], blocks[1][1], margin);
}

static void blocks_shadow_what_lies_behind_them_and_nothing_else(void **state)
{
    (void) state;
    const ag_light light = ceiling_spot(58);
    const room_desc room = { .boxes = true };
    ag_scene *scene = room_scene(&room, &light);
    image direct = render_layer(scene, SIZE, SIZE, LAYER_DIRECT, NULL, NULL);
    image position = render_layer(scene, SIZE, SIZE, LAYER_POSITION, NULL, NULL);
    image normal = render_layer(scene, SIZE, SIZE, LAYER_NORMAL, NULL, NULL);
    image albedo = render_layer(scene, SIZE, SIZE, LAYER_ALBEDO, NULL, NULL);
    // A texel is 2 tan(58 deg) / 2048 of the way from the light, 1 at most.
    const double margin = 4 * 2 * 1.6 / 2048;
    int dark = 0, lit = 0, leaks = 0, acne = 0;
    for (int i = 0; i < 3 * SIZE * SIZE; i += 3) {
        double p[3], n[3], q[3];
        for (int k = 0; k < 3; k++) {
            p[k] = (double) position.rgb[i + k];
            n[k] = (double) normal.rgb[i + k];
            q[k] = p[k] + 1e-4 * n[k]; // off its own block
        }
        const double want =
            (double) albedo.rgb[i] / 3.14159265358979 * irradiance(&scene->lights[0], p, n);
        if (want < 1e-3)
            continue;
        if (blocked(q, scene->lights[0].position, -margin)) {
            dark++;
            leaks += direct.rgb[i] > 0;
        } else if (!blocked(q, scene->lights[0].position, 0)) {
            lit++;
            const bool near_edge = blocked(q, scene->lights[0].position, margin);
            acne += !near_edge && fabs((double) direct.rgb[i] - want) > 1e-3 * want;
        }
    }
    assert_true(dark > 300);
    assert_true(lit > 5000);
    assert_int_equal(leaks, 0);
    assert_int_equal(acne, 0);
    image_finish(&direct);
    image_finish(&position);
    image_finish(&normal);
    image_finish(&albedo);
    ag_scene_destroy(scene);
}

static void sphere_about_its_light_is_uniform(void **state)
{
    (void) state;
    ag_scene *scene = sphere_scene(96, 0.5f);
    image direct = render_layer(scene, SIZE, SIZE, LAYER_DIRECT, NULL, NULL);
    const double want = 0.5 / pi; // albedo / pi x I / R^2
    // A chord of pi / 96 sags by (pi / 192)^2 / 2 = 1.3e-4, that is 2.7e-4 of 1 / R^2, twice over
    // for the two ways it bends; half-float normals add 2e-4.
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        if (fabs((double) direct.rgb[i] - want) > 1e-3 * want)
            fail_msg("pixel %d is %g, not %g", i / 3, (double) direct.rgb[i], want);
    image_finish(&direct);
    ag_scene_destroy(scene);
}

static void emission_is_seen_from_the_front_alone(void **state)
{
    (void) state;
    for (int both = 0; both < 2; both++) {
        for (int back = 0; back < 2; back++) {
            static const double p[3] = { -1, -1, -1 }, x[3] = { 2, 0, 0 }, y[3] = { 0, 2, 0 };
            ag_builder *b = ag_builder_create(test_log(), "panel");
            ag_material m = ag_default_material();
            m.emissive[0] = 1;
            m.emissive[1] = 2;
            m.emissive[2] = 70000; // beyond a half float
            m.double_sided = both;
            add_quad(b, ag_builder_material(b, &m), p, back ? y : x, back ? x : y);
            const ag_camera camera = plain_camera("front");
            ag_builder_camera(b, -1, &camera);
            ag_scene *scene = finish_scene(b);
            image direct = render_layer(scene, 3, 3, LAYER_DIRECT, NULL, NULL);
            const bool seen = both || !back;
            assert_true(direct.rgb[0] == (seen ? 1.0f : 0.0f));
            assert_true(direct.rgb[1] == (seen ? 2.0f : 0.0f));
            assert_true(direct.rgb[2] == (seen ? 70000.0f : 0.0f));
            image_finish(&direct);
            ag_scene_destroy(scene);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spot_in_an_empty_room_casts_no_shadow),
        cmocka_unit_test(cosine_spot_in_an_empty_room_casts_no_shadow),
        cmocka_unit_test(point_light_in_an_empty_room_casts_no_shadow),
        cmocka_unit_test(acne_does_not_come_with_scale),
        cmocka_unit_test(directional_light_on_a_floor_casts_no_shadow),
        cmocka_unit_test(blocks_shadow_what_lies_behind_them_and_nothing_else),
        cmocka_unit_test(sphere_about_its_light_is_uniform),
        cmocka_unit_test(emission_is_seen_from_the_front_alone),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
