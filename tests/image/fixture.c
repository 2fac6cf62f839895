// SPDX-License-Identifier: MIT
#include "fixture.h"

#include <epoxy/gl.h>
#include <math.h>
#include <pass/math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static fg_gl_context *context;
static fg_device *dev;
static gi_registry *registry;
static char text[8192], warnings[8192];

static void remember(void *user, fg_log_level level, const char *msg)
{
    (void) user;
    char *to = level == FG_LOG_ERROR ? text : warnings;
    const size_t used = strlen(to);
    snprintf(to + used, sizeof text - used, "%s\n", msg);
}

const fg_log *test_log(void)
{
    static const fg_log log = { .fn = remember, .level = FG_LOG_WARN };
    return &log;
}

const char *log_text(void)
{
    return text;
}

const char *warnings_text(void)
{
    return warnings;
}

void log_clear(void)
{
    text[0] = warnings[0] = 0;
}

fg_device *device(void)
{
    return dev;
}

int device_setup(void **state)
{
    static const char *const dirs[] = { TEST_PLUGIN_DIR, NULL };
    const gi_registry_desc plugins = { .log = test_log(), .dirs = dirs, .only_dirs = true };
    (void) state;
    const fg_gl_context_desc ctx = { .log = test_log(), .debug = true };
    if (fg_gl_context_create(&ctx, &context) ||
        fg_gl_device_create(&(fg_gl_device_desc){ .log = test_log() }, &dev) ||
        gi_registry_create(&plugins, &registry)) {
        fprintf(stderr, "%s", text);
        return -1;
    }
    return 0;
}

int device_teardown(void **state)
{
    (void) state;
    const int errors = fg_gl_error_count(dev);
    if (errors)
        fprintf(stderr, "%d OpenGL errors:\n%s", errors, text);
    gi_registry_destroy(registry);
    fg_device_destroy(dev);
    fg_gl_context_destroy(context);
    return errors ? -1 : 0;
}

const gi_plugin *plugin_named(const char *name)
{
    const gi_plugin *p = gi_find(registry, name);
    if (!p)
        fail_msg("no plugin %s: %s", name, text);
    return p;
}

const gi_plugin *plugin_rsm(void)
{
    return plugin_named("rsm");
}

void add_quad(ag_builder *b, int material, const double p[3], const double u[3], const double v[3])
{
    static const uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    ag_vertex corners[4];
    memset(corners, 0, sizeof corners);
    for (int i = 0; i < 4; i++) {
        const double a = i == 1 || i == 2, c = i >= 2;
        for (int k = 0; k < 3; k++)
            corners[i].position[k] = (float) (a * u[k] + c * v[k]);
        for (int k = 0; k < 4; k++)
            corners[i].color[k] = 1;
    }
    const ag_primitive_desc quad = {
        .name = "quad",
        .vertices = corners,
        .vertex_count = 4,
        .indices = indices,
        .index_count = 6,
        .material = material,
    };
    // The place is the node's, in double precision: rooms may stand far from the origin.
    const ag_node_desc node = { .name = "quad", .parent = -1, .translation = { p[0], p[1], p[2] } };
    ag_builder_show(b, ag_builder_node(b, &node), ag_builder_primitive(b, &quad), -1);
}

// Six quads about `lo` .. `hi`; inward or outward normals.
static void add_box(ag_builder *b, const int materials[6], const double lo[3], const double hi[3],
                    bool inward)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int side = 0; side < 2; side++) {
            const int i = (axis + 1) % 3, j = (axis + 2) % 3; // i x j = axis
            const bool plus = (side == 1) != inward;
            double p[3] = { lo[0], lo[1], lo[2] }, u[3] = { 0 }, v[3] = { 0 };
            p[axis] = side ? hi[axis] : lo[axis];
            u[plus ? i : j] = hi[plus ? i : j] - lo[plus ? i : j];
            v[plus ? j : i] = hi[plus ? j : i] - lo[plus ? j : i];
            add_quad(b, materials[2 * axis + side], p, u, v);
        }
    }
}

static int diffuse(ag_builder *b, const float rgb[3])
{
    ag_material m = ag_default_material();
    for (int i = 0; i < 3; i++)
        m.base_color[i] = rgb[i];
    return ag_builder_material(b, &m);
}

static void add_blocks(ag_builder *b, const double centre[3], double edge)
{
    static const double blocks[2][2][3] = {
        { { -0.35, -0.5, -0.35 }, { -0.05, 0.1, -0.1 } },
        { { 0.08, -0.5, 0.0 }, { 0.36, -0.22, 0.28 } },
    };
    const float grey[3] = { 0.7f, 0.7f, 0.7f };
    const int m = diffuse(b, grey);
    const int materials[6] = { m, m, m, m, m, m };
    for (int i = 0; i < 2; i++) {
        double lo[3], hi[3];
        for (int k = 0; k < 3; k++) {
            lo[k] = centre[k] + edge * blocks[i][0][k];
            hi[k] = centre[k] + edge * blocks[i][1][k];
        }
        add_box(b, materials, lo, hi, false);
    }
}

ag_camera plain_camera(const char *name)
{
    ag_camera camera = { .yfov = 1.5f, .znear = 1e-3f };
    snprintf(camera.name, sizeof camera.name, "%s", name);
    ag_mat_identity(camera.world);
    return camera;
}

ag_builder *room_builder(const room_desc *desc)
{
    ag_builder *b = ag_builder_create(test_log(), "room");
    assert_non_null(b);
    const double edge = desc->edge > 0 ? desc->edge : 1;
    double lo[3], hi[3];
    int materials[6];
    float any = 0;
    for (int i = 0; i < 18; i++)
        any += (&desc->albedo[0][0])[i];
    for (int i = 0; i < 6; i++) {
        const float half[3] = { 0.5f, 0.5f, 0.5f };
        materials[i] = diffuse(b, any > 0 ? desc->albedo[i] : half);
    }
    for (int k = 0; k < 3; k++) {
        lo[k] = desc->centre[k] - edge / 2;
        hi[k] = desc->centre[k] + edge / 2;
    }
    add_box(b, materials, lo, hi, true);
    if (desc->boxes)
        add_blocks(b, desc->centre, edge);
    ag_camera camera = plain_camera("wall");
    camera.yfov = 1.3f;
    camera.znear = (float) (1e-3 * edge);
    for (int k = 0; k < 3; k++)
        camera.world[12 + k] = desc->centre[k] + (k == 2 ? 0.48 * edge : 0);
    ag_builder_camera(b, -1, &camera);
    return b;
}

ag_scene *finish_scene(ag_builder *b)
{
    ag_scene *scene = NULL;
    const fg_status status = ag_scene_build(b, &scene);
    ag_builder_destroy(b);
    if (status)
        fail_msg("scene: %s", text);
    return scene;
}

ag_scene *room_scene(const room_desc *desc, const ag_light *light)
{
    ag_builder *b = room_builder(desc);
    if (light) {
        ag_light placed = *light;
        const double edge = desc->edge > 0 ? desc->edge : 1;
        for (int k = 0; k < 3; k++)
            placed.position[k] = desc->centre[k] + edge * light->position[k];
        ag_builder_light(b, -1, &placed);
    }
    return finish_scene(b);
}

ag_light ceiling_spot(float outer_degrees)
{
    const float radians = outer_degrees * 3.14159265f / 180;
    return (ag_light){
        .name = "spot",
        .kind = AG_LIGHT_SPOT,
        .position = { 0.03, 0.47, -0.02 },
        .direction = { 0, -1, 0 },
        .intensity = { 1, 1, 1 },
        .cos_outer = cosf(radians),
        .cos_inner = cosf(0.7f * radians),
    };
}

double spot_power(const ag_light *light)
{
    enum { STEPS = 100000 };
    const double from = light->cosine ? 0 : (double) light->cos_outer;
    const double ramp = fmax(1e-3, (double) light->cos_inner - (double) light->cos_outer);
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double c = from + (1 - from) * (i + 0.5) / STEPS;
        const double fade = fmin(1, (c - (double) light->cos_outer) / ramp);
        sum += (light->cosine ? c : fade * fade) * (1 - from) / STEPS;
    }
    return 2 * 3.14159265358979 * sum * (double) light->intensity[0];
}

static void capture_texture(capture *c, const fg_written *written)
{
    const fg_tex_desc *t = written->tex;
    const int layers = t->layers > 0 ? t->layers : 1;
    const size_t layer_bytes = (size_t) 16 * t->width * t->height;
    c->width = t->width;
    c->height = t->height;
    c->layers = layers;
    c->size = layer_bytes * layers;
    c->texels = realloc(c->texels, c->size);
    assert_non_null(c->texels);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glGetTextureImage(written->object, 0, GL_RGBA, GL_FLOAT, (GLsizei) c->size, c->texels);
}

static void on_written(void *user, const fg_written *written)
{
    for (capture *c = user; c && c->resource; c++) {
        if (strcmp(c->resource, written->resource) != 0)
            continue;
        if (written->tex) {
            capture_texture(c, written);
            continue;
        }
        c->size = written->buf->size;
        c->bytes = realloc(c->bytes, c->size);
        assert_non_null(c->bytes);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glGetNamedBufferSubData(written->object, 0, (GLsizeiptr) c->size, c->bytes);
    }
}

void captures_finish(capture *captures)
{
    for (capture *c = captures; c->resource; c++) {
        free(c->texels);
        free(c->bytes);
    }
}

image shot_take(const shot *s)
{
    gi_value values[32];
    image img = { 0 };
    renderer *r = NULL;
    log_clear();
    if (s->plugin) {
        assert_true(gi_params_count(s->plugin) <= FG_COUNT(values));
        gi_params_default(s->plugin, values);
    }
    for (int i = 0; s->plugin && s->settings && s->settings[i]; i++)
        assert_int_equal(gi_params_set(test_log(), s->plugin, values, s->settings[i]), FG_OK);
    const renderer_desc desc = {
        .log = test_log(),
        .device = dev,
        .scene = s->scene,
        .width = s->width,
        .height = s->height,
        .plugin = s->plugin,
        .values = s->plugin ? values : NULL,
        .layers = 1u << s->layer,
        .strict = true,
        .shadow_size = s->shadow_size,
        .shadow_taps = s->shadow_taps,
        .inspect = s->captures ? on_written : NULL,
        .inspect_user = s->captures,
    };
    if (renderer_create(&desc, &r) || renderer_frame(r, 0) || renderer_read(r, s->layer, &img))
        fail_msg("frame: %s", text);
    renderer_destroy(r);
    return img;
}

image render_layer(ag_scene *scene, int width, int height, renderer_layer layer,
                   const gi_plugin *plugin, const char *const *settings)
{
    const shot s = { scene, width, height, layer, plugin, settings, NULL };
    return shot_take(&s);
}

image render_captured(ag_scene *scene, int width, int height, renderer_layer layer,
                      const char *const *settings, capture *captures)
{
    const shot s = { scene, width, height, layer, plugin_rsm(), settings, captures };
    return shot_take(&s);
}

static void sphere_vertices(int rings, ag_vertex *v)
{
    for (int i = 0; i <= rings; i++) {
        for (int j = 0; j <= 2 * rings; j++, v++) {
            const double polar = 3.14159265358979 * i / rings;
            const double around = 3.14159265358979 * j / rings;
            const float p[3] = { (float) (sin(polar) * cos(around)), (float) cos(polar),
                                 (float) (sin(polar) * sin(around)) };
            *v = (ag_vertex){ .position = { p[0], p[1], p[2] },
                              .normal = { -p[0], -p[1], -p[2] },
                              .color = { 1, 1, 1, 1 } };
        }
    }
}

static void sphere_indices(int rings, uint32_t *indices)
{
    const uint32_t row = 2 * (uint32_t) rings + 1;
    for (uint32_t i = 0; i < (uint32_t) rings; i++) {
        for (uint32_t j = 0; j + 1 < row; j++, indices += 6) {
            const uint32_t a = i * row + j, b = a + 1, c = a + row, d = c + 1;
            const uint32_t quad[6] = { a, c, b, b, c, d }; // counter-clockwise from inside
            memcpy(indices, quad, sizeof quad);
        }
    }
}

ag_scene *sphere_scene(int rings, float albedo)
{
    const size_t columns = 2 * (size_t) rings;
    const size_t vertex_count = (columns + 1) * ((size_t) rings + 1);
    const size_t index_count = 6 * columns * (size_t) rings;
    ag_vertex *vertices = calloc(vertex_count, sizeof *vertices);
    uint32_t *indices = calloc(index_count, sizeof *indices);
    assert_true(vertices && indices);
    sphere_vertices(rings, vertices);
    sphere_indices(rings, indices);
    ag_builder *builder = ag_builder_create(test_log(), "sphere");
    const float rgb[3] = { albedo, albedo, albedo };
    const ag_primitive_desc sphere = {
        .name = "sphere",
        .vertices = vertices,
        .vertex_count = vertex_count,
        .indices = indices,
        .index_count = index_count,
        .material = diffuse(builder, rgb),
    };
    const ag_node_desc node = { .name = "sphere", .parent = -1 };
    const ag_light light = { .name = "point", .direction = { 0, -1, 0 }, .intensity = { 1, 1, 1 } };
    const ag_camera camera = plain_camera("centre");
    const int primitive = ag_builder_primitive(builder, &sphere);
    ag_builder_show(builder, ag_builder_node(builder, &node), primitive, -1);
    ag_builder_light(builder, -1, &light);
    ag_builder_camera(builder, -1, &camera);
    free(vertices);
    free(indices);
    return finish_scene(builder);
}

double image_mean(const image *img)
{
    double sum = 0;
    const size_t count = (size_t) 3 * img->width * img->height;
    for (size_t i = 0; i < count; i++)
        sum += (double) img->rgb[i];
    return sum / (double) count;
}

bool same_bits(const void *a, const void *b, size_t size)
{
    return memcmp(a, b, size) == 0;
}
