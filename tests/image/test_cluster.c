// SPDX-License-Identifier: MIT
// Light-space clusters of isr: their energy, where they sit, how many there are, and that they keep
// still when a light moves.
#include "fixture.h"

#include <math.h>
#include <pass/vpl_shared.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static image clusters(ag_scene *scene, const char *const *settings, capture *c)
{
    const shot s = { scene, 4, 4, LAYER_INDIRECT, plugin_named("isr"), settings, c };
    return shot_take(&s);
}

// How many VPLs there are; the caller frees them.
static uint32_t vpls_of(ag_scene *scene, const char *const *settings, ag_vpl **vpls)
{
    capture c[] = { { .resource = "isr.vpls" }, { .resource = "isr.count" }, { 0 } };
    image img = clusters(scene, settings, c);
    const uint32_t count = ((const uint32_t *) c[1].bytes)[0];
    assert_true(count * sizeof(ag_vpl) <= c[0].size);
    *vpls = c[0].bytes;
    free(c[1].bytes);
    image_finish(&img);
    return count;
}

static uint32_t count_of(ag_scene *scene, const char *const *settings)
{
    ag_vpl *vpls;
    const uint32_t count = vpls_of(scene, settings, &vpls);
    free(vpls);
    return count;
}

// ---- energy ----------------------------------------------------------------------------------

// Flux of three channels and the area of what reflects any.
static void map_sums(const capture *flux, const capture *position, double sums[4])
{
    const size_t texels = (size_t) flux->width * flux->height * flux->layers;
    memset(sums, 0, 4 * sizeof *sums);
    for (size_t i = 0; i < texels; i++) {
        const float *f = flux->texels + 4 * i;
        for (int k = 0; k < 3; k++)
            sums[k] += (double) f[k];
        sums[3] += f[0] + f[1] + f[2] > 0 ? (double) position->texels[4 * i + 3] : 0;
    }
}

static void expect_energy(ag_scene *scene, const char *const *settings)
{
    capture c[] = { { .resource = "isr.vpls" },
                    { .resource = "isr.count" },
                    { .resource = "isr.flux" },
                    { .resource = "isr.position" },
                    { 0 } };
    image img = clusters(scene, settings, c);
    const ag_vpl *v = c[0].bytes;
    const uint32_t count = ((const uint32_t *) c[1].bytes)[0];
    double want[4], got[4] = { 0 };
    map_sums(&c[2], &c[3], want);
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++)
            got[k] += (double) v[i].flux[k];
        got[3] += (double) v[i].position_area[3];
    }
    // Sums of floats, of at most 65536 texels a patch, in a tree.
    for (int k = 0; k < 4; k++)
        if (fabs(got[k] - want[k]) > 1e-4 * want[k])
            fail_msg("%s %s, sum %d: %.7g, not %.7g", settings[0], settings[1], k, got[k], want[k]);
    image_finish(&img);
    captures_finish(c);
}

static void patches_have_the_energy_of_the_map(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true,
                             .albedo = { { 0.6f, 0.1f, 0.1f }, { 0.2f, 0.5f, 0.1f } } };
    ag_light lights[5] = { ceiling_spot(58), ceiling_spot(80), ceiling_spot(90), ceiling_spot(90),
                           ceiling_spot(90) };
    lights[2].cosine = true;
    lights[3].kind = AG_LIGHT_POINT;
    lights[4].kind = AG_LIGHT_DIRECTIONAL;
    const char *const thresholds[] = { "light_flux=0", "light_flux=0.01", "light_flux=1" };
    const char *const grids[] = { "light_initial=64", "light_initial=8", "light_initial=1" };
    for (int i = 0; i < 5 * FG_COUNT(thresholds); i++) {
        ag_scene *scene = room_scene(&room, &lights[i / 3]);
        for (int k = 0; k < FG_COUNT(grids); k++) {
            const char *const settings[] = { thresholds[i % 3], grids[k], "rsm_size=128", NULL };
            expect_energy(scene, settings);
        }
        ag_scene_destroy(scene);
    }
    ag_scene *scene = room_scene(&room, &lights[0]);
    const char *const finest[] = { "light_initial=256", "light_coarsest=32", NULL };
    const char *const large[] = { "rsm_size=1024", "light_coarsest=1", "light_initial=8", NULL };
    const char *const single[] = { "rsm_size=1", "light_flux=0", NULL };
    expect_energy(scene, finest);
    expect_energy(scene, large);
    expect_energy(scene, single);
    ag_scene_destroy(scene);
}

// Channels of one light each, whose powers are far apart.
static void faint_lights_keep_their_energy(void **state)
{
    (void) state;
    static const double ratios[] = { 1, 1e4, 1e9 };
    for (int r = 0; r < FG_COUNT(ratios); r++) {
        const room_desc room = { .boxes = true };
        ag_builder *b = room_builder(&room);
        for (int i = 0; i < 3; i++) {
            ag_light light = ceiling_spot(i == 1 ? 80 : 58);
            snprintf(light.name, sizeof light.name, "light %d", i);
            light.kind = i == 2 ? AG_LIGHT_POINT : AG_LIGHT_SPOT;
            light.position[1] = 0.4 - 0.1 * i;
            for (int c = 0; c < 3; c++)
                light.intensity[c] = c == i ? (float) pow(ratios[r], -0.5 * i) : 0;
            ag_builder_light(b, -1, &light);
        }
        ag_scene *scene = finish_scene(b);
        const char *const settings[] = { "light_flux=0.01", "light_initial=64", NULL };
        const char *const one[] = { "light_flux=0.01", "light_coarsest=1", "light_initial=8",
                                    NULL };
        expect_energy(scene, settings);
        expect_energy(scene, one);
        ag_scene_destroy(scene);
    }
}

// A second light as strong takes patches from the first, a faint one next to none.
static void lights_share_the_patches_by_power(void **state)
{
    (void) state;
    uint32_t counts[3];
    for (int i = 0; i < 3; i++) {
        static const float intensities[3] = { 0, 1e-6f, 1 };
        const room_desc room = { 0 };
        ag_builder *b = room_builder(&room);
        for (int k = 0; k < 2; k++) {
            ag_light light = ceiling_spot(58);
            snprintf(light.name, sizeof light.name, "light %d", k);
            light.position[1] = k ? 0.3 : 0.47;
            for (int c = 0; k && c < 3; c++)
                light.intensity[c] = intensities[i];
            ag_builder_light(b, -1, &light);
        }
        ag_scene *scene = finish_scene(b);
        const char *const settings[] = { NULL };
        counts[i] = count_of(scene, settings);
        ag_scene_destroy(scene);
    }
    assert_true(counts[0] > 100);
    assert_in_range(counts[1], counts[0], counts[0] + 5); // one patch, of five walls
    assert_in_range(counts[2], counts[0] / 2, 2 * counts[0]);
}

// ---- where they sit ---------------------------------------------------------------------------

// A square of 4 m, one below a spot, whose cone ends on it.
static ag_scene *wall_scene(void)
{
    static const double p[3] = { -2, -1, -2 }, u[3] = { 0, 0, 4 }, v[3] = { 4, 0, 0 };
    ag_builder *b = ag_builder_create(test_log(), "wall");
    ag_light light = ceiling_spot(50);
    light.position[1] = 0;
    add_quad(b, -1, p, u, v);
    ag_builder_light(b, -1, &light);
    const ag_camera camera = plain_camera("there");
    ag_builder_camera(b, -1, &camera);
    return finish_scene(b);
}

static void a_flat_wall_has_the_coarsest_patches(void **state)
{
    (void) state;
    ag_scene *scene = wall_scene();
    const char *const coarsest[] = { "light_coarsest=8", "light_coarsest=16" };
    for (int i = 0; i < 2; i++) {
        const int edge = 8 << i;
        ag_vpl *v;
        const char *const settings[] = { coarsest[i], "light_flux=0", NULL };
        const uint32_t count = vpls_of(scene, settings, &v);
        // The cone is a circle in its square: pi / 4 of it, and patches on the rim.
        assert_in_range(count, (uint32_t) (0.75 * edge * edge), (uint32_t) (edge * edge));
        for (uint32_t k = 0; k < count; k++) {
            assert_true(v[k].normal[1] > 0.999f);
            assert_true(fabs((double) v[k].position_area[1] + 1) < 1e-5); // the camera is at 0
        }
        free(v);
    }
    ag_scene_destroy(scene);
}

// Whether a point lies on a wall of the room or a face of its boxes that has this normal.
static bool is_on_surface(const double p[3], const float n[3])
{
    static const double boxes[2][2][3] = {
        { { -0.35, -0.5, -0.35 }, { -0.05, 0.1, -0.1 } },
        { { 0.08, -0.5, 0.0 }, { 0.36, -0.22, 0.28 } },
    };
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (fabsf(n[k]) > fabsf(n[axis]))
            axis = k;
    if (fabsf(n[axis]) < 0.999f)
        return false;
    const int side = n[axis] > 0;
    if (fabs(p[axis] - (side ? -0.5 : 0.5)) < 1e-4)
        return true;
    for (int i = 0; i < 2; i++) {
        bool inside = fabs(p[axis] - boxes[i][side][axis]) < 1e-4;
        for (int k = 0; k < 3; k++)
            inside = inside && p[k] > boxes[i][0][k] - 1e-4 && p[k] < boxes[i][1][k] + 1e-4;
        if (inside)
            return true;
    }
    return false;
}

static void expect_on_surfaces(ag_scene *scene, const char *const *settings)
{
    ag_vpl *v;
    const uint32_t count = vpls_of(scene, settings, &v);
    for (uint32_t i = 0; i < count; i++) {
        const float *n = v[i].normal;
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = (double) v[i].position_area[k] + scene->cameras[0].world[12 + k];
        if (!is_on_surface(p, n))
            fail_msg("%s: VPL %u of %u at %g %g %g, normal %g %g %g", settings[0], i, count, p[0],
                     p[1], p[2], (double) n[0], (double) n[1], (double) n[2]);
    }
    free(v);
}

// Even patches over corners and silhouettes, which have a VPL for each of their surfaces.
static void vpls_sit_on_surfaces(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    const char *const thresholds[] = { "light_flux=0", "light_flux=0.01", "light_flux=1" };
    for (int t = 0; t < 3; t++) {
        const char *const settings[] = { thresholds[t], NULL };
        expect_on_surfaces(scene, settings);
    }
    ag_scene_destroy(scene);
}

static double half_to_double(uint32_t h)
{
    const int exponent = (int) (h >> 10 & 31);
    const double m = exponent ? 1 + (h & 1023) / 1024.0 : (h & 1023) / 1024.0;
    return (h & 0x8000 ? -1 : 1) * ldexp(m, (exponent ? exponent : 1) - 15);
}

// Length of a packed edge, over the root of the area.
static double edge_length(float packed)
{
    uint32_t bits;
    memcpy(&bits, &packed, sizeof bits);
    return hypot(half_to_double(bits & 0xffff), half_to_double(bits >> 16));
}

// A board of 4 m x 3 cm one below a spot: patches of 30 cm of it are as narrow as the board.
static void patches_have_the_shape_of_what_they_hold(void **state)
{
    (void) state;
    static const double p[3] = { -2, -1, -0.015 }, u[3] = { 0, 0, 0.03 }, v[3] = { 4, 0, 0 };
    ag_builder *b = ag_builder_create(test_log(), "board");
    ag_light light = ceiling_spot(50);
    light.position[0] = light.position[1] = light.position[2] = 0;
    add_quad(b, -1, p, u, v);
    ag_builder_light(b, -1, &light);
    const ag_camera camera = plain_camera("there");
    ag_builder_camera(b, -1, &camera);
    ag_scene *scene = finish_scene(b);
    const char *const settings[] = { "light_flux=1", NULL };
    ag_vpl *vpls;
    const uint32_t count = vpls_of(scene, settings, &vpls);
    double narrow = 0, whole = 0;
    assert_in_range(count, 8, 24);
    for (uint32_t i = 0; i < count; i++) {
        const double e = edge_length(vpls[i].normal[3]), f = edge_length(vpls[i].flux[3]);
        const double area = (double) vpls[i].position_area[3];
        whole += area;
        narrow += fmax(e, f) > 2 * fmin(e, f) ? area : 0; // a block's own are about as long
    }
    assert_true(narrow > 0.75 * whole); // but for ends that a block cuts off
    free(vpls);
    ag_scene_destroy(scene);
}

// What bends more than `light_normal` within a patch is divided, however smooth its depth is.
static void curved_walls_are_divided(void **state)
{
    (void) state;
    ag_scene *scene = sphere_scene(64, 0.5f);
    const char *const settings[] = { "light_flux=0", "light_coarsest=8", NULL };
    const char *const blind[] = { "light_flux=0", "light_coarsest=8", "light_normal=4",
                                  "light_depth=1e6", NULL };
    ag_vpl *v;
    const uint32_t count = vpls_of(scene, settings, &v), coarse = count_of(scene, blind);
    assert_true(count > 2 * coarse);
    for (uint32_t i = 0; i < count; i++) {
        const float *p = v[i].position_area, *n = v[i].normal;
        const double r = sqrt((double) (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
        // A patch of 0.3 rad from edge to edge has its mean at most 0.3^2 / 8 (1 - a cosine) deep,
        // in both directions, and facets 5e-3 more; its own normals' extent bounds how it is off.
        assert_true(r > 0.96 && r < 1.001);
        assert_true((double) -(p[0] * n[0] + p[1] * n[1] + p[2] * n[2]) / r > 0.995);
    }
    free(v);
    ag_scene_destroy(scene);
}

// ---- how many --------------------------------------------------------------------------------

static void the_share_of_flux_says_how_many(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    const char *const shares[] = { "light_flux=1", "light_flux=0.03", "light_flux=0.01",
                                   "light_flux=0.003", "light_flux=0" };
    uint32_t last = 0;
    for (int i = 0; i < FG_COUNT(shares); i++) {
        const char *const settings[] = { shares[i], "light_initial=64", NULL };
        const uint32_t count = count_of(scene, settings);
        assert_true(count > last);
        last = count;
    }
    assert_true(last > 1000);
    const char *const usual[] = { NULL };
    assert_in_range(count_of(scene, usual), 150, 400);
    ag_scene_destroy(scene);
}

static void nothing_lit_makes_no_vpl(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true };
    ag_light black = ceiling_spot(58);
    memset(black.intensity, 0, sizeof black.intensity);
    ag_scene *scene = room_scene(&room, &black);
    const char *const settings[] = { NULL };
    assert_int_equal(count_of(scene, settings), 0);
    ag_scene_destroy(scene);
}

static void clusters_twice_are_bit_identical(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(80);
    ag_scene *scene = room_scene(&room, &light);
    const char *const settings[] = { NULL };
    ag_vpl *a, *b;
    const uint32_t count = vpls_of(scene, settings, &a);
    assert_int_equal(vpls_of(scene, settings, &b), count);
    assert_memory_equal(a, b, count * sizeof *a);
    free(a);
    free(b);
    ag_scene_destroy(scene);
}

static void mistakes_name_value_and_rule(void **state)
{
    (void) state;
    const room_desc room = { 0 };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    const gi_plugin *plugin = plugin_named("isr");
    gi_value values[32];
    gi_params_default(plugin, values);
    assert_int_equal(gi_params_set(test_log(), plugin, values, "light_coarsest=2"), FG_OK);
    const renderer_desc desc = { .log = test_log(),
                                 .device = device(),
                                 .scene = scene,
                                 .width = 4,
                                 .height = 4,
                                 .plugin = plugin,
                                 .values = values,
                                 .strict = true };
    renderer *r = NULL;
    log_clear();
    assert_int_equal(renderer_create(&desc, &r), FG_OK);
    assert_int_equal(renderer_frame(r, 0), FG_ERR_INVALID);
    assert_non_null(strstr(log_text(), "isr: coarsest is 2, must be a power of two in [4, 32]"));
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

// ---- keeping still ---------------------------------------------------------------------------

enum { EDGE = 24, FRAMES = 6 };

// Mean change from one frame to the next while the light moves.
static double unrest(ag_scene *scene, const char *plugin, const char *const *settings)
{
    const ag_light start = scene->lights[0];
    image last = { 0 };
    double sum = 0;
    for (int f = 0; f < FRAMES; f++) {
        ag_light light = start;
        light.position[0] += 0.004 * f;
        light.position[2] += 0.003 * f;
        assert_int_equal(ag_scene_add_light(scene, &light), FG_OK);
        const shot s = { scene, EDGE, EDGE, LAYER_INDIRECT, plugin_named(plugin), settings, NULL };
        image img = shot_take(&s);
        for (int i = 0; f > 0 && i < 3 * EDGE * EDGE; i++)
            sum += fabs((double) (img.rgb[i] - last.rgb[i]));
        image_finish(&last);
        last = img;
    }
    image_finish(&last);
    assert_int_equal(ag_scene_add_light(scene, &start), FG_OK);
    return sum;
}

// What moves beyond what the light itself does is at most a quarter of that of single texels'.
static void patches_keep_still_where_texels_jump(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    const char *const all[] = { "pattern=all", "rsm_size=128", NULL };
    const char *const few[] = { "vpls=256", NULL };
    const char *const patches[] = { "depth=0", "normal=0", NULL };
    const double least = unrest(scene, "rsm", all);
    const double texels = unrest(scene, "rsm", few) - least;
    const double got = unrest(scene, "isr", patches) - least;
    assert_true(texels > 0);
    if (got > 0.25 * texels)
        fail_msg("%.3f of %.3f, %.3f by itself", got, texels, least);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patches_have_the_energy_of_the_map),
        cmocka_unit_test(faint_lights_keep_their_energy),
        cmocka_unit_test(lights_share_the_patches_by_power),
        cmocka_unit_test(a_flat_wall_has_the_coarsest_patches),
        cmocka_unit_test(vpls_sit_on_surfaces),
        cmocka_unit_test(patches_have_the_shape_of_what_they_hold),
        cmocka_unit_test(curved_walls_are_divided),
        cmocka_unit_test(the_share_of_flux_says_how_many),
        cmocka_unit_test(nothing_lit_makes_no_vpl),
        cmocka_unit_test(clusters_twice_are_bit_identical),
        cmocka_unit_test(mistakes_name_value_and_rule),
        cmocka_unit_test(patches_keep_still_where_texels_jump),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
