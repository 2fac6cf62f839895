// SPDX-License-Identifier: MIT
// The box filter of interleaved sampling, on G-buffers and patterns made up here.
#include "feed.h"

#include <epoxy/gl.h>
#include <math.h>
#include <pass/interleave.h>
#include <stdlib.h>

static void whole(feed *f, const double n[3], double d)
{
    feed_plane(f, (int[4]){ 0, 0, f->width, f->height }, n, d);
}

typedef struct picture {
    feed f;
    float (*light)[4];
    uint32_t texture;
} picture;

static void picture_init(picture *p, int width, int height)
{
    p->texture = 0;
    feed_init(&p->f, width, height, 0);
    p->light = calloc((size_t) width * (size_t) height, sizeof *p->light);
    assert_non_null(p->light);
}

static void picture_finish(picture *p)
{
    glDeleteTextures(1, &p->texture);
    free(p->light);
    feed_finish(&p->f);
}

// A value for each tile, the same in every block. Returns their mean.
static double set_pattern(picture *p, int n)
{
    float value[AG_MAX_TILES * AG_MAX_TILES];
    uint32_t seed = 7;
    double mean = 0;
    for (int i = 0; i < n * n; i++) {
        value[i] = (float) feed_random(&seed);
        mean += (double) value[i] / (n * n);
    }
    for (int i = 0; i < p->f.width * p->f.height; i++)
        for (int k = 0; k < 3; k++)
            p->light[i][k] = value[i / p->f.width % n * n + i % p->f.width % n];
    return mean;
}

static float *filtered(picture *p, int n, ag_box_filter_desc desc)
{
    feed *f = &p->f;
    ag_split_pass split;
    ag_box_filter_pass filter;
    feed_begin(f);
    glDeleteTextures(1, &p->texture);
    glCreateTextures(GL_TEXTURE_2D, 1, &p->texture);
    glTextureStorage2D(p->texture, 1, GL_RGBA32F, f->width, f->height);
    glTextureSubImage2D(p->texture, 0, 0, 0, f->width, f->height, GL_RGBA, GL_FLOAT, p->light);
    const fg_tex_desc tex = { .format = FG_RGBA32F, .width = f->width, .height = f->height };
    const fg_res in = fg_import_texture(f->graph, "t.light", &tex, p->texture);
    ag_split_declare(&split, f->graph, &f->scene, &f->gbuffer,
                     &(ag_split_desc){ "t", n, f->width, f->height });
    ag_box_filter_declare(&filter, f->graph, &split, in, &desc);
    fg_export(f->graph, filter.out);
    feed_run(f);
    return feed_texels(f, filter.out);
}

static const ag_box_filter_desc plane = { .alpha = 0.01f, .beta = 0.8f };

// Whether the window of a pixel, shifted inwards at the border, is full.
static bool sees_all(const feed *f, int x, int y, int n)
{
    const int left = x - n / 2 < 0 ? 0 : x - n / 2 > f->width - n ? f->width - n : x - n / 2;
    const int low = y - n / 2 < 0 ? 0 : y - n / 2 > f->height - n ? f->height - n : y - n / 2;
    for (int i = 0; i < n * n; i++)
        if (f->position[(low + i / n) * f->width + left + i % n][3] <= 0)
            return false;
    return true;
}

// The pattern of a plane is gone where the plane fills the window. Returns how many pixels.
static int check_pattern(picture *p, int n, ag_box_filter_desc desc)
{
    const double mean = set_pattern(p, n);
    float *got = filtered(p, n, desc);
    int count = 0;
    for (int i = 0; i < p->f.width * p->f.height; i++) {
        const bool there = p->f.position[i][3] > 0;
        assert_true(got[(size_t) 4 * (size_t) i + 3] == (there ? 1 : 0));
        if (there && !sees_all(&p->f, i % p->f.width, i / p->f.width, n))
            continue;
        // A sum of at most 64 terms of below 1, and a division.
        assert_true(fabs((double) got[(size_t) 4 * (size_t) i] - (there ? mean : 0)) < 66 * 6e-8);
        count += there;
    }
    free(got);
    return count;
}

static void pattern_of_a_plane_goes(void **state)
{
    static const int sizes[][2] = { { 65, 63 }, { 8, 8 }, { 40, 9 } };
    // Head-on; at slants; a floor to the horizon, by a normal that no half float holds: its last
    // rows are 5 m and 16 m away, 0.1 m below the eye.
    static const double planes[][3] = {
        { 0, 0, 1 }, { 0.6, -0.3, 0.7 }, { 0.9, -0.3, 0.4 }, { 0.05, 1, 0.0071 }
    };
    const ag_box_filter_desc distance = { AG_BOX_DISTANCE, INFINITY, 0.8f };
    (void) state;
    for (int s = 0; s < FG_COUNT(sizes); s++)
        for (int i = 0; i < FG_COUNT(planes); i++) {
            const int pixels = sizes[s][0] * sizes[s][1], least = i < 2    ? pixels
                                                                  : s == 0 ? pixels / 8
                                                                           : 0;
            picture p;
            picture_init(&p, sizes[s][0], sizes[s][1]);
            whole(&p.f, planes[i], -0.1);
            for (int n = 2; n <= 8; n++)
                assert_true(check_pattern(&p, n, plane) >= least);
            check_pattern(&p, 5, distance);
            picture_finish(&p);
        }
}

static void pattern_goes_up_to_edges(void **state)
{
    enum { W = 41, H = 37 };
    // Left and right of a slanting edge: planes that meet there, and one far behind the other.
    (void) state;
    for (int far = 0; far < 2; far++)
        for (int n = 2; n <= 8; n++) {
            picture p;
            picture_init(&p, W, H);
            for (int y = 0; y < H; y++) {
                const int edge = 12 + y / 3;
                feed_plane(&p.f, (int[4]){ 0, y, edge, y + 1 }, (double[3]){ 0, 0, 1 }, -1);
                feed_plane(&p.f, (int[4]){ edge, y, W, y + 1 },
                           (double[3]){ far ? 0.1 : -1, 0, 0.4 }, far ? -9 : -0.4);
            }
            const double mean = set_pattern(&p, n);
            float *got = filtered(&p, n, plane);
            // Either part is 2 n - 1 pixels wide on all rows up to n = 6.
            for (int i = 0; i < W * H; i++)
                assert_true(n > 6 ||
                            fabs((double) got[(size_t) 4 * (size_t) i] - mean) < 66 * 6e-8);
            free(got);
            picture_finish(&p);
        }
}

static void light_stays_on_its_surface(void **state)
{
    enum { W = 32, H = 24 };
    // Right half: farther off; turned by 60 degrees about the edge, where only beta tells; nothing.
    static const double normals[][3] = { { 0, 0, 1 }, { -0.866, 0, 0.5 }, { 0, 0, 1 } };
    static const double depths[] = { -1.1, -0.5, 0 };
    (void) state;
    for (int c = 0; c < 3; c++)
        for (int metric = 0; metric < 2; metric++) {
            const ag_box_filter_desc desc = { metric ? AG_BOX_DISTANCE : AG_BOX_PLANE, 0.05f,
                                              0.8f };
            picture p;
            picture_init(&p, W, H);
            feed_plane(&p.f, (int[4]){ 0, 0, W / 2, H }, (double[3]){ 0, 0, 1 }, -1);
            if (depths[c] < 0)
                feed_plane(&p.f, (int[4]){ W / 2, 0, W, H }, normals[c], depths[c]);
            for (int i = 0; i < W * H; i++)
                for (int k = 0; k < 3; k++)
                    p.light[i][k] = i % W < W / 2 ? 3 : 5;
            float *got = filtered(&p, 4, desc);
            for (int i = 0; i < W * H; i++)
                assert_true(got[(size_t) 4 * (size_t) i] == (i % W < W / 2   ? 3
                                                             : depths[c] < 0 ? 5
                                                                             : 0));
            free(got);
            picture_finish(&p);
        }
}

static void a_pixel_counts_itself(void **state)
{
    enum { EDGE = 16 };
    picture p;
    (void) state;
    picture_init(&p, EDGE, EDGE);
    feed_scene(&p.f, FEED_NOISE, 3);
    for (int i = 0; i < EDGE * EDGE; i++)
        for (int k = 0; k < 3; k++)
            p.light[i][k] = (float) (i + 1);
    // No cosine is above 1.
    for (int metric = 0; metric < 2; metric++) {
        const ag_box_filter_desc desc = { metric ? AG_BOX_DISTANCE : AG_BOX_PLANE, 0, 1 };
        float *got = filtered(&p, 4, desc);
        for (int i = 0; i < EDGE * EDGE; i++)
            assert_true(got[(size_t) 4 * (size_t) i] ==
                        (p.f.position[i][3] > 0 ? (float) (i + 1) : 0));
        free(got);
    }
    picture_finish(&p);
}

static void what_is_not_finite_does_not_spread(void **state)
{
    enum { EDGE = 16, BAD = 5 * EDGE + 7 };
    static const float bad[] = { NAN, INFINITY, -INFINITY };
    (void) state;
    for (int b = 0; b < FG_COUNT(bad); b++) {
        picture p;
        picture_init(&p, EDGE, EDGE);
        whole(&p.f, (double[3]){ 0, 0, 1 }, -1);
        for (int i = 0; i < EDGE * EDGE; i++)
            for (int k = 0; k < 3; k++)
                p.light[i][k] = 3e38f; // a sum of them would overflow
        p.light[BAD][1] = bad[b];
        float *got = filtered(&p, 4, plane);
        for (int i = 0; i < 4 * EDGE * EDGE; i++) // to a last bit
            assert_true(fabs((double) got[i] / (i % 4 < 3 ? 3e38 : 1) - 1) < 2e-7);
        free(got);
        picture_finish(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pattern_of_a_plane_goes),
        cmocka_unit_test(pattern_goes_up_to_edges),
        cmocka_unit_test(light_stays_on_its_surface),
        cmocka_unit_test(a_pixel_counts_itself),
        cmocka_unit_test(what_is_not_finite_does_not_spread),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
