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

// A floor, a plate above it, and what lights the plate.
typedef struct plates {
    ag_light lights[4];
    int count;
    bool blocker; // a black quad between plate and floor
    bool unshadowed;
} plates;

static const double plate_height = 0.8, plate_albedo = 0.7;

static plates lit_by(ag_light_kind kind, double height)
{
    plates with = { .count = 1 };
    with.lights[0] = (ag_light){ .name = "l",
                                 .kind = kind,
                                 .position = { 0.4, 0.6, height },
                                 .direction = { 0, 0, 1 },
                                 .intensity = { 2, 2, 2 },
                                 .cos_inner = 0.95f,
                                 .cos_outer = 0.7f };
    return with;
}

static image render_plates(plates with)
{
    shapes s = shapes_begin(&test_log);
    const float x[] = { 1, 0, 0 }, y[] = { 0, 1, 0 };
    test_unit_floor(&s, shapes_diffuse(&s, 1, 0));
    shapes_quad(&s, s.node, shapes_diffuse(&s, (float) plate_albedo, 0),
                (float[]){ 0, 0, (float) plate_height }, x, y);
    if (with.blocker)
        shapes_quad(&s, s.node, shapes_diffuse(&s, 0, 0), (float[]){ -1, -1, 0.2f },
                    (float[]){ 3, 0, 0 }, (float[]){ 0, 3, 0 });
    for (int i = 0; i < with.count; ++i)
        ag_builder_light(s.builder, -1, with.lights + i);
    ag_scene *scene = test_scene(&s);
    const ag_camera camera = test_camera_down(0.05);
    const reference_desc desc = { .width = 8,
                                  .height = 8,
                                  .bounces = 1,
                                  .spp = 4096,
                                  .layer = REFERENCE_INDIRECT,
                                  .unshadowed_bounce = with.unshadowed };
    image img = test_render(desc, scene, &camera);
    ag_scene_destroy(scene);
    return img;
}

// E at (x, y) of the plate's lower side.
static double plate_irradiance(const ag_light *light, double x, double y)
{
    const double dx = x - light->position[0], dy = y - light->position[1];
    const double dz = plate_height - light->position[2], d2 = dx * dx + dy * dy + dz * dz;
    const double cosine = dz / sqrt(d2); // to the plate's normal and to the light's axis
    if (light->kind == AG_LIGHT_DIRECTIONAL) {
        // Slanting up past the floor, which shades what lies straight behind it.
        const double floor_x =
            x - plate_height * (double) (light->direction[0] / light->direction[2]);
        return floor_x < 0 ? 2 * (double) light->direction[2] : 0;
    }
    double intensity = 2;
    if (light->kind == AG_LIGHT_SPOT && light->cosine)
        intensity *= cosine;
    else if (light->kind == AG_LIGHT_SPOT)
        intensity *= pow(fmin(fmax((cosine - 0.7) / (0.95 - 0.7), 0), 1), 2);
    return intensity * cosine / d2;
}

// E / pi of the floor: the sum over small squares of the plate of
// albedo / pi E_j cos_i cos_j / d^2 dA.
static double floor_light(const plates *with, double x, double y)
{
    enum { CELLS = 200 };
    double sum = 0;
    for (int i = 0; i < CELLS; ++i)
        for (int j = 0; j < CELLS; ++j) {
            const double px = (i + 0.5) / CELLS, py = (j + 0.5) / CELLS;
            const double d2 =
                (px - x) * (px - x) + (py - y) * (py - y) + plate_height * plate_height;
            double lit = 0;
            for (int k = 0; k < with->count; ++k)
                lit += plate_irradiance(with->lights + k, px, py);
            sum += plate_albedo / test_pi * lit * plate_height * plate_height / (d2 * d2);
        }
    return sum / ((double) CELLS * CELLS) / test_pi;
}

// The farthest pixel of 64 is off by 3.2 % at 1024 samples and by 0.9 % at 16384, as noise is; at
// 4096 that is 1.6 %, and an eighth of it for the mean.
static void expect_floor_light(plates with)
{
    double sum = 0, expected_sum = 0;
    image img = render_plates(with);
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) {
            const double expected = floor_light(&with, (i + 0.5) / 8, 1 - (j + 0.5) / 8);
            test_near(test_value(&img, i, j, 0), expected, 0.02 * expected);
            sum += test_value(&img, i, j, 0);
            expected_sum += expected;
        }
    test_near(sum, expected_sum, 0.003 * expected_sum);
    image_finish(&img);
}

static void expect_dark_floor(plates with)
{
    image img = render_plates(with);
    assert_true(test_mean(&img) == 0);
    image_finish(&img);
}

// Both ways to a lit point, a bounce and a ray from the light, together count it once.
static void one_bounce_is_the_area_integral_for_every_light(void **state)
{
    (void) state;
    plates with = lit_by(AG_LIGHT_POINT, 0.3), all = with;
    expect_floor_light(with);
    with = lit_by(AG_LIGHT_SPOT, 0.3);
    all.lights[all.count++] = with.lights[0];
    expect_floor_light(with);
    with.lights[0].cosine = true;
    all.lights[all.count++] = with.lights[0];
    expect_floor_light(with);
    with = lit_by(AG_LIGHT_DIRECTIONAL, 0);
    with.lights[0].direction[0] = 0.6f;
    with.lights[0].direction[2] = 0.8f;
    all.lights[all.count++] = with.lights[0];
    expect_floor_light(with);
    expect_floor_light(all);
}

// The light is between blocker and plate: the plate is lit, and hidden from the floor.
static void what_hides_the_plate_counts_unless_asked_not_to(void **state)
{
    (void) state;
    plates hidden = lit_by(AG_LIGHT_POINT, 0.3);
    hidden.blocker = true;
    expect_dark_floor(hidden);
    hidden.unshadowed = true;
    expect_floor_light(hidden);
}

// Without anything in between the two are the same sum of the same rays.
static void nothing_hidden_makes_no_difference(void **state)
{
    (void) state;
    plates with = lit_by(AG_LIGHT_POINT, 0.3);
    image shadowed = render_plates(with);
    with.unshadowed = true;
    image unshadowed = render_plates(with);
    assert_memory_equal(shadowed.rgb, unshadowed.rgb, (size_t) (3 * 64) * sizeof(float));
    image_finish(&shadowed);
    image_finish(&unshadowed);
}

// Lit from above, the plate's upper side shines away from the floor.
static void a_lit_side_that_is_turned_away_adds_nothing(void **state)
{
    (void) state;
    plates with = lit_by(AG_LIGHT_POINT, 1.2);
    with.unshadowed = true;
    expect_dark_floor(with);
}

// Shadows of the light itself stay: the light is below the blocker, the plate above it.
static void an_unlit_plate_adds_nothing(void **state)
{
    (void) state;
    plates with = lit_by(AG_LIGHT_POINT, 0.1);
    with.unshadowed = with.blocker = true;
    expect_dark_floor(with);
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
        cmocka_unit_test(one_bounce_is_the_area_integral_for_every_light),
        cmocka_unit_test(what_hides_the_plate_counts_unless_asked_not_to),
        cmocka_unit_test(nothing_hidden_makes_no_difference),
        cmocka_unit_test(a_lit_side_that_is_turned_away_adds_nothing),
        cmocka_unit_test(an_unlit_plate_adds_nothing),
        cmocka_unit_test(hidden_emitters_count_when_asked),
        cmocka_unit_test(unshadowed_bounces_in_a_convex_room_are_ordinary_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
