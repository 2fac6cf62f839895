// SPDX-License-Identifier: MIT
// Random graphs, run on a device that simulates memory: each texel block (a mip of an
// object) holds one number. A pass makes a number from its name and all that it reads.
// What it sees must be what it would see if all passes ran in the order in which they
// were thought of, every resource in memory of its own.
#include "rig.h"

#include <stdio.h>

enum { MIPS = 3, MOST_RES = 12, MOST_PASSES = 40, MOST_OBJECTS = 4096, FRAMES = 3 };

static uint64_t mix(uint64_t a, uint64_t b)
{
    uint64_t h = (a ^ b * 0x9e3779b97f4a7c15u) + 0x632be59bd9b4e019u;
    h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
    return h ^ h >> 27;
}

static uint64_t random_state;

static unsigned random_below(unsigned n)
{
    random_state = mix(random_state, 1);
    return (unsigned) (random_state >> 16) % n;
}

// ---- a device that simulates memory -----------------------------------------------------

//
// It also keeps the clock of OpenGL's incoherent memory: when each block was stored to by a
// shader (`stored`) and when it was last touched, and the last barrier of each kind.
typedef struct sim {
    fg_device base;
    uint64_t memory[MOST_OBJECTS][MIPS];
    unsigned stored[MOST_OBJECTS][MIPS], touched[MOST_OBJECTS][MIPS];
    unsigned clock, barrier[9];
    uint32_t block[MOST_OBJECTS]; // object -> row of `memory`; views share
    uint32_t objects;
    int live;
    uint64_t garbage;
} sim;

static const fg_device_limits *limits(fg_device *dev)
{
    static const fg_device_limits l = { 8, 16384, 2048, 2048, 4, 1 << 27 };
    (void) dev;
    return &l;
}

static void fill_garbage(sim *s, uint32_t object)
{
    for (int m = 0; m < MIPS; m++)
        s->memory[s->block[object]][m] = mix(++s->garbage, 77);
}

static uint32_t add_object(sim *s, uint32_t block)
{
    assert_true(s->objects + 1 < MOST_OBJECTS);
    s->block[++s->objects] = block;
    s->live++;
    return s->objects;
}

static fg_status create_texture(fg_device *dev, const char *label, const fg_tex_desc *desc,
                                uint32_t *object)
{
    sim *s = (sim *) dev;
    (void) label;
    (void) desc;
    *object = add_object(s, s->objects + 1);
    fill_garbage(s, *object);
    return FG_OK;
}

static fg_status create_view(fg_device *dev, const char *label, uint32_t of,
                             const fg_tex_desc *desc, uint32_t *object)
{
    sim *s = (sim *) dev;
    (void) label;
    (void) desc;
    *object = add_object(s, s->block[of]);
    return FG_OK;
}

static fg_status create_buffer(fg_device *dev, const char *label, uint64_t size, uint32_t *object)
{
    (void) size;
    return create_texture(dev, label, NULL, object);
}

static void destroy_object(fg_device *dev, uint32_t object)
{
    ((sim *) dev)->live--;
    (void) object;
}

static fg_status frame_begin(fg_device *dev, uint64_t frame, int timers)
{
    (void) dev;
    (void) frame;
    (void) timers;
    return FG_OK;
}

static fg_status frame_end(fg_device *dev)
{
    (void) dev;
    return FG_OK;
}

static void barrier(fg_device *dev, unsigned bits)
{
    sim *s = (sim *) dev;
    assert_int_not_equal(bits, 0);
    for (int i = 0; i < 9; i++)
        if (bits >> i & 1)
            s->barrier[i] = ++s->clock;
}

// C90, C91: an access of a kind sees earlier stores only past a barrier of that kind, and
// a store must not overtake any earlier access.
static void touch(sim *s, uint32_t block, int mip, int kind, bool store)
{
    if (s->stored[block][mip] > s->barrier[kind])
        fail_msg("a barrier of kind %d is missing after a store", kind);
    if (store && s->touched[block][mip] > s->barrier[kind])
        fail_msg("a barrier of kind %d is missing before a store", kind);
}

static void clear(fg_device *dev, const fg_clear *c)
{
    sim *s = (sim *) dev;
    const uint32_t block = s->block[c->object];
    for (int m = c->mip; m < c->mip + c->mips; m++) {
        touch(s, block, m, 8, false);
        s->touched[block][m] = ++s->clock;
        s->stored[block][m] = 0; // nothing of it shows any more
        s->memory[block][m] = c->poison ? mix(++s->garbage, 99) : (uint64_t) c->value[0];
    }
}

static fg_status pass_begin(fg_device *dev, const fg_pass_begin *begin)
{
    (void) dev;
    (void) begin;
    return FG_OK;
}

static void pass_end(fg_device *dev, const fg_pass_begin *begin)
{
    (void) dev;
    (void) begin;
}

// NOLINTNEXTLINE(readability-non-const-parameter): the table has it so
static bool timing(fg_device *dev, int timer, double *start_ms, double *ms, uint64_t *frame)
{
    (void) dev;
    (void) timer;
    (void) start_ms;
    (void) ms;
    (void) frame;
    return false;
}

static void nothing(fg_device *dev)
{
    (void) dev;
}

static const fg_device_ops sim_ops = {
    "sim",          limits,      create_texture, create_view, create_buffer, destroy_object,
    destroy_object, frame_begin, frame_end,      barrier,     clear,         pass_begin,
    pass_end,       timing,      nothing,        nothing,
};

// ---- a random graph -----------------------------------------------------------------------

typedef struct res {
    fg_tex_desc desc;
    uint64_t bytes; // > 0: a buffer
    int mips, versions;
    bool written[MIPS];
    fg_res handle;
} res;

typedef struct io {
    int res, version, mip, mips; // version 0: last frame's
    fg_use use;
    fg_load load;
    float clear;
} io;

typedef struct pass {
    char name[16];
    fg_kind kind;
    fg_effect effect;
    bool left_out;
    io reads[4], writes[3];
    int read_count, write_count;
    // While it runs.
    struct world *world;
    uint64_t expected[FRAMES];
    int runs;
} pass;

typedef struct world {
    sim sim;
    fg_log log;
    res res[MOST_RES];
    pass pass[MOST_PASSES];
    int order[MOST_PASSES]; // of declaration
    int res_count, pass_count, frame;
    char said[4096];
} world;

static bool pass_names(const pass *p, int r)
{
    for (int i = 0; i < p->read_count; i++)
        if (p->reads[i].res == r)
            return true;
    for (int i = 0; i < p->write_count; i++)
        if (p->writes[i].res == r)
            return true;
    return false;
}

static void think_of_resources(world *w)
{
    static const fg_format formats[] = { FG_RGBA16F, FG_RG32F, FG_R32UI };
    w->res_count = 3 + (int) random_below(MOST_RES - 3);
    for (int i = 0; i < w->res_count; i++) {
        res *r = &w->res[i];
        r->mips = random_below(3) ? 1 : MIPS;
        r->bytes = random_below(5) ? 0 : 64;
        r->mips = r->bytes ? 1 : r->mips;
        r->desc = (fg_tex_desc){ .format = formats[random_below(3)], .mips = r->mips };
        r->desc.history = random_below(5) ? FG_HISTORY_NONE : FG_HISTORY_CLEAR;
    }
}

static void think_of_read(world *w, pass *p, int r)
{
    const res *x = &w->res[r];
    io *in = &p->reads[p->read_count];
    *in = (io){ .res = r, .version = x->versions, .mips = x->mips };
    in->use = x->bytes ? FG_USE_STORAGE : random_below(2) ? FG_USE_SAMPLED : FG_USE_IMAGE;
    if (x->desc.history && random_below(2)) {
        in->version = 0;
    } else if (x->mips > 1 && random_below(2)) {
        in->mip = (int) random_below(MIPS);
        in->mips = 1;
        if (!x->written[in->mip])
            return;
    }
    p->read_count += in->version > 0 || x->desc.history;
}

static void think_of_write(world *w, pass *p, int r)
{
    res *x = &w->res[r];
    io *out = &p->writes[p->write_count++];
    *out = (io){ .res = r, .version = ++x->versions, .mips = x->mips };
    out->load = (fg_load) random_below(3);
    out->clear = (float) (1 + random_below(9));
    out->use = x->bytes ? FG_USE_STORAGE : p->kind == FG_KIND_COMPUTE ? FG_USE_IMAGE : FG_USE_COLOR;
    if (x->mips > 1 && (out->use == FG_USE_COLOR || random_below(2))) {
        // Attachments are of one size.
        out->mip = out->use == FG_USE_COLOR ? 0 : (int) random_below(MIPS);
        out->mips = 1;
    }
    // In place, where it is allowed: it sees the version before.
    if (out->version > 1 && out->use != FG_USE_COLOR && out->load == FG_LOAD_KEEP &&
        x->written[out->mip] && random_below(3) == 0 && p->read_count < 4) {
        p->reads[p->read_count] = *out;
        p->reads[p->read_count++].version--;
    }
    for (int m = out->mip; m < out->mip + out->mips; m++)
        x->written[m] |= !p->left_out;
}

// A left out pass may only change what is there in full.
static bool may_leave_out(const world *w)
{
    for (int r = 0; r < w->res_count; r++)
        for (int m = 0; m < w->res[r].mips; m++)
            if (!w->res[r].written[m])
                return false;
    return random_below(6) == 0;
}

static void think_of_passes(world *w)
{
    w->pass_count = w->res_count + (int) random_below((unsigned) (MOST_PASSES - w->res_count));
    for (int i = 0; i < w->pass_count; i++) {
        pass *p = &w->pass[i];
        snprintf(p->name, sizeof p->name, "g%u.p%d", random_below(3), i);
        p->world = w;
        p->kind = (fg_kind) random_below(2);
        p->effect = (fg_effect) (random_below(4) ? 0 : 1 + random_below(2));
        p->left_out = may_leave_out(w);
        for (unsigned k = random_below(4); k > 0; k--) {
            const int r = (int) random_below((unsigned) w->res_count);
            if (r != i && !pass_names(p, r) && w->res[r].versions)
                think_of_read(w, p, r);
        }
        // The first passes see to it that everything is written.
        if (i < w->res_count)
            think_of_write(w, p, i);
        const int r = (int) random_below((unsigned) w->res_count);
        if (!pass_names(p, r))
            think_of_write(w, p, r);
    }
    w->pass[w->pass_count - 1].effect = FG_EFFECT_EXTERNAL;
    w->pass[w->pass_count - 1].left_out = false;
}

// One may not go before the other: it overwrites what the other reads.
static bool must_stay(const pass *reader, const pass *writer)
{
    for (int i = 0; i < reader->read_count; i++)
        for (int k = 0; k < writer->write_count; k++)
            if (reader->reads[i].res == writer->writes[k].res && reader->reads[i].version &&
                writer->writes[k].version == reader->reads[i].version + 1)
                return true;
    return false;
}

static void shuffle_declaration(world *w)
{
    for (int i = 0; i < w->pass_count; i++)
        w->order[i] = i;
    for (unsigned n = random_below(2) * 200; n > 0; n--) {
        const int i = (int) random_below((unsigned) w->pass_count);
        if (i + 1 >= w->pass_count || must_stay(&w->pass[w->order[i]], &w->pass[w->order[i + 1]]))
            continue;
        const int hold = w->order[i];
        w->order[i] = w->order[i + 1];
        w->order[i + 1] = hold;
    }
}

// ---- what should happen -------------------------------------------------------------------

static uint64_t name_of(const pass *p)
{
    uint64_t h = 5;
    for (const char *c = p->name; *c; c++)
        h = mix(h, (uint64_t) *c);
    return h;
}

// What a pass sees and makes of texels as they are and as they were last frame.
static void expect_pass(pass *p, int frame, uint64_t (*now)[MIPS], uint64_t (*last)[MIPS])
{
    uint64_t h = name_of(p);
    for (int k = 0; k < p->read_count; k++)
        for (int m = p->reads[k].mip; m < p->reads[k].mip + p->reads[k].mips; m++)
            h = mix(h, (p->reads[k].version ? now : last)[p->reads[k].res][m]);
    p->expected[frame] = h;
    for (int k = 0; k < p->write_count; k++) {
        const io *out = &p->writes[k];
        for (int m = out->mip; m < out->mip + out->mips; m++) {
            uint64_t *texel = &now[out->res][m];
            *texel = out->load == FG_LOAD_CLEAR ? (uint64_t) out->clear : *texel;
            *texel = out->load == FG_LOAD_DISCARD ? h : mix(h, *texel);
        }
    }
}

// Runs all passes in the order in which they were thought of.
static void expect(world *w)
{
    static uint64_t now[MOST_RES][MIPS], last[MOST_RES][MIPS];
    memset(now, 0, sizeof now);
    for (int f = 0; f < FRAMES; f++) {
        memcpy(last, now, sizeof last);
        memset(now, 0, sizeof now);
        for (int i = 0; i < w->pass_count; i++)
            if (!w->pass[i].left_out)
                expect_pass(&w->pass[i], f, now, last);
    }
}

// ---- what does happen ---------------------------------------------------------------------

static fg_res handle_of(const world *w, const io *x)
{
    fg_res h = w->res[x->res].handle;
    h.version = x->version ? (uint16_t) x->version : UINT16_MAX;
    return h;
}

static uint64_t *memory_of(const fg_run *run, world *w, const io *x)
{
    const uint32_t object = fg_run_object(run, handle_of(w, x));
    assert_int_not_equal(object, 0);
    return w->sim.memory[w->sim.block[object]];
}

static void note(sim *s, uint32_t block, int mip, bool store, bool discard)
{
    s->touched[block][mip] = ++s->clock;
    if (store)
        s->stored[block][mip] = s->clock;
    else if (discard)
        s->stored[block][mip] = 0;
}

// A pass makes all its accesses at once, after the barriers before it.
static void touch_all(const fg_run *run, const pass *p)
{
    static const int kinds[] = {
        [FG_USE_SAMPLED] = 0, [FG_USE_IMAGE] = 1, [FG_USE_COLOR] = 2, [FG_USE_STORAGE] = 3
    };
    world *w = p->world;
    sim *s = &w->sim;
    for (int k = 0; k < 2 * (p->read_count + p->write_count); k++) {
        const int i = k % (p->read_count + p->write_count);
        const bool write = i >= p->read_count, check = k == i;
        const io *x = write ? &p->writes[i - p->read_count] : &p->reads[i];
        const bool store = write && (x->use == FG_USE_IMAGE || x->use == FG_USE_STORAGE);
        const uint32_t block = s->block[fg_run_object(run, handle_of(w, x))];
        for (int m = x->mip; m < x->mip + x->mips; m++) {
            if (check)
                touch(s, block, m, kinds[x->use], store);
            else
                note(s, block, m, store, write && x->load == FG_LOAD_DISCARD);
        }
    }
}

static fg_status execute(const fg_run *run, void *user)
{
    pass *p = user;
    world *w = p->world;
    uint64_t h = name_of(p);
    touch_all(run, p);
    for (int k = 0; k < p->read_count; k++) {
        const uint64_t *memory = memory_of(run, w, &p->reads[k]);
        for (int m = p->reads[k].mip; m < p->reads[k].mip + p->reads[k].mips; m++)
            h = mix(h, memory[m]);
    }
    if (h != p->expected[w->frame])
        fail_msg("pass %s saw something else in frame %d", p->name, w->frame);
    p->runs++;
    for (int k = 0; k < p->write_count; k++) {
        uint64_t *memory = memory_of(run, w, &p->writes[k]);
        for (int m = p->writes[k].mip; m < p->writes[k].mip + p->writes[k].mips; m++)
            memory[m] = p->writes[k].load == FG_LOAD_DISCARD ? h : mix(h, memory[m]);
    }
    return FG_OK;
}

static fg_io io_of(fg_graph *g, const world *w, const io *x)
{
    fg_res h = handle_of(w, x);
    if (!x->version)
        h = fg_last_frame(g, w->res[x->res].handle);
    const bool part = x->mips < w->res[x->res].mips;
    return (fg_io){ .res = h,
                    .use = x->use,
                    .load = x->load,
                    .clear = { x->clear },
                    .mip = (uint8_t) x->mip,
                    .mips = part ? (uint8_t) x->mips : 0 };
}

static void declare(world *w, fg_graph *g)
{
    fg_graph_begin(g, &(fg_frame_desc){ .width = 64, .height = 64 });
    for (int i = 0; i < w->res_count; i++) {
        char name[16];
        snprintf(name, sizeof name, "r%d", i);
        const fg_buf_desc buf = { .size = w->res[i].bytes, .history = w->res[i].desc.history };
        w->res[i].handle =
            buf.size ? fg_buffer(g, name, &buf) : fg_texture(g, name, &w->res[i].desc);
    }
    for (int i = 0; i < w->pass_count; i++) {
        pass *p = &w->pass[w->order[i]];
        fg_pass_desc desc = { .name = p->name,
                              .kind = p->kind,
                              .effect = p->effect,
                              .needs = p->left_out,
                              .run = execute,
                              .user = p };
        for (int k = 0; k < p->read_count; k++)
            desc.reads[k] = io_of(g, w, &p->reads[k]);
        for (int k = 0; k < p->write_count; k++)
            desc.writes[k] = io_of(g, w, &p->writes[k]);
        fg_passes(g, &desc, 1);
    }
}

static void hear(void *user, fg_log_level level, const char *msg)
{
    world *w = user;
    const size_t at = strlen(w->said);
    (void) level;
    snprintf(w->said + at, sizeof w->said - at, "%s\n", msg);
}

// Returns the passes that ran.
static int run_frames(world *w, unsigned debug, uint64_t seed)
{
    w->sim.base.ops = &sim_ops;
    w->log = (fg_log){ hear, w, FG_LOG_ERROR };
    w->said[0] = '\0';
    const fg_graph_desc desc = {
        .device = &w->sim.base, .log = &w->log, .debug = debug, .seed = seed
    };
    fg_graph *g = fg_graph_create(&desc);
    assert_non_null(g);
    for (int i = 0; i < w->pass_count; i++)
        w->pass[i].runs = 0;
    for (w->frame = 0; w->frame < FRAMES; w->frame++) {
        declare(w, g);
        if (fg_graph_compile(g) != FG_OK || fg_graph_run(g) != FG_OK)
            fail_msg("refused: %s", w->said);
    }
    const fg_graph_stats s = fg_graph_get_stats(g);
    int ran = 0;
    for (int i = 0; i < w->pass_count; i++) { // C53
        assert_true(w->pass[i].runs == 0 || w->pass[i].runs == FRAMES);
        ran += w->pass[i].runs > 0;
    }
    assert_int_equal(ran, s.kept);
    assert_true(s.live_bytes <= s.transient_bytes && s.transient_bytes <= s.unshared_bytes);
    assert_int_equal(s.compiles, 1);
    fg_graph_destroy(g);
    assert_int_equal(w->sim.live, 0);
    return ran;
}

static void random_graphs_pass_on_the_right_data(void **state) // C52, C53, C62, C69
{
    (void) state;
    world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    int shared = 0;
    for (unsigned i = 0; i < 1500; i++) {
        memset(w, 0, sizeof *w);
        random_state = i + 1;
        think_of_resources(w);
        think_of_passes(w);
        shuffle_declaration(w);
        expect(w);
        const int ran = run_frames(w, 0, 0);
        assert_int_equal(run_frames(w, FG_DEBUG_NO_SHARING, 0), ran);
        assert_int_equal(run_frames(w, FG_DEBUG_POISON, 0), ran);
        assert_int_equal(run_frames(w, FG_DEBUG_RANDOM_ORDER, i), ran);
        assert_int_equal(run_frames(w, FG_DEBUG_RANDOM_ORDER | FG_DEBUG_POISON, i + 7), ran);
        assert_true(run_frames(w, FG_DEBUG_KEEP_ALL | FG_DEBUG_RANDOM_ORDER, i) >= ran);
        shared += ran < w->pass_count;
    }
    // The graphs are worth something: in many of them something was left out.
    assert_true(shared > 300);
    free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_graphs_pass_on_the_right_data),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
