// SPDX-License-Identifier: MIT
#include "gl_priv.h"

#include <epoxy/egl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- messages and errors --------------------------------------------------------

static fg_log_level message_level(GLenum source, GLenum type, GLenum severity)
{
    if (source == GL_DEBUG_SOURCE_SHADER_COMPILER && type == GL_DEBUG_TYPE_ERROR)
        return FG_LOG_DEBUG; // no GL error: program.c says it with the names of shader and defines
    if (type == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH)
        return FG_LOG_ERROR;
    if (type == GL_DEBUG_TYPE_PERFORMANCE)
        return FG_LOG_INFO; // a read back that waits is medium to some drivers, and meant
    return severity == GL_DEBUG_SEVERITY_MEDIUM ? FG_LOG_WARN : FG_LOG_DEBUG;
}

// NOLINTNEXTLINE(readability-function-size): the parameters are OpenGL's
static void APIENTRY on_message(GLenum source, GLenum type, GLuint id, GLenum severity,
                                GLsizei length, const GLchar *message, const void *user)
{
    gl_device *d = (gl_device *) user;
    fg_log_level level = message_level(source, type, severity);

    while (length > 0 && (message[length - 1] == '\n' || message[length - 1] == '\0'))
        --length; // some drivers end with a line break
    if (type == GL_DEBUG_TYPE_ERROR && source == GL_DEBUG_SOURCE_API)
        ++d->heard;
    if (type == GL_DEBUG_TYPE_ERROR && d->allocating)
        level = FG_LOG_WARN; // gl_drain_errors() knows what kind of error it is, and counts
    if (level == FG_LOG_ERROR)
        ++d->errors;
    fg_logf(d->log, level, "gl: %.*s (message %u)", (int) length, message, id);
}

static const char *error_name(GLenum error)
{
    switch (error) {
    case GL_INVALID_ENUM: return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE: return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION: return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION: return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY: return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST: return "GL_CONTEXT_LOST";
    default: return "an unknown GL error";
    }
}

bool gl_drain_errors(gl_device *d)
{
    bool no_memory = false;
    // A lost context may answer with the same error for ever.
    for (int i = 0; i < 16; ++i) {
        const GLenum error = glGetError();
        if (error == GL_NO_ERROR)
            break;
        if (error == GL_OUT_OF_MEMORY && d->allocating) {
            no_memory = true;
            continue;
        }
        if (d->heard > 0 && !d->allocating)
            continue; // logged and counted when it came
        ++d->errors;
        fg_logf(d->log, FG_LOG_ERROR, "gl: %s", error_name(error));
    }
    d->heard = 0;
    return no_memory;
}

void gl_label(const gl_device *d, GLenum kind, GLuint object, const char *label)
{
    const size_t length = strlen(label), max = (size_t) d->max_label - 1;
    glObjectLabel(kind, object, (GLsizei) (length < max ? length : max), label);
}

static void listen(gl_device *d)
{
    GLint flags = 0;
    glGetIntegerv(GL_CONTEXT_FLAGS, &flags);
    d->debug = (flags & GL_CONTEXT_FLAG_DEBUG_BIT) != 0;
    if (!d->debug)
        return;
    glGetPointerv(GL_DEBUG_CALLBACK_FUNCTION, (void **) &d->host_callback);
    glGetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &d->host_user);
    d->host_synchronous = glIsEnabled(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS); // counts must be right when a call returns
    glDebugMessageCallback(on_message, d);
    // Groups and notes on placement would drown the rest.
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, NULL,
                          GL_FALSE);
}

static void stop_listening(const gl_device *d)
{
    if (!d->debug)
        return;
    glDebugMessageCallback(d->host_callback, d->host_user);
    if (!d->host_synchronous)
        glDisable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
}

// ---- the frame ------------------------------------------------------------------

static const fg_device_limits *limits(fg_device *dev)
{
    return &((gl_device *) dev)->limits;
}

static void close_group(gl_device *d)
{
    if (d->in_pass)
        glPopDebugGroup();
    d->in_pass = false;
}

static fg_status check_lost(gl_device *d)
{
    if (!d->lost) {
        const GLenum status = glGetGraphicsResetStatus();
        d->lost = status != GL_NO_ERROR;
        if (d->lost)
            fg_logf(d->log, FG_LOG_ERROR, "gl device: the context is lost (0x%04x)", status);
    }
    return d->lost ? FG_ERR_DEVICE : FG_OK;
}

// What passes find and what a host finds after a frame alike: as a new context has it.
static void set_common_state(void)
{
    static const GLenum off[] = {
        GL_BLEND,
        GL_CULL_FACE,
        GL_SCISSOR_TEST,
        GL_STENCIL_TEST,
        GL_DEPTH_CLAMP,
        GL_POLYGON_OFFSET_FILL,
        GL_COLOR_LOGIC_OP,
        GL_RASTERIZER_DISCARD,
        GL_SAMPLE_ALPHA_TO_COVERAGE,
        GL_SAMPLE_COVERAGE,
        GL_SAMPLE_MASK,
        GL_PRIMITIVE_RESTART,
        GL_SAMPLE_SHADING,
        GL_PROGRAM_POINT_SIZE,
        GL_PRIMITIVE_RESTART_FIXED_INDEX,
        GL_LINE_SMOOTH,
        GL_POLYGON_SMOOTH,
        GL_SAMPLE_ALPHA_TO_ONE,
        // These two for filled triangles, too, where llvmpipe is concerned.
        GL_POLYGON_OFFSET_LINE,
        GL_POLYGON_OFFSET_POINT,
    };
    for (int i = 0; i < FG_COUNT(off); ++i)
        glDisable(off[i]);
    for (GLenum i = 0; i < GL_CLIP_DISTANCES; ++i)
        glDisable(GL_CLIP_DISTANCE0 + i);
    glEnable(GL_MULTISAMPLE);
    glDepthRange(0.0, 1.0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glFrontFace(GL_CCW);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
    glStencilMask(~0u);
}

// The host goes on with what a new context has, wherever passes may have set something else.
static void leave_state(void)
{
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindVertexArray(0);
    glUseProgram(0);
    set_common_state();
    glEnable(GL_DITHER);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glStencilFunc(GL_ALWAYS, 0, ~0u);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    glBlendFunc(GL_ONE, GL_ZERO);
    glBlendEquation(GL_FUNC_ADD);
    glPointSize(1.0f);
}

// Uploads and clears take their texels as they lie.
static void set_unpacking(void)
{
    static const GLenum zero[] = {
        GL_UNPACK_ROW_LENGTH,   GL_UNPACK_SKIP_ROWS,  GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_IMAGES,
        GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST,
    };
    for (int i = 0; i < FG_COUNT(zero); ++i)
        glPixelStorei(zero[i], 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

static fg_status frame_begin(fg_device *dev, uint64_t frame, int timers)
{
    gl_device *d = (gl_device *) dev;
    if (d->lost)
        return FG_ERR_DEVICE;
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    set_unpacking();
    return gl_timers_begin_frame(d, frame, timers);
}

static fg_status frame_end(fg_device *dev)
{
    gl_device *d = (gl_device *) dev;
    close_group(d); // of a pass that failed
    gl_timers_end_frame(d);
    leave_state();
    if (d->terminates)
        glFrameTerminatorGREMEDY();
    if (d->debug)
        gl_drain_errors(d);
    glFlush(); // without a swap nothing else starts the GPU, and no timing would come back
    return check_lost(d);
}

static void barrier(fg_device *dev, unsigned bits)
{
    static const struct {
        unsigned from;
        GLbitfield to;
    } map[] = {
        { FG_BARRIER_SAMPLED, GL_TEXTURE_FETCH_BARRIER_BIT },
        { FG_BARRIER_IMAGE, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT },
        { FG_BARRIER_ATTACHMENT, GL_FRAMEBUFFER_BARRIER_BIT },
        { FG_BARRIER_STORAGE, GL_SHADER_STORAGE_BARRIER_BIT },
        { FG_BARRIER_UNIFORM, GL_UNIFORM_BARRIER_BIT },
        { FG_BARRIER_VERTEX, GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT },
        { FG_BARRIER_INDEX, GL_ELEMENT_ARRAY_BARRIER_BIT },
        { FG_BARRIER_INDIRECT, GL_COMMAND_BARRIER_BIT },
        { FG_BARRIER_COPY, GL_TEXTURE_UPDATE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                               GL_PIXEL_BUFFER_BARRIER_BIT },
    };
    GLbitfield gl = 0;
    (void) dev;
    for (int i = 0; i < FG_COUNT(map); ++i)
        if (bits & map[i].from)
            gl |= map[i].to;
    glMemoryBarrier(gl);
}

// ---- passes ---------------------------------------------------------------------

// The state that fg/gl.h promises to callbacks.
static void set_raster_state(const fg_pass_begin *begin, bool attachments)
{
    set_common_state();
    glDisable(GL_DITHER);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDepthMask(begin->depth.object && begin->depth_read_only ? GL_FALSE : GL_TRUE);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    if (attachments) {
        glEnable(GL_FRAMEBUFFER_SRGB);
        glViewport(0, 0, begin->width, begin->height);
    } else {
        glDisable(GL_FRAMEBUFFER_SRGB);
    }
}

static fg_status bind_framebuffer(gl_device *d, const fg_pass_begin *begin)
{
    const bool attachments = begin->color_count > 0 || begin->depth.object;
    GLuint framebuffer = 0;
    if (attachments) {
        framebuffer = gl_framebuffer_get(d, begin);
        if (!framebuffer)
            return FG_ERR_DEVICE;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    set_raster_state(begin, attachments);
    return FG_OK;
}

static fg_status pass_begin(fg_device *dev, const fg_pass_begin *begin)
{
    gl_device *d = (gl_device *) dev;
    const size_t length = strlen(begin->name), max = (size_t) d->max_message - 1;

    close_group(d);
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, (GLsizei) (length < max ? length : max),
                     begin->name);
    d->in_pass = true;
    if (begin->kind == FG_KIND_RASTER) {
        const fg_status status = bind_framebuffer(d, begin);
        if (status) {
            close_group(d);
            return status;
        }
    }
    glUseProgram(0);
    glBindVertexArray(d->vao);
    gl_timers_mark(d, begin->timer, false);
    return FG_OK;
}

static void pass_end(fg_device *dev, const fg_pass_begin *begin)
{
    gl_device *d = (gl_device *) dev;
    gl_timers_mark(d, begin->timer, true);
    close_group(d);
}

static void reset(fg_device *dev)
{
    gl_framebuffers_drop((gl_device *) dev);
    gl_timers_forget((gl_device *) dev);
}

// ---- life -----------------------------------------------------------------------

static void create_samplers(gl_device *d)
{
    static const GLint min[GL_FILTER_COUNT] = {
        [FG_GL_NEAREST] = GL_NEAREST,
        [FG_GL_LINEAR] = GL_LINEAR,
        [FG_GL_LINEAR_MIPMAP] = GL_LINEAR_MIPMAP_LINEAR,
        [FG_GL_SHADOW] = GL_LINEAR,
    };
    glCreateSamplers(GL_FILTER_COUNT, d->samplers);
    for (int i = 0; i < GL_FILTER_COUNT; ++i) {
        const GLuint s = d->samplers[i];
        glSamplerParameteri(s, GL_TEXTURE_MIN_FILTER, min[i]);
        glSamplerParameteri(s, GL_TEXTURE_MAG_FILTER, i == FG_GL_NEAREST ? GL_NEAREST : GL_LINEAR);
        glSamplerParameteri(s, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glSamplerParameteri(s, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        glSamplerParameteri(s, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
    }
    glSamplerParameteri(d->samplers[FG_GL_SHADOW], GL_TEXTURE_COMPARE_MODE,
                        GL_COMPARE_REF_TO_TEXTURE);
    glSamplerParameteri(d->samplers[FG_GL_SHADOW], GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
}

static void destroy(fg_device *dev)
{
    gl_device *d = (gl_device *) dev;
    gl_programs_destroy(d->programs);
    gl_framebuffers_drop(d);
    gl_timers_destroy(d);
    glDeleteSamplers(GL_FILTER_COUNT, d->samplers);
    glDeleteVertexArrays(1, &d->vao);
    stop_listening(d);
    free(d);
}

static const fg_device_ops ops = {
    .name = "gl",
    .limits = limits,
    .texture_create = gl_texture_create,
    .view_create = gl_view_create,
    .buffer_create = gl_buffer_create,
    .texture_destroy = gl_texture_destroy,
    .buffer_destroy = gl_buffer_destroy,
    .frame_begin = frame_begin,
    .frame_end = frame_end,
    .barrier = barrier,
    .clear = gl_clear,
    .pass_begin = pass_begin,
    .pass_end = pass_end,
    .timing = gl_timers_read,
    .time_of = gl_timers_of,
    .reset = reset,
    .destroy = destroy,
};

static fg_status check_version(const fg_log *log)
{
    (void) epoxy_has_egl(); // loads EGL, without which epoxy aborts where no context is current
    const int version = epoxy_gl_version();
    if (version == 0) {
        fg_logf(log, FG_LOG_ERROR, "gl device: no OpenGL context is current");
        return FG_ERR_UNSUPPORTED;
    }
    if (!epoxy_is_desktop_gl() || version < 45) {
        fg_logf(log, FG_LOG_ERROR, "gl device: the context is \"%s\", OpenGL 4.5 is needed",
                (const char *) glGetString(GL_VERSION));
        return FG_ERR_UNSUPPORTED;
    }
    return FG_OK;
}

static void begin_device(gl_device *d)
{
    snprintf(d->renderer, sizeof d->renderer, "%s", (const char *) glGetString(GL_RENDERER));
    snprintf(d->version, sizeof d->version, "%s", (const char *) glGetString(GL_VERSION));
    glGetIntegerv(GL_MAX_LABEL_LENGTH, &d->max_label);
    glGetIntegerv(GL_MAX_DEBUG_MESSAGE_LENGTH, &d->max_message);
    listen(d);
    // A tool that records (apitrace) knows frames by their swaps. Without a surface there are none.
    d->terminates =
        epoxy_has_gl_extension("GL_GREMEDY_frame_terminator") &&
        glCheckNamedFramebufferStatus(0, GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_UNDEFINED;
    gl_read_limits(d);
    glCreateVertexArrays(1, &d->vao);
    create_samplers(d);
}

fg_status fg_gl_device_create(const fg_gl_device_desc *desc, fg_device **out)
{
    static const fg_gl_device_desc plain = { 0 };
    if (!desc)
        desc = &plain;
    *out = NULL;

    const fg_status status = check_version(desc->log);
    if (status)
        return status;
    gl_device *d = calloc(1, sizeof *d);
    if (!d) {
        fg_logf(desc->log, FG_LOG_ERROR, "gl device: out of memory");
        return FG_ERR_MEMORY;
    }
    d->base.ops = &ops;
    d->log = desc->log;
    d->timers.current = -1;
    begin_device(d);
    d->software = gl_is_software(d->renderer);
    d->timers.on_cpu = d->software && !desc->timestamps;
    gl_timers_set_clock(d);
    d->programs = gl_programs_create(d, desc);
    if (!d->programs) {
        fg_logf(desc->log, FG_LOG_ERROR, "gl device: out of memory");
        destroy(&d->base);
        return FG_ERR_MEMORY;
    }
    *out = &d->base;
    return FG_OK;
}

// ---- asking ---------------------------------------------------------------------

gl_device *gl_device_of(fg_device *dev)
{
    return dev && dev->ops == &ops ? (gl_device *) dev : NULL;
}

bool gl_is_software(const char *renderer)
{
    return strstr(renderer, "llvmpipe") || strstr(renderer, "softpipe") ||
           strstr(renderer, "swrast");
}

bool fg_gl_software(const fg_device *dev)
{
    return ((const gl_device *) dev)->software;
}

int fg_gl_error_count(const fg_device *dev)
{
    return ((const gl_device *) dev)->errors;
}

const char *fg_gl_renderer(const fg_device *dev)
{
    return ((const gl_device *) dev)->renderer;
}

const char *fg_gl_version(const fg_device *dev)
{
    return ((const gl_device *) dev)->version;
}

fg_status fg_gl_finish(fg_device *dev)
{
    gl_device *d = (gl_device *) dev;
    glFinish();
    gl_timers_collect(d);
    return check_lost(d);
}
