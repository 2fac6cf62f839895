// SPDX-License-Identifier: MIT
// VPL management: several lights, slots over time, tiles, and what is extreme.
#include "iir_rooms.h"

static lines heard;
static fg_log logger;

static int start(void **state)
{
    (void) state;
    logger = log_to(&heard);
    return 0;
}

// Points of each light are VPLs in a closed room.
static void count_by_light(const iir_result *r, int *counts, int lights)
{
    memset(counts, 0, (size_t) lights * sizeof *counts);
    for (int i = 0; i < r->count; i++) {
        assert_in_range(r->vpls[i].light, 0, lights - 1);
        counts[r->vpls[i].light]++;
    }
}

// ---- several lights ---------------------------------------------------------------------------

static void lights_share_points_by_power(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 256);
    const iir_budget budget = default_budget(256);
    ag_light lights[3] = { point_light(-0.5, 0, 0.2), point_light(0.5, 0, 0.1),
                           point_light(0.2, 0.5, 0) };
    int counts[3];
    lights[1].intensity[0] = lights[1].intensity[1] = lights[1].intensity[2] = 3;
    count_by_light(step_many(m, lights, 2, &budget), counts, 2);
    assert_int_equal(counts[0], 64);
    assert_int_equal(counts[1], 192);
    // Of 256: 51.2, 153.6, 51.2; the larger remainder gets the one that is left.
    iir_manager_clear(m);
    const iir_result *r = step_many(m, lights, 3, &budget);
    count_by_light(r, counts, 3);
    assert_int_equal(counts[0], 51);
    assert_int_equal(counts[1], 154);
    assert_int_equal(counts[2], 51);
    assert_power_kept(r);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void a_faint_light_gets_a_point_and_its_turn(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 64);
    iir_budget budget = default_budget(64);
    budget.settle = false;
    ag_light lights[2] = { point_light(-0.5, 0.1, 0.2), point_light(0.5, 0.1, 0.1) };
    int counts[2], remade = 0;
    lights[0].intensity[0] = 1e6f;
    count_by_light(step_many(m, lights, 2, &budget), counts, 2);
    assert_int_equal(counts[0], 63);
    assert_int_equal(counts[1], 1);
    // With a tenth of the power it has a tenth of the turns: 100 steps free 400 points.
    lights[0].intensity[0] = lights[0].intensity[1] = lights[0].intensity[2] = 9;
    for (int i = 0; i < 100; i++) {
        const iir_result *r = step_many(m, lights, 2, &budget);
        assert_power_kept(r);
        for (int n = 0; n < r->count && i >= 10; n++)
            remade += r->vpls[n].fresh && r->vpls[n].light == 1;
    }
    assert_in_range(remade, 34, 38); // 36 in 90
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void a_new_light_shines_at_once(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 64);
    iir_budget budget = default_budget(64);
    budget.recalc_min = 0;
    budget.recalc_max = 2;
    ag_light lights[3] = { point_light(-0.5, 0.1, 0.2), point_light(0.5, 0.1, 0.1),
                           point_light(0.5, 0.6, 0.1) };
    lights[2].intensity[0] = lights[2].intensity[1] = lights[2].intensity[2] = 0.01f;
    step_many(m, lights, 1, &budget);
    for (int i = 0; i < 40; i++)
        assert_power_kept(step_many(m, lights, 3, &budget));
    // And one that goes takes its VPLs along.
    const iir_result *r = step_many(m, lights, 1, &budget);
    assert_true(r->invalid > 0);
    assert_power_kept(r);
    for (int i = 0; i < r->count; i++)
        assert_int_equal(r->vpls[i].light, 0);
    lights[0].intensity[0] = lights[0].intensity[1] = lights[0].intensity[2] = 0;
    r = step_many(m, lights, 1, &budget);
    assert_int_equal(r->count + r->escaped, 0);
    assert_true(r->power == 0 && r->lost == 0);
    r = step_many(m, lights, 0, &budget);
    assert_int_equal(r->count, 0);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void of_more_lights_than_points_the_brightest_count(void **state)
{
    (void) state;
    enum { MANY = 50 };
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 7);
    const iir_budget budget = default_budget(7);
    static ag_light lights[MANY];
    int counts[MANY];
    for (int i = 0; i < MANY; i++) {
        lights[i] = point_light(-0.9 + 0.035 * i, 0.1, 0.2);
        lights[i].intensity[1] = (float) (1 + i * 17 % MANY);
    }
    for (int n = 0; n < 3; n++) {
        const iir_result *r = step_many(m, lights, MANY, &budget);
        assert_int_equal(r->count, 7);
        count_by_light(r, counts, MANY);
        for (int i = 0; i < MANY; i++)
            assert_int_equal(counts[i], i * 17 % MANY >= MANY - 7);
    }
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// ---- slots ------------------------------------------------------------------------------------

// A shadow map is drawn where a VPL is fresh. At any time a VPL finds its own in its slot.
static void over_ten_thousand_steps_no_slot_is_lost(void **state)
{
    (void) state;
    enum { MOST = 24 };
    static uint64_t drawn[MOST];
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, MOST);
    iir_budget budget = default_budget(MOST);
    ag_light lights[2] = { point_light(0, 0, 0), cosine_light(0, 0, 0) };
    int reused = 0;
    for (int i = 0; i < 10000; i++) {
        const int count = i % 97 < 50 ? 2 : i % 97 < 95 ? 1 : 0;
        walk(&lights[0], i * (i % 13));
        walk(&lights[1], 3 * i + 100);
        budget.max_lights = i % 31 < 4 ? 1 + i % MOST : MOST;
        budget.settle = i % 200 < 100;
        budget.mode = i % 501 == 500 ? IIR_ANEW : IIR_INCREMENTAL;
        const iir_result *r = step_many(m, lights, count, &budget);
        for (int n = 0; n < r->count; n++) {
            const iir_vpl *v = &r->vpls[n];
            assert_in_range(v->slot, 0, MOST - 1);
            reused += v->fresh && drawn[v->slot] > 0;
            if (v->fresh)
                drawn[v->slot] = v->birth;
            assert_true(drawn[v->slot] == v->birth);
        }
    }
    assert_true(reused > 10000);
    budget.fill_first = true;
    budget.max_lights = MOST;
    step_many(m, lights, 0, &budget);
    assert_int_equal(step_many(m, lights, 2, &budget)->count, MOST); // all are there still
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// ---- memory -----------------------------------------------------------------------------------

static int allocations;
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);

void *__wrap_malloc(size_t size)
{
    allocations++;
    return __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    allocations++;
    return __real_calloc(count, size);
}

void *__wrap_realloc(void *block, size_t size)
{
    allocations++;
    return __real_realloc(block, size);
}

static void a_steady_step_allocates_nothing(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 256);
    const iir_budget budget = default_budget(256);
    ag_light lights[2] = { point_light(0, 0, 0), cosine_light(0, 0, 0) };
    for (int i = 0; i < 300; i++) {
        walk(&lights[0], i);
        walk(&lights[1], i + 250);
        if (i == 1) // the domains have their sizes
            allocations = 0;
        step_many(m, lights, 2, &budget);
    }
    assert_int_equal(allocations, 0);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// ---- tiles ------------------------------------------------------------------------------------

static int tile_size(int count, int tiles, int t)
{
    return count / tiles + (t < count % tiles);
}

static void every_tile_gets_its_number_of_vpls(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    const int sizes[] = { 1, 5, 16, 63, 64, 100 };
    for (int at = 0; at < FG_COUNT(sizes) * IIR_MAX_TILES * 2; at++) {
        iir_budget budget = default_budget(sizes[at / 2 % FG_COUNT(sizes)]);
        budget.tiles = 1 + at / 2 / FG_COUNT(sizes);
        budget.deal = at % 2 ? IIR_DEAL_CREATION : IIR_DEAL_CURVE;
        iir_manager *m = manage(&logger, scene, 100);
        const ag_light light = point_light(0.3, 0.2, 0.1);
        const iir_result *r = step(m, &light, &budget); // sound: each slot once
        assert_int_equal(r->count, budget.max_lights);
        // By creation the births of a tile are its number and all T after it.
        const int all = budget.tiles * budget.tiles;
        for (int t = 0, i = 0; t < all && budget.deal == IIR_DEAL_CREATION; t++)
            for (int k = 0; k < tile_size(r->count, all, t); k++)
                assert_int_equal(r->vpls[i++].birth, k * all + t);
        iir_manager_destroy(m);
    }
    ag_scene_destroy(scene);
}

// How far the centre of a tile's directions lies off the light: the mean over tiles, the light in
// the middle of a sphere.
static double bias_of_tiles(const iir_result *r, int tiles)
{
    double sum = 0;
    for (int t = 0, i = 0; t < tiles; t++) {
        double mean[3] = { 0 };
        const int count = tile_size(r->count, tiles, t);
        for (int k = 0; k < count; k++, i++)
            for (int c = 0; c < 3; c++)
                mean[c] += r->vpls[i].position[c] / count;
        sum += sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]) / tiles;
    }
    return sum;
}

// Sixteen random directions have a mean 1 / sqrt(16) long; along the curve it is to be less than
// half of that.
static void along_the_curve_every_tile_is_representative(void **state)
{
    (void) state;
    shapes s = shapes_begin(&logger);
    shapes_sphere_inside(&s, shapes_diffuse(&s, 1, 0), 1, 24);
    ag_scene *scene = shapes_end(&s);
    iir_manager *m = manage(&logger, scene, 256);
    iir_budget budget = default_budget(256);
    ag_light light = point_light(0.3, 0, 0);
    for (int i = 0; i <= 100; i++) { // so that births are well mixed
        light.position[0] = 0.3 * (100 - i) / 100;
        light.position[1] = 0.2 * sin(0.06283185307 * i);
        step(m, &light, &budget);
    }
    const iir_result *r = step(m, &light, &budget);
    assert_int_equal(r->count, 256);
    assert_true(bias_of_tiles(r, 16) < 0.125);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// Any 2 x 2 of the 4 x 4 pixels of a block hold VPLs from all around.
static void part_of_the_tiles_is_representative_too(void **state)
{
    (void) state;
    shapes s = shapes_begin(&logger);
    shapes_sphere_inside(&s, shapes_diffuse(&s, 1, 0), 1, 24);
    ag_scene *scene = shapes_end(&s);
    iir_manager *m = manage(&logger, scene, 64);
    const iir_budget budget = default_budget(64);
    const ag_light light = point_light(0, 0, 0);
    const iir_result *r = step(m, &light, &budget);
    double sum = 0;
    for (int corner = 0; corner < 9; corner++) {
        double mean[3] = { 0 };
        for (int i = 0; i < 4; i++) {
            const int t = 4 * (corner / 3 + i / 2) + corner % 3 + i % 2;
            for (int k = 0; k < 4; k++)
                for (int c = 0; c < 3; c++)
                    mean[c] += r->vpls[4 * t + k].position[c] / 16;
        }
        sum += sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]) / 9;
    }
    assert_true(sum < 0.125); // half of what 16 random ones have
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// ---- extremes ---------------------------------------------------------------------------------

static void an_open_sky_is_said_once(void **state)
{
    (void) state;
    ag_scene *scene = open_floor(&logger);
    iir_manager *m = manage(&logger, scene, 32);
    const iir_budget budget = default_budget(32);
    ag_light light = cosine_light(0, 1, 0);
    aim(&light, 0, 1, 0);
    for (int i = 0; i < 5; i++) {
        const iir_result *r = step(m, &light, &budget);
        assert_int_equal(r->count, 0);
        assert_int_equal(r->escaped, 32);
        assert_near(r->lost, r->power, 1e-9);
        light.position[0] += 0.1;
    }
    assert_int_equal(heard.warnings, 1);
    assert_has(heard.warning, "no VPL");
    aim(&light, 0, -1, 0);
    for (int i = 0; i < 5; i++)
        step(m, &light, &budget);
    assert_true(step(m, &light, &budget)->count > 0);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void a_scene_without_surfaces_has_no_vpls(void **state)
{
    (void) state;
    shapes s = shapes_begin(&logger);
    ag_scene *scene = shapes_end(&s);
    iir_manager *m = manage(&logger, scene, 32);
    const iir_budget budget = default_budget(32);
    const ag_light lights[2] = { point_light(0, 0, 0), directional_light(0, -1, 0) };
    const iir_result *r = step_many(m, lights, 2, &budget);
    assert_int_equal(r->count, 0);
    assert_int_equal(r->escaped, 32); // of the point light; the other has nothing to shine on
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void cones_of_none_and_of_all_are_defined(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    const double degrees[] = { 0, 1e-3, 1, 180, 359, 360 };
    for (int i = 0; i < FG_COUNT(degrees); i++) {
        iir_manager *m = manage(&logger, scene, 32);
        const iir_budget budget = default_budget(32);
        ag_light light = spot_light(0.3, 0.1, 0.2, degrees[i]);
        for (int n = 0; n < 10; n++) {
            const iir_result *r = step(m, &light, &budget);
            assert_int_equal(r->count > 0, r->power > 0);
            assert_power_kept(r);
            light.position[0] += 1e-4;
        }
        iir_manager_destroy(m);
    }
    ag_scene_destroy(scene);
}

// On the wall, next to it by less than a float tells, in a corner, inside of a box, on a VPL.
static void a_light_may_be_anywhere(void **state)
{
    (void) state;
    const double places[][3] = {
        { 1, 0.1, 0.2 }, { 1 - 1e-8, 0.1, 0.2 }, { 1 + 1e-8, 0.1, 0.2 },
        { 1, 1, 1 },     { 0, -0.5, 0.3 },       { 0, -1, -1 },
        { 5, 5, 5 },     { 1e6, 0, 0 },          { 1 - 1e-16, -1, 1 - 1e-7 },
        { 0, 0, 0 },
    };
    ag_scene *scene = walled_room(&logger);
    for (int kind = 0; kind < 2; kind++) {
        iir_manager *m = manage(&logger, scene, 48);
        const iir_budget budget = default_budget(48);
        for (int i = 0; i < 3 * FG_COUNT(places); i++) {
            const double *at = places[i * 7 % FG_COUNT(places)];
            const ag_light light =
                kind ? cosine_light(at[0], at[1], at[2]) : point_light(at[0], at[1], at[2]);
            const iir_result *r = step(m, &light, &budget);
            if (r->count + r->escaped > 0)
                assert_power_kept(r);
        }
        ag_light light = point_light(0.4, 0.3, 0.2);
        for (int i = 0; i < 10; i++) {
            const iir_result *r = step(m, &light, &budget);
            assert_true(r->count > 0);
            memcpy(light.position, r->vpls[0].position, sizeof light.position);
        }
        iir_manager_destroy(m);
    }
    ag_scene_destroy(scene);
}

// A light that stands on a wall, to the last bit or beside it, lights the room before it as one
// does that is a little off: half of its rays go into the room.
static void a_light_on_a_wall_lights_the_room(void **state)
{
    (void) state;
    const double gaps[] = { 0, 1e-9, -1e-9, 3e-8 };
    ag_scene *scene = walled_room(&logger);
    for (int i = 0; i < FG_COUNT(gaps); i++) {
        iir_manager *m = manage(&logger, scene, 200);
        const iir_budget budget = default_budget(200);
        ag_light light = point_light(1 - gaps[i], 0.6, 0.2);
        const iir_result *r = step(m, &light, &budget);
        int far_away = 0;
        for (int n = 0; n < r->count; n++)
            far_away += r->vpls[n].position[0] < 1 - 1e-6;
        assert_in_range(far_away, 90, 110);
        light.position[1] += 0.01; // along the wall: they stay valid
        r = step(m, &light, &budget);
        assert_true(r->invalid <= 12); // those next to the horizon, and on the wall itself
        iir_manager_destroy(m);
    }
    ag_scene_destroy(scene);
}

static void any_number_of_vpls_will_do(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    const int sizes[] = { 1, 2, 3, 4096 };
    for (int i = 0; i < FG_COUNT(sizes); i++) {
        iir_manager *m = manage(&logger, scene, sizes[i]);
        const iir_budget budget = default_budget(sizes[i]);
        ag_light light = point_light(0, 0, 0);
        for (int n = 0; n < 8; n++) {
            walk(&light, n);
            assert_power_kept(step(m, &light, &budget));
        }
        iir_manager_destroy(m);
    }
    ag_scene_destroy(scene);
}

// The walled room at a scale: places scale along, all else stays.
static ag_scene *scaled_room(float scale, float offset)
{
    shapes s = shapes_begin(&logger);
    const int white = shapes_diffuse(&s, 1, 0);
    const double at = (double) offset;
    const int node = ag_builder_node(
        s.builder, &(ag_node_desc){ .parent = -1,
                                    .translation = { at, at, at },
                                    .scale = { (double) scale, (double) scale, (double) scale } });
    s.node = node;
    shapes_room(&s, white, (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
    shapes_quad(&s, node, white, (float[]){ 0, -1, -1 }, (float[]){ 0, 1, 0 },
                (float[]){ 0, 0, 2 });
    return shapes_end(&s);
}

static void scale_and_place_of_the_scene_do_not_matter(void **state)
{
    (void) state;
    const float scales[] = { 1, 1e-4f, 1e4f, 1 }, offsets[] = { 0, 0, 0, 1e6f };
    static iir_vpl want[64];
    for (int i = 0; i < FG_COUNT(scales); i++) {
        const double scale = (double) scales[i], offset = (double) offsets[i];
        ag_scene *scene = scaled_room(scales[i], offsets[i]);
        iir_manager *m = manage(&logger, scene, 64);
        const iir_budget budget = default_budget(64);
        ag_light light = point_light(0, 0, 0);
        const iir_result *r = NULL;
        for (int n = 0; n < 20; n++) {
            walk(&light, n);
            for (int k = 0; k < 3; k++)
                light.position[k] = light.position[k] * scale + offset;
            r = step(m, &light, &budget);
            assert_power_kept(r);
        }
        assert_int_equal(r->count, 64);
        for (int n = 0; n < 64; n++) {
            if (i == 0)
                want[n] = r->vpls[n];
            for (int k = 0; k < 3; k++) // floats of size 1, a few roundings; 1e6 in double: 1e-10
                assert_near((r->vpls[n].position[k] - offset) / scale, want[n].position[k], 1e-5);
            assert_near((double) r->vpls[n].area / scale / scale, (double) want[n].area,
                        1e-3 * (double) want[n].area);
            assert_int_equal(r->vpls[n].slot, want[n].slot);
        }
        iir_manager_destroy(m);
        ag_scene_destroy(scene);
    }
}

static void what_a_mask_leaves_out_is_not_hit(void **state)
{
    (void) state;
    shapes s = shapes_begin(&logger);
    const int white = shapes_diffuse(&s, 1, 0);
    ag_material gone = ag_default_material();
    gone.alpha = AG_ALPHA_MASK;
    gone.alpha_cutoff = 0.5f;
    gone.base_color[3] = 0.2f;
    shapes_room(&s, white, (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
    shapes_room(&s, ag_builder_material(s.builder, &gone), (float[]){ -0.5f, -0.5f, -0.5f },
                (float[]){ 0.5f, 0.5f, 0.5f });
    ag_scene *scene = shapes_end(&s);
    iir_manager *m = manage(&logger, scene, 64);
    const iir_budget budget = default_budget(64);
    ag_light light = point_light(0, 0, 0);
    for (int i = 0; i < 20; i++) {
        const iir_result *r = step(m, &light, &budget);
        assert_int_equal(r->count, 64);
        assert_int_equal(r->invalid, 0); // nor does it hide
        for (int n = 0; n < r->count; n++) {
            const double *p = r->vpls[n].position;
            assert_true(fmax(fabs(p[0]), fmax(fabs(p[1]), fabs(p[2]))) > 0.99);
        }
        light.position[0] = 0.02 * i;
    }
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// Walls that stand twice, and ones that a scale of 0 has made flat.
static void degenerate_triangles_are_not_there(void **state)
{
    (void) state;
    shapes s = shapes_begin(&logger);
    const int white = shapes_diffuse(&s, 1, 0);
    shapes_room(&s, white, (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
    shapes_room(&s, white, (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
    const double flat[16] = { 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0.2, 0.2, 0, 1 };
    s.node = ag_builder_node(s.builder, &(ag_node_desc){ .parent = -1, .matrix = flat });
    shapes_room(&s, white, (float[]){ -0.5f, -0.5f, -0.5f }, (float[]){ 0.5f, 0.5f, 0.5f });
    ag_scene *scene = shapes_end(&s);
    iir_manager *m = manage(&logger, scene, 64);
    const iir_budget budget = default_budget(64);
    ag_light light = point_light(0.2, 0.2, -0.7); // in line with what is flat
    for (int i = 0; i < 40; i++) {
        const iir_result *r = step(m, &light, &budget);
        assert_int_equal(r->count, 64);
        assert_power_kept(r);
        for (int n = 0; n < r->count; n++) {
            const double *p = r->vpls[n].position;
            assert_true(fmax(fabs(p[0]), fmax(fabs(p[1]), fabs(p[2]))) > 0.99);
        }
        light.position[0] -= i % 2 ? 0.01 : 0;
    }
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// ---- patches ----------------------------------------------------------------------------------

// The light in the middle: head-on a patch is its cell, and all of them are the room's walls, but
// for how cells bend around corners.
static void patches_add_up_to_the_walls(void **state)
{
    (void) state;
    shapes s = shapes_begin(&logger);
    shapes_room(&s, shapes_diffuse(&s, 1, 0), (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
    ag_scene *scene = shapes_end(&s);
    iir_manager *m = manage(&logger, scene, 1024);
    const iir_budget budget = default_budget(1024);
    const ag_light light = point_light(0, 0, 0);
    const iir_result *r = step(m, &light, &budget);
    double sum = 0;
    for (int i = 0; i < r->count; i++) {
        const iir_vpl *v = &r->vpls[i];
        double cross[3], length = 0, off = 0;
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            cross[k] = (double) v->edges[0][a] * (double) v->edges[1][b] -
                       (double) v->edges[0][b] * (double) v->edges[1][a];
            length += cross[k] * cross[k];
            off += cross[k] * (double) v->normal[k];
        }
        // In the plane of the surface, and as large as `area` says.
        assert_near(sqrt(length), (double) v->area, 1e-5 * (double) v->area);
        assert_near(fabs(off), sqrt(length), 1e-5 * sqrt(length));
        sum += (double) v->area;
    }
    // A cell's size is taken at its point, not over it: some percent.
    assert_near(sum, 24, 0.05 * 24);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void budgets_out_of_range_are_refused(void **state)
{
    (void) state;
    ag_scene *scene = open_floor(&logger);
    iir_manager *m = manage(&logger, scene, 32);
    const ag_light light = point_light(0, 1, 0);
    const iir_lights lights = { .lights = &light, .count = 1 };
    iir_budget wrong[] = { default_budget(33), default_budget(0), default_budget(32),
                           default_budget(32), default_budget(32) };
    static const char *const says[] = { "max_lights is 33, must be in [1, 32]", "max_lights is 0",
                                        "recalc_min is -1", "recalc_max is -2", "tiles is 9" };
    wrong[2].recalc_min = -1;
    wrong[3].recalc_max = -2;
    wrong[4].tiles = 9;
    for (int i = 0; i < FG_COUNT(wrong); i++) {
        const iir_result *r;
        assert_int_equal(iir_manager_step(m, &lights, &wrong[i], &r), FG_ERR_INVALID);
        assert_null(r);
        assert_has(heard.error, says[i]);
    }
    iir_manager *none;
    const iir_manager_desc desc = { .log = &logger, .scene = scene, .max_lights = 4097 };
    assert_int_equal(iir_manager_create(&desc, &none), FG_ERR_INVALID);
    assert_null(none);
    iir_manager_destroy(NULL);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(lights_share_points_by_power, start),
        cmocka_unit_test_setup(a_faint_light_gets_a_point_and_its_turn, start),
        cmocka_unit_test_setup(a_new_light_shines_at_once, start),
        cmocka_unit_test_setup(of_more_lights_than_points_the_brightest_count, start),
        cmocka_unit_test_setup(over_ten_thousand_steps_no_slot_is_lost, start),
        cmocka_unit_test_setup(a_steady_step_allocates_nothing, start),
        cmocka_unit_test_setup(every_tile_gets_its_number_of_vpls, start),
        cmocka_unit_test_setup(along_the_curve_every_tile_is_representative, start),
        cmocka_unit_test_setup(part_of_the_tiles_is_representative_too, start),
        cmocka_unit_test_setup(an_open_sky_is_said_once, start),
        cmocka_unit_test_setup(a_scene_without_surfaces_has_no_vpls, start),
        cmocka_unit_test_setup(cones_of_none_and_of_all_are_defined, start),
        cmocka_unit_test_setup(a_light_may_be_anywhere, start),
        cmocka_unit_test_setup(a_light_on_a_wall_lights_the_room, start),
        cmocka_unit_test_setup(any_number_of_vpls_will_do, start),
        cmocka_unit_test_setup(scale_and_place_of_the_scene_do_not_matter, start),
        cmocka_unit_test_setup(what_a_mask_leaves_out_is_not_hit, start),
        cmocka_unit_test_setup(degenerate_triangles_are_not_there, start),
        cmocka_unit_test_setup(patches_add_up_to_the_walls, start),
        cmocka_unit_test_setup(budgets_out_of_range_are_refused, start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
