// SPDX-License-Identifier: MIT
#include "reference_test.h"

// Where there is no noise, what is left is the float of textures, normals and the picture.
static const double rounding = 1e-5;

// ---- furnaces -------------------------------------------------------------------------

static double furnace(bool round, double albedo, int bounces)
{
    shapes s = shapes_begin(&test_log);
    const int material = shapes_diffuse(&s, (float) albedo, 1);
    if (round)
        shapes_sphere_inside(&s, material, 1, 48);
    else
        shapes_room(&s, material, (float[]){ -1, -2, -1 }, (float[]){ 2, 1, 1 });
    ag_scene *scene = test_scene(&s);
    const ag_camera camera = shapes_camera(
        (double[]){ 0.1, 0.2, -0.3 }, (double[]){ 0.8, -0.5, 0.6 }, (double[]){ 0, 1, 0 }, 1.2);
    image img =
        test_render((reference_desc){ .width = 24, .height = 16, .bounces = bounces, .spp = 64 },
                    scene, &camera);
    const double mean = test_mean(&img);
    image_finish(&img);
    ag_scene_destroy(scene);
    return mean;
}

static double partial_sum(double albedo, int bounces)
{
    return (1 - pow(albedo, bounces + 1)) / (1 - albedo);
}

// Every path is worth the same, so that there is no noise at all.
static void a_closed_box_that_emits_is_a_furnace(void **state)
{
    (void) state;
    const int bounces[] = { 0, 1, 2, 4 };
    for (int i = 0; i < FG_COUNT(bounces); ++i) {
        const double expected = partial_sum(0.5, bounces[i]);
        test_near(furnace(false, 0.5, bounces[i]), expected, rounding * expected);
    }
}

// Of a path of weight w = 0.8^4 one in 1/w goes on at bounce 5, and so on: a sample has a variance
// below the square of what the later bounces add, 0.8^5 / 0.2 = 1.6. 24 x 16 x 64 samples: one
// deviation is 0.01 of 4.9; four of them are 1 %.
static void russian_roulette_keeps_the_mean(void **state)
{
    (void) state;
    const double expected = partial_sum(0.8, 16);
    test_near(furnace(false, 0.8, 16), expected, 0.01 * expected);
}

// Smooth normals on facets: of the directions around a normal that leans by up to d = 2.7
// degrees from its facet, (1 - cos d) / 2 = 0.06 % lie behind the facet, at each bounce.
static void a_sphere_of_facets_is_a_furnace_too(void **state)
{
    (void) state;
    test_near(furnace(true, 0.5, 1), 1.5, 1.5 * 0.0006);
    test_near(furnace(true, 0.5, 4), partial_sum(0.5, 4), partial_sum(0.5, 4) * 0.0012);
}

// A light of intensity I in the middle: E = I / R^2 everywhere, and each bounce albedo times
// the one before. Facets of 48 rings lie up to 0.11 % nearer, 0.2 % of E; leaning normals cost as
// in the furnace.
static void a_lit_sphere_is_uniform_at_every_bounce(void **state)
{
    (void) state;
    const double albedo = 0.6, radius = 2, intensity = 5;
    shapes s = shapes_begin(&test_log);
    shapes_sphere_inside(&s, shapes_diffuse(&s, (float) albedo, 0), (float) radius, 48);
    const ag_light light = { .name = "l", .kind = AG_LIGHT_POINT, .intensity = { 5, 5, 5 } };
    ag_builder_light(s.builder, -1, &light);
    ag_scene *scene = test_scene(&s);
    const ag_camera camera = shapes_camera((double[]){ 0.4, -0.2, 0.3 }, (double[]){ 1, 0.5, -1 },
                                           (double[]){ 0, 1, 0 }, 1.2);
    double factor = albedo / test_pi * intensity / (radius * radius), sum = 0;
    for (int bounces = 1; bounces <= 3; ++bounces) {
        const reference_desc desc = {
            .width = 16, .height = 16, .bounces = bounces, .spp = 64, .layer = REFERENCE_INDIRECT
        };
        image img = test_render(desc, scene, &camera);
        factor *= albedo;
        sum += factor;
        test_near(test_mean(&img), sum, 0.005 * sum);
        for (int i = 0; i < 3 * 16 * 16; ++i)
            test_near((double) img.rgb[i], sum, 0.02 * sum);
        image_finish(&img);
    }
    ag_scene_destroy(scene);
}

// ---- form factors ---------------------------------------------------------------------

// A white receiver under an emitter of radiance 1 shows the fraction of its hemisphere that the
// emitter fills; over all of it the mean is the form factor. 64^2 x 64 samples have a noise of
// at most sqrt(F (1 - F) / 262144) = 0.0008, less when stratified, that is 0.4 % of 0.2.
static double form_factor(const float corner[3], const float a[3], const float b[3],
                          reference_desc desc)
{
    shapes s = shapes_begin(&test_log);
    test_unit_floor(&s, shapes_diffuse(&s, 1, 0));
    shapes_quad(&s, s.node, shapes_diffuse(&s, 0, 1), corner, a, b);
    ag_scene *scene = test_scene(&s);
    const ag_camera camera = test_camera_down(0.5);
    desc.width = desc.height = 64;
    desc.bounces = 1;
    desc.layer = REFERENCE_INDIRECT;
    desc.spp = 64;
    image img = test_render(desc, scene, &camera);
    const double mean = test_mean(&img);
    image_finish(&img);
    ag_scene_destroy(scene);
    return mean;
}

static void parallel_unit_squares_have_their_form_factor(void **state)
{
    (void) state;
    const double f = form_factor((float[]){ 0, 0, 1 }, (float[]){ 0, 1, 0 }, (float[]){ 1, 0, 0 },
                                 (reference_desc){ 0 });
    test_near(f, 0.19982, 0.01 * 0.19982);
}

static void perpendicular_unit_squares_have_their_form_factor(void **state)
{
    (void) state;
    const double f = form_factor((float[]){ 0, 0, 0 }, (float[]){ 0, 1, 0 }, (float[]){ 0, 0, 1 },
                                 (reference_desc){ 0 });
    test_near(f, 0.20004, 0.01 * 0.20004);
}

static void the_back_of_an_emitter_is_dark(void **state)
{
    (void) state;
    const double f = form_factor((float[]){ 0, 0, 1 }, (float[]){ 1, 0, 0 }, (float[]){ 0, 1, 0 },
                                 (reference_desc){ 0 });
    assert_true(f == 0);
}

// ---- bounces that nothing hides -------------------------------------------------------

// A floor, a lit plate above it, and what may stand between; the light is above or below.
typedef struct plates {
    double light_height;
    bool blocker; // a black quad between plate and floor
} plates;

static const double plate_height = 0.8, plate_albedo = 0.7, light_at[2] = { 0.4, 0.6 };

static image render_plates(plates with, bool unshadowed)
{
    shapes s = shapes_begin(&test_log);
    const int black = shapes_diffuse(&s, 0, 0);
    const float x[] = { 1, 0, 0 }, y[] = { 0, 1, 0 };
    test_unit_floor(&s, shapes_diffuse(&s, 1, 0));
    shapes_quad(&s, s.node, shapes_diffuse(&s, (float) plate_albedo, 0),
                (float[]){ 0, 0, (float) plate_height }, x, y);
    if (with.blocker)
        shapes_quad(&s, s.node, black, (float[]){ -1, -1, 0.2f }, (float[]){ 3, 0, 0 },
                    (float[]){ 0, 3, 0 });
    const ag_light light = { .name = "l",
                             .kind = AG_LIGHT_POINT,
                             .position = { light_at[0], light_at[1], with.light_height },
                             .intensity = { 2, 2, 2 } };
    ag_builder_light(s.builder, -1, &light);
    ag_scene *scene = test_scene(&s);
    const ag_camera camera = test_camera_down(0.05);
    const reference_desc desc = { .width = 8,
                                  .height = 8,
                                  .bounces = 1,
                                  .spp = 1024,
                                  .layer = REFERENCE_INDIRECT,
                                  .unshadowed_bounce = unshadowed };
    image img = test_render(desc, scene, &camera);
    ag_scene_destroy(scene);
    return img;
}

// E / pi from the plate's lower side, lit from below: the sum over small squares of
// albedo / pi E_j cos_i cos_j / d^2 dA.
static double plate_to_floor(double x, double y, double light_height)
{
    enum { CELLS = 200 };
    double sum = 0;
    for (int i = 0; i < CELLS; ++i)
        for (int j = 0; j < CELLS; ++j) {
            const double px = (i + 0.5) / CELLS, py = (j + 0.5) / CELLS;
            const double lx = px - light_at[0], ly = py - light_at[1];
            const double lz = plate_height - light_height;
            const double l2 = lx * lx + ly * ly + lz * lz;
            const double d2 =
                (px - x) * (px - x) + (py - y) * (py - y) + plate_height * plate_height;
            const double lit = 2 * lz / (l2 * sqrt(l2));
            sum += plate_albedo / test_pi * lit * plate_height * plate_height / (d2 * d2);
        }
    return sum / ((double) CELLS * CELLS) / test_pi;
}

// 1024 stratified samples of a value that varies by a factor of a few: well below 1 %.
static void expect_plate_light(const image *img, double light_height)
{
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) {
            const double expected = plate_to_floor((i + 0.5) / 8, 1 - (j + 0.5) / 8, light_height);
            test_near((double) img->rgb[3 * (8 * j + i)], expected, 0.02 * expected);
        }
}

static void one_bounce_is_the_area_integral(void **state)
{
    (void) state;
    image img = render_plates((plates){ .light_height = 0.3 }, false);
    expect_plate_light(&img, 0.3);
    image_finish(&img);
}

// The light is between blocker and plate: the plate is lit, and hidden from the floor.
static void what_hides_the_plate_counts_unless_asked_not_to(void **state)
{
    (void) state;
    const plates hidden = { .light_height = 0.3, .blocker = true };
    image img = render_plates(hidden, false);
    assert_true(test_mean(&img) == 0);
    image_finish(&img);
    img = render_plates(hidden, true);
    expect_plate_light(&img, 0.3);
    image_finish(&img);
}

// Without anything in between the two are the same sum of the same rays.
static void nothing_hidden_makes_no_difference(void **state)
{
    (void) state;
    image shadowed = render_plates((plates){ .light_height = 0.3 }, false);
    image unshadowed = render_plates((plates){ .light_height = 0.3 }, true);
    assert_memory_equal(shadowed.rgb, unshadowed.rgb, 3 * 64 * sizeof(float));
    image_finish(&shadowed);
    image_finish(&unshadowed);
}

// Lit from above, the plate's upper side shines away from the floor.
static void a_lit_side_that_is_turned_away_adds_nothing(void **state)
{
    (void) state;
    image img = render_plates((plates){ .light_height = 1.2 }, true);
    assert_true(test_mean(&img) == 0);
    image_finish(&img);
}

// Shadows of the light itself stay: a blocker below the plate, with the light below both.
static void an_unlit_plate_adds_nothing(void **state)
{
    (void) state;
    image img = render_plates((plates){ .light_height = 0.1, .blocker = true }, true);
    assert_true(test_mean(&img) == 0);
    image_finish(&img);
}

// Emission counts likewise, from the side that emits.
static void hidden_emitters_count_when_asked(void **state)
{
    (void) state;
    const double f = form_factor((float[]){ 0, 0, 1 }, (float[]){ 0, 1, 0 }, (float[]){ 1, 0, 0 },
                                 (reference_desc){ .unshadowed_bounce = true });
    test_near(f, 0.19982, 0.01 * 0.19982);
    const double back =
        form_factor((float[]){ 0, 0, 1 }, (float[]){ 1, 0, 0 }, (float[]){ 0, 1, 0 },
                    (reference_desc){ .unshadowed_bounce = true });
    assert_true(back == 0);
}

// In a convex room every ray meets one surface from inside and no other behind it.
static void unshadowed_bounces_in_a_convex_room_are_ordinary_ones(void **state)
{
    (void) state;
    shapes s = shapes_begin(&test_log);
    shapes_room(&s, shapes_diffuse(&s, 0.5f, 1), (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
    ag_scene *scene = test_scene(&s);
    const ag_camera camera =
        shapes_camera((double[]){ 0, 0, 0 }, (double[]){ 1, 0.3, 0.2 }, (double[]){ 0, 1, 0 }, 1);
    const reference_desc desc = {
        .width = 8, .height = 8, .bounces = 3, .spp = 16, .unshadowed_bounce = true
    };
    image img = test_render(desc, scene, &camera);
    test_near(test_mean(&img), partial_sum(0.5, 3), rounding);
    image_finish(&img);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closed_box_that_emits_is_a_furnace),
        cmocka_unit_test(russian_roulette_keeps_the_mean),
        cmocka_unit_test(a_sphere_of_facets_is_a_furnace_too),
        cmocka_unit_test(a_lit_sphere_is_uniform_at_every_bounce),
        cmocka_unit_test(parallel_unit_squares_have_their_form_factor),
        cmocka_unit_test(perpendicular_unit_squares_have_their_form_factor),
        cmocka_unit_test(the_back_of_an_emitter_is_dark),
        cmocka_unit_test(one_bounce_is_the_area_integral),
        cmocka_unit_test(what_hides_the_plate_counts_unless_asked_not_to),
        cmocka_unit_test(nothing_hidden_makes_no_difference),
        cmocka_unit_test(a_lit_side_that_is_turned_away_adds_nothing),
        cmocka_unit_test(an_unlit_plate_adds_nothing),
        cmocka_unit_test(hidden_emitters_count_when_asked),
        cmocka_unit_test(unshadowed_bounces_in_a_convex_room_are_ordinary_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
