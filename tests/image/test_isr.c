// SPDX-License-Identifier: MIT
// Image-space radiosity as a whole: against the gather at every pixel, at its extremes.
#include "fixture.h"
#include "metrics.h"
#include "scenes.h"

#include <math.h>
#include <string.h>

static const char *const techniques[2] = { "isr", "rsm" };

// The light that `isr` and `rsm` gather from the same VPLs, with their own settings.
typedef struct pair {
    image isr, rsm;
    uint32_t texels; // that isr lit
} pair;

static pair render_pair(ag_scene *scene, const int size[2], const char *const *isr_settings,
                        const char *const *rsm_settings)
{
    pair p;
    capture c[] = { { .resource = "isr.texel_count" }, { 0 } };
    const shot isr = { scene,        size[0], size[1], LAYER_INDIRECT, plugin_named(techniques[0]),
                       isr_settings, c };
    const shot rsm = { scene,        size[0], size[1], LAYER_INDIRECT, plugin_named(techniques[1]),
                       rsm_settings, NULL };
    p.isr = shot_take(&isr);
    p.rsm = shot_take(&rsm);
    p.texels = ((const uint32_t *) c[0].bytes)[0];
    captures_finish(c);
    return p;
}

static metrics pair_finish(pair *p)
{
    metrics m;
    assert_int_equal(metrics_compare(test_log(), &p->isr, &p->rsm, &m), FG_OK);
    image_finish(&p->isr);
    image_finish(&p->rsm);
    assert_int_equal(m.nonfinite, 0);
    return m;
}

static ag_scene *furnished_room(int lights)
{
    static const room_desc room = { .boxes = true };
    ag_builder *b = room_builder(&room);
    for (int i = 0; i < lights; i++) {
        ag_light light = ceiling_spot(58);
        light.position[0] += 0.3 * i;
        light.position[2] -= 0.2 * i;
        light.intensity[i % 3] = 3;
        if (i == 1)
            light.kind = AG_LIGHT_POINT;
        ag_builder_light(b, -1, &light);
    }
    return finish_scene(b);
}

// ---- thresholds --------------------------------------------------------------------------------

static void expect_rsm(ag_scene *scene, const int size[2], const char *share, const char *cull,
                       const char *clamp)
{
    const char *const isr[] = {
        "source=regular", "vpls=64", "rsm_size=64", "depth=0", "normal=0", share, cull, clamp, NULL
    };
    const char *const rsm[] = { "vpls=64", "rsm_size=64", clamp, NULL };
    pair p = render_pair(scene, size, isr, rsm);
    assert_int_equal(p.texels, size[0] * size[1]);
    assert_true(image_mean(&p.rsm) > 0);
    for (int i = 0; i < 3 * size[0] * size[1]; i++)
        if (!same_bits(p.isr.rgb + i, p.rsm.rgb + i, sizeof(float)))
            fail_msg("%d x %d, %s, %s, %s: pixel %d, %d is %.9g, rsm has %.9g", size[0], size[1],
                     share, cull, clamp, i / 3 % size[0], i / 3 / size[0], (double) p.isr.rgb[i],
                     (double) p.rsm.rgb[i]);
    pair_finish(&p);
}

static void thresholds_of_0_give_the_bits_of_rsm(void **state)
{
    static const int sizes[][2] = { { 1, 1 }, { 2, 1 }, { 64, 64 }, { 65, 63 }, { 131, 40 } };
    (void) state;
    ag_scene *one = furnished_room(1), *three = furnished_room(3);
    for (int i = 0; i < FG_COUNT(sizes); i++) {
        expect_rsm(one, sizes[i], "share=0", "cull=compact", "clamp=footprint");
        expect_rsm(three, sizes[i], "share=3", "cull=compact", "clamp=footprint");
        expect_rsm(one, sizes[i], "share=3", "cull=stencil", "clamp=disc");
    }
    expect_rsm(three, sizes[3], "share=1", "cull=stencil", "clamp=footprint");
    ag_scene_destroy(one);
    ag_scene_destroy(three);
}

// Nothing is left of edges where blocks of up to an eighth of the room are lit at their middles.
// What that is too bright on one side of a middle it is too dark on the other; what does not cancel
// is the curvature over a block, of the order of its edge squared, (1/8)^2 = 1.6 %, and edges,
// which add about as much by chance: measured 0.7 to 2.9 %. Of two pixels one alone is lit: 5.6 %.
static void infinite_thresholds_keep_most_of_the_energy(void **state)
{
    static const int sizes[][2] = { { 64, 64 }, { 65, 63 }, { 131, 40 }, { 1, 1 }, { 2, 1 } };
    (void) state;
    ag_scene *scene = furnished_room(1);
    for (int i = 0; i < FG_COUNT(sizes); i++) {
        for (int share = 0; share <= 3; share += 3) {
            const char *const isr[] = { "source=regular",
                                        "vpls=64",
                                        "coarsest=8",
                                        "depth=1e6",
                                        "normal=4",
                                        share ? "share=3" : "share=0",
                                        NULL };
            const char *const rsm[] = { "vpls=64", NULL };
            pair p = render_pair(scene, sizes[i], isr, rsm);
            const uint32_t texels = p.texels, pixels = (uint32_t) (sizes[i][0] * sizes[i][1]);
            const metrics m = pair_finish(&p);
            assert_true(fabs(m.energy_ratio - 1) < (pixels > 2 ? 0.05 : 0.1));
            assert_true(pixels <= 2 || texels < pixels / 8);
        }
    }
    ag_scene_destroy(scene);
}

// ---- error -------------------------------------------------------------------------------------

// The bounds are those that the defaults are chosen for, at 1024^2; measured here: 2.0 % of RMS,
// 0.4 % of the maximum, 4240 texels. A quarter as many pixels see edges four times as wide.
static void cornell_is_within_3_5_percent_at_an_eighth_of_the_pixels(void **state)
{
    (void) state;
    static const int size[2] = { 256, 256 };
    ag_scene *scene = NULL;
    assert_int_equal(scenes_open(test_log(), "cornell", &scene), FG_OK);
    const char *const isr[] = { "source=regular", "vpls=256", NULL };
    const char *const rsm[] = { "vpls=256", NULL };
    pair p = render_pair(scene, size, isr, rsm);
    const uint32_t texels = p.texels;
    const metrics m = pair_finish(&p);
    print_message("eye hierarchy: %u texels, relative RMSE %.4f, over maximum %.4f, energy %.4f\n",
                  texels, m.rmse_rms, m.rmse_max, m.energy_ratio);
    assert_true(m.rmse_rms < 0.035 && m.rmse_max < 0.015);
    assert_true(texels < 256 * 256 / 8);
    ag_scene_destroy(scene);
}

static void several_lights_add_up(void **state)
{
    (void) state;
    static const int size[2] = { 96, 96 };
    ag_scene *scene = furnished_room(3);
    const char *const isr[] = { "source=regular", "vpls=256", NULL };
    const char *const rsm[] = { "vpls=256", NULL };
    pair p = render_pair(scene, size, isr, rsm);
    const metrics m = pair_finish(&p);
    // Edges are everywhere at this size: measured 6.4 %. A light that is left out takes a tenth of
    // the energy at least.
    assert_true(m.rmse_rms < 0.1 && fabs(m.energy_ratio - 1) < 0.02);
    ag_scene_destroy(scene);
}

// ---- nothing -----------------------------------------------------------------------------------

static void expect_black(ag_scene *scene, const char *what)
{
    static const int sizes[][2] = { { 1, 1 }, { 65, 63 } };
    static const char *const settings[][4] = { { "share=0", "source=regular" },
                                               { "share=3", "source=clusters" },
                                               { "share=3", "cull=stencil", "source=regular" },
                                               { "depth=0", "normal=0" },
                                               { "depth=1e6", "normal=4" } };
    for (int i = 0; i < FG_COUNT(sizes) * FG_COUNT(settings); i++) {
        const int *size = sizes[i / FG_COUNT(settings)];
        const char *const *chosen = settings[i % FG_COUNT(settings)];
        image img =
            render_layer(scene, size[0], size[1], LAYER_INDIRECT, plugin_named("isr"), chosen);
        for (int k = 0; k < 3 * size[0] * size[1]; k++)
            if (img.rgb[k] != 0)
                fail_msg("%s, %s, %d x %d: pixel %d is %g", what, chosen[0], size[0], size[1],
                         k / 3, (double) img.rgb[k]);
        image_finish(&img);
    }
    ag_scene_destroy(scene);
}

// A wall of 2 m, 1 m in front of the camera or behind it, and a spot half way that looks along
// `direction` in z.
static ag_scene *wall_scene(double wall, double spot, double direction)
{
    ag_builder *b = ag_builder_create(test_log(), "wall");
    const double p[3] = { -1, -1, wall }, u[3] = { 2, 0, 0 }, v[3] = { 0, 2, 0 };
    ag_light light = ceiling_spot(58);
    const ag_camera camera = plain_camera("plain");
    light.position[0] = light.position[1] = 0;
    light.position[2] = spot;
    light.direction[1] = 0;
    light.direction[2] = (float) direction;
    add_quad(b, -1, p, u, v);
    if (spot != 0)
        ag_builder_light(b, -1, &light);
    ag_builder_camera(b, -1, &camera);
    return finish_scene(b);
}

static void without_light_or_anything_to_see_it_is_black(void **state)
{
    (void) state;
    expect_black(wall_scene(-1, -0.5, 1), "light facing away");
    expect_black(wall_scene(1, 0.5, 1), "nothing in view");
    expect_black(wall_scene(-1, 0, 0), "no light");
    expect_black(wall_scene(-1, -0.5, -1), "one plane, which lights nothing");
}

static ag_scene *triangle_scene(void)
{
    static const uint32_t indices[3] = { 0, 1, 2 };
    ag_vertex corners[3];
    memset(corners, 0, sizeof corners);
    for (int i = 0; i < 3; i++) {
        corners[i].position[0] = i == 1 ? 1 : -1;
        corners[i].position[1] = i == 2 ? 1 : -1;
        corners[i].position[2] = -2;
        for (int k = 0; k < 4; k++)
            corners[i].color[k] = 1;
    }
    const ag_primitive_desc triangle = { .name = "triangle",
                                         .vertices = corners,
                                         .vertex_count = 3,
                                         .indices = indices,
                                         .index_count = 3,
                                         .material = -1 };
    const ag_node_desc node = { .name = "triangle", .parent = -1 };
    ag_builder *b = ag_builder_create(test_log(), "triangle");
    ag_light light = ceiling_spot(58);
    const ag_camera camera = plain_camera("plain");
    light.position[1] = 0;
    light.direction[1] = 0;
    light.direction[2] = -1;
    ag_builder_show(b, ag_builder_node(b, &node), ag_builder_primitive(b, &triangle), -1);
    ag_builder_light(b, -1, &light);
    ag_builder_camera(b, -1, &camera);
    return finish_scene(b);
}

static void one_triangle_lights_nothing(void **state)
{
    (void) state;
    expect_black(triangle_scene(), "one triangle");
}

// ---- what must not change it -------------------------------------------------------------------

// Lengths are scaled by a power of two and back, so that floats round alike but for the scene's own
// corners, 2^-24 of it, which thresholds may take either way: measured 1.7e-4.
static image room_of(double edge, double offset)
{
    const room_desc room = { .edge = edge, .centre = { offset, -offset, offset }, .boxes = true };
    const char *const settings[] = { "source=regular", NULL };
    ag_light light = ceiling_spot(58);
    for (int k = 0; k < 3; k++)
        light.intensity[k] = (float) (edge * edge); // E = I / r^2 stays as it is
    ag_scene *scene = room_scene(&room, &light);
    image img = render_layer(scene, 96, 70, LAYER_INDIRECT, plugin_named("isr"), settings);
    ag_scene_destroy(scene);
    return img;
}

static void scale_and_place_do_not_matter(void **state)
{
    static const double others[][2] = { { 1e-4, 0 }, { 1e-2, 0 }, { 1e4, 0 }, { 1, 1e6 } };
    (void) state;
    image want = room_of(1, 0);
    for (int i = 0; i < FG_COUNT(others); i++) {
        image got = room_of(others[i][0], others[i][1]);
        metrics m;
        assert_int_equal(metrics_compare(test_log(), &got, &want, &m), FG_OK);
        if (m.nonfinite || !(m.rmse_rms < 0.01) || !(fabs(m.energy_ratio - 1) < 1e-3))
            fail_msg("edge %g m, %g m away: relative RMSE %g, energy %g", others[i][0],
                     others[i][1], m.rmse_rms, m.energy_ratio);
        image_finish(&got);
    }
    image_finish(&want);
}

static image render_debug(ag_scene *scene, const char *const *settings, unsigned debug)
{
    gi_value values[32];
    renderer *r = NULL;
    image img = { 0 };
    const gi_plugin *plugin = plugin_named("isr");
    gi_params_default(plugin, values);
    for (int i = 0; settings[i]; i++)
        assert_int_equal(gi_params_set(test_log(), plugin, values, settings[i]), FG_OK);
    const renderer_desc desc = { .log = test_log(),
                                 .device = device(),
                                 .scene = scene,
                                 .width = 65,
                                 .height = 63,
                                 .plugin = plugin,
                                 .values = values,
                                 .layers = 1u << LAYER_INDIRECT,
                                 .debug = debug,
                                 .seed = 3,
                                 .strict = true };
    log_clear();
    // Twice: what the first frame left does not show in the second.
    if (renderer_create(&desc, &r) || renderer_frame(r, 0) || renderer_frame(r, 0) ||
        renderer_read(r, LAYER_INDIRECT, &img))
        fail_msg("frame: %s", log_text());
    renderer_destroy(r);
    return img;
}

// Memory full of NaN, memory of its own for each, another legal order, a second run.
static void expect_same_in_all_memory(ag_scene *scene, const char *const *settings)
{
    static const unsigned debug[] = { 0, FG_DEBUG_POISON, FG_DEBUG_POISON | FG_DEBUG_NO_SHARING,
                                      FG_DEBUG_RANDOM_ORDER | FG_DEBUG_KEEP_ALL };
    image want = render_debug(scene, settings, 0);
    for (int k = 0; k < FG_COUNT(debug); k++) {
        image got = render_debug(scene, settings, debug[k]);
        if (!same_bits(got.rgb, want.rgb, sizeof(float) * 3 * 65 * 63))
            fail_msg("%s, debug %u: another picture", settings[0], debug[k]);
        image_finish(&got);
    }
    image_finish(&want);
}

static void what_memory_held_does_not_show(void **state)
{
    static const char *const settings[][5] = { { "share=0" },
                                               { "share=2", "coarsest=4" },
                                               { "share=3", "coarsest=8" },
                                               { "cull=stencil", "source=regular" },
                                               { "share=0", "coarsest=1", "depth=1e6",
                                                 "normal=4" } };
    (void) state;
    ag_scene *room = furnished_room(2), *wall = triangle_scene();
    for (int i = 0; i < 2 * FG_COUNT(settings); i++)
        expect_same_in_all_memory(i % 2 ? wall : room, settings[i / 2]);
    ag_scene_destroy(room);
    ag_scene_destroy(wall);
}

// ---- extremes ----------------------------------------------------------------------------------

// A floor of 200 m from 1 cm above it, its far end 2^-14 of the near one: one plane all over, and
// no reason to refine it but its rim.
static void a_grazing_floor_is_not_refined(void **state)
{
    (void) state;
    static const int size[2] = { 256, 128 };
    static const char *const metric[2] = { "metric=plane", "metric=slope" };
    uint32_t texels[2];
    ag_builder *b = ag_builder_create(test_log(), "floor");
    const double p[3] = { -100, -0.01, 100 }, u[3] = { 200, 0, 0 }, v[3] = { 0, 0, -200 };
    ag_light light = ceiling_spot(58);
    const ag_camera camera = plain_camera("plain");
    add_quad(b, -1, p, u, v);
    ag_builder_light(b, -1, &light);
    ag_builder_camera(b, -1, &camera);
    ag_scene *scene = finish_scene(b);
    for (int i = 0; i < 2; i++) {
        const char *const isr[] = { "source=regular", "vpls=64", "share=0", metric[i], NULL };
        const char *const rsm[] = { "vpls=64", NULL };
        pair q = render_pair(scene, size, isr, rsm);
        texels[i] = q.texels;
        pair_finish(&q);
    }
    // Texels of 4 pixels: 1024 for the lower half. Two rows at the horizon are refined to pixels.
    assert_true(texels[0] < 256 * 128 / 8);
    assert_true(texels[1] > texels[0]);
    ag_scene_destroy(scene);
}

static void a_light_at_a_wall_stays_finite(void **state)
{
    (void) state;
    static const int size[2] = { 65, 63 };
    for (int i = 0; i < 3; i++) {
        static const room_desc room = { .boxes = true };
        ag_light light = ceiling_spot(58);
        light.kind = AG_LIGHT_POINT;
        light.position[0] = 0.2; // on the wall, before and behind it
        light.position[1] = i == 0 ? 0.5 : i == 1 ? 0.499 : 0.501;
        ag_scene *scene = room_scene(&room, &light);
        const char *const isr[] = { "source=regular", "vpls=256", NULL };
        const char *const rsm[] = { "vpls=256", NULL };
        pair p = render_pair(scene, size, isr, rsm);
        const metrics m = pair_finish(&p);
        assert_true(isfinite(m.energy_ratio) && fabs(m.energy_ratio - 1) < 0.1);
        ag_scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thresholds_of_0_give_the_bits_of_rsm),
        cmocka_unit_test(infinite_thresholds_keep_most_of_the_energy),
        cmocka_unit_test(cornell_is_within_3_5_percent_at_an_eighth_of_the_pixels),
        cmocka_unit_test(several_lights_add_up),
        cmocka_unit_test(without_light_or_anything_to_see_it_is_black),
        cmocka_unit_test(one_triangle_lights_nothing),
        cmocka_unit_test(scale_and_place_do_not_matter),
        cmocka_unit_test(what_memory_held_does_not_show),
        cmocka_unit_test(a_grazing_floor_is_not_refined),
        cmocka_unit_test(a_light_at_a_wall_stays_finite),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
