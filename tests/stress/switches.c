// SPDX-License-Identifier: MIT
// Switches between techniques, settings and scenes in random order in one process: the first frame
// after each is, to the bit, that of a process which began with it, and memory does not grow.
//
//     switches [COUNT] [SEED]
//     switches first CASE FILE     what that process does
//
// Two frames belong to a switch: the first, which is compared, and one at another time, so that
// what is left behind is not what is expected. What is measured is measured where the same case is
// on: after the 50th and after the last switch. Up to 50 switches are for a leak checker: there is
// no other process, a case's first frame in this one is what it must be again, and memory is left
// to the checker.
#include "renderer.h"
#include "scenes.h"

#include <epoxy/gl.h>
#include <malloc.h>
#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { W = 48, H = 32, EARLY = 50, MAX_VALUES = 64, MAX_ROWS = 8, NAMES = 1 << 15 };

// Small settings: what is tested is what comes and goes.
static const struct {
    const char *plugin; // NULL: direct light alone
    const char *values[MAX_ROWS];
    bool keeps; // state from frame to frame, for other values, too
} settings[] = {
    { NULL, { NULL } },
    { "rsm", { "rsm_size=32", "vpls=16" } },
    { "rsm", { "rsm_size=32", "vpls=64", "visibility=ism", "ism_points=256", "ism_size=16" } },
    { "isr", { "rsm_size=32", "vpls=16" } },
    { "isr", { "rsm_size=32", "source=clusters", "light_initial=8", "light_coarsest=4" } },
    { "hisr", { "rsm_size=32" } },
    { "iir", { "max_lights=8", "map_size=16" }, true },
    { "iir", { "max_lights=16", "map_size=16", "delay=0", "clamp=geometry", "tiles=2" }, true },
    { "splat", { "rsm_size=32", "vpls=16" } },
};
static const char *const scene_names[] = { "cornell", "atrium" };
enum { SETTINGS = FG_COUNT(settings), SCENES = FG_COUNT(scene_names), CASES = SETTINGS * SCENES };
enum { MEASURED = 1 }; // the case where memory is measured

static void say(void *user, fg_log_level level, const char *msg)
{
    (void) user;
    (void) level;
    fprintf(stderr, "%s\n", msg);
}

static const fg_log log_ = { .fn = say, .level = FG_LOG_WARN };

typedef struct stress {
    fg_gl_context *context;
    fg_device *device;
    gi_registry *registry;
    ag_scene *scene; // of the renderer
    renderer *r;
    int scene_index; // -1: none
    unsigned debug;
    float *first[CASES];
} stress;

enum { FLOATS = 3 * W * H };

static fg_status open_device(stress *s)
{
    static const char *const dirs[] = { TEST_PLUGIN_DIR, NULL };
    const gi_registry_desc plugins = { .log = &log_, .dirs = dirs, .only_dirs = true };
    const fg_gl_context_desc context = { .log = &log_, .debug = true };
    *s = (stress){ .scene_index = -1 };
    fg_status status = fg_gl_context_create(&context, &s->context);
    if (!status)
        status = fg_gl_device_create(&(fg_gl_device_desc){ .log = &log_ }, &s->device);
    return status ? status : gi_registry_create(&plugins, &s->registry);
}

static void close_scene(stress *s)
{
    renderer_destroy(s->r);
    ag_scene_destroy(s->scene);
    s->r = NULL;
    s->scene = NULL;
    s->scene_index = -1;
}

static int close_device(stress *s)
{
    close_scene(s);
    for (int i = 0; i < CASES; i++)
        free(s->first[i]);
    const int errors = s->device ? fg_gl_error_count(s->device) : 0;
    gi_registry_destroy(s->registry);
    fg_device_destroy(s->device);
    fg_gl_context_destroy(s->context);
    return errors;
}

// ---- a switch --------------------------------------------------------------------------------

static fg_status choose(stress *s, int setting, const gi_plugin **plugin, gi_value *values)
{
    const char *name = settings[setting].plugin;
    *plugin = name ? gi_find(s->registry, name) : NULL;
    if (!name)
        return FG_OK;
    if (!*plugin || gi_params_count(*plugin) > MAX_VALUES)
        return FG_ERR_INVALID;
    fg_status status = FG_OK;
    gi_params_default(*plugin, values);
    for (int i = 0; !status && i < MAX_ROWS && settings[setting].values[i]; i++)
        status = gi_params_set(&log_, *plugin, values, settings[setting].values[i]);
    return status;
}

// Between two frames, or with another scene, which is another renderer.
static fg_status switch_to(stress *s, int which)
{
    const int scene = which / SETTINGS;
    const gi_plugin *plugin = NULL;
    gi_value values[MAX_VALUES];
    fg_status status = choose(s, which % SETTINGS, &plugin, values);
    if (status)
        return status;
    if (scene == s->scene_index) {
        // The same technique keeps what it can, which is meant; only by way of nothing it begins
        // anew, and has no more than it needs where memory is measured.
        if (settings[which % SETTINGS].keeps || which == MEASURED)
            status = renderer_set_plugin(s->r, NULL, NULL);
        return status ? status : renderer_set_plugin(s->r, plugin, values);
    }
    close_scene(s);
    status = scenes_open(&log_, scene_names[scene], &s->scene);
    const renderer_desc desc = {
        .log = &log_,
        .device = s->device,
        .scene = s->scene,
        .width = W,
        .height = H,
        .plugin = plugin,
        .values = values,
        .layers = 1u << LAYER_RADIANCE | 1u << LAYER_FINAL,
        .shadow_size = 64,
        .debug = s->debug,
        .strict = true,
    };
    if (!status)
        status = renderer_create(&desc, &s->r);
    s->scene_index = status ? -1 : scene;
    return status;
}

static fg_status frame(stress *s, double time, float *rgb)
{
    image img = { 0 };
    fg_status status = renderer_frame(s->r, time);
    if (!status && rgb)
        status = renderer_read(s->r, LAYER_RADIANCE, &img);
    if (!status && rgb)
        memcpy(rgb, img.rgb, FLOATS * sizeof *rgb);
    image_finish(&img);
    return status;
}

// ---- first frames of fresh processes ---------------------------------------------------------

static int run_first(int which, const char *path)
{
    stress s;
    float rgb[FLOATS];
    FILE *f = NULL;
    fg_status status = open_device(&s);
    if (!status)
        status = switch_to(&s, which);
    if (!status)
        status = frame(&s, 0, rgb);
    if (!status)
        f = fopen(path, "wb");
    const bool written = f && fwrite(rgb, sizeof rgb, 1, f) == 1;
    if (f)
        fclose(f);
    return close_device(&s) == 0 && written ? 0 : 1;
}

static bool take_first(stress *s, const char *self, int which)
{
    extern char **environ;
    char path[] = "switches-XXXXXX", number[16], first[] = "first", program[4096];
    char *const args[] = { program, first, number, path, NULL };
    pid_t child;
    int state = 1;
    const int file = mkstemp(path);
    if (file < 0)
        return false;
    snprintf(program, sizeof program, "%s", self);
    snprintf(number, sizeof number, "%d", which);
    s->first[which] = malloc(FLOATS * sizeof(float));
    bool good = s->first[which] && posix_spawn(&child, self, NULL, NULL, args, environ) == 0;
    good = good && waitpid(child, &state, 0) == child && state == 0 &&
           read(file, s->first[which], FLOATS * sizeof(float)) == FLOATS * (long) sizeof(float);
    close(file);
    unlink(path);
    for (int i = 0; i < FLOATS && good; i++) // nothing of the poison that transients begin with
        good = isfinite(s->first[which][i]) && s->first[which][i] >= 0;
    return good;
}

// ---- memory ----------------------------------------------------------------------------------

typedef struct memory {
    double pool;     // bytes that the graph holds
    double gl;       // bytes of all textures and buffers that there are, the plugins' own too
    double resident; // bytes
    int objects;     // textures, buffers, framebuffers, programs, vertex arrays, samplers, queries
} memory;

static double texture_size(GLuint name)
{
    static const GLenum depths[] = { GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE,
                                     GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE,
                                     GL_TEXTURE_DEPTH_SIZE };
    double bytes = 0;
    GLint levels = 0;
    glGetTextureParameteriv(name, GL_TEXTURE_IMMUTABLE_LEVELS, &levels);
    for (int level = 0; level < levels; level++) {
        GLint size[3] = { 0 }, bits = 0;
        glGetTextureLevelParameteriv(name, level, GL_TEXTURE_WIDTH, &size[0]);
        glGetTextureLevelParameteriv(name, level, GL_TEXTURE_HEIGHT, &size[1]);
        glGetTextureLevelParameteriv(name, level, GL_TEXTURE_DEPTH, &size[2]);
        for (int i = 0; i < FG_COUNT(depths); i++) {
            GLint depth = 0;
            glGetTextureLevelParameteriv(name, level, depths[i], &depth);
            bits += depth;
        }
        bytes += 0.125 * bits * size[0] * size[1] * size[2];
    }
    return bytes;
}

static double resident(void)
{
    long total = 0, pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    const bool read_both = f && fscanf(f, "%ld %ld", &total, &pages) == 2;
    if (f)
        fclose(f);
    return read_both ? (double) pages * (double) sysconf(_SC_PAGESIZE) : 0;
}

static memory measure(stress *s)
{
    memory m = { .pool = (double) fg_graph_get_stats(renderer_graph(s->r)).pool_bytes };
    glFinish();
    for (GLuint i = 1; i < NAMES; i++) {
        m.objects += glIsFramebuffer(i) + glIsProgram(i) + glIsVertexArray(i) + glIsSampler(i) +
                     glIsQuery(i);
        if (glIsTexture(i)) {
            m.objects++;
            m.gl += texture_size(i);
        }
        if (glIsBuffer(i)) {
            GLint64 size = 0;
            glGetNamedBufferParameteri64v(i, GL_BUFFER_SIZE, &size);
            m.objects++;
            m.gl += (double) size;
        }
    }
    malloc_trim(0); // what the allocator keeps for later is no growth
    m.resident = resident();
    return m;
}

static void print_memory(int after, const memory *m)
{
    printf("after %4d switches: graph %.0f bytes, OpenGL %.0f bytes in %d objects, resident %.2f "
           "MB\n",
           after, m->pool, m->gl, m->objects, m->resident / 1e6);
}

// Whether a figure has changed by more than 1 %.
static bool grown(const char *what, double early, double late)
{
    const double change = late / early - 1;
    if (change <= 0.01 && change >= -0.01)
        return false;
    printf("FAIL: %s: %.6g after the %dth switch, %.6g after the last: %+.2f %%\n", what, early,
           EARLY, late, 100 * change);
    return true;
}

// ---- the run ---------------------------------------------------------------------------------

static uint64_t state_ = 1;
static int roll(int sides) // xorshift64*
{
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    return (int) ((state_ * 0x2545f4914f6cdd1du >> 33) % (uint64_t) sides);
}

// All cases in turn at first, and one case where memory is measured.
static int next_case(int i, int count)
{
    if (i == EARLY || (i == count && count > EARLY))
        return MEASURED;
    return i <= CASES ? i - 1 : roll(CASES);
}

static void report_difference(int i, int which, const float *got, const float *due)
{
    const char *plugin = settings[which % SETTINGS].plugin;
    int count = 0;
    float most = 0;
    for (int k = 0; k < FLOATS; k++) {
        count += got[k] != due[k];
        most = fmaxf(most, fabsf(got[k] - due[k]));
    }
    printf(
        "FAIL: switch %d, to %s with setting %d (%s): not the first frame of a process, %d of %d "
        "values differ by up to %g\n",
        i, scene_names[which / SETTINGS], which % SETTINGS, plugin ? plugin : "none", count,
        (int) FLOATS, (double) most);
}

static bool one_switch(stress *s, int i, int which)
{
    float rgb[FLOATS];
    fg_status status = switch_to(s, which);
    if (!status)
        status = frame(s, 0, rgb);
    if (!status && !s->first[which]) {
        s->first[which] = malloc(sizeof rgb);
        status = s->first[which] ? FG_OK : FG_ERR_MEMORY;
        if (!status)
            memcpy(s->first[which], rgb, sizeof rgb);
    }
    if (!status && memcmp((const char *) rgb, (const char *) s->first[which], sizeof rgb) != 0) {
        report_difference(i, which, rgb, s->first[which]);
        return false;
    }
    if (!status)
        status = frame(s, (1 + roll(4)) / 60.0, NULL);
    return status == FG_OK;
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec;
}

static bool run(stress *s, const char *self, int count)
{
    memory early = { 0 };
    bool good = true;
    for (int i = 0; i < CASES && good && count > EARLY; i++)
        good = take_first(s, self, i);
    if (!good)
        printf("FAIL: a process of its own has no first frame, or none that is finite\n");
    const double start = seconds();
    for (int i = 1; i <= count && good; i++) {
        good = one_switch(s, i, next_case(i, count));
        if (good && i == EARLY) {
            early = measure(s);
            print_memory(i, &early);
        } else if (good && i % 100 == 0 && i != count) {
            printf("%d switches, %.1f s, resident %.2f MB\n", i, seconds() - start,
                   resident() / 1e6);
            fflush(stdout);
        }
    }
    if (!good || count <= EARLY)
        return good;
    const memory late = measure(s);
    print_memory(count, &late);
    printf("%.1f s\n", seconds() - start);
    good = !grown("bytes of the graph", early.pool, late.pool);
    good = !grown("bytes of OpenGL's objects", early.gl, late.gl) && good;
    good = !grown("objects", early.objects, late.objects) && good;
    // Less is no leak: that much comes and goes with what the allocator holds back.
    return !(late.resident > early.resident &&
             grown("resident bytes", early.resident, late.resident)) &&
           good;
}

int main(int argc, char **argv)
{
    stress s;
    if (argc == 4 && !strcmp(argv[1], "first"))
        return run_first(atoi(argv[2]), argv[3]);
    const int count = argc > 1 ? atoi(argv[1]) : 1000;
    state_ = argc > 2 ? (uint64_t) atoi(argv[2]) + 1 : 1;
    if (count < 1) {
        fprintf(stderr, "switches: the count must be positive\n");
        return 2;
    }
    bool good = open_device(&s) == FG_OK;
    s.debug = FG_DEBUG_POISON; // what is fresh has none: poison that shows is a difference
    good = good && run(&s, argv[0], count);
    const int errors = close_device(&s);
    if (errors)
        printf("FAIL: %d OpenGL errors\n", errors);
    return good && !errors ? 0 : 1;
}
