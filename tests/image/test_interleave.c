// SPDX-License-Identifier: MIT
// Split, tiled gather and combine, on G-buffers and VPLs made up here.
#include "feed.h"

#include <epoxy/gl.h>
#include <math.h>
#include <pass/gather.h>
#include <pass/interleave.h>
#include <pass/paraboloid_shared.h>
#include <pass/vpl_shared.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979;

static void whole(feed *f, const double n[3], double d)
{
    feed_plane(f, (int[4]){ 0, 0, f->width, f->height }, n, d);
}

// ---- split and combine --------------------------------------------------------------------------

static void declare_split(ag_split_pass *split, feed *f, int tiles)
{
    const ag_split_desc desc = {
        .prefix = "t", .tiles = tiles, .width = f->width, .height = f->height
    };
    ag_split_declare(split, f->graph, &f->scene, &f->gbuffer, &desc);
}

// Every texel of the split image against the pixel that it is of.
static void assert_split(const feed *f, const ag_split_pass *split, const float *texels,
                         float (*pixels)[4])
{
    const int n = split->tiles;
    for (int y = 0; y < split->size[1]; y++)
        for (int x = 0; x < split->size[0]; x++) {
            static const float nothing[4] = { 0 };
            const int at[2] = { x % split->tile[0] * n + x / split->tile[0],
                                y % split->tile[1] * n + y / split->tile[1] };
            const bool there = at[0] < f->width && at[1] < f->height;
            const float *want = there ? pixels[at[1] * f->width + at[0]] : nothing;
            const float *got = texels + 4 * ((size_t) y * (size_t) split->size[0] + (size_t) x);
            assert_true(same_bits(got, want, 4 * sizeof *got));
        }
}

static void check_there_and_back(int width, int height, int n)
{
    feed f;
    ag_split_pass split;
    ag_combine_pass combine;
    feed_init(&f, width, height, 0);
    feed_scene(&f, FEED_NOISE, (uint32_t) (width + n));
    feed_begin(&f);
    declare_split(&split, &f, n);
    ag_combine_declare(&combine, f.graph, &split, split.position);
    if (split.tiles == 1) { // nothing is declared, nothing is to be run
        assert_true(split.position.id == f.gbuffer.position.id);
        assert_true(split.normal.id == f.gbuffer.normal.id);
        assert_true(combine.out.id == split.position.id);
    } else {
        fg_export(f.graph, split.position);
        fg_export(f.graph, split.normal);
        fg_export(f.graph, combine.out);
        feed_run(&f);
        float *position = feed_texels(&f, split.position), *normal = feed_texels(&f, split.normal);
        float *back = feed_texels(&f, combine.out);
        assert_split(&f, &split, position, f.position);
        assert_split(&f, &split, normal, f.normal);
        assert_true(
            same_bits(back, f.position, sizeof(float[4]) * (size_t) width * (size_t) height));
        free(position);
        free(normal);
        free(back);
    }
    feed_finish(&f);
}

static void combining_undoes_the_split(void **state)
{
    static const int sizes[][2] = { { 1, 1 }, { 2, 1 }, { 8, 8 }, { 17, 3 }, { 65, 63 } };
    (void) state;
    for (int s = 0; s < FG_COUNT(sizes); s++)
        for (int n = 1; n <= 9; n++)
            check_there_and_back(sizes[s][0], sizes[s][1], n < 9 ? n : AG_MAX_TILES);
}

// ---- gather of tiles ----------------------------------------------------------------------------

enum { MAX_VPLS = 300 };

typedef struct lit {
    feed f;
    ag_vpl vpls[MAX_VPLS];
    uint32_t count[4];
    uint32_t buffers[2];
    ag_vpl_pass pass;
    ag_split_pass split;
    ag_gather_pass gather;
    ag_combine_pass combine;
    ag_box_filter_pass filter;
} lit;

// VPLs in the plane z = -1, within half a metre, that shine towards -z.
static void lit_init(lit *l, int width, int height, int count)
{
    uint32_t seed = 1;
    *l = (lit){ .count = { (uint32_t) count } };
    feed_init(&l->f, width, height, 0);
    for (int i = 0; i < MAX_VPLS; i++)
        l->vpls[i] = (ag_vpl){
            .position_area = { (float) feed_random(&seed) - 0.5f, (float) feed_random(&seed) - 0.5f,
                               -1, 0.01f },
            .normal = { 0, 0, -1 },
            .flux = { (float) feed_random(&seed), (float) feed_random(&seed), 1 },
        };
}

static void lit_finish(lit *l)
{
    glDeleteBuffers(2, l->buffers);
    feed_finish(&l->f);
}

static void lit_begin(lit *l)
{
    const fg_buf_desc vpls = { .size = sizeof l->vpls }, count = { .size = sizeof l->count };
    feed_begin(&l->f);
    glDeleteBuffers(2, l->buffers);
    glCreateBuffers(2, l->buffers);
    glNamedBufferStorage(l->buffers[0], sizeof l->vpls, l->vpls, 0);
    glNamedBufferStorage(l->buffers[1], sizeof l->count, l->count, 0);
    l->pass = (ag_vpl_pass){
        .vpls = fg_import_buffer(l->f.graph, "t.vpls", &vpls, l->buffers[0]),
        .count = fg_import_buffer(l->f.graph, "t.count", &count, l->buffers[1]),
        .capacity = MAX_VPLS,
    };
}

// E / pi at every pixel, the caller's to free; with `n` above 0 of a split frame, not filtered.
static float *lit_run(lit *l, int n, ag_gather_desc desc)
{
    lit_begin(l);
    desc.prefix = "t";
    if (n > 0) {
        declare_split(&l->split, &l->f, n);
        desc.split = &l->split;
    }
    ag_gather_declare(&l->gather, l->f.graph, &l->f.scene, &l->f.gbuffer, &l->pass, &desc);
    fg_res out = l->gather.out;
    if (n > 0) {
        ag_combine_declare(&l->combine, l->f.graph, &l->split, out);
        out = l->combine.out;
    }
    fg_export(l->f.graph, out);
    feed_run(&l->f);
    return feed_texels(&l->f, out);
}

// The plane z = -d, each n x n pixels showing the one point: all tiles are then the same image.
static void show_blocks(feed *f, int n, double d)
{
    whole(f, (double[3]){ 0, 0, 1 }, -d);
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++)
            memcpy(f->position[y * f->width + x], f->position[(y - y % n) * f->width + (x - x % n)],
                   sizeof f->position[0]);
}

static void check_sum(int n, int count, const ag_gather_desc *desc)
{
    enum { EDGE = 48 }; // multiples of all n
    lit l;
    lit_init(&l, EDGE, EDGE, count);
    show_blocks(&l.f, n, 1.2);
    float *full = lit_run(&l, 0, *desc), *tiled = lit_run(&l, n, *desc);
    for (int y = 0; y < EDGE; y += n)
        for (int x = 0; x < EDGE; x += n)
            for (int k = 0; k < 4; k++) {
                double mean = 0;
                for (int i = 0; i < n * n; i++)
                    mean += (double) tiled[4 * ((y + i / n) * EDGE + x + i % n) + k] / (n * n);
                const double want = (double) full[4 * (y * EDGE + x) + k];
                // Each of at most `count` positive terms, and each sum, rounds by 6e-8, in both;
                // other code for other permutations: some ten roundings a term.
                assert_true(fabs(mean - want) <= 6e-8 * (2 * count + 20) * want);
                assert_true(k == 3 || count == 0 || want > 0);
            }
    free(full);
    free(tiled);
    lit_finish(&l);
}

static void tiles_add_up_to_all_vpls(void **state)
{
    static const ag_gather_desc clamps[] = {
        { .clamp = AG_CLAMP_FOOTPRINT },
        { .clamp = AG_CLAMP_DISC },
        { .clamp = AG_CLAMP_NONE, .block = 4 },
        { .clamp = AG_CLAMP_CONSTANT, .clamp_d2 = 0.1f, .block = 1 },
        { .clamp = AG_CLAMP_IRRADIANCE, .clamp_e = 1, .block = 4 },
        { .clamp = AG_CLAMP_GEOMETRY, .clamp_g = 1, .block = 4 },
    };
    static const int counts[] = { 0, 1, 3, 15, 16, 17, 37, MAX_VPLS };
    (void) state;
    for (int c = 0; c < FG_COUNT(clamps); c++)
        check_sum(4, 61, &clamps[c]);
    for (int i = 0; i < FG_COUNT(counts); i++)
        check_sum(4, counts[i], &clamps[1]);
    check_sum(2, MAX_VPLS, &clamps[0]);
    check_sum(3, 61, &clamps[0]); // n^2 is no power of two
    check_sum(8, 61, &clamps[0]); // fewer VPLs than tiles
}

// Irradiance over pi of one VPL, as a disc.
static double disc_of(const ag_vpl *v, const float *p)
{
    double d[3], d2 = 0;
    for (int k = 0; k < 3; k++) {
        d[k] = (double) v->position_area[k] - (double) p[k];
        d2 += d[k] * d[k];
    }
    return d[2] * d[2] / (d2 * (pi * d2 + (double) v->position_area[3])) / pi;
}

static void each_tile_has_its_run_of_the_list(void **state)
{
    enum { W = 37, H = 29, N = 3, COUNT = 14 }; // 9 tiles: five of two VPLs, four of one
    static const ag_gather_desc disc = { .clamp = AG_CLAMP_DISC };
    lit l;
    (void) state;
    lit_init(&l, W, H, COUNT);
    whole(&l.f, (double[3]){ 0, 0, 1 }, -2);
    float *got = lit_run(&l, N, disc);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const size_t at = (size_t) y * W + (size_t) x;
            const int t = y % N * N + x % N, first = t < 5 ? 2 * t : t + 5;
            for (int k = 0; k < 3; k++) {
                double want = 0;
                for (int j = first; j < first + (t < 5 ? 2 : 1); j++)
                    want +=
                        N * N * disc_of(&l.vpls[j], l.f.position[at]) * (double) l.vpls[j].flux[k];
                // Some ten roundings of terms, of differences of lengths about 1.
                assert_true(fabs((double) got[4 * at + (size_t) k] - want) < 3e-6 * want);
            }
        }
    free(got);
    lit_finish(&l);
}

static void what_bounds_a_vpl_bounds_it_alone(void **state)
{
    enum { EDGE = 8 };
    static const ag_gather_desc none = { .clamp = AG_CLAMP_NONE };
    static const ag_gather_desc irradiance = { .clamp = AG_CLAMP_IRRADIANCE, .clamp_e = 0.75f };
    static const ag_gather_desc geometry = { .clamp = AG_CLAMP_GEOMETRY, .clamp_g = 3 };
    lit l;
    (void) state;
    lit_init(&l, EDGE, EDGE, 1);
    show_blocks(&l.f, EDGE, 1.1);
    const float *p = l.f.position[0];
    l.vpls[0] = (ag_vpl){ .position_area = { p[0], p[1], -1, 0.01f }, // G = 1 / (pi 0.01)
                          .normal = { 0, 0, -1 },
                          .flux = { 0.5f, 2, 1 } };
    float *free_ = lit_run(&l, 0, none);
    float *e = lit_run(&l, 2, irradiance), *g = lit_run(&l, 2, geometry);
    for (int k = 0; k < 3; k++) {
        const double flux = (double) l.vpls[0].flux[k];
        assert_true((double) free_[k] * pi > 3 * flux && (double) free_[k] * pi > 0.75);
        // Before the factor of 4 tiles; the largest component, green, is at the bound and colour
        // stays.
        assert_true(fabs((double) e[k] * pi / 4 - 0.75 * flux / 2) < 1e-6);
        assert_true(fabs((double) g[k] * pi / 4 - 3 * flux) < 1e-5);
    }
    free(free_);
    free(e);
    free(g);
    lit_finish(&l);
}

static void one_tile_is_no_split(void **state)
{
    static const int sizes[][2] = { { 33, 31 }, { 1, 1 } }; // a pixel takes no more than one tile
    static const ag_gather_desc desc = { 0 };
    (void) state;
    for (int s = 0; s < FG_COUNT(sizes); s++) {
        const size_t size = sizeof(float[4]) * (size_t) sizes[s][0] * (size_t) sizes[s][1];
        lit l;
        lit_init(&l, sizes[s][0], sizes[s][1], MAX_VPLS);
        whole(&l.f, (double[3]){ 0.3, 0.1, 1 }, -1.5);
        float *full = lit_run(&l, 0, desc), *tiled = lit_run(&l, s == 0 ? 1 : 8, desc);
        assert_true(full[0] > 0 && same_bits(full, tiled, size));
        free(full);
        free(tiled);
        lit_finish(&l);
    }
}

// Maps of VPLs j: everything hidden where j is odd, nothing else.
static void paraboloid_maps(lit *l, ag_paraboloid_pass *maps, GLuint *texture, GLuint *buffer)
{
    enum { EDGE = 16 };
    static float texels[2][EDGE * EDGE]; // reciprocal distance over its unit
    static struct {
        int32_t layout[4];
        ag_paraboloid_eye_block eyes[MAX_VPLS];
    } block;
    const fg_tex_desc tex = { .format = FG_R16F, .width = EDGE, .height = EDGE, .layers = 2 };
    block.layout[0] = EDGE;
    for (int j = 0; j < MAX_VPLS; j++) {
        ag_paraboloid_eye_block *e = &block.eyes[j];
        *e = (ag_paraboloid_eye_block){ .position = { 0, 0, 0, 1 },
                                        .tangent = { 1 },
                                        .bitangent = { 0, -1 },
                                        .normal = { 0, 0, -1, (float) (j % 2) } };
        memcpy(e->position, l->vpls[j].position_area, 3 * sizeof(float));
    }
    for (int i = 0; i < EDGE * EDGE; i++)
        texels[1][i] = 1e4f;
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, texture);
    glTextureStorage3D(*texture, 1, GL_R16F, EDGE, EDGE, 2);
    glTextureSubImage3D(*texture, 0, 0, 0, 0, EDGE, EDGE, 2, GL_RED, GL_FLOAT, texels);
    glCreateBuffers(1, buffer);
    glNamedBufferStorage(*buffer, sizeof block, &block, 0);
    *maps = (ag_paraboloid_pass){
        .maps = fg_import_texture(l->f.graph, "t.maps", &tex, *texture),
        .eyes =
            fg_import_buffer(l->f.graph, "t.eyes", &(fg_buf_desc){ .size = sizeof block }, *buffer),
    };
}

// Blocks of 16 where the clamp is DISC; their compilers take long.
static ag_gather_desc by_maps(ag_clamp clamp)
{
    return (
        ag_gather_desc){ .clamp = clamp, .clamp_e = 1, .block = clamp == AG_CLAMP_DISC ? 16 : 4 };
}

static float *lit_by_maps(lit *l, int n, ag_clamp clamp)
{
    ag_paraboloid_pass maps;
    GLuint texture, buffer;
    lit_begin(l);
    paraboloid_maps(l, &maps, &texture, &buffer);
    ag_gather_desc desc = by_maps(clamp);
    desc.prefix = "t";
    desc.split = &l->split;
    desc.paraboloid = &maps;
    declare_split(&l->split, &l->f, n);
    ag_gather_declare(&l->gather, l->f.graph, &l->f.scene, &l->f.gbuffer, &l->pass, &desc);
    ag_combine_declare(&l->combine, l->f.graph, &l->split, l->gather.out);
    fg_export(l->f.graph, l->combine.out);
    feed_run(&l->f);
    float *texels = feed_texels(&l->f, l->combine.out);
    glDeleteTextures(1, &texture);
    glDeleteBuffers(1, &buffer);
    return texels;
}

static void each_vpl_has_its_own_map(void **state)
{
    enum { EDGE = 24, COUNT = 40 };
    static const ag_clamp clamps[] = { AG_CLAMP_FOOTPRINT, AG_CLAMP_DISC, AG_CLAMP_NONE,
                                       AG_CLAMP_IRRADIANCE };
    (void) state;
    for (int c = 0; c < FG_COUNT(clamps); c++)
        for (int n = 1; n <= 4; n += 3) {
            lit l;
            lit_init(&l, EDGE, EDGE, COUNT);
            show_blocks(&l.f, 1, 1.2);
            float *got = lit_by_maps(&l, n, clamps[c]);
            for (int j = 1; j < COUNT; j += 2)
                memset(l.vpls[j].flux, 0, sizeof l.vpls[j].flux);
            float *want = lit_run(&l, n, by_maps(clamps[c]));
            for (int i = 0; i < 4 * EDGE * EDGE; i++) // the last bits, of some ten roundings a term
                assert_true(fabs((double) (got[i] - want[i])) <= 3e-6 * (double) want[i]);
            free(got);
            free(want);
            lit_finish(&l);
        }
}

static void mistakes_name_value_and_rule(void **state)
{
    static const struct {
        int tiles;
        ag_box_filter_desc filter;
        ag_gather_desc gather;
        const char *message;
    } cases[] = {
        { 0, { 0, 1, 0 }, { 0 }, "t: tiles is 0, must lie in [1, 16]" },
        { 17, { 0, 1, 0 }, { 0 }, "t: tiles is 17, must lie in [1, 16]" },
        { 4, { 0, -1, 0 }, { 0 }, "t: alpha is -1, must be at least 0" },
        { 4, { 0, 1, NAN }, { 0 }, "t: beta is nan, must lie in [-1, 1]" },
        { 4,
          { 0, 1, 0 },
          { .clamp = AG_CLAMP_IRRADIANCE },
          "t: clamp of a VPL is 0, must be above 0" },
        { 4,
          { 0, 1, 0 },
          { .clamp = AG_CLAMP_GEOMETRY },
          "t: clamp of a VPL is 0, must be above 0" },
    };
    (void) state;
    for (int i = 0; i < FG_COUNT(cases); i++) {
        lit l;
        ag_gather_desc gather = cases[i].gather;
        lit_init(&l, 8, 8, 1);
        lit_begin(&l);
        log_clear();
        gather.prefix = "t";
        gather.split = &l.split;
        declare_split(&l.split, &l.f, cases[i].tiles);
        ag_gather_declare(&l.gather, l.f.graph, &l.f.scene, &l.f.gbuffer, &l.pass, &gather);
        ag_combine_declare(&l.combine, l.f.graph, &l.split, l.gather.out);
        ag_box_filter_declare(&l.filter, l.f.graph, &l.split, l.combine.out, &cases[i].filter);
        assert_int_equal(fg_graph_compile(l.f.graph), FG_ERR_INVALID);
        assert_non_null(strstr(log_text(), cases[i].message));
        lit_finish(&l);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(combining_undoes_the_split),
        cmocka_unit_test(tiles_add_up_to_all_vpls),
        cmocka_unit_test(each_tile_has_its_run_of_the_list),
        cmocka_unit_test(what_bounds_a_vpl_bounds_it_alone),
        cmocka_unit_test(one_tile_is_no_split),
        cmocka_unit_test(each_vpl_has_its_own_map),
        cmocka_unit_test(mistakes_name_value_and_rule),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
