// SPDX-License-Identifier: MIT
#include "reference_test.h"

// Positions, directions and sums are floats at places: a few units in the last place of 1.
static const double rounding = 1e-5;

// ---- direct light against closed forms ------------------------------------------------

enum { SIDE = 16 };

// A floor of albedo 0.5 under one light, seen from above, bounce 0.
static image render_floor(const ag_light *light)
{
    shapes s = shapes_begin(&test_log);
    test_unit_floor(&s, shapes_diffuse(&s, 0.5f, 0));
    ag_builder_light(s.builder, -1, light);
    ag_scene *scene = test_scene(&s);
    const ag_camera camera = test_camera_down(3);
    image img =
        test_render((reference_desc){ .width = SIDE, .height = SIDE, .spp = 1 }, scene, &camera);
    ag_scene_destroy(scene);
    return img;
}

// Radiance where the light leaves its source with `intensity` at the cosine to its axis.
static void expect_floor(const ag_light *light, double (*intensity)(double cosine))
{
    image img = render_floor(light);
    double brightest = 0;
    for (int j = 0; j < SIDE; ++j)
        for (int i = 0; i < SIDE; ++i) {
            const double x = (i + 0.5) / SIDE - light->position[0];
            const double y = 1 - (j + 0.5) / SIDE - light->position[1];
            const double z = light->position[2], d2 = x * x + y * y + z * z;
            const double cosine = z / sqrt(d2); // at both ends: the axis is the plane's normal
            const double expected = 0.5 / test_pi * intensity(cosine) * cosine / d2;
            test_near(test_value(&img, i, j, 0), expected, 1e-4 * expected + 1e-9);
            brightest = fmax(brightest, expected);
        }
    assert_true(brightest > 0);
    image_finish(&img);
}

static double always_three(double cosine)
{
    (void) cosine;
    return 3;
}

static double squared_ramp(double cosine)
{
    const double ramp =
        fmin(fmax((cosine - (double) 0.8f) / ((double) 0.95f - (double) 0.8f), 0), 1);
    return 3 * ramp * ramp;
}

static double three_cosines(double cosine)
{
    return 3 * cosine;
}

static const ag_light overhead = { .name = "l",
                                   .kind = AG_LIGHT_POINT,
                                   .position = { 0.3, 0.6, 0.8 },
                                   .direction = { 0, 0, -1 },
                                   .intensity = { 3, 3, 3 } };

static void a_point_light_over_a_plane_is_exact(void **state)
{
    (void) state;
    expect_floor(&overhead, always_three);
}

static void a_spot_fades_by_the_squared_ramp(void **state)
{
    (void) state;
    ag_light light = overhead;
    light.kind = AG_LIGHT_SPOT;
    light.cos_inner = 0.95f;
    light.cos_outer = 0.8f;
    expect_floor(&light, squared_ramp);
}

static void a_cosine_spot_shines_by_its_cosine(void **state)
{
    (void) state;
    ag_light light = overhead;
    light.kind = AG_LIGHT_SPOT;
    light.cosine = true;
    light.cos_outer = 0;
    expect_floor(&light, three_cosines);
}

static void a_directional_light_is_uniform(void **state)
{
    (void) state;
    ag_light light = overhead;
    light.kind = AG_LIGHT_DIRECTIONAL;
    light.direction[1] = 0.6f;
    light.direction[2] = -0.8f;
    image img = render_floor(&light);
    for (int i = 0; i < 3 * SIDE * SIDE; ++i)
        test_near((double) img.rgb[i], 0.5 / test_pi * 3 * 0.8, 1e-5);
    image_finish(&img);
}

static void light_from_behind_the_face_is_dark(void **state)
{
    (void) state;
    ag_light light = overhead;
    light.position[2] = -0.5;
    image img = render_floor(&light);
    assert_true(test_mean(&img) == 0);
    image_finish(&img);
}

// ---- shadows, masks, sides ------------------------------------------------------------

// A quad at half height whose left half is masked away, under a light far above: the floor
// is lit where x < 0.5.
static void a_mask_lets_light_through(void **state)
{
    (void) state;
    const uint8_t texels[8] = { 255, 255, 255, 0, 255, 255, 255, 255 };
    const ag_texture texture = { .name = "mask",
                                 .width = 2,
                                 .height = 1,
                                 .rgba = texels,
                                 .nearest = true,
                                 .wrap_u = AG_WRAP_CLAMP };
    const ag_light light = { .name = "l",
                             .kind = AG_LIGHT_DIRECTIONAL,
                             .direction = { 0, 0, -1 },
                             .intensity = { 1, 1, 1 } };
    shapes s = shapes_begin(&test_log);
    ag_material m = ag_default_material();
    m.base_color_tex.texture = ag_builder_texture(s.builder, &texture);
    m.alpha = AG_ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    test_unit_floor(&s, shapes_diffuse(&s, 0.5f, 0));
    shapes_quad(&s, s.node, ag_builder_material(s.builder, &m), (float[]){ 0, 0, 1 },
                (float[]){ 1, 0, 0 }, (float[]){ 0, 1, 0 });
    ag_builder_light(s.builder, -1, &light);
    ag_scene *scene = test_scene(&s);
    const ag_camera camera = test_camera_down(0.5);
    image img =
        test_render((reference_desc){ .width = SIDE, .height = SIDE, .spp = 1 }, scene, &camera);
    for (int i = 0; i < SIDE * SIDE; ++i)
        test_near(test_value(&img, i % SIDE, i / SIDE, 0), i % SIDE < SIDE / 2 ? 0.5 / test_pi : 0,
                  rounding);
    image_finish(&img);
    ag_scene_destroy(scene);
}

// The floor seen and lit from below reflects as from above; its normal is turned.
static void surfaces_are_two_sided(void **state)
{
    (void) state;
    shapes s = shapes_begin(&test_log);
    test_unit_floor(&s, shapes_diffuse(&s, 0.5f, 0));
    ag_light light = overhead;
    light.kind = AG_LIGHT_DIRECTIONAL;
    light.direction[2] = 1;
    ag_builder_light(s.builder, -1, &light);
    ag_scene *scene = test_scene(&s);
    const ag_camera camera = shapes_camera((double[]){ 0.5, 0.5, -2 }, (double[]){ 0.5, 0.5, 0 },
                                           (double[]){ 0, 1, 0 }, 0.2);
    image img = test_render((reference_desc){ .width = 4, .height = 4, .spp = 1 }, scene, &camera);
    test_near(test_mean(&img), 0.5 / test_pi * 3, rounding);
    image_finish(&img);
    img = test_render(
        (reference_desc){ .width = 4, .height = 4, .spp = 1, .layer = REFERENCE_NORMAL }, scene,
        &camera);
    for (int i = 0; i < 16; ++i)
        test_near(test_value(&img, i % 4, i / 4, 2), -1, rounding);
    image_finish(&img);
    ag_scene_destroy(scene);
}

static double seen_emission(bool double_sided, double camera_height)
{
    shapes s = shapes_begin(&test_log);
    ag_material m = ag_default_material();
    m.emissive[0] = 2;
    m.double_sided = double_sided;
    test_unit_floor(&s, ag_builder_material(s.builder, &m));
    ag_scene *scene = test_scene(&s);
    const ag_camera camera = shapes_camera((double[]){ 0.5, 0.5, camera_height },
                                           (double[]){ 0.5, 0.5, 0 }, (double[]){ 0, 1, 0 }, 0.2);
    image img = test_render((reference_desc){ .width = 4, .height = 4, .spp = 1 }, scene, &camera);
    const double mean = test_mean(&img);
    image_finish(&img);
    ag_scene_destroy(scene);
    return mean;
}

static void emission_is_seen_from_the_front_or_both_sides(void **state)
{
    (void) state;
    test_near(seen_emission(false, 2), 2, rounding);
    test_near(seen_emission(false, -2), 0, 0);
    test_near(seen_emission(true, 2), 2, rounding);
    test_near(seen_emission(true, -2), 2, rounding);
}

// ---- layers, cameras, filters ---------------------------------------------------------

// A wall that fills the left half of the view; camera as in test_camera_down().
static ag_scene *left_half(double away)
{
    shapes s = shapes_begin(&test_log);
    const ag_node_desc place = { .name = "place", .parent = -1, .translation = { away, 0, 0 } };
    const int node = ag_builder_node(s.builder, &place);
    shapes_quad(&s, node, shapes_diffuse(&s, 0.25f, 1), (float[]){ 0, 0, 0 },
                (float[]){ 0.5f, 0, 0 }, (float[]){ 0, 1, 0 });
    return test_scene(&s);
}

static void layers_show_what_they_say(void **state)
{
    (void) state;
    ag_scene *scene = left_half(0);
    const ag_camera camera = test_camera_down(1);
    reference_desc desc = { .width = 2, .height = 1, .spp = 1, .layer = REFERENCE_POSITION };
    image img = test_render(desc, scene, &camera);
    // The pixel is twice as wide as high: half_height is of the height.
    const float expected[] = { 0, 0.5f, 0, 0, 0, 0 };
    for (int i = 0; i < 6; ++i)
        test_near((double) img.rgb[i], (double) expected[i], rounding);
    image_finish(&img);
    desc.width = 1;
    desc.height = 2;
    desc.layer = REFERENCE_ALBEDO;
    img = test_render(desc, scene, &camera);
    test_near((double) img.rgb[0], 0.25, rounding);
    image_finish(&img);
    ag_scene_destroy(scene);
}

static void a_box_filter_averages_the_pixel(void **state)
{
    (void) state;
    ag_scene *scene = left_half(0.25 - 0.5); // covers a quarter
    const ag_camera camera = test_camera_down(1);
    reference_desc desc = { .width = 1, .height = 1, .spp = 64, .filter = REFERENCE_BOX };
    image img = test_render(desc, scene, &camera);
    // 64 points of a (0,2)-sequence: each 64th of the width has one.
    test_near((double) img.rgb[0], 0.25, rounding);
    image_finish(&img);
    desc.filter = REFERENCE_POINT;
    img = test_render(desc, scene, &camera);
    assert_true(img.rgb[0] == 0);
    image_finish(&img);
    ag_scene_destroy(scene);
}

// A perspective pixel's position is where its ray meets the plane.
static void perspective_rays_pass_the_pixel_centres(void **state)
{
    (void) state;
    shapes s = shapes_begin(&test_log);
    shapes_quad(&s, s.node, -1, (float[]){ -50, -50, 0 }, (float[]){ 100, 0, 0 },
                (float[]){ 0, 100, 0 });
    ag_scene *scene = test_scene(&s);
    const ag_camera camera =
        shapes_camera((double[]){ 0, 0, 4 }, (double[]){ 0, 0, 0 }, (double[]){ 0, 1, 0 }, 0.9);
    image img = test_render(
        (reference_desc){ .width = 6, .height = 4, .spp = 1, .layer = REFERENCE_POSITION }, scene,
        &camera);
    const double edge = 4 * tan((double) 0.9f / 2);
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 6; ++i) {
            test_near(test_value(&img, i, j, 0), edge * ((i + 0.5) / 2 - 1.5), rounding);
            test_near(test_value(&img, i, j, 1), edge * (1 - (j + 0.5) / 2), rounding);
        }
    image_finish(&img);
    ag_scene_destroy(scene);
}

// Nearer than the near plane nothing is seen.
static void the_near_plane_cuts(void **state)
{
    (void) state;
    ag_scene *scene = left_half(0);
    ag_camera camera = shapes_camera((double[]){ 0.25, 0.5, 1 }, (double[]){ 0.25, 0.5, 0 },
                                     (double[]){ 0, 1, 0 }, 0.1);
    for (int cut = 0; cut < 2; ++cut) {
        camera.znear = cut ? 1.01f : 0.99f;
        image img =
            test_render((reference_desc){ .width = 2, .height = 2, .spp = 1 }, scene, &camera);
        test_near(test_mean(&img), cut ? 0 : 1, rounding);
        image_finish(&img);
    }
    ag_scene_destroy(scene);
}

static const size_t room_bytes = (size_t) (3 * 40 * 24) * sizeof(float);

// ---- a lit room: determinism, noise, invariance ---------------------------------------

static ag_scene *lit_room(double away, double scale)
{
    shapes s = shapes_begin(&test_log);
    const ag_node_desc place = { .name = "place",
                                 .parent = -1,
                                 .translation = { away, -away, away },
                                 .scale = { scale, scale, scale } };
    s.node = ag_builder_node(s.builder, &place);
    const float power = (float) (scale * scale);
    const ag_light light = { .name = "l",
                             .kind = AG_LIGHT_POINT,
                             .position = { away + 0.3 * scale, -away + 0.2 * scale, away },
                             .intensity = { power, power, power } };
    shapes_room(&s, shapes_diffuse(&s, 0.6f, 0), (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
    shapes_quad(&s, s.node, -1, (float[]){ -0.5f, -0.5f, -0.5f }, (float[]){ 0, 0, 1 },
                (float[]){ 0.6f, 0.2f, 0 });
    ag_builder_light(s.builder, -1, &light);
    return test_scene(&s);
}

static ag_camera room_camera(double away, double scale)
{
    return shapes_camera((double[]){ away - 0.6 * scale, -away + 0.5 * scale, away + 0.8 * scale },
                         (double[]){ away, -away - 0.2 * scale, away }, (double[]){ 0, 1, 0 }, 1.2);
}

static image render_room(reference_desc desc)
{
    ag_scene *scene = lit_room(0, 1);
    const ag_camera camera = room_camera(0, 1);
    desc.width = 40;
    desc.height = 24;
    desc.bounces = 2;
    desc.layer = REFERENCE_INDIRECT;
    image img = test_render(desc, scene, &camera);
    ag_scene_destroy(scene);
    return img;
}

static double distance(const image *a, const image *b)
{
    double sum = 0;
    const int n = 3 * a->width * a->height;
    for (int i = 0; i < n; ++i) {
        const double d = (double) a->rgb[i] - (double) b->rgb[i];
        sum += d * d;
    }
    return sqrt(sum / n);
}

static void threads_do_not_change_a_bit(void **state)
{
    (void) state;
    image one = render_room((reference_desc){ .spp = 8, .threads = 1 });
    image three = render_room((reference_desc){ .spp = 8, .threads = 3 });
    image all = render_room((reference_desc){ .spp = 8 });
    assert_memory_equal(one.rgb, three.rgb, room_bytes);
    assert_memory_equal(one.rgb, all.rgb, room_bytes);
    image_finish(&one);
    image_finish(&three);
    image_finish(&all);
}

// Four times the samples: half the noise or less. Two seeds differ by noise alone, sqrt(2) of it.
static void noise_falls_as_the_root_of_the_samples(void **state)
{
    (void) state;
    const int spp[] = { 4, 16, 64, 256 };
    double noise[4], means[4];
    for (int i = 0; i < 4; ++i) {
        image a = render_room((reference_desc){ .spp = spp[i], .seed = 1 });
        image b = render_room((reference_desc){ .spp = spp[i], .seed = 2 });
        noise[i] = distance(&a, &b) / sqrt(2);
        means[i] = (test_mean(&a) + test_mean(&b)) / 2;
        assert_true(noise[i] > 0);
        image_finish(&a);
        image_finish(&b);
    }
    // 960 pixels: the noise itself is known to 1 / sqrt(2 * 960 * 3) of it, some percent.
    for (int i = 1; i < 4; ++i)
        assert_true(noise[i] < 0.5 * 1.1 * noise[i - 1]);
    // The means of 1920 pixels: four deviations.
    for (int i = 0; i < 3; ++i)
        test_near(means[i], means[3], 4 * noise[i] / sqrt(1920));
}

// The same room 10^6 m away, where a float knows 6 cm: what is off is the light's position,
// relative to the camera, by 10^-10.
static void far_from_the_origin_is_like_near(void **state)
{
    (void) state;
    ag_scene *scene = lit_room(1e6, 1);
    const ag_camera camera = room_camera(1e6, 1);
    image there = test_render(
        (reference_desc){
            .width = 40, .height = 24, .bounces = 2, .spp = 16, .layer = REFERENCE_INDIRECT },
        scene, &camera);
    image here = render_room((reference_desc){ .spp = 16 });
    assert_true(test_mean(&here) > 0);
    // Single rays may fall on the other side of an edge.
    test_near(test_mean(&there), test_mean(&here), 1e-3 * test_mean(&here));
    image_finish(&there);
    image_finish(&here);
    ag_scene_destroy(scene);
}

// Lengths times s, intensities times s^2: the same picture.
static void scale_does_not_matter(void **state)
{
    (void) state;
    const double scales[] = { 1e-4, 1e4 };
    image here = render_room((reference_desc){ .spp = 16 });
    for (int i = 0; i < 2; ++i) {
        ag_scene *scene = lit_room(0, scales[i]);
        ag_camera camera = room_camera(0, scales[i]);
        camera.znear *= (float) scales[i];
        image scaled = test_render(
            (reference_desc){
                .width = 40, .height = 24, .bounces = 2, .spp = 16, .layer = REFERENCE_INDIRECT },
            scene, &camera);
        test_near(test_mean(&scaled), test_mean(&here), 1e-3 * test_mean(&here));
        image_finish(&scaled);
        ag_scene_destroy(scene);
    }
    image_finish(&here);
}

// A light on a surface, and one where the camera stands: finite.
static void lights_in_bad_places_stay_finite(void **state)
{
    (void) state;
    for (int i = 0; i < 2; ++i) {
        shapes s = shapes_begin(&test_log);
        ag_light light = { .name = "l", .kind = AG_LIGHT_POINT, .intensity = { 1, 1, 1 } };
        if (i == 0)
            light.position[1] = -1;
        shapes_room(&s, shapes_diffuse(&s, 0.6f, 0), (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
        ag_builder_light(s.builder, -1, &light);
        ag_scene *scene = test_scene(&s);
        const ag_camera camera = shapes_camera((double[]){ 0, 0, 0 }, (double[]){ 0, -1, 0.01 },
                                               (double[]){ 0, 0, 1 }, 1);
        image img = test_render((reference_desc){ .width = 9, .height = 9, .bounces = 2, .spp = 4 },
                                scene, &camera);
        for (int k = 0; k < 3 * 81; ++k)
            assert_true(isfinite(img.rgb[k]) && img.rgb[k] >= 0);
        image_finish(&img);
        ag_scene_destroy(scene);
    }
}

// ---- the call -------------------------------------------------------------------------

static void note_progress(void *user, double fraction)
{
    double *last = user;
    assert_true(fraction > *last);
    *last = fraction;
}

static void progress_goes_up_to_one(void **state)
{
    (void) state;
    double last = 0;
    image img = render_room((reference_desc){
        .spp = 1, .threads = 2, .progress = note_progress, .progress_user = &last });
    assert_true(last == 1);
    image_finish(&img);
}

// What is told of the noise is what is off from many samples of another seed. Of 960 pixels in
// three channels, which are alike: known to 1 / sqrt(2 * 960) of it, 2 %, were it normal; it has
// longer tails.
static void two_halves_know_their_noise(void **state)
{
    (void) state;
    image img, many = render_room((reference_desc){ .spp = 2048, .seed = 7 });
    double noise, last = 0;
    ag_scene *scene = lit_room(0, 1);
    const ag_camera camera = room_camera(0, 1);
    const reference_desc desc = {
        .log = &test_log,
        .scene = scene,
        .camera = &camera,
        .width = many.width,
        .height = many.height,
        .bounces = 2,
        .spp = 32,
        .layer = REFERENCE_INDIRECT,
        .progress = note_progress,
        .progress_user = &last,
    };
    assert_int_equal(reference_render_halves(&desc, &img, &noise), FG_OK);
    assert_true(last == 1);
    test_near(noise, distance(&img, &many), 0.2 * noise);
    test_near(test_mean(&img), test_mean(&many), 4 * noise / sqrt(960));
    image_finish(&img);
    image_finish(&many);
    ag_scene_destroy(scene);
}

static void mistakes_are_refused_in_words(void **state)
{
    (void) state;
    ag_scene *scene = left_half(0);
    const ag_camera camera = test_camera_down(1);
    ag_camera broken = camera;
    broken.world[3] = (double) NAN;
    const reference_desc good = {
        .log = &test_log, .scene = scene, .camera = &camera, .width = 2, .height = 2, .spp = 1
    };
    struct {
        reference_desc desc;
        const char *reason;
    } cases[8];
    for (int i = 0; i < 8; ++i)
        cases[i].desc = good;
    cases[0].desc.spp = 0, cases[0].reason = "spp is 0, must be 1 to 1048576";
    cases[1].desc.bounces = 65, cases[1].reason = "bounces is 65, must be 0 to 64";
    cases[2].desc.bounces = -1, cases[2].reason = "bounces is -1, must be 0 to 64";
    cases[3].desc.width = 0, cases[3].reason = "size is 0 x 2, must be at least 1 x 1";
    cases[4].desc.camera = &broken, cases[4].reason = "a camera that is finite";
    cases[5].desc.scene = NULL, cases[5].reason = "needs a scene";
    cases[6].desc.unshadowed_bounce = true, cases[6].reason = "1 or more for unshadowed bounces";
    cases[7].desc.threads = -1, cases[7].reason = "threads is -1, must be 0 or more";
    for (int i = 0; i < 8; ++i) {
        image img;
        assert_int_equal(reference_render(&cases[i].desc, &img), FG_ERR_INVALID);
        assert_null(img.rgb);
        if (!strstr(test_message, cases[i].reason))
            fail_msg("\"%s\" does not say \"%s\"", test_message, cases[i].reason);
    }
    ag_scene_destroy(scene);
}

static void an_empty_scene_is_black(void **state)
{
    (void) state;
    shapes s = shapes_begin(&test_log);
    ag_scene *scene = test_scene(&s);
    const ag_camera camera = test_camera_down(1);
    image img = test_render((reference_desc){ .width = 3, .height = 5, .bounces = 2, .spp = 4 },
                            scene, &camera);
    for (int i = 0; i < 3 * 15; ++i)
        assert_true(img.rgb[i] == 0);
    image_finish(&img);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_light_over_a_plane_is_exact),
        cmocka_unit_test(a_spot_fades_by_the_squared_ramp),
        cmocka_unit_test(a_cosine_spot_shines_by_its_cosine),
        cmocka_unit_test(a_directional_light_is_uniform),
        cmocka_unit_test(light_from_behind_the_face_is_dark),
        cmocka_unit_test(a_mask_lets_light_through),
        cmocka_unit_test(surfaces_are_two_sided),
        cmocka_unit_test(emission_is_seen_from_the_front_or_both_sides),
        cmocka_unit_test(layers_show_what_they_say),
        cmocka_unit_test(a_box_filter_averages_the_pixel),
        cmocka_unit_test(perspective_rays_pass_the_pixel_centres),
        cmocka_unit_test(the_near_plane_cuts),
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(noise_falls_as_the_root_of_the_samples),
        cmocka_unit_test(two_halves_know_their_noise),
        cmocka_unit_test(far_from_the_origin_is_like_near),
        cmocka_unit_test(scale_does_not_matter),
        cmocka_unit_test(lights_in_bad_places_stay_finite),
        cmocka_unit_test(progress_goes_up_to_one),
        cmocka_unit_test(mistakes_are_refused_in_words),
        cmocka_unit_test(an_empty_scene_is_black),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
