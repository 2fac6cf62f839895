// SPDX-License-Identifier: MIT
// VPLs of several lights: the power of their faces, the budget split by it, and energy that does
// not depend on the split.
#include "fixture.h"

#include <math.h>
#include <pass/math.h>
#include <pass/vpl.h>
#include <pass/vpl_shared.h>
#include <stdio.h>
#include <string.h>

// ---- the split ------------------------------------------------------------------------------

static void one_face_gets_the_largest_power_of_four(void **state)
{
    (void) state;
    static const struct {
        int64_t budget;
        int most, grid;
    } cases[] = { { 1, 256, 1 },  { 3, 256, 1 },     { 4, 256, 2 },        { 1000, 256, 16 },
                  { 1024, 8, 8 }, { 1024, 256, 32 }, { 1048576, 256, 256 } };
    for (int i = 0; i < FG_COUNT(cases); i++) {
        const double power = 1e-30;
        int grid = -1;
        const int64_t total = ag_vpl_split(&power, 1, cases[i].budget, cases[i].most, &grid);
        assert_int_equal(grid, cases[i].grid);
        assert_int_equal(total, grid * grid);
    }
}

static void faces_share_by_power(void **state)
{
    (void) state;
    static const struct {
        int64_t budget;
        double power[3];
        int grid[3];
    } cases[] = {
        { 256, { 1, 1, 0 }, { 8, 8, 0 } },      // 16 x 16 and 8 x 8 are beyond it
        { 320, { 1, 1, 0 }, { 16, 8, 0 } },     // of equal ones the first
        { 272, { 1, 16, 0 }, { 4, 16, 0 } },    // as many watts each
        { 256, { 1, 4, 0 }, { 8, 8, 0 } },      // what is left goes to whom it suffices
        { 1024, { 1e-9, 1, 0 }, { 1, 32, 0 } }, // one that takes nothing from the other
        { 1030, { 1, 1, 1e9 }, { 1, 1, 32 } },
        { 2, { 1, 1, 1 }, { 1, 1, 1 } }, // one each, beyond the budget
        { 1024, { 0, 0, 0 }, { 0, 0, 0 } },
    };
    for (int i = 0; i < FG_COUNT(cases); i++) {
        int grid[3];
        int64_t total = 0;
        const int64_t got = ag_vpl_split(cases[i].power, 3, cases[i].budget, 256, grid);
        for (int f = 0; f < 3; f++)
            total += (int64_t) grid[f] * grid[f];
        assert_int_equal(got, total);
        assert_memory_equal(grid, cases[i].grid, sizeof grid);
    }
}

// Faces whose share is below one VPL; they must have one, and those without power none.
static int64_t faint_faces(const double *power, int faces, int64_t budget, const int *grid)
{
    int64_t faint = 0;
    double sum = 0;
    for (int i = 0; i < faces; i++)
        sum += power[i];
    for (int i = 0; i < faces; i++) {
        const bool is_faint = power[i] > 0 && power[i] * (double) budget < sum;
        assert_true(is_faint ? grid[i] == 1 : (grid[i] > 0) == (power[i] > 0));
        faint += is_faint;
    }
    return faint;
}

static void a_split_exceeds_its_budget_by_faint_faces_alone(void **state)
{
    (void) state;
    enum { FACES = 37 };
    double power[FACES];
    int grid[FACES];
    for (int i = 0; i < FACES; i++)
        power[i] = i % 5 ? pow(10, -9.0 * i / FACES) : 0;
    for (int64_t budget = 1; budget <= 1 << 20; budget = 3 * budget / 2 + 1) {
        const int64_t total = ag_vpl_split(power, FACES, budget, 256, grid);
        assert_true(total <= budget + faint_faces(power, FACES, budget, grid));
        // Room for a quarter more is left only by those that have the finest grid.
        assert_true(grid[1] == 256 || total > budget / 4);
    }
}

// ---- the power of a face -----------------------------------------------------------------------

static room_desc white_room(void)
{
    room_desc room = { 0 };
    for (int i = 0; i < 18; i++)
        (&room.albedo[0][0])[i] = 1;
    return room;
}

static double layer_flux(const capture *c, int layer, int channel)
{
    const size_t texels = (size_t) c->width * c->height;
    double sum = 0;
    for (size_t i = 0; i < texels; i++)
        sum += (double) c->texels[4 * (texels * layer + i) + channel];
    return sum;
}

// In a closed white room each map reflects all that goes through its face.
static void expect_face_powers(ag_scene *scene, int faces, double bound)
{
    const char *const settings[] = { "rsm_size=128", NULL };
    capture c[] = { { .resource = "rsm.flux" }, { 0 } };
    image img = render_captured(scene, 4, 4, LAYER_INDIRECT, settings, c);
    ag_gpu_scene *gpu;
    ag_view view;
    const ag_gpu_scene_desc desc = { .log = test_log(), .device = device(), .scene = scene };
    assert_int_equal(ag_gpu_scene_create(&desc, &gpu), FG_OK);
    assert_int_equal(ag_view_from_camera(test_log(), scene->cameras, 4, 4, &view), FG_OK);
    assert_int_equal(ag_gpu_scene_update(gpu, &view), FG_OK);
    assert_int_equal(ag_gpu_scene_face_count(gpu), faces);
    double whole = 0;
    for (int f = 0; f < faces; f++)
        whole += ag_gpu_scene_face_power(gpu, f);
    for (int f = 0; f < faces; f++) {
        const double want = layer_flux(c, f, 0), got = ag_gpu_scene_face_power(gpu, f);
        if (fabs(got - want) > bound * want + 1e-5 * whole)
            fail_msg("face %d of %d: %.6f W, not %.6f W", f, faces, got, want);
        assert_int_equal(got > 0, want > 0);
    }
    ag_gpu_scene_destroy(gpu);
    image_finish(&img);
    captures_finish(c);
    ag_scene_destroy(scene);
}

static void a_face_has_the_power_that_its_map_gets(void **state)
{
    (void) state;
    const room_desc room = white_room();
    static const struct {
        float outer;
        int faces;
    } spots[] = { { 2, 1 }, { 35, 1 }, { 58, 1 }, { 62, 5 }, { 80, 5 }, { 100, 6 }, { 150, 6 } };
    for (int i = 0; i < FG_COUNT(spots); i++) {
        ag_light light = ceiling_spot(spots[i].outer);
        light.position[1] = 0.2;
        // A ramp narrower than 1e-3 is widened alike. The map's texels sample the ramp 128 times
        // across; and the quadrature here: 1e-3 each.
        expect_face_powers(room_scene(&room, &light), spots[i].faces, 2e-3);
    }
    ag_light cosine = ceiling_spot(90);
    cosine.cosine = true;
    expect_face_powers(room_scene(&room, &cosine), 5, 2e-3);
    ag_light point = ceiling_spot(90);
    point.kind = AG_LIGHT_POINT;
    expect_face_powers(room_scene(&room, &point), 6, 2e-3);
    // Straight down on the room's lid; the face's margin is 1e-3 and 1e-4 of the diagonal twice
    // over.
    ag_light sun = ceiling_spot(90);
    sun.kind = AG_LIGHT_DIRECTIONAL;
    expect_face_powers(room_scene(&room, &sun), 1, 2e-2);
}

// ---- energy ----------------------------------------------------------------------------------

enum { MOST_LIGHTS = 5 };

// Lights of quite different kinds, each of them of one colour, and each channel of one magnitude.
static ag_scene *lights_scene(int count, double ratio)
{
    const room_desc room = { .boxes = true };
    ag_builder *b = room_builder(&room);
    for (int i = 0; i < count; i++) {
        static const float angles[MOST_LIGHTS] = { 58, 80, 40, 90, 90 };
        ag_light light = ceiling_spot(angles[i]);
        snprintf(light.name, sizeof light.name, "light %d", i);
        light.position[0] = 0.1 * i - 0.2;
        light.position[1] = 0.4 - 0.1 * i;
        light.kind = i == 3 ? AG_LIGHT_POINT : AG_LIGHT_SPOT;
        light.cosine = i == 4;
        for (int c = 0; c < 3; c++)
            light.intensity[c] = c == i % 3 ? (float) pow(ratio, -0.5 * (i % 3)) : 0;
        ag_builder_light(b, -1, &light);
    }
    return finish_scene(b);
}

static void expect_energy(ag_scene *scene, const char *const *settings, int budget, int faces)
{
    capture c[] = {
        { .resource = "rsm.flux" }, { .resource = "rsm.vpls" }, { .resource = "rsm.count" }, { 0 }
    };
    image img = render_captured(scene, 4, 4, LAYER_INDIRECT, settings, c);
    const ag_vpl *v = c[1].bytes;
    const uint32_t *count = c[2].bytes;
    assert_true(count[1] <= (uint32_t) (budget + faces));
    assert_true(count[0] <= count[1]);
    for (int channel = 0; channel < 3; channel++) {
        double want = 0, got = 0;
        for (int layer = 0; layer < c[0].layers; layer++)
            want += layer_flux(c, layer, channel);
        for (uint32_t i = 0; i < count[0]; i++)
            got += (double) v[i].flux[channel];
        if (fabs(got - want) > 1e-4 * want) // sums of floats: each 65536 roundings at most
            fail_msg("%s, channel %d: %.7g W of %.7g W", settings[0], channel, got, want);
    }
    image_finish(&img);
    captures_finish(c);
}

static void energy_does_not_depend_on_the_split(void **state)
{
    (void) state;
    static const int counts[] = { 1, 2, 5 }, faces[] = { 1, 6, 18 };
    static const double ratios[] = { 1, 1e4, 1e9 };
    static const int budgets[] = { 1, 17, 256, 5000 };
    for (int i = 0; i < FG_COUNT(counts) * FG_COUNT(ratios); i++) {
        ag_scene *scene = lights_scene(counts[i % 3], ratios[i / 3]);
        for (int k = 0; k < FG_COUNT(budgets); k++) {
            char vpls[32];
            snprintf(vpls, sizeof vpls, "vpls=%d", budgets[k]);
            const char *const settings[] = { vpls, "rsm_size=64", NULL };
            expect_energy(scene, settings, budgets[k], faces[i % 3]);
        }
        ag_scene_destroy(scene);
    }
}

static void several_lights_twice_are_bit_identical(void **state)
{
    (void) state;
    ag_scene *scene = lights_scene(5, 1e3);
    const char *const settings[] = { "vpls=700", "pattern=stratified", NULL };
    capture a[] = { { .resource = "rsm.vpls" }, { .resource = "rsm.count" }, { 0 } };
    capture b[] = { { .resource = "rsm.vpls" }, { .resource = "rsm.count" }, { 0 } };
    image first = render_captured(scene, 16, 16, LAYER_INDIRECT, settings, a);
    image second = render_captured(scene, 16, 16, LAYER_INDIRECT, settings, b);
    const uint32_t *count = a[1].bytes;
    assert_memory_equal(a[1].bytes, b[1].bytes, 8);
    assert_memory_equal(a[0].bytes, b[0].bytes, count[0] * sizeof(ag_vpl));
    assert_memory_equal(first.rgb, second.rgb, sizeof(float) * 3 * 16 * 16);
    image_finish(&first);
    image_finish(&second);
    captures_finish(a);
    captures_finish(b);
    ag_scene_destroy(scene);
}

// ---- pictures ----------------------------------------------------------------------------------

static ag_scene *same_spots(int count, float intensity, bool dark_one)
{
    const room_desc room = { .boxes = true };
    ag_builder *b = room_builder(&room);
    for (int i = 0; i < count + dark_one; i++) {
        ag_light light = ceiling_spot(58);
        snprintf(light.name, sizeof light.name, "light %d", i);
        if (i == 0 && dark_one)
            light.kind = AG_LIGHT_POINT;
        for (int c = 0; c < 3; c++)
            light.intensity[c] = i == 0 && dark_one ? 0 : intensity;
        ag_builder_light(b, -1, &light);
    }
    return finish_scene(b);
}

static image indirect_of(ag_scene *scene, const char *vpls)
{
    const char *const settings[] = { vpls, NULL };
    image img = render_layer(scene, 32, 32, LAYER_INDIRECT, plugin_rsm(), settings);
    ag_scene_destroy(scene);
    return img;
}

// Two halves in one place with twice the budget have the whole light's VPLs, each twice at half the
// flux: the sums differ in rounding only. With the whole light's own budget each half gets a
// quarter of its VPLs, and the picture is that of so many.
static void a_light_in_two_halves_gives_the_same_picture(void **state)
{
    (void) state;
    image whole = indirect_of(same_spots(1, 1, false), "vpls=4096");
    image halves = indirect_of(same_spots(2, 0.5f, false), "vpls=8192");
    image coarse = indirect_of(same_spots(2, 0.5f, false), "vpls=4096");
    image quarter = indirect_of(same_spots(1, 1, false), "vpls=1024");
    for (int i = 0; i < 3 * 32 * 32; i++) {
        assert_true(fabsf(halves.rgb[i] - whole.rgb[i]) <= 1e-5f * whole.rgb[i]);
        assert_true(fabsf(coarse.rgb[i] - quarter.rgb[i]) <= 1e-5f * quarter.rgb[i]);
    }
    // 1024 VPLs lose 1 % of the light to corners, as README.md of rsm has it for 32 texels.
    assert_true(fabs(image_mean(&coarse) / image_mean(&whole) - 1) < 0.02);
    image_finish(&whole);
    image_finish(&halves);
    image_finish(&coarse);
    image_finish(&quarter);
}

static void dark_lights_take_nothing_from_the_others(void **state)
{
    (void) state;
    static const char *const settings[] = { "vpls=256", NULL };
    ag_scene *scenes[2] = { same_spots(1, 1, false), same_spots(1, 1, true) };
    capture c[2][3] = { { { .resource = "rsm.vpls" }, { .resource = "rsm.count" } },
                        { { .resource = "rsm.vpls" }, { .resource = "rsm.count" } } };
    for (int i = 0; i < 2; i++) {
        image img = render_captured(scenes[i], 8, 8, LAYER_INDIRECT, settings, c[i]);
        image_finish(&img);
    }
    const uint32_t *count = c[0][1].bytes;
    assert_int_equal(count[1], 256);
    assert_memory_equal(c[0][1].bytes, c[1][1].bytes, 8);
    assert_memory_equal(c[0][0].bytes, c[1][0].bytes, count[0] * sizeof(ag_vpl));
    for (int i = 0; i < 2; i++) {
        captures_finish(c[i]);
        ag_scene_destroy(scenes[i]);
    }
}

// The split follows the lights from frame to frame, though the graph is declared once.
static void a_light_switched_on_shines(void **state)
{
    (void) state;
    ag_scene *scene = same_spots(1, 0, false);
    const renderer_desc desc = {
        .log = test_log(),
        .device = device(),
        .scene = scene,
        .width = 16,
        .height = 16,
        .plugin = plugin_rsm(),
        .layers = 1u << LAYER_INDIRECT,
        .strict = true,
    };
    renderer *r = NULL;
    image img = { 0 };
    assert_int_equal(renderer_create(&desc, &r), FG_OK);
    for (int on = 0; on < 2; on++) {
        ag_light light = scene->lights[0];
        light.intensity[0] = light.intensity[1] = light.intensity[2] = (float) on;
        assert_int_equal(ag_scene_add_light(scene, &light), FG_OK);
        assert_int_equal(renderer_frame(r, 0), FG_OK);
        assert_int_equal(renderer_read(r, LAYER_INDIRECT, &img), FG_OK);
        for (int i = 0; i < 3 * 16 * 16; i++)
            assert_int_equal(img.rgb[i] > 0, on);
        image_finish(&img);
    }
    renderer_destroy(r);
    ag_scene_destroy(scene);
}

// ---- to look at --------------------------------------------------------------------------------

enum { DOTS_EDGE = 64 };

// The rgb of the vpls layer where a VPL is on the screen; NULL: beyond it.
static const float *at_vpl(const image *img, const ag_view *view, const ag_vpl *v)
{
    double clip[4];
    for (int r = 0; r < 4; r++) {
        clip[r] = (double) view->view_proj[12 + r];
        for (int c = 0; c < 3; c++)
            clip[r] += (double) view->view_proj[4 * c + r] * (double) v->position_area[c];
    }
    const double x = (0.5 + 0.5 * clip[0] / clip[3]) * DOTS_EDGE;
    const double y = (0.5 - 0.5 * clip[1] / clip[3]) * DOTS_EDGE; // from the top down
    if (clip[3] <= 0 || x < 0 || y < 0 || x >= DOTS_EDGE || y >= DOTS_EDGE)
        return NULL;
    return img->rgb + 3 * ((size_t) y * DOTS_EDGE + (size_t) x);
}

// How many VPLs are in view, each of which must show as a dot or as none; `dots` is 1 or 0.
static int expect_dots(ag_scene *scene, float dots)
{
    const char *const settings[] = { "vpls=64", NULL };
    capture c[] = { { .resource = "rsm.vpls" }, { .resource = "rsm.count" }, { 0 } };
    image img =
        render_captured(scene, DOTS_EDGE, DOTS_EDGE, (renderer_layer) LAYER_PLUGIN, settings, c);
    const uint32_t count = *(const uint32_t *) c[1].bytes;
    ag_view view;
    int seen = 0;
    assert_int_equal(ag_view_from_camera(test_log(), scene->cameras, DOTS_EDGE, DOTS_EDGE, &view),
                     FG_OK);
    for (uint32_t i = 0; i < count; i++) {
        const float *rgb = at_vpl(&img, &view, (const ag_vpl *) c[0].bytes + i);
        for (int k = 0; rgb && k < 3; k++)
            assert_true(rgb[k] == dots);
        seen += rgb != NULL;
    }
    image_finish(&img);
    captures_finish(c);
    ag_scene_destroy(scene);
    return seen;
}

// White walls, which make white VPLs, and no direct light where a board stands before the camera.
static void vpls_are_seen_where_nothing_hides_them(void **state)
{
    (void) state;
    static const double p[3] = { -0.4, -0.4, 0.4 }, u[3] = { 0, 0.8, 0 }, v[3] = { 0.8, 0, 0 };
    const room_desc room = white_room();
    for (int board = 0; board < 2; board++) {
        ag_builder *b = room_builder(&room);
        const ag_light light = ceiling_spot(58);
        ag_builder_light(b, -1, &light);
        if (board)
            add_quad(b, -1, p, u, v);
        assert_in_range(expect_dots(finish_scene(b), board ? 0 : 1), 20, 64);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_face_gets_the_largest_power_of_four),
        cmocka_unit_test(faces_share_by_power),
        cmocka_unit_test(a_split_exceeds_its_budget_by_faint_faces_alone),
        cmocka_unit_test(a_face_has_the_power_that_its_map_gets),
        cmocka_unit_test(energy_does_not_depend_on_the_split),
        cmocka_unit_test(several_lights_twice_are_bit_identical),
        cmocka_unit_test(a_light_in_two_halves_gives_the_same_picture),
        cmocka_unit_test(dark_lights_take_nothing_from_the_others),
        cmocka_unit_test(a_light_switched_on_shines),
        cmocka_unit_test(vpls_are_seen_where_nothing_hides_them),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
