// SPDX-License-Identifier: MIT
#include "paraboloid.h"

#include "paraboloid_lookup_comp.h"
#include "scenes.h"

#include <epoxy/gl.h>
#include <math.h>
#include <pass/math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_RECEIVERS = 1 << 16 };

static const double pi = 3.14159265358979;

// ---- frames -------------------------------------------------------------------------------------

static fg_status run_first(const fg_run *run, void *user)
{
    (void) run;
    return ((const maps_host *) user)->fail ? FG_ERR_DEVICE : FG_OK;
}

static fg_status run_lookup(const fg_run *run, void *user)
{
    const maps_host *h = user;
    const fg_gl_program_desc desc = { .shaders = { &paraboloid_lookup_comp } };
    const uint32_t program = fg_gl_program(fg_run_device(run), &desc);
    if (!program)
        return FG_ERR_SHADER;
    fg_gl_uniform(run, 0, h->res.view);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, h->receivers);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, h->answers);
    ag_paraboloid_bind(run, &h->pass);
    glProgramUniform2i(program, 0, h->asked[0], h->asked[1]);
    glUseProgram(program);
    if (h->asked[1] > 0)
        fg_gl_dispatch_2d(h->asked[1], 1, 64, 1);
    return FG_OK;
}

static void declare(maps_host *h)
{
    const fg_pass_desc first = {
        .name = "test.first",
        .kind = FG_KIND_COMPUTE,
        .effect = FG_EFFECT_EXTERNAL,
        .run = run_first,
        .user = h,
    };
    fg_graph_begin(h->graph, &(fg_frame_desc){ .width = 16, .height = 16 });
    h->res = ag_gpu_scene_import(h->gpu, h->graph);
    fg_passes(h->graph, &first, 1);
    ag_paraboloid_declare(&h->pass, h->graph, h->maps, "test");
    const fg_pass_desc lookup = {
        .name = "test.lookup",
        .kind = FG_KIND_COMPUTE,
        .reads = { { h->res.view, FG_USE_UNIFORM }, AG_PARABOLOID_READS(h->pass) },
        .effect = FG_EFFECT_EXTERNAL,
        .run = run_lookup,
        .user = h,
    };
    fg_passes(h->graph, &lookup, 1);
    fg_export(h->graph, h->pass.maps);
    assert_int_equal(fg_graph_compile(h->graph), FG_OK);
}

// The power of two that brings the box's diagonal to (1/2, 1].
static double unit_of(const ag_scene *scene)
{
    double sum = 0;
    int exponent;
    for (int k = 0; k < 3; k++)
        sum += pow(scene->box_max[k] - scene->box_min[k], 2);
    frexp(sqrt(sum), &exponent);
    return ldexp(1, -exponent);
}

void maps_init(maps_host *h, ag_scene *scene, int size, int capacity)
{
    const ag_paraboloid_desc desc = {
        .log = test_log(), .device = device(), .scene = scene, .size = size, .capacity = capacity
    };
    const ag_gpu_scene_desc gpu = { .log = test_log(), .device = device(), .scene = scene };
    ag_rays_desc rays = { .log = test_log(), .scene = scene, .static_only = true };
    ag_camera camera = plain_camera("middle");
    *h = (maps_host){ .scene = scene, .size = size, .unit = unit_of(scene) };
    for (int k = 0; k < 3; k++)
        h->centre[k] = rays.origin[k] = camera.world[12 + k] =
            0.5 * (scene->box_min[k] + scene->box_max[k]);
    assert_int_equal(ag_view_from_camera(test_log(), &camera, 16, 16, &h->view), FG_OK);
    assert_int_equal(ag_gpu_scene_create(&gpu, &h->gpu), FG_OK);
    assert_int_equal(ag_paraboloid_create(&desc, &h->maps), FG_OK);
    assert_int_equal(ag_rays_create(&rays, &h->rays), FG_OK);
    h->graph = fg_graph_create(&(fg_graph_desc){ .device = device(), .log = test_log() });
    glCreateBuffers(1, &h->receivers);
    glCreateBuffers(1, &h->answers);
    glNamedBufferStorage(h->receivers, (GLsizeiptr) MOST_RECEIVERS * 32, NULL,
                         GL_DYNAMIC_STORAGE_BIT);
    glNamedBufferStorage(h->answers, (GLsizeiptr) MOST_RECEIVERS * 4, NULL, 0);
    declare(h);
}

void maps_finish(maps_host *h)
{
    fg_graph_destroy(h->graph);
    ag_paraboloid_destroy(h->maps);
    ag_gpu_scene_destroy(h->gpu);
    ag_rays_destroy(h->rays);
    ag_scene_destroy(h->scene);
    glDeleteBuffers(1, &h->receivers);
    glDeleteBuffers(1, &h->answers);
}

ag_scene *maps_scene(const char *builtin)
{
    ag_scene *scene = NULL;
    assert_int_equal(scenes_open(test_log(), builtin, &scene), FG_OK);
    return scene;
}

fg_status maps_draw(maps_host *h, const ag_paraboloid_eye *eyes, int count)
{
    h->asked[1] = 0;
    assert_int_equal(ag_gpu_scene_update(h->gpu, &h->view), FG_OK);
    ag_paraboloid_set(h->maps, eyes, count, &h->view);
    return fg_graph_run(h->graph);
}

float *maps_read(const maps_host *h, int slot)
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

float *maps_look_up(maps_host *h, int eye, const maps_receiver *receivers, int count)
{
    float(*rows)[4] = calloc((size_t) count * 2, sizeof *rows),
    *answers = calloc((size_t) count, 4);
    assert_true(rows && answers && count <= MOST_RECEIVERS);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            rows[2 * (size_t) i][k] = (float) (receivers[i].position[k] - h->view.origin[k]);
            rows[2 * (size_t) i + 1][k] = receivers[i].normal[k];
        }
    glNamedBufferSubData(h->receivers, 0, (GLsizeiptr) count * 32, rows);
    h->asked[0] = eye;
    h->asked[1] = count;
    assert_int_equal(fg_graph_run(h->graph), FG_OK);
    h->asked[1] = 0;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(h->answers, 0, (GLsizeiptr) count * 4, answers);
    free(rows);
    return answers;
}

// ---- rays ---------------------------------------------------------------------------------------

ag_paraboloid_eye maps_eye(const maps_host *h, uint32_t *seed, int slot)
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

bool maps_ray(const ag_paraboloid_eye *eye, int size, double x, double y, double d[3])
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

// The least height of the triangle that was hit over its longest edge, at most 1.
static double width_of(const maps_host *h, const ag_hit *hit)
{
    const ag_instance *instance = &h->scene->instances[hit->instance];
    const ag_primitive *p = &h->scene->primitives[instance->primitive];
    const uint32_t *corner = h->scene->indices + p->first_index + 3 * (size_t) hit->triangle;
    double at[3][3], longest = 0, n2 = 0;
    for (int i = 0; i < 3; i++) {
        const float *v = h->scene->vertices[p->first_vertex + corner[i]].position;
        const double local[3] = { (double) v[0], (double) v[1], (double) v[2] };
        ag_mat_point(instance->world, local, at[i]);
    }
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int k = 0; k < 3; k++)
            sum += pow(at[(i + 1) % 3][k] - at[i][k], 2);
        longest = fmax(longest, sum);
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        n2 += pow((at[1][j] - at[0][j]) * (at[2][k] - at[0][k]) -
                      (at[1][k] - at[0][k]) * (at[2][j] - at[0][j]),
                  2);
    }
    return fmin(fmax(sqrt(n2) / longest, 1e-9), 1);
}

double maps_by_ray(const maps_host *h, const ag_paraboloid_eye *eye, const double d[3], double *off)
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
    // Half floats are off by 2^-11 where rounded to the nearest, 2^-10 where cut, and end at 65504.
    // Planes nearer to the eye than 2^-20 are moved away to that. Places are known to 2^-24, which
    // turns a triangle by so much over its width.
    const double w = fmin(1 / ((double) hit.distance * h->unit), 65504);
    *off = w * (0x1p-10 + w * (0x1p-19 / fmax(fabs(cosine), 1e-9) + 0x1p-24 / width_of(h, &hit)));
    return w;
}

// Whether rays within `angle` of `d`, its own among them, find what a texel has.
static bool is_near_edge(const maps_host *h, const ag_paraboloid_eye *eye, const double d[3],
                         double got, double angle)
{
    double low = HUGE_VAL, high = 0, t[3], b[3];
    ag_frame_about(d, t, b);
    for (int i = 0; i <= 16; i++) {
        const double r = angle * (i < 8 ? 1 : i < 16 ? 0.3 : 0), phi = pi * i / 4;
        double beside[3], off, length = sqrt(1 + r * r);
        for (int k = 0; k < 3; k++)
            beside[k] = (d[k] + r * (cos(phi) * t[k] + sin(phi) * b[k])) / length;
        const double w = maps_by_ray(h, eye, beside, &off);
        low = fmin(low, w - off);
        high = fmax(high, w + off);
    }
    return got >= low && got <= high;
}

static void check_texel(const maps_host *h, const ag_paraboloid_eye *eye, const double at[2],
                        double got, maps_verdict *v)
{
    double d[3], off;
    if (!maps_ray(eye, h->size, at[0], at[1], d)) {
        v->wrong += got != 0;
        return;
    }
    const double truth = maps_by_ray(h, eye, d, &off);
    v->texels++;
    if (fabs(got - truth) <= off)
        return;
    // What is near moves with the eye, which stands 2^-20 off its surface at one side.
    if (is_near_edge(h, eye, d, got, 1e-5 + 0x1p-19 * fmax(got, truth))) {
        v->edges++;
        return;
    }
    if (v->wrong++ < 5)
        print_message("texel %.0f %.0f has %.6g, a ray says %.6g\n", at[0], at[1], got, truth);
}

maps_verdict maps_check(const maps_host *h, const ag_paraboloid_eye *eye, const float *texels,
                        int step)
{
    maps_verdict v = { 0 };
    for (int y = step / 2; y < h->size; y += step)
        for (int x = step / 2; x < h->size; x += step) {
            const double at[2] = { x, y };
            check_texel(h, eye, at, (double) texels[y * h->size + x], &v);
        }
    return v;
}
