// SPDX-License-Identifier: MIT
// VPL management, step by step: what is kept, removed, created, and how strong it is.
#include "iir_rooms.h"

#include <pass/rays.h>

static lines heard;
static fg_log logger;

static int start(void **state)
{
    (void) state;
    logger = log_to(&heard);
    return 0;
}

// ---- intensities (sec. 4.7) -------------------------------------------------------------------

static void vpls_and_the_sky_share_all_of_the_power(void **state)
{
    (void) state;
    ag_scene *rooms[] = { walled_room(&logger), open_floor(&logger) };
    const ag_light kinds[] = { point_light(0, 0, 0), spot_light(0, 0, 0, 70),
                               spot_light(0, 0, 0, 250), cosine_light(0, 0, 0),
                               directional_light(0.2, -1, 0) };
    const int sizes[] = { 1, 2, 3, 100 };
    for (int at = 0; at < 2 * FG_COUNT(kinds) * FG_COUNT(sizes); at++) {
        ag_light light = kinds[at / 2 % FG_COUNT(kinds)];
        light.intensity[0] = 3;
        light.intensity[2] = 0.25f;
        const iir_budget budget = default_budget(sizes[at / 2 / FG_COUNT(kinds)]);
        iir_manager *m = manage(&logger, rooms[at % 2], 100);
        for (int i = 0; i < 60; i++) {
            walk(&light, 7 * i);
            assert_power_kept(step(m, &light, &budget));
        }
        iir_manager_destroy(m);
    }
    for (int i = 0; i < 2; i++)
        ag_scene_destroy(rooms[i]);
}

// Over a floor of 2 x 2 m in its middle, at a height of 1 m, the four walls and the ceiling of the
// cube that the floor belongs to are missing: five sixths of a point light's power are lost.
static void what_misses_the_scene_is_lost_or_given_to_the_rest(void **state)
{
    (void) state;
    ag_scene *scene = open_floor(&logger);
    iir_manager *m = manage(&logger, scene, 1000);
    const ag_light light = point_light(0, 1, 0);
    iir_budget budget = default_budget(1000);
    const iir_result *r = step(m, &light, &budget);
    const double pi = 3.14159265358979323846;
    assert_near(r->power, 4 * pi, 1e-5);
    // The floor's edge is 8/6 sqrt(4 pi / 6) ~ 8 / sqrt(6) radius long and crosses some 90 of the
    // cells, each with 1/1000 of the sphere: half of them at worst are on the wrong side.
    assert_near(r->lost / r->power, 5. / 6, 0.045);
    assert_power_kept(r);
    const double kept = 1 - r->lost / r->power;
    const float flux = r->vpls[0].flux[0];
    budget.rescale = true;
    r = step(m, &light, &budget);
    assert_true(r->lost == 0);
    assert_true(r->escaped > 0);
    assert_near(r->vpls[0].flux[0], (double) flux / kept, 1e-6 * (double) flux / kept);
    assert_power_kept(r);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void colour_is_power_times_albedo(void **state)
{
    (void) state;
    shapes s = shapes_begin(&logger);
    ag_material red = ag_default_material();
    red.base_color[1] = 0.5f;
    red.base_color[2] = 0;
    shapes_room(&s, ag_builder_material(s.builder, &red), (float[]){ -1, -1, -1 },
                (float[]){ 1, 1, 1 });
    ag_scene *scene = shapes_end(&s);
    iir_manager *m = manage(&logger, scene, 64);
    ag_light light = point_light(0, 0, 0);
    light.intensity[0] = 2;
    light.intensity[1] = 3;
    const iir_budget budget = default_budget(64);
    const iir_result *r = step(m, &light, &budget);
    double sum[3] = { 0 };
    assert_int_equal(r->count, 64);
    for (int i = 0; i < r->count; i++)
        for (int k = 0; k < 3; k++)
            sum[k] += (double) r->vpls[i].flux[k];
    const double pi = 3.14159265358979323846;
    assert_near(sum[0], 2 * 4 * pi, 1e-5 * 8 * pi);
    assert_near(sum[1], 0.5 * 3 * 4 * pi, 1e-5 * 6 * pi);
    assert_near(sum[2], 0, 0);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// ---- validity (sec. 4.4) ----------------------------------------------------------------------

// Rounding of positions of size 1 in floats, as the rays have them, with room to spare.
static const double blur = 1e-5;

// By rays of the test's own from the light: the first thing there is the VPL.
static void assert_lit(const ag_rays *rays, const ag_light *light, const iir_result *r)
{
    for (int i = 0; i < r->count; i++) {
        const iir_vpl *v = &r->vpls[i];
        float from[3], to[3];
        double length = 0, facing = 0;
        ag_hit hit;
        for (int k = 0; k < 3; k++) {
            from[k] = (float) light->position[k];
            to[k] = (float) (v->position[k] - light->position[k]);
            length += (double) to[k] * (double) to[k];
            facing -= (double) v->normal[k] * (double) to[k];
        }
        length = sqrt(length);
        assert_true(facing > 0);
        assert_true(ag_rays_nearest(rays, from, to, 0, 2, &hit));
        // Off by the blur across the surface, which the ray meets at `facing` / length.
        if (facing > 0.01 * length)
            assert_near((double) hit.distance * length, length, blur * length / facing);
    }
}

static void a_vpl_is_what_the_light_sees(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    ag_rays *rays;
    const ag_rays_desc desc = { .log = &logger, .scene = scene, .threads = 1 };
    assert_int_equal(ag_rays_create(&desc, &rays), FG_OK);
    for (int spot = 0; spot < 2; spot++) {
        iir_manager *m = manage(&logger, scene, 128);
        ag_light light = spot ? cosine_light(0, 0, 0) : point_light(0, 0, 0);
        const iir_budget budget = default_budget(128);
        int invalid = 0;
        for (int i = 0; i < 500; i++) {
            walk(&light, i);
            const iir_result *r = step(m, &light, &budget);
            assert_lit(rays, &light, r);
            invalid += r->invalid;
        }
        assert_true(invalid > 128); // the wall does hide some
        iir_manager_destroy(m);
    }
    ag_rays_destroy(rays);
    ag_scene_destroy(scene);
}

static void assert_within_cone(const ag_light *light, const iir_vpl *v)
{
    double along = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        const double to = v->position[k] - light->position[k];
        along += to * (double) light->direction[k];
        length += to * to;
    }
    length = sqrt(length);
    // The rim itself is within, and what rounding of the position puts beyond it.
    assert_true(along >= (double) light->cos_outer * length - 1e-5 * length - 0.1 * blur);
}

static void a_vpl_stays_within_the_cone(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 128);
    ag_light light = spot_light(0, 0, 0, 80);
    const iir_budget budget = default_budget(128);
    for (int i = 0; i < 500; i++) {
        walk(&light, i);
        const iir_result *r = step(m, &light, &budget);
        for (int n = 0; n < r->count; n++)
            assert_within_cone(&light, &r->vpls[n]);
    }
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// A spot that shifts by a thousandth of a metre, and so turns its VPLs, a metre away, by a
// thousandth: what it loses in a frame.
static double lost_at_the_rim(ag_scene *scene, double rim)
{
    iir_manager *m = manage(&logger, scene, 128);
    iir_budget budget = default_budget(128);
    ag_light light = spot_light(-0.5, 0.9, 0, 60);
    int lost = 0;
    aim(&light, 0, -1, 0);
    budget.rim = rim;
    for (int i = 0; i < 100; i++) {
        light.position[0] += 0.001;
        lost += step(m, &light, &budget)->invalid;
    }
    iir_manager_destroy(m);
    return lost / 100.0;
}

// About 2 sqrt(pi 128) = 40 of 128 points are along the rim. On it, half of them go with the first
// shift, and of those made anew in each frame, half; a third of an empty circle, 0.03, within, a
// point lasts for 0.03 / 0.002 frames and more.
static void points_within_the_rim_stay(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    assert_true(lost_at_the_rim(scene, 0) > 4);
    assert_true(lost_at_the_rim(scene, 0.35) < 2);
    ag_scene_destroy(scene);
}

// The light steps through the wall from one side to the other: every point on it is on the side
// from which it is lit.
static void a_thin_wall_hides_its_other_side(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 64);
    const iir_budget budget = default_budget(64);
    for (int i = 0; i < 40; i++) {
        const double x = i % 2 ? 0.3 : -0.3;
        const ag_light light = point_light(x, -0.6, 0.1);
        const iir_result *r = step(m, &light, &budget);
        assert_power_kept(r);
        for (int n = 0; n < r->count; n++)
            if (fabs(r->vpls[n].position[0]) < 1e-6)
                assert_true((double) r->vpls[n].normal[0] * x > 0);
    }
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void points_in_the_sky_go_when_something_comes_before_them(void **state)
{
    (void) state;
    ag_scene *scene = open_floor(&logger);
    iir_manager *m = manage(&logger, scene, 200);
    ag_light light = point_light(0, -0.5, 0); // the floor above it
    const iir_budget budget = default_budget(200);
    const iir_result *r = step(m, &light, &budget);
    assert_int_equal(r->invalid, 0);
    const int vpls = r->count;
    assert_in_range(vpls, 40, 100);
    light.position[1] = 0.5; // all of the floor was seen from below; half of the sky is gone
    r = step(m, &light, &budget);
    assert_true(r->invalid >= 2 * vpls);
    for (int i = 0; i < r->count; i++)
        assert_true(r->vpls[i].normal[1] > 0.9f);
    assert_int_equal(r->rays, 200 - vpls + r->created); // no ray for what faces away
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// A light that turns about a point of the floor under the sky: neither the share of the sky nor the
// VPLs jump from step to step.
static void a_sun_keeps_its_share_of_the_sky(void **state)
{
    (void) state;
    ag_scene *scene = open_floor(&logger);
    iir_manager *m = manage(&logger, scene, 400);
    const iir_budget budget = default_budget(400);
    for (int i = 0; i < 100; i++) {
        const double angle = 0.01 * i;
        const ag_light sun = directional_light(sin(angle), -cos(angle), 0);
        const iir_result *r = step(m, &sun, &budget);
        // The disc has the floor's half diagonal for a radius: cos(angle) 4 / (pi 2) of it is
        // floor.
        const double want = 1 - cos(angle) * 4 / (3.14159265358979323846 * 2);
        assert_near(r->lost / r->power, want, 0.05);
        assert_true(r->invalid < 40);
    }
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void there_need_not_be_any_light(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 64);
    const iir_budget budget = default_budget(64);
    const ag_light lamp = point_light(0.3, 0.2, 0.1);
    for (int count = 0; count < 3; count++) { // none, one, none again
        const iir_lights lights = { .lights = &lamp, .count = count % 2 };
        const iir_result *r;
        assert_int_equal(iir_manager_step(m, &lights, &budget, &r), FG_OK);
        assert_int_equal(r->count, 64 * lights.count);
        assert_int_equal(r->point_count, r->count + r->escaped);
    }
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void nothing_is_cast_for_a_light_that_rests(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 64);
    const iir_budget budget = default_budget(64);
    ag_light light = point_light(0.3, 0.2, 0.1);
    for (int i = 0; i < 20; i++) {
        light.intensity[0] = 1 + 0.1f * (float) i; // flickers, but stays where it is
        const iir_result *r = step(m, &light, &budget);
        assert_int_equal(r->rays, r->created);
        assert_power_kept(r);
    }
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void moving_things_neither_hide_nor_make_vpls(void **state)
{
    (void) state;
    ag_scene *scenes[2];
    for (int with = 0; with < 2; with++) {
        shapes s = shapes_begin(&logger);
        const int white = shapes_diffuse(&s, 1, 0);
        shapes_room(&s, white, (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
        if (with) {
            const int node = add_node(s.builder, -1, 0, 0, 0);
            static const float times[] = { 0, 1 }, places[] = { -3, 0, 0, 3, 0, 0 };
            const ag_channel_desc channel = { .node = node,
                                              .path = AG_PATH_TRANSLATION,
                                              .key_count = 2,
                                              .times = times,
                                              .values = places };
            shapes_quad(&s, node, white, (float[]){ 0, -1, -1 }, (float[]){ 0, 2, 0 },
                        (float[]){ 0, 0, 2 });
            ag_builder_channel(s.builder, &channel);
        }
        scenes[with] = shapes_end(&s);
    }
    iir_manager *plain = manage(&logger, scenes[0], 64), *other = manage(&logger, scenes[1], 64);
    const iir_budget budget = default_budget(64);
    ag_light lights[2] = { point_light(0.3, 0.2, 0.1), directional_light(0.1, -1, 0.2) };
    for (int i = 0; i < 20; i++) {
        ag_scene_set_time(scenes[1], 0.05 * i);
        walk(&lights[0], 5 * i);
        const iir_result *a = step_many(plain, lights, 2, &budget);
        const iir_result *b = step_many(other, lights, 2, &budget);
        assert_int_equal(a->count, b->count);
        assert_same_vpls(a->vpls, b->vpls, a->count);
    }
    iir_manager_destroy(plain);
    iir_manager_destroy(other);
    ag_scene_destroy(scenes[0]);
    ag_scene_destroy(scenes[1]);
}

// ---- the budget (sec. 4.2, 4.5, 4.6) ----------------------------------------------------------

static void a_step_makes_no_more_than_its_budget(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 100);
    iir_budget budget = default_budget(100);
    budget.settle = false;
    int before = 0, most = 0;
    for (int i = 0; i < 300; i++) {
        const double angle = i < 200 ? 0.02 * i : 0.3 * i;
        const ag_light light = point_light(0.5 + 0.4 * sin(angle), 0.3 * cos(3 * angle), 0.1);
        const iir_result *r = step(m, &light, &budget);
        const int left = before - r->invalid;
        assert_int_equal(r->deleted, left > 96 ? left - 96 : 0);
        const int room = 100 - left + r->deleted;
        assert_int_equal(r->created, i == 0 ? 100 : room < 8 ? room : 8);
        before = r->count + r->escaped;
        assert_int_equal(before, left - r->deleted + r->created);
        most = r->invalid > most ? r->invalid : most;
    }
    assert_true(most > 8);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void without_fill_a_start_takes_as_long_as_its_budget(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 100);
    iir_budget budget = default_budget(100);
    budget.fill_first = false;
    const ag_light light = point_light(0.4, 0, 0);
    for (int i = 1; i <= 13; i++) {
        const iir_result *r = step(m, &light, &budget);
        assert_int_equal(r->count, i < 13 ? 8 * i : 100);
        assert_power_kept(r);
    }
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// Twelve rooms apart: what was lit is out of sight. Back within ceil(maxLights / recalcMax) steps.
static void a_light_that_jumps_recovers_within_its_budget(void **state)
{
    (void) state;
    shapes s = shapes_begin(&logger);
    const int white = shapes_diffuse(&s, 1, 0);
    shapes_room(&s, white, (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
    shapes_room(&s, white, (float[]){ 11, -1, -1 }, (float[]){ 13, 1, 1 });
    ag_scene *scene = shapes_end(&s);
    iir_manager *m = manage(&logger, scene, 100);
    const iir_budget budget = default_budget(100);
    ag_light light = point_light(0.1, 0.2, 0.3);
    assert_int_equal(step(m, &light, &budget)->count, 100);
    light.position[0] = 12.1;
    for (int i = 1; i <= 13; i++) {
        const iir_result *r = step(m, &light, &budget);
        assert_int_equal(r->invalid, i == 1 ? 100 : 0);
        assert_int_equal(r->count, i < 13 ? 8 * i : 100);
        assert_power_kept(r); // from the first on
    }
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void a_smaller_budget_takes_points_away_at_once(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 256);
    const ag_light light = point_light(0.4, 0, 0);
    iir_budget budget = default_budget(256);
    assert_int_equal(step(m, &light, &budget)->count, 256);
    budget.max_lights = 50;
    const iir_result *r = step(m, &light, &budget);
    assert_in_range(r->count, 46, 50);
    assert_int_equal(r->fresh, r->created);
    assert_power_kept(r);
    budget.max_lights = 256;
    r = step(m, &light, &budget);
    assert_int_equal(r->created, 8);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void without_a_budget_points_are_made_once_and_then_only_die(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 100);
    iir_budget budget = default_budget(100);
    budget.recalc_min = budget.recalc_max = 0;
    ag_light light = point_light(0, 0, 0);
    int before = 0;
    for (int i = 0; i < 100; i++) {
        walk(&light, i);
        const iir_result *r = step(m, &light, &budget);
        assert_int_equal(r->created, i == 0 ? 100 : 0);
        assert_int_equal(r->count, i == 0 ? 100 : before - r->invalid);
        assert_int_equal(r->deleted, 0);
        assert_power_kept(r);
        before = r->count;
    }
    assert_true(before < 100);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// ---- from scratch -----------------------------------------------------------------------------

static void anew_is_incremental_with_all_of_the_budget(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *a = manage(&logger, scene, 90), *b = manage(&logger, scene, 90);
    iir_budget anew = default_budget(90), full = default_budget(90);
    anew.mode = IIR_ANEW;
    full.recalc_min = full.recalc_max = 90;
    full.settle = false;
    ag_light lights[] = { point_light(0, 0, 0), cosine_light(0, 0, 0),
                          directional_light(0.3, -1, 0.1) };
    for (int i = 0; i < 50; i++) {
        const int count = i % 10 == 9 ? 2 : 3;
        walk(&lights[0], 4 * i);
        walk(&lights[1], 4 * i + 250);
        if (i % 7 == 0)
            lights[1].intensity[0] = 0.3f * (float) i;
        const iir_result *x = step_many(a, lights, count, &anew);
        const iir_result *y = step_many(b, lights, count, &full);
        assert_int_equal(x->count, y->count);
        assert_int_equal(x->created, 90);
        assert_int_equal(y->created, 90);
        assert_same_vpls(x->vpls, y->vpls, x->count);
        for (int n = 0; n < x->count; n++) {
            assert_true(x->vpls[n].fresh && y->vpls[n].fresh);
            assert_true(x->vpls[n].birth == y->vpls[n].birth);
        }
    }
    iir_manager_destroy(a);
    iir_manager_destroy(b);
    ag_scene_destroy(scene);
}

// ---- rest -------------------------------------------------------------------------------------

static void assert_rests(iir_manager *m, const ag_light *light, const iir_budget *budget)
{
    static iir_vpl kept[256];
    // Each step moves up to four points; ten times through all is far more than they need.
    const int patience = 20 + 10 * budget->max_lights / 4;
    const iir_result *r = NULL;
    int rests = 0;
    for (int i = 0; i < patience && rests < 3; i++) {
        r = step(m, light, budget);
        rests = r->created == 0 && r->fresh == 0 ? rests + 1 : 0;
    }
    assert_int_equal(rests, 3);
    const int count = r->count;
    memcpy(kept, r->vpls, (size_t) count * sizeof *kept);
    for (int i = 0; i < 10; i++) {
        r = step(m, light, budget);
        assert_int_equal(r->count, count);
        assert_int_equal(r->fresh + r->created + r->deleted + r->rays, 0);
        assert_same_vpls(r->vpls, kept, count);
    }
}

static void a_light_that_rests_comes_to_bits_that_rest(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    for (int size = 1; size <= 200; size += size < 24 ? 1 : 37) {
        iir_manager *m = manage(&logger, scene, size);
        const iir_budget budget = default_budget(size);
        ag_light light = size % 2 ? point_light(0, 0, 0) : cosine_light(0, 0, 0);
        assert_rests(m, &light, &budget);
        for (int i = 0; i < 30; i++) { // and again after a walk
            walk(&light, i);
            step(m, &light, &budget);
        }
        assert_rests(m, &light, &budget);
        light = size % 2 ? cosine_light(0.1, 0.2, 0) : point_light(0.2, 0.3, 0.1);
        assert_rests(m, &light, &budget);
        iir_manager_destroy(m);
    }
    ag_scene_destroy(scene);
}

static void by_the_papers_rule_points_never_rest(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_manager *m = manage(&logger, scene, 64);
    iir_budget budget = default_budget(64);
    budget.settle = false;
    const ag_light light = point_light(0.3, 0.1, 0.2);
    for (int i = 0; i < 100; i++) {
        const iir_result *r = step(m, &light, &budget);
        assert_int_equal(r->created, i == 0 ? 64 : 4);
        assert_int_equal(r->fresh, r->created);
    }
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

// Points are left where they are only while nothing moves.
static void on_its_way_a_light_goes_by_the_papers_rule(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    double sum[2] = { 0 };
    for (int settle = 0; settle < 2; settle++) {
        iir_manager *m = manage(&logger, scene, 128);
        iir_budget budget = default_budget(128);
        budget.settle = settle;
        ag_light light = point_light(0, 0, 0);
        for (int i = 0; i < 600; i++) {
            walk(&light, i);
            sum[settle] += step(m, &light, &budget)->dispersion;
        }
        iir_manager_destroy(m);
    }
    assert_true(sum[1] == sum[0]);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(vpls_and_the_sky_share_all_of_the_power, start),
        cmocka_unit_test_setup(what_misses_the_scene_is_lost_or_given_to_the_rest, start),
        cmocka_unit_test_setup(colour_is_power_times_albedo, start),
        cmocka_unit_test_setup(a_vpl_is_what_the_light_sees, start),
        cmocka_unit_test_setup(a_vpl_stays_within_the_cone, start),
        cmocka_unit_test_setup(points_within_the_rim_stay, start),
        cmocka_unit_test_setup(a_thin_wall_hides_its_other_side, start),
        cmocka_unit_test_setup(points_in_the_sky_go_when_something_comes_before_them, start),
        cmocka_unit_test_setup(a_sun_keeps_its_share_of_the_sky, start),
        cmocka_unit_test_setup(there_need_not_be_any_light, start),
        cmocka_unit_test_setup(nothing_is_cast_for_a_light_that_rests, start),
        cmocka_unit_test_setup(moving_things_neither_hide_nor_make_vpls, start),
        cmocka_unit_test_setup(a_step_makes_no_more_than_its_budget, start),
        cmocka_unit_test_setup(without_fill_a_start_takes_as_long_as_its_budget, start),
        cmocka_unit_test_setup(a_light_that_jumps_recovers_within_its_budget, start),
        cmocka_unit_test_setup(a_smaller_budget_takes_points_away_at_once, start),
        cmocka_unit_test_setup(without_a_budget_points_are_made_once_and_then_only_die, start),
        cmocka_unit_test_setup(anew_is_incremental_with_all_of_the_budget, start),
        cmocka_unit_test_setup(a_light_that_rests_comes_to_bits_that_rest, start),
        cmocka_unit_test_setup(by_the_papers_rule_points_never_rest, start),
        cmocka_unit_test_setup(on_its_way_a_light_goes_by_the_papers_rule, start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
