// SPDX-License-Identifier: MIT
// What leaving out what a scene does not need is worth: frames with `needs` honoured and with
// everything forced on, in turn, for each built-in scene and technique.
//
//     bench_needs [--size N|WxH] [--scene NAME] [--gi NAME]... [--least] [--verbose] [FIGURE]...
//
// Direct light, rsm and isr at 320 x 180 where nothing is said. Figures are "needs.FIGURE.GI":
// ms and bytes as they are ("kept") and forced on ("all"), and what is saved as a ratio; a table of
// the same is on stderr.
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { KEPT, ALL, SIDES };
enum { WARM = 2, LEAST = 5, MOST = 21 };
static const double patience_ms = 4e3; // after that, LEAST frames have to do

typedef struct bytes {
    double transient, persistent, unshared;
} bytes;

static bytes bytes_of(const side *s)
{
    const fg_graph_stats stats = fg_graph_get_stats(renderer_graph(s->r));
    return (bytes){ (double) stats.transient_bytes, (double) stats.persistent_bytes,
                    (double) stats.unshared_bytes };
}

static fg_status run_frames(const bench *b, side *sides)
{
    fg_status status = FG_OK;
    for (int i = 0; i < WARM; i++)
        for (int k = 0; k < SIDES && status == FG_OK; k++)
            status = side_frame(b, &sides[k], i / 60.0);
    for (int k = 0; k < SIDES; k++)
        side_forget(&sides[k]);
    const double start = bench_now_ms();
    for (int i = 0; i < MOST && status == FG_OK; i++) {
        if (i >= LEAST && bench_now_ms() - start > patience_ms)
            break;
        // Which goes first changes, so that a drift of the machine's speed meets both.
        for (int k = 0; k < SIDES && status == FG_OK; k++)
            status = side_frame(b, &sides[(i + k) % SIDES], (WARM + i) / 60.0);
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

static void print_figures(const bench *b, const char *technique, const side *sides)
{
    const double kept = samples_typical(&sides[KEPT].frame),
                 all = samples_typical(&sides[ALL].frame);
    const bytes m = bytes_of(&sides[KEPT]), forced = bytes_of(&sides[ALL]);
    print_one(b, "ms_kept", technique, kept, "ms");
    print_one(b, "ms_all", technique, all, "ms");
    print_one(b, "all_over_kept", technique, all / kept, "x");
    print_bytes(b, "kept", technique, &m);
    print_bytes(b, "all", technique, &forced);
    fprintf(
        stderr, "%-12s %-6s %8.2f ms %8.2f ms %8.2f x  %10.2f %10.2f %10.2f %10.2f %10.2f %10.2f\n",
        b->label, technique, kept, all, all / kept, m.transient * 1e-6, forced.transient * 1e-6,
        m.persistent * 1e-6, forced.persistent * 1e-6, m.unshared * 1e-6, forced.unshared * 1e-6);
}

static fg_status measure(const bench *b, const char *technique)
{
    const char *plugin = strcmp(technique, "none") ? technique : NULL;
    side sides[SIDES] = { [KEPT] = { .plugin = plugin, .values = "" },
                          [ALL] = { .plugin = plugin, .values = "", .needs_all = true } };
    fg_status status = FG_OK;
    for (int k = 0; k < SIDES && status == FG_OK; k++)
        status = side_open(b, &sides[k], b->size);
    if (status == FG_OK)
        status = run_frames(b, sides);
    if (status == FG_OK)
        print_figures(b, technique, sides);
    for (int k = 0; k < SIDES; k++) {
        side_list(b, &sides[k]);
        side_close(&sides[k]);
    }
    return status == FG_ERR_UNSUPPORTED && plugin ? FG_OK : status; // it has been said
}

static void print_head(void)
{
    static bool said;
    if (!said)
        fprintf(stderr, "%-12s %-6s %11s %11s %10s  %21s %21s %21s\n", "scene", "gi", "kept", "all",
                "ratio", "transient MB", "persistent MB", "unshared MB");
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
        .size = { 320, 180 },
        .builtin = true,
        .parts = parts,
    };
    return bench_main(&program, argc, argv);
}
