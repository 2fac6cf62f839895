// SPDX-License-Identifier: MIT
// Corners: a wall that stands on a lit floor, seen from so near that pixels lie far below a texel
// of the reflective shadow map from the corner.
#include "fixture.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979;

// A floor of albedo 1 from z = 0 to 2 m under a sun of 1 W/m^2 straight down, and a wall at z = 0.
static ag_scene *corner_scene(void)
{
    static const double floor_at[3] = { -1, 0, 0 }, along_z[3] = { 0, 0, 2 },
                        along_x[3] = { 2, 0, 0 };
    static const double wall_at[3] = { -1, 0, 0 }, up[3] = { 0, 1, 0 };
    ag_builder *b = ag_builder_create(test_log(), "corner");
    ag_material white = ag_default_material();
    white.metallic = 0;
    const int material = ag_builder_material(b, &white);
    add_quad(b, material, floor_at, along_z, along_x);
    add_quad(b, material, wall_at, along_x, up);
    const ag_light sun = { .kind = AG_LIGHT_DIRECTIONAL,
                           .direction = { 0, -1, 0 },
                           .intensity = { 1, 1, 1 } };
    // 0.14 m of wall from the corner up, off the middle of the map's texels.
    ag_camera camera = { .yfov = 0.28f, .znear = 0.01f, .world = { [0] = 1, [5] = 1, [10] = 1 } };
    camera.world[12] = 0.013;
    camera.world[13] = 0.0701;
    camera.world[14] = 0.5;
    camera.world[15] = 1;
    ag_builder_light(b, -1, &sun);
    ag_builder_camera(b, -1, &camera);
    return finish_scene(b);
}

// Form factor from a point of the wall to the floor, by quadrature over the floor's columns; along
// x it is integrated in closed form.
static double truth(double x, double y)
{
    enum { STEPS = 20000 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        // Cubed steps: they are fine where the integrand is steep.
        const double t0 = 2 * pow((double) i / STEPS, 3), t1 = 2 * pow((i + 1.0) / STEPS, 3);
        const double z = 0.5 * (t0 + t1), a2 = y * y + z * z, a = sqrt(a2);
        double f = 0; // integral of dx / (dx^2 + a^2)^2
        for (int side = 0; side < 2; side++) {
            const double w = side ? 1 - x : 1 + x;
            f += w / (2 * a2 * (a2 + w * w)) + atan(w / a) / (2 * a2 * a);
        }
        sum += y * z * f * (t1 - t0) / pi;
    }
    return sum;
}

// Lowest and highest ratio to the truth among pixels between two heights.
static void ratios(const char *clamp, double from, double to, double range[2])
{
    enum { W = 9, H = 96, MAP = 64 };
    const char *const settings[] = { "rsm_size=64", "pattern=all", clamp, NULL };
    const double texel = 2.0 / MAP; // or more: the map covers the scene's box
    ag_scene *scene = corner_scene();
    capture c[] = { { .resource = "rsm.indirect" }, { .resource = "gbuffer.position" }, { 0 } };
    image img = render_captured(scene, W, H, LAYER_INDIRECT, settings, c);
    range[0] = (double) INFINITY;
    range[1] = 0;
    for (int i = 0; i < W * H; i++) {
        const float *p = c[1].texels + 4 * (size_t) i;
        const double x = (double) p[0] + 0.013, y = (double) p[1] + 0.0701;
        if (p[3] < 0.5f || fabs((double) p[2] + 0.5) > 1e-4 || y < from * texel || y > to * texel)
            continue;
        // B = 1 W/m^2 of the floor; the plugin gives E / pi.
        const double ratio = (double) c[0].texels[4 * (size_t) i] * pi / truth(x, y);
        range[0] = fmin(range[0], ratio);
        range[1] = fmax(range[1], ratio);
    }
    image_finish(&img);
    captures_finish(c);
    ag_scene_destroy(scene);
}

static void wall_is_lit_down_to_the_floor(void **state)
{
    (void) state;
    double range[2];
    // The texel at the corner may be the wall's: then the floor's patches begin up to a texel from
    // it, and a strip of width g seen from height h takes 1 - h / sqrt(h^2 + g^2) of the light.
    // Held at half a texel the worst is 1 / sqrt(5), and h = 4 texels loses 3 %. A patch that
    // reaches behind the wall is cut off, so nothing is gained but the rounding of half texels.
    ratios("clamp=footprint", 0, 4, range);
    assert_true(range[0] > 0.447 && range[1] < 1.05);
    ratios("clamp=footprint", 4, 5, range);
    assert_true(range[0] > 0.95 && range[1] < 1.03);
}

static void disc_leaves_the_corner_dark(void **state)
{
    (void) state;
    double range[2];
    // What the patch is for: within a tenth of a texel next to nothing arrives.
    ratios("clamp=disc", 0, 0.1, range);
    assert_true(range[0] < 0.25);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wall_is_lit_down_to_the_floor),
        cmocka_unit_test(disc_leaves_the_corner_dark),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
