// SPDX-License-Identifier: MIT
#ifndef FG_GRAPH_H
#define FG_GRAPH_H

#include <fg/base.h>
#include <fg/format.h>

FG_BEGIN

// A frame graph is declared in tables, compiled once, then run every frame:
//
//     fg_graph *g = fg_graph_create(&(fg_graph_desc){ .device = dev, .log = &log });
//     fg_graph_begin(g, &(fg_frame_desc){ .width = 1920, .height = 1080 });
//     fg_res hdr = fg_texture(g, "hdr", &(fg_tex_desc){ .format = FG_RGBA16F });
//     const fg_pass_desc passes[] = {
//         { .name = "sky", .writes = { { hdr } }, .run = run_sky },
//         { .name = "show", .reads = { { hdr } }, .run = run_show, .effect = FG_EFFECT_EXTERNAL },
//     };
//     fg_passes(g, passes, FG_COUNT(passes));
//     if (fg_graph_compile(g) == FG_OK) fg_graph_run(g);      // run again for the next frame
//
// Declaring never fails loudly. A bad descriptor yields the null handle and
// marks the declaration; fg_graph_compile() then returns the first error, and
// every error has gone to the log with the names of pass, resource and rule.
//
// Thread: all calls on one graph come from one thread; for a GL device the one
// that has the context current.
typedef struct fg_graph fg_graph;
typedef struct fg_device fg_device; // fg/device.h

// A resource at one version. A plain value; {0} is the null handle.
//
// fg_texture() and fg_buffer() give the handle of the contents that the first
// write makes; fg_next() names what the following write makes. A pass names in
// `writes` the version it produces and in `reads` the one it sees, so that
// which contents a pass reads never depends on a guess:
//
//     { .name = "clear", .writes = { { hdr } } },
//     { .name = "draw",  .writes = { { fg_next(hdr) } } },     // keeps what clear left
//     { .name = "tone",  .reads  = { { fg_next(hdr) } }, ... },
//
// A version is a name, not memory: all versions of a resource live in one place.
// Passes may be declared in any order, but one that reads version v must be
// declared before a pass that makes v + 1 (else the handle is stale: refused).
// A handle is good for the declaration that made it and until the next
// fg_graph_begin(); later use is refused by name.
typedef struct fg_res {
    uint32_t id;
    uint16_t version; // 1: what the first write makes
    uint16_t epoch;   // the declaration it belongs to
} fg_res;

// The contents after one more write. Null gives null.
FG_API fg_res fg_next(fg_res res);

// ---- resources -------------------------------------------------------------

// Whether a resource outlives the frame, and what its first frame reads.
typedef enum fg_history {
    FG_HISTORY_NONE = 0, // transient: contents and memory end with its last reader
    FG_HISTORY_CLEAR,    // kept one frame; before there is a last frame it reads zeros
    FG_HISTORY_DISCARD,  // kept one frame; before there is one, reading it gives undefined texels:
                         // ask fg_run_history_valid()
} fg_history;

typedef struct fg_tex_desc {
    fg_format format;
    int width, height; // Texels. 0 means the frame's; then `scale_log2` halves it that often.
    int scale_log2;    // Applies to frame-sized textures only, [0, 15]; sizes round up.
    int depth;         // Slices of a 3D texture; 0 means it is not 3D.
    int layers;        // Array layers; 0 means it is not an array. Cubes: a multiple of 6.
    int mips;          // 0 means 1; FG_MIPS_ALL the full chain.
    int samples;       // 0 means 1.
    bool cube;         // 6 layers seen as a cube map, 12 as an array of two, ...
    fg_history history;
} fg_tex_desc;

enum { FG_MIPS_ALL = -1 };

typedef struct fg_buf_desc {
    uint64_t size; // Bytes, > 0.
    fg_history history;
} fg_buf_desc;

// `desc` is read during the call; `name` is unique in the declaration and copied.
// Subresources that a frame has not written when they are read are cleared to zero;
// a read that meets nothing written at all is refused.
FG_API fg_res fg_texture(fg_graph *g, const char *name, const fg_tex_desc *desc);
FG_API fg_res fg_buffer(fg_graph *g, const char *name, const fg_buf_desc *desc);

// A resource that the caller owns; `object` is the device's name for it (a GL
// name), not 0, and stays valid while the graph runs. It arrives written: the
// handle can be read at once and fg_next() of it is what a first pass makes.
// Writing to an import is an effect outside: it keeps the pass. Another object in an
// otherwise equal declaration is bound without a compile.
FG_API fg_res fg_import_texture(fg_graph *g, const char *name, const fg_tex_desc *desc,
                                uint32_t object);
FG_API fg_res fg_import_buffer(fg_graph *g, const char *name, const fg_buf_desc *desc,
                               uint32_t object);

// Last frame's final contents of a resource declared with a history policy;
// `res` is any version of it. Reading it keeps the resource's writers. Histories
// are known by name and survive recompiles, culling and declarations that leave
// them out, until fg_graph_trim() or fg_graph_forget(); a new size or format resets them and the
// log says why. What to read is resolved when the frame runs. A frame that fails changes no
// history.
FG_API fg_res fg_last_frame(fg_graph *g, fg_res res);

// Keeps a version beyond the frame: it is not culled, shares no memory, and
// fg_graph_exported() gives its object after fg_graph_run(). How the host will use it the graph
// does not know: what a shader wrote as image or storage needs the host's glMemoryBarrier() first.
FG_API void fg_export(fg_graph *g, fg_res res);

// Begins the names of passes and resources declared from here on, so that one piece of code can be
// declared twice in a frame:
//
//     fg_prefix(g, "b:");
//     declare_technique(other, g);   // passes "b:rsm.map", ..., buffers "b:rsm.vpls", ...
//     fg_prefix(g, "");
//
// "" or NULL ends it, and so does the end of the declaration. Everything shows the longer name:
// messages, dumps, timings, histories, fg_pass_enable(), FG_EFFECT_INTERNAL's groups. What the host
// declared before keeps its name. At most 31 bytes, and no '.', which would make one group of all
// groups.
FG_API void fg_prefix(fg_graph *g, const char *prefix);

// ---- passes ----------------------------------------------------------------

// How a pass touches a resource. DEFAULT: textures are sampled when read; when
// written they are attachments in a raster pass and images in a compute pass;
// buffers are storage buffers.
typedef enum fg_use {
    FG_USE_DEFAULT = 0,
    FG_USE_SAMPLED,
    FG_USE_IMAGE, // image load/store
    FG_USE_COLOR, // attachment; the n-th colour use of `writes` is attachment n
    FG_USE_DEPTH, // attachment; in `reads`: depth test without depth write
    FG_USE_STORAGE,
    FG_USE_UNIFORM,
    FG_USE_VERTEX,
    FG_USE_INDEX,
    FG_USE_INDIRECT,
    FG_USE_COPY,
} fg_use;

// What a write does to the contents that are there.
typedef enum fg_load {
    FG_LOAD_KEEP = 0, // `write`: a partial write. Earlier writers live as long as it does. On
                      // the very first write the graph clears to zero before the pass.
    FG_LOAD_CLEAR,    // `write_all`: the graph clears to `clear` first; earlier writers may go.
    FG_LOAD_DISCARD,  // `write_all`: the pass promises to write every texel it declares.
} fg_load;

// Subresource ranges: 0 counts mean "all from the first on".
typedef struct fg_io {
    fg_res res;
    fg_use use;
    fg_load load;   // writes only
    float clear[4]; // FG_LOAD_CLEAR: rgba, or depth in [0]
    uint8_t mip, mips;
    uint16_t layer, layers;
    bool optional; // reads only: may be the null handle, or of a pass that was left out
} fg_io;

enum { FG_MAX_READS = 20, FG_MAX_WRITES = 8 };

// What a pass does that its writes do not show.
typedef enum fg_effect {
    FG_EFFECT_NONE = 0, // nothing: culled when nobody reads what it writes
    FG_EFFECT_INTERNAL, // it updates state of its own group, the passes whose name shares the text
                        // before the first '.': kept while any of them is
    FG_EFFECT_EXTERNAL, // it shows, saves or sends something: always kept
} fg_effect;

typedef enum fg_kind {
    FG_KIND_RASTER = 0,
    FG_KIND_COMPUTE,
} fg_kind;

typedef struct fg_run fg_run; // what a pass may touch while it runs

// The arrays end at the first null handle that is not `optional`.
typedef struct fg_pass_desc {
    const char *name; // Required, unique. "plugin.step" by convention. Copied.
    fg_kind kind;
    fg_io reads[FG_MAX_READS];
    fg_io writes[FG_MAX_WRITES];
    fg_effect effect;
    uint64_t needs; // Feature bits; where the frame lacks one, the pass is left out. What it was to
                    // change is then read as it was before; what only it makes, optionally or not
                    // at all.
    fg_status (*run)(const fg_run *run, void *user); // Required. A status other than FG_OK ends
                                                     // the frame and comes out of fg_graph_run().
    void *user;                                      // Borrowed while the graph runs.
} fg_pass_desc;

// Appends `count` passes. Order follows from what is read and written, ties
// from the order given.
FG_API void fg_passes(fg_graph *g, const fg_pass_desc *passes, int count);

// Marks the declaration as failed, for code that finds a mistake of its own while
// it declares. The message goes to the log.
FG_API void fg_fail(fg_graph *g, const char *fmt, ...) FG_PRINTF(2, 3);

// Turns a pass off or on from the next fg_graph_run() on, without a recompile.
// While it is off, what it was to make first reads as zeros (or its clear value),
// what it was to change stays as it was. FG_ERR_INVALID: no such pass.
FG_API FG_NODISCARD fg_status fg_pass_enable(fg_graph *g, const char *pass, bool enabled);

// ---- graph -----------------------------------------------------------------

typedef enum fg_debug {
    FG_DEBUG_POISON = 1 << 0,       // fill transients with NaN (integers: 0xcd) before first use
    FG_DEBUG_NO_SHARING = 1 << 1,   // every transient gets its own memory
    FG_DEBUG_RANDOM_ORDER = 1 << 2, // a random legal order, from `seed`
    FG_DEBUG_KEEP_ALL = 1 << 3,     // cull nothing
} fg_debug;

// Called after each pass for each thing it wrote, when set. For tests and
// sanity checks: it may read the object back, which a frame otherwise never does.
typedef struct fg_written {
    const char *pass, *resource;
    const fg_tex_desc *tex; // sizes resolved; NULL for a buffer
    const fg_buf_desc *buf; // NULL for a texture
    uint32_t object;
    int mip, mips, layer, layers; // the range written
} fg_written;

typedef struct fg_graph_desc {
    fg_device *device;      // Required. Borrowed; must outlive the graph.
    const fg_log *log;      // Optional. Borrowed; must outlive the graph.
    fg_allocator allocator; // Zero means malloc.
    unsigned debug;         // fg_debug bits
    uint64_t seed;          // FG_DEBUG_RANDOM_ORDER
    void (*inspect)(void *user, const fg_written *written);
    void *inspect_user;
} fg_graph_desc;

// Returns NULL only when out of memory or without a device (logged).
FG_API fg_graph *fg_graph_create(const fg_graph_desc *desc);

// Accepts NULL. Frees everything declared on the graph, and its device memory.
FG_API void fg_graph_destroy(fg_graph *g);

typedef struct fg_frame_desc {
    int width, height;                // Texels of frame-sized textures. > 0 if there are any.
    uint64_t features;                // What `needs` is held against. 0: nothing special.
    const char *const *feature_names; // Names of the bits, for reasons; optional, borrowed.
    int feature_count;
} fg_frame_desc;

// Starts a declaration; handles of the one before are void from here on. The
// compiled graph stays and runs until another compiles.
FG_API void fg_graph_begin(fg_graph *g, const fg_frame_desc *desc);

// Checks, culls, orders and places. A declaration equal to the compiled one costs
// a comparison, allocates nothing and keeps everything; callbacks, `user` and
// clear values are taken anew either way. On an error the graph compiled before
// stays as it was.
//
// Errors: FG_ERR_INVALID, the first bad declaration or the cycle found;
//         FG_ERR_EMPTY, nothing would run; FG_ERR_MEMORY; FG_ERR_UNSUPPORTED.
FG_API FG_NODISCARD fg_status fg_graph_compile(fg_graph *g);

// Runs the surviving passes in order. Frees nothing and allocates nothing, save
// in the first frame after a compile that changed something.
//
// Errors: what a callback returned; FG_ERR_INVALID: an undeclared access, or not
//         compiled; FG_ERR_MEMORY; FG_ERR_DEVICE. The next call starts afresh.
FG_API FG_NODISCARD fg_status fg_graph_run(fg_graph *g);

// Frees pooled device memory and histories that the compiled graph does not use.
FG_API void fg_graph_trim(fg_graph *g);

// Histories of resources whose names begin with `prefix` begin anew in the next frame, as their
// policies say: for a technique that was created again, a cut. NULL: all histories.
FG_API void fg_graph_forget(fg_graph *g, const char *prefix);

// The object of an exported version after a run; 0 where it was never made.
FG_API uint32_t fg_graph_exported(const fg_graph *g, fg_res res);

// ---- what a pass may ask while it runs ----------------------------------------

// The device's name for what the pass declared: a GL texture or buffer. 0 when an
// optional read is absent. Anything undeclared: 0, and the frame fails with a
// message that names pass and resource. Handles are those of the declaration that
// compiled, or of a later equal one.
FG_API uint32_t fg_run_object(const fg_run *run, fg_res res);

// Size of mip level `mip`; of a buffer: its bytes in [0].
FG_API void fg_run_size(const fg_run *run, fg_res res, int mip, int size[3]);

// Whether last frame's contents exist (false in the first frame, after a reset).
FG_API bool fg_run_history_valid(const fg_run *run, fg_res res);

FG_API fg_device *fg_run_device(const fg_run *run);
FG_API const char *fg_run_pass(const fg_run *run);
FG_API uint64_t fg_run_frame(const fg_run *run); // counts fg_graph_run() calls from 0

// ---- looking at it -------------------------------------------------------------

typedef struct fg_graph_stats {
    int declared, kept, left_out; // passes
    int compiles;                 // declarations that were not equal to the one before
    uint64_t transient_bytes;     // device memory of transients as placed
    uint64_t unshared_bytes;      // the same with sharing off
    uint64_t live_bytes;          // the largest sum of bytes alive at once: the lower bound
    uint64_t persistent_bytes;    // histories and exports
    uint64_t pool_bytes;          // all device memory that the graph holds now
} fg_graph_stats;

FG_API fg_graph_stats fg_graph_get_stats(const fg_graph *g);

// Passes of the compiled graph in the order of execution, and those left out in
// the order of declaration. NULL past the end. Valid until the next compile.
FG_API const char *fg_graph_pass(const fg_graph *g, int i);
FG_API const char *fg_graph_left_out(const fg_graph *g, int i, const char **why);

typedef struct fg_timing {
    const char *pass;
    double gpu_ms;       // of a frame some frames ago; negative while none has come back
    double cpu_ms;       // last frame: the callback, and what the device does around it; 0 on a
                         // device that times nothing
    uint64_t frame;      // the frame that gpu_ms is of
    double gpu_start_ms; // since the first pass of that frame began
    double cpu_start_ms; // since fg_graph_run() was entered
} fg_timing;

// Timing of pass i in order of execution; false past the end.
FG_API bool fg_graph_timing(const fg_graph *g, int i, fg_timing *out);

typedef enum fg_dump {
    FG_DUMP_TEXT = 0, // passes in order, accesses, lifetimes, memory, what was left out and why
    FG_DUMP_DOT,      // Graphviz
    FG_DUMP_JSON,
    FG_DUMP_TRACE, // the last frame's timings as Chrome trace events; fg/trace.h is for many frames
} fg_dump;

// The compiled graph as text, owned by the caller: free it with fg_dump_free().
// NULL when out of memory or not compiled.
FG_API char *fg_graph_dump(const fg_graph *g, fg_dump format);
FG_API void fg_dump_free(const fg_graph *g, char *text);

FG_END

#endif // FG_GRAPH_H
