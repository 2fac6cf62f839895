// SPDX-License-Identifier: MIT
// The rsm plugin: energy of its maps and VPLs, its gather against sums and closed forms, and what
// must not change it.
#include "fixture.h"

#include <math.h>
#include <pass/vpl_shared.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979;

static const float white[3] = { 1, 1, 1 };

static room_desc white_room(void)
{
    room_desc room = { 0 };
    for (int i = 0; i < 6; i++)
        memcpy(room.albedo[i], white, sizeof white);
    return room;
}

static double vpl_power(const capture *vpls, const capture *count)
{
    const ag_vpl *v = vpls->bytes;
    const uint32_t *n = count->bytes;
    double sum = 0;
    for (uint32_t i = 0; i < n[0]; i++)
        sum += (double) v[i].flux[0];
    return sum;
}

// The power of all VPLs of a white room, W.
static double room_power(ag_scene *scene, const char *const *settings)
{
    capture captures[] = { { .resource = "rsm.vpls" }, { .resource = "rsm.count" }, { 0 } };
    image img = render_captured(scene, 4, 4, LAYER_INDIRECT, settings, captures);
    const double power = vpl_power(&captures[0], &captures[1]);
    image_finish(&img);
    captures_finish(captures);
    return power;
}

// ---- energy -------------------------------------------------------------------------------

// All of the light's power lands on some texel: what is left is the midpoint rule over a spot's
// ramp, 64 samples across at least, whose second derivative jumps at the ramp's ends.
static void expect_power(ag_scene *scene, double want, const char *size, double bound)
{
    const char *const settings[] = { size, "pattern=all", NULL };
    const double got = room_power(scene, settings);
    if (fabs(got / want - 1) > bound)
        fail_msg("%s: %.6f W of %.6f W (%+.2e)", size, got, want, got / want - 1);
}

static void maps_hold_the_power_of_the_light(void **state)
{
    (void) state;
    const room_desc room = white_room();
    ag_light lights[4] = { ceiling_spot(35), ceiling_spot(58), ceiling_spot(80), ceiling_spot(90) };
    lights[3].cosine = true;
    for (int l = 0; l < FG_COUNT(lights); l++) {
        ag_scene *scene = room_scene(&room, &lights[l]);
        const double want = spot_power(&lights[l]);
        expect_power(scene, want, "rsm_size=256", 1e-4);
        expect_power(scene, want, "rsm_size=32", 2e-3);
        expect_power(scene, want, "rsm_size=2", 2e-3);
        // One texel of a face loses all where its centre is in the dark, as in half of a
        // cosine spot's side faces; from two on both halves have centres.
        if (l < 2)
            expect_power(scene, want, "rsm_size=1", 2e-3);
        ag_scene_destroy(scene);
    }
}

static void point_light_spends_its_power_on_six_faces(void **state)
{
    (void) state;
    const room_desc room = white_room();
    ag_light light = ceiling_spot(90);
    light.kind = AG_LIGHT_POINT;
    light.position[1] = 0.1;
    ag_scene *scene = room_scene(&room, &light);
    static const char *const settings[] = { "rsm_size=64", "pattern=all", NULL };
    // Exact solid angles: the sum is 4 pi but for float rounding of 24576 terms.
    assert_true(fabs(room_power(scene, settings) / (4 * pi) - 1) < 1e-5);
    ag_scene_destroy(scene);
}

static double layer_sum(const capture *c, int layer, int channel)
{
    const size_t texels = (size_t) c->width * c->height;
    double sum = 0;
    for (size_t i = 0; i < texels; i++)
        sum += (double) c->texels[4 * (texels * layer + i) + channel];
    return sum;
}

static void solid_angles_of_a_face_sum_to_its_own(void **state)
{
    (void) state;
    const room_desc room = white_room();
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    const double t = tan(58 * pi / 180);
    const double want = 4 * asin(t * t / (1 + t * t));
    const char *const sizes[] = { "rsm_size=1", "rsm_size=16", "rsm_size=512" };
    for (int s = 0; s < FG_COUNT(sizes); s++) {
        const char *const settings[] = { sizes[s], "vpls=1", NULL };
        capture captures[] = { { .resource = "rsm.flux" }, { 0 } };
        image img = render_captured(scene, 4, 4, LAYER_INDIRECT, settings, captures);
        assert_true(fabs(layer_sum(&captures[0], 0, 3) / want - 1) < 1e-5);
        image_finish(&img);
        captures_finish(captures);
    }
    ag_scene_destroy(scene);
}

// Power of the VPLs on the floor, W.
static double floor_power(ag_scene *scene, const char *size)
{
    const char *const settings[] = { size, "pattern=all", NULL };
    capture c[] = { { .resource = "rsm.vpls" }, { .resource = "rsm.count" }, { 0 } };
    image img = render_captured(scene, 4, 4, LAYER_INDIRECT, settings, c);
    const ag_vpl *v = c[0].bytes;
    const uint32_t *count = c[1].bytes;
    double sum = 0;
    for (uint32_t i = 0; i < count[0]; i++)
        sum += v[i].normal[1] > 0.5f ? (double) v[i].flux[0] : 0;
    image_finish(&img);
    captures_finish(c);
    return sum;
}

// The floor's edges run along the world's axes, as a light's map must not: a row of texels that is
// taken for the floor or for the walls at once is 1 part in 20 of the floor at 64 texels. Texels
// along a slanted edge are off by half of one each, some 80 of them, in turns to both sides.
static void a_map_gives_each_wall_its_share(void **state)
{
    (void) state;
    const room_desc room = white_room();
    ag_light lights[3] = { ceiling_spot(58), ceiling_spot(80), ceiling_spot(58) };
    lights[2].kind = AG_LIGHT_POINT;
    for (int l = 0; l < FG_COUNT(lights); l++) {
        lights[l].position[0] = lights[l].position[2] = 0; // both edges at one phase: the worst
        ag_scene *scene = room_scene(&room, &lights[l]);
        const double want = floor_power(scene, "rsm_size=512");
        const double got = floor_power(scene, "rsm_size=64");
        if (fabs(got / want - 1) > 0.01)
            fail_msg("light %d: %.4f W of %.4f W on the floor", l, got, want);
        ag_scene_destroy(scene);
    }
}

// truth.md's erratum of eq. 4: over a 90-degree face the centre is 6 / pi = 1.91 too dark.
static void equal_solid_angles_are_off_by_what_the_paper_says_nothing_of(void **state)
{
    (void) state;
    const room_desc room = white_room();
    ag_light light = ceiling_spot(90);
    light.kind = AG_LIGHT_POINT;
    light.position[1] = 0;
    ag_scene *scene = room_scene(&room, &light);
    const char *const exact[] = { "rsm_size=64", "vpls=1", NULL };
    const char *const equal[] = { "rsm_size=64", "vpls=1", "solid_angle=equal", NULL };
    capture a[] = { { .resource = "rsm.flux" }, { 0 } };
    capture b[] = { { .resource = "rsm.flux" }, { 0 } };
    image first = render_captured(scene, 4, 4, LAYER_INDIRECT, exact, a);
    image second = render_captured(scene, 4, 4, LAYER_INDIRECT, equal, b);
    const size_t centre = 4 * (64 * 32 + 32) + 3, corner = 3;
    // A texel's solid angle varies by 3 texels of 1/32 across the corner's, less at the centre.
    assert_true(fabs((double) (a->texels[centre] / b->texels[centre]) - 6 / pi) < 0.01);
    assert_true(fabs((double) (b->texels[corner] / a->texels[corner]) - pi * sqrt(3) / 2) < 0.13);
    assert_true(fabs(layer_sum(b, 0, 3) / layer_sum(a, 0, 3) - 1) < 1e-5);
    image_finish(&first);
    image_finish(&second);
    captures_finish(a);
    captures_finish(b);
    ag_scene_destroy(scene);
}

static void choosing_fewer_vpls_keeps_the_energy(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true,
                             .albedo = { { 0.6f, 0.1f, 0.1f }, { 0.2f, 0.5f, 0.1f } } };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    const char *const all[] = { "pattern=all", NULL };
    const double want = room_power(scene, all);
    const char *const patterns[] = { "pattern=regular", "pattern=stratified" };
    const char *const counts[] = { "vpls=1", "vpls=17", "vpls=256", "vpls=16384" };
    for (int i = 0; i < 2 * FG_COUNT(counts); i++) {
        const char *const settings[] = { patterns[i % 2], counts[i / 2], NULL };
        const double got = room_power(scene, settings);
        // The same float terms in another order: 65536 of them, 2^-24 each.
        if (fabs(got / want - 1) > 1e-5)
            fail_msg("%s %s: %.7f W of %.7f W", settings[0], settings[1], got, want);
    }
    // Blocks of 262144 texels, that no device may leave half-way.
    const char *const large[] = { "rsm_size=512", "pattern=all", NULL };
    const char *const one[] = { "rsm_size=512", "vpls=1", NULL };
    const double full = room_power(scene, large), got = room_power(scene, one);
    if (fabs(got / full - 1) > 1e-5)
        fail_msg("one VPL of 512 x 512 texels: %.7f W of %.7f W", got, full);
    ag_scene_destroy(scene);
}

static void stratified_vpls_follow_the_seed(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    const char *const seeds[] = { "seed=1", "seed=1", "seed=2" };
    capture captures[3][2] = { 0 };
    for (int i = 0; i < 3; i++) {
        const char *const settings[] = { "pattern=stratified", "vpls=64", seeds[i], NULL };
        captures[i][0].resource = "rsm.vpls";
        image img = render_captured(scene, 4, 4, LAYER_INDIRECT, settings, captures[i]);
        image_finish(&img);
    }
    const size_t size = 16 * sizeof(ag_vpl); // what is valid for sure
    assert_memory_equal(captures[0][0].bytes, captures[1][0].bytes, size);
    assert_memory_not_equal(captures[0][0].bytes, captures[2][0].bytes, size);
    for (int i = 0; i < 3; i++)
        captures_finish(captures[i]);
    ag_scene_destroy(scene);
}

// ---- gather -------------------------------------------------------------------------------

typedef double (*spread_fn)(double d2, double area);

static double disc(double d2, double area)
{
    return pi * d2 + area;
}

static double none(double d2, double area)
{
    (void) area;
    return pi * d2;
}

static double constant(double d2, double area)
{
    (void) area;
    return pi * fmax(d2, 0.02);
}

// E / pi at a receiver, summed in double over the VPLs that the GPU made.
static double gather(const ag_vpl *vpls, uint32_t count, const float *p, const float *n,
                     spread_fn spread)
{
    double sum = 0;
    for (uint32_t j = 0; j < count; j++) {
        double d2 = 0, ci = 0, cj = 0;
        for (int k = 0; k < 3; k++) {
            const double d = (double) vpls[j].position_area[k] - (double) p[k];
            d2 += d * d;
            ci += d * (double) n[k];
            cj -= d * (double) vpls[j].normal[k];
        }
        if (ci > 0 && cj > 0)
            sum += (double) vpls[j].flux[0] * ci * cj /
                   (d2 * spread(d2, (double) vpls[j].position_area[3]));
    }
    return sum / pi;
}

static void expect_gather(const char *clamp, spread_fn spread)
{
    enum { W = 37, H = 23 };
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    const char *const settings[] = { "rsm_size=32", "pattern=all", clamp, "clamp_d2=0.02", NULL };
    capture c[] = { { .resource = "rsm.vpls" },       { .resource = "rsm.count" },
                    { .resource = "rsm.indirect" },   { .resource = "gbuffer.position" },
                    { .resource = "gbuffer.normal" }, { 0 } };
    image img = render_captured(scene, W, H, LAYER_INDIRECT, settings, c);
    const uint32_t *count = c[1].bytes;
    assert_in_range(count[0], 600, 1024); // pi / 4 of the texels are within the cone
    assert_int_equal(count[1], 1024);
    for (int i = 0; i < W * H; i++) {
        const double want = gather(c[0].bytes, count[0], c[3].texels + 4 * (size_t) i,
                                   c[4].texels + 4 * (size_t) i, spread);
        const double got = (double) c[2].texels[4 * (size_t) i];
        // 1024 float terms in sums of 64: 64 + 16 roundings at most; a cosine of one near
        // grazing loses some more.
        if (fabs(got - want) > 1e-5 * want + 1e-9)
            fail_msg("%s, pixel %d: %.8g, not %.8g", clamp, i, got, want);
    }
    image_finish(&img);
    captures_finish(c);
    ag_scene_destroy(scene);
}

static void gather_is_the_sum_over_its_vpls(void **state)
{
    (void) state;
    expect_gather("clamp=disc", disc);
    expect_gather("clamp=none", none);
    expect_gather("clamp=constant", constant);
}

// 6 faces of 128^2: more VPLs than rounds that some devices let a loop have.
static void every_one_of_98304_vpls_counts(void **state)
{
    enum { W = 8, H = 8 };
    (void) state;
    const room_desc room = white_room();
    ag_light light = ceiling_spot(58);
    light.kind = AG_LIGHT_POINT;
    light.position[1] = 0;
    ag_scene *scene = room_scene(&room, &light);
    const char *const settings[] = { "rsm_size=128", "pattern=all", "clamp=disc", NULL };
    capture c[] = { { .resource = "rsm.vpls" },       { .resource = "rsm.count" },
                    { .resource = "rsm.indirect" },   { .resource = "gbuffer.position" },
                    { .resource = "gbuffer.normal" }, { 0 } };
    image img = render_captured(scene, W, H, LAYER_INDIRECT, settings, c);
    const uint32_t *count = c[1].bytes;
    assert_int_equal(count[0], 6 * 128 * 128); // the room is closed
    for (int i = 0; i < W * H; i++) {
        const double want = gather(c[0].bytes, count[0], c[3].texels + 4 * (size_t) i,
                                   c[4].texels + 4 * (size_t) i, disc);
        // Sums of 64, of at most 1536 of those: 1600 roundings, most of which cancel.
        if (fabs((double) c[2].texels[4 * (size_t) i] / want - 1) > 5e-5)
            fail_msg("pixel %d: %.8g, not %.8g", i, (double) c[2].texels[4 * (size_t) i], want);
    }
    image_finish(&img);
    captures_finish(c);
    ag_scene_destroy(scene);
}

// Inside a sphere of albedo rho about a point light of power P every point gets rho P / (4 pi R^2)
// from one bounce.
static void sphere_is_lit_uniformly_by_one_bounce(void **state)
{
    (void) state;
    enum { N = 32 };
    ag_scene *scene = sphere_scene(64, 0.5f);
    const char *const settings[] = { "rsm_size=64", "pattern=all", NULL };
    image img = render_layer(scene, N, N, LAYER_INDIRECT, plugin_rsm(), settings);
    const double want = 0.5 * 0.5 * 4 * pi / (4 * pi) / pi; // albedo / pi x rho P / (4 pi R^2)
    // The disc term takes A_j / (pi d^2 + A_j) of each VPL: of a cap of radius r it is about
    // A_j / 4 ln(4 / A_j) of the whole, A_j = 4 pi / 24576, that is 0.12 %. The faceted
    // sphere's chords add 2 x 2.7e-4, half-float normals of both ends 5e-4.
    for (int i = 0; i < 3 * N * N; i++)
        if (fabs((double) img.rgb[i] / want - 1) > 0.01)
            fail_msg("pixel %d: %g, not %g", i / 3, (double) img.rgb[i], want);
    assert_true(fabs(image_mean(&img) / want - 1) < 0.003);
    image_finish(&img);
    ag_scene_destroy(scene);
}

// ---- what must not change it -------------------------------------------------------------------

static double radiance_mean(double edge, double offset)
{
    const room_desc room = { .edge = edge,
                             .centre = { offset, -offset, offset },
                             .boxes = offset == 0 };
    ag_light light = ceiling_spot(58);
    for (int k = 0; k < 3; k++)
        light.intensity[k] = (float) (edge * edge); // E = I / r^2 stays as it is
    ag_scene *scene = room_scene(&room, &light);
    image img = render_layer(scene, 48, 48, LAYER_INDIRECT, plugin_rsm(), NULL);
    const double mean = image_mean(&img);
    image_finish(&img);
    ag_scene_destroy(scene);
    return mean;
}

static void scale_and_place_do_not_matter(void **state)
{
    (void) state;
    const double want = radiance_mean(1, 0);
    assert_true(want > 0.01);
    for (int e = -4; e <= 4; e++) {
        const double got = radiance_mean(pow(10, e), 0);
        if (fabs(got / want - 1) > 1e-3)
            fail_msg("edge 1e%d m: mean %g, not %g", e, got, want);
    }
    const double near = radiance_mean(1, 0.5), far = radiance_mean(1, 1e6);
    if (fabs(far / near - 1) > 1e-3)
        fail_msg("1e6 m away: mean %g, not %g", far, near);
}

static void same_frame_twice_is_bit_identical(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    image a = render_layer(scene, 65, 33, LAYER_RADIANCE, plugin_rsm(), NULL);
    image b = render_layer(scene, 65, 33, LAYER_RADIANCE, plugin_rsm(), NULL);
    assert_memory_equal(a.rgb, b.rgb, sizeof(float) * 3 * 65 * 33);
    image_finish(&a);
    image_finish(&b);
    ag_scene_destroy(scene);
}

static void any_size_renders_and_a_pixel_does_not_depend_on_it(void **state)
{
    (void) state;
    static const int sizes[][2] = { { 1, 1 }, { 3, 5 }, { 2, 2 }, { 257, 1 }, { 1023, 517 } };
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    const char *const settings[] = { "vpls=64", NULL };
    ag_scene *scene = room_scene(&room, &light);
    image one = { 0 };
    for (int s = 0; s < FG_COUNT(sizes); s++) {
        const int w = sizes[s][0], h = sizes[s][1];
        image img = render_layer(scene, w, h, LAYER_RADIANCE, plugin_rsm(), settings);
        for (int i = 0; i < 3 * w * h; i++)
            assert_true(isfinite(img.rgb[i]) && img.rgb[i] > 0); // every wall is lit
        if (s == 0) {
            one = img;
            continue;
        }
        const float *middle = img.rgb + 3 * ((size_t) (h / 2) * w + w / 2);
        // Odd sizes have a pixel centre in the middle, which looks at the same point: the
        // varyings round differently, 1e-6 of the room.
        if (w % 2 && h % 2)
            assert_true(fabs((double) (middle[0] / one.rgb[0]) - 1) < 1e-3);
        image_finish(&img);
    }
    image_finish(&one);
    ag_scene_destroy(scene);
}

static void receivers_of_one_invocation_do_not_matter(void **state)
{
    (void) state;
    // 45 x 45 is no multiple of the 32 x 32 tile: its last columns are those of the 33 x 45 frame's
    // last tile only if each pixel's sum is its own. Checked against the sums in double.
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    capture c[] = { { .resource = "rsm.vpls" },       { .resource = "rsm.count" },
                    { .resource = "rsm.indirect" },   { .resource = "gbuffer.position" },
                    { .resource = "gbuffer.normal" }, { 0 } };
    const char *const settings[] = { "vpls=16", "clamp=disc", NULL };
    image img = render_captured(scene, 33, 45, LAYER_INDIRECT, settings, c);
    const uint32_t *count = c[1].bytes;
    for (int i = 32; i < 33 * 45; i += 33) {
        const double want = gather(c[0].bytes, count[0], c[3].texels + 4 * (size_t) i,
                                   c[4].texels + 4 * (size_t) i, disc);
        assert_true(fabs((double) c[2].texels[4 * (size_t) i] - want) <= 1e-5 * want + 1e-9);
    }
    image_finish(&img);
    captures_finish(c);
    ag_scene_destroy(scene);
}

// ---- nothing to do ------------------------------------------------------------------------------

static void without_light_there_is_exactly_nothing(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true };
    ag_scene *dark = room_scene(&room, NULL);
    image img = render_layer(dark, 16, 16, LAYER_RADIANCE, plugin_rsm(), NULL);
    for (int i = 0; i < 3 * 16 * 16; i++)
        assert_true(img.rgb[i] == 0);
    image_finish(&img);
    ag_scene_destroy(dark);

    ag_light black = ceiling_spot(58);
    memset(black.intensity, 0, sizeof black.intensity);
    ag_scene *unlit = room_scene(&room, &black);
    capture c[] = { { .resource = "rsm.count" }, { 0 } };
    img = render_captured(unlit, 16, 16, LAYER_INDIRECT, NULL, c);
    assert_int_equal(((const uint32_t *) c[0].bytes)[0], 0);
    for (int i = 0; i < 3 * 16 * 16; i++)
        assert_true(img.rgb[i] == 0);
    image_finish(&img);
    captures_finish(c);
    ag_scene_destroy(unlit);
}

static void light_that_meets_nothing_gives_nothing(void **state)
{
    (void) state;
    static const double p[3] = { -1, -1, -1 }, u[3] = { 0, 0, 2 }, v[3] = { 2, 0, 0 };
    ag_builder *b = ag_builder_create(test_log(), "sky");
    ag_light light = ceiling_spot(40);
    light.direction[1] = 1; // up and away
    add_quad(b, -1, p, u, v);
    ag_builder_light(b, -1, &light);
    ag_scene *scene = finish_scene(b);
    capture c[] = { { .resource = "rsm.count" }, { 0 } };
    image img = render_captured(scene, 16, 16, LAYER_RADIANCE, NULL, c);
    assert_int_equal(((const uint32_t *) c[0].bytes)[0], 0);
    for (int i = 0; i < 3 * 16 * 16; i++)
        assert_true(img.rgb[i] == 0);
    image_finish(&img);
    captures_finish(c);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_hold_the_power_of_the_light),
        cmocka_unit_test(point_light_spends_its_power_on_six_faces),
        cmocka_unit_test(solid_angles_of_a_face_sum_to_its_own),
        cmocka_unit_test(a_map_gives_each_wall_its_share),
        cmocka_unit_test(equal_solid_angles_are_off_by_what_the_paper_says_nothing_of),
        cmocka_unit_test(choosing_fewer_vpls_keeps_the_energy),
        cmocka_unit_test(stratified_vpls_follow_the_seed),
        cmocka_unit_test(gather_is_the_sum_over_its_vpls),
        cmocka_unit_test(every_one_of_98304_vpls_counts),
        cmocka_unit_test(sphere_is_lit_uniformly_by_one_bounce),
        cmocka_unit_test(scale_and_place_do_not_matter),
        cmocka_unit_test(same_frame_twice_is_bit_identical),
        cmocka_unit_test(any_size_renders_and_a_pixel_does_not_depend_on_it),
        cmocka_unit_test(receivers_of_one_invocation_do_not_matter),
        cmocka_unit_test(without_light_there_is_exactly_nothing),
        cmocka_unit_test(light_that_meets_nothing_gives_nothing),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
