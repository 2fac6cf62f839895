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

static image render_direct(ag_scene *scene, int shadow_size, int taps)
{
    const shot s = { .scene = scene,
                     .width = SIZE,
                     .height = SIZE,
                     .layer = LAYER_DIRECT,
                     .shadow_size = shadow_size,
                     .shadow_taps = taps };
    return shot_take(&s);
}

// Largest deviation of a pixel over the brightest value there is.
static double worst_deviation(ag_scene *scene, int taps)
{
    image albedo = render_layer(scene, SIZE, SIZE, LAYER_ALBEDO, NULL, NULL);
    image direct = render_direct(scene, 0, taps);
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
    for (int taps = 4; taps <= 16; taps += 12) {
        const double worst = worst_deviation(scene, taps);
        if (worst > bound)
            fail_msg("edge %g, %d taps: worst pixel is off by %g of the maximum", edge, taps,
                     worst);
    }
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
        assert_true(worst_deviation(scene, 4) <= bound);
        assert_true(worst_deviation(scene, 16) <= bound);
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

static void expect_blocks(int taps)
{
    const ag_light light = ceiling_spot(58);
    const room_desc room = { .boxes = true };
    ag_scene *scene = room_scene(&room, &light);
    image direct = render_direct(scene, 0, taps);
    image position = render_layer(scene, SIZE, SIZE, LAYER_POSITION, NULL, NULL);
    image normal = render_layer(scene, SIZE, SIZE, LAYER_NORMAL, NULL, NULL);
    image albedo = render_layer(scene, SIZE, SIZE, LAYER_ALBEDO, NULL, NULL);
    // A texel is 2 tan(58 deg) / 2048 of the way from the light, 1 at most.
    const double margin = (taps == 16 ? 8 : 4) * 2 * 1.6 / 2048;
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

static void blocks_shadow_what_lies_behind_them_and_nothing_else(void **state)
{
    (void) state;
    expect_blocks(4);
    expect_blocks(16);
}

// Where wall and floor meet the filter takes in the other; the light grazes the wall at a tangent
// of up to 0.97 / 0.04 = 24.
static void a_grazed_wall_is_lit_down_to_the_floor(void **state)
{
    (void) state;
    ag_light light = ceiling_spot(58);
    light.position[0] = -0.46;
    ag_scene *scene = room_scene(&(room_desc){ 0 }, &light);
    image direct = render_direct(scene, 0, 16);
    image position = render_layer(scene, SIZE, SIZE, LAYER_POSITION, NULL, NULL);
    const double normal[3] = { 1, 0, 0 };
    int seen = 0;
    for (int i = 0; i < 3 * SIZE * SIZE; i += 3) {
        const double p[3] = { (double) position.rgb[i], (double) position.rgb[i + 1],
                              (double) position.rgb[i + 2] };
        const double want = 0.5 / pi * irradiance(&scene->lights[0], p, normal);
        if (p[0] > -0.4999 || p[1] < -0.4999 || p[2] < -0.4999 || want < 1e-3)
            continue;
        seen++;
        // Positions are off by 3e-8, of 0.04 from the light's plane.
        if (fabs((double) direct.rgb[i] - want) > 1e-4 * want)
            fail_msg("at %g %g %g it is %g, not %g", p[0], p[1], p[2], (double) direct.rgb[i],
                     want);
    }
    assert_true(seen > 1000);
    image_finish(&direct);
    image_finish(&position);
    ag_scene_destroy(scene);
}

// ---- the edge of a half plane's shadow --------------------------------------------------------
//
// A point light at the origin over a floor at y = -0.5. The first face of its map looks down, the
// second along `across`: passes/gpu_scene/light_faces.c turns them by the golden section. A half
// plane halfway up casts a shadow on what lies further than `edge` in that direction.

enum { EDGE_SIZE = 64 };
static const double across[3] = { 0.52573111211913361, 0, 0.85065080835203993 };
static const double texel = 2 * 0.5 / EDGE_SIZE; // on the floor, in the first face

static ag_scene *edge_scene(double edge)
{
    const double floor_at[3] = { -2, -0.5, -2 }, z[3] = { 0, 0, 4 }, x[3] = { 4, 0, 0 };
    const double along[3] = { 2 * across[2], 0, -2 * across[0] };
    double corner[3];
    ag_builder *b = ag_builder_create(test_log(), "edge");
    ag_material white = ag_default_material();
    white.metallic = 0;
    const int material = ag_builder_material(b, &white);
    for (int k = 0; k < 3; k++)
        corner[k] = 0.5 * edge * across[k] - 0.5 * along[k] - (k == 1 ? 0.25 : 0);
    add_quad(b, material, floor_at, z, x);
    add_quad(b, material, corner, across, along);
    const ag_light light = { .name = "lamp", .direction = { 0, -1, 0 }, .intensity = { 1, 1, 1 } };
    ag_builder_light(b, -1, &light);
    // Under the half plane, looking down on the edge.
    ag_camera camera = { .name = "under", .yfov = 1.2f, .znear = 0.01f };
    for (int k = 0; k < 3; k++) {
        camera.world[k] = across[k];
        camera.world[4 + k] = 0.5 * along[k];
        camera.world[8 + k] = k == 1;
        camera.world[12 + k] = edge * across[k] - (k == 1 ? 0.3 : 0);
    }
    camera.world[15] = 1;
    ag_builder_camera(b, -1, &camera);
    return finish_scene(b);
}

// Fraction of light by filtering over `width` texels in the first face, the second being dark.
static double filtered(double s, double edge, double width)
{
    const double beyond = s > 0.5 ? (1 - 0.5 / s) * EDGE_SIZE / 2 // texels of the second face
                                  : (s - 0.5) / texel;
    return fmin(fmax(0.5 + ((edge - 0.5) / texel - beyond) / width, 0), 1);
}

static void expect_edge(double edge, int taps)
{
    ag_scene *scene = edge_scene(edge);
    image direct = render_direct(scene, EDGE_SIZE, taps);
    image position = render_layer(scene, SIZE, SIZE, LAYER_POSITION, NULL, NULL);
    int between = 0;
    for (int i = 0; i < 3 * SIZE * SIZE; i += 3) {
        const double p[3] = { (double) position.rgb[i], (double) position.rgb[i + 1],
                              (double) position.rgb[i + 2] };
        const double up[3] = { 0, 1, 0 }, s = p[0] * across[0] + p[2] * across[2];
        const double got = (double) direct.rgb[i] * pi / irradiance(&scene->lights[0], p, up);
        const double want = filtered(s, edge, taps == 16 ? 3 : 1);
        // Positions are floats: 1e-7 of a texel of 0.015; and half a dozen
        // roundings.
        if (fabs(got - want) > 2e-5)
            fail_msg("%d taps, edge %g: at %g it is %g, not %g", taps, edge, s, got, want);
        between += want > 0 && want < 1;
    }
    assert_true(between > SIZE); // a row at least
    image_finish(&direct);
    image_finish(&position);
    ag_scene_destroy(scene);
}

static void a_shadows_edge_is_a_ramp_as_wide_as_the_filter(void **state)
{
    (void) state;
    expect_edge(12 * texel, 4);
    expect_edge(12 * texel, 16);
}

// With the texels of one face alone the light would be cut off there.
static void the_wide_filter_crosses_the_seam_of_two_faces(void **state)
{
    (void) state;
    expect_edge(0.5, 16);
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
        cmocka_unit_test(a_grazed_wall_is_lit_down_to_the_floor),
        cmocka_unit_test(a_shadows_edge_is_a_ramp_as_wide_as_the_filter),
        cmocka_unit_test(the_wide_filter_crosses_the_seam_of_two_faces),
        cmocka_unit_test(sphere_about_its_light_is_uniform),
        cmocka_unit_test(emission_is_seen_from_the_front_alone),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
