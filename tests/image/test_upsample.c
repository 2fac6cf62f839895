// SPDX-License-Identifier: MIT
// Interpolation of a multiresolution image: what goes in is made up at the valid texels, the rest
// of the image is NaN.
#include "feed.h"

#include <epoxy/gl.h>
#include <math.h>
#include <pass/gather.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Illumination at a place on the screen, pixels, of what is seen at pixel `seen`.
typedef void value_fn(const feed *f, const double place[2], const int seen[2], float rgb[3]);

// In place while the graph runs.
static ag_multires_pass eye;
static ag_upsample_pass upsample;
static ag_gather_pass gather;

static uint32_t *valid_texels(feed *f, const ag_multires_desc *desc, uint32_t *count)
{
    feed_begin(f);
    ag_multires_declare(&eye, f->graph, &f->scene, &f->gbuffer, desc);
    fg_export(f->graph, eye.texels);
    fg_export(f->graph, eye.count);
    feed_run(f);
    uint32_t *head = feed_words(f, eye.count, 1);
    *count = head[0];
    free(head);
    return feed_words(f, eye.texels, (size_t) eye.capacity);
}

static float *illumination(feed *f, const ag_multires_desc *desc, value_fn *value)
{
    uint32_t count;
    uint32_t *texels = valid_texels(f, desc, &count);
    const int *size = eye.pyramid.size;
    float *rgba = malloc((size_t) 16 * size[0] * size[1]);
    assert_non_null(rgba);
    for (int i = 0; i < 4 * size[0] * size[1]; i++)
        rgba[i] = NAN;
    for (uint32_t i = 0; i < count; i++) {
        const int level = (int) (texels[i] >> 28), x = (int) (texels[i] & 0x3fff),
                  y = (int) (texels[i] >> 14 & 0x3fff), edge = 1 << level;
        int origin[2];
        ag_pyramid_origin(&eye.pyramid, level, origin);
        float *to = rgba + 4 * ((size_t) (origin[1] + y) * size[0] + origin[0] + x);
        value(f, (double[2]){ (x + 0.5) * edge, (y + 0.5) * edge },
              (int[2]){ x * edge + (edge - 1) / 2, y * edge + (edge - 1) / 2 }, to);
        to[3] = 1;
    }
    free(texels);
    return rgba;
}

// At every pixel, rgba.
static float *interpolate(feed *f, const ag_multires_desc *desc, value_fn *value)
{
    float *rgba = illumination(f, desc, value);
    const fg_tex_desc tex = { .format = FG_RGBA32F,
                              .width = eye.pyramid.size[0],
                              .height = eye.pyramid.size[1] };
    GLuint texture;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, GL_RGBA32F, tex.width, tex.height);
    glTextureSubImage2D(texture, 0, 0, 0, tex.width, tex.height, GL_RGBA, GL_FLOAT, rgba);
    free(rgba);
    feed_begin(f);
    ag_multires_declare(&eye, f->graph, &f->scene, &f->gbuffer, desc);
    ag_upsample_declare(&upsample, f->graph, &eye,
                        fg_import_texture(f->graph, "values", &tex, texture), "test");
    fg_export(f->graph, upsample.out);
    feed_run(f);
    glDeleteTextures(1, &texture);
    return feed_texels(f, upsample.out);
}

static const char *name_of(const ag_multires_desc *d)
{
    static char text[128];
    snprintf(text, sizeof text,
             "%d x %d, coarsest %d, share %d, depth %g, normal %g, unbalanced %d", d->width,
             d->height, d->coarsest, d->share, (double) d->depth, (double) d->normal,
             d->unbalanced);
    return text;
}

static bool shows_surface(const feed *f, int pixel)
{
    return f->normal[pixel][3] > 0;
}

static const int sizes[][2] = { { 1, 1 },   { 2, 1 },   { 2, 2 },     { 9, 5 },
                                { 64, 64 }, { 65, 63 }, { 255, 131 }, { 1023, 517 } };

// ---- constants ---------------------------------------------------------------------------------

static void constant_value(const feed *f, const double place[2], const int seen[2], float rgb[3])
{
    (void) f, (void) place, (void) seen;
    rgb[0] = 1.0f / 3;
    rgb[1] = 1.2345e-5f;
    rgb[2] = 7e4f;
}

static void expect_constant(feed *f, const ag_multires_desc *desc)
{
    float *out = interpolate(f, desc, constant_value), want[4] = { 0, 0, 0, 1 };
    constant_value(f, NULL, NULL, want);
    for (int i = 0; i < f->width * f->height; i++) {
        const float *got = out + 4 * (size_t) i;
        if (shows_surface(f, i) && !same_bits(got, want, sizeof want))
            fail_msg("%s: pixel %d, %d is %.9g, %.9g, %.9g", name_of(desc), i % f->width,
                     i / f->width, (double) got[0], (double) got[1], (double) got[2]);
    }
    free(out);
}

// With every share; at a large size with one.
static void expect_constants(feed *f, int kind, uint32_t *seed)
{
    const bool large = f->width > 1000;
    for (int share = large ? kind - 1 : 0; share <= (large ? kind - 1 : 3); share++) {
        const ag_multires_desc desc = {
            .prefix = "test",
            .width = f->width,
            .height = f->height,
            .coarsest = feed_random(seed) < 0.5 ? 64 : 4,
            .depth = (float) pow(10, -3 + 2 * feed_random(seed)),
            .normal = (float) (0.01 + 0.5 * feed_random(seed)),
            .share = share,
            .unbalanced = feed_random(seed) < 0.3,
        };
        expect_constant(f, &desc);
    }
}

static void a_constant_stays_as_it_is_to_the_bit(void **state)
{
    uint32_t seed = 31;
    (void) state;
    for (int s = 0; s < FG_COUNT(sizes); s++) {
        for (int kind = FEED_ONE_PIXEL; kind < FEED_KINDS; kind++) {
            feed f;
            feed_init(&f, sizes[s][0], sizes[s][1], 0);
            feed_scene(&f, (feed_kind) kind, 5u + (uint32_t) s);
            expect_constants(&f, kind, &seed);
            feed_finish(&f);
        }
    }
}

// ---- linear ------------------------------------------------------------------------------------

// From 1 to 2 over the image.
static void linear_value(const feed *f, const double place[2], const int seen[2], float rgb[3])
{
    (void) seen;
    const double x = place[0] / f->width, y = place[1] / f->height;
    rgb[0] = (float) (1 + 0.4 * x + 0.6 * y);
    rgb[1] = (float) (2 - x);
    rgb[2] = (float) (2 - y);
}

// Blocks of a level with flags that hold an edge or reach beyond the image.
enum { MIXED = 2 };

// Whether the blocks of level `share` at a pixel and about it are whole. `flags`: of `eye`.
static bool is_inside(const uint32_t *flags, int x, int y)
{
    const int share = eye.share, *base = eye.pyramid.base;
    for (int k = 0; k < 9; k++) {
        const int i = (x >> share) + k % 3 - 1, j = (y >> share) + k / 3 - 1;
        if (i >= 0 && j >= 0 && i < base[0] >> share && j < base[1] >> share &&
            flags[ag_multires_flag_start(&eye, share) + j * (base[0] >> share) + i] & MIXED)
            return false;
    }
    return true;
}

static uint32_t *flags_of(feed *f, const ag_multires_desc *desc)
{
    feed_begin(f);
    ag_multires_declare(&eye, f->graph, &f->scene, &f->gbuffer, desc);
    fg_export(f->graph, eye.flags);
    feed_run(f);
    return feed_words(f, eye.flags, (size_t) ag_multires_flag_start(&eye, eye.pyramid.levels));
}

// On the plane that fills the view: to float rounding, wherever levels change. Near shared blocks
// that hold an edge or the image's rim, pieces of surfaces are averaged: off by what the light
// changes over one block.
static void expect_linear(feed *f, const ag_multires_desc *desc)
{
    uint32_t *flags = flags_of(f, desc);
    float *out = interpolate(f, desc, linear_value);
    const double block = (double) (1 << eye.share);
    const double near_bound = eye.share > 0 ? block * (0.4 / f->width + 0.6 / f->height) : 1e-5;
    const double near[3] = { near_bound, block / f->width, block / f->height };
    for (int i = 0; i < f->width * f->height; i++) {
        const int x = i % f->width, y = i / f->width;
        const bool inside = eye.share == 0 || is_inside(flags, x, y);
        float want[3];
        if ((double) f->position[i][2] > -1.01)
            continue; // the object
        linear_value(f, (double[2]){ x + 0.5, y + 0.5 }, NULL, want);
        int k = 0;
        double error = 0;
        for (; k < 3; k++) {
            error = fabs((double) out[4 * i + k] - (double) want[k]);
            if (!(error <= (inside ? 1e-5 : near[k])))
                break;
        }
        if (k < 3)
            fail_msg("%s: pixel %d, %d, channel %d is off by %g, inside %d", name_of(desc), x, y, k,
                     error, inside);
    }
    free(out);
    free(flags);
}

static void what_is_linear_stays_so_within_a_surface(void **state)
{
    (void) state;
    for (int s = 0; s < FG_COUNT(sizes); s++) {
        for (int k = 0; k < 8; k++) {
            const int share = k % 2 * 3, coarsest = k / 2 % 2 ? 64 : 8, w = sizes[s][0];
            if (w > 1000 && k != 4 && k != 5 && k != 0)
                continue;
            feed f;
            feed_init(&f, w, sizes[s][1], 0);
            feed_scene(&f, FEED_ONE_PLANE, 1);
            // Nowhere so near to the rim that a texel between has no neighbour on either side: such
            // a one is taken as even.
            if (k / 4 && (w > 100 || (w >= 64 && coarsest == 64)))
                feed_plane(&f, (int[4]){ w / 3, 20, w / 3 + 3, 23 }, (double[3]){ 0, 0, 1 }, -1);
            const ag_multires_desc desc = {
                .prefix = "test",
                .width = f.width,
                .height = f.height,
                .coarsest = coarsest,
                .depth = 0.005f,
                .normal = 0.25f,
                .share = share,
            };
            if (w != 2) // a single texel of two pixels has no neighbour either
                expect_linear(&f, &desc);
            feed_finish(&f);
        }
    }
}

// ---- edges -------------------------------------------------------------------------------------

typedef enum edge_kind {
    STEP = 0, // the left half nearer, along a slanted line
    FOLD,     // two walls that meet
    WIRE,     // a pixel wide in front of a wall
    EDGE_KINDS,
} edge_kind;

static void feed_edge(feed *f, edge_kind kind)
{
    const int w = f->width, h = f->height;
    if (kind == FOLD) {
        feed_plane(f, (int[4]){ 0, 0, w, h }, (double[3]){ 0.5, 0.2, 1 }, -2);
        feed_plane(f, (int[4]){ 0, 0, w, h }, (double[3]){ -0.5, 0.1, 1 }, -2);
        return;
    }
    feed_plane(f, (int[4]){ 0, 0, w, h }, (double[3]){ 0, 0, 1 }, -2);
    for (int y = 0; y < h; y++) {
        const int x = (w + y) / 3;
        feed_plane(f, (int[4]){ kind == STEP ? 0 : x, y, x + 1, y + 1 }, (double[3]){ 0, 0, 1 },
                   -1);
    }
}

// Which of the two surfaces a pixel shows.
static bool is_first(const feed *f, int pixel)
{
    return (double) f->position[pixel][2] > -1.5 || (double) f->normal[pixel][0] > 0.2;
}

static void two_values(const feed *f, const double place[2], const int seen[2], float rgb[3])
{
    (void) place;
    rgb[0] = is_first(f, seen[1] * f->width + seen[0]) ? 5 : 1;
    rgb[1] = 3 * rgb[0];
    rgb[2] = 1 / rgb[0];
}

// Not by a bit: each pixel takes only what its own surface has.
static void expect_no_bleeding(feed *f, const ag_multires_desc *desc, edge_kind kind)
{
    float *out = interpolate(f, desc, two_values);
    for (int i = 0; i < f->width * f->height; i++) {
        float want[4] = { 0, 0, 0, 1 };
        two_values(f, NULL, (int[2]){ i % f->width, i / f->width }, want);
        const float *got = out + 4 * (size_t) i;
        if (!same_bits(got, want, sizeof want))
            fail_msg("%s, edge %d: pixel %d, %d is %.9g, not %g", name_of(desc), (int) kind,
                     i % f->width, i / f->width, (double) got[0], (double) want[0]);
    }
    free(out);
}

static void no_light_crosses_an_edge(void **state)
{
    (void) state;
    for (int s = 0; s < FG_COUNT(sizes); s++) {
        for (int k = 0; k < 4 * EDGE_KINDS; k++) {
            const int share = k % 4;
            if (sizes[s][0] > 1000 && share != k / 4)
                continue;
            feed f;
            feed_init(&f, sizes[s][0], sizes[s][1], 0);
            feed_edge(&f, (edge_kind) (k / 4));
            const ag_multires_desc desc = {
                .prefix = "test",
                .width = f.width,
                .height = f.height,
                .coarsest = s % 2 ? 64 : 8,
                .depth = 0.005f,
                .normal = 0.25f,
                .share = share,
                .unbalanced = s == 5,
            };
            expect_no_bleeding(&f, &desc, (edge_kind) (k / 4));
            feed_finish(&f);
        }
    }
}

// ---- what is no number -------------------------------------------------------------------------

// Texels that are not valid are NaN in every test here. A pixel of the G-buffer that is, in
// position or normal or both, spoils no other.
static void expect_nan_stays(feed *f, const ag_multires_desc *desc, int pixel, int what)
{
    static const uint32_t edges[2] = { 0x00003c00, 0x3c000000 }; // half floats (1, 0), (0, 1)
    const uint32_t count[4] = { 1, 1 };
    float vpl[12] = { 0.2f, 0.1f, -0.5f, 0.01f, 0, 0, -1, 0, 1, 1, 1, 0 };
    uint32_t buffers[2];
    memcpy(vpl + 7, &edges[0], 4);
    memcpy(vpl + 11, &edges[1], 4);
    for (int k = 0; k < 3; k++) {
        f->position[pixel][k] = what & 1 ? NAN : f->position[pixel][k];
        f->normal[pixel][k] = what & 2 ? NAN : f->normal[pixel][k];
    }
    feed_begin(f);
    glCreateBuffers(2, buffers);
    glNamedBufferStorage(buffers[0], sizeof vpl, vpl, 0);
    glNamedBufferStorage(buffers[1], sizeof count, count, 0);
    const fg_buf_desc list = { .size = sizeof vpl }, head = { .size = sizeof count };
    const ag_vpl_pass vpls = {
        .vpls = fg_import_buffer(f->graph, "vpls", &list, buffers[0]),
        .count = fg_import_buffer(f->graph, "vpl_count", &head, buffers[1]),
        .capacity = 1,
    };
    const ag_gather_desc sum = { .prefix = "test", .multires = &eye };
    ag_multires_declare(&eye, f->graph, &f->scene, &f->gbuffer, desc);
    ag_gather_declare(&gather, f->graph, &f->scene, &f->gbuffer, &vpls, &sum);
    ag_upsample_declare(&upsample, f->graph, &eye, gather.out, "test");
    fg_export(f->graph, upsample.out);
    feed_run(f);
    float *out = feed_texels(f, upsample.out);
    for (int i = 0; i < f->width * f->height; i++)
        for (int k = 0; k < 3; k++)
            if (i != pixel && !isfinite(out[4 * i + k]))
                fail_msg("%s, NaN %d at %d, %d: pixel %d, %d is %g", name_of(desc), what,
                         pixel % f->width, pixel / f->width, i % f->width, i / f->width,
                         (double) out[4 * i + k]);
    free(out);
    glDeleteBuffers(2, buffers);
}

static void what_is_no_number_stays_where_it_is(void **state)
{
    // Middle of a block of 8 and of coarser ones, corner of one, the image's corners.
    static const int places[][2] = { { 31, 31 }, { 28, 27 }, { 8, 8 }, { 0, 0 }, { 64, 62 } };
    (void) state;
    for (int i = 0; i < FG_COUNT(places); i++) {
        for (int k = 0; k < 6; k++) {
            feed f;
            feed_init(&f, 65, 63, 0);
            feed_scene(&f, FEED_ONE_PLANE, 1);
            const ag_multires_desc desc = {
                .prefix = "test",
                .width = 65,
                .height = 63,
                .coarsest = 8,
                .depth = 0.005f,
                .normal = 0.25f,
                .share = k / 3 * 3,
            };
            expect_nan_stays(&f, &desc, places[i][1] * 65 + places[i][0], 1 + k % 3);
            feed_finish(&f);
        }
    }
}

// ---- size --------------------------------------------------------------------------------------

// With thresholds of 0 each of 4 x 1040 x 1024 cells has an edge near: 66560 work groups, more than
// every device takes along one axis.
static void more_cells_than_one_axis_takes_fill_rows(void **state)
{
    (void) state;
    feed f;
    feed_init(&f, 2080, 2048, 0);
    feed_begin(&f);
    const ag_multires_desc desc = { .prefix = "test", .width = 2080, .height = 2048, .share = 1 };
    ag_multires_declare(&eye, f.graph, &f.scene, &f.gbuffer, &desc);
    const fg_tex_desc tex = { .format = FG_RGBA32F,
                              .width = eye.pyramid.size[0],
                              .height = eye.pyramid.size[1] };
    GLuint texture;
    glCreateTextures(GL_TEXTURE_2D, 1, &texture);
    glTextureStorage2D(texture, 1, GL_RGBA32F, tex.width, tex.height);
    ag_upsample_declare(&upsample, f.graph, &eye,
                        fg_import_texture(f.graph, "values", &tex, texture), "test");
    fg_export(f.graph, upsample.out);
    fg_export(f.graph, upsample.cells);
    feed_run(&f);
    uint32_t *head = feed_words(&f, upsample.cells, 4);
    assert_int_equal(head[3], 4 * 1040 * 1024);
    assert_true(head[0] <= 65535 && head[1] <= 65535 && head[2] == 1);
    assert_true(64ull * head[0] * head[1] >= head[3]);
    free(head);
    glDeleteTextures(1, &texture);
    feed_finish(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_constant_stays_as_it_is_to_the_bit),
        cmocka_unit_test(what_is_linear_stays_so_within_a_surface),
        cmocka_unit_test(no_light_crosses_an_edge),
        cmocka_unit_test(what_is_no_number_stays_where_it_is),
        cmocka_unit_test(more_cells_than_one_axis_takes_fill_rows),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
