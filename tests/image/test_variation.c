// SPDX-License-Identifier: MIT
// Variation pyramids against a brute-force reduction of what was fed in.
#include "feed.h"

#include <math.h>
#include <pass/variation.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct variation_case {
    int width, height, layers, levels, first;
    ag_depth_metric metric;
    bool orthographic;
} variation_case;

// What a block should hold.
typedef struct block {
    double least[3], most[3], depth;
    double range[2];
} block;

static const block nothing = { { 2, 2, 2 }, { -2, -2, -2 }, 0, { 1, 0 } };

static const char *name_of(const variation_case *c)
{
    static char text[96];
    snprintf(text, sizeof text, "%d x %d x %d, levels %d .. %d, metric %d, orthographic %d",
             c->width, c->height, c->layers, c->first, c->levels, (int) c->metric, c->orthographic);
    return text;
}

// ---- brute force -------------------------------------------------------------------------------

// Depth beside texel (x, y) of a layer; its own where there is none.
static double depth_at(const feed *f, int layer, int x, int y)
{
    x = x < 0 ? 0 : x >= f->width ? f->width - 1 : x;
    y = y < 0 ? 0 : y >= f->height ? f->height - 1 : y;
    return (double) f->depth[((size_t) layer * f->height + y) * f->width + x];
}

// Departure from a line of three texels: none where one is missing, unless there are but two.
static double bend(double before, double here, double after, int at, int size)
{
    if (size == 2)
        return fabs(before - after);
    return at > 0 && at < size - 1 ? fabs(before + after - 2 * here) : 0;
}

static double derivative(const feed *f, const variation_case *c, int layer, int x, int y)
{
    const double z = depth_at(f, layer, x, y);
    const double right = depth_at(f, layer, x + 1, y), above = depth_at(f, layer, x, y + 1);
    double dx = fabs(right - z), dy = fabs(above - z), most = fmax(z, fmax(right, above));
    if (c->metric == AG_DEPTH_PLANE) {
        const double left = depth_at(f, layer, x - 1, y), below = depth_at(f, layer, x, y - 1);
        dx = bend(left, z, right, x, f->width);
        dy = bend(below, z, above, y, f->height);
        most = fmax(most, fmax(left, below));
    }
    most = c->orthographic ? 1 : most;
    return most > 0 ? hypot(dx, dy) / most : 0;
}

static void add_texel(block *b, const feed *f, int layer, int x, int y, double depth)
{
    const int beside[3][2] = { { 0, 0 }, { x + 1 < f->width, 0 }, { 0, y + 1 < f->height } };
    for (int i = 0; i < 3; i++) {
        const size_t at =
            ((size_t) layer * f->height + y + beside[i][1]) * f->width + x + beside[i][0];
        for (int k = 0; k < 3; k++) {
            b->least[k] = fmin(b->least[k], (double) f->normal[at][k]);
            b->most[k] = fmax(b->most[k], (double) f->normal[at][k]);
        }
    }
    const double z = depth_at(f, layer, x, y);
    b->depth = fmax(b->depth, depth);
    if (z > 0) {
        b->range[0] = fmin(b->range[0], z);
        b->range[1] = fmax(b->range[1], z);
    }
}

// Blocks of one level of one layer, in rows of `across`.
static block *reduce(const feed *f, int layer, int level, int across, int down, const double *depth)
{
    block *blocks = malloc((size_t) across * down * sizeof *blocks);
    assert_non_null(blocks);
    for (int i = 0; i < across * down; i++)
        blocks[i] = nothing;
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++)
            add_texel(&blocks[(y >> level) * across + (x >> level)], f, layer, x, y,
                      depth[(size_t) y * f->width + x]);
    return blocks;
}

// ---- comparison --------------------------------------------------------------------------------

typedef struct result {
    ag_variation_pass pass;
    float *change, *range;
} result;

static result run_pass(feed *f, const variation_case *c)
{
    result r;
    feed_begin(f);
    const ag_variation_desc desc = {
        .prefix = "test",
        .depth = f->gbuffer.depth,
        .normal = f->gbuffer.normal,
        .width = c->width,
        .height = c->height,
        .layers = c->layers,
        .levels = c->levels,
        .first = c->first,
        .metric = c->metric,
        .range = true,
    };
    // The pass stays in place while the graph runs.
    static ag_variation_pass pass;
    ag_variation_declare(&pass, f->graph, &f->scene, &desc);
    fg_export(f->graph, pass.change);
    fg_export(f->graph, pass.range);
    feed_run(f);
    r.pass = pass;
    r.change = feed_texels(f, pass.change);
    r.range = feed_texels(f, pass.range);
    return r;
}

static void result_finish(result *r)
{
    free(r->change);
    free(r->range);
}

static size_t place_of(const result *r, int layer, int level, int x, int y)
{
    int origin[2];
    const ag_pyramid *p = &r->pass.pyramid;
    ag_pyramid_origin(p, level - r->pass.first, origin);
    return (((size_t) layer * p->size[1] + origin[1] + y) * p->size[0] + origin[0] + x) * 4;
}

// A half float at v (1 + 2^-10) + 6e-8 rounded either way lies within 2^-11 of that or, downward,
// is the next one at or above v: at most 2^-10 + 2^-11 = 0.15 % above. Float sums: the derivative
// is a difference of depths relative to the largest of them, each rounded by 2^-24 of it, four of
// them by axis; quotient and length are within 2^-21.
static void expect_change(const variation_case *c, const float *got, const block *want, int level,
                          const int at[2])
{
    const double rounding = 0x1p-21;
    for (int k = 0; k < 4; k++) {
        const double w = k < 3 ? fmax(want->most[k] - want->least[k], 0) : want->depth;
        const double low = w * (1 - rounding) - (k == 3 ? 0x1p-21 : 0);
        const double high = w * 1.002 + 1e-6 + (k == 3 ? 0x1p-21 : 0);
        if (!((double) got[k] >= fmin(low, 65504)) || !((double) got[k] <= high))
            fail_msg("%s: level %d, block %d, %d, component %d: %.9g, not %.9g", name_of(c), level,
                     at[0], at[1], k, (double) got[k], w);
    }
}

// Least and most depth, exactly.
static void expect_range(const variation_case *c, const float got[2], const block *want, int level,
                         const int at[2])
{
    for (int i = 0; i < 2; i++)
        if ((double) got[i] != want->range[i])
            fail_msg("%s: level %d, block %d, %d: range %.9g, not %.9g", name_of(c), level, at[0],
                     at[1], (double) got[i], want->range[i]);
}

static void expect_level(const feed *f, const variation_case *c, const result *r, int layer,
                         int level, const double *depth)
{
    const int k = level - r->pass.first;
    const int across = r->pass.pyramid.base[0] >> k, down = r->pass.pyramid.base[1] >> k;
    block *blocks = reduce(f, layer, level, across, down, depth);
    for (int y = 0; y < down; y++) {
        for (int x = 0; x < across; x++) {
            const size_t place = place_of(r, layer, level, x, y);
            const block *want = &blocks[y * across + x];
            expect_change(c, r->change + place, want, level, (int[2]){ x, y });
            expect_range(c, r->range + place, want, level, (int[2]){ x, y });
        }
    }
    free(blocks);
}

static void expect_brute_force(feed *f, const variation_case *c)
{
    result r = run_pass(f, c);
    double *depth = malloc((size_t) c->width * c->height * sizeof *depth);
    assert_non_null(depth);
    for (int layer = 0; layer < (c->layers > 0 ? c->layers : 1); layer++) {
        for (int y = 0; y < c->height; y++)
            for (int x = 0; x < c->width; x++)
                depth[(size_t) y * c->width + x] = derivative(f, c, layer, x, y);
        for (int level = r.pass.first; level <= c->levels; level++)
            expect_level(f, c, &r, layer, level, depth);
    }
    free(depth);
    result_finish(&r);
}

// ---- facts -------------------------------------------------------------------------------------

static size_t fed_texels(const feed *f)
{
    return (size_t) f->width * f->height * (f->layers > 0 ? f->layers : 1);
}

// A tenth of it background; `calm`: nearly equal values, as within a surface.
static void feed_noise(feed *f, uint32_t seed, bool calm)
{
    for (size_t i = 0; i < fed_texels(f); i++) {
        const double spread = calm ? 1e-3 : 1;
        if (feed_random(&seed) < 0.1)
            continue;
        f->depth[i] = (float) (1e-3 + (calm ? 0.5 : 0) + 0.4 * spread * feed_random(&seed));
        double n[3], length = 1e-6;
        for (int k = 0; k < 3; k++) {
            n[k] = (k == 2) + spread * (2 * feed_random(&seed) - 1);
            length += n[k] * n[k];
        }
        for (int k = 0; k < 3; k++)
            f->normal[i][k] = (float) (n[k] / sqrt(length));
        f->normal[i][3] = 1;
    }
}

static void noise_is_reduced_as_by_brute_force(void **state)
{
    static const int sizes[][2] = { { 1, 1 },   { 2, 1 },   { 1, 2 },     { 2, 2 },     { 3, 2 },
                                    { 64, 64 }, { 65, 63 }, { 255, 255 }, { 1023, 517 } };
    (void) state;
    for (int i = 0; i < FG_COUNT(sizes); i++) {
        for (int k = 0; k < 4; k++) {
            if (sizes[i][0] > 1000 && k > 1)
                continue; // the rest at smaller sizes
            const variation_case c = {
                .width = sizes[i][0],
                .height = sizes[i][1],
                .levels = k == 2 ? 3 : AG_MAX_LEVELS,
                .first = k == 0 ? 0 : k,
                .metric = k % 2 ? AG_DEPTH_SLOPE : AG_DEPTH_PLANE,
                .orthographic = k == 3,
            };
            feed f;
            feed_init(&f, c.width, c.height, 0);
            f.orthographic = c.orthographic;
            feed_noise(&f, 7u + (uint32_t) i, k == 1);
            expect_brute_force(&f, &c);
            feed_finish(&f);
        }
    }
}

static void faces_of_lights_are_reduced_each_for_itself(void **state)
{
    static const int sizes[][3] = {
        { 1, 1, 3 }, { 2, 2, 2 }, { 64, 64, 6 }, { 65, 63, 3 }, { 32, 32, 11 }
    };
    (void) state;
    for (int i = 0; i < FG_COUNT(sizes); i++) {
        for (int k = 0; k < 4; k++) {
            const variation_case c = {
                .width = sizes[i][0],
                .height = sizes[i][1],
                .layers = sizes[i][2],
                .levels = 5,
                .first = k,
                .metric = k % 2 ? AG_DEPTH_SLOPE : AG_DEPTH_PLANE,
                .orthographic = k > 1,
            };
            feed f;
            feed_init(&f, c.width, c.height, c.layers);
            f.orthographic = c.orthographic;
            feed_noise(&f, 70u + (uint32_t) i, k == 1);
            expect_brute_force(&f, &c);
            feed_finish(&f);
        }
    }
}

// The most of a level: of component `k` of the change, and of depth.
static void most_of_level(const result *r, int layer, int level, int k, float most[2])
{
    most[0] = most[1] = 0;
    for (int y = 0; y < r->pass.pyramid.base[1] >> (level - 1); y++) {
        for (int x = 0; x < r->pass.pyramid.base[0] >> (level - 1); x++) {
            const size_t place = place_of(r, layer, level, x, y);
            most[0] = fmaxf(most[0], r->change[place + (size_t) k]);
            most[1] = fmaxf(most[1], r->range[place + 1]);
        }
    }
}

// One texel that stands out, of depth or of normal: the blocks about it see it at every level.
static void expect_spikes(const int size[2], int (*spikes)[2], int count, ag_depth_metric metric,
                          bool depth)
{
    const variation_case c = { size[0], size[1], count, AG_MAX_LEVELS, 1, metric, false };
    feed f;
    feed_init(&f, size[0], size[1], count);
    for (size_t i = 0; i < fed_texels(&f); i++) {
        f.depth[i] = 0.5f;
        f.normal[i][2] = f.normal[i][3] = 1;
    }
    for (int i = 0; i < count; i++) {
        const size_t at = ((size_t) i * size[1] + spikes[i][1]) * size[0] + spikes[i][0];
        if (depth)
            f.depth[at] = 0.6f;
        else
            f.normal[at][0] = 0.5f;
    }
    expect_brute_force(&f, &c);
    result r = run_pass(&f, &c);
    for (int k = 0; k < count * c.levels; k++) {
        const int i = k / c.levels, level = 1 + k % c.levels;
        float most[2];
        most_of_level(&r, i, level, depth ? 3 : 0, most);
        if (most[0] < 0.1f || (depth && most[1] != 0.6f))
            fail_msg("%d x %d: spike at %d, %d, metric %d is lost on level %d: %g", size[0],
                     size[1], spikes[i][0], spikes[i][1], (int) metric, level, (double) most[0]);
    }
    result_finish(&r);
    feed_finish(&f);
}

static void no_texel_of_the_border_is_lost(void **state)
{
    static const int sizes[][2] = { { 2, 1 }, { 2, 2 }, { 3, 3 }, { 7, 5 }, { 13, 9 }, { 33, 31 } };
    (void) state;
    for (int s = 0; s < FG_COUNT(sizes); s++) {
        int spikes[128][2], count = 0;
        const int w = sizes[s][0], h = sizes[s][1];
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++)
                if (x == 0 || y == 0 || x == w - 1 || y == h - 1) {
                    spikes[count][0] = x;
                    spikes[count++][1] = y;
                }
        for (int k = 0; k < 4; k++)
            expect_spikes(sizes[s], spikes, count, k % 2 ? AG_DEPTH_SLOPE : AG_DEPTH_PLANE, k < 2);
    }
}

// No horizon in block (x, y) of level 1 or about it.
static bool is_whole(const feed *f, int x, int y)
{
    for (int k = 0; k < 16; k++)
        if (!(depth_at(f, 0, 2 * x + k % 4 - 1, 2 * y + k / 4 - 1) > 0))
            return false;
    return true;
}

// The blocks of level 1 that show one plane alone change by `bound` at most.
static void expect_flat(const feed *f, const result *r, double bound, int plane)
{
    const int across = f->width / 2, down = f->height / 2;
    for (int i = 0; i < across * down; i++) {
        const int x = i % across, y = i / across;
        const float *got = r->change + place_of(r, 0, 1, x, y);
        if (is_whole(f, x, y) && (double) got[3] > bound)
            fail_msg("plane %d, block %d, %d: %g", plane, x, y, (double) got[3]);
    }
}

// Reversed depth of a plane is linear over the screen. Rounded to float, the three depths depart by
// 2^-24 of themselves at most, the middle one twice over, and their sum by one such step more:
// 5 x 2^-24 by axis, sqrt(2) of that by both, and what half floats add.
static void planes_do_not_bend_however_steep(void **state)
{
    (void) state;
    static const double slopes[][3] = { { 0, 0, 1 },   { 0.5, 0.2, 1 }, { 3, -2, 1 },
                                        { 20, 30, 1 }, { 0, 1, 0 },     { 1e-3, 1, 0.01 } };
    const double bound = 5 * 0x1p-24 * sqrt(2) * 1.002 + 1e-6;
    for (int i = 0; i < FG_COUNT(slopes); i++) {
        const variation_case c = {
            .width = 130, .height = 65, .levels = AG_MAX_LEVELS, .first = 1
        };
        feed f;
        feed_init(&f, c.width, c.height, 0);
        feed_plane(&f, (int[4]){ 0, 0, c.width, c.height }, slopes[i], -1);
        result r = run_pass(&f, &c);
        expect_flat(&f, &r, bound, i);
        result_finish(&r);
        feed_finish(&f);
    }
}

// Far away the depth is small; against background it is still the whole of itself.
static void rims_of_surfaces_show(void **state)
{
    (void) state;
    for (int k = 0; k < 4; k++) {
        const variation_case c = { .width = 64,
                                   .height = 64,
                                   .levels = 2,
                                   .first = 1,
                                   .metric = k % 2 ? AG_DEPTH_SLOPE : AG_DEPTH_PLANE };
        feed f;
        feed_init(&f, c.width, c.height, 0);
        const int edge = 21 + k / 2; // within a block, and between two
        feed_plane(&f, (int[4]){ 0, 0, edge, 64 }, (double[3]){ 0, 0, 1 }, k < 2 ? -1 : -1e6);
        result r = run_pass(&f, &c);
        for (int i = 0; i < 32 + 16; i++) {
            const int level = i < 32 ? 1 : 2, y = i % 32;
            // The rim is between two texels: one of their blocks sees both.
            const float *l = r.change + place_of(&r, 0, level, (edge - 1) >> level, y);
            const float *h = r.change + place_of(&r, 0, level, edge >> level, y);
            assert_true(fmaxf(l[3], h[3]) >= 1 && fmaxf(l[2], h[2]) >= 1);
        }
        result_finish(&r);
        feed_finish(&f);
    }
}

static void mistakes_are_named(void **state)
{
    static const struct {
        variation_case c;
        const char *message;
    } mistakes[] = {
        { { .width = 8, .height = 8, .levels = 7 }, "test: levels 0 to 7, must lie in [1, 6]" },
        { { .width = 8, .height = 8, .levels = 0 }, "test: levels 0 to 0, must lie in [1, 6]" },
        { { .width = 8, .height = 8, .levels = 2, .first = 3 },
          "test: levels 3 to 2, must lie in [1, 6]" },
        { { .width = 0, .height = 8, .levels = 2 }, "test: variation of 0 x 8 x 0 texels" },
    };
    (void) state;
    feed f;
    feed_init(&f, 8, 8, 0);
    for (int i = 0; i < FG_COUNT(mistakes); i++) {
        ag_variation_pass pass;
        feed_begin(&f);
        const ag_variation_desc desc = {
            .prefix = "test",
            .depth = f.gbuffer.depth,
            .normal = f.gbuffer.normal,
            .width = mistakes[i].c.width,
            .height = mistakes[i].c.height,
            .levels = mistakes[i].c.levels,
            .first = mistakes[i].c.first,
        };
        log_clear();
        ag_variation_declare(&pass, f.graph, &f.scene, &desc);
        assert_int_equal(fg_graph_compile(f.graph), FG_ERR_INVALID);
        assert_non_null(strstr(log_text(), mistakes[i].message));
    }
    feed_finish(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_reduced_as_by_brute_force),
        cmocka_unit_test(faces_of_lights_are_reduced_each_for_itself),
        cmocka_unit_test(no_texel_of_the_border_is_lost),
        cmocka_unit_test(planes_do_not_bend_however_steep),
        cmocka_unit_test(rims_of_surfaces_show),
        cmocka_unit_test(mistakes_are_named),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
