// SPDX-License-Identifier: MIT
// The multiresolution buffer on random G-buffers: what covers each pixel, what is listed.
#include "feed.h"

#include <epoxy/gl.h>
#include <math.h>
#include <pass/gather.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REFINED = 1, MIXED = 2 }; // bits of flags, as passes/multires/texel.glsl has them

// What the passes left, and the sizes they need to be read.
typedef struct result {
    const feed *f;
    const ag_multires_desc *desc;
    const ag_multires_pass *pass;
    uint32_t *flags, *tiles, *texels, *count;
    float *change;
    char name[160];
} result;

static ag_multires_pass state; // in place while the graph runs

static result run_pass(feed *f, const ag_multires_desc *desc)
{
    result r = { .f = f, .desc = desc, .pass = &state };
    feed_begin(f);
    ag_multires_declare(&state, f->graph, &f->scene, &f->gbuffer, desc);
    const fg_res res[] = { state.flags, state.tiles, state.texels, state.count,
                           state.variation.change };
    for (int i = 0; i < FG_COUNT(res); i++)
        fg_export(f->graph, res[i]);
    feed_run(f);
    const size_t tiles = (size_t) ((f->width + 7) / 8) * (size_t) ((f->height + 7) / 8);
    r.flags =
        feed_words(f, state.flags, (size_t) ag_multires_flag_start(&state, state.pyramid.levels));
    r.tiles = feed_words(f, state.tiles, 4 * tiles);
    r.texels = feed_words(f, state.texels, (size_t) state.capacity);
    r.count = feed_words(f, state.count, 16);
    r.change = feed_texels(f, state.variation.change);
    snprintf(r.name, sizeof r.name,
             "%d x %d, levels %d, share %d, depth %g, normal %g, metric %d, unbalanced %d",
             desc->width, desc->height, state.pyramid.levels, desc->share, (double) desc->depth,
             (double) desc->normal, (int) desc->metric, desc->unbalanced);
    return r;
}

static void result_finish(result *r)
{
    free(r->flags);
    free(r->tiles);
    free(r->texels);
    free(r->count);
    free(r->change);
}

static uint32_t flags_of(const result *r, int level, int x, int y)
{
    const int across = r->pass->pyramid.base[0] >> level;
    return r->flags[ag_multires_flag_start(r->pass, level) + y * across + x];
}

static size_t place_of(const result *r, int level, int x, int y)
{
    int origin[2];
    ag_pyramid_origin(&r->pass->pyramid, level, origin);
    return (size_t) (origin[1] + y) * r->pass->pyramid.size[0] + origin[0] + x;
}

static bool shows_surface(const feed *f, int x, int y)
{
    return x < f->width && y < f->height && f->normal[(size_t) y * f->width + x][3] > 0;
}

// ---- flags -------------------------------------------------------------------------------------

static bool is_mixed(const result *r, int level, int x, int y)
{
    int origin[2];
    const ag_variation_pass *v = &r->pass->variation;
    ag_pyramid_origin(&v->pyramid, level - v->first, origin);
    const float *c =
        r->change + 4 * ((size_t) (origin[1] + y) * v->pyramid.size[0] + origin[0] + x);
    const bool beyond = (x + 1) << level > r->f->width || (y + 1) << level > r->f->height;
    return beyond || c[3] >= r->desc->depth || fmaxf(c[0], fmaxf(c[1], c[2])) >= r->desc->normal;
}

static bool is_refined(const result *r, int level, int x, int y)
{
    bool refined = is_mixed(r, level, x, y);
    if (level == r->pass->variation.first)
        return refined;
    const int reach = r->desc->unbalanced ? 0 : 1, *base = r->pass->pyramid.base;
    for (int j = 2 * y - reach; j <= 2 * y + 1 + reach; j++)
        for (int i = 2 * x - reach; i <= 2 * x + 1 + reach; i++)
            if (i >= 0 && j >= 0 && i < base[0] >> (level - 1) && j < base[1] >> (level - 1))
                refined = refined || (flags_of(r, level - 1, i, j) & REFINED);
    return refined;
}

static void expect_flags(const result *r)
{
    const int *base = r->pass->pyramid.base;
    for (int level = r->pass->variation.first; level < r->pass->pyramid.levels; level++)
        for (int y = 0; y < base[1] >> level; y++)
            for (int x = 0; x < base[0] >> level; x++) {
                const uint32_t want = (is_refined(r, level, x, y) ? REFINED : 0) |
                                      (is_mixed(r, level, x, y) ? MIXED : 0);
                if (flags_of(r, level, x, y) != want)
                    fail_msg("%s: flags of level %d, %d, %d are %u, not %u", r->name, level, x, y,
                             flags_of(r, level, x, y), want);
            }
}

// ---- cover -------------------------------------------------------------------------------------

// By definition: the texel is not refined, the one above it is. A shared block counts as one.
static bool covers(const result *r, int level, int x, int y)
{
    const bool wanted =
        level == r->pass->pyramid.levels - 1 || (flags_of(r, level + 1, x >> 1, y >> 1) & REFINED);
    const bool refined = level > r->pass->share && (flags_of(r, level, x, y) & REFINED);
    return wanted && !refined;
}

// Exactly one texel covers a pixel; its level.
static int level_of(const result *r, int x, int y)
{
    int found = -1;
    for (int level = r->pass->share; level < r->pass->pyramid.levels; level++) {
        if (!covers(r, level, x >> level, y >> level))
            continue;
        if (found >= 0)
            fail_msg("%s: levels %d and %d cover pixel %d, %d", r->name, found, level, x, y);
        found = level;
    }
    if (found < 0)
        fail_msg("%s: nothing covers pixel %d, %d", r->name, x, y);
    return found;
}

// No pixel beside pixel `i` is of a level more than one away from its own.
static void expect_balance(const result *r, const signed char *levels, int i)
{
    static const int beside[4][2] = { { 1, 0 }, { 0, 1 }, { 1, 1 }, { -1, 1 } };
    const int w = r->f->width, h = r->f->height;
    for (int k = 0; k < 4; k++) {
        const int x = i % w + beside[k][0], y = i / w + beside[k][1];
        if (x >= 0 && x < w && y < h && abs(levels[y * w + x] - levels[i]) > 1)
            fail_msg("%s: pixels %d, %d and %d, %d are of levels %d and %d", r->name, i % w, i / w,
                     x, y, levels[i], levels[y * w + x]);
    }
}

static void expect_cover(const result *r)
{
    const int w = r->f->width, h = r->f->height;
    signed char *levels = malloc((size_t) w * h);
    assert_non_null(levels);
    for (int i = 0; i < w * h; i++)
        levels[i] = (signed char) level_of(r, i % w, i / w);
    for (int i = 0; i < w * h && !r->desc->unbalanced; i++)
        expect_balance(r, levels, i);
    free(levels);
}

// ---- what is lit -------------------------------------------------------------------------------

static bool in_tile(const result *r, int level, int x, int y)
{
    const int tx = (x << level) >> 3, ty = (y << level) >> 3, across = (r->f->width + 7) / 8;
    if (tx >= across || ty >= (r->f->height + 7) / 8)
        return false;
    const uint32_t *tile = r->tiles + 4 * ((size_t) ty * across + tx);
    const int pixel = (y & 7) * 8 + (x & 7);
    if (level == 0)
        return tile[pixel / 32] >> (pixel % 32) & 1;
    const int bit = level == 1   ? (y & 3) * 4 + (x & 3)
                    : level == 2 ? 16 + (y & 1) * 2 + (x & 1)
                                 : 17 + level;
    return tile[2] >> bit & 1;
}

// passes/multires/surface.glsl: `i` on the surface seen at `j`. Slack for float sums of three
// terms.
static bool same_surface(const result *r, size_t i, size_t j)
{
    const feed *f = r->f;
    double bend = 0, off = 0, distance = 0;
    for (int k = 0; k < 3; k++) {
        const double m = (double) f->normal[i][k], p = (double) f->position[j][k];
        bend += (m - (double) f->normal[j][k]) * (m - (double) f->normal[j][k]);
        off += m * (p - (double) f->position[i][k]);
        distance += p * p;
    }
    return sqrt(bend) < (double) r->desc->normal * (1 + 1e-5) &&
           fabs(off) < ((double) r->desc->depth + 1e-6) * sqrt(distance);
}

static bool is_represented(const result *r, int x, int y)
{
    const int share = r->pass->share, w = r->f->width, edge = 1 << share;
    if (in_tile(r, 0, x, y))
        return true;
    for (int k = 0; k < edge * edge; k++) {
        const int i = (x & -edge) + k % edge, j = (y & -edge) + k / edge;
        if (i < w && j < r->f->height && in_tile(r, 0, i, j) &&
            same_surface(r, (size_t) y * w + x, (size_t) j * w + i))
            return true;
    }
    return false;
}

// Whether texels of level 0 come from sharing there.
static bool in_shared_block(const result *r, int x, int y)
{
    const int share = r->pass->share;
    return share > 0 && covers(r, share, x >> share, y >> share) &&
           (flags_of(r, share, x >> share, y >> share) & MIXED);
}

// The tiles' bits are what definition and surfaces say.
static bool should_be_lit(const result *r, int level, int x, int y)
{
    const int share = r->pass->share;
    if (level == 0 && share > 0) {
        const bool lit = in_tile(r, 0, x, y);
        if (lit && !(in_shared_block(r, x, y) && shows_surface(r->f, x, y)))
            fail_msg("%s: pixel %d, %d is lit", r->name, x, y);
        if (in_shared_block(r, x, y) && shows_surface(r->f, x, y) && !is_represented(r, x, y))
            fail_msg("%s: nothing lights pixel %d, %d of a shared block", r->name, x, y);
        return lit;
    }
    if (level < share || !covers(r, level, x, y))
        return false;
    if (level == share && share > 0 && (flags_of(r, level, x, y) & MIXED))
        return false;
    const int middle = level > 0 ? (1 << (level - 1)) - 1 : 0;
    return shows_surface(r->f, (x << level) + middle, (y << level) + middle);
}

static void expect_list(const result *r)
{
    const ag_pyramid *p = &r->pass->pyramid;
    unsigned char *listed = calloc((size_t) p->size[0] * p->size[1], 1);
    assert_non_null(listed);
    const uint32_t count = r->count[0];
    uint32_t lit = 0;
    assert_true(count <= (uint32_t) r->pass->capacity);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t code = r->texels[i];
        const int level = (int) (code >> 28), x = (int) (code & 0x3fff),
                  y = (int) (code >> 14 & 0x3fff);
        assert_true(level < p->levels && x < p->base[0] >> level && y < p->base[1] >> level);
        if (listed[place_of(r, level, x, y)]++)
            fail_msg("%s: texel %d, %d of level %d is listed twice", r->name, x, y, level);
    }
    for (int level = 0; level < p->levels; level++)
        for (int y = 0; y < p->base[1] >> level; y++)
            for (int x = 0; x < p->base[0] >> level; x++) {
                const bool want = should_be_lit(r, level, x, y);
                lit += want;
                if (in_tile(r, level, x, y) != want || listed[place_of(r, level, x, y)] != want)
                    fail_msg("%s: texel %d, %d of level %d: in its tile %d, listed %d, not %d",
                             r->name, x, y, level, in_tile(r, level, x, y),
                             listed[place_of(r, level, x, y)], want);
            }
    free(listed);
    assert_int_equal(lit, count);
}

static void expect_counts(const result *r)
{
    static const uint32_t each[3] = { 64, 256, 1024 };
    const uint32_t head[4] = { r->count[0], 0, 0, 0 };
    assert_memory_equal(r->count, head, sizeof head);
    for (int i = 0; i < 3; i++) {
        const uint32_t groups = (r->count[0] + each[i] - 1) / each[i];
        const uint32_t want[4] = { groups, 1, 1, 0 }; // no test has 65536
        assert_memory_equal(r->count + 4 * ((size_t) i + 1), want, sizeof want);
    }
}

static void expect_all(feed *f, const ag_multires_desc *desc)
{
    result r = run_pass(f, desc);
    expect_flags(&r);
    expect_cover(&r);
    expect_list(&r);
    expect_counts(&r);
    result again = run_pass(f, desc);
    assert_int_equal(again.count[0], r.count[0]);
    assert_memory_equal(again.texels, r.texels, r.count[0] * sizeof *r.texels);
    result_finish(&again);
    result_finish(&r);
}

// ---- facts -------------------------------------------------------------------------------------

static const int sizes[][2] = { { 1, 1 },   { 2, 1 },   { 2, 2 },     { 7, 19 },
                                { 64, 64 }, { 65, 63 }, { 255, 255 }, { 1023, 517 } };

static ag_multires_desc random_desc(const int size[2], int share, uint32_t *seed)
{
    static const int coarsest[4] = { 0, 1, 8, 30 };
    const ag_multires_desc desc = {
        .prefix = "test",
        .width = size[0],
        .height = size[1],
        .coarsest = coarsest[(int) (4 * feed_random(seed))],
        .depth = (float) pow(10, -3 + 3 * feed_random(seed)),
        .normal = (float) (0.01 + 1.5 * feed_random(seed)),
        .metric = feed_random(seed) < 0.7 ? AG_DEPTH_PLANE : AG_DEPTH_SLOPE,
        .share = share,
        .unbalanced = feed_random(seed) < 0.3,
    };
    return desc;
}

// With every share; at a large size with one.
static void expect_all_shares(feed *f, int kind, uint32_t *seed)
{
    const int size[2] = { f->width, f->height };
    const bool large = size[0] > 1000;
    const int first = large ? kind % 2 * 3 : 0, last = large ? first : 3;
    for (int share = first; share <= last; share++) {
        const ag_multires_desc desc = random_desc(size, share, seed);
        expect_all(f, &desc);
    }
}

static void each_pixel_is_covered_once_and_what_covers_it_is_listed(void **unused)
{
    uint32_t seed = 11;
    (void) unused;
    for (int s = 0; s < FG_COUNT(sizes); s++) {
        for (int kind = 0; kind < FEED_KINDS; kind++) {
            feed f;
            feed_init(&f, sizes[s][0], sizes[s][1], 0);
            feed_scene(&f, (feed_kind) kind, 3u * (uint32_t) s + (uint32_t) kind);
            expect_all_shares(&f, kind, &seed);
            feed_finish(&f);
        }
    }
}

static void thresholds_of_0_light_every_pixel_and_infinite_ones_only_the_coarsest(void **unused)
{
    (void) unused;
    for (int share = 0; share <= 3; share++) {
        feed f;
        feed_init(&f, 96, 64, 0);
        feed_scene(&f, FEED_ONE_PLANE, 1);
        const ag_multires_desc all = {
            .prefix = "test", .width = 96, .height = 64, .coarsest = 12, .share = share
        };
        ag_multires_desc none = all;
        none.depth = none.normal = INFINITY;
        result r = run_pass(&f, &all);
        assert_int_equal(r.count[0], 96 * 64);
        result_finish(&r);
        r = run_pass(&f, &none);
        assert_int_equal(r.pass->pyramid.levels, 4);
        assert_int_equal(r.count[0], 12 * 8);
        result_finish(&r);
        feed_finish(&f);
    }
}

static void a_surface_in_a_shared_block_takes_one_pixel(void **unused)
{
    (void) unused;
    feed f;
    feed_init(&f, 64, 64, 0);
    feed_scene(&f, FEED_ONE_PLANE, 1);
    feed_plane(&f, (int[4]){ 0, 0, 27, 64 }, (double[3]){ 0, 0, 1 }, -1);
    for (int share = 1; share <= 3; share++) {
        const ag_multires_desc desc = { .prefix = "test",
                                        .width = 64,
                                        .height = 64,
                                        .coarsest = 8,
                                        .depth = 0.01f,
                                        .normal = 0.2f,
                                        .share = share };
        result r = run_pass(&f, &desc);
        int pixels = 0, blocks = 0, edge = 1 << share;
        for (uint32_t i = 0; i < r.count[0]; i++)
            pixels += r.texels[i] >> 28 == 0;
        for (int y = 0; y < 64; y += edge)
            for (int x = 0; x < 64; x += edge)
                blocks += in_shared_block(&r, x, y);
        // The rim at 27 runs through a block; one beside it may see it too, and has one surface.
        assert_in_range(blocks, 64 / edge, 2 * 64 / edge);
        assert_int_equal(pixels, blocks + 64 / edge);
        result_finish(&r);
    }
    feed_finish(&f);
}

// ---- culling -----------------------------------------------------------------------------------

// VPLs in front of the camera, as bytes of an ag_vpl[].
static float *random_vpls(int count, uint32_t seed)
{
    static const uint32_t edges[2] = { 0x00003c00, 0x3c000000 }; // half floats (1, 0), (0, 1)
    float *vpls = malloc((size_t) count * 12 * sizeof *vpls);
    assert_non_null(vpls);
    for (float *v = vpls; v < vpls + (size_t) count * 12; v += 12) {
        double n[3], length = 1e-6;
        for (int k = 0; k < 3; k++) {
            n[k] = 2 * feed_random(&seed) - 1;
            length += n[k] * n[k];
            v[k] = (float) (2 * feed_random(&seed) - (k == 2 ? 3 : 1));
            v[8 + k] = (float) feed_random(&seed);
        }
        for (int k = 0; k < 3; k++)
            v[4 + k] = (float) (n[k] / sqrt(length));
        v[3] = 0.01f;
        memcpy(v + 7, &edges[0], 4);
        memcpy(v + 11, &edges[1], 4);
    }
    return vpls;
}

static fg_res import(feed *f, const char *name, const void *bytes, size_t size, uint32_t *buffer)
{
    glCreateBuffers(1, buffer);
    glNamedBufferStorage(*buffer, (GLsizeiptr) size, bytes, 0);
    return fg_import_buffer(f->graph, name, &(fg_buf_desc){ .size = size }, *buffer);
}

static void expect_equal_culls(feed *f, const ag_multires_desc *desc, int vpl_count, ag_clamp clamp)
{
    static const char *const prefixes[2] = { "list", "mask" };
    static ag_multires_pass eyes[2];
    static ag_gather_pass gathers[2];
    const uint32_t count[4] = { (uint32_t) vpl_count, (uint32_t) vpl_count };
    uint32_t buffers[2];
    float *vpls = random_vpls(vpl_count, 5), *out[2];
    feed_begin(f);
    const ag_vpl_pass list = {
        .vpls = import(f, "vpls", vpls, (size_t) vpl_count * 48, &buffers[0]),
        .count = import(f, "vpl_count", count, sizeof count, &buffers[1]),
        .capacity = vpl_count,
    };
    for (int i = 0; i < 2; i++) {
        ag_multires_desc eye = *desc;
        eye.prefix = prefixes[i];
        eye.cull = i == 0 ? AG_CULL_COMPACT : AG_CULL_STENCIL;
        const ag_gather_desc gather = { .prefix = prefixes[i],
                                        .clamp = clamp,
                                        .multires = &eyes[i] };
        ag_multires_declare(&eyes[i], f->graph, &f->scene, &f->gbuffer, &eye);
        ag_gather_declare(&gathers[i], f->graph, &f->scene, &f->gbuffer, &list, &gather);
        fg_export(f->graph, gathers[i].out);
    }
    feed_run(f);
    for (int i = 0; i < 2; i++)
        out[i] = feed_texels(f, gathers[i].out);
    const int across = eyes[0].pyramid.size[0];
    double sum = 0;
    for (int i = 0; i < across * eyes[0].pyramid.size[1]; i++) {
        const float *list_rgba = out[0] + 4 * (size_t) i, *stencil_rgba = out[1] + 4 * (size_t) i;
        sum += (double) list_rgba[0];
        if (!same_bits(list_rgba, stencil_rgba, 16))
            fail_msg("%d x %d, share %d, %d VPLs, clamp %d: %d, %d is %.9g, %g in a list, %.9g, %g "
                     "by stencil",
                     f->width, f->height, desc->share, vpl_count, (int) clamp, i % across,
                     i / across, (double) list_rgba[0], (double) list_rgba[3],
                     (double) stencil_rgba[0], (double) stencil_rgba[3]);
    }
    assert_true(sum > 0 || vpl_count == 1 || f->width < 8);
    for (int i = 0; i < 2; i++)
        free(out[i]);
    free(vpls);
    glDeleteBuffers(2, buffers);
}

static void culling_by_stencil_and_by_list_give_the_same_bits(void **unused)
{
    static const int cases[][3] = { { 1, 1, 64 },   { 2, 1, 1 },      { 65, 63, 1 },
                                    { 65, 63, 64 }, { 65, 63, 1024 }, { 40, 33, 4096 },
                                    { 255, 97, 64 } };
    uint32_t seed = 21;
    (void) unused;
    for (int i = 0; i < FG_COUNT(cases); i++) {
        feed f;
        feed_init(&f, cases[i][0], cases[i][1], 0);
        feed_scene(&f, FEED_ONE_PLANE, 1);
        feed_scene(&f, FEED_PLANES, 100u + (uint32_t) i);
        for (int share = 0; share <= 3; share += 3) {
            ag_multires_desc desc = random_desc(cases[i], share, &seed);
            desc.depth = 0.02f;
            expect_equal_culls(&f, &desc, cases[i][2],
                               share == 0 ? AG_CLAMP_FOOTPRINT : AG_CLAMP_DISC);
        }
        feed_finish(&f);
    }
}

static void mistakes_are_named(void **unused)
{
    static const struct {
        ag_multires_desc desc;
        const char *message;
    } mistakes[] = {
        { { .prefix = "test", .width = 0, .height = 1 }, "test: 0 x 1 pixels, must lie in" },
        { { .prefix = "test", .width = 1, .height = 16385 },
          "test: 1 x 16385 pixels, must lie in" },
        { { .prefix = "test", .width = 8, .height = 8, .coarsest = -1 },
          "test: coarsest is -1, must be at least 1" },
        { { .prefix = "test", .width = 8, .height = 8, .depth = -1 },
          "test: thresholds of depth -1 and normal 0, must be at least 0" },
        { { .prefix = "test", .width = 8, .height = 8, .normal = NAN },
          "test: thresholds of depth 0 and normal nan, must be at least 0" },
        { { .prefix = "test", .width = 8, .height = 8, .share = 4 },
          "test: share is 4, must lie in [0, 3]" },
    };
    (void) unused;
    feed f;
    feed_init(&f, 8, 8, 0);
    for (int i = 0; i < FG_COUNT(mistakes); i++) {
        feed_begin(&f);
        log_clear();
        ag_multires_declare(&state, f.graph, &f.scene, &f.gbuffer, &mistakes[i].desc);
        assert_int_equal(fg_graph_compile(f.graph), FG_ERR_INVALID);
        assert_non_null(strstr(log_text(), mistakes[i].message));
    }
    feed_finish(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_pixel_is_covered_once_and_what_covers_it_is_listed),
        cmocka_unit_test(thresholds_of_0_light_every_pixel_and_infinite_ones_only_the_coarsest),
        cmocka_unit_test(a_surface_in_a_shared_block_takes_one_pixel),
        cmocka_unit_test(culling_by_stencil_and_by_list_give_the_same_bits),
        cmocka_unit_test(mistakes_are_named),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
