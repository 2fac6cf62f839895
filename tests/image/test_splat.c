// SPDX-License-Identifier: MIT
// The splat plugin: its patches and its picture against those of isr, and what `reach` costs.
#include "fixture.h"

#include <math.h>
#include <pass/multires.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ag_scene *furnished_room(void)
{
    const room_desc room = { .boxes = true,
                             .albedo = { { 0.6f, 0.1f, 0.1f },
                                         { 0.1f, 0.5f, 0.1f },
                                         { 0.7f, 0.7f, 0.7f },
                                         { 0.7f, 0.7f, 0.7f },
                                         { 0.5f, 0.5f, 0.6f },
                                         { 0.5f, 0.5f, 0.5f } } };
    const ag_light light = ceiling_spot(58);
    return room_scene(&room, &light);
}

// A slanted quad with nothing behind it, which fills about half of the view.
static ag_scene *lone_quad(double light_y)
{
    static const double p[3] = { -0.5, -0.6, -1 }, u[3] = { 1, 0.2, 0 }, v[3] = { 0.1, 0.9, -0.6 };
    ag_builder *b = ag_builder_create(test_log(), "quad");
    assert_non_null(b);
    const ag_material white = ag_default_material();
    add_quad(b, ag_builder_material(b, &white), p, u, v);
    const ag_camera camera = plain_camera("front");
    ag_light light = ceiling_spot(70);
    light.position[1] = light_y;
    light.position[2] = -0.7;
    ag_builder_camera(b, -1, &camera);
    ag_builder_light(b, -1, &light);
    return finish_scene(b);
}

static image indirect(ag_scene *scene, const int size[2], const char *plugin,
                      const char *const *settings, capture *captures)
{
    const shot s = {
        .scene = scene,
        .width = size[0],
        .height = size[1],
        .layer = LAYER_INDIRECT,
        .plugin = plugin_named(plugin),
        .settings = settings,
        .captures = captures,
    };
    return shot_take(&s);
}

static void expect_finite(const image *img)
{
    for (size_t i = 0; i < (size_t) 3 * img->width * img->height; i++)
        assert_true(isfinite(img->rgb[i]) && img->rgb[i] >= 0);
}

// Of the float terms that both sides sum, in another order, each sum of up to 256 is off by 256 x
// 2^-24 of itself; a cosine near 0 by 2^-24 of one that is not, which the mean stands for; and the
// upsampling goes on from two texels to where there is none, three errors' worth.
static void expect_same(const image *a, const image *b, const char *what)
{
    const double mean = image_mean(b);
    assert_int_equal(a->width * a->height, b->width * b->height);
    for (size_t i = 0; i < (size_t) 3 * a->width * a->height; i++) {
        const double got = (double) a->rgb[i], want = (double) b->rgb[i];
        if (!(fabs(got - want) <= 1e-4 * (want + mean)))
            fail_msg("%s: %g at %zu, must be %g", what, got, i, want);
    }
}

// ---- patches -----------------------------------------------------------------------------

typedef struct patch_set {
    uint8_t *marks; // of each texel of the pyramid: how often it is a patch
    size_t texels;
    uint32_t count;
} patch_set;

static patch_set empty_set(const ag_pyramid *pyramid)
{
    patch_set set = { .texels = (size_t) pyramid->size[0] * pyramid->size[1] };
    set.marks = calloc(set.texels, 1);
    assert_non_null(set.marks);
    return set;
}

static void mark(patch_set *set, const ag_pyramid *pyramid, int x, int y)
{
    assert_true(x >= 0 && y >= 0 && x < pyramid->size[0] && y < pyramid->size[1]);
    set->marks[(size_t) y * pyramid->size[0] + x]++;
}

static patch_set splat_patches(ag_scene *scene, const ag_pyramid *pyramid, const int size[2],
                               const char *const *settings)
{
    capture c[] = { { .resource = "splat.positions" },
                    { .resource = "splat.normals" },
                    { .resource = "splat.patches" },
                    { 0 } };
    image img = indirect(scene, size, "splat", settings, c);
    patch_set set = empty_set(pyramid);
    set.count = *(const uint32_t *) c[2].bytes;
    assert_true(set.count <= (uint32_t) c[0].width * c[0].height);
    for (uint32_t i = 0; i < set.count; i++) {
        const double x = (double) c[0].texels[4 * i + 3], y = (double) c[1].texels[4 * i + 3];
        mark(&set, pyramid, (int) floor((x + 1) / 2 * pyramid->size[0]),
             (int) floor((y + 1) / 2 * pyramid->size[1]));
    }
    expect_finite(&img);
    image_finish(&img);
    captures_finish(c);
    return set;
}

static patch_set isr_texels(ag_scene *scene, const ag_pyramid *pyramid, const int size[2],
                            const char *const *settings)
{
    capture c[] = { { .resource = "isr.texels" }, { .resource = "isr.texel_count" }, { 0 } };
    image img = indirect(scene, size, "isr", settings, c);
    const uint32_t *texels = c[0].bytes;
    patch_set set = empty_set(pyramid);
    set.count = *(const uint32_t *) c[1].bytes;
    for (uint32_t i = 0; i < set.count; i++) {
        int origin[2];
        ag_pyramid_origin(pyramid, (int) (texels[i] >> 28), origin);
        mark(&set, pyramid, origin[0] + (int) (texels[i] & 0x3fff),
             origin[1] + (int) (texels[i] >> 14 & 0x3fff));
    }
    image_finish(&img);
    captures_finish(c);
    return set;
}

// How many patches there are.
static uint32_t expect_patches(ag_scene *scene, const int size[2], const char *const *settings)
{
    const int levels = ag_multires_levels(size[0], size[1], 64);
    const ag_pyramid pyramid = ag_pyramid_of(size[0], size[1], levels);
    patch_set got = splat_patches(scene, &pyramid, size, settings);
    patch_set want = isr_texels(scene, &pyramid, size, settings);
    assert_int_equal(got.count, want.count);
    assert_memory_equal(got.marks, want.marks, want.texels);
    for (size_t i = 0; i < got.texels; i++)
        assert_true(got.marks[i] <= 1);
    free(got.marks);
    free(want.marks);
    return got.count;
}

static void refinement_round_by_round_ends_at_the_texels_of_isr(void **state)
{
    static const int sizes[][2] = { { 1, 1 }, { 2, 1 }, { 64, 64 }, { 65, 63 }, { 1023, 517 } };
    static const char *const settings[][5] = {
        { "vpls=1", "share=3", NULL },
        { "vpls=1", "share=0", NULL },
        { "vpls=1", "share=1", "metric=slope", NULL },
        { "vpls=1", "share=2", "balanced=0", NULL },
        { "vpls=1", "share=3", "depth=1e6", "normal=4", NULL },
    };
    (void) state;
    ag_scene *room = furnished_room(), *quad = lone_quad(0.6);
    for (int s = 0; s < FG_COUNT(sizes); s++) {
        for (int k = 0; k < FG_COUNT(settings); k++) {
            expect_patches(room, sizes[s], settings[k]);
            expect_patches(quad, sizes[s], settings[k]);
        }
    }
    ag_scene_destroy(room);
    ag_scene_destroy(quad);
}

static void thresholds_of_zero_make_each_pixel_a_patch(void **state)
{
    static const char *const shared[] = { "vpls=1", "depth=0", "normal=0", "share=3", NULL };
    static const char *const paper[] = { "vpls=1", "depth=0", "normal=0", "share=0", NULL };
    static const int size[2] = { 130, 67 };
    (void) state;
    ag_scene *scene = furnished_room();
    assert_int_equal(expect_patches(scene, size, shared), 130 * 67);
    assert_int_equal(expect_patches(scene, size, paper), 130 * 67);
    ag_scene_destroy(scene);
}

// ---- pictures ----------------------------------------------------------------------------

static void splatting_and_gathering_make_one_picture(void **state)
{
    static const int sizes[][2] = { { 1, 1 }, { 64, 64 }, { 65, 63 }, { 130, 67 } };
    static const char *const splat[][3] = { { "vpls=256", "share=3", NULL },
                                            { "vpls=256", "share=0", NULL } };
    static const char *const isr[][5] = {
        { "source=regular", "vpls=256", "clamp=disc", NULL },
        { "source=regular", "vpls=256", "clamp=disc", "share=0", NULL },
    };
    (void) state;
    ag_scene *room = furnished_room(), *quad = lone_quad(0.6);
    for (int k = 0; k < 4 * FG_COUNT(sizes); k++) {
        ag_scene *scene = k % 4 < 2 ? room : quad;
        const int *size = sizes[k / 4];
        char what[64];
        snprintf(what, sizeof what, "%s, %d x %d, setting %d", scene == room ? "room" : "quad",
                 size[0], size[1], k % 2);
        image a = indirect(scene, size, "splat", splat[k % 2], NULL);
        image b = indirect(scene, size, "isr", isr[k % 2], NULL);
        expect_finite(&a);
        expect_same(&a, &b, what);
        assert_true(scene == quad || image_mean(&a) > 0);
        image_finish(&a);
        image_finish(&b);
    }
    ag_scene_destroy(room);
    ag_scene_destroy(quad);
}

static void every_pixel_a_patch_is_the_full_gather(void **state)
{
    static const char *const splat[] = { "vpls=64", "depth=0", "normal=0", NULL };
    static const char *const rsm[] = { "vpls=64", "clamp=disc", NULL };
    (void) state;
    ag_scene *scene = furnished_room();
    image a = indirect(scene, (int[2]){ 130, 67 }, "splat", splat, NULL);
    image b = indirect(scene, (int[2]){ 130, 67 }, "rsm", rsm, NULL);
    expect_same(&a, &b, "thresholds of zero");
    image_finish(&a);
    image_finish(&b);
    ag_scene_destroy(scene);
}

static void without_vpls_there_is_no_light(void **state)
{
    static const char *const settings[] = { "vpls=256", NULL };
    static const char *const reaching[] = { "vpls=256", "reach=0.001", NULL };
    (void) state;
    ag_scene *scene = lone_quad(-3); // the light is below it and looks down
    for (int i = 0; i < 2; i++) {
        capture c[] = { { .resource = "splat.count" }, { .resource = "splat.patches" }, { 0 } };
        image img = indirect(scene, (int[2]){ 65, 63 }, "splat", i ? reaching : settings, c);
        assert_int_equal(*(const uint32_t *) c[0].bytes, 0);
        assert_true(*(const uint32_t *) c[1].bytes > 0);
        for (size_t k = 0; k < (size_t) 3 * 65 * 63; k++)
            assert_true(img.rgb[k] == 0);
        image_finish(&img);
        captures_finish(c);
    }
    ag_scene_destroy(scene);
}

// ---- reach -------------------------------------------------------------------------------

static capture splat_image(ag_scene *scene, const char *reach)
{
    const char *const settings[] = { "vpls=64", reach, NULL };
    capture c[] = { { .resource = "splat.image" }, { 0 } };
    image img = indirect(scene, (int[2]){ 65, 63 }, "splat", settings, c);
    image_finish(&img);
    return c[0];
}

static double energy(const capture *c)
{
    double sum = 0;
    for (size_t i = 0; i < c->size / sizeof(float); i++)
        sum += (double) c->texels[i];
    return sum;
}

// Sums of some of the same terms in the same order, none of them negative: rounding is monotonous,
// so that no texel may gain.
static void the_less_a_vpl_reaches_the_less_light_there_is(void **state)
{
    static const char *const reach[] = { "reach=0",    "reach=1e-12", "reach=0.001",
                                         "reach=0.01", "reach=0.1",   "reach=1e6" };
    double sums[FG_COUNT(reach)];
    (void) state;
    ag_scene *scene = furnished_room();
    capture all = splat_image(scene, reach[0]), more = splat_image(scene, reach[0]);
    sums[0] = energy(&all);
    assert_memory_equal(all.texels, more.texels, all.size); // twice the same
    for (int i = 1; i < FG_COUNT(reach); i++) {
        capture less = splat_image(scene, reach[i]);
        for (size_t k = 0; k < less.size / sizeof(float); k++)
            assert_true(less.texels[k] <= more.texels[k]);
        sums[i] = energy(&less);
        free(more.texels);
        more = less;
    }
    assert_true(sums[0] > 0 && sums[1] > 0.99999 * sums[0]);
    for (int i = 2; i < FG_COUNT(reach); i++)
        assert_true(sums[i] < sums[i - 1]);
    assert_true(sums[FG_COUNT(reach) - 1] == 0);
    free(all.texels);
    free(more.texels);
}

// The same room a thousand times as large under a light three times as strong.
static void reach_knows_neither_metres_nor_watts(void **state)
{
    double kept[2];
    (void) state;
    for (int i = 0; i < 2; i++) {
        const room_desc room = { .boxes = true, .edge = i ? 1024 : 1 };
        ag_light light = ceiling_spot(58);
        for (int k = 0; k < 3; k++)
            light.intensity[k] = i ? 3 : 1;
        ag_scene *scene = room_scene(&room, &light);
        capture all = splat_image(scene, "reach=0"), some = splat_image(scene, "reach=0.02");
        kept[i] = energy(&some) / energy(&all);
        free(all.texels);
        free(some.texels);
        ag_scene_destroy(scene);
    }
    assert_true(kept[0] > 0.05 && kept[0] < 0.95);
    // Pairs at the very threshold may fall to either side: one of some 2^16.
    assert_true(fabs(kept[1] / kept[0] - 1) < 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refinement_round_by_round_ends_at_the_texels_of_isr),
        cmocka_unit_test(thresholds_of_zero_make_each_pixel_a_patch),
        cmocka_unit_test(splatting_and_gathering_make_one_picture),
        cmocka_unit_test(every_pixel_a_patch_is_the_full_gather),
        cmocka_unit_test(without_vpls_there_is_no_light),
        cmocka_unit_test(the_less_a_vpl_reaches_the_less_light_there_is),
        cmocka_unit_test(reach_knows_neither_metres_nor_watts),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
