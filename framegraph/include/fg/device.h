// SPDX-License-Identifier: MIT
#ifndef FG_DEVICE_H
#define FG_DEVICE_H

#include <fg/format.h>
#include <fg/graph.h>

FG_BEGIN

// What a graph asks of a graphics API. Two devices stand: `null` (below; records
// calls, needs no GPU) and `gl` (fg/gl.h). A host can bring its own: fill the
// table and put a fg_device first in its own struct.

// Consumers that a memory barrier must serve; the gl device maps them to
// glMemoryBarrier bits.
typedef enum fg_barrier {
    FG_BARRIER_SAMPLED = 1 << 0,    // TEXTURE_FETCH
    FG_BARRIER_IMAGE = 1 << 1,      // SHADER_IMAGE_ACCESS
    FG_BARRIER_ATTACHMENT = 1 << 2, // FRAMEBUFFER
    FG_BARRIER_STORAGE = 1 << 3,    // SHADER_STORAGE
    FG_BARRIER_UNIFORM = 1 << 4,
    FG_BARRIER_VERTEX = 1 << 5,
    FG_BARRIER_INDEX = 1 << 6,
    FG_BARRIER_INDIRECT = 1 << 7, // COMMAND
    FG_BARRIER_COPY = 1 << 8,     // TEXTURE_UPDATE | BUFFER_UPDATE | PIXEL_BUFFER
} fg_barrier;

typedef struct fg_attachment {
    uint32_t object;        // 0: unused
    int mip, layer, layers; // of a 3D texture, slices
    bool layered;           // all layers, faces or slices; else `layer` alone, of an array, a cube
                            // or a 3D texture
} fg_attachment;

// Entries of `color` from color_count on and a `depth` without object are not set.
typedef struct fg_pass_begin {
    const char *name; // debug group and timer
    int timer;        // index in [0, timer count) given by the graph, see begin_frame
    fg_kind kind;
    fg_attachment color[FG_MAX_WRITES];
    int color_count;
    fg_attachment depth;
    bool depth_read_only;
    int width, height;        // viewport; 0 in a pass without attachments
    uint64_t framebuffer_key; // equal keys mean equal attachments: what a device caches by
} fg_pass_begin;

// One clear before a pass, or poison.
typedef struct fg_clear {
    uint32_t object;
    const fg_tex_desc *tex; // NULL: a buffer
    uint64_t size;          // bytes of a buffer
    int mip, mips;          // levels
    int layer, layers;      // array layers or cube faces; a 3D texture is cleared in its full depth
                            // and says layer 0, layers 1
    float value[4];         // rgba, or depth in [0]
    bool poison;            // NaN in float formats, 0xcd bytes elsewhere; `value` is ignored
} fg_clear;

typedef struct fg_device_limits {
    int max_color_attachments;
    int max_texture_size, max_3d_size, max_layers, max_samples;
    uint64_t max_buffer_bytes;
} fg_device_limits;

// All entries are required unless said otherwise. Objects are nonzero.
typedef struct fg_device_ops {
    const char *name;
    const fg_device_limits *(*limits)(fg_device *dev);

    // `desc` is resolved: width, height, mips and samples are never 0, scale_log2 is, a cube map
    // has its layers (6, 12, ...). depth 0 still means not 3D, layers 0 not an array.
    // FG_ERR_MEMORY when the API says so.
    fg_status (*texture_create)(fg_device *dev, const char *label, const fg_tex_desc *desc,
                                uint32_t *object);
    // A second texture over the memory of `of`, of the same size and shape and of a
    // format of the same view class. Destroyed like a texture, before or after `of`.
    fg_status (*view_create)(fg_device *dev, const char *label, uint32_t of,
                             const fg_tex_desc *desc, uint32_t *object);
    fg_status (*buffer_create)(fg_device *dev, const char *label, uint64_t size, uint32_t *object);
    void (*texture_destroy)(fg_device *dev, uint32_t object);
    void (*buffer_destroy)(fg_device *dev, uint32_t object);

    // Brackets fg_graph_run(). `timers` passes will be timed.
    fg_status (*frame_begin)(fg_device *dev, uint64_t frame, int timers);
    fg_status (*frame_end)(fg_device *dev);

    void (*barrier)(fg_device *dev, unsigned bits); // fg_barrier bits, never 0
    void (*clear)(fg_device *dev, const fg_clear *clear);
    fg_status (*pass_begin)(fg_device *dev, const fg_pass_begin *begin);
    void (*pass_end)(fg_device *dev, const fg_pass_begin *begin);

    // Start and duration of timer `timer` in the newest frame whose results have come
    // back; false while none has. Never waits. NULL: nobody times passes on this device, and the
    // graph does not read the CPU's clock around them either.
    bool (*timing)(fg_device *dev, int timer, double *start_ms, double *ms, uint64_t *frame);

    // Forgets framebuffers and timers of the graph that is going or has recompiled.
    void (*reset)(fg_device *dev);
    void (*destroy)(fg_device *dev);

    // Begin and end of a timer in one of the last frames, ns of CLOCK_MONOTONIC: as far as a device
    // has a clock of its own, it was set when the device was created. false where the frame has not
    // come back yet, was not timed or is too long ago. Never waits. Optional.
    bool (*time_of)(fg_device *dev, int timer, uint64_t frame, int64_t *begin, int64_t *end);
} fg_device_ops;

struct fg_device {
    const fg_device_ops *ops;
};

// Accepts NULL.
FG_API void fg_device_destroy(fg_device *dev);

// ---- the null device ------------------------------------------------------------

// Does nothing and writes down what it was asked, a line a call, e.g.
// "texture hdr RGBA16F 64x64 -> 1", "barrier sampled|image", "pass sky 64x64 color 1",
// so that a test can compare a whole frame with a text. Passes are timed (on the CPU) only
// where it records.
typedef struct fg_null_desc {
    bool record;             // keep the lines; off for benchmarks
    int fail_at;             // > 0: the n-th creating call fails with FG_ERR_MEMORY
    fg_device_limits limits; // zeros mean the floor of OpenGL 4.5 (16384, 8 attachments, ...)
} fg_null_desc;

// NULL when out of memory.
FG_API fg_device *fg_null_create(const fg_null_desc *desc);
FG_API const char *fg_null_log(const fg_device *dev); // lines so far; "" if none
FG_API void fg_null_clear_log(fg_device *dev);
FG_API int fg_null_live_objects(const fg_device *dev);
FG_API uint64_t fg_null_live_bytes(const fg_device *dev);

FG_END

#endif // FG_DEVICE_H
