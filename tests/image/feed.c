// SPDX-License-Identifier: MIT
#include "feed.h"

#include <epoxy/gl.h>
#include <math.h>
#include <pass/scene_shared.h>
#include <pass/view_shared.h>
#include <stdlib.h>
#include <string.h>

static const double focal = 1.2, near_plane = 0.01; // longer edges; metres

static size_t texel_count(const feed *f)
{
    return (size_t) f->width * (size_t) f->height * (size_t) (f->layers > 0 ? f->layers : 1);
}

void feed_init(feed *f, int width, int height, int layers)
{
    *f = (feed){ .width = width, .height = height, .layers = layers };
    const size_t count = texel_count(f);
    f->depth = calloc(count, sizeof *f->depth);
    f->normal = calloc(count, sizeof *f->normal);
    f->position = calloc(count, sizeof *f->position);
    assert_true(f->depth && f->normal && f->position);
}

void feed_finish(feed *f)
{
    fg_graph_destroy(f->graph);
    glDeleteTextures(3, f->textures);
    glDeleteBuffers(2, f->buffers);
    free(f->depth);
    free(f->normal);
    free(f->position);
    *f = (feed){ 0 };
}

// One pixel of a plane, where nothing nearer is.
static void plane_pixel(feed *f, int x, int y, const double n[3], double d)
{
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const double longer = f->width > f->height ? f->width : f->height;
    const size_t i = (size_t) y * (size_t) f->width + (size_t) x;
    const double ray[3] = { (x + 0.5 - 0.5 * f->width) / (focal * longer),
                            (y + 0.5 - 0.5 * f->height) / (focal * longer), -1 };
    const double along = n[0] * ray[0] + n[1] * ray[1] + n[2] * ray[2];
    const double t = along != 0 ? d / along : 0;
    if (t < near_plane || near_plane / t <= (double) f->depth[i])
        return;
    f->depth[i] = (float) (near_plane / t);
    for (int k = 0; k < 3; k++) {
        f->normal[i][k] = (float) ((along < 0 ? n[k] : -n[k]) / length);
        f->position[i][k] = (float) (t * ray[k]);
    }
    f->normal[i][3] = f->position[i][3] = 1;
}

void feed_plane(feed *f, const int pixels[4], const double n[3], double d)
{
    for (int y = pixels[1]; y < pixels[3] && y < f->height; y++)
        for (int x = pixels[0]; x < pixels[2] && x < f->width; x++)
            plane_pixel(f, x, y, n, d);
}

void feed_scene(feed *f, feed_kind kind, uint32_t seed)
{
    const int w = f->width, h = f->height;
    const int x = (int) (feed_random(&seed) * w), y = (int) (feed_random(&seed) * h);
    if (kind == FEED_ONE_PIXEL)
        feed_plane(f, (int[4]){ x, y, x + 1, y + 1 }, (double[3]){ 0, 0, 1 }, -1);
    if (kind == FEED_ONE_PLANE)
        feed_plane(f, (int[4]){ 0, 0, w, h }, (double[3]){ 0.3, -0.2, 1 }, -2);
    for (int i = 0; kind == FEED_PLANES && i < 8; i++) {
        int r[4];
        for (int k = 0; k < 4; k++)
            r[k] = (int) (feed_random(&seed) * ((k % 2 ? h : w) + 1));
        const int rect[4] = { r[0] < r[2] ? r[0] : r[2], r[1] < r[3] ? r[1] : r[3],
                              r[0] < r[2] ? r[2] : r[0], r[1] < r[3] ? r[3] : r[1] };
        const double n[3] = { 2 * feed_random(&seed) - 1, 2 * feed_random(&seed) - 1, 1 };
        feed_plane(f, rect, n, -1 - 3 * feed_random(&seed));
    }
    for (int i = 0; kind == FEED_NOISE && i < w * h; i++) {
        const double n[3] = { 2 * feed_random(&seed) - 1, 2 * feed_random(&seed) - 1, 1 };
        const double d = -1 - 3 * feed_random(&seed);
        if (feed_random(&seed) < 0.8)
            feed_plane(f, (int[4]){ i % w, i / w, i % w + 1, i / w + 1 }, n, d);
    }
}

static fg_res upload(feed *f, int i, const char *name, fg_format format, GLenum sized,
                     const void *texels)
{
    const int layers = f->layers > 0 ? f->layers : 1;
    const GLenum from = format == FG_DEPTH32F ? GL_DEPTH_COMPONENT : GL_RGBA;
    const fg_tex_desc desc = {
        .format = format,
        .width = f->width,
        .height = f->height,
        .layers = f->layers,
    };
    GLuint *texture = &f->textures[i];
    glDeleteTextures(1, texture);
    if (f->layers > 0) {
        glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, texture);
        glTextureStorage3D(*texture, 1, sized, f->width, f->height, layers);
        glTextureSubImage3D(*texture, 0, 0, 0, 0, f->width, f->height, layers, from, GL_FLOAT,
                            texels);
    } else {
        glCreateTextures(GL_TEXTURE_2D, 1, texture);
        glTextureStorage2D(*texture, 1, sized, f->width, f->height);
        glTextureSubImage2D(*texture, 0, 0, 0, f->width, f->height, from, GL_FLOAT, texels);
    }
    return fg_import_texture(f->graph, name, &desc, *texture);
}

static fg_res upload_buffer(feed *f, int i, const char *name, size_t size, const void *bytes)
{
    glDeleteBuffers(1, &f->buffers[i]);
    glCreateBuffers(1, &f->buffers[i]);
    glNamedBufferStorage(f->buffers[i], (GLsizeiptr) size, bytes, 0);
    return fg_import_buffer(f->graph, name, &(fg_buf_desc){ .size = size }, f->buffers[i]);
}

void feed_begin(feed *f)
{
    if (!f->graph)
        f->graph = fg_graph_create(&(fg_graph_desc){ .device = device(), .log = test_log() });
    assert_non_null(f->graph);
    const fg_frame_desc frame = { .width = f->width, .height = f->height, .features = ~0ull };
    const ag_view_block view = {
        .forward = { 0, 0, -1, f->orthographic },
        .scale = { 1, 1 },
        .size = { f->width, f->height },
    };
    const int count = f->layers > 0 ? f->layers : 1;
    ag_gpu_face *faces = calloc((size_t) count, sizeof *faces);
    assert_non_null(faces);
    for (int i = 0; i < count; i++)
        faces[i].eye[3] = f->orthographic;
    fg_graph_begin(f->graph, &frame);
    f->scene.view = upload_buffer(f, 0, "feed.view", sizeof view, &view);
    f->scene.faces = upload_buffer(f, 1, "feed.faces", (size_t) count * sizeof *faces, faces);
    free(faces);
    f->gbuffer.depth = upload(f, 0, "feed.depth", FG_DEPTH32F, GL_DEPTH_COMPONENT32F, f->depth);
    f->gbuffer.normal = upload(f, 1, "feed.normal", FG_RGBA16F, GL_RGBA16F, f->normal);
    f->gbuffer.position = upload(f, 2, "feed.position", FG_RGBA32F, GL_RGBA32F, f->position);
    glGetTextureImage(f->textures[1], 0, GL_RGBA, GL_FLOAT,
                      (GLsizei) (texel_count(f) * sizeof *f->normal), f->normal);
}

void feed_run(feed *f)
{
    const int errors = fg_gl_error_count(device());
    log_clear();
    if (fg_graph_compile(f->graph) || fg_graph_run(f->graph) ||
        fg_gl_error_count(device()) != errors)
        fail_msg("graph: %s", log_text());
}

float *feed_texels(const feed *f, fg_res res)
{
    const GLuint texture = fg_graph_exported(f->graph, res);
    GLint width = 0, height = 0, layers = 0;
    assert_true(texture != 0);
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_WIDTH, &width);
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_HEIGHT, &height);
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_DEPTH, &layers);
    const size_t size = (size_t) 16 * (size_t) width * (size_t) height * (size_t) layers;
    float *texels = malloc(size);
    assert_non_null(texels);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glGetTextureImage(texture, 0, GL_RGBA, GL_FLOAT, (GLsizei) size, texels);
    return texels;
}

uint32_t *feed_words(const feed *f, fg_res res, size_t words)
{
    const GLuint buffer = fg_graph_exported(f->graph, res);
    uint32_t *bytes = malloc(words * sizeof *bytes);
    assert_true(buffer != 0 && bytes);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(buffer, 0, (GLsizeiptr) (words * sizeof *bytes), bytes);
    return bytes;
}

double feed_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double) (*state >> 8) / 16777216.0;
}
