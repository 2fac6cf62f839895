// SPDX-License-Identifier: MIT
// Bias compensation in a corner of two lit walls, against the form factor of a rectangle, and what
// else bounds VPLs beside it.
#include "fixture.h"

#include <epoxy/gl.h>
#include <math.h>
#include <pass/compensate.h>
#include <pass/gather.h>
#include <pass/gbuffer.h>
#include <pass/lighting.h>
#include <pass/vpl_shared.h>
#include <string.h>

static const double pi = 3.14159265358979;

// A floor y = 0 and a wall z = 0, 2 m by 2 m from their common edge on, of albedo 1/2 under a sun
// of 4 W/m^2 at 45 degrees to both: B = sqrt(2) W/m^2 everywhere.
enum { GRID = 8, VPLS = 2 * GRID * GRID, EDGE = 128 };

// What a corner may differ in.
typedef struct corner_desc {
    double scale;
    bool emissive, orthographic;
} corner_desc;

static ag_scene *corner_scene(const corner_desc *desc)
{
    const double s = desc->scale, half = 0.5 * sqrt(2);
    const double at[3] = { -s, 0, 0 }, x[3] = { 2 * s, 0, 0 }, up[3] = { 0, 2 * s, 0 },
                 out[3] = { 0, 0, 2 * s };
    ag_builder *b = ag_builder_create(test_log(), "corner");
    ag_material grey = ag_default_material();
    grey.metallic = 0;
    for (int k = 0; k < 3; k++)
        grey.base_color[k] = 0.5f;
    for (int k = 0; k < 3 && desc->emissive; k++)
        grey.emissive[k] = 100;
    const int material = ag_builder_material(b, &grey);
    add_quad(b, material, at, out, x);
    add_quad(b, material, at, x, up);
    const ag_light sun = { .kind = AG_LIGHT_DIRECTIONAL,
                           .direction = { 0, (float) -half, (float) -half },
                           .intensity = { 4, 4, 4 } };
    // From the middle between the walls, 1.3 m from the edge.
    ag_camera camera = plain_camera("corner");
    const double world[16] = { 1, 0,    0,    0, 0,         half,     -half,    0,
                               0, half, half, 0, 0.013 * s, 0.92 * s, 0.92 * s, 1 };
    memcpy(camera.world, world, sizeof world);
    camera.yfov = 0.9f;
    camera.znear = (float) (0.01 * s);
    camera.zfar = (float) (10 * s);
    camera.orthographic = desc->orthographic;
    camera.half_height = (float) (0.62 * s);
    ag_builder_light(b, -1, &sun);
    ag_builder_camera(b, -1, &camera);
    return finish_scene(b);
}

// Form factor from the point (x, h) of one wall to the other, 2 m by 2 m from the edge on. Lambert:
// of the edges of the rectangle those through the edge's line and the one across from it have a
// part.
static double truth(double x, double h)
{
    const double near_angle = atan((1 - x) / h) + atan((1 + x) / h), r = sqrt(h * h + 4);
    const double far_angle = atan((1 - x) / r) + atan((1 + x) / r);
    return (near_angle - h / r * far_angle) / (2 * pi);
}

typedef struct corner {
    double cell; // edge of a VPL's, m
    ag_scene *scene;
    ag_gpu_scene *gpu;
    ag_view view;
    fg_graph *graph;
    uint32_t buffers[2];
    ag_gbuffer_pass gbuffer;
    ag_shadow_pass shadow;
    ag_direct_pass direct;
    ag_split_pass split;
    ag_vpl_pass vpl;
    ag_gather_pass gather;
    ag_combine_pass combine;
    ag_compensate_pass compensate;
    ag_box_filter_pass filter;
} corner;

static double fraction(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

// One VPL a square cell, at a random place in it, with a patch of the cell's size about it.
static void place_vpls(const corner *c, uint32_t seed)
{
    static ag_vpl vpls[VPLS];
    const double cell = c->cell;
    for (int i = 0; i < VPLS; i++) {
        const int at = i * 37 % VPLS; // dealt out: no tile has neighbours alone
        const int wall = at / (GRID * GRID), u = at % GRID, v = at / GRID % GRID;
        const double x = (u + fraction(&seed) - 0.5 * GRID) * cell,
                     a = (v + fraction(&seed)) * cell;
        const double p[3] = { x, wall ? a : 0, wall ? 0 : a };
        ag_vpl_patch patch = { .area = (float) (cell * cell), .edges = { { (float) cell } } };
        patch.edges[1][wall ? 1 : 2] = (float) cell;
        patch.normal[1 + wall] = 1;
        for (int k = 0; k < 3; k++) {
            patch.position[k] = (float) (p[k] - c->view.origin[k]);
            patch.flux[k] = (float) (sqrt(2) * cell * cell);
        }
        ag_vpl_from_host(&patch, &vpls[i]);
    }
    glNamedBufferSubData(c->buffers[0], 0, sizeof vpls, vpls);
}

static const corner_desc plain = { .scale = 1 };

static void corner_init(corner *c, const corner_desc *d)
{
    const uint32_t count[4] = { VPLS };
    *c = (corner){ .cell = 2 * d->scale / GRID, .scene = corner_scene(d) };
    const ag_gpu_scene_desc desc = { .log = test_log(), .device = device(), .scene = c->scene };
    assert_int_equal(ag_gpu_scene_create(&desc, &c->gpu), FG_OK);
    assert_int_equal(ag_view_from_camera(test_log(), &c->scene->cameras[0], EDGE, EDGE, &c->view),
                     FG_OK);
    assert_int_equal(ag_gpu_scene_update(c->gpu, &c->view), FG_OK);
    glCreateBuffers(2, c->buffers);
    glNamedBufferStorage(c->buffers[0], VPLS * sizeof(ag_vpl), NULL, GL_DYNAMIC_STORAGE_BIT);
    glNamedBufferStorage(c->buffers[1], sizeof count, count, 0);
    c->graph = fg_graph_create(&(fg_graph_desc){ .device = device(), .log = test_log() });
    assert_non_null(c->graph);
}

static void corner_finish(corner *c)
{
    fg_graph_destroy(c->graph);
    glDeleteBuffers(2, c->buffers);
    ag_gpu_scene_destroy(c->gpu);
    ag_scene_destroy(c->scene);
}

// How a frame is lit. Areas over the bound are in cells: 1 is a bound of 1 / A.
typedef struct way {
    ag_clamp clamp;
    double areas; // GEOMETRY: 1 / (b A)
    bool compensate;
    int tiles; // 0: 1
} way;

static void declare(corner *c, const way *w)
{
    const int tiles = w->tiles > 0 ? w->tiles : 1;
    const double bound = w->areas > 0 ? 1 / (w->areas * c->cell * c->cell) : 0;
    const fg_buf_desc vpls = { .size = VPLS * sizeof(ag_vpl) }, count = { .size = 16 };
    fg_graph *g = c->graph;
    fg_graph_begin(g, &(fg_frame_desc){ EDGE, EDGE, .features = c->scene->features });
    const ag_scene_res res = ag_gpu_scene_import(c->gpu, g);
    const ag_gather_desc gather = {
        .prefix = "t", .clamp = w->clamp, .clamp_g = (float) bound, .split = &c->split
    };
    c->vpl = (ag_vpl_pass){ .vpls = fg_import_buffer(g, "t.vpls", &vpls, c->buffers[0]),
                            .count = fg_import_buffer(g, "t.count", &count, c->buffers[1]),
                            .capacity = VPLS };
    ag_gbuffer_declare(&c->gbuffer, g, c->gpu, &res);
    const ag_gbuffer *gbuffer = &c->gbuffer.out;
    ag_shadow_declare(&c->shadow, g, c->gpu, &res, 0);
    const ag_direct_desc direct = { &res, gbuffer, c->shadow.maps, 0 };
    ag_direct_declare(&c->direct, g, c->gpu, &direct);
    ag_split_declare(&c->split, g, &res, gbuffer, &(ag_split_desc){ "t", tiles, EDGE, EDGE });
    ag_gather_declare(&c->gather, g, &res, gbuffer, &c->vpl, &gather);
    ag_combine_declare(&c->combine, g, &c->split, c->gather.out);
    c->compensate.out = c->combine.out;
    const ag_compensate_desc compensate = {
        .prefix = "t",
        .in = c->combine.out,
        .direct = c->direct.out,
        .bound = (float) bound,
        .tiles = tiles,
        .width = EDGE,
        .height = EDGE,
    };
    if (w->compensate)
        ag_compensate_declare(&c->compensate, g, &res, gbuffer, &compensate);
    ag_box_filter_declare(&c->filter, g, &c->split, c->compensate.out,
                          &(ag_box_filter_desc){ .alpha = 0.01f, .beta = 0.8f });
    fg_export(g, c->filter.out);
    fg_export(g, gbuffer->position);
}

static void read_texture(const corner *c, fg_res res, float *texels)
{
    glGetTextureImage(fg_graph_exported(c->graph, res), 0, GL_RGBA, GL_FLOAT,
                      (GLsizei) ((size_t) 4 * EDGE * EDGE * sizeof *texels), texels);
}

// One frame: E / pi, and positions.
static void take(corner *c, const way *w, uint32_t seed, float light[][4], float position[][4])
{
    place_vpls(c, seed);
    log_clear();
    declare(c, w);
    if (fg_graph_compile(c->graph) || fg_graph_run(c->graph))
        fail_msg("%s", log_text());
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    read_texture(c, c->filter.out, light[0]);
    read_texture(c, c->gbuffer.out.position, position[0]);
}

// Bins by distance from the edge, in cells.
enum { BINS = 7 };
static const double limits[BINS + 1] = { 0, 0.125, 0.25, 0.5, 0.75, 1, 1.5, 2 };

static int bin_of(double cells)
{
    int b = 0;
    while (b < BINS && cells >= limits[b + 1])
        b++;
    return b;
}

// Light over the truth in each bin, of pixels and VPLs of several seeds together.
static void ratios(corner *c, const way *w, double ratio[BINS])
{
    enum { SEEDS = 6 };
    static float light[EDGE * EDGE][4], position[EDGE * EDGE][4];
    double sum[BINS + 1] = { 0 };
    int count[BINS + 1] = { 0 };
    for (int s = 0; s < SEEDS; s++) {
        take(c, w, (uint32_t) s, light, position);
        for (int i = 0; i < EDGE * EDGE; i++) {
            double p[3]; // m of the unscaled corner
            for (int k = 0; k < 3; k++)
                p[k] = ((double) position[i][k] + c->view.origin[k]) * 2 / (c->cell * GRID);
            const double h = p[1] > p[2] ? p[1] : p[2];
            if (position[i][3] < 0.5f || fabs(p[0]) > 0.5)
                continue;
            const int b = bin_of(h * GRID / 2);
            sum[b] += (double) light[i][0] * pi / (sqrt(2) * truth(p[0], h));
            count[b]++;
        }
    }
    for (int b = 0; b < BINS; b++) {
        assert_true(count[b] > 0);
        ratio[b] = sum[b] / count[b];
        print_message(" %.3f", ratio[b]);
    }
    print_message("\n");
}

// ---- facts --------------------------------------------------------------------------------------

static void compensation_lights_the_rim(void **state)
{
    static const corner_desc views[] = { { .scale = 1 }, { .scale = 1, .orthographic = true } };
    static const double areas[] = { 4, 16 };
    (void) state;
    for (int v = 0; v < FG_COUNT(views); v++) {
        corner c;
        corner_init(&c, &views[v]);
        for (int a = 0; a < FG_COUNT(areas); a++) {
            const way dark = { AG_CLAMP_GEOMETRY, areas[a], false, 4 };
            const way lit = { AG_CLAMP_GEOMETRY, areas[a], true, 4 };
            double without[BINS], with[BINS];
            ratios(&c, &dark, without);
            ratios(&c, &lit, with);
            // b A = 1 / 4: within an eighth of a cell, 3 cm, from the edge most of the light is of
            // surfaces that are nearer than b allows.
            assert_true(without[0] < 0.4);
            // Nothing is hidden here. What is left is noise: of pixels that see 128 VPLs and 384
            // samples, some hundred of them on their own in a bin.
            for (int b = 0; b < BINS; b++)
                assert_true(fabs(with[b] - 1) < 0.05);
        }
        corner_finish(&c);
    }
}

static void patches_leave_the_rim_darker(void **state)
{
    // A patch about a place near the edge reaches behind the other wall, where it lights nothing; a
    // disc is not even seen from beside.
    static const way ways[] = { { AG_CLAMP_FOOTPRINT }, { AG_CLAMP_DISC } };
    (void) state;
    corner c;
    corner_init(&c, &plain);
    for (int i = 0; i < FG_COUNT(ways); i++) {
        double ratio[BINS];
        ratios(&c, &ways[i], ratio);
        assert_true(ratio[0] < 0.75);
    }
    corner_finish(&c);
}

static void compare(const way *w, const corner_desc *a, const corner_desc *b, double tolerance)
{
    static float light[2][EDGE * EDGE][4], position[EDGE * EDGE][4];
    for (int i = 0; i < 2; i++) {
        corner c;
        corner_init(&c, i ? b : a);
        take(&c, w, 1, light[i], position);
        corner_finish(&c);
    }
    double sum = 0, off = 0;
    for (int i = 0; i < EDGE * EDGE; i++) {
        sum += (double) light[0][i][0];
        off += fabs((double) (light[1][i][0] - light[0][i][0]));
    }
    print_message("off by %g of %g\n", off, sum);
    assert_true(sum > 0 && off <= tolerance * sum);
}

static const way best = { AG_CLAMP_GEOMETRY, 16, true, 4 };

static void emission_is_not_given_back(void **state)
{
    (void) state;
    const corner_desc bright = { .scale = 1, .emissive = true };
    // 100 + 0.45 - 100 W/(m^2 sr) in floats: off by up to 2^-18 of 0.45.
    compare(&best, &plain, &bright, 1e-5);
}

static void scale_does_not_matter(void **state)
{
    (void) state;
    const corner_desc small = { .scale = 1.1e-4 }, large = { .scale = 0.9e4 };
    // Places round differently, and samples at the border of two pixels go to the other.
    compare(&best, &plain, &small, 2e-4);
    compare(&best, &plain, &large, 2e-4);
}

static void without_a_bound_there_is_nothing_to_give_back(void **state)
{
    static float light[2][EDGE * EDGE][4], position[EDGE * EDGE][4];
    (void) state;
    corner c;
    corner_init(&c, &plain);
    for (int i = 0; i < 2; i++) {
        const way w = { AG_CLAMP_GEOMETRY, 1e-12, i == 1, 4 };
        take(&c, &w, 1, light[i], position);
    }
    assert_true(same_bits(light[0], light[1], sizeof light[0]));
    corner_finish(&c);
}

static void mistakes_name_value_and_rule(void **state)
{
    static const struct {
        ag_compensate_desc desc;
        const char *message;
    } cases[] = {
        { { .tiles = 4 }, "t: bound of the geometry term is 0, must be above 0" },
        { { .bound = 1 }, "t: tiles is 0, must lie in [1, 16]" },
        { { .bound = 1, .tiles = 4, .samples = 257 }, "t: samples is 257, must lie in [1, 256]" },
    };
    (void) state;
    corner c;
    corner_init(&c, &plain);
    for (int i = 0; i < FG_COUNT(cases); i++) {
        ag_compensate_desc desc = cases[i].desc;
        log_clear();
        declare(&c, &best);
        const ag_scene_res res = c.split.scene;
        desc.prefix = "t";
        ag_compensate_declare(&c.compensate, c.graph, &res, &c.gbuffer.out, &desc);
        assert_int_equal(fg_graph_compile(c.graph), FG_ERR_INVALID);
        assert_non_null(strstr(log_text(), cases[i].message));
    }
    corner_finish(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(compensation_lights_the_rim),
        cmocka_unit_test(patches_leave_the_rim_darker),
        cmocka_unit_test(emission_is_not_given_back),
        cmocka_unit_test(scale_does_not_matter),
        cmocka_unit_test(without_a_bound_there_is_nothing_to_give_back),
        cmocka_unit_test(mistakes_name_value_and_rule),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
