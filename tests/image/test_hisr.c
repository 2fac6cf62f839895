// SPDX-License-Identifier: MIT
// The hisr plugin: energy and means of its tree, its gather against that of all texels, and what
// must not change it.
#include "fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plugins/hisr/hisr_shared.h"

// Every pixel is lit, as plugin rsm does it.
#define EVERY_PIXEL "depth=0", "normal=0", "share=0"

static const room_desc boxes = {
    .boxes = true,
    .albedo = { { 0.7f, 0.1f, 0.1f },
                { 0.2f, 0.6f, 0.1f },
                { 0.5f, 0.5f, 0.5f },
                { 0.6f, 0.6f, 0.6f },
                { 0.4f, 0.4f, 0.5f },
                { 0.3f, 0.3f, 0.3f } },
};

static ag_scene *boxes_scene(void)
{
    const ag_light light = ceiling_spot(58);
    return room_scene(&boxes, &light);
}

// A spot, a point light and a sun that comes in through no wall: eight faces.
static ag_scene *three_lights(void)
{
    ag_builder *b = room_builder(&boxes);
    const ag_light spot = ceiling_spot(58);
    const ag_light point = { .position = { 0.2, 0.1, 0.3 }, .intensity = { 0.1f, 0.2f, 0.3f } };
    const ag_light sun = { .kind = AG_LIGHT_DIRECTIONAL,
                           .direction = { 0.36f, -0.8f, 0.48f },
                           .intensity = { 0.2f, 0.2f, 0.1f } };
    ag_builder_light(b, -1, &spot);
    ag_builder_light(b, -1, &point);
    ag_builder_light(b, -1, &sun);
    return finish_scene(b);
}

static image render_as(ag_scene *scene, const char *plugin, int edge, const char *const *settings)
{
    const shot s = { scene, edge, edge, LAYER_INDIRECT, plugin_named(plugin), settings, NULL };
    return shot_take(&s);
}

static double rms(const image *img)
{
    const size_t count = (size_t) 3 * img->width * img->height;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (double) img->rgb[i] * (double) img->rgb[i];
    return sqrt(sum / (double) count);
}

// Root mean square of the difference over that of `b`.
static double relative_rmse(const image *a, const image *b)
{
    const size_t count = (size_t) 3 * a->width * a->height;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += pow((double) a->rgb[i] - (double) b->rgb[i], 2);
    return sqrt(sum / (double) count) / rms(b);
}

static void expect_finite(const image *img)
{
    for (int i = 0; i < 3 * img->width * img->height; i++)
        assert_true(isfinite(img->rgb[i]) && img->rgb[i] >= 0);
}

// ---- tree -----------------------------------------------------------------------------------

typedef struct tree {
    capture c[4];
    const hisr_node *nodes;
    int roots, levels; // of all faces; the last is the map's texels
} tree;

static tree capture_tree(ag_scene *scene, const char *size)
{
    const char *const settings[] = { size, NULL };
    tree t = { .c = { { .resource = "hisr.nodes" },
                      { .resource = "hisr.flux" },
                      { .resource = "hisr.position" },
                      { 0 } } };
    const shot s = { scene, 4, 4, LAYER_INDIRECT, plugin_named("hisr"), settings, t.c };
    image img = shot_take(&s);
    image_finish(&img);
    const int map = t.c[1].width, edge = map < HISR_ROOTS ? map : HISR_ROOTS;
    t.nodes = t.c[0].bytes;
    t.roots = edge * edge * t.c[1].layers;
    for (t.levels = 1; edge << (t.levels - 1) < map;)
        t.levels++;
    assert_int_equal(t.c[0].size, sizeof(hisr_node) * (size_t) HISR_LEVEL_START(t.roots, t.levels));
    return t;
}

static const hisr_node *node_of(const tree *t, int level, int i)
{
    return &t->nodes[HISR_LEVEL_START(t->roots, level) + i];
}

// Flux and area, summed in double.
static void add_node(double sum[4], const hisr_node *node)
{
    for (int k = 0; k < 3; k++)
        sum[k] += (double) node->vpl.flux[k];
    sum[3] += (double) node->vpl.position_area[3];
}

// Of a cut below node i of a level that is refined with a chance of `chance` in 8.
static void add_cut(const tree *t, int level, int i, int chance, double sum[4])
{
    if (level + 1 == t->levels || rand() % 8 >= chance) {
        add_node(sum, node_of(t, level, i));
        return;
    }
    for (int k = 0; k < 4; k++)
        add_cut(t, level + 1, 4 * i + k, chance, sum);
}

static void map_sums(const tree *t, double sum[4])
{
    const size_t texels = (size_t) t->c[1].width * t->c[1].height * t->c[1].layers;
    for (size_t i = 0; i < texels; i++) {
        const float *flux = t->c[1].texels + 4 * i;
        if (t->c[2].texels[4 * i + 3] <= 0 || flux[0] + flux[1] + flux[2] <= 0)
            continue; // seen and not lit
        for (int k = 0; k < 3; k++)
            sum[k] += (double) flux[k];
        sum[3] += (double) t->c[2].texels[4 * i + 3];
    }
}

static void expect_energy_of_cuts(ag_scene *scene, const char *size)
{
    tree t = capture_tree(scene, size);
    double want[4] = { 0 };
    map_sums(&t, want);
    assert_true(want[0] > 0);
    srand(7);
    for (int chance = 0; chance <= 8; chance++) {
        double got[4] = { 0 };
        for (int i = 0; i < t.roots; i++)
            add_cut(&t, 0, i, chance, got);
        // Six levels at most of three additions in float, 2^-24 each.
        for (int k = 0; k < 4; k++)
            if (fabs(got[k] / want[k] - 1) > 2e-6)
                fail_msg("%s, cut %d, channel %d: %.9g of %.9g", size, chance, k, got[k], want[k]);
    }
    captures_finish(t.c);
}

static void any_cut_has_the_energy_of_the_map(void **state)
{
    (void) state;
    static const char *const sizes[] = { "rsm_size=256", "rsm_size=64", "rsm_size=16",
                                         "rsm_size=8" };
    ag_scene *scene = boxes_scene(), *lights = three_lights();
    for (int i = 0; i < FG_COUNT(sizes); i++)
        expect_energy_of_cuts(scene, sizes[i]);
    expect_energy_of_cuts(lights, "rsm_size=32");
    ag_scene_destroy(scene);
    ag_scene_destroy(lights);
}

// Weight, position, squared distance from the origin and normal of the texels below a node, summed.
typedef struct moments {
    double weight, position[3], square, normal[3], reach;
} moments;

static void add_texels(const tree *t, int level, int i, moments *m)
{
    if (level + 1 < t->levels) {
        for (int k = 0; k < 4; k++)
            add_texels(t, level + 1, 4 * i + k, m);
        return;
    }
    const hisr_node *n = node_of(t, level, i);
    const double w = (double) n->vpl.flux[0] + (double) n->vpl.flux[1] + (double) n->vpl.flux[2];
    m->weight += w;
    for (int k = 0; k < 3; k++) {
        const double p = (double) n->vpl.position_area[k];
        m->position[k] += w * p;
        m->square += w * p * p;
        m->normal[k] += w * (double) n->vpl.normal[k];
    }
    m->square += w * (double) n->spread[0];
    m->reach = fmax(m->reach, (double) n->spread[1]);
}

static void expect_means(const tree *t, int i)
{
    const hisr_node *n = node_of(t, 0, i);
    moments m = { 0 };
    add_texels(t, 0, i, &m);
    if (m.weight <= 0) {
        assert_true(n->vpl.position_area[3] == 0 && n->vpl.flux[1] == 0);
        return;
    }
    double normal = 0, variance = m.square / m.weight;
    for (int k = 0; k < 3; k++) {
        m.position[k] /= m.weight;
        m.normal[k] /= m.weight;
        variance -= m.position[k] * m.position[k];
        normal += m.normal[k] * m.normal[k];
    }
    // A room of 1 m seen from 1 m: floats of order 1. Lengths of means are kept as half floats.
    for (int k = 0; k < 3; k++) {
        assert_true(fabs((double) n->vpl.position_area[k] - m.position[k]) < 2e-6);
        assert_true(fabs((double) n->vpl.normal[k] * sqrt(normal) - m.normal[k]) < 2e-3);
    }
    assert_true(fabs((double) n->spread[0] - variance) < 2e-6);
    // The patch as it would be at the farthest texel's distance from the light.
    const double reach = m.reach * pow(4, t->levels - 1);
    assert_true(fabs((double) n->spread[1] / reach - 1) < 1e-5);
}

static void a_node_is_the_mean_of_its_texels(void **state)
{
    (void) state;
    ag_scene *scene = three_lights();
    tree t = capture_tree(scene, "rsm_size=128");
    for (int i = 0; i < t.roots; i++)
        expect_means(&t, i);
    captures_finish(t.c);
    ag_scene_destroy(scene);
}

// ---- gather ---------------------------------------------------------------------------------

static void expect_gather_of_all(ag_scene *scene, const char *size, const char *clamp)
{
    enum { EDGE = 33 };
    const char *const all[] = { size, clamp, "clamp_d2=0.02", "pattern=all", NULL };
    const char *const none_left_out[] = {
        size, clamp, "clamp_d2=0.02", "tau=0", EVERY_PIXEL, NULL
    };
    const char *const paper[] = { size,        clamp, "clamp_d2=0.02", "tau=0", "bound=paper",
                                  EVERY_PIXEL, NULL };
    image want = render_as(scene, "rsm", EDGE, all);
    image got = render_as(scene, "hisr", EDGE, none_left_out),
          same = render_as(scene, "hisr", EDGE, paper);
    for (int i = 0; i < 3 * EDGE * EDGE; i++) {
        // The same terms in another order: sums of 64 and 1024 on one side, of 256 and as many
        // roots on the other; each rounds by 2^-24, as often up as down.
        if (fabs((double) (got.rgb[i] - want.rgb[i])) > 2e-5 * (double) want.rgb[i] + 1e-9)
            fail_msg("%s %s: %.9g, not %.9g", size, clamp, (double) got.rgb[i],
                     (double) want.rgb[i]);
        assert_true(fabs((double) (got.rgb[i] - same.rgb[i])) <=
                    2e-5 * (double) want.rgb[i] + 1e-9);
    }
    image_finish(&want);
    image_finish(&got);
    image_finish(&same);
}

static void tau_0_is_the_gather_of_all_texels(void **state)
{
    (void) state;
    ag_scene *scene = boxes_scene();
    expect_gather_of_all(scene, "rsm_size=64", "clamp=footprint");
    expect_gather_of_all(scene, "rsm_size=64", "clamp=disc");
    expect_gather_of_all(scene, "rsm_size=32", "clamp=none");
    expect_gather_of_all(scene, "rsm_size=32", "clamp=constant");
    expect_gather_of_all(scene, "rsm_size=16", "clamp=footprint");
    expect_gather_of_all(scene, "rsm_size=4", "clamp=disc");
    ag_scene_destroy(scene);
}

// 21840 nodes of a spot, and 43680 of eight faces: more than one dispatch looks at.
static void every_node_counts_over_several_dispatches(void **state)
{
    (void) state;
    ag_scene *scene = boxes_scene(), *lights = three_lights();
    expect_gather_of_all(scene, "rsm_size=128", "clamp=footprint");
    expect_gather_of_all(lights, "rsm_size=64", "clamp=footprint");
    ag_scene_destroy(scene);
    ag_scene_destroy(lights);
}

static void expect_falling_error(ag_scene *scene, const char *bound, const image *want)
{
    static const char *const taus[] = { "tau=1e12", "tau=0.1",  "tau=0.01",
                                        "tau=1e-3", "tau=1e-4", "tau=1e-5" };
    double last = (double) INFINITY;
    for (int i = 0; i < FG_COUNT(taus); i++) {
        const char *const settings[] = { "rsm_size=128", bound, taus[i], EVERY_PIXEL, NULL };
        image got = render_as(scene, "hisr", want->width, settings);
        const double error = relative_rmse(&got, want);
        expect_finite(&got);
        if (error > last)
            fail_msg("%s %s: %.4f after %.4f", bound, taus[i], error, last);
        // Even the roots hold all energy, and most of a wall's light comes from afar.
        assert_true(fabs(image_mean(&got) / image_mean(want) - 1) < 0.05);
        last = error;
        image_finish(&got);
    }
    assert_true(last < 2e-3);
}

static void error_falls_with_tau(void **state)
{
    (void) state;
    const char *const all[] = { "rsm_size=128", "pattern=all", NULL };
    ag_scene *scene = boxes_scene();
    image want = render_as(scene, "rsm", 48, all);
    expect_falling_error(scene, "bound=patch", &want);
    expect_falling_error(scene, "bound=paper", &want);
    image_finish(&want);
    ag_scene_destroy(scene);
}

static void tau_infinite_is_the_coarsest_cut(void **state)
{
    (void) state;
    enum { EDGE = 32 };
    const char *const coarse[] = { "tau=1e12", NULL };
    const char *const roots[] = { "tau=0", "finest=16", NULL };
    ag_scene *scene = boxes_scene();
    image a = render_as(scene, "hisr", EDGE, coarse), b = render_as(scene, "hisr", EDGE, roots);
    assert_memory_equal(a.rgb, b.rgb, sizeof(float) * 3 * EDGE * EDGE);
    image_finish(&a);
    image_finish(&b);
    ag_scene_destroy(scene);
}

// Walls all around hide nothing from each other; boxes hide more of the light the finer the tree.
static void imperfect_shadow_maps_darken_what_is_hidden(void **state)
{
    (void) state;
    enum { EDGE = 40 };
    static const room_desc empty = { 0 };
    const ag_light light = ceiling_spot(58);
    ag_scene *scenes[] = { room_scene(&empty, &light), boxes_scene() };
    static const char *const taus[] = { "tau=1e12", "tau=1e-3" };
    for (int i = 0; i < 4; i++) {
        const char *const open[] = { taus[i % 2], NULL };
        const char *const hidden[] = { taus[i % 2], "visibility=ism", NULL };
        image a = render_as(scenes[i / 2], "hisr", EDGE, open);
        image b = render_as(scenes[i / 2], "hisr", EDGE, hidden);
        expect_finite(&b);
        const double kept = image_mean(&b) / image_mean(&a);
        // Imperfect: some of the empty room's light is lost at texels along its edges.
        if (i < 2 ? kept < 0.97 || kept > 1.0001 : kept < 0.5 || kept > 0.97)
            fail_msg("scene %d %s: %.4f of the light is left", i / 2, taus[i % 2], kept);
        image_finish(&a);
        image_finish(&b);
    }
    ag_scene_destroy(scenes[0]);
    ag_scene_destroy(scenes[1]);
}

// ---- what must not change it --------------------------------------------------------------------

static image scaled_room(double edge)
{
    const room_desc room = { .edge = edge, .boxes = true };
    ag_light light = ceiling_spot(58);
    for (int k = 0; k < 3; k++)
        light.intensity[k] = (float) (edge * edge); // E = I / r^2 stays as it is
    ag_scene *scene = room_scene(&room, &light);
    image img = render_as(scene, "hisr", 64, NULL);
    ag_scene_destroy(scene);
    return img;
}

static void scale_does_not_matter(void **state)
{
    (void) state;
    static const double edges[] = { 1e-4, 0.03, 70, 1e4 };
    image want = scaled_room(1);
    assert_true(image_mean(&want) > 0.01);
    for (int i = 0; i < FG_COUNT(edges); i++) {
        image got = scaled_room(edges[i]);
        const double error = relative_rmse(&got, &want);
        if (!(error < 0.01))
            fail_msg("edge %g m: %g", edges[i], error);
        image_finish(&got);
    }
    image_finish(&want);
}

static void brighter_light_changes_no_cut(void **state)
{
    (void) state;
    enum { EDGE = 32 };
    image img[2];
    for (int i = 0; i < 2; i++) {
        ag_light light = ceiling_spot(58);
        for (int k = 0; k < 3; k++)
            light.intensity[k] = i ? 1048576.0f : 1.0f; // a power of two rounds nothing
        ag_scene *scene = room_scene(&boxes, &light);
        img[i] = render_as(scene, "hisr", EDGE, NULL);
        ag_scene_destroy(scene);
    }
    for (int i = 0; i < 3 * EDGE * EDGE; i++)
        assert_true(fabs((double) img[1].rgb[i] - 1048576.0 * (double) img[0].rgb[i]) <=
                    1e-5 * (double) img[1].rgb[i]);
    image_finish(&img[0]);
    image_finish(&img[1]);
}

// The stencil's fragments go through the tree alone, the list's texels by sixteens. Where that
// takes several dispatches sums may be split at different nodes, and round differently; here it
// takes one.
static void stencil_and_list_give_the_same_bits(void **state)
{
    (void) state;
    static const char *const bounds[] = { "bound=patch", "bound=paper" };
    ag_scene *scene = boxes_scene();
    for (int i = 0; i < FG_COUNT(bounds); i++) {
        enum { EDGE = 130 };
        const char *const list[] = { bounds[i], "rsm_size=64", "tau=1e-3", "cull=compact", NULL };
        const char *const stencil[] = { bounds[i], "rsm_size=64", "tau=1e-3", "cull=stencil",
                                        NULL };
        image a = render_as(scene, "hisr", EDGE, list), b = render_as(scene, "hisr", EDGE, stencil);
        assert_memory_equal(a.rgb, b.rgb, sizeof(float) * 3 * EDGE * EDGE);
        image_finish(&a);
        image_finish(&b);
    }
    ag_scene_destroy(scene);
}

static void same_frame_twice_is_bit_identical(void **state)
{
    (void) state;
    enum { EDGE = 65 };
    ag_scene *scene = three_lights();
    image a = render_as(scene, "hisr", EDGE, NULL), b = render_as(scene, "hisr", EDGE, NULL);
    assert_memory_equal(a.rgb, b.rgb, sizeof(float) * 3 * EDGE * EDGE);
    image_finish(&a);
    image_finish(&b);
    ag_scene_destroy(scene);
}

static void any_size_renders(void **state)
{
    (void) state;
    static const int sizes[][2] = { { 1, 1 }, { 2, 1 }, { 65, 63 }, { 511, 259 } };
    ag_scene *scene = boxes_scene();
    for (int i = 0; i < FG_COUNT(sizes); i++) {
        const shot s = { scene, sizes[i][0], sizes[i][1], LAYER_INDIRECT, plugin_named("hisr"),
                         NULL,  NULL };
        image img = shot_take(&s);
        expect_finite(&img);
        assert_true(image_mean(&img) > 0.01);
        image_finish(&img);
    }
    ag_scene_destroy(scene);
}

// ---- nothing to do ------------------------------------------------------------------------------

static void expect_black(ag_scene *scene)
{
    static const char *const taus[] = { "tau=0", "tau=1e-3", "tau=1e12" };
    for (int i = 0; i < FG_COUNT(taus); i++) {
        const char *const settings[] = { taus[i], "rsm_size=64", NULL };
        image img = render_as(scene, "hisr", 16, settings);
        for (int k = 0; k < 3 * 16 * 16; k++)
            assert_true(img.rgb[k] == 0);
        image_finish(&img);
    }
}

static void light_that_meets_nothing_gives_nothing(void **state)
{
    (void) state;
    static const double p[3] = { -1, -1, -1 }, u[3] = { 0, 0, 2 }, v[3] = { 2, 0, 0 };
    ag_light light = ceiling_spot(40), black = ceiling_spot(58);
    ag_builder *b = ag_builder_create(test_log(), "sky");
    light.direction[1] = 1; // up and away
    add_quad(b, -1, p, u, v);
    ag_builder_light(b, -1, &light);
    memset(black.intensity, 0, sizeof black.intensity);
    ag_scene *scenes[] = { finish_scene(b), room_scene(&boxes, NULL), room_scene(&boxes, &black) };
    for (int i = 0; i < 3; i++) {
        expect_black(scenes[i]);
        ag_scene_destroy(scenes[i]);
    }
}

// A spot 1 mm from a wall: one texel may hold nearly all of the light.
static void light_next_to_a_wall_is_finite(void **state)
{
    (void) state;
    ag_light light = ceiling_spot(80);
    light.position[0] = 0.499;
    light.position[1] = 0;
    ag_scene *scene = room_scene(&boxes, &light);
    image img = render_as(scene, "hisr", 64, NULL);
    expect_finite(&img);
    assert_true(image_mean(&img) > 0);
    image_finish(&img);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_cut_has_the_energy_of_the_map),
        cmocka_unit_test(a_node_is_the_mean_of_its_texels),
        cmocka_unit_test(tau_0_is_the_gather_of_all_texels),
        cmocka_unit_test(every_node_counts_over_several_dispatches),
        cmocka_unit_test(error_falls_with_tau),
        cmocka_unit_test(tau_infinite_is_the_coarsest_cut),
        cmocka_unit_test(scale_does_not_matter),
        cmocka_unit_test(brighter_light_changes_no_cut),
        cmocka_unit_test(imperfect_shadow_maps_darken_what_is_hidden),
        cmocka_unit_test(stencil_and_list_give_the_same_bits),
        cmocka_unit_test(same_frame_twice_is_bit_identical),
        cmocka_unit_test(any_size_renders),
        cmocka_unit_test(light_that_meets_nothing_gives_nothing),
        cmocka_unit_test(light_next_to_a_wall_is_finite),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
