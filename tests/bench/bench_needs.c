// SPDX-License-Identifier: MIT
// What leaving out what a scene does not need is worth: frames with `needs` honoured and with
// everything forced on, in turn, for each built-in scene and technique.
//
//     bench_needs [--size N|WxH] [--scene NAME] [--gi NAME]... [--least] [--verbose] [FIGURE]...
//
// Direct light, rsm and isr at 160 x 90 where nothing is said. Figures are "needs.FIGURE.GI":
// ms and bytes as they are ("kept") and forced on ("all"), and what is saved as a ratio; a table of
// the same is on stderr. "cpu" is what all threads of the process take: on a software renderer all
// of a frame, and less disturbed by what else the machine does than the time that passes.
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { KEPT, ALL, SIDES };
enum { WARM = 1, LEAST = 3, MOST = 21 };
static const double patience_ms = 2e3; // after that, LEAST frames have to do

// Both sides, and the CPU's time of their frames.
typedef struct pair {
    side sides[SIDES];
    samples cpu[SIDES];
} pair;

typedef struct bytes {
    double transient, persistent, unshared;
} bytes;

static bytes bytes_of(const side *s)
{
    const fg_graph_stats stats = fg_graph_get_stats(renderer_graph(s->r));
    return (bytes){ (double) stats.transient_bytes, (double) stats.persistent_bytes,
                    (double) stats.unshared_bytes };
}

static double cpu_now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double) t.tv_sec * 1e3 + (double) t.tv_nsec * 1e-6;
}

static fg_status run_frame(const bench *b, pair *p, int k, int frame)
{
    const double start = cpu_now_ms();
    const fg_status status = side_frame(b, &p->sides[k], frame / 60.0);
    samples_add(&p->cpu[k], cpu_now_ms() - start);
    return status;
}

static fg_status run_frames(const bench *b, pair *p)
{
    fg_status status = FG_OK;
    for (int i = 0; i < WARM; i++)
        for (int k = 0; k < SIDES && status == FG_OK; k++)
            status = run_frame(b, p, k, i);
    for (int k = 0; k < SIDES; k++) {
        side_forget(&p->sides[k]);
        p->cpu[k].count = 0;
    }
    const double start = bench_now_ms();
    for (int i = 0; i < MOST && status == FG_OK; i++) {
        if (i >= LEAST && bench_now_ms() - start > patience_ms)
            break;
        // Which goes first changes, so that a drift of the machine's speed meets both.
        for (int k = 0; k < SIDES && status == FG_OK; k++)
            status = run_frame(b, p, (i + k) % SIDES, WARM + i);
    }
    return status;
}

static void print_one(const bench *b, const char *what, const char *technique, double value,
                      const char *unit)
{
    char name[96];
    snprintf(name, sizeof name, "needs.%s.%s", what, technique);
    bench_print(b, name, b->size, value, unit);
}

static void print_bytes(const bench *b, const char *of, const char *technique, const bytes *m)
{
    char what[64];
    snprintf(what, sizeof what, "transient_%s", of);
    print_one(b, what, technique, m->transient, "bytes");
    snprintf(what, sizeof what, "persistent_%s", of);
    print_one(b, what, technique, m->persistent, "bytes");
    snprintf(what, sizeof what, "unshared_%s", of);
    print_one(b, what, technique, m->unshared, "bytes");
}

static void print_figures(const bench *b, const char *technique, const pair *p)
{
    const double kept = samples_typical(&p->sides[KEPT].frame),
                 all = samples_typical(&p->sides[ALL].frame), cpu = samples_typical(&p->cpu[KEPT]),
                 cpu_all = samples_typical(&p->cpu[ALL]);
    const bytes m = bytes_of(&p->sides[KEPT]), forced = bytes_of(&p->sides[ALL]);
    print_one(b, "ms_kept", technique, kept, "ms");
    print_one(b, "ms_all", technique, all, "ms");
    print_one(b, "all_over_kept", technique, all / kept, "x");
    print_one(b, "cpu_ms_kept", technique, cpu, "ms");
    print_one(b, "cpu_ms_all", technique, cpu_all, "ms");
    print_one(b, "cpu_all_over_kept", technique, cpu_all / cpu, "x");
    print_bytes(b, "kept", technique, &m);
    print_bytes(b, "all", technique, &forced);
    fprintf(
        stderr,
        "%-12s %-6s %9.2f %9.2f %6.2f x %9.2f %9.2f %6.2f x %10.2f %8.2f %8.2f %8.2f %8.2f %8.2f\n",
        b->label, technique, kept, all, all / kept, cpu, cpu_all, cpu_all / cpu, m.transient * 1e-6,
        forced.transient * 1e-6, m.persistent * 1e-6, forced.persistent * 1e-6, m.unshared * 1e-6,
        forced.unshared * 1e-6);
}

static fg_status measure(const bench *b, const char *technique)
{
    const char *plugin = strcmp(technique, "none") ? technique : NULL;
    pair p = { .sides = { [KEPT] = { .plugin = plugin, .values = "" },
                          [ALL] = { .plugin = plugin, .values = "", .needs_all = true } } };
    fg_status status = FG_OK;
    for (int k = 0; k < SIDES && status == FG_OK; k++)
        status = side_open(b, &p.sides[k], b->size);
    if (status == FG_OK)
        status = run_frames(b, &p);
    if (status == FG_OK)
        print_figures(b, technique, &p);
    for (int k = 0; k < SIDES; k++) {
        side_list(b, &p.sides[k]);
        side_close(&p.sides[k]);
    }
    return status == FG_ERR_UNSUPPORTED && plugin ? FG_OK : status; // it has been said
}

static void print_head(void)
{
    static bool said;
    if (!said)
        fprintf(stderr, "%-12s %-6s %19s %8s %19s %8s %19s %17s %17s\n", "scene", "gi",
                "ms, kept and all", "ratio", "cpu ms", "ratio", "transient MB", "persistent MB",
                "unshared MB");
    said = true;
}

static fg_status bench_needs(const bench *b)
{
    static const char *const usual[] = { "none", "rsm", "isr" };
    const char *const *techniques = b->technique_count ? b->techniques : usual;
    const int count = b->technique_count ? b->technique_count : FG_COUNT(usual);
    fg_status status = FG_OK;
    print_head();
    for (int i = 0; i < count && status == FG_OK; i++)
        status = measure(b, techniques[i]);
    return status;
}

int main(int argc, char **argv)
{
    static const bench_part parts[] = { bench_needs, NULL };
    const bench_program program = {
        .name = "bench_needs",
        .size = { 160, 90 },
        .builtin = true,
        .parts = parts,
    };
    return bench_main(&program, argc, argv);
}
