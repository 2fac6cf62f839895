// SPDX-License-Identifier: MIT
#include "scene_log.h"

#include <math.h>
#include <pass/surface.h>
#include <stdlib.h>

static const float white[4] = { 1, 1, 1, 1 };

static ag_texture texture(int width, int height, const uint8_t *rgba)
{
    return (ag_texture){ .name = "t", .width = width, .height = height, .rgba = rgba };
}

static ag_material material(float r, float g, float b, float a)
{
    ag_material m = ag_default_material();
    memcpy(m.base_color, (float[4]){ r, g, b, a }, sizeof m.base_color);
    m.metallic = 0;
    return m;
}

// One material on a triangle.
static ag_scene *scene_of(const ag_texture *base, const ag_texture *metal, const ag_material *like)
{
    ag_builder *b = ag_builder_create(NULL, "blur");
    ag_material m = *like;
    m.base_color_tex.texture = base ? ag_builder_texture(b, base) : -1;
    m.metallic_roughness_tex.texture = metal ? ag_builder_texture(b, metal) : -1;
    const int material = ag_builder_material(b, &m);
    ag_builder_show(b, add_node(b, -1, 0, 0, 0), add_triangle(b, material), -1);
    return build(b);
}

static ag_blur *blur_of(const ag_scene *scene, int texels)
{
    ag_blur *blur;
    assert_int_equal(ag_blur_create(NULL, scene, texels, &blur), FG_OK);
    return blur;
}

static void look(const ag_blur *blur, double u, double v, float albedo[3])
{
    const float uv[2][2] = { { (float) u, (float) v }, { -9, -9 } };
    ag_blur_albedo(blur, 0, uv, white, albedo);
}

static void fill_with_noise(uint8_t *rgba, int count, uint32_t seed)
{
    for (int i = 0; i < 4 * count; i++) {
        seed = seed * 1664525u + 1013904223u;
        rgba[i] = (uint8_t) (seed >> 24);
    }
}

static double decoded(uint8_t value, bool srgb)
{
    const double v = value / 255.0;
    return !srgb ? v : v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static void expect_mean(const ag_texture *t, int texels)
{
    const ag_material plain = material(1, 1, 1, 1);
    const int w = t->width, h = t->height, longer = w > h ? w : h;
    const double scale = fmin((double) texels / longer, 1);
    const int dw = (int) fmax(round(w * scale), 1), dh = (int) fmax(round(h * scale), 1);
    ag_scene *scene = scene_of(t, NULL, &plain);
    ag_blur *blur = blur_of(scene, texels);
    double want[3] = { 0 }, got[3] = { 0 };
    for (int i = 0; i < 3 * w * h; i++)
        want[i % 3] += decoded(t->rgba[i / 3 * 4 + i % 3], t->srgb) / (w * h);
    for (int i = 0; i < dw * dh; i++) {
        const int row = i / dw;
        float albedo[3];
        look(blur, (i % dw + 0.5) / dw, (row + 0.5) / dh, albedo);
        for (int k = 0; k < 3; k++)
            got[k] += (double) albedo[k] / (dw * dh);
    }
    for (int k = 0; k < 3; k++) // floats: of the table, the copy, the weights at centres
        assert_near(got[k], want[k], 1e-6);
    ag_blur_destroy(blur);
    ag_scene_destroy(scene);
}

static void any_size_keeps_its_mean(void **state)
{
    (void) state;
    static const int sizes[][2] = { { 1, 1 },   { 7, 5 },  { 640, 3 }, { 33, 100 },
                                    { 16, 16 }, { 3, 17 }, { 256, 1 } };
    static uint8_t rgba[4 * 4096];
    for (int s = 0; s < FG_COUNT(sizes); s++) {
        fill_with_noise(rgba, sizes[s][0] * sizes[s][1], 3);
        ag_texture t = texture(sizes[s][0], sizes[s][1], rgba);
        t.srgb = s % 2;
        for (int texels = 1; texels <= 16; texels = 2 * texels + (texels > 3))
            expect_mean(&t, texels);
    }
}

static void a_texture_that_is_small_enough_stays_as_it_is(void **state)
{
    (void) state;
    uint8_t rgba[4 * 35];
    fill_with_noise(rgba, 35, 5);
    ag_texture t = texture(7, 5, rgba);
    t.srgb = true;
    t.wrap_u = AG_WRAP_MIRROR;
    t.wrap_v = AG_WRAP_CLAMP;
    ag_material m = material(0.5f, 0.75f, 1, 1);
    m.metallic = 0.25f;
    m.base_color_tex.uv = 1;
    m.base_color_tex.transform[0] = 2;
    m.base_color_tex.transform[2] = 0.3f;
    m.base_color_tex.transform[4] = -1;
    ag_scene *scene = scene_of(&t, NULL, &m);
    ag_blur *blur = blur_of(scene, 7);
    for (int i = 0; i < 200; i++) {
        const float uv[2][2] = { { 9, 9 }, { sinf((float) i), 2 * cosf((float) i) } };
        const float color[4] = { 0.9f, 1, 0.2f, 0 };
        float albedo[3];
        ag_surface surface;
        ag_blur_albedo(blur, 0, uv, color, albedo);
        ag_surface_eval(scene, &scene->materials[0], uv, color, &surface);
        for (int k = 0; k < 3; k++)
            assert_near((double) albedo[k], (double) surface.albedo[k], 1e-6);
    }
    ag_blur_destroy(blur);
    ag_scene_destroy(scene);
}

static void texels_that_meet_two_cells_are_shared(void **state)
{
    (void) state;
    const ag_material plain = material(1, 1, 1, 1);
    const uint8_t row[12] = { 255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255 };
    ag_texture t = texture(3, 1, row);
    t.wrap_u = t.wrap_v = AG_WRAP_CLAMP;
    ag_scene *scene = scene_of(&t, NULL, &plain);
    ag_blur *blur = blur_of(scene, 2);
    float albedo[3];
    look(blur, 0.25, 0.5, albedo); // a whole texel and half a one
    assert_near(albedo[0], 2.0 / 3, 1e-6);
    assert_near(albedo[1], 1.0 / 3, 1e-6);
    assert_near(albedo[2], 0, 0);
    look(blur, 0.5, 0.5, albedo); // between the two
    assert_near(albedo[0], 1.0 / 3, 1e-6);
    assert_near(albedo[1], 1.0 / 3, 1e-6);
    assert_near(albedo[2], 1.0 / 3, 1e-6);
    ag_blur_destroy(blur);
    ag_scene_destroy(scene);
}

static void edges_wrap_as_the_texture_does(void **state)
{
    (void) state;
    const ag_material plain = material(1, 1, 1, 1);
    static const double seam[] = {
        [AG_WRAP_REPEAT] = 0.5, [AG_WRAP_CLAMP] = 1, [AG_WRAP_MIRROR] = 1
    };
    static const double beyond[] = {
        [AG_WRAP_REPEAT] = 0, [AG_WRAP_CLAMP] = 1, [AG_WRAP_MIRROR] = 1
    };
    uint8_t rgba[4 * 64];
    for (int i = 0; i < 4 * 64; i++) // the left half is black
        rgba[i] = i / 4 % 8 < 4 ? 0 : 255;
    for (ag_wrap wrap = AG_WRAP_REPEAT; wrap <= AG_WRAP_MIRROR; wrap++) {
        ag_texture t = texture(8, 8, rgba);
        t.wrap_u = wrap;
        t.nearest = true; // of the full texture; the copy is looked up between texels
        ag_scene *scene = scene_of(&t, NULL, &plain);
        ag_blur *blur = blur_of(scene, 2);
        float albedo[3];
        look(blur, 1, 0.3, albedo);
        assert_near(albedo[0], seam[wrap], 1e-6);
        look(blur, 1.25, 0.3, albedo);
        assert_near(albedo[0], beyond[wrap], 1e-6);
        ag_blur_destroy(blur);
        ag_scene_destroy(scene);
    }
}

// Leaves as files have them: green where they are, and any colour where they are not.
static void what_a_mask_takes_away_gives_no_colour(void **state)
{
    (void) state;
    uint8_t rgba[4 * 64];
    for (int i = 0; i < 64; i++) {
        const bool leaf = i % 8 < 2 || i < 8;
        const uint8_t texel[4] = { leaf ? 0 : 255, leaf ? 255 : 0, 0, leaf ? 160 : 150 };
        memcpy(rgba + (size_t) 4 * i, texel, 4);
    }
    const ag_texture t = texture(8, 8, rgba);
    ag_material m = material(1, 1, 1, 0.8f); // cutoff 0.5: alpha 159.4
    for (int masks = 0; masks < 3; masks++) {
        m.alpha = masks > 0 ? AG_ALPHA_MASK : AG_ALPHA_OPAQUE;
        m.alpha_cutoff = masks < 2 ? 0.5f : 0.6f; // nothing is there
        ag_scene *scene = scene_of(&t, NULL, &m);
        ag_blur *blur = blur_of(scene, 4);
        for (int i = 0; i < 16; i++) {
            const int row = i / 4;
            float albedo[3];
            look(blur, (i % 4 + 0.5) / 4, (row + 0.5) / 4, albedo);
            // A cell of 2 x 2: the first column is all leaf, of the first row half.
            const double leaf = i % 4 == 0 ? 1 : i < 4 ? 0.5 : 0;
            assert_near(albedo[0], masks > 0 ? 0 : 1 - leaf, 1e-6);
            assert_near(albedo[1], masks == 2 ? 0 : masks == 1 ? 1 : leaf, 1e-6);
        }
        ag_blur_destroy(blur);
        ag_scene_destroy(scene);
    }
}

static void two_materials_may_mask_one_texture_apart(void **state)
{
    (void) state;
    const uint8_t rgba[8] = { 255, 0, 0, 100, 0, 0, 255, 255 };
    ag_builder *b = ag_builder_create(NULL, "blur");
    const ag_texture t = texture(2, 1, rgba);
    ag_material m = material(1, 1, 1, 1);
    m.base_color_tex.texture = ag_builder_texture(b, &t);
    m.alpha_cutoff = 0.5f;
    for (int i = 0; i < 2; i++) {
        m.alpha = i ? AG_ALPHA_MASK : AG_ALPHA_OPAQUE;
        ag_builder_show(b, add_node(b, -1, 0, 0, 0), add_triangle(b, ag_builder_material(b, &m)),
                        -1);
    }
    ag_scene *scene = build(b);
    ag_blur *blur = blur_of(scene, 1);
    for (int i = 0; i < 2; i++) {
        const float uv[2][2] = { { 0 } };
        float albedo[3];
        ag_blur_albedo(blur, i, uv, white, albedo);
        assert_near(albedo[0], i ? 0 : 0.5, 1e-6);
        assert_near(albedo[2], i ? 1 : 0.5, 1e-6);
    }
    ag_blur_destroy(blur);
    ag_scene_destroy(scene);
}

static void metal_reflects_less_diffusely(void **state)
{
    (void) state;
    const uint8_t rgba[16] = { 9, 9, 255, 9, 9, 9, 255, 9, 9, 9, 0, 9, 9, 9, 51, 9 };
    const ag_texture t = texture(2, 2, rgba);
    ag_material m = material(0.5f, 1, 0.25f, 1);
    m.metallic = 0.5f;
    ag_scene *scene = scene_of(NULL, &t, &m);
    ag_blur *blur = blur_of(scene, 1);
    float albedo[3];
    look(blur, 0.1, 0.7, albedo);
    const double diffuse = 1 - 0.5 * (1 + 1 + 0 + 0.2) / 4;
    for (int k = 0; k < 3; k++)
        assert_near(albedo[k], (double) m.base_color[k] * diffuse, 1e-6);
    ag_blur_destroy(blur);
    ag_scene_destroy(scene);
}

static void no_texels_are_refused(void **state)
{
    (void) state;
    const ag_material plain = material(1, 1, 1, 1);
    ag_scene *scene = scene_of(NULL, NULL, &plain);
    lines l;
    fg_log log = log_to(&l);
    ag_blur *blur;
    assert_int_equal(ag_blur_create(&log, scene, 0, &blur), FG_ERR_INVALID);
    assert_null(blur);
    assert_has(l.error, "blur: texels is 0, must be at least 1");
    ag_blur_destroy(NULL);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_size_keeps_its_mean),
        cmocka_unit_test(a_texture_that_is_small_enough_stays_as_it_is),
        cmocka_unit_test(texels_that_meet_two_cells_are_shared),
        cmocka_unit_test(edges_wrap_as_the_texture_does),
        cmocka_unit_test(what_a_mask_takes_away_gives_no_colour),
        cmocka_unit_test(two_materials_may_mask_one_texture_apart),
        cmocka_unit_test(metal_reflects_less_diffusely),
        cmocka_unit_test(no_texels_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
