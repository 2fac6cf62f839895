// SPDX-License-Identifier: MIT
// Materials that move.
#include "scene_log.h"

#include <math.h>
#include <pass/rays.h>
#include <pass/surface.h>

// Keys are floats, sampling is in doubles, what comes out is a float of about 1.
#define TIGHT 1e-6

static const float seconds_0_1_2[] = { 0, 1, 2 };

// One row of four greys, sampled to the texel: offsets of 1/4 step from one to the next.
static const uint8_t greys[16] = { 0,   0,   0,   255, 51,  51,  51,  255,
                                   102, 102, 102, 255, 255, 255, 255, 0 };
static const ag_texture strip = {
    .name = "strip", .width = 4, .height = 1, .rgba = greys, .nearest = true
};

// A triangle of one material that has the strip as base colour and as emission.
static ag_builder *strip_builder(const fg_log *log, ag_material *m)
{
    ag_builder *b = ag_builder_create(log, "strip");
    const int texture = ag_builder_texture(b, &strip);
    *m = ag_default_material();
    snprintf(m->name, sizeof m->name, "screen");
    m->base_color_tex = m->emissive_tex = (ag_texture_ref){ .texture = texture };
    return b;
}

static ag_scene *shown(ag_builder *b, const ag_material *m, const ag_channel_desc *channels,
                       int count)
{
    const int material = ag_builder_material(b, m);
    ag_builder_show(b, add_node(b, -1, 0, 0, 0), add_triangle(b, material), -1);
    for (int i = 0; i < count; i++)
        ag_builder_channel(b, &channels[i]);
    return build(b);
}

static ag_channel_desc emission(const float *values, ag_interpolation how)
{
    return (ag_channel_desc){ .node = -7, // not looked at
                              .path = AG_PATH_EMISSIVE,
                              .interpolation = how,
                              .key_count = 3,
                              .times = seconds_0_1_2,
                              .values = values };
}

static ag_channel_desc offsets(const float *values, ag_interpolation how)
{
    ag_channel_desc c = emission(values, how);
    c.path = AG_PATH_UV_OFFSET;
    return c;
}

static float base_at(const ag_scene *s, float u)
{
    const float uv[2][2] = { { u, 0.5f } }, white[4] = { 1, 1, 1, 1 };
    ag_surface surface;
    ag_surface_eval(s, &s->materials[0], uv, white, &surface);
    return surface.base_color[0];
}

// ---- values -----------------------------------------------------------------------------

static void emission_follows_its_keys_and_loops(void **state)
{
    (void) state;
    static const float values[] = { 0, 1, 2, 10, 1, 2, 10, 21, 2 };
    static const struct {
        ag_interpolation how;
        double time, want[3];
    } cases[] = {
        { AG_INTERPOLATE_LINEAR, 0, { 0, 1, 2 } },
        { AG_INTERPOLATE_LINEAR, 0.5, { 5, 1, 2 } },
        { AG_INTERPOLATE_LINEAR, 1.5, { 10, 11, 2 } },
        { AG_INTERPOLATE_LINEAR, 4.25, { 2.5, 1, 2 } },
        { AG_INTERPOLATE_STEP, 0.99, { 0, 1, 2 } },
        { AG_INTERPOLATE_STEP, 1, { 10, 1, 2 } },
        { AG_INTERPOLATE_STEP, 3.5, { 10, 1, 2 } },
    };
    for (int i = 0; i < FG_COUNT(cases); i++) {
        ag_material m = ag_default_material();
        const ag_channel_desc c = emission(values, cases[i].how);
        ag_scene *s = shown(ag_builder_create(NULL, "glow"), &m, &c, 1);
        assert_true(s->materials[0].moving && s->duration == 2);
        ag_scene_set_time(s, cases[i].time);
        for (int k = 0; k < 3; k++)
            assert_near(s->materials[0].emissive[k], cases[i].want[k], 10 * TIGHT);
        ag_scene_destroy(s);
    }
}

// The spline of t (t - 1) (t - 2) dips below 0 in its second half: no surface takes light away.
static void a_cubic_that_swings_below_zero_is_dark(void **state)
{
    (void) state;
    float values[27] = { 0 };
    for (int k = 0; k < 3; k++) {
        const float t = (float) k, slope = 3 * t * t - 6 * t + 2;
        float *key = values + 9 * (ptrdiff_t) k;
        key[0] = key[6] = slope;
    }
    ag_material m = ag_default_material();
    const ag_channel_desc c = emission(values, AG_INTERPOLATE_CUBIC);
    ag_scene *s = shown(ag_builder_create(NULL, "swing"), &m, &c, 1);
    // No key has any light, and yet there is some.
    assert_true(s->features & AG_FEATURE_EMISSIVE && s->features & AG_FEATURE_AREA_LIGHT);
    for (int i = 0; i < 20; i++) {
        const double t = i / 10.0;
        ag_scene_set_time(s, t);
        assert_near(s->materials[0].emissive[0], fmax(t * (t - 1) * (t - 2), 0), TIGHT);
        assert_false(signbit(s->materials[0].emissive[0]));
    }
    ag_scene_destroy(s);
}

static void an_offset_is_added_to_every_texture_of_the_material(void **state)
{
    (void) state;
    static const float values[] = { 0, 0, 0.25f, 0.5f, 0.5f, -1 };
    ag_material m;
    ag_builder *b = strip_builder(NULL, &m);
    const float shifted[6] = { 2, 0, 0.125f, 0, 2, 0.25f };
    memcpy(m.emissive_tex.transform, shifted, sizeof shifted);
    const ag_channel_desc c = offsets(values, AG_INTERPOLATE_LINEAR);
    ag_scene *s = shown(b, &m, &c, 1);
    const ag_material *now = &s->materials[0];
    // A transform of all zeros means identity, and moves as one.
    const float *base = now->base_color_tex.transform, *glow = now->emissive_tex.transform;
    for (int i = 0; i < 3; i++) {
        ag_scene_set_time(s, i * 0.5);
        const float du = 0.125f * (float) i, dv = 0.25f * (float) i;
        const float want[2][6] = { { 1, 0, du, 0, 1, dv },
                                   { 2, 0, 0.125f + du, 0, 2, 0.25f + dv } };
        assert_memory_equal(base, want[0], sizeof want[0]);
        assert_memory_equal(glow, want[1], sizeof want[1]);
        assert_int_equal(now->metallic_roughness_tex.texture, -1);
        assert_true(now->metallic_roughness_tex.transform[2] == 0);
    }
    ag_scene_destroy(s);
}

static void steps_of_an_atlas_show_frame_after_frame(void **state)
{
    (void) state;
    static const float values[] = { 0, 0, 0.25f, 0, 0.5f, 0 };
    ag_material m;
    ag_builder *b = strip_builder(NULL, &m);
    const ag_channel_desc c = offsets(values, AG_INTERPOLATE_STEP);
    ag_scene *s = shown(b, &m, &c, 1);
    static const struct {
        double time;
        float want;
    } cases[] = { { 0, 0 }, { 0.99, 0 }, { 1, 0.2f }, { 1.99, 0.2f }, { 2, 0 }, { 7.5, 0.2f } };
    for (int i = 0; i < FG_COUNT(cases); i++) {
        ag_scene_set_time(s, cases[i].time);
        assert_near(base_at(s, 0.125f), (double) cases[i].want, TIGHT);
    }
    ag_scene_destroy(s);
}

static void equal_times_give_equal_materials_whatever_came_before(void **state)
{
    (void) state;
    static const float glow[] = { 0.1f, 0.2f, 0.3f, 0.9f, 0, 0, 0.1f, 0.3f, 0.3f };
    static const float slide[] = { -0.1f, 0.1f, 0, 0, 0.3f, 0.7f };
    ag_material m;
    ag_builder *b = strip_builder(NULL, &m);
    const ag_channel_desc c[] = { emission(glow, AG_INTERPOLATE_LINEAR),
                                  offsets(slide, AG_INTERPOLATE_LINEAR) };
    ag_scene *s = shown(b, &m, c, 2);
    const ag_material first = s->materials[0];
    ag_scene_set_time(s, 0.7);
    const ag_material once = s->materials[0];
    for (int i = 0; i < 50; i++)
        ag_scene_set_time(s, i * 0.37);
    ag_scene_set_time(s, 0.7);
    assert_memory_equal(&s->materials[0], &once, sizeof once);
    ag_scene_set_time(s, 0);
    assert_memory_equal(&s->materials[0], &first, sizeof first);
    ag_scene_destroy(s);
}

// ---- revisions --------------------------------------------------------------------------

static void the_material_revision_counts_changes_and_nothing_else(void **state)
{
    (void) state;
    static const float values[] = { 1, 1, 1, 5, 5, 5, 5, 5, 5 };
    ag_material m = ag_default_material();
    const ag_channel_desc c = emission(values, AG_INTERPOLATE_LINEAR);
    ag_scene *s = shown(ag_builder_create(NULL, "revisions"), &m, &c, 1);
    const uint64_t geometry = s->geometry_revision, light = s->light_revision;
    const uint64_t material = s->material_revision;
    ag_scene_set_time(s, 0.5);
    assert_int_equal(s->material_revision, material + 1);
    ag_scene_set_time(s, 1.2);
    ag_scene_set_time(s, 1.7); // held at 5 by both keys
    assert_int_equal(s->material_revision, material + 2);
    assert_true(s->geometry_revision == geometry && s->light_revision == light);
    ag_scene_destroy(s);
}

static void a_constant_channel_sets_a_material_that_does_not_move(void **state)
{
    (void) state;
    static const float glow[] = { 4, 4, 4, 4, 4, 4, 4, 4, 4 }, slide[] = { 1, 2, 1, 2, 1, 2 };
    ag_material m;
    ag_builder *b = strip_builder(NULL, &m);
    const ag_channel_desc c[] = { emission(glow, AG_INTERPOLATE_LINEAR),
                                  offsets(slide, AG_INTERPOLATE_LINEAR) };
    ag_scene *s = shown(b, &m, c, 2);
    const uint64_t revision = s->material_revision;
    assert_false(s->materials[0].moving || s->features & AG_FEATURE_MOVING_MATERIAL);
    assert_true(s->materials[0].emissive[2] == 4);
    assert_true(s->materials[0].base_color_tex.transform[5] == 2);
    assert_true(s->features & AG_FEATURE_TEXTURE_TRANSFORM);
    ag_scene_set_time(s, 1);
    assert_int_equal(s->material_revision, revision);
    ag_scene_destroy(s);
}

// Marks that are still there were not written over: another thread may read there.
static void what_no_channel_drives_is_not_even_written(void **state)
{
    (void) state;
    static const float values[] = { 1, 1, 1, 5, 5, 5, 5, 5, 5 };
    ag_material m;
    ag_builder *b = strip_builder(NULL, &m);
    ag_builder_material(b, &m); // 0 glows, 1 does not
    const ag_channel_desc c = emission(values, AG_INTERPOLATE_LINEAR);
    ag_scene *s = shown(b, &m, &c, 1);
    ag_material *materials = (ag_material *) s->materials;
    const ag_material *before = s->materials;
    materials[0].base_color[0] = materials[0].base_color_tex.transform[2] = 42;
    materials[1].emissive[0] = 43;
    ag_scene_set_time(s, 0.5);
    assert_true(materials[0].emissive[0] == 3 && materials[1].emissive[0] == 43);
    assert_true(materials[0].base_color[0] == 42);
    assert_true(materials[0].base_color_tex.transform[2] == 42);
    assert_ptr_equal(s->materials, before);
    ag_scene_destroy(s);
}

// ---- features ---------------------------------------------------------------------------

static void a_material_that_is_dark_now_and_shines_later_counts_as_emissive(void **state)
{
    (void) state;
    static const float values[] = { 0, 0, 0, 0, 3, 0, 0, 0, 0 };
    ag_material m = ag_default_material();
    const ag_channel_desc c = emission(values, AG_INTERPOLATE_STEP);
    ag_scene *s = shown(ag_builder_create(NULL, "later"), &m, &c, 1);
    assert_true(s->materials[0].emissive[1] == 0);
    assert_int_equal(s->features, AG_FEATURE_GEOMETRY | AG_FEATURE_EMISSIVE |
                                      AG_FEATURE_AREA_LIGHT | AG_FEATURE_MOVING_MATERIAL);
    // Beside a point light of 4 pi kW its 3 pi/2 W no longer count as a light.
    ag_light light = ag_default_light();
    light.intensity[0] = 1000;
    ag_scene_set_time(s, 1);
    assert_int_equal(ag_scene_add_light(s, &light), FG_OK);
    assert_false(s->features & AG_FEATURE_AREA_LIGHT);
    ag_scene_destroy(s);
}

static void a_driven_emission_stands_in_for_the_factor(void **state)
{
    (void) state;
    static const float values[9] = { 0 };
    ag_material m = ag_default_material();
    m.emissive[0] = 5;
    const ag_channel_desc c = emission(values, AG_INTERPOLATE_LINEAR);
    ag_scene *s = shown(ag_builder_create(NULL, "off"), &m, &c, 1);
    assert_true(s->materials[0].emissive[0] == 0);
    assert_false(s->features & (AG_FEATURE_EMISSIVE | AG_FEATURE_AREA_LIGHT));
    ag_scene_destroy(s);
}

static void an_offset_of_no_texture_moves_nothing(void **state)
{
    (void) state;
    static const float values[] = { 0, 0, 1, 0, 0, 0 };
    ag_material m = ag_default_material();
    const ag_channel_desc c = offsets(values, AG_INTERPOLATE_LINEAR);
    ag_scene *s = shown(ag_builder_create(NULL, "plain"), &m, &c, 1);
    assert_false(s->materials[0].moving);
    assert_int_equal(s->features, AG_FEATURE_GEOMETRY);
    assert_true(s->duration == 2);
    ag_scene_destroy(s);
}

static void a_moving_texture_is_a_transformed_one(void **state)
{
    (void) state;
    static const float values[] = { 0, 0, 1, 0, 0, 0 };
    ag_material m;
    ag_builder *b = strip_builder(NULL, &m);
    const ag_channel_desc c = offsets(values, AG_INTERPOLATE_LINEAR);
    ag_scene *s = shown(b, &m, &c, 1);
    assert_int_equal(s->features, AG_FEATURE_GEOMETRY | AG_FEATURE_TEXTURES |
                                      AG_FEATURE_TEXTURE_TRANSFORM | AG_FEATURE_MOVING_MATERIAL);
    assert_string_equal(ag_feature_names[17], "moving material");
    ag_scene_destroy(s);
}

// ---- refusals ---------------------------------------------------------------------------

static void mistakes_are_refused_with_the_material_named(void **state)
{
    (void) state;
    static const float negative[] = { 0, 0, 0, 1, -0.5f, 0, 0, 0, 0 };
    static const float endless[] = { 0, 0, 0, INFINITY, 0, 0 };
    ag_channel_desc nowhere = emission(seconds_0_1_2, AG_INTERPOLATE_STEP), path = nowhere;
    nowhere.material = 1;
    path.path = (ag_path) (AG_PATH_UV_OFFSET + 1);
    const struct {
        ag_channel_desc channel;
        const char *want;
    } cases[] = {
        { emission(negative, AG_INTERPOLATE_LINEAR),
          "strip: channel: emission of material 0 'screen': a value is negative" },
        { offsets(endless, AG_INTERPOLATE_LINEAR),
          "strip: channel: UV offset of material 0 'screen': a value is not finite" },
        { nowhere, "strip: channel: material 1 or path 3 does not exist" },
        { path, "strip: channel: node -7 or path 5 does not exist" },
    };
    for (int i = 0; i < FG_COUNT(cases); i++) {
        lines l;
        fg_log log = log_to(&l);
        ag_material m;
        ag_scene *s;
        ag_builder *b = strip_builder(&log, &m);
        ag_builder_material(b, &m);
        ag_builder_channel(b, &cases[i].channel);
        assert_int_equal(ag_scene_build(b, &s), FG_ERR_INVALID);
        assert_string_equal(l.error, cases[i].want);
        ag_builder_destroy(b);
    }
}

// Of a cubic's three values a key the tangents are rates, which may be negative.
static void tangents_of_an_emission_may_be_negative(void **state)
{
    (void) state;
    float values[27] = { 0 };
    values[9] = -1;
    ag_material m = ag_default_material();
    const ag_channel_desc c = emission(values, AG_INTERPOLATE_CUBIC);
    ag_scene_destroy(shown(ag_builder_create(NULL, "tangents"), &m, &c, 1));
    values[9] = 0;
    values[12] = -1;
    lines l;
    fg_log log = log_to(&l);
    ag_builder *b = ag_builder_create(&log, "values");
    ag_builder_material(b, &m);
    ag_builder_channel(b, &c);
    assert_has(l.error, "a value is negative");
    ag_builder_destroy(b);
}

static void a_material_driven_twice_keeps_its_first_channel(void **state)
{
    (void) state;
    static const float ones[] = { 1, 1, 1, 1, 1, 1, 1, 1, 1 },
                       twos[] = { 2, 2, 2, 2, 2, 2, 2, 2, 2 };
    lines l;
    fg_log log = log_to(&l);
    ag_material m;
    ag_builder *b = strip_builder(&log, &m);
    const ag_channel_desc c[] = { emission(ones, AG_INTERPOLATE_LINEAR),
                                  emission(twos, AG_INTERPOLATE_LINEAR) };
    ag_scene *s = shown(b, &m, c, 2);
    assert_has(l.warning, "emission of material 0 'screen' is driven already");
    assert_true(s->materials[0].emissive[0] == 1);
    ag_scene_destroy(s);
}

// ---- what outlives the motion -----------------------------------------------------------

static void blurred_colors_of_a_moving_texture_are_its_mean(void **state)
{
    (void) state;
    static const float values[] = { 0, 0, 0.25f, 0, 0.5f, 0 };
    static const float white[4] = { 1, 1, 1, 1 };
    const double mean = (0 + 51 + 102 + 255) / (4 * 255.0);
    ag_material m;
    ag_builder *b = strip_builder(NULL, &m);
    m.metallic = 0;
    const ag_channel_desc c = offsets(values, AG_INTERPOLATE_STEP);
    ag_scene *s = shown(b, &m, &c, 1);
    ag_blur *blur;
    assert_int_equal(ag_blur_create(NULL, s, 16, &blur), FG_OK);
    for (int i = 0; i < 8; i++) {
        const float uv[2][2] = { { (float) i / 8, 0 } };
        float albedo[3];
        ag_scene_set_time(s, i * 0.5);
        ag_blur_albedo(blur, 0, uv, white, albedo);
        assert_near(albedo[1], mean, TIGHT);
    }
    ag_blur_destroy(blur);
    ag_scene_destroy(s);
}

// A hole that wanders is a shape that moves; a masked surface that flickers stays where it is.
static void a_moving_mask_moves_its_instances(void **state)
{
    (void) state;
    static const float slide[] = { 0, 0, 0.25f, 0, 0.5f, 0 };
    static const float glow[] = { 0, 0, 0, 1, 1, 1, 0, 0, 0 };
    for (int moves = 0; moves < 2; moves++) {
        ag_material m;
        ag_builder *b = strip_builder(NULL, &m);
        m.alpha = AG_ALPHA_MASK;
        const ag_channel_desc c =
            moves ? offsets(slide, AG_INTERPOLATE_STEP) : emission(glow, AG_INTERPOLATE_STEP);
        ag_scene *s = shown(b, &m, &c, 1);
        assert_int_equal(s->instances[0].moving, moves);
        assert_int_equal(!!(s->features & AG_FEATURE_MOVING_GEOMETRY), moves);
        assert_true(s->materials[0].moving);
        ag_scene_destroy(s);
    }
}

// The triangle's texture coordinates are all 0: the whole of it is one texel, the hole at time 1.
static void rays_meet_the_mask_of_the_moment_and_static_ones_none(void **state)
{
    (void) state;
    static const float slide[] = { 0, 0, 0.75f, 0, 0.5f, 0 };
    static const struct {
        double time;
        bool blocked;
    } cases[] = { { 0, true }, { 1, false }, { 3.5, false }, { 4, true } };
    const float from[3] = { 0.2f, 0.2f, 1 }, down[3] = { 0, 0, -1 };
    ag_material m;
    ag_builder *b = strip_builder(NULL, &m);
    m.alpha = AG_ALPHA_MASK;
    const ag_channel_desc c = offsets(slide, AG_INTERPOLATE_STEP);
    ag_scene *s = shown(b, &m, &c, 1);
    for (int i = 0; i < 2 * FG_COUNT(cases); i++) {
        const bool only = i & 1;
        const ag_rays_desc desc = { .scene = s, .static_only = only, .threads = 1 };
        ag_rays *rays;
        ag_scene_set_time(s, cases[i / 2].time);
        assert_int_equal(ag_rays_create(&desc, &rays), FG_OK);
        assert_int_equal(ag_rays_blocked(rays, from, down, 0, 2), !only && cases[i / 2].blocked);
        ag_rays_destroy(rays);
    }
    ag_scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(emission_follows_its_keys_and_loops),
        cmocka_unit_test(a_cubic_that_swings_below_zero_is_dark),
        cmocka_unit_test(an_offset_is_added_to_every_texture_of_the_material),
        cmocka_unit_test(steps_of_an_atlas_show_frame_after_frame),
        cmocka_unit_test(equal_times_give_equal_materials_whatever_came_before),
        cmocka_unit_test(the_material_revision_counts_changes_and_nothing_else),
        cmocka_unit_test(a_constant_channel_sets_a_material_that_does_not_move),
        cmocka_unit_test(what_no_channel_drives_is_not_even_written),
        cmocka_unit_test(a_material_that_is_dark_now_and_shines_later_counts_as_emissive),
        cmocka_unit_test(a_driven_emission_stands_in_for_the_factor),
        cmocka_unit_test(an_offset_of_no_texture_moves_nothing),
        cmocka_unit_test(a_moving_texture_is_a_transformed_one),
        cmocka_unit_test(mistakes_are_refused_with_the_material_named),
        cmocka_unit_test(tangents_of_an_emission_may_be_negative),
        cmocka_unit_test(a_material_driven_twice_keeps_its_first_channel),
        cmocka_unit_test(blurred_colors_of_a_moving_texture_are_its_mean),
        cmocka_unit_test(a_moving_mask_moves_its_instances),
        cmocka_unit_test(rays_meet_the_mask_of_the_moment_and_static_ones_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
