// SPDX-License-Identifier: MIT
// Incremental instant radiosity as a whole: against a closed form, from frame to frame, and with
// things that move. Its parts have tests of their own.
#include "fixture.h"
#include "metrics.h"

#include <gi/registry.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- frames in a row --------------------------------------------------------------------------

enum { EDGE = 48, MAX_FRAMES = 24 };

// The lamp of frame i; NULL: as the scene has it.
typedef void (*move_fn)(int frame, ag_light *lamp);

typedef struct film {
    image frames[MAX_FRAMES]; // indirect light
    double fresh[MAX_FRAMES], drawn[MAX_FRAMES], invalid[MAX_FRAMES], vpls[MAX_FRAMES];
    int count;
} film;

static double counter(renderer *r, const char *name)
{
    gi_counter counters[32];
    const int count = renderer_counters(r, counters, FG_COUNT(counters));
    for (int i = 0; i < count && i < FG_COUNT(counters); i++)
        if (!strcmp(counters[i].name, name))
            return counters[i].value;
    fail_msg("there is no counter %s", name);
    return 0;
}

static void note(film *f, renderer *r)
{
    const int i = f->count++;
    assert_int_equal(renderer_read(r, LAYER_INDIRECT, &f->frames[i]), FG_OK);
    f->fresh[i] = counter(r, "new_vpls");
    f->drawn[i] = counter(r, "shadow_maps");
    f->invalid[i] = counter(r, "invalid");
    f->vpls[i] = counter(r, "vpls");
}

static film shoot(ag_scene *scene, const char *const *settings, int frames, move_fn move,
                  double seconds)
{
    film f = { 0 };
    gi_value values[64];
    renderer *r;
    const gi_plugin *plugin = plugin_named("iir");
    const ag_light lamp = scene->lights[0];
    gi_params_default(plugin, values);
    for (int i = 0; settings[i]; i++)
        assert_int_equal(gi_params_set(test_log(), plugin, values, settings[i]), FG_OK);
    const renderer_desc desc = { .log = test_log(),
                                 .device = device(),
                                 .scene = scene,
                                 .width = EDGE,
                                 .height = EDGE,
                                 .plugin = plugin,
                                 .values = values,
                                 .layers = 1u << LAYER_INDIRECT,
                                 .strict = true };
    assert_int_equal(renderer_create(&desc, &r), FG_OK);
    for (int i = 0; i < frames; i++) {
        ag_light at = lamp;
        if (move) {
            move(i, &at);
            assert_int_equal(ag_scene_add_light(scene, &at), FG_OK);
        }
        assert_int_equal(renderer_frame(r, i * seconds), FG_OK);
        note(&f, r);
    }
    renderer_destroy(r);
    if (move)
        assert_int_equal(ag_scene_add_light(scene, &lamp), FG_OK);
    return f;
}

static void film_finish(film *f)
{
    for (int i = 0; i < f->count; i++)
        image_finish(&f->frames[i]);
}

static bool same_frames(const image *a, const image *b)
{
    return same_bits(a->rgb, b->rgb, sizeof(float) * 3 * EDGE * EDGE);
}

static void sideways(int frame, ag_light *lamp)
{
    lamp->position[0] += 0.01 * frame;
}

static void then_still(int frame, ag_light *lamp)
{
    sideways(frame < 10 ? frame : 10, lamp);
}

static ag_scene *furnished_room(void)
{
    static const room_desc room = { .boxes = true };
    ag_light lamp = ceiling_spot(70);
    snprintf(lamp.name, sizeof lamp.name, "lamp");
    return room_scene(&room, &lamp);
}

// ---- against closed forms -----------------------------------------------------------------------

// A light of power P in the middle of a sphere of radius 1: irradiance of one bounce is
// rho P / (4 pi) everywhere, and so E / pi = rho I / pi with P = 4 pi I. There a point light's
// cos_i cos_j / (pi d^2) is 1 / (4 pi) at any distance, exactly. Of 256 VPLs' patches, as large as
// pi / 64, a pixel sees those within 2 sqrt(A_j) as flat: 1.6 % of the light, of which it may miss
// all.
static void light_within_a_sphere_is_uniform(void **state)
{
    static const char *const settings[] = { "tiles=1", NULL };
    static const char *const interleaved[] = { "tiles=4", NULL };
    (void) state;
    const double rho = 0.5,
                 want = rho * rho / 3.14159265358979; // the layer has the albedo once more
    ag_scene *scene = sphere_scene(64, (float) rho);
    for (int i = 0; i < 2; i++) {
        const image img = render_layer(scene, EDGE, EDGE, LAYER_INDIRECT, plugin_named("iir"),
                                       i ? interleaved : settings);
        assert_true(fabs(image_mean(&img) / want - 1) < 0.02);
        for (int k = 0; k < 3 * EDGE * EDGE; k++)
            assert_true(fabs((double) img.rgb[k] / want - 1) < 0.15);
        image_finish((image *) &img);
    }
    ag_scene_destroy(scene);
}

// Two rooms without a door. What is lit is in the one, the camera in the other.
static void no_light_goes_through_a_wall(void **state)
{
    static const char *const with[] = { "max_lights=64", NULL };
    static const char *const without[] = { "max_lights=64", "visibility=none", NULL };
    static const room_desc room = { 0 };
    static const double p[3] = { -0.5, -0.5, -0.3 }, u[3] = { 1, 0, 0 }, v[3] = { 0, 1, 0 };
    (void) state;
    ag_builder *b = room_builder(&room);
    ag_material grey = ag_default_material();
    add_quad(b, ag_builder_material(b, &grey), p, u, v);
    ag_light lamp = ag_default_light(); // beyond the wall
    lamp.position[2] = -0.4;
    lamp.position[1] = 0.2;
    ag_builder_light(b, -1, &lamp);
    ag_scene *scene = finish_scene(b);
    image img = render_layer(scene, EDGE, EDGE, LAYER_INDIRECT, plugin_named("iir"), with);
    image open = render_layer(scene, EDGE, EDGE, LAYER_INDIRECT, plugin_named("iir"), without);
    assert_true(image_mean(&open) > 0.01); // floor, ceiling and walls of the camera's room
    // Within a texel of a map, a degree, of the wall's rim a VPL and a pixel on the same surface
    // see each other: a band of 1 / 50 of those surfaces, and of it VPLs as near, 1 / 10 or so.
    assert_true(image_mean(&img) < 0.005 * image_mean(&open));
    image_finish(&img);
    image_finish(&open);
    ag_scene_destroy(scene);
}

// ---- from frame to frame
// -------------------------------------------------------------------------

static void a_light_that_rests_does_not_flicker(void **state)
{
    static const char *const settings[] = { "max_lights=64", NULL };
    (void) state;
    ag_scene *scene = furnished_room();
    film still = shoot(scene, settings, 4, NULL, 0),
         moved = shoot(scene, settings, 24, then_still, 0);
    for (int i = 1; i < still.count; i++)
        assert_true(same_frames(&still.frames[0], &still.frames[i]));
    assert_false(same_frames(&moved.frames[9], &moved.frames[10]));
    for (int i = 21; i < moved.count; i++)
        assert_true(same_frames(&moved.frames[20], &moved.frames[i]));
    film_finish(&still);
    film_finish(&moved);
    ag_scene_destroy(scene);
}

static void no_frame_draws_more_maps_than_its_budget(void **state)
{
    static const char *const settings[] = { "max_lights=64", "recalc_min=2", "recalc_max=5", NULL };
    static const char *const slow[] = { "max_lights=64", "recalc_max=5", "first=budget", NULL };
    (void) state;
    ag_scene *scene = furnished_room();
    film f = shoot(scene, settings, 16, sideways, 0), g = shoot(scene, slow, 16, sideways, 0);
    int drawn = 0;
    for (int i = 1; i < f.count; i++) {
        assert_true(f.drawn[i] <= 5);
        drawn += f.drawn[i] > 0;
    }
    assert_true(f.drawn[0] > 32); // all at once
    assert_true(drawn >= 10);     // the light moves, and its VPLs follow
    for (int i = 0; i < g.count; i++)
        assert_true(g.drawn[i] <= 5);
    assert_true(g.vpls[15] > g.vpls[5] && g.vpls[5] > g.vpls[0]);
    film_finish(&f);
    film_finish(&g);
    ag_scene_destroy(scene);
}

// Sec. 6: the thread beside the frame costs it the light's last step, and nothing else.
static void with_a_delay_a_frame_is_lit_as_the_one_before(void **state)
{
    static const char *const at_once[] = { "max_lights=64", "delay=0", NULL };
    static const char *const late[] = { "max_lights=64", "delay=1", NULL };
    (void) state;
    ag_scene *scene = furnished_room();
    film a = shoot(scene, at_once, 12, sideways, 0), b = shoot(scene, late, 12, sideways, 0);
    assert_true(same_frames(&a.frames[0], &b.frames[0]));
    for (int i = 1; i < b.count; i++) {
        assert_true(same_frames(&a.frames[i - 1], &b.frames[i]));
        assert_false(same_frames(&a.frames[i], &b.frames[i]));
    }
    film_finish(&a);
    film_finish(&b);
    ag_scene_destroy(scene);
}

static void anew_is_incremental_with_all_recomputed(void **state)
{
    static const char *const all[] = { "max_lights=48", "recalc_min=48", "recalc_max=48",
                                       "settle=0",      "delay=0",       NULL };
    static const char *const anew[] = { "max_lights=48", "mode=anew", "delay=0", NULL };
    (void) state;
    ag_scene *scene = furnished_room();
    film a = shoot(scene, all, 5, sideways, 0), b = shoot(scene, anew, 5, sideways, 0);
    for (int i = 0; i < a.count; i++)
        assert_true(same_frames(&a.frames[i], &b.frames[i]));
    assert_true(b.drawn[4] > 24);
    film_finish(&a);
    film_finish(&b);
    ag_scene_destroy(scene);
}

// ---- what moves
// ----------------------------------------------------------------------------------

// A board that passes between the lamp and the floor.
static ag_scene *room_with_a_moving_board(void)
{
    static const float times[] = { 0, 1 }, places[] = { -0.3f, -0.25f, 0, 0.3f, -0.25f, 0 };
    static const room_desc room = { 0 };
    ag_vertex v[4];
    memset(v, 0, sizeof v);
    for (int i = 0; i < 4; i++) {
        v[i].position[0] = i % 2 ? 0.12f : -0.12f;
        v[i].position[2] = i / 2 ? 0.12f : -0.12f;
        for (int k = 0; k < 4; k++)
            v[i].color[k] = 1;
    }
    static const uint32_t order[] = { 0, 2, 1, 1, 2, 3 };
    const ag_primitive_desc board = {
        .name = "board",
        .vertices = v,
        .vertex_count = 4,
        .indices = order,
        .index_count = 6,
        .material = -1,
    };
    ag_builder *b = room_builder(&room);
    ag_light lamp = ceiling_spot(70);
    snprintf(lamp.name, sizeof lamp.name, "lamp");
    ag_builder_light(b, -1, &lamp);
    const int node = ag_builder_node(b, &(ag_node_desc){ .name = "board", .parent = -1 });
    ag_builder_show(b, node, ag_builder_primitive(b, &board), -1);
    const ag_channel_desc path = { .node = node, .key_count = 2, .times = times, .values = places };
    ag_builder_channel(b, &path);
    return finish_scene(b);
}

// Sec. 2, 4.4: it is lit from below, and neither takes a VPL away nor makes one; with it or
// without, what is not hidden by it from the camera has the same light.
static void moving_things_are_lit_and_change_no_vpl(void **state)
{
    static const char *const settings[] = { "max_lights=64", "tiles=1", NULL };
    static const room_desc room = { 0 };
    (void) state;
    ag_light lamp = ceiling_spot(70);
    snprintf(lamp.name, sizeof lamp.name, "lamp");
    ag_scene *with = room_with_a_moving_board(), *without = room_scene(&room, &lamp);
    film a = shoot(with, settings, 4, NULL, 0.2), b = shoot(without, settings, 1, NULL, 0);
    int same = 0, on_board = 0;
    for (int i = 0; i < a.count; i++)
        assert_true(a.invalid[i] == 0 && a.vpls[i] == b.vpls[0]);
    for (int i = 0; i < EDGE * EDGE; i++) {
        const float *p = a.frames[2].rgb + 3 * (size_t) i, *q = b.frames[0].rgb + 3 * (size_t) i;
        same += same_bits(p, q, 3 * sizeof *p);
        // The board is white, the room grey.
        on_board += !same_bits(p, q, 3 * sizeof *p) && p[0] > 0;
    }
    assert_true(same > EDGE * EDGE * 9 / 10);
    assert_true(on_board > 4);
    film_finish(&a);
    film_finish(&b);
    ag_scene_destroy(with);
    ag_scene_destroy(without);
}

// ---- the image
// -------------------------------------------------------------------------------------

// The mean over a block of n x n pixels is the sum of all VPLs, but for how the light changes
// within the block. At the foot of walls, a tenth of the picture, it changes by up to a fifth from
// pixel to pixel: of the whole about 2 % a pixel, measured 1.6 % n and less.
static void tiles_change_little(void **state)
{
    static const char *const one[] = { "tiles=1", NULL };
    static const char *const many[][2] = { { "tiles=2" }, { "tiles=4" }, { "tiles=8" } };
    (void) state;
    static const room_desc room = { 0 };
    ag_light lamp = ceiling_spot(70);
    ag_scene *scene = room_scene(&room, &lamp);
    image want = render_layer(scene, 4 * EDGE, 4 * EDGE, LAYER_INDIRECT, plugin_named("iir"), one);
    for (int i = 0; i < FG_COUNT(many); i++) {
        metrics m;
        image img =
            render_layer(scene, 4 * EDGE, 4 * EDGE, LAYER_INDIRECT, plugin_named("iir"), many[i]);
        assert_int_equal(metrics_compare(test_log(), &img, &want, &m), FG_OK);
        assert_int_equal(m.nonfinite, 0);
        assert_true(m.rmse_rms < 0.02 * (2 << i));

        assert_true(fabs(m.energy_ratio - 1) < 0.01);
        image_finish(&img);
    }
    image_finish(&want);
    ag_scene_destroy(scene);
}

static void layers_show_something(void **state)
{
    static const char *const settings[] = { "max_lights=64", NULL };
    (void) state;
    ag_scene *scene = furnished_room();
    const gi_plugin *plugin = plugin_named("iir");
    assert_int_equal(gi_layers_count(plugin), 3);
    for (int i = 0; i < 3; i++) {
        image img =
            render_layer(scene, EDGE, EDGE, (renderer_layer) (LAYER_PLUGIN + i), plugin, settings);
        assert_true(image_mean(&img) > 0.01);
        assert_true(image_mean(&img) < 1);
        image_finish(&img);
    }
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_within_a_sphere_is_uniform),
        cmocka_unit_test(no_light_goes_through_a_wall),
        cmocka_unit_test(a_light_that_rests_does_not_flicker),
        cmocka_unit_test(no_frame_draws_more_maps_than_its_budget),
        cmocka_unit_test(with_a_delay_a_frame_is_lit_as_the_one_before),
        cmocka_unit_test(anew_is_incremental_with_all_recomputed),
        cmocka_unit_test(moving_things_are_lit_and_change_no_vpl),
        cmocka_unit_test(tiles_change_little),
        cmocka_unit_test(layers_show_something),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
