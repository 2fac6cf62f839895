// SPDX-License-Identifier: MIT
// Paraboloid shadow maps: every texel against a ray through its middle, straight edges, what is
// drawn when, what a lookup says.
#include "feed.h"
#include "scenes.h"

#include <epoxy/gl.h>
#include <math.h>
#include <pass/math.h>
#include <pass/paraboloid.h>
#include <pass/rays.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979;

// ---- maps of a scene ----------------------------------------------------------------------------

typedef struct host {
    ag_scene *scene;
    fg_graph *graph;
    ag_paraboloid_maps *maps;
    ag_paraboloid_pass pass;
    ag_rays *rays; // about `centre`
    double centre[3];
    double unit; // of the maps, 1/m
    int size, edge;
} host;

static void host_init(host *h, ag_scene *scene, int size, int capacity)
{
    const ag_paraboloid_desc desc = {
        .log = test_log(), .device = device(), .scene = scene, .size = size, .capacity = capacity
    };
    ag_rays_desc rays = { .log = test_log(), .scene = scene, .static_only = true };
    *h = (host){ .scene = scene, .size = size };
    for (int k = 0; k < 3; k++)
        h->centre[k] = rays.origin[k] = 0.5 * (scene->box_min[k] + scene->box_max[k]);
    assert_int_equal(ag_paraboloid_create(&desc, &h->maps), FG_OK);
    assert_int_equal(ag_rays_create(&rays, &h->rays), FG_OK);
    h->graph = fg_graph_create(&(fg_graph_desc){ .device = device(), .log = test_log() });
    fg_graph_begin(h->graph, &(fg_frame_desc){ .width = 16, .height = 16 });
    ag_paraboloid_declare(&h->pass, h->graph, h->maps, "test");
    fg_export(h->graph, h->pass.maps);
    assert_int_equal(fg_graph_compile(h->graph), FG_OK);
    double sum = 0;
    int exponent;
    for (int k = 0; k < 3; k++)
        sum += pow(scene->box_max[k] - scene->box_min[k], 2);
    frexp(sqrt(sum), &exponent);
    h->unit = ldexp(1, -exponent);
}

static void host_finish(host *h)
{
    fg_graph_destroy(h->graph);
    ag_paraboloid_destroy(h->maps);
    ag_rays_destroy(h->rays);
    ag_scene_destroy(h->scene);
}

static ag_scene *built_in(const char *name)
{
    ag_scene *scene = NULL;
    assert_int_equal(scenes_open(test_log(), name, &scene), FG_OK);
    return scene;
}

static void draw(host *h, const ag_paraboloid_eye *eyes, int count)
{
    ag_camera camera = plain_camera("anywhere");
    ag_view view;
    assert_int_equal(ag_view_from_camera(test_log(), &camera, 16, 16, &view), FG_OK);
    ag_paraboloid_set(h->maps, eyes, count, &view);
    assert_int_equal(fg_graph_run(h->graph), FG_OK);
}

// The texels of one map, the caller's to free. Maps lie in rows of squares.
static float *read_map(const host *h, int slot)
{
    const uint32_t texture = fg_graph_exported(h->graph, h->pass.maps);
    const size_t bytes = sizeof(float) * (size_t) h->size * (size_t) h->size;
    float *texels = malloc(bytes);
    GLint width = 0;
    assert_non_null(texels);
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_WIDTH, &width);
    const int edge = width / h->size, in_layer = slot % (edge * edge);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glGetTextureSubImage(texture, 0, in_layer % edge * h->size, in_layer / edge * h->size,
                         slot / (edge * edge), h->size, h->size, 1, GL_RED, GL_FLOAT,
                         (GLsizei) bytes, texels);
    return texels;
}

// ---- against rays -------------------------------------------------------------------------------

// The ray of a place in a map, texels' middles at whole numbers; false where no lookup comes. What
// is beyond the horizon shows what is just inside of it.
static bool map_ray(const ag_paraboloid_eye *eye, int size, double x, double y, double d[3])
{
    double u = (2 * x + 1) / size - 1, v = (2 * y + 1) / size - 1, n[3], t[3], b[3];
    const double s = sqrt(u * u + v * v), horizon = 1 - 1.0 / 4096;
    for (int k = 0; k < 3; k++)
        n[k] = (double) eye->normal[k];
    ag_frame_about(n, t, b);
    if (s > horizon) {
        u *= horizon / s;
        v *= horizon / s;
    }
    const double l = u * u + v * v;
    for (int k = 0; k < 3; k++)
        d[k] = (2 * u * t[k] + 2 * v * b[k] + (1 - l) * n[k]) / (1 + l);
    return s <= 1 + 3.0 / size;
}

// Reciprocal distance by a ray, 0 where it meets nothing, and how far off it may be: half floats
// are off by 2^-11 where rounded to the nearest, 2^-10 where cut, and planes nearer to the eye than
// 2^-20 are moved away to that.
static double by_ray(const host *h, const ag_paraboloid_eye *eye, const double d[3], double *off)
{
    float from[3], direction[3];
    ag_hit hit;
    for (int k = 0; k < 3; k++) {
        // Off the surface, as far as the maps take it to be.
        const double rise = (double) eye->normal[k] * 0x1p-20 / h->unit;
        from[k] = (float) (eye->position[k] + rise - h->centre[k]);
        direction[k] = (float) d[k];
    }
    if (!ag_rays_nearest(h->rays, from, direction, 0, INFINITY, &hit))
        return *off = 0;
    double cosine = 0;
    for (int k = 0; k < 3; k++)
        cosine += d[k] * (double) hit.face_normal[k];
    const double w = fmin(1 / ((double) hit.distance * h->unit), 65504);
    *off = w * (0x1p-10 + 0x1p-19 * w / fmax(fabs(cosine), 1e-9));
    return w;
}

typedef struct verdict {
    int texels, edges, wrong;
} verdict;

// Whether a texel has what rays find within `angle` of its middle.
static bool is_near_edge(const host *h, const ag_paraboloid_eye *eye, double x, double y,
                         double got, double angle)
{
    double low = INFINITY, high = 0;
    for (int i = 0; i < 16; i++) {
        const double r = angle * h->size / 4 * (i < 8 ? 1 : 0.3), phi = pi * i / 4;
        double d[3], off;
        map_ray(eye, h->size, x + r * cos(phi), y + r * sin(phi), d);
        const double w = by_ray(h, eye, d, &off);
        low = fmin(low, w - off);
        high = fmax(high, w + off);
    }
    return got >= low && got <= high;
}

static verdict check_map(const host *h, const ag_paraboloid_eye *eye, const float *texels, int step)
{
    verdict v = { 0 };
    for (int y = step / 2; y < h->size; y += step)
        for (int x = step / 2; x < h->size; x += step) {
            double d[3], off;
            const double got = (double) texels[y * h->size + x];
            if (!map_ray(eye, h->size, x, y, d)) {
                assert_true(got == 0);
                continue;
            }
            const double truth = by_ray(h, eye, d, &off);
            v.texels++;
            if (fabs(got - truth) <= off)
                continue;
            // What is near moves with the eye, which stands 2^-20 off its surface at one side.
            const double angle = 1e-5 + 0x1p-19 * fmax(got, truth);
            if (is_near_edge(h, eye, x, y, got, angle)) {
                v.edges++;
                continue;
            }
            if (v.wrong++ < 5)
                print_message("texel %d %d has %.6g, a ray says %.6g\n", x, y, got, truth);
        }
    return v;
}

// Where a random ray from a random place within the scene's box ends.
static ag_paraboloid_eye random_eye(const host *h, uint32_t *seed, int slot)
{
    ag_paraboloid_eye eye = { .slot = slot, .fresh = true };
    for (int tries = 0; tries < 1000; tries++) {
        float from[3], d[3], length = 0;
        ag_hit hit;
        for (int k = 0; k < 3; k++) {
            const double edge = h->scene->box_max[k] - h->scene->box_min[k];
            from[k] = (float) ((feed_random(seed) - 0.5) * 0.9 * edge);
            d[k] = (float) (feed_random(seed) - 0.5);
            length += d[k] * d[k];
        }
        if (length == 0 || !ag_rays_nearest(h->rays, from, d, 0, INFINITY, &hit))
            continue;
        for (int k = 0; k < 3; k++) {
            eye.position[k] = h->centre[k] + (double) hit.position[k];
            eye.normal[k] = hit.front ? hit.face_normal[k] : -hit.face_normal[k];
        }
        return eye;
    }
    fail_msg("no surface to stand on");
    return eye;
}

static void check_scene(ag_scene *scene, int size, int count, int step)
{
    ag_paraboloid_eye eyes[16];
    uint32_t seed = 7;
    host h;
    host_init(&h, scene, size, count);
    for (int i = 0; i < count; i++)
        eyes[i] = random_eye(&h, &seed, i);
    draw(&h, eyes, count);
    assert_int_equal(ag_paraboloid_drawn(h.maps), count);
    for (int i = 0; i < count; i++) {
        float *texels = read_map(&h, i);
        const verdict v = check_map(&h, &eyes[i], texels, step);
        print_message("%s: map %d of %d texels: %d at edges, %d wrong\n", scene->name, i, v.texels,
                      v.edges, v.wrong);
        assert_int_equal(v.wrong, 0);
        free(texels);
    }
    host_finish(&h);
}

static void texels_of_cornell_are_rays(void **state)
{
    (void) state;
    check_scene(built_in("cornell"), 256, 8, 3);
}

static void texels_of_the_atrium_are_rays(void **state)
{
    (void) state;
    check_scene(built_in("atrium"), 256, 12, 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_of_cornell_are_rays),
        cmocka_unit_test(texels_of_the_atrium_are_rays),
    };
    return cmocka_run_group_tests(tests, device_setup, device_teardown);
}
