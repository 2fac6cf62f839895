// SPDX-License-Identifier: MIT
// The smallest host: the frame graph alone, without scene and plugins.
//
//     host_graph OUT.ppm
//
// Three passes: a glow is drawn, halved by a compute shader and tone mapped. A fourth that
// nobody reads is left out.
#include <epoxy/gl.h>
#include <fg/device.h>
#include <fg/gl.h>
#include <stdio.h>

#include "glow_frag.h"
#include "halve_comp.h"
#include "tone_frag.h"
#include "triangle_vert.h"

enum { SIDE = 256, HALF = SIDE / 2 };

typedef struct textures {
    fg_res light, half, picture;
} textures;

static fg_status use(const fg_run *run, const fg_gl_program_desc *desc)
{
    const uint32_t program = fg_gl_program(fg_run_device(run), desc);
    glUseProgram(program);
    return program ? FG_OK : FG_ERR_SHADER;
}

static fg_status run_glow(const fg_run *run, void *user)
{
    (void) user;
    const fg_status status = use(run, &(fg_gl_program_desc){ { &triangle_vert, &glow_frag } });
    fg_gl_fullscreen(run);
    return status;
}

static fg_status run_halve(const fg_run *run, void *user)
{
    const textures *t = user;
    const fg_status status = use(run, &(fg_gl_program_desc){ { &halve_comp } });
    fg_gl_sample(run, 0, t->light, FG_GL_NEAREST);
    fg_gl_image(run, 0, t->half, 0, GL_WRITE_ONLY, FG_RGBA16F);
    fg_gl_dispatch_2d(HALF, HALF, 8, 8);
    return status;
}

static fg_status run_tone(const fg_run *run, void *user)
{
    const textures *t = user;
    const fg_status status = use(run, &(fg_gl_program_desc){ { &triangle_vert, &tone_frag } });
    fg_gl_sample(run, 0, t->half, FG_GL_NEAREST);
    fg_gl_fullscreen(run);
    return status;
}

static void declare(fg_graph *g, textures *t)
{
    fg_graph_begin(g, &(fg_frame_desc){ .width = SIDE, .height = SIDE });
    t->light = fg_texture(g, "light", &(fg_tex_desc){ .format = FG_RGBA16F });
    t->half = fg_texture(g, "half", &(fg_tex_desc){ .format = FG_RGBA16F, .scale_log2 = 1 });
    t->picture = fg_texture(g, "picture", &(fg_tex_desc){ FG_SRGB8_ALPHA8, .scale_log2 = 1 });
    const fg_res unread = fg_texture(g, "unread", &(fg_tex_desc){ .format = FG_RGBA16F });
    const fg_pass_desc passes[] = {
        { .name = "glow", .writes = { { t->light, .load = FG_LOAD_DISCARD } }, .run = run_glow },
        { .name = "unread", .writes = { { unread } }, .run = run_glow },
        { .name = "halve",
          .kind = FG_KIND_COMPUTE,
          .reads = { { t->light } },
          .writes = { { t->half, .load = FG_LOAD_DISCARD } },
          .run = run_halve,
          .user = t },
        { .name = "tone",
          .reads = { { t->half } },
          .writes = { { t->picture, .load = FG_LOAD_DISCARD } },
          .run = run_tone,
          .user = t },
    };
    fg_passes(g, passes, FG_COUNT(passes));
    fg_export(g, t->picture);
}

static bool write_ppm(const char *path, uint32_t texture)
{
    static unsigned char rgb[HALF * HALF * 3];
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(texture, 0, GL_RGB, GL_UNSIGNED_BYTE, sizeof rgb, rgb);
    FILE *f = fopen(path, "wb");
    if (!f)
        return false;
    const bool written =
        fprintf(f, "P6\n%d %d\n255\n", HALF, HALF) > 0 && fwrite(rgb, sizeof rgb, 1, f) == 1;
    return fclose(f) == 0 && written;
}

static void to_stderr(void *user, fg_log_level level, const char *msg)
{
    (void) user, (void) level;
    fprintf(stderr, "host_graph: %s\n", msg);
}

int main(int argc, char **argv)
{
    const fg_log log = { .fn = to_stderr, .level = FG_LOG_WARN };
    fg_gl_context *context = NULL;
    fg_device *device = NULL;
    fg_graph *g = NULL;
    textures t;
    bool done = false;

    if (argc != 2) {
        fprintf(stderr, "usage: host_graph OUT.ppm\n");
        return 2;
    }
    if (fg_gl_context_create(&(fg_gl_context_desc){ .log = &log }, &context) == FG_OK &&
        fg_gl_device_create(&(fg_gl_device_desc){ .log = &log }, &device) == FG_OK)
        g = fg_graph_create(&(fg_graph_desc){ .device = device, .log = &log });
    if (g) {
        declare(g, &t);
        done = fg_graph_compile(g) == FG_OK && fg_graph_run(g) == FG_OK &&
               write_ppm(argv[1], fg_graph_exported(g, t.picture));
    }
    const char *why = NULL;
    if (done)
        for (int i = 0; fg_graph_left_out(g, i, &why); ++i)
            printf("left out: %s: %s\n", fg_graph_left_out(g, i, NULL), why);
    fg_graph_destroy(g);
    fg_device_destroy(device);
    fg_gl_context_destroy(context);
    return done ? 0 : 1;
}
