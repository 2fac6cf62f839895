// SPDX-License-Identifier: MIT
// VPL management on a thread of its own. Run under ThreadSanitizer by ./test.sh tsan.
#include "iir_rooms.h"

#include <time.h>

static lines heard;
static fg_log logger;

static int start(void **state)
{
    (void) state;
    logger = log_to(&heard);
    return 0;
}

static iir_worker *work(const ag_scene *scene, int max_lights)
{
    iir_worker *w = NULL;
    const iir_manager_desc desc = {
        .log = &logger, .scene = scene, .max_lights = max_lights, .blur = 16
    };
    assert_non_null(scene);
    assert_int_equal(iir_worker_create(&desc, &w), FG_OK);
    return w;
}

static const iir_result *frame(iir_worker *w, const ag_light *light, const iir_budget *budget,
                               int delay)
{
    // What was handed in may be gone right after the call.
    ag_light lent = *light;
    const iir_lights lights = { .lights = &lent, .count = 1 };
    const iir_result *r = NULL;
    assert_int_equal(iir_worker_frame(w, &lights, budget, delay, &r), FG_OK);
    memset(&lent, 0xff, sizeof lent);
    assert_sound(r, budget->max_lights);
    return r;
}

static void assert_same(const iir_result *a, const iir_result *b)
{
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->escaped, b->escaped);
    assert_int_equal(a->created, b->created);
    assert_int_equal(a->invalid, b->invalid);
    assert_same_vpls(a->vpls, b->vpls, a->count);
    for (int i = 0; i < a->count; i++)
        assert_true(a->vpls[i].fresh == b->vpls[i].fresh);
}

// One call after the other: the first gives its own step and starts another one, every later one
// gives what the call before has started.
static void a_frame_gives_the_step_of_the_call_before(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_worker *w = work(scene, 100);
    iir_manager *m = manage(&logger, scene, 100);
    const iir_budget budget = default_budget(100);
    ag_light light = point_light(0, 0, 0), before = light;
    for (int i = 0; i < 100; i++) {
        before = i > 0 ? light : before;
        walk(&light, 3 * i);
        const iir_result *want = step(m, i > 0 ? &before : &light, &budget);
        assert_same(frame(w, &light, &budget, 1), want);
    }
    iir_worker_destroy(w);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void without_delay_a_frame_gives_its_own_step(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_worker *w = work(scene, 100);
    iir_manager *m = manage(&logger, scene, 100);
    const iir_budget budget = default_budget(100);
    ag_light light = cosine_light(0, 0, 0);
    for (int i = 0; i < 100; i++) {
        walk(&light, 3 * i);
        const iir_result *want = step(m, &light, &budget);
        assert_same(frame(w, &light, &budget, 0), want);
    }
    iir_worker_destroy(w);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void let_the_job_end(void)
{
    nanosleep(&(struct timespec){ .tv_nsec = 30000000 }, NULL);
}

static void what_was_given_stays_while_the_next_one_is_made(void **state)
{
    (void) state;
    static iir_vpl kept[100];
    ag_scene *scene = walled_room(&logger);
    iir_worker *w = work(scene, 100);
    const iir_budget budget = default_budget(100);
    ag_light light = point_light(0, 0, 0);
    for (int i = 0; i < 6; i++) {
        walk(&light, 20 * i);
        const iir_result *r = frame(w, &light, &budget, 1);
        const iir_result whole = *r;
        const int count = r->count;
        memcpy(kept, r->vpls, (size_t) count * sizeof *kept);
        let_the_job_end();
        assert_memory_equal(r, &whole, sizeof whole);
        assert_memory_equal(r->vpls, kept, (size_t) count * sizeof *kept);
    }
    iir_worker_destroy(w);
    ag_scene_destroy(scene);
}

static void draw_fresh(const iir_result *r, uint64_t *drawn)
{
    for (int i = 0; i < r->count; i++) {
        const iir_vpl *v = &r->vpls[i];
        if (v->fresh)
            drawn[v->slot] = v->birth + 1;
        assert_true(drawn[v->slot] == v->birth + 1);
    }
}

// Delay, budget and mode change at any time. The maps are drawn for what is fresh, and at any time
// a VPL finds its own in its slot; the same calls give the same results.
static void switches_lose_no_map_and_change_no_result(void **state)
{
    (void) state;
    enum { MOST = 60 };
    static uint64_t drawn[2][MOST];
    ag_scene *scene = walled_room(&logger);
    iir_worker *pair[2] = { work(scene, MOST), work(scene, MOST) };
    iir_budget budget = default_budget(MOST);
    ag_light light = point_light(0, 0, 0);
    for (int i = 0; i < 400; i++) {
        const iir_result *r[2];
        walk(&light, 5 * i);
        budget.max_lights = i % 23 < 9 ? 20 : MOST;
        budget.mode = i % 57 == 56 ? IIR_ANEW : IIR_INCREMENTAL;
        for (int n = 0; n < 2; n++) {
            const ag_light lent = light;
            const iir_lights lights = { .lights = &lent, .count = 1 };
            assert_int_equal(iir_worker_frame(pair[n], &lights, &budget, i % 7 < 4, &r[n]), FG_OK);
            assert_sound(r[n], MOST);
            draw_fresh(r[n], drawn[n]);
            if (i % 50 == 49)
                let_the_job_end();
        }
        assert_same(r[0], r[1]);
    }
    iir_worker_destroy(pair[0]);
    iir_worker_destroy(pair[1]);
    ag_scene_destroy(scene);
}

static void an_error_comes_out_of_the_next_frame(void **state)
{
    (void) state;
    ag_scene *scene = walled_room(&logger);
    iir_worker *w = work(scene, 32);
    iir_budget budget = default_budget(32);
    ag_light light = point_light(0.3, 0, 0);
    const iir_lights lights = { .lights = &light, .count = 1 };
    const iir_result *r;
    frame(w, &light, &budget, 1);
    budget.max_lights = 33;
    assert_int_equal(iir_worker_frame(w, &lights, &budget, 1, &r), FG_OK);
    let_the_job_end();
    assert_int_equal(heard.errors, 0); // it speaks with the caller's voice only
    budget.max_lights = 32;
    assert_int_equal(iir_worker_frame(w, &lights, &budget, 1, &r), FG_ERR_INVALID);
    assert_null(r);
    assert_has(heard.error, "max_lights is 33");
    assert_int_equal(frame(w, &light, &budget, 1)->count, 32);
    assert_int_equal(frame(w, &light, &budget, 1)->count, 32);
    iir_worker_destroy(w);
    ag_scene_destroy(scene);
}

// Slides over what it is put on, and flickers.
static int moving_material(shapes *s, ag_alpha alpha)
{
    static const uint8_t texels[16] = { 255, 0, 0,   255, 0,   255, 0,   0,
                                        0,   0, 255, 255, 255, 255, 255, 0 };
    static const float times[] = { 0, 1 }, slide[] = { 0, 0, 1, 1 }, glow[] = { 0, 1, 0, 5, 0, 0 };
    ag_texture texture = { .name = "texels", .width = 2, .height = 2, .rgba = texels };
    ag_material m = ag_default_material();
    m.base_color_tex.texture = ag_builder_texture(s->builder, &texture);
    m.alpha = alpha;
    const int material = ag_builder_material(s->builder, &m);
    ag_channel_desc c = {
        .path = AG_PATH_UV_OFFSET, .key_count = 2, .times = times, .values = slide
    };
    c.material = material;
    ag_builder_channel(s->builder, &c);
    c.path = AG_PATH_EMISSIVE;
    c.values = glow;
    ag_builder_channel(s->builder, &c);
    return material;
}

static ag_scene *room_with_a_moving_wall(void)
{
    static const float times[] = { 0, 1 }, places[] = { -1, 0, 0, 1, 0, 0 };
    shapes s = shapes_begin(&logger);
    const int white = shapes_diffuse(&s, 1, 0), node = add_node(s.builder, -1, 0, 0, 0);
    const ag_channel_desc channel = {
        .node = node, .path = AG_PATH_TRANSLATION, .key_count = 2, .times = times, .values = places
    };
    shapes_room(&s, white, (float[]){ -1, -1, -1 }, (float[]){ 1, 1, 1 });
    shapes_quad(&s, node, white, (float[]){ 0, -1, -1 }, (float[]){ 0, 2, 0 },
                (float[]){ 0, 0, 2 });
    // Before a wall, and a screen in the room whose holes wander.
    shapes_quad(&s, s.node, moving_material(&s, AG_ALPHA_OPAQUE), (float[]){ -0.9f, -1, -1 },
                (float[]){ 0, 0, 2 }, (float[]){ 0, 2, 0 });
    shapes_quad(&s, s.node, moving_material(&s, AG_ALPHA_MASK), (float[]){ -1, -0.5f, -1 },
                (float[]){ 0, 0, 2 }, (float[]){ 2, 0, 0 });
    ag_builder_channel(s.builder, &channel);
    return shapes_end(&s);
}

static void the_scene_may_move_on_meanwhile(void **state)
{
    (void) state;
    ag_scene *scene = room_with_a_moving_wall();
    iir_worker *w = work(scene, 500);
    iir_manager *m = manage(&logger, scene, 500);
    const iir_budget budget = default_budget(500);
    ag_light light = point_light(0, 0, 0);
    for (int i = 0; i < 50; i++) {
        const ag_light before = light;
        walk(&light, 3 * i);
        const iir_result *r = frame(w, &light, &budget, 1);
        for (int n = 0; n < 50; n++)
            ag_scene_set_time(scene, 0.02 * i + 1e-4 * n);
        assert_same(r, step(m, i > 0 ? &before : &light, &budget));
    }
    iir_worker_destroy(w);
    iir_manager_destroy(m);
    ag_scene_destroy(scene);
}

static void workers_may_end_amid_a_step_and_scenes_be_switched(void **state)
{
    (void) state;
    for (int i = 0; i < 20; i++) {
        ag_scene *scene = i % 2 ? room_with_a_moving_wall() : walled_room(&logger);
        iir_worker *w = work(scene, 1000);
        iir_budget budget = default_budget(1000);
        ag_light light = point_light(0.2, 0, 0);
        budget.mode = IIR_ANEW; // long steps
        for (int n = 0; n < i % 3; n++) {
            walk(&light, n);
            frame(w, &light, &budget, 1);
        }
        iir_worker_destroy(w);
        ag_scene_destroy(scene);
    }
    iir_worker_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_frame_gives_the_step_of_the_call_before, start),
        cmocka_unit_test_setup(without_delay_a_frame_gives_its_own_step, start),
        cmocka_unit_test_setup(what_was_given_stays_while_the_next_one_is_made, start),
        cmocka_unit_test_setup(switches_lose_no_map_and_change_no_result, start),
        cmocka_unit_test_setup(an_error_comes_out_of_the_next_frame, start),
        cmocka_unit_test_setup(the_scene_may_move_on_meanwhile, start),
        cmocka_unit_test_setup(workers_may_end_amid_a_step_and_scenes_be_switched, start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
