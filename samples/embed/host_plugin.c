// SPDX-License-Identifier: MIT
// The smallest host that uses a plugin: a scene made by code, one frame of direct and indirect
// light, the radiance as an OpenGL texture, whose mean is printed.
//
//     host_plugin [PLUGIN] [FILE.gltf]
#include <epoxy/gl.h>
#include <gi/registry.h>
#include <pass/gbuffer.h>
#include <pass/lighting.h>
#include <pass/post.h>
#include <stdio.h>
#include <stdlib.h>

#include "room.h"

enum { WIDTH = 320, HEIGHT = 240, MAX_PARAMS = 32 };

typedef struct host { // what the passes' callbacks point to stays in place
    fg_gl_context *context;
    fg_device *device;
    ag_scene *scene;
    ag_gpu_scene *gpu;
    gi_registry *registry;
    const gi_plugin *plugin;
    void *technique;
    fg_graph *graph;
    ag_gbuffer_pass gbuffer;
    ag_shadow_pass shadow;
    ag_direct_pass direct;
    ag_compose_pass compose;
} host;

static void print(void *user, fg_log_level level, const char *msg)
{
    (void) user;
    fprintf(stderr, "%s: %s\n", level == FG_LOG_ERROR ? "error" : "note", msg);
}

static const fg_log log_to_stderr = { .fn = print, .level = FG_LOG_WARN };

static fg_status create(host *h, const char *plugin, const char *file)
{
    gi_value values[MAX_PARAMS];
    fg_status s = fg_gl_context_create(&(fg_gl_context_desc){ .log = &log_to_stderr }, &h->context);
    if (!s)
        s = fg_gl_device_create(&(fg_gl_device_desc){ .log = &log_to_stderr }, &h->device);
    if (!s)
        s = file ? ag_scene_load(&log_to_stderr, file, &h->scene)
                 : room_create(&log_to_stderr, &h->scene);
    if (!s)
        s = ag_gpu_scene_create(&(ag_gpu_scene_desc){ &log_to_stderr, h->device, h->scene, 0 },
                                &h->gpu);
    if (!s)
        s = gi_registry_create(&(gi_registry_desc){ .log = &log_to_stderr }, &h->registry);
    if (s)
        return s;
    h->graph = fg_graph_create(&(fg_graph_desc){ .device = h->device, .log = &log_to_stderr });
    h->plugin = gi_find(h->registry, plugin);
    if (!h->graph || !h->plugin || gi_params_count(h->plugin) > MAX_PARAMS)
        return FG_ERR_UNSUPPORTED;
    gi_params_default(h->plugin, values);
    const gi_env env = { &log_to_stderr, h->device, h->scene, h->gpu };
    return h->plugin->create(&env, values, &h->technique);
}

static void destroy(host *h)
{
    fg_graph_destroy(h->graph);
    if (h->technique)
        h->plugin->destroy(h->technique);
    gi_registry_destroy(h->registry);
    ag_gpu_scene_destroy(h->gpu);
    ag_scene_destroy(h->scene);
    fg_device_destroy(h->device);
    fg_gl_context_destroy(h->context);
}

// G-buffer, shadows, direct light, the technique, their sum.
static fg_status declare(host *h)
{
    fg_graph *g = h->graph;
    const fg_frame_desc frame = { WIDTH, HEIGHT, h->scene->features, ag_feature_names,
                                  AG_FEATURE_COUNT };
    gi_outputs out = { 0 };
    fg_graph_begin(g, &frame);
    const ag_scene_res scene = ag_gpu_scene_import(h->gpu, g);
    ag_gbuffer_declare(&h->gbuffer, g, h->gpu, &scene);
    ag_shadow_declare(&h->shadow, g, h->gpu, &scene, 0);
    const ag_direct_desc direct = { &scene, &h->gbuffer.out, h->shadow.maps, 0 };
    ag_direct_declare(&h->direct, g, h->gpu, &direct);
    const gi_inputs in = { WIDTH, HEIGHT, h->gbuffer.out, scene, h->direct.out };
    h->plugin->declare(h->technique, g, &in, &out);
    h->compose = (ag_compose_pass){ scene.view,   h->direct.out, h->gbuffer.out.albedo,
                                    out.indirect, out.glossy,    { 0 } };
    ag_compose_declare(&h->compose, g, "host.compose", "host.radiance");
    fg_export(g, h->compose.out);
    return fg_graph_compile(g);
}

static fg_status draw_frame(host *h, uint64_t index)
{
    const ag_camera camera =
        h->scene->camera_count ? h->scene->cameras[0] : ag_scene_framing_camera(h->scene);
    ag_view view;
    fg_status s = ag_view_from_camera(&log_to_stderr, &camera, WIDTH, HEIGHT, &view);
    if (!s)
        s = ag_gpu_scene_update(h->gpu, &view);
    if (!s && h->plugin->update)
        s = h->plugin->update(h->technique, &(gi_frame){ .view = &view, .index = index });
    if (!s && index == 0) // later frames are declared alike: nothing to do
        s = declare(h);
    return s ? s : fg_graph_run(h->graph);
}

static void print_mean(uint32_t texture)
{
    static float rgba[WIDTH * HEIGHT][4];
    double sum[3] = { 0 };
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT); // a compute pass wrote it
    glGetTextureImage(texture, 0, GL_RGBA, GL_FLOAT, sizeof rgba, rgba);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += (double) rgba[i][c] / (WIDTH * HEIGHT);
    printf("mean radiance %.4f %.4f %.4f W/(m^2 sr)\n", sum[0], sum[1], sum[2]);
}

int main(int argc, char **argv)
{
    static host h;
    fg_status s = create(&h, argc > 1 ? argv[1] : "rsm", argc > 2 ? argv[2] : NULL);
    for (uint64_t i = 0; i < 3 && !s; i++)
        s = draw_frame(&h, i);
    if (!s)
        print_mean(fg_graph_exported(h.graph, h.compose.out));
    destroy(&h);
    return s ? 1 : 0;
}
