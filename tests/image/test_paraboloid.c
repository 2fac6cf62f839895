// SPDX-License-Identifier: MIT
// Paraboloid shadow maps: every texel against a ray through its middle, straight edges, eyes within
// rounding of walls, what is drawn when.
#include "paraboloid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- against rays -------------------------------------------------------------------------------

static void check_eye(const maps_host *h, const ag_paraboloid_eye *eye, int step)
{
    float *texels = maps_read(h, eye->slot);
    const maps_verdict v = maps_check(h, eye, texels, step);
    free(texels);
    if (v.wrong || v.edges * 50 > v.texels)
        print_message("%s, slot %d: of %d texels %d at edges, %d wrong\n", h->scene->name,
                      eye->slot, v.texels, v.edges, v.wrong);
    assert_int_equal(v.wrong, 0);
    // Rounding moves edges past texels' middles seldom.
    assert_true(v.edges * 50 <= v.texels);
}

static void check_scene(ag_scene *scene, int size, int count, int step)
{
    ag_paraboloid_eye eyes[64];
    uint32_t seed = 7;
    maps_host h;
    maps_init(&h, scene, size, count);
    for (int i = 0; i < count; i++)
        eyes[i] = maps_eye(&h, &seed, i);
    assert_int_equal(maps_draw(&h, eyes, count), FG_OK);
    assert_int_equal(ag_paraboloid_drawn(h.maps), count);
    for (int i = 0; i < count; i++)
        check_eye(&h, &eyes[i], step);
    maps_finish(&h);
}

static void texels_of_cornell_are_rays(void **state)
{
    (void) state;
    check_scene(maps_scene("cornell"), 256, 8, 3);
    check_scene(maps_scene("cornell"), 32, 40, 1); // more than are drawn at once
}

static void texels_of_the_atrium_are_rays(void **state)
{
    (void) state;
    check_scene(maps_scene("atrium"), 256, 12, 5);
}

// A triangle of a size of its own; a sliver is a thousandth to a millionth as wide as long.
static void add_random(ag_builder *b, uint32_t *seed, double size, double width)
{
    ag_vertex v[3];
    memset(v, 0, sizeof v);
    for (int k = 0; k < 3; k++) {
        const double at = feed_random(seed) * 2 - 1, along = feed_random(seed) * 2 - 1;
        v[0].position[k] = (float) at;
        v[1].position[k] = (float) (at + size * along);
        v[2].position[k] = (float) (at + size * (0.5 * along + width * (feed_random(seed) - 0.5)));
    }
    const ag_primitive_desc desc = { .vertices = v, .vertex_count = 3, .material = -1 };
    ag_builder_show(b, ag_builder_node(b, &(ag_node_desc){ .parent = -1 }),
                    ag_builder_primitive(b, &desc), -1);
}

static ag_scene *soup(uint32_t seed)
{
    static const double sizes[] = { 0.02, 0.2, 8 }, widths[] = { 1, 1e-3, 1e-6 };
    ag_builder *b = ag_builder_create(test_log(), "soup");
    for (int i = 0; i < 300; i++)
        add_random(b, &seed, sizes[i % 3], i % 10 == 0 ? widths[1 + i / 10 % 2] : widths[0]);
    return finish_scene(b);
}

static void texels_of_any_triangles_are_rays(void **state)
{
    (void) state;
    for (uint32_t seed = 1; seed < 4; seed++)
        check_scene(soup(seed), 128, 16, 2);
}

// A square with its lower left corner at `at`, holed as its material says.
static void add_masked(ag_builder *b, int material, const float at[3], bool along_z)
{
    static const uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    ag_vertex v[4];
    memset(v, 0, sizeof v);
    for (int i = 0; i < 4; i++) {
        const float a = i == 1 || i == 2 ? 1 : 0, c = i >= 2 ? 1 : 0;
        memcpy(v[i].position, at, sizeof v[i].position);
        v[i].position[along_z ? 2 : 0] += 2 * a;
        v[i].position[1] += 2 * c;
        v[i].uv[0][0] = a;
        v[i].uv[0][1] = c;
        for (int k = 0; k < 4; k++)
            v[i].color[k] = i == 2 ? 0.9f : 1;
    }
    const ag_primitive_desc desc = {
        .vertices = v, .vertex_count = 4, .indices = indices, .index_count = 6, .material = material
    };
    ag_builder_show(b, ag_builder_node(b, &(ag_node_desc){ .parent = -1 }),
                    ag_builder_primitive(b, &desc), -1);
}

static ag_scene *masked_scene(bool nearest)
{
    enum { N = 8 };
    static const double corner[3] = { -1, -1, -1.5 }, up[3] = { 0, 2, 0 }, along[3] = { 2, 0, 0 };
    const float turn[6] = { 2.5f, 0.5f, -1.25f, -0.5f, 2, 0.125f };
    uint8_t rgba[4 * N * N];
    for (int i = 0; i < N * N; i++) {
        memset(rgba + 4 * (size_t) i, 255, 4);
        rgba[4 * i + 3] = (i ^ i / N) & 1 ? 250 : 10;
    }
    const ag_texture texture = { .width = N,
                                 .height = N,
                                 .rgba = rgba,
                                 .nearest = nearest,
                                 .wrap_u = AG_WRAP_MIRROR,
                                 .wrap_v = nearest ? AG_WRAP_CLAMP : AG_WRAP_REPEAT };
    ag_builder *b = ag_builder_create(test_log(), "masked");
    ag_material m = ag_default_material();
    m.alpha = AG_ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    m.base_color_tex.texture = ag_builder_texture(b, &texture);
    memcpy(m.base_color_tex.transform, turn, sizeof turn);
    const int holed = ag_builder_material(b, &m);
    add_quad(b, -1, corner, along, up);
    for (int i = 0; i < 3; i++)
        add_masked(b, holed, (float[3]){ -1, -1, -0.9f + 0.6f * (float) i }, false);
    add_masked(b, holed, (float[3]){ -1, -1, -1 }, true);
    return finish_scene(b);
}

static void masked_texels_are_not_there(void **state)
{
    (void) state;
    for (int nearest = 0; nearest < 2; nearest++)
        check_scene(masked_scene(nearest), 128, 8, 1);
}

// ---- straight edges -----------------------------------------------------------------------------

// Whether rays at a place of the map find what is nearer to `a` than to `b`.
static bool is_like(const maps_host *h, const ag_paraboloid_eye *eye, const double at[2], double a,
                    double b)
{
    double d[3], off;
    maps_ray(eye, h->size, at[0], at[1], d);
    return (maps_by_ray(h, eye, d, &off) > sqrt(a * b)) == (a > b);
}

// Where in a row, nearest to the middle between x and x + 1, rays stop to find what x has and find
// what x + 1 has; NAN where they do not within four texels.
static double crossing(const maps_host *h, const ag_paraboloid_eye *eye, const int texel[2],
                       double a, double b)
{
    const int steps = 256; // of a 64th of a texel
    const double middle = texel[0] + 0.5;
    double nearest = (double) NAN;
    bool before = true;
    for (int i = 0; i <= 2 * steps; i++) {
        const double at[2] = { middle + (i - steps) / 64.0, texel[1] };
        const bool like = is_like(h, eye, at, a, b);
        if (i > 0 && before && !like && !(fabs(nearest - middle) <= fabs(at[0] - middle)))
            nearest = at[0];
        before = like;
    }
    return nearest;
}

// An edge in a map is taken to lie midway between the texels that show different things: cornell's
// boxes', the sides of which are 2 triangles each, then are within half a texel of where they are.
static void straight_edges_are_straight_to_half_a_texel(void **state)
{
    enum { SIZE = 256 };
    ag_paraboloid_eye eyes[6];
    uint32_t seed = 11;
    int edges = 0;
    double worst = 0;
    maps_host h;
    (void) state;
    maps_init(&h, maps_scene("cornell"), SIZE, FG_COUNT(eyes));
    for (int i = 0; i < FG_COUNT(eyes); i++)
        eyes[i] = maps_eye(&h, &seed, i);
    assert_int_equal(maps_draw(&h, eyes, FG_COUNT(eyes)), FG_OK);
    for (int i = 0; i < FG_COUNT(eyes); i++) {
        float *texels = maps_read(&h, i);
        for (int y = 32; y < SIZE - 32; y += 3)
            for (int x = 32; x < SIZE - 32; x++) {
                const double a = (double) texels[y * SIZE + x],
                             b = (double) texels[y * SIZE + x + 1];
                if ((a <= 1.5 * b && b <= 1.5 * a) || hypot(x - 0.5 * SIZE, y - 0.5 * SIZE) > 120)
                    continue; // no box before a wall
                const double at = crossing(&h, &eyes[i], (int[2]){ x, y }, a, b);
                assert_false(isnan(at));
                worst = fmax(worst, fabs(at - (x + 0.5)));
                edges++;
            }
        free(texels);
    }
    print_message("%d rows cross an edge, at most %.3f texels off\n", edges, worst);
    assert_true(edges > 100);
    assert_true(worst <= 0.5 + 1.0 / 64);
    maps_finish(&h);
}

// ---- within rounding of a wall ------------------------------------------------------------------

// On the floor and at, before or behind the plane of a wall by less than places are known to: the
// room is seen, and nothing behind the wall. The truth is what is seen from inside.
static void eyes_at_walls_see_the_room_alone(void **state)
{
    static const double offs[] = { -0x1p-22, 0, 0x1p-22 };
    (void) state;
    const room_desc room = { .boxes = true };
    maps_host h;
    maps_init(&h, room_scene(&room, NULL), 128, 1);
    for (int axes = 1; axes <= 2; axes++)
        for (int i = 0; i < FG_COUNT(offs); i++) {
            ag_paraboloid_eye eye = { .position = { -0.5, -0.5, 0.1 },
                                      .normal = { 0, 1, 0 },
                                      .fresh = true };
            eye.position[0] += offs[i] / h.unit;
            if (axes == 2)
                eye.position[2] = -0.5 + offs[2 - i] / h.unit;
            assert_int_equal(maps_draw(&h, &eye, 1), FG_OK);
            eye.position[0] = -0.5 + 0x1p-20 / h.unit;
            if (axes == 2)
                eye.position[2] = -0.5 + 0x1p-20 / h.unit;
            check_eye(&h, &eye, 1);
        }
    maps_finish(&h);
}

// ---- what is drawn ------------------------------------------------------------------------------

static void others_keep_their_texels(void **state)
{
    enum { COUNT = 6, SIZE = 64 };
    ag_paraboloid_eye eyes[COUNT];
    float *before[COUNT];
    uint32_t seed = 5;
    maps_host h;
    (void) state;
    maps_init(&h, maps_scene("cornell"), SIZE, COUNT);
    for (int i = 0; i < COUNT; i++)
        eyes[i] = maps_eye(&h, &seed, i);
    assert_int_equal(maps_draw(&h, eyes, COUNT), FG_OK);
    for (int i = 0; i < COUNT; i++) {
        before[i] = maps_read(&h, i);
        eyes[i].fresh = false;
    }
    assert_int_equal(maps_draw(&h, eyes, COUNT), FG_OK);
    assert_int_equal(ag_paraboloid_drawn(h.maps), 0);
    eyes[2] = maps_eye(&h, &seed, 2);
    assert_int_equal(maps_draw(&h, eyes, COUNT), FG_OK);
    assert_int_equal(ag_paraboloid_drawn(h.maps), 1);
    for (int i = 0; i < COUNT; i++) {
        float *after = maps_read(&h, i);
        assert_true(same_bits(before[i], after, sizeof(float) * SIZE * SIZE) == (i != 2));
        free(after);
        free(before[i]);
    }
    check_eye(&h, &eyes[2], 1);
    maps_finish(&h);
}

static void what_a_failed_frame_left_is_drawn_later(void **state)
{
    ag_paraboloid_eye eyes[3];
    uint32_t seed = 5;
    maps_host h;
    (void) state;
    maps_init(&h, maps_scene("cornell"), 64, 3);
    for (int i = 0; i < 3; i++)
        eyes[i] = maps_eye(&h, &seed, i);
    h.fail = true;
    assert_int_equal(maps_draw(&h, eyes, 3), FG_ERR_DEVICE);
    h.fail = false;
    for (int i = 0; i < 3; i++)
        eyes[i].fresh = false;
    assert_int_equal(maps_draw(&h, eyes, 2), FG_OK); // the third is not looked up yet
    assert_int_equal(ag_paraboloid_drawn(h.maps), 2);
    assert_int_equal(maps_draw(&h, eyes, 3), FG_OK);
    assert_int_equal(ag_paraboloid_drawn(h.maps), 1);
    for (int i = 0; i < 3; i++)
        check_eye(&h, &eyes[i], 1);
    maps_finish(&h);
}

// A room with blocks, and a quad amid it that moves, or none.
static ag_scene *moving_scene(bool there)
{
    static const ag_vertex corners[3] = { { .position = { -0.2f, 0, 0 } },
                                          { .position = { 0.2f, 0, 0.1f } },
                                          { .position = { 0, 0.3f, 0 } } };
    static const float times[2] = { 0, 1 }, places[6] = { 0, 0, 0, 0.1f, 0, 0 };
    const room_desc room = { .boxes = true };
    ag_builder *b = room_builder(&room);
    if (there) {
        const ag_primitive_desc desc = { .vertices = corners, .vertex_count = 3, .material = -1 };
        const int node = ag_builder_node(b, &(ag_node_desc){ .parent = -1 });
        const ag_channel_desc way = {
            .node = node, .key_count = 2, .times = times, .values = places
        };
        ag_builder_show(b, node, ag_builder_primitive(b, &desc), -1);
        ag_builder_channel(b, &way);
    }
    return finish_scene(b);
}

static void what_moves_is_not_in(void **state)
{
    enum { SIZE = 64 };
    const ag_paraboloid_eye eye = { .position = { 0, 0.5, 0 },
                                    .normal = { 0, -1, 0 },
                                    .fresh = true };
    float *texels[2];
    (void) state;
    for (int i = 0; i < 2; i++) {
        maps_host h;
        maps_init(&h, moving_scene(i == 1), SIZE, 1);
        assert_int_equal(h.scene->features & AG_FEATURE_MOVING_GEOMETRY ? 1 : 0, i);
        assert_int_equal(maps_draw(&h, &eye, 1), FG_OK);
        texels[i] = maps_read(&h, 0);
        maps_finish(&h);
    }
    assert_memory_equal(texels[0], texels[1], sizeof(float) * SIZE * SIZE);
    free(texels[0]);
    free(texels[1]);
}

// ---- sizes --------------------------------------------------------------------------------------

static void one_map_and_4096(void **state)
{
    static const int capacities[] = { 1, 4096 }, slots[2][3] = { { 0 }, { 0, 2049, 4095 } };
    (void) state;
    for (int c = 0; c < 2; c++) {
        const int count = c == 0 ? 1 : 3;
        ag_paraboloid_eye eyes[3];
        uint32_t seed = 5;
        maps_host h;
        maps_init(&h, maps_scene("cornell"), 32, capacities[c]);
        for (int i = 0; i < count; i++)
            eyes[i] = maps_eye(&h, &seed, slots[c][i]);
        assert_int_equal(maps_draw(&h, eyes, count), FG_OK);
        for (int i = 0; i < count; i++)
            check_eye(&h, &eyes[i], 1);
        assert_true(ag_paraboloid_bytes(h.maps) >= 2048ull * (uint64_t) capacities[c]);
        maps_finish(&h);
    }
}

static void scale_does_not_matter(void **state)
{
    static const double edges[] = { 1e-4, 1, 1e4 };
    (void) state;
    for (int i = 0; i < FG_COUNT(edges); i++) {
        const room_desc room = { .edge = edges[i], .boxes = true };
        check_scene(room_scene(&room, NULL), 128, 4, 1);
    }
}

static void an_empty_scene_has_empty_maps(void **state)
{
    (void) state;
    ag_builder *b = ag_builder_create(test_log(), "nothing");
    const ag_paraboloid_eye eye = { .normal = { 0, 0, 1 }, .fresh = true };
    maps_host h;
    maps_init(&h, finish_scene(b), 16, 1);
    assert_int_equal(maps_draw(&h, &eye, 1), FG_OK);
    float *texels = maps_read(&h, 0);
    for (int i = 0; i < 16 * 16; i++)
        assert_true(texels[i] == 0);
    free(texels);
    maps_finish(&h);
}

static void mistakes_name_value_and_rule(void **state)
{
    static const struct {
        int size, capacity;
        const char *message;
    } cases[] = {
        { 100, 1, "paraboloid: size is 100, must be a power of two in [16, 1024]" },
        { 2048, 1, "paraboloid: size is 2048, must be a power of two in [16, 1024]" },
        { 8, 1, "paraboloid: size is 8, must be a power of two in [16, 1024]" },
        { 16, 0, "paraboloid: capacity is 0, must lie in [1, 4096]" },
        { 16, 4097, "paraboloid: capacity is 4097, must lie in [1, 4096]" },
    };
    (void) state;
    ag_scene *scene = maps_scene("cornell");
    for (int i = 0; i < FG_COUNT(cases); i++) {
        ag_paraboloid_maps *maps;
        const ag_paraboloid_desc desc = { .log = test_log(),
                                          .device = device(),
                                          .scene = scene,
                                          .size = cases[i].size,
                                          .capacity = cases[i].capacity };
        log_clear();
        assert_int_equal(ag_paraboloid_create(&desc, &maps), FG_ERR_INVALID);
        assert_null(maps);
        assert_non_null(strstr(log_text(), cases[i].message));
    }
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_of_cornell_are_rays),
        cmocka_unit_test(texels_of_the_atrium_are_rays),
        cmocka_unit_test(texels_of_any_triangles_are_rays),
        cmocka_unit_test(masked_texels_are_not_there),
        cmocka_unit_test(straight_edges_are_straight_to_half_a_texel),
        cmocka_unit_test(eyes_at_walls_see_the_room_alone),
        cmocka_unit_test(others_keep_their_texels),
        cmocka_unit_test(what_a_failed_frame_left_is_drawn_later),
        cmocka_unit_test(what_moves_is_not_in),
        cmocka_unit_test(one_map_and_4096),
        cmocka_unit_test(scale_does_not_matter),
        cmocka_unit_test(an_empty_scene_has_empty_maps),
        cmocka_unit_test(mistakes_name_value_and_rule),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
