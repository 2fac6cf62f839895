// SPDX-License-Identifier: MIT
#ifndef FG_GRAPH_PRIV_H
#define FG_GRAPH_PRIV_H

// The graph from the inside. The way of a declaration:
//
//   declare.c   copies descriptors into a `decl`: flat arrays of canonical records
//   compile.c   compares it with the compiled one; if it differs builds a new `plan`:
//   check.c       names, versions, uses; indexes who makes which version
//   order.c       an order of all passes that obeys reads and writes
//   cull.c        which of them run
//   place.c       lifetimes, memory slots
//   barrier.c     clears and barriers
//   bind.c      gives slots device objects, in the first run of a plan
//   execute.c   runs it
//
// Records in a `decl` have no padding and hold resolved values only, so that two
// declarations are equal when their bytes are.

#include <fg/device.h>
#include <fg/graph.h>
#include <stdarg.h>

#define NONE UINT32_MAX

// fg_res.version of what fg_last_frame() gives.
enum { VERSION_LAST = UINT16_MAX };

// ---- host memory ------------------------------------------------------------------

// Grows `*array` to hold `need` elements of `size` bytes. What is there stays.
bool fg_grow(const fg_allocator *a, void **array, uint32_t *cap, uint64_t need, size_t size);
void *fg_alloc(const fg_allocator *a, size_t size);
void fg_release(const fg_allocator *a, void *ptr);
uint32_t fg_hash(const void *bytes, size_t size);
int64_t fg_now_ns(void); // CLOCK_MONOTONIC

#define GROW(g, array, cap, need)                                                                  \
    ((uint64_t) (need) <= (cap) ||                                                                 \
     fg_grow(&(g)->allocator, (void **) &(array), &(cap), (need), sizeof *(array)))

// ---- declaration --------------------------------------------------------------------

enum {
    RES_TEXTURE = 1,
    RES_CUBE = 2,
    RES_EXPORT = 4,
};

typedef struct res_rec {
    uint64_t bytes;  // device memory; of a buffer its size
    uint32_t name;   // offset into decl.text
    uint32_t import; // index into decl.import, or NONE
    int32_t width, height;
    uint16_t depth, layers;
    uint8_t mips, samples, format;
    uint8_t flags : 4, history : 4;
} res_rec;
_Static_assert(sizeof(res_rec) == 32, "no padding");

enum {
    IO_WRITE = 1,
    IO_OPTIONAL = 2,
    IO_CLEAR = 4,
    IO_DISCARD = 8,
    IO_LAST = 16,  // reads last frame's contents
    IO_WHOLE = 32, // every subresource
};

typedef struct io_rec {
    uint32_t res; // index
    uint16_t version;
    uint8_t use; // resolved: never FG_USE_DEFAULT
    uint8_t flags;
    uint8_t mip, mips;
    uint16_t layer, layers, zero;
} io_rec;
_Static_assert(sizeof(io_rec) == 16, "no padding");

enum { PASS_ABSENT = 1 }; // an optional read was the null handle

typedef struct pass_rec {
    uint64_t needs;
    uint32_t name, io;
    uint32_t reason; // left out: offset of the reason in decl.text, else 0
    uint32_t clear;  // first of its values in decl.clear
    uint8_t reads, writes, kind, effect;
    uint32_t flags;
} pass_rec;
_Static_assert(sizeof(pass_rec) == 32, "no padding");

typedef struct callback {
    fg_status (*run)(const fg_run *run, void *user);
    void *user;
} callback;

typedef struct clear_value {
    float rgba[4];
} clear_value;

typedef struct export_rec {
    uint32_t res, version;
} export_rec;

typedef struct decl {
    // The key.
    res_rec *res;
    pass_rec *pass;
    io_rec *io;
    export_rec *exports;
    char *text; // names and reasons, NUL-terminated; [0] is ""
    uint32_t res_count, pass_count, io_count, export_count, text_count;

    // Taken anew from an equal declaration.
    callback *callback; // per pass
    clear_value *clear; // per write with FG_LOAD_CLEAR, in order
    uint32_t *import;   // objects
    uint32_t clear_count, import_count;

    uint32_t res_cap, pass_cap, io_cap, export_cap, text_cap, callback_cap, clear_cap, import_cap;
    int width, height;
    fg_status status; // first mistake
} decl;

// ---- plan -------------------------------------------------------------------------------

// Who makes a version. Version v of resource r is plan.version[plan.res[r].version + v - 1].
typedef struct version_rec {
    uint32_t pass; // NONE: the import, as it arrived
    uint32_t io;   // first write of it; others of the pass follow
} version_rec;

typedef struct res_plan {
    uint32_t version;     // offset into plan.version
    uint32_t versions;    // how many there are
    uint32_t first, last; // positions of its first and last use; NONE: unused
    uint32_t slot;        // index into plan.slot, NONE if it is not live; a history's other
                          // object is slot + 1
    uint32_t written;     // offset into plan.written
    union {
        uint32_t object;  // bound object
        uint32_t writes;  // while checking: how many
        uint32_t last_io; // while placing: its last access
    };
    uint32_t last_object; // of last frame, for histories
} res_plan;

typedef enum slot_kind {
    SLOT_SHARED = 0,
    SLOT_EXPORT,
    SLOT_IMPORT,
    SLOT_HISTORY,
} slot_kind;

typedef struct slot_rec {
    uint32_t res;   // the first one in it: format and label
    uint32_t group; // index into plan.group
    uint32_t subs;  // offset into plan.sub
    uint32_t next;  // free list while placing
    uint8_t kind;
    bool incoherent; // holds something that images or storage buffers write
    uint32_t pool;   // index into graph.pool, when bound
} slot_rec;

// What resources must have in common to share memory.
typedef struct group_key {
    uint64_t size;
    int32_t width, height, depth;
    uint16_t layers;
    uint8_t mips, samples;
    uint16_t view_class; // or 0x8000 | format
    uint8_t cube, texture;
    uint32_t zero;
} group_key;
_Static_assert(sizeof(group_key) == 32, "no padding");

typedef struct group_rec {
    group_key key;
    uint32_t hash; // of the key
    uint32_t free; // first free slot
} group_rec;

// Positions in time, see barrier.c.
typedef struct sub_state {
    uint32_t write; // last incoherent write
    uint32_t touch; // last access of any kind
} sub_state;

enum {
    CLEAR_IF_ON = 1,  // when the pass is enabled
    CLEAR_IF_OFF = 2, // when it is not
    CLEAR_POISON = 4,
};

typedef struct clear_rec {
    uint32_t res;
    uint32_t value; // index into decl.clear; NONE: zero
    uint16_t layer, layers;
    uint8_t mip, mips;
    uint8_t flags;
} clear_rec;

typedef struct step_rec {
    uint32_t pass;
    uint32_t clear;      // first clear; they end at the next step's
    uint16_t clear_bits; // barrier before the clears
    uint16_t bits;       // barrier before the pass
    uint16_t clears;     // nonzero: something is cleared when the pass is on
    uint16_t off;        // nonzero: the pass is off
} step_rec;

typedef struct plan {
    res_plan *res;
    version_rec *version;
    uint32_t *order;   // all passes in a legal order
    uint32_t *step_of; // pass -> step, NONE if it does not run
    step_rec *step;    // two more than step_count: the end of the frame, and of its clears
    slot_rec *slot;
    group_rec *group;
    sub_state *sub;
    clear_rec *clear;
    uint8_t *written; // per subresource of resources with more than one
    uint8_t *absent;  // per io: an optional read of something left out
    uint32_t step_count, slot_count, group_count, sub_count, clear_count, written_count;
    uint32_t res_cap, version_cap, order_cap, step_of_cap, step_cap, slot_cap, group_cap, sub_cap,
        clear_cap, written_cap, absent_cap;

    bool incoherent; // there are incoherent writes
    fg_graph_stats stats;
    char **why; // per pass, made when asked for
    uint32_t why_cap;
} plan;

// ---- device memory ----------------------------------------------------------------------

typedef struct pool_view {
    uint32_t pool, format, object;
    uint32_t next; // of the same pool entry, + 1
} pool_view;

typedef struct pool_rec {
    group_key key;
    uint64_t bytes;
    uint32_t hash; // of the key
    uint32_t object, format;
    uint32_t view; // first of its views, + 1
    uint32_t idle; // compiles since it was last in use
    uint32_t next; // of the same hash, while binding
    bool used;
} pool_rec;

typedef struct history_rec {
    char *name;
    group_key key;
    uint64_t bytes;
    uint32_t object[2]; // 0: none
    uint32_t format;
    uint32_t res; // in the compiled graph, or NONE
    int current;  // what this frame writes
    bool valid;
} history_rec;

// ---- graph ------------------------------------------------------------------------------

typedef struct step_time { // ns of CLOCK_MONOTONIC
    int64_t begin, end;
} step_time;

struct fg_graph {
    fg_device *device;
    const fg_device_limits *limits; // asked once
    const fg_log *log;
    fg_allocator allocator;
    unsigned debug;
    uint64_t seed;
    void (*inspect)(void *user, const fg_written *written);
    void *inspect_user;

    decl *open, *built; // being declared; compiled
    plan *next, *plan;  // likewise
    decl decls[2];
    plan plans[2];

    char prefix[32]; // of names in the open declaration
    uint32_t prefix_length;
    char *name; // scratch: a name with its prefix
    uint32_t name_cap;

    bool declaring, running, compiled;
    bool disturbed;        // something was declared while it ran
    bool bound;            // the plan has its objects
    bool ran;              // since the compile
    bool swap_due;         // the last frame succeeded
    bool after_incoherent; // the plan before had incoherent writes
    fg_tex_desc last_desc; // of the last texture declared, where last_known
    res_rec last_rec;
    bool last_known;
    uint64_t features;
    const char *const *feature_names;
    int feature_count;

    uint64_t epoch;                         // of the open declaration
    uint64_t epoch_built;                   // of the one that compiled
    uint64_t epoch_equal, epoch_equal_last; // later equal ones
    uint64_t frame;
    int compiles;
    int pool_width, pool_height;

    uint32_t *table; // scratch: names with their hashes, then groups, then others
    uint32_t *stack;
    uint32_t *last, *seen; // per subresource, per access: see cull.c
    uint32_t table_cap, stack_cap, last_cap, seen_cap;
    uint64_t work;          // steps of the loops of the last compile
    uint32_t missing;       // while checking: versions without a pass
    uint32_t most_versions; // of a resource

    pool_rec *pool;
    pool_view *view;
    history_rec *history;
    uint32_t pool_count, view_count, history_count;
    uint32_t pool_cap, view_cap, history_cap;

    step_time *time;
    uint32_t time_cap, time_count;
    int64_t run_begin, run_end; // of the last fg_graph_run(); 0 where the device times nothing

    char **off; // names of disabled passes
    uint32_t off_count, off_cap;
};

struct fg_run {
    fg_graph *graph;
    uint32_t pass, step;
    fg_status status; // of accesses
};

extern const fg_format_info fg_formats[FG_FORMAT_COUNT];

static inline const char *res_name(const decl *d, uint32_t res)
{
    return d->text + d->res[res].name;
}

static inline const char *pass_name(const decl *d, uint32_t pass)
{
    return d->text + d->pass[pass].name;
}

// Slices of a 3D texture are one subresource.
static inline uint32_t sub_layers(const res_rec *r)
{
    return r->layers ? r->layers : 1;
}

static inline uint32_t sub_count(const res_rec *r)
{
    return r->mips * sub_layers(r);
}

// Past the last access of a pass.
static inline uint32_t io_end(const pass_rec *p)
{
    return p->io + p->reads + p->writes;
}

// A write of a shader to an image or a storage buffer.
static inline bool io_incoherent(const io_rec *io)
{
    return (io->flags & IO_WRITE) && (io->use == FG_USE_IMAGE || io->use == FG_USE_STORAGE);
}

static inline bool io_overlap(const io_rec *a, const io_rec *b)
{
    return a->mip < b->mip + b->mips && b->mip < a->mip + a->mips &&
           a->layer < b->layer + b->layers && b->layer < a->layer + a->layers;
}

#define REFUSE(...)                                                                                \
    do {                                                                                           \
        fg_decl_fail(g, FG_ERR_INVALID, __VA_ARGS__);                                              \
        return false;                                                                              \
    } while (0)

// Marks the open declaration with its first mistake and logs it.
void fg_decl_fail(fg_graph *g, fg_status status, const char *fmt, ...) FG_PRINTF(3, 4);
// Logs a call that is not allowed now; the declaration takes no harm. FG_ERR_INVALID.
fg_status fg_misuse(fg_graph *g, const char *call, const char *rule);
// `name` behind the prefix of the open declaration, until the next call; `name` itself without one.
const char *fg_decl_name(fg_graph *g, const char *name);
// Appends a string to the text of the open declaration; 0 when out of memory.
uint32_t fg_decl_text(fg_graph *g, const char *text, size_t length);
void fg_decl_reset(decl *d);
bool fg_decl_equal(const decl *a, const decl *b);
void fg_decl_free(const fg_allocator *a, decl *d);
void fg_plan_free(const fg_allocator *a, plan *p);
fg_tex_desc fg_tex_desc_of(const res_rec *r);
group_key fg_group_of(const res_rec *r);
// A string of words such as "mip 2, layers 3..5" for messages.
const char *fg_range_text(char *buf, size_t size, const res_rec *r, const io_rec *io);
const char *fg_use_name(unsigned use);

// The stages of a compile; each logs what it refuses. fg_check() leaves the declared order in
// plan.order and says whether it is legal.
fg_status fg_check(fg_graph *g, bool *in_order);
void fg_check_uses(fg_graph *g, uint32_t pass);
fg_status fg_order(fg_graph *g, bool in_order);
fg_status fg_cull(fg_graph *g);
fg_status fg_place(fg_graph *g);
fg_status fg_barriers(fg_graph *g);

// Why a pass of the compiled graph does not run (reason.c).
const char *fg_reason(const fg_graph *g, uint32_t pass);

// Whether the handle of an open or compiled declaration belongs to the compiled one.
bool fg_epoch_built(const fg_graph *g, uint16_t epoch);

// Device objects of the compiled graph (bind.c, history.c).
fg_status fg_bind(fg_graph *g);
void fg_bind_imports(fg_graph *g);
void fg_bind_free(fg_graph *g);
uint64_t fg_pool_bytes(const fg_graph *g);
fg_status fg_history_bind(fg_graph *g);
void fg_history_swap(fg_graph *g); // between a frame that succeeded and the next
void fg_history_trim(fg_graph *g, bool all);
bool fg_history_is_valid(const fg_graph *g, uint32_t res);
fg_status fg_object_create(fg_graph *g, uint32_t res, uint32_t *object);
void fg_object_destroy(fg_graph *g, bool texture, uint32_t object);
// A clear of a whole object.
fg_clear fg_whole_clear(const res_rec *r, const fg_tex_desc *tex, uint32_t object);

#endif // FG_GRAPH_PRIV_H
