// SPDX-License-Identifier: MIT
// The gather alone, by a host of passes of its own: receivers of one invocation may not change a
// bit.
#include "fixture.h"

#include <epoxy/gl.h>
#include <pass/gather.h>
#include <pass/gbuffer.h>
#include <string.h>

typedef struct gather_host {
    ag_gpu_scene *gpu;
    fg_graph *graph;
    ag_gbuffer_pass gbuffer;
    ag_rsm_pass rsm;
    ag_vpl_pass vpl;
    ag_gather_pass gathers[3];
} gather_host;

static void run_frame(gather_host *h, ag_scene *scene, int width, int height)
{
    static const char *const prefixes[] = { "one", "four", "sixteen" };
    static const int blocks[] = { 1, 4, 16 };
    ag_view view;
    const fg_frame_desc frame = { .width = width, .height = height, .features = scene->features };
    const ag_gpu_scene_desc desc = { .log = test_log(), .device = device(), .scene = scene };
    assert_int_equal(ag_gpu_scene_create(&desc, &h->gpu), FG_OK);
    h->graph = fg_graph_create(&(fg_graph_desc){ .device = device(), .log = test_log() });
    assert_int_equal(ag_view_from_camera(test_log(), &scene->cameras[0], width, height, &view),
                     FG_OK);
    assert_int_equal(ag_gpu_scene_update(h->gpu, &view), FG_OK);
    fg_graph_begin(h->graph, &frame);
    const ag_scene_res res = ag_gpu_scene_import(h->gpu, h->graph);
    const ag_rsm_desc rsm = { .prefix = "map", .size = 64 };
    const ag_vpl_desc vpl = { .prefix = "map", .pattern = AG_VPL_REGULAR, .grid = 16 };
    ag_gbuffer_declare(&h->gbuffer, h->graph, h->gpu, &res);
    ag_rsm_declare(&h->rsm, h->graph, h->gpu, &res, &rsm);
    ag_vpl_declare(&h->vpl, h->graph, &h->rsm, &vpl);
    for (int i = 0; i < 3; i++) {
        const ag_gather_desc gather = { .prefix = prefixes[i], .block = blocks[i] };
        ag_gather_declare(&h->gathers[i], h->graph, &res, &h->gbuffer.out, &h->vpl, &gather);
        fg_export(h->graph, h->gathers[i].out);
    }
    assert_int_equal(fg_graph_compile(h->graph), FG_OK);
    assert_int_equal(fg_graph_run(h->graph), FG_OK);
}

static void read_gather(const gather_host *h, int i, float *rgba, size_t size)
{
    const uint32_t texture = fg_graph_exported(h->graph, h->gathers[i].out);
    assert_true(texture != 0);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glGetTextureImage(texture, 0, GL_RGBA, GL_FLOAT, (GLsizei) size, rgba);
}

static void receivers_of_an_invocation_share_nothing_but_loads(void **state)
{
    enum { W = 75, H = 41 }; // multiples of no tile
    static float first[4 * W * H], other[4 * W * H];
    (void) state;
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    gather_host h = { 0 };
    run_frame(&h, scene, W, H);
    read_gather(&h, 0, first, sizeof first);
    for (int i = 0; i < W * H; i++)
        assert_true(first[4 * (size_t) i] > 0);
    for (int i = 1; i < 3; i++) {
        memset(other, 0, sizeof other);
        read_gather(&h, i, other, sizeof other);
        // Compilers of shaders may contract differently between permutations: the last bits.
        for (int k = 0; k < 4 * W * H; k++)
            assert_true(other[k] >= first[k] * 0.999995f && other[k] <= first[k] * 1.000005f);
    }
    fg_graph_destroy(h.graph);
    ag_gpu_scene_destroy(h.gpu);
    ag_scene_destroy(scene);
}

static void mistakes_name_pass_value_and_rule(void **state)
{
    (void) state;
    const room_desc room = { 0 };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    ag_gpu_scene *gpu;
    const ag_gpu_scene_desc desc = { .log = test_log(), .device = device(), .scene = scene };
    assert_int_equal(ag_gpu_scene_create(&desc, &gpu), FG_OK);
    fg_graph *g = fg_graph_create(&(fg_graph_desc){ .device = device(), .log = test_log() });
    static ag_rsm_pass rsm;
    static ag_shadow_pass shadow;
    ag_vpl_pass vpl;
    ag_gather_pass gather;
    ag_gbuffer_pass gbuffer;
    for (int mistake = 0; mistake < 4; mistake++) {
        static const char *const messages[] = {
            "map: size is 2048, must lie in [1, 1024]",
            "map: a grid of 12 VPLs does not divide 64 texels",
            "map: block is 3, must be 1, 4 or 16",
            "shadow: size is -1, must lie in [1, 8192] or be 0",
        };
        log_clear();
        fg_graph_begin(g, &(fg_frame_desc){ .width = 8, .height = 8, .features = ~0u });
        const ag_scene_res res = ag_gpu_scene_import(gpu, g);
        ag_gbuffer_declare(&gbuffer, g, gpu, &res);
        const ag_rsm_desc map = { .prefix = "map", .size = mistake == 0 ? 2048 : 64 };
        ag_rsm_declare(&rsm, g, gpu, &res, &map);
        const ag_vpl_desc list = { .prefix = "map",
                                   .pattern = AG_VPL_REGULAR,
                                   .grid = mistake == 1 ? 12 : 8 };
        ag_vpl_declare(&vpl, g, &rsm, &list);
        const ag_gather_desc sum = { .prefix = "map", .block = mistake == 2 ? 3 : 4 };
        ag_gather_declare(&gather, g, &res, &gbuffer.out, &vpl, &sum);
        if (mistake == 3)
            ag_shadow_declare(&shadow, g, gpu, &res, -1);
        assert_int_equal(fg_graph_compile(g), FG_ERR_INVALID);
        assert_non_null(strstr(log_text(), messages[mistake]));
    }
    fg_graph_destroy(g);
    ag_gpu_scene_destroy(gpu);
    ag_scene_destroy(scene);
}

// 18 maps of 2^20 VPLs, 864 MiB: beyond what one dispatch may have on every device.
static void more_vpls_than_the_device_takes_are_refused(void **state)
{
    (void) state;
    static const room_desc room = { 0 };
    const ag_light lamp = { .name = "lamp", .intensity = { 1, 1, 1 } };
    ag_builder *b = room_builder(&room);
    for (int i = 0; i < 3; i++)
        ag_builder_light(b, -1, &lamp);
    ag_scene *scene = finish_scene(b);
    const ag_gpu_scene_desc desc = { .log = test_log(), .device = device(), .scene = scene };
    gather_host h = { 0 };
    assert_int_equal(ag_gpu_scene_create(&desc, &h.gpu), FG_OK);
    h.graph = fg_graph_create(&(fg_graph_desc){ .device = device(), .log = test_log() });
    fg_graph_begin(h.graph, &(fg_frame_desc){ .width = 4, .height = 4 });
    const ag_scene_res res = ag_gpu_scene_import(h.gpu, h.graph);
    log_clear();
    ag_rsm_declare(&h.rsm, h.graph, h.gpu, &res, &(ag_rsm_desc){ .prefix = "map", .size = 1024 });
    ag_vpl_declare(&h.vpl, h.graph, &h.rsm, &(ag_vpl_desc){ .prefix = "map" });
    assert_int_not_equal(fg_graph_compile(h.graph), FG_OK);
    assert_non_null(strstr(log_text(), "map: 18874368 VPLs in 864 MiB, the device takes "));
    fg_graph_destroy(h.graph);
    ag_gpu_scene_destroy(h.gpu);
    ag_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(receivers_of_an_invocation_share_nothing_but_loads),
        cmocka_unit_test(more_vpls_than_the_device_takes_are_refused),
        cmocka_unit_test(mistakes_name_pass_value_and_rule),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
