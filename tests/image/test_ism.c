// SPDX-License-Identifier: MIT
// Imperfect shadow maps: against rays, in rooms that shadow nothing, behind a wall, against the
// reference; shared maps; what must not change the picture.
#include "fixture.h"
#include "metrics.h"
#include "reference.h"
#include "scenes.h"

#include <epoxy/gl.h>
#include <math.h>
#include <pass/gather.h>
#include <pass/gbuffer.h>
#include <pass/ism.h>
#include <pass/math.h>
#include <pass/rays.h>
#include <pass/vpl_shared.h>
#include <string.h>

enum { N = 48 };

static const double pi = 3.14159265358979;

static image indirect(ag_scene *scene, const char *vpls, bool shadows)
{
    const char *const settings[] = { vpls, shadows ? "visibility=ism" : "visibility=none", NULL };
    return render_layer(scene, N, N, LAYER_INDIRECT, plugin_rsm(), settings);
}

// What shadows leave of all light.
static double part_left(ag_scene *scene, const char *vpls)
{
    image none = indirect(scene, vpls, false), ism = indirect(scene, vpls, true);
    const double left = image_mean(&ism) / image_mean(&none);
    image_finish(&none);
    image_finish(&ism);
    return left;
}

// ---- where nothing hides anything ---------------------------------------------------------------

static void convex_rooms_keep_their_light(void **state)
{
    (void) state;
    // No plane hides itself. What is lost is within a texel and a half, 5 to 9 % of the distance,
    // of the room's edges, where a texel's ray goes past the edge: half of the light of a tenth of
    // the walls at worst, of which the bias takes most back.
    const room_desc room = { 0 };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    const double box = part_left(scene, "vpls=256");
    ag_scene_destroy(scene);
    // Chords of a curved wall pass below its discs' rims: those of 8192 stand out by a half of
    // 4 / 8192 of the radius, far less than the bias.
    scene = sphere_scene(32, 0.5f);
    const double sphere = part_left(scene, "vpls=64");
    ag_scene_destroy(scene);
    print_message("left of the light: box %.4f, sphere %.4f\n", box, sphere);
    assert_true(box > 0.98 && box <= 1);
    assert_true(sphere > 0.98 && sphere <= 1);
}

// ---- against rays -------------------------------------------------------------------------------

typedef struct sums {
    double none, rays, ism;          // of all pixels
    double rays2, none_off, ism_off; // squares; of what is off from the rays
} sums;

// Whether a ray reaches the VPL, but for the last thousandth at both ends: the VPL's surface and
// the receiver's own.
static double visible(const ag_rays *rays, const float *p, const float d[3])
{
    return ag_rays_blocked(rays, p, d, 1e-3f, 1 - 1e-3f) ? 0 : 1;
}

static void add_pixel(const capture *c, const ag_rays *rays, size_t i, sums *s)
{
    const ag_vpl *vpls = c[0].bytes;
    const uint32_t count = *(const uint32_t *) c[1].bytes;
    const float *p = c[3].texels + 4 * i, *n = c[4].texels + 4 * i;
    double none = 0, exact = 0;
    for (uint32_t j = 0; j < count; j++) {
        float d[3], d2 = 0, ci = 0, cj = 0;
        for (int k = 0; k < 3; k++) {
            d[k] = vpls[j].position_area[k] - p[k];
            d2 += d[k] * d[k];
            ci += d[k] * n[k];
            cj -= d[k] * vpls[j].normal[k];
        }
        if (ci <= 0 || cj <= 0)
            continue;
        const double spread = pi * (double) d2 + (double) vpls[j].position_area[3];
        const double e = (double) (vpls[j].flux[0] * ci * cj / d2) / spread / pi;
        none += e;
        exact += e * visible(rays, p, d);
    }
    const double ism = (double) c[2].texels[4 * i];
    s->none += none;
    s->rays += exact;
    s->ism += ism;
    s->rays2 += exact * exact;
    s->none_off += (none - exact) * (none - exact);
    s->ism_off += (ism - exact) * (ism - exact);
}

static sums against_rays(ag_scene *scene, const char *points)
{
    const char *const settings[] = { "vpls=256", "clamp=disc", "visibility=ism", points, NULL };
    const double *eye = scene->cameras[0].world + 12;
    const ag_rays_desc desc = { .log = test_log(),
                                .scene = scene,
                                .origin = { eye[0], eye[1], eye[2] } };
    capture c[] = { { .resource = "rsm.vpls" },       { .resource = "rsm.count" },
                    { .resource = "rsm.indirect" },   { .resource = "gbuffer.position" },
                    { .resource = "gbuffer.normal" }, { 0 } };
    ag_rays *rays;
    sums s = { 0 };
    image img = render_captured(scene, N, N, LAYER_INDIRECT, settings, c);
    assert_int_equal(ag_rays_create(&desc, &rays), FG_OK);
    for (size_t i = 0; i < (size_t) N * N; i++)
        if (c[3].texels[4 * i + 3] > 0.5f)
            add_pixel(c, rays, i, &s);
    ag_rays_destroy(rays);
    image_finish(&img);
    captures_finish(c);
    print_message("%s: against rays %.4f of the energy and %.4f off; unshadowed %.4f and %.4f\n",
                  points, s.ism / s.rays, sqrt(s.ism_off / s.rays2), s.none / s.rays,
                  sqrt(s.none_off / s.rays2));
    return s;
}

// Shadows of 256 VPLs, each sharp to a texel and to a disc, a twentieth of its distance: their
// borders cover about a tenth of what is shadowed at all, half of it wrong.
static void maps_say_what_rays_say(void **state)
{
    static const char *const points[] = { "ism_points=2048", "ism_points=8192" };
    (void) state;
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    for (int i = 0; i < FG_COUNT(points); i++) {
        const sums s = against_rays(scene, points[i]);
        assert_true(sqrt(s.none_off / s.rays2) > 0.15);
        assert_true(sqrt(s.ism_off) < 0.15 * sqrt(s.none_off));
        assert_true(fabs(s.ism / s.rays - 1) < 0.1 * (s.none / s.rays - 1));
    }
    ag_scene_destroy(scene);
}

// ---- a wall
// ---------------------------------------------------------------------------------------

// A lit spot on the floor about x = -1 m, within 0.53 m of it; a wall 1 m high at x = 0.5 m, or
// moving there from `far` within a second; a screen at x = 2 m, 2 m high, that the camera sees.
static ag_scene *wall_scene(bool wall, double far)
{
    static const double floor_at[3] = { -2, 0, -2 }, along_x[3] = { 4, 0, 0 },
                        along_z[3] = { 0, 0, 4 }, screen_at[3] = { 2, 0, -2 },
                        two_up[3] = { 0, 2, 0 };
    static const ag_vertex corners[4] = {
        { .position = { 0, 0, -2 }, .normal = { -1, 0, 0 } },
        { .position = { 0, 0, 2 }, .normal = { -1, 0, 0 } },
        { .position = { 0, 1, 2 }, .normal = { -1, 0, 0 } },
        { .position = { 0, 1, -2 }, .normal = { -1, 0, 0 } },
    };
    static const uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    static const float times[3] = { 0, 1, 2 };
    const float places[9] = { (float) (0.5 + far), 0, 0, 0.5f, 0, 0, 0.5f, 0, 0 };
    const ag_primitive_desc quad = {
        .vertices = corners, .vertex_count = 4, .indices = indices, .index_count = 6, .material = -1
    };
    ag_builder *b = ag_builder_create(test_log(), "wall");
    add_quad(b, -1, floor_at, along_z, along_x);
    add_quad(b, -1, screen_at, along_z, two_up);
    if (wall) {
        const int node = ag_builder_node(b, &(ag_node_desc){ .parent = -1 });
        const ag_channel_desc way = {
            .node = node, .key_count = 3, .times = times, .values = places
        };
        ag_builder_show(b, node, ag_builder_primitive(b, &quad), -1);
        ag_builder_channel(b, &way);
    }
    ag_light light = ceiling_spot(10);
    light.position[0] = -1;
    light.position[1] = 3;
    light.position[2] = 0;
    ag_builder_light(b, -1, &light);
    ag_camera camera = plain_camera("screen");
    const double world[16] = { 0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0.6, 1, 0, 1 }; // along +x
    memcpy(camera.world, world, sizeof world);
    ag_builder_camera(b, -1, &camera);
    return finish_scene(b);
}

static image frame_at(ag_scene *scene, double time, const char *visibility)
{
    gi_value values[32];
    renderer *r;
    image img;
    gi_params_default(plugin_rsm(), values);
    assert_int_equal(gi_params_set(test_log(), plugin_rsm(), values, visibility), FG_OK);
    const renderer_desc desc = { .log = test_log(),
                                 .device = device(),
                                 .scene = scene,
                                 .width = N,
                                 .height = N,
                                 .plugin = plugin_rsm(),
                                 .values = values,
                                 .layers = 1u << LAYER_INDIRECT,
                                 .strict = true };
    assert_int_equal(renderer_create(&desc, &r), FG_OK);
    assert_int_equal(renderer_frame(r, 0), FG_OK);
    assert_int_equal(renderer_frame(r, time), FG_OK);
    assert_int_equal(renderer_read(r, LAYER_INDIRECT, &img), FG_OK);
    renderer_destroy(r);
    return img;
}

// What shadows leave of the light on the screen between two heights, in m.
static double left_between(ag_scene *scene, double time, double from, double to)
{
    image none = frame_at(scene, time, "visibility=none");
    image ism = frame_at(scene, time, "visibility=ism");
    double a = 0, b = 0;
    for (int i = 0; i < N * N; i++) {
        // The camera is 1 m up and 1.4 m off the screen; the first row is the upper one.
        const int line = i / N;
        const double row = 1 - 2 * (line + 0.5) / N, column = 2 * (i % N + 0.5) / N - 1;
        const double y = 1 + 1.4 * tan(0.75) * row;
        if (y < from || y > to || fabs(column) > 0.8)
            continue;
        a += (double) none.rgb[3 * (size_t) i];
        b += (double) ism.rgb[3 * (size_t) i];
    }
    image_finish(&none);
    image_finish(&ism);
    assert_true(a > 0);
    return b / a;
}

// The nearest lit point, 0.97 m before the wall, sees the screen above 2.5 m alone, the farthest
// above 1.74 m. A disc and a texel and a half at the wall's upper edge are 0.04 m and 0.16 m, which
// at the screen is 0.4 m at most; 0.1 m above the floor rays are too flat for a map's rim.
static void it_is_dark_behind_a_wall(void **state)
{
    (void) state;
    ag_scene *scene = wall_scene(true, 0);
    const double behind = left_between(scene, 1.5, 0.1, 1.3);
    ag_scene_destroy(scene);
    scene = wall_scene(false, 0);
    const double open = left_between(scene, 1.5, 0.1, 1.9);
    ag_scene_destroy(scene);
    print_message("left: behind the wall %.5f, without it %.5f\n", behind, open);
    assert_true(behind < 0.01);
    assert_true(open > 0.99);
}

static void samples_follow_what_moves(void **state)
{
    (void) state;
    ag_scene *scene = wall_scene(true, -1.4); // at first beyond the lit floor's middle
    const double away = left_between(scene, 1e-3, 0.1, 1.3),
                 there = left_between(scene, 1.5, 0.1, 1.3);
    ag_scene_destroy(scene);
    print_message("left: wall away %.5f, wall there %.5f\n", away, there);
    assert_true(there < 0.01);
    assert_true(away > 0.2);
}

// ---- against the reference
// -----------------------------------------------------------------------

static void cornell_nears_the_shadowed_reference(void **state)
{
    (void) state;
    ag_scene *scene = NULL;
    image truth = { 0 };
    metrics none, ism;
    assert_int_equal(scenes_open(test_log(), "cornell", &scene), FG_OK);
    const reference_desc desc = { .log = test_log(),
                                  .scene = scene,
                                  .camera = &scene->cameras[0],
                                  .width = N,
                                  .height = N,
                                  .bounces = 1,
                                  .spp = 256,
                                  .seed = 1,
                                  .layer = REFERENCE_INDIRECT };
    assert_int_equal(reference_render(&desc, &truth), FG_OK);
    image without = indirect(scene, "vpls=1024", false), with = indirect(scene, "vpls=1024", true);
    assert_int_equal(metrics_compare(test_log(), &without, &truth, &none), FG_OK);
    assert_int_equal(metrics_compare(test_log(), &with, &truth, &ism), FG_OK);
    print_message("relative RMSE %.4f, with maps %.4f; energy %.4f, with maps %.4f\n",
                  none.rmse_rms, ism.rmse_rms, none.energy_ratio, ism.energy_ratio);
    // 1024 VPLs themselves are 8.7 % off and 2 % dark against the unshadowed reference.
    assert_true(ism.rmse_rms < 0.75 * none.rmse_rms);
    assert_true(fabs(ism.energy_ratio - 1) < 0.35 * (none.energy_ratio - 1));
    image_finish(&without);
    image_finish(&with);
    image_finish(&truth);
    ag_scene_destroy(scene);
}

// ---- shared maps
// -----------------------------------------------------------------------------------

typedef struct host {
    ag_gpu_scene *gpu;
    fg_graph *graph;
    ag_ism_samples *samples;
    ag_gbuffer_pass gbuffer;
    ag_rsm_pass rsm;
    ag_vpl_pass vpl;
    ag_ism_pass ism;
    ag_gather_pass gather;
} host;

static void host_finish(host *h)
{
    fg_graph_destroy(h->graph);
    ag_ism_samples_destroy(h->samples);
    ag_gpu_scene_destroy(h->gpu);
}

static void host_declare(host *h, ag_scene *scene, const ag_ism_desc *settings)
{
    const ag_gpu_scene_desc gpu = { .log = test_log(), .device = device(), .scene = scene };
    const ag_ism_samples_desc samples = { .log = test_log(), .scene = scene };
    ag_view view;
    assert_int_equal(ag_gpu_scene_create(&gpu, &h->gpu), FG_OK);
    assert_int_equal(ag_ism_samples_create(&samples, &h->samples), FG_OK);
    h->graph = fg_graph_create(&(fg_graph_desc){ .device = device(), .log = test_log() });
    assert_int_equal(ag_view_from_camera(test_log(), &scene->cameras[0], N, N, &view), FG_OK);
    assert_int_equal(ag_gpu_scene_update(h->gpu, &view), FG_OK);
    fg_graph_begin(h->graph,
                   &(fg_frame_desc){ .width = N, .height = N, .features = scene->features });
    const ag_scene_res res = ag_gpu_scene_import(h->gpu, h->graph);
    const ag_rsm_desc rsm = { .prefix = "map", .size = 64 };
    const ag_vpl_desc vpl = { .prefix = "map", .pattern = AG_VPL_REGULAR, .grid = 16 };
    const ag_gather_desc gather = { .prefix = "map", .visibility = &h->ism };
    ag_gbuffer_declare(&h->gbuffer, h->graph, h->gpu, &res);
    ag_rsm_declare(&h->rsm, h->graph, h->gpu, &res, &rsm);
    ag_vpl_declare(&h->vpl, h->graph, &h->rsm, &vpl);
    ag_ism_desc ism = *settings;
    ism.prefix = "map";
    ism.vpls = h->vpl.vpls;
    ism.count = h->vpl.count;
    ism.capacity = h->vpl.capacity;
    ag_ism_declare(&h->ism, h->graph, h->samples, &res, &ism);
    ag_gather_declare(&h->gather, h->graph, &res, &h->gbuffer.out, &h->vpl, &gather);
    fg_export(h->graph, h->gather.out);
    fg_export(h->graph, h->vpl.vpls);
    fg_export(h->graph, h->vpl.count);
    fg_export(h->graph, h->ism.eyes);
}

static void read_buffer(const host *h, fg_res res, void *out, size_t size)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(fg_graph_exported(h->graph, res), 0, (GLsizeiptr) size, out);
}

// The picture's mean, and the eyes of its maps.
static double shared_mean(ag_scene *scene, int maps, ag_ism_eye *eyes, ag_vpl *vpls,
                          uint32_t *count)
{
    static float rgba[4 * N * N];
    host h = { 0 };
    double sum = 0;
    host_declare(&h, scene, &(ag_ism_desc){ .maps = maps });
    assert_int_equal(fg_graph_compile(h.graph), FG_OK);
    assert_int_equal(fg_graph_run(h.graph), FG_OK);
    read_buffer(&h, h.vpl.vpls, vpls, 256 * sizeof *vpls);
    read_buffer(&h, h.vpl.count, count, 4 * sizeof *count);
    read_buffer(&h, h.ism.eyes, eyes, (size_t) maps * sizeof *eyes);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glGetTextureImage(fg_graph_exported(h.graph, h.gather.out), 0, GL_RGBA, GL_FLOAT, sizeof rgba,
                      rgba);
    for (int i = 0; i < N * N; i++)
        sum += (double) rgba[4 * (size_t) i];
    host_finish(&h);
    return sum;
}

static void neighbours_share_a_map_where_there_are_few(void **state)
{
    enum { FEW = 60, MANY = 256 };
    static ag_ism_eye eyes[MANY];
    static ag_vpl vpls[MANY];
    uint32_t count[4];
    (void) state;
    const room_desc room = { .boxes = true };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    const double all = shared_mean(scene, MANY, eyes, vpls, count);
    assert_in_range(count[0], 150, MANY);
    for (uint32_t m = 0; m < MANY; m++) // of maps beyond the VPLs all is 0
        for (int k = 0; k < 3; k++)
            assert_true(m < count[0] ? eyes[m].normal[k] == vpls[m].normal[k]
                                     : eyes[m].normal[k] == 0);
    const double few = shared_mean(scene, FEW, eyes, vpls, count);
    // Runs of equal length, but for one more in the first: map m has its middle one's eye.
    const uint32_t run = count[0] / FEW, longer = count[0] % FEW;
    for (uint32_t m = 0, first = 0; m < FEW; m++) {
        const uint32_t length = run + (m < longer ? 1 : 0), owner = (2 * first + length) / 2;
        const double scale = 0.5; // view.scale.x: the room's diagonal, 1.73 m, to below 1
        for (int k = 0; k < 3; k++)
            assert_true(fabs((double) eyes[m].position[k] -
                             scale * (double) vpls[owner].position_area[k]) < 1e-6);
        first += length;
    }
    // Three or four VPLs of a row share: up to an eighth of the room's edge from their owner, so
    // that what stands as far from both as the blocks do has its shadow an eighth beside its place.
    print_message("60 maps over 256: %.4f\n", few / all);
    assert_true(fabs(few / all - 1) < 0.08);
    ag_scene_destroy(scene);
}

static void mistakes_name_value_and_rule(void **state)
{
    static const struct {
        ag_ism_desc desc;
        const char *message;
    } cases[] = {
        { { .size = 48 }, "map: ism size is 48, must be 8, 16, 32 or 64" },
        { { .size = 128 }, "map: ism size is 128, must be 8, 16, 32 or 64" },
        { { .points = 1000 }, "map: ism points is 1000, must be a power of two in [256, 32768]" },
        { { .maps = 2049 }, "map: ism maps is 2049, must lie in [1, 2048] or be 0" },
    };
    (void) state;
    const room_desc room = { 0 };
    const ag_light light = ceiling_spot(58);
    ag_scene *scene = room_scene(&room, &light);
    for (int i = 0; i < FG_COUNT(cases); i++) {
        host h = { 0 };
        log_clear();
        host_declare(&h, scene, &cases[i].desc);
        assert_int_equal(fg_graph_compile(h.graph), FG_ERR_INVALID);
        assert_non_null(strstr(log_text(), cases[i].message));
        host_finish(&h);
    }
    ag_ism_samples *samples;
    const ag_ism_samples_desc three = { .log = test_log(), .scene = scene, .count = 3 };
    log_clear();
    assert_int_equal(ag_ism_samples_create(&three, &samples), FG_ERR_INVALID);
    assert_null(samples);
    assert_non_null(strstr(log_text(), "ism: 3 samples, must be a power of two in [1, 1048576]"));
    ag_scene_destroy(scene);
}

// ---- what must not change it, and nothing to do
// -----------------------------------------------------

static image scaled(double edge)
{
    const room_desc room = { .edge = edge, .boxes = true };
    ag_light light = ceiling_spot(58);
    for (int k = 0; k < 3; k++)
        light.intensity[k] = (float) (edge * edge); // E = I / r^2 stays as it is
    ag_scene *scene = room_scene(&room, &light);
    image img = indirect(scene, "vpls=64", true);
    ag_scene_destroy(scene);
    return img;
}

static void scale_does_not_matter(void **state)
{
    (void) state;
    static const double edges[] = { 1e-4, 1.01, 1e4 };
    image one = scaled(1);
    for (int i = 0; i < FG_COUNT(edges); i++) {
        image other = scaled(edges[i]);
        metrics m;
        assert_int_equal(metrics_compare(test_log(), &other, &one, &m), FG_OK);
        // Places round differently, by 1e-7 of the room: a hundred of 65536 samples fall to the
        // next part of their triangle, and single texels of some map tip over.
        assert_true(m.rmse_rms < 0.01);
        assert_true(fabs(m.energy_ratio - 1) < 1e-3);
        image_finish(&other);
    }
    image_finish(&one);
}

static void same_frame_twice_is_bit_identical(void **state)
{
    (void) state;
    image a = scaled(1), b = scaled(1);
    assert_memory_equal(a.rgb, b.rgb, sizeof(float) * 3 * N * N);
    image_finish(&a);
    image_finish(&b);
}

static void without_vpls_or_surfaces_there_is_exactly_nothing(void **state)
{
    (void) state;
    const room_desc room = { .boxes = true };
    ag_light black = ceiling_spot(58);
    memset(black.intensity, 0, sizeof black.intensity);
    ag_builder *b = ag_builder_create(test_log(), "nothing");
    const ag_light lit = ceiling_spot(58);
    const ag_camera camera = plain_camera("nowhere");
    ag_builder_light(b, -1, &lit);
    ag_builder_camera(b, -1, &camera);
    ag_scene *scenes[3] = { room_scene(&room, &black), room_scene(&room, NULL), finish_scene(b) };
    for (int s = 0; s < 3; s++) {
        const char *const settings[] = { "visibility=ism", NULL };
        image img = render_layer(scenes[s], 16, 16, LAYER_RADIANCE, plugin_rsm(), settings);
        for (int i = 0; i < 3 * 16 * 16; i++)
            assert_true(img.rgb[i] == 0);
        image_finish(&img);
        ag_scene_destroy(scenes[s]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(convex_rooms_keep_their_light),
        cmocka_unit_test(maps_say_what_rays_say),
        cmocka_unit_test(it_is_dark_behind_a_wall),
        cmocka_unit_test(samples_follow_what_moves),
        cmocka_unit_test(cornell_nears_the_shadowed_reference),
        cmocka_unit_test(neighbours_share_a_map_where_there_are_few),
        cmocka_unit_test(mistakes_name_value_and_rule),
        cmocka_unit_test(scale_does_not_matter),
        cmocka_unit_test(same_frame_twice_is_bit_identical),
        cmocka_unit_test(without_vpls_or_surfaces_there_is_exactly_nothing),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
