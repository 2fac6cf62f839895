// SPDX-License-Identifier: MIT
// The Cornell box as a plugin renders it against the path-traced reference.
#include "fixture.h"
#include "metrics.h"
#include "reference.h"
#include "scenes.h"

#include <math.h>
#include <stdio.h>

static ag_scene *cornell(void)
{
    ag_scene *scene = NULL;
    log_clear();
    if (scenes_open(test_log(), "cornell", &scene))
        fail_msg("%s", log_text());
    return scene;
}

static image reference(const ag_scene *scene, int size, int bounces, int spp, uint64_t seed)
{
    image img = { 0 };
    const reference_desc desc = {
        .log = test_log(),
        .scene = scene,
        .camera = &scene->cameras[0],
        .width = size,
        .height = size,
        .bounces = bounces,
        .spp = spp,
        .seed = seed,
        .layer = bounces ? REFERENCE_INDIRECT : REFERENCE_DIRECT,
        .unshadowed_bounce = bounces > 0,
    };
    if (reference_render(&desc, &img))
        fail_msg("%s", log_text());
    return img;
}

static metrics compare(const image *a, const image *b)
{
    metrics m;
    assert_int_equal(metrics_compare(test_log(), a, b, &m), FG_OK);
    assert_int_equal(m.nonfinite, 0);
    return m;
}

// What is left are pixels on edges: a shadow's, where the map's texel blends two sides.
static void direct_light_is_the_references(void **state)
{
    (void) state;
    ag_scene *scene = cornell();
    image ours = render_layer(scene, 256, 256, LAYER_DIRECT, NULL, NULL);
    image truth = reference(scene, 256, 0, 1, 1);
    const metrics m = compare(&ours, &truth);
    print_message("direct: relative RMSE %.4f, energy %.5f\n", m.rmse_rms, m.energy_ratio);
    assert_true(m.rmse_rms < 0.03);
    assert_true(fabs(m.energy_ratio - 1) < 0.005);
    image_finish(&ours);
    image_finish(&truth);
    ag_scene_destroy(scene);
}

// The error left at the finest map is that of pixels nearer to a lit surface than a texel of it,
// which see its VPLs from too flat: rows of one pixel along inner edges, of which 64^2 has about
// 100 of 4096 with errors around a third.
static void one_bounce_nears_the_references_as_the_map_grows(void **state)
{
    enum { SIZE = 64, SPP = 512 };
    static const char *const sizes[] = { "rsm_size=32", "rsm_size=64", "rsm_size=128",
                                         "rsm_size=256" };
    (void) state;
    ag_scene *scene = cornell();
    image truth = reference(scene, SIZE, 1, SPP, 1);
    image again = reference(scene, SIZE, 1, SPP, 2);
    // The two differ by the noise of both; the reference alone has half of that variance.
    const double noise = compare(&again, &truth).rmse_rms / sqrt(2);
    double before = 1;
    for (int i = 0; i < FG_COUNT(sizes); i++) {
        const char *const settings[] = { sizes[i], "pattern=all", NULL };
        image ours = render_layer(scene, SIZE, SIZE, LAYER_INDIRECT, plugin_rsm(), settings);
        const metrics m = compare(&ours, &truth);
        const double error = sqrt(fmax(m.rmse_rms * m.rmse_rms - noise * noise, 0));
        print_message("%s: relative RMSE %.4f without the reference's noise of %.4f, energy %.4f\n",
                      sizes[i], error, noise, m.energy_ratio);
        assert_true(error < before);
        before = error;
        if (i == FG_COUNT(sizes) - 1)
            assert_true(fabs(m.energy_ratio - 1) < 0.01);
        image_finish(&ours);
    }
    assert_true(before < 0.055);
    image_finish(&truth);
    image_finish(&again);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(direct_light_is_the_references),
        cmocka_unit_test(one_bounce_nears_the_references_as_the_map_grows),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
