// SPDX-License-Identifier: MIT
#ifndef FG_GL_H
#define FG_GL_H

#include <fg/device.h>

FG_BEGIN

// OpenGL 4.5 core: a headless context, the gl device, programs.
//
//     fg_gl_context *ctx;
//     fg_device *dev;
//     fg_gl_context_create(&(fg_gl_context_desc){ .log = &log }, &ctx);
//     fg_gl_device_create(&(fg_gl_device_desc){ .log = &log }, &dev);
//     ... fg_graph_create(&(fg_graph_desc){ .device = dev }) ...
//     fg_device_destroy(dev);
//     fg_gl_context_destroy(ctx);
//
// A host with a context of its own needs only the device. GL entry points come
// from libepoxy; callbacks may include <epoxy/gl.h>.
//
// Thread: every call that takes a device comes from the thread that has its context
// current; a context is current in one thread at a time.

// ---- headless context ---------------------------------------------------------

typedef struct fg_gl_context fg_gl_context;

typedef struct fg_gl_context_desc {
    const fg_log *log;
    int device; // 0: the first that works, real GPUs first; n > 0: the n-th of fg_gl_device_info()
    bool debug; // a debug context
} fg_gl_context_desc;

// Creates an EGL context without a surface and makes it current.
// Errors: FG_ERR_UNSUPPORTED, no EGL device gives OpenGL 4.5 core; FG_ERR_INVALID, no such device.
FG_API FG_NODISCARD fg_status fg_gl_context_create(const fg_gl_context_desc *desc,
                                                   fg_gl_context **out);
FG_API void fg_gl_context_destroy(fg_gl_context *ctx); // accepts NULL
FG_API FG_NODISCARD fg_status fg_gl_context_make_current(fg_gl_context *ctx);

// Describes EGL device n (from 1): renderer and version if a context can be had.
// false past the end. Strings are cut to fit. What is current stays current.
typedef struct fg_gl_device_info {
    char name[128];     // EGL's name: driver, DRM node or "surfaceless"
    char renderer[128]; // "" if it gives no OpenGL 4.5 core
    char version[128];
    bool software;
} fg_gl_device_info;
FG_API bool fg_gl_get_device_info(int n, fg_gl_device_info *info);

// ---- device -----------------------------------------------------------------------

typedef struct fg_gl_device_desc {
    const fg_log *log;
    const char *shader_dir; // Development: read shaders below this folder (by the names they were
                            // embedded under) and rebuild on change. One that is not there is the
                            // embedded one, with a warning. NULL: the embedded ones.
    const char *cache_dir;  // Program binaries, where the driver has them. NULL: none.
    bool timestamps;        // Time passes by GL timestamps on a software renderer too.
} fg_gl_device_desc;

// For the context that is current. If that is a debug context, driver messages go
// to the log; a callback that the host has set is put back when the device goes.
//
// What a callback finds, whatever ran before it:
//   program 0; a vertex array without attributes bound; a debug group named as the pass;
//   in raster passes besides: the framebuffer of what it writes, with a viewport over it;
//   depth test on, GREATER_OR_EQUAL (reversed: 1 is near, 0 far), depth writes on unless
//   depth is only read; depth range [0, 1]; glClipControl(LOWER_LEFT, ZERO_TO_ONE); no culling,
//   front faces counter-clockwise; blending, scissor, stencil, polygon offset, depth clamp, logic
//   operation, primitive restart, sample masks, clip distances, smoothing and dithering off;
//   polygons filled; all colour channels and all bits of the stencil written; flat attributes from
//   the last vertex; GL_FRAMEBUFFER_SRGB on.
//   A raster pass that writes no texture gets framebuffer 0, GL_FRAMEBUFFER_SRGB off, and
//   the viewport as it was: it shows something, and sets these itself.
// Cube maps are seamless, and pixels are unpacked as in a new context, from memory. Bindings of
// textures, samplers, images and buffers are not reset: a pass binds all that its shaders name.
//
// What a host finds after fg_graph_run(), whatever it had set before:
//   as in a new context: all that is named above, down to the depth test (off), clip control and
//   GL_FRAMEBUFFER_SRGB (off), stencil and blend functions, point size, pixel unpacking;
//   framebuffer, program and vertex array are 0;
//   left as the last pass had it: the viewport; what is bound to the units and binding points of
//   textures, samplers, images, shader storage and uniform buffers; the buffers bound for indirect
//   draws and dispatches and for query results; GL_TEXTURE_CUBE_MAP_SEAMLESS is on.
// All else is neither asked for nor touched: scissor box, clear values, blend colour, line width,
// pixel packing, the active unit, renderbuffers, other buffers, hints. Nor is anything changed by
// the calls around a frame, which create, update and declare, but by ag_*_destroy() and the like as
// OpenGL has it: what is deleted is unbound.
//
// Clears: an sRGB texture takes linear values; a buffer is filled with `value`[0] as 32 bits,
// 3D textures are cleared in all slices. Poison in depth formats is 0xcdcd / 0xffff, about
// 0.8: drivers do not keep a NaN there.
//
// Timings belong to one graph at a time: where several share a device, the one that
// compiled last resets them.
//
// Errors: FG_ERR_UNSUPPORTED without OpenGL 4.5; FG_ERR_MEMORY.
FG_API FG_NODISCARD fg_status fg_gl_device_create(const fg_gl_device_desc *desc, fg_device **out);

// Framebuffers are kept by the names of what they hold. Call this before deleting a texture
// that a graph imported, or a new texture of the same name would not be drawn to.
FG_API void fg_gl_forget_texture(fg_device *dev, uint32_t object);

// GL errors and high-severity messages seen since creation. Tests demand 0. Sees every
// error in a debug context; in others only what is pending when something is allocated. A
// shader that does not compile, and an allocation refused for want of memory, are statuses
// and not counted.
FG_API int fg_gl_error_count(const fg_device *dev);
FG_API const char *fg_gl_renderer(const fg_device *dev);
FG_API const char *fg_gl_version(const fg_device *dev);

// Whether the renderer runs on the CPU (llvmpipe, softpipe). Then a pass's gpu_ms is the time
// between a glFinish() at either end of it, since such drivers' timestamps leave compute out;
// fg_gl_device_desc.timestamps says otherwise.
FG_API bool fg_gl_software(const fg_device *dev);

// Waits for the GPU (benchmarks, captures; never in a frame), so that the timings
// of the last frame are there. FG_ERR_DEVICE if the context is lost.
FG_API FG_NODISCARD fg_status fg_gl_finish(fg_device *dev);

// ---- programs -----------------------------------------------------------------------

// A shader as embedded by the build: static, shared by address; in place as long as the device.
typedef struct fg_gl_shader {
    const char *name; // path in the source tree, e.g. "passes/gbuffer/gbuffer.vert"; the extension
                      // is the stage
    const char *text; // includes expanded; first line "#version 450 core"
} fg_gl_shader;

typedef struct fg_gl_program_desc {
    const fg_gl_shader *shaders[3]; // ends at NULL: {comp}, {vert, frag} or {vert, geom, frag}
    const char *defines;            // "SHADOWS=1;LIGHTS=4": inserted after #version. NULL: none.
} fg_gl_program_desc;

// The program of this permutation, built on first use and then looked up without
// allocation; 0 if it does not build, and, once, a log line with shader, defines and the
// driver's message. The device owns it. With a shader_dir its files are looked at in each
// call; while a changed source does not build, the last good program is what it gives.
FG_API uint32_t fg_gl_program(fg_device *dev, const fg_gl_program_desc *desc);

// ---- helpers for callbacks ------------------------------------------------------------

// All clamp to the edge. Integer textures take NEAREST alone.
typedef enum fg_gl_filter {
    FG_GL_NEAREST = 0,   // of mip 0; texelFetch() reaches the others
    FG_GL_LINEAR,        // of mip 0
    FG_GL_LINEAR_MIPMAP, // trilinear; textureLod() at a whole level is that level alone
    FG_GL_SHADOW,        // of mip 0, for sampler2DShadow and its kin: linear, compare
                         // GREATER_OR_EQUAL (reversed depth): 1 where lit
} fg_gl_filter;

// Bind what the pass declared; fg_run_object() refuses the rest. An optional read that is
// absent unbinds the unit.
FG_API void fg_gl_sample(const fg_run *run, int unit, fg_res tex, fg_gl_filter filter);
// `access` is GL_READ_ONLY, GL_WRITE_ONLY or GL_READ_WRITE. Arrays, cubes and 3D textures are
// bound with all their layers.
FG_API void fg_gl_image(const fg_run *run, int unit, fg_res tex, int mip, unsigned access,
                        fg_format format);
FG_API void fg_gl_storage(const fg_run *run, int binding, fg_res buf);
FG_API void fg_gl_uniform(const fg_run *run, int binding, fg_res buf);

// glDispatchCompute over `width` x `height` in groups of `group_x` x `group_y`, rounded up.
FG_API void fg_gl_dispatch_2d(int width, int height, int group_x, int group_y);
// A triangle over the viewport without vertex buffers (gl_VertexID 0..2).
FG_API void fg_gl_fullscreen(const fg_run *run);

FG_END

#endif // FG_GL_H
