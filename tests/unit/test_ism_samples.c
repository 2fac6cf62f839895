// SPDX-License-Identifier: MIT
// Point samples of a scene's surfaces, on the CPU.
#include "scene_log.h"

#include <math.h>
#include <pass/ism.h>

enum { COUNT = 4096 };

static ag_ism_sample samples[COUNT], others[COUNT];

static void take(const ag_scene *scene, uint32_t seed, ag_ism_sample *out)
{
    lines l;
    const fg_log log = log_to(&l);
    assert_int_equal(ag_ism_sample_scene(&log, scene, seed, COUNT, out), FG_OK);
    assert_int_equal(l.errors + l.warnings, 0);
}

static int show(ag_builder *b, int primitive, double scale)
{
    const ag_node_desc node = { .parent = -1, .scale = { scale, scale, scale } };
    const int n = ag_builder_node(b, &node);
    ag_builder_show(b, n, primitive, -1);
    return n;
}

// In the triangle's own plane, of which the corners are (0, 0), (1, 0), (0, 1).
static void place_in_triangle(const ag_scene *scene, const ag_ism_sample *s, double out[2])
{
    out[0] = out[1] = 0;
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 2; axis++)
            out[axis] +=
                (double) s->weights[k] * (double) scene->vertices[s->corners[k]].position[axis];
}

static ag_scene *one_triangle(fg_log *log)
{
    ag_builder *b = ag_builder_create(log, "one");
    show(b, add_triangle(b, -1), 1);
    return build(b);
}

// Samples lie at equal steps of area along one curve, so an interval of n steps' length holds n or
// one more or less.
static void each_triangle_gets_its_share_of_every_run(void **state)
{
    enum { TRIANGLES = 20, RUN = 256 };
    (void) state;
    lines l;
    const fg_log log = log_to(&l);
    ag_builder *b = ag_builder_create(&log, "many");
    const int primitive = add_triangle(b, -1);
    double area[TRIANGLES], all = 0;
    for (int i = 0; i < TRIANGLES; i++) {
        const double scale = pow(1.3, i % 7) * (i == 3 ? 10 : 1);
        show(b, primitive, scale);
        all += area[i] = 0.5 * scale * scale;
    }
    ag_scene *scene = build(b);
    for (uint32_t seed = 0; seed < 3; seed++) {
        take(scene, seed, samples);
        for (int first = 0; first < COUNT; first += RUN) {
            int found[TRIANGLES] = { 0 };
            for (int i = first; i < first + RUN; i++)
                found[samples[i].corners[3]]++;
            for (int t = 0; t < TRIANGLES; t++)
                assert_near(found[t], RUN * area[t] / all, 1);
        }
        // What a sample stands for is the same for all: its triangle's area times its last weight.
        for (int i = 0; i < COUNT; i++)
            assert_near((double) samples[i].weights[3] * area[samples[i].corners[3]] * COUNT / all,
                        1, 1e-6);
    }
    ag_scene_destroy(scene);
}

// The curve halves the triangle across its longest edge again and again: a square of 1/8 that lies
// within it is two of the 64 parts after six halvings.
static void a_triangle_is_filled_evenly(void **state)
{
    enum { EDGE = 8 };
    (void) state;
    lines l;
    fg_log log = log_to(&l);
    ag_scene *scene = one_triangle(&log);
    take(scene, 1, samples);
    int found[EDGE][EDGE] = { 0 };
    for (int i = 0; i < COUNT; i++) {
        double at[2];
        const float *w = samples[i].weights;
        assert_near(w[0] + w[1] + w[2], 1, 1e-6);
        assert_true(w[0] >= 0 && w[1] >= 0 && w[2] >= 0);
        place_in_triangle(scene, &samples[i], at);
        found[(int) (at[1] * EDGE)][(int) (at[0] * EDGE)]++;
    }
    for (int y = 0; y < EDGE; y++)
        for (int x = 0; x + y + 1 < EDGE; x++)
            assert_int_equal(found[y][x], 2 * COUNT / (EDGE * EDGE));
    ag_scene_destroy(scene);
}

static void a_seed_says_where(void **state)
{
    (void) state;
    lines l;
    fg_log log = log_to(&l);
    ag_scene *scene = one_triangle(&log);
    take(scene, 7, samples);
    take(scene, 7, others);
    assert_memory_equal(samples, others, sizeof samples);
    take(scene, 8, others);
    assert_memory_not_equal(samples, others, sizeof samples);
    ag_scene_destroy(scene);
}

static void no_area_gets_no_samples(void **state)
{
    (void) state;
    lines l;
    const fg_log log = log_to(&l);
    ag_builder *b = ag_builder_create(&log, "flat");
    const double line[16] = { [0] = 1, [10] = 1, [15] = 1 }; // y is gone, and the triangle with it
    const int primitive = add_triangle(b, -1);
    const int flat = ag_builder_node(b, &(ag_node_desc){ .parent = -1, .matrix = line });
    ag_builder_show(b, flat, primitive, -1);
    ag_scene *scene = build(b);
    take(scene, 0, samples);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(samples[i].corners[3], -1);
    ag_scene_destroy(scene);

    b = ag_builder_create(&log, "half flat");
    const int both = add_triangle(b, -1);
    ag_builder_show(b, ag_builder_node(b, &(ag_node_desc){ .parent = -1, .matrix = line }), both,
                    -1);
    show(b, both, 1);
    scene = build(b);
    take(scene, 0, samples);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(samples[i].corners[3], 1);
    ag_scene_destroy(scene);

    b = ag_builder_create(&log, "empty");
    scene = build(b);
    take(scene, 0, samples);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(samples[i].corners[3], -1);
    ag_scene_destroy(scene);
}

// Opaque where u < 1/2: three quarters of the triangle, and 1/2 is an edge of the curve's parts.
static void a_mask_takes_samples_away(void **state)
{
    (void) state;
    static const uint8_t texels[2 * 4] = { 255, 255, 255, 255, 255, 255, 255, 0 };
    lines l;
    const fg_log log = log_to(&l);
    ag_builder *b = ag_builder_create(&log, "mask");
    const ag_texture texture = {
        .width = 2, .height = 1, .rgba = texels, .nearest = true, .wrap_u = AG_WRAP_CLAMP
    };
    ag_material m = ag_default_material();
    m.alpha = AG_ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    m.base_color_tex = (ag_texture_ref){ .texture = ag_builder_texture(b, &texture) };
    ag_vertex v[3] = { vertex(0, 0, 0), vertex(1, 0, 0), vertex(0, 1, 0) };
    for (int k = 0; k < 3; k++)
        v[k].uv[0][0] = v[k].position[0];
    const ag_primitive_desc desc = { .vertices = v,
                                     .vertex_count = 3,
                                     .material = ag_builder_material(b, &m) };
    show(b, ag_builder_primitive(b, &desc), 1);
    ag_scene *scene = build(b);
    take(scene, 0, samples);
    int there = 0;
    for (int i = 0; i < COUNT; i++) {
        double at[2];
        place_in_triangle(scene, &samples[i], at);
        assert_int_equal(samples[i].corners[3], at[0] < 0.5 ? 0 : -1);
        there += samples[i].corners[3] == 0;
    }
    assert_int_equal(there, 3 * COUNT / 4);
    ag_scene_destroy(scene);
}

static void counts_are_powers_of_two(void **state)
{
    static const int counts[] = { 0, -1, 3, 2 * AG_ISM_MAX_SAMPLES };
    (void) state;
    lines l;
    fg_log log = log_to(&l);
    ag_scene *scene = one_triangle(&log);
    for (int i = 0; i < FG_COUNT(counts); i++) {
        l.errors = 0;
        assert_int_equal(ag_ism_sample_scene(&log, scene, 0, counts[i], samples), FG_ERR_INVALID);
        assert_int_equal(l.errors, 1);
        assert_has(l.error, "samples, must be a power of two in [1, 1048576]");
    }
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_triangle_gets_its_share_of_every_run),
        cmocka_unit_test(a_triangle_is_filled_evenly),
        cmocka_unit_test(a_seed_says_where),
        cmocka_unit_test(no_area_gets_no_samples),
        cmocka_unit_test(a_mask_takes_samples_away),
        cmocka_unit_test(counts_are_powers_of_two),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
