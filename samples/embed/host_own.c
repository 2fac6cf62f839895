// SPDX-License-Identifier: MIT
// A host that owns everything: its EGL context, its graph with a pass of its own, its framebuffer
// and its OpenGL state. A technique's light is one texture in it.
//
//     host_own OUT.ppm [PLUGIN]
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fg/gl.h>
#include <gi/registry.h>
#include <pass/gbuffer.h>
#include <pass/lighting.h>
#include <stdio.h>
#include <stdlib.h>

#include "grade_comp.h"
#include "room.h"
#include "window_frag.h"
#include "window_vert.h"

enum { WIDTH = 160, HEIGHT = 120, CANVAS_WIDTH = 200, CANVAS_HEIGHT = 160, MAX_PARAMS = 64 };

static void print(void *user, fg_log_level level, const char *msg)
{
    (void) user, (void) level;
    fprintf(stderr, "host_own: %s\n", msg);
}
static const fg_log to_stderr = { .fn = print, .level = FG_LOG_WARN };

// ---- what is the host's ----------------------------------------------------------------------

typedef struct canvas {
    EGLDisplay display;
    EGLContext context;
    GLuint framebuffer, texture, array, program;
} canvas;

static EGLDisplay open_display(void)
{
    EGLDeviceEXT device;
    EGLint n = 0;
    EGLDisplay d =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (d != EGL_NO_DISPLAY && eglInitialize(d, NULL, NULL))
        return d;
    if (!eglQueryDevicesEXT(1, &device, &n) || n < 1)
        return EGL_NO_DISPLAY;
    d = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, NULL);
    return d != EGL_NO_DISPLAY && eglInitialize(d, NULL, NULL) ? d : EGL_NO_DISPLAY;
}

static bool open_context(canvas *c)
{
    static const EGLint version[] = { EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
                                      EGL_NONE };
    c->display = open_display();
    if (c->display == EGL_NO_DISPLAY || !eglBindAPI(EGL_OPENGL_API))
        return false;
    c->context = eglCreateContext(c->display, NULL, EGL_NO_CONTEXT, version);
    return c->context != EGL_NO_CONTEXT &&
           eglMakeCurrent(c->display, EGL_NO_SURFACE, EGL_NO_SURFACE, c->context);
}

static bool attach(GLuint program, GLenum stage, const char *text)
{
    GLint compiled = 0;
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    glAttachShader(program, shader);
    glDeleteShader(shader);
    return compiled;
}

static bool create_canvas(canvas *c)
{
    GLint linked = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &c->texture);
    glTextureStorage2D(c->texture, 1, GL_RGBA8, CANVAS_WIDTH, CANVAS_HEIGHT);
    glCreateFramebuffers(1, &c->framebuffer);
    glNamedFramebufferTexture(c->framebuffer, GL_COLOR_ATTACHMENT0, c->texture, 0);
    glCreateVertexArrays(1, &c->array);
    c->program = glCreateProgram();
    if (attach(c->program, GL_VERTEX_SHADER, window_vert.text) &&
        attach(c->program, GL_FRAGMENT_SHADER, window_frag.text))
        glLinkProgram(c->program);
    glGetProgramiv(c->program, GL_LINK_STATUS, &linked);
    return linked;
}

static void draw_quad(const canvas *c, const float place[4], const float color[4])
{
    glProgramUniform4fv(c->program, 0, 1, place);
    glProgramUniform4fv(c->program, 1, 1, color);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

// What stays as the host sets it once: a frame does not touch it. fg/gl.h has the list.
static void set_lasting_state(void)
{
    glClearColor(0.25f, 0, 0.25f, 1);
    glScissor(10, 10, CANVAS_WIDTH - 20, CANVAS_HEIGHT - 20);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
}

// What a frame leaves to be set anew: framebuffer, program, vertex array, viewport, what is bound
// to units, and switches, which it leaves off.
static void draw_canvas(const canvas *c, uint32_t picture)
{
    const float x = (float) WIDTH / CANVAS_WIDTH, y = (float) HEIGHT / CANVAS_HEIGHT;
    glBindFramebuffer(GL_FRAMEBUFFER, c->framebuffer);
    glUseProgram(c->program);
    glBindVertexArray(c->array);
    glViewport(0, 0, CANVAS_WIDTH, CANVAS_HEIGHT);
    glBindTextureUnit(0, picture);
    glBindSampler(0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    draw_quad(c, (float[]){ -x, -y, x, y }, (float[4]){ 0 });
    glEnable(GL_SCISSOR_TEST); // cuts the band off at both ends
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    draw_quad(c, (float[]){ -1, -0.95f, 1, -0.8f }, (float[]){ 1, 1, 0, 0.5f });
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
}

static bool write_ppm(const canvas *c, const char *path)
{
    static unsigned char rgb[CANVAS_HEIGHT][CANVAS_WIDTH][3];
    glGetTextureImage(c->texture, 0, GL_RGB, GL_UNSIGNED_BYTE, sizeof rgb, rgb);
    FILE *f = fopen(path, "wb");
    if (!f)
        return false;
    bool written = fprintf(f, "P6\n%d %d\n255\n", CANVAS_WIDTH, CANVAS_HEIGHT) > 0;
    for (int row = CANVAS_HEIGHT - 1; row >= 0; row--)
        written = written && fwrite(rgb[row], sizeof rgb[row], 1, f) == 1;
    return fclose(f) == 0 && written;
}

// ---- its frame -------------------------------------------------------------------------------

typedef struct host { // what the passes' callbacks point to stays in place
    fg_device *device;
    fg_graph *graph;
    ag_scene *scene;
    ag_gpu_scene *gpu;
    gi_registry *registry;
    const gi_plugin *plugin;
    void *technique;
    ag_gbuffer_pass gbuffer;
    ag_shadow_pass shadow;
    ag_direct_pass direct;
    fg_res light, picture;
} host;

static fg_status create(host *h, const char *plugin)
{
    gi_value values[MAX_PARAMS];
    fg_status s = fg_gl_device_create(&(fg_gl_device_desc){ .log = &to_stderr }, &h->device);
    if (!s)
        s = room_create(&to_stderr, &h->scene);
    if (!s)
        s = ag_gpu_scene_create(&(ag_gpu_scene_desc){ &to_stderr, h->device, h->scene, 0 },
                                &h->gpu);
    if (!s)
        s = gi_registry_create(&(gi_registry_desc){ .log = &to_stderr }, &h->registry);
    if (s)
        return s;
    h->graph = fg_graph_create(&(fg_graph_desc){ .device = h->device, .log = &to_stderr });
    h->plugin = gi_find(h->registry, plugin);
    if (!h->graph || !h->plugin || gi_params_count(h->plugin) > MAX_PARAMS)
        return FG_ERR_UNSUPPORTED;
    gi_params_default(h->plugin, values);
    const gi_env env = { &to_stderr, h->device, h->scene, h->gpu };
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
}

static fg_status run_grade(const fg_run *run, void *user)
{
    const host *h = user;
    const uint32_t program =
        fg_gl_program(fg_run_device(run), &(fg_gl_program_desc){ { &grade_comp } });
    glUseProgram(program);
    fg_gl_sample(run, 0, h->direct.out, FG_GL_NEAREST);
    fg_gl_sample(run, 1, h->gbuffer.out.albedo, FG_GL_NEAREST);
    fg_gl_sample(run, 2, h->light, FG_GL_NEAREST);
    fg_gl_image(run, 0, h->picture, 0, GL_WRITE_ONLY, FG_RGBA8);
    fg_gl_dispatch_2d(WIDTH, HEIGHT, 8, 8);
    return program ? FG_OK : FG_ERR_SHADER;
}

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
    h->light = out.indirect;
    h->picture = fg_texture(g, "host.picture", &(fg_tex_desc){ .format = FG_RGBA8 });
    const fg_pass_desc grade = {
        .name = "host.grade",
        .kind = FG_KIND_COMPUTE,
        .reads = { { h->direct.out }, { h->gbuffer.out.albedo }, { h->light, .optional = true } },
        .writes = { { h->picture, .load = FG_LOAD_DISCARD } },
        .run = run_grade,
        .user = h,
    };
    fg_passes(g, &grade, 1);
    fg_export(g, h->picture);
    return fg_graph_compile(g);
}

static fg_status draw_frame(host *h, uint64_t index)
{
    ag_view view;
    fg_status s = ag_view_from_camera(&to_stderr, &h->scene->cameras[0], WIDTH, HEIGHT, &view);
    if (!s)
        s = ag_gpu_scene_update(h->gpu, &view);
    if (!s && h->plugin->update)
        s = h->plugin->update(h->technique, &(gi_frame){ .view = &view, .index = index });
    if (!s && index == 0)
        s = declare(h);
    return s ? s : fg_graph_run(h->graph);
}

int main(int argc, char **argv)
{
    static host h;
    canvas c = { 0 };
    if (argc < 2 || !open_context(&c) || !create_canvas(&c)) {
        fprintf(stderr, argc < 2 ? "usage: host_own OUT.ppm [PLUGIN]\n"
                                 : "host_own: no OpenGL 4.5 context\n");
        return argc < 2 ? 2 : 1;
    }
    set_lasting_state();
    fg_status s = create(&h, argc > 2 ? argv[2] : "rsm");
    for (uint64_t i = 0; i < 3 && !s; i++) {
        s = draw_frame(&h, i);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT); // a compute pass wrote it
        if (!s)
            draw_canvas(&c, fg_graph_exported(h.graph, h.picture));
    }
    const bool done = !s && write_ppm(&c, argv[1]) && glGetError() == GL_NO_ERROR;
    destroy(&h); // what the host made stays, and so does its context
    glDeleteProgram(c.program);
    glDeleteVertexArrays(1, &c.array);
    glDeleteFramebuffers(1, &c.framebuffer);
    glDeleteTextures(1, &c.texture);
    const bool clean = glGetError() == GL_NO_ERROR;
    eglMakeCurrent(c.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(c.display, c.context);
    return done && clean ? 0 : 1;
}
