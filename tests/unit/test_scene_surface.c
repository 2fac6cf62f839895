// SPDX-License-Identifier: MIT
#include "scene_log.h"

#include <math.h>
#include <pass/surface.h>

// Floats of a few operations each.
#define TIGHT 1e-6

static const uint8_t checks[2 * 2 * 4] = {
    255, 0, 0,   255, 0,   255, 0,   128, // first row: red, green
    0,   0, 255, 255, 255, 255, 255, 0,
};

static ag_texture texture_of(ag_wrap wrap, bool srgb, bool nearest)
{
    return (ag_texture){ .width = 2,
                         .height = 2,
                         .rgba = checks,
                         .srgb = srgb,
                         .nearest = nearest,
                         .wrap_u = wrap,
                         .wrap_v = wrap };
}

static void assert_rgba(const float *is, double r, double g, double b, double a)
{
    const double want[4] = { r, g, b, a };
    for (int i = 0; i < 4; i++)
        assert_near(is[i], want[i], TIGHT);
}

static void texel_centres_give_the_texels(void **state)
{
    (void) state;
    ag_texture t = texture_of(AG_WRAP_REPEAT, false, false);
    float rgba[4];
    ag_texture_sample(&t, 0.25f, 0.25f, rgba);
    assert_rgba(rgba, 1, 0, 0, 1);
    ag_texture_sample(&t, 0.75f, 0.25f, rgba);
    assert_rgba(rgba, 0, 1, 0, 128 / 255.0);
    ag_texture_sample(&t, 0.25f, 0.75f, rgba);
    assert_rgba(rgba, 0, 0, 1, 1);
}

static void between_texels_is_their_mean(void **state)
{
    (void) state;
    ag_texture t = texture_of(AG_WRAP_CLAMP, false, false);
    float rgba[4];
    ag_texture_sample(&t, 0.5f, 0.25f, rgba);
    assert_rgba(rgba, 0.5, 0.5, 0, (1 + 128 / 255.0) / 2);
}

static void colours_are_made_linear_before_they_are_filtered(void **state)
{
    (void) state;
    const uint8_t grey[8] = { 0, 0, 0, 255, 255, 255, 255, 255 };
    ag_texture t = { .width = 2, .height = 1, .rgba = grey, .srgb = true };
    float rgba[4];
    ag_texture_sample(&t, 0.5f, 0.5f, rgba);
    assert_rgba(rgba, 0.5, 0.5, 0.5, 1);
    const uint8_t middle[4] = { 188, 188, 188, 188 };
    t = (ag_texture){ .width = 1, .height = 1, .rgba = middle, .srgb = true };
    ag_texture_sample(&t, 0, 0, rgba);
    // sRGB 188 of 255, by IEC 61966-2-1; alpha is never decoded.
    assert_near(rgba[0], pow((188 / 255.0 + 0.055) / 1.055, 2.4), TIGHT);
    assert_near(rgba[3], 188 / 255.0, TIGHT);
}

static void wrap_modes_repeat_clamp_and_mirror(void **state)
{
    (void) state;
    const struct {
        ag_wrap wrap;
        float u;
        double red; // of the first row: texels 1 0
    } cases[] = {
        { AG_WRAP_REPEAT, 1.25f, 1 },  { AG_WRAP_REPEAT, -0.25f, 0 }, { AG_WRAP_REPEAT, 1e7f, 1 },
        { AG_WRAP_CLAMP, 7.0f, 0 },    { AG_WRAP_CLAMP, -7.0f, 1 },   { AG_WRAP_MIRROR, 1.25f, 0 },
        { AG_WRAP_MIRROR, -0.25f, 1 }, { AG_WRAP_MIRROR, 1.75f, 1 },
    };
    for (int i = 0; i < FG_COUNT(cases); i++) {
        ag_texture t = texture_of(cases[i].wrap, false, true);
        float rgba[4];
        ag_texture_sample(&t, cases[i].u, 0.25f, rgba);
        assert_near(rgba[0], cases[i].red, 0);
    }
}

static void absurd_coordinates_stay_in_the_image(void **state)
{
    (void) state;
    const float us[] = { 3e38f, -3e38f, INFINITY, NAN, 1e-40f };
    for (int mode = AG_WRAP_REPEAT; mode <= AG_WRAP_MIRROR; mode++)
        for (int i = 0; i < FG_COUNT(us); i++) {
            ag_texture t = texture_of((ag_wrap) mode, true, false);
            float rgba[4];
            ag_texture_sample(&t, us[i], us[i], rgba);
            for (int k = 0; k < 4; k++)
                assert_true(rgba[k] >= 0 && rgba[k] <= 1.000001f);
        }
}

// ---- surfaces ---------------------------------------------------------------------

static ag_scene *scene_of(ag_material *m, const ag_texture *t)
{
    ag_builder *b = ag_builder_create(NULL, "surface");
    int texture = ag_builder_texture(b, t);
    m->base_color_tex.texture = m->metallic_roughness_tex.texture = m->emissive_tex.texture =
        texture;
    assert_int_equal(ag_builder_material(b, m), 0);
    return build(b);
}

static void a_surface_multiplies_factor_texture_and_vertex_colour(void **state)
{
    (void) state;
    const uint8_t texel[4] = { 51, 102, 204, 128 }; // .2 .4 .8
    ag_texture t = { .width = 1, .height = 1, .rgba = texel };
    ag_material m = ag_default_material();
    for (int i = 0; i < 3; i++)
        m.base_color[i] = 0.5f;
    m.metallic = 0.5f;
    m.emissive[0] = 10;
    ag_scene *s = scene_of(&m, &t);
    const float uv[2][2] = { { 0 } }, color[4] = { 0.5f, 1, 1, 1 };
    ag_surface out;
    ag_surface_eval(s, &s->materials[0], uv, color, &out);
    assert_near(out.base_color[0], 0.5 * 0.2 * 0.5, TIGHT);
    assert_near(out.metallic, 0.5 * 0.8, TIGHT); // blue
    assert_near(out.roughness, 0.4, TIGHT);      // green
    assert_near(out.albedo[1], 0.5 * 0.4 * (1 - 0.4), TIGHT);
    assert_near(out.emission[0], 10 * 0.2, TIGHT);
    assert_near(out.alpha, 128 / 255.0, TIGHT);
    ag_scene_destroy(s);
}

static void mask_cuts_below_the_cutoff_and_only_when_asked(void **state)
{
    (void) state;
    ag_texture t = texture_of(AG_WRAP_REPEAT, false, true); // alpha 1, .502, 1, 0
    ag_material m = ag_default_material();
    m.alpha = AG_ALPHA_MASK;
    m.alpha_cutoff = 0.6f;
    ag_scene *s = scene_of(&m, &t);
    const float red[2][2] = { { 0.25f, 0.25f } }, green[2][2] = { { 0.75f, 0.25f } };
    const float white[4] = { 1, 1, 1, 1 };
    assert_false(ag_surface_masked(s, &s->materials[0], red, white));
    assert_true(ag_surface_masked(s, &s->materials[0], green, white));
    m.base_color_tex = s->materials[0].base_color_tex;
    m.alpha = AG_ALPHA_OPAQUE;
    assert_false(ag_surface_masked(s, &m, green, white));
    ag_scene_destroy(s);
}

static void a_texture_transform_moves_the_lookup(void **state)
{
    (void) state;
    ag_texture t = texture_of(AG_WRAP_REPEAT, false, true);
    ag_material m = ag_default_material();
    m.base_color_tex.uv = 1;
    const float shift[6] = { 1, 0, 0.5f, 0, 1, 0 };
    memcpy(m.base_color_tex.transform, shift, sizeof shift);
    ag_scene *s = scene_of(&m, &t);
    const float uv[2][2] = { { 0.25f, 0.75f }, { 0.25f, 0.25f } }, white[4] = { 1, 1, 1, 1 };
    ag_surface out;
    ag_surface_eval(s, &s->materials[0], uv, white, &out);
    assert_near(out.base_color[1], 1, TIGHT); // green: the second set, moved by half
    assert_near(out.base_color[0], 0, TIGHT);
    ag_scene_destroy(s);
}

// ---- lights -----------------------------------------------------------------------

static void a_point_light_falls_with_the_square(void **state)
{
    (void) state;
    ag_light light = ag_default_light();
    light.intensity[1] = 8;
    light.position[0] = 1e6;
    const double point[3] = { 1e6, -2, 0 };
    float e[3], to[3];
    double distance;
    ag_light_eval(&light, point, e, to, &distance);
    assert_near(e[0], 0.25, TIGHT);
    assert_near(e[1], 2, TIGHT);
    assert_near(to[1], 1, TIGHT);
    assert_near(distance, 2, TIGHT);
    ag_light_eval(&light, light.position, e, to, &distance);
    assert_true(e[1] == 0 && distance == 0);
}

static void a_spot_fades_by_the_squared_ramp(void **state)
{
    (void) state;
    ag_light light = ag_default_light();
    light.kind = AG_LIGHT_SPOT;
    light.cos_inner = 0.9f;
    light.cos_outer = 0.5f;
    const double cosines[] = { 1, 0.9, 0.7, 0.5, 0.2, -1 };
    const double factors[] = { 1, 1, 0.25, 0, 0, 0 };
    for (int i = 0; i < FG_COUNT(cosines); i++) {
        double c = cosines[i], point[3] = { sqrt(1 - c * c), 0, -c }, distance;
        float e[3], to[3];
        ag_light_eval(&light, point, e, to, &distance);
        assert_near(e[0], factors[i], 1e-5);
    }
    light.cosine = true;
    const double point[3] = { 0.6, 0, -0.8 }, behind[3] = { 0, 0, 1 };
    float e[3], to[3];
    double distance;
    ag_light_eval(&light, point, e, to, &distance);
    assert_near(e[0], 0.8, TIGHT);
    ag_light_eval(&light, behind, e, to, &distance);
    assert_true(e[0] == 0);
}

static void a_cone_of_no_width_gives_no_light_and_no_nan(void **state)
{
    (void) state;
    ag_light light = ag_default_light();
    light.kind = AG_LIGHT_SPOT;
    light.cos_inner = light.cos_outer = 1;
    const double axis[3] = { 0, 0, -1 };
    float e[3], to[3];
    double distance;
    ag_light_eval(&light, axis, e, to, &distance);
    assert_true(e[0] == 0);
}

static void a_directional_light_is_the_same_everywhere(void **state)
{
    (void) state;
    ag_light light = ag_default_light();
    light.kind = AG_LIGHT_DIRECTIONAL;
    light.intensity[0] = 3;
    const double point[3] = { 1e9, -4, 2 };
    float e[3], to[3];
    double distance;
    ag_light_eval(&light, point, e, to, &distance);
    assert_true(e[0] == 3 && to[2] == 1 && isinf(distance));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texel_centres_give_the_texels),
        cmocka_unit_test(between_texels_is_their_mean),
        cmocka_unit_test(colours_are_made_linear_before_they_are_filtered),
        cmocka_unit_test(wrap_modes_repeat_clamp_and_mirror),
        cmocka_unit_test(absurd_coordinates_stay_in_the_image),
        cmocka_unit_test(a_surface_multiplies_factor_texture_and_vertex_colour),
        cmocka_unit_test(mask_cuts_below_the_cutoff_and_only_when_asked),
        cmocka_unit_test(a_texture_transform_moves_the_lookup),
        cmocka_unit_test(a_point_light_falls_with_the_square),
        cmocka_unit_test(a_spot_fades_by_the_squared_ramp),
        cmocka_unit_test(a_cone_of_no_width_gives_no_light_and_no_nan),
        cmocka_unit_test(a_directional_light_is_the_same_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
