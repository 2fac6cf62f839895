// SPDX-License-Identifier: MIT
// What a frame costs the CPU in the graph itself, a declared pass: on the null device,
// with callbacks that do nothing. Time is that of the thread, so that other load on the
// machine counts little.
//
// The graph is a chain, every second pass compute, with a branch that nobody reads after
// each four passes. Each pass makes a texture of its own.
#include <fg/device.h>

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SIZES = 4, REPEATS = 41, MOST = 10000 };

typedef struct counter {
    long calls;
} counter;

static void *count_calls(void *user, void *ptr, size_t size)
{
    counter *c = user;
    c->calls++;
    if (size)
        return realloc(ptr, size);
    free(ptr);
    return NULL;
}

static fg_status nothing(const fg_run *run, void *user)
{
    (void) run;
    (void) user;
    return FG_OK;
}

static char names[MOST][2][16];

static void name_all(void)
{
    for (int i = 0; i < MOST; i++) {
        snprintf(names[i][0], sizeof names[i][0], "pass.%d", i);
        snprintf(names[i][1], sizeof names[i][1], "texture.%d", i);
    }
}

// `variant` changes the last texture, so that the graph must be compiled anew.
static void declare(fg_graph *g, int count, int variant)
{
    fg_graph_begin(g, &(fg_frame_desc){ .width = 1920, .height = 1080 });
    fg_res before = { 0 };
    for (int i = 0; i < count; i++) {
        const bool last = i == count - 1, branch = i % 5 == 3 && !last;
        const fg_format format = last && variant ? FG_RG16F : FG_RGBA16F;
        const fg_res made = fg_texture(g, names[i][1], &(fg_tex_desc){ .format = format });
        const fg_pass_desc pass = {
            .name = names[i][0],
            .kind = i % 2 ? FG_KIND_COMPUTE : FG_KIND_RASTER,
            .reads = { { before } },
            .writes = { { made, .load = FG_LOAD_DISCARD } },
            .effect = last ? FG_EFFECT_EXTERNAL : FG_EFFECT_NONE,
            .run = nothing,
        };
        fg_passes(g, &pass, 1);
        if (!branch)
            before = made;
    }
}

static double now_us(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double) t.tv_sec * 1e6 + (double) t.tv_nsec * 1e-3;
}

static void must(fg_status status)
{
    if (status == FG_OK)
        return;
    fprintf(stderr, "bench_graph: %s\n", fg_status_name(status));
    exit(1);
}

// Microseconds a pass for `frames` frames; each is compiled anew if `change`.
static double measure(fg_graph *g, int count, int frames, bool change)
{
    static int variant;
    const double start = now_us();
    for (int i = 0; i < frames; i++) {
        variant ^= change;
        declare(g, count, variant);
        must(fg_graph_compile(g));
        must(fg_graph_run(g));
    }
    return (now_us() - start) / frames / count;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

int main(void)
{
    static const int sizes[SIZES] = { 10, 100, 1000, 10000 };
    static double compiled[SIZES][REPEATS], cached[SIZES][REPEATS];
    counter allocations = { 0 };
    long cached_allocations = 0;
    name_all();
    fg_device *dev = fg_null_create(NULL);
    const fg_graph_desc desc = { .device = dev, .allocator = { count_calls, &allocations } };
    fg_graph *g[SIZES];
    for (int s = 0; s < SIZES; s++) {
        g[s] = fg_graph_create(&desc);
        measure(g[s], sizes[s], 4, true);
        measure(g[s], sizes[s], 4, false);
    }
    for (int i = 0; i < REPEATS; i++)
        for (int s = 0; s < SIZES; s++) {
            const int frames = MOST / sizes[s] < 100 ? MOST / sizes[s] : 100;
            compiled[s][i] = measure(g[s], sizes[s], frames, true);
            measure(g[s], sizes[s], 1, false);
            const long before = allocations.calls;
            cached[s][i] = measure(g[s], sizes[s], frames, false);
            cached_allocations += allocations.calls - before;
        }
    for (int s = 0; s < SIZES; s++) {
        qsort(compiled[s], REPEATS, sizeof(double), ascending);
        qsort(cached[s], REPEATS, sizeof(double), ascending);
        printf("BENCH fg.us_per_pass_%d null %d %.4f us\n", sizes[s], sizes[s],
               compiled[s][REPEATS / 2]);
        printf("BENCH fg.cached_us_per_pass_%d null %d %.4f us\n", sizes[s], sizes[s],
               cached[s][REPEATS / 2]);
        fg_graph_destroy(g[s]);
    }
    printf("BENCH fg.cached_allocations null %d %ld 1\n", MOST, cached_allocations);
    fg_device_destroy(dev);
    return 0;
}
