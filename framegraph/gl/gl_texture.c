// SPDX-License-Identifier: MIT
#include "gl_priv.h"

#include <stdio.h>
#include <unistd.h>

#ifndef GL_GPU_MEMORY_INFO_DEDICATED_VIDMEM_NVX
#define GL_GPU_MEMORY_INFO_DEDICATED_VIDMEM_NVX 0x9047
#endif

// ---- limits ---------------------------------------------------------------------

// No single object can be larger than all the memory there is: what lies above is
// refused before a driver is asked, since some promise it and die in the first use.
static uint64_t memory_bytes(void)
{
    GLint kib = 0;
    if (epoxy_has_gl_extension("GL_NVX_gpu_memory_info"))
        glGetIntegerv(GL_GPU_MEMORY_INFO_DEDICATED_VIDMEM_NVX, &kib);
    if (kib > 0)
        return (uint64_t) kib * 1024;
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
    return pages > 0 && page > 0 ? (uint64_t) pages * (uint64_t) page : UINT64_C(1) << 32;
}

static int integer(GLenum name)
{
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

void gl_read_limits(gl_device *d)
{
    const int draw_buffers = integer(GL_MAX_DRAW_BUFFERS);
    const int attachments = integer(GL_MAX_COLOR_ATTACHMENTS);
    d->limits = (fg_device_limits){
        .max_color_attachments = attachments < draw_buffers ? attachments : draw_buffers,
        .max_texture_size = integer(GL_MAX_TEXTURE_SIZE),
        .max_3d_size = integer(GL_MAX_3D_TEXTURE_SIZE),
        .max_layers = integer(GL_MAX_ARRAY_TEXTURE_LAYERS),
        .max_samples = integer(GL_MAX_SAMPLES),
        .max_buffer_bytes = memory_bytes(),
    };
}

// ---- textures -------------------------------------------------------------------

static uint64_t texture_bytes(const fg_tex_desc *desc)
{
    double bytes = 0.0; // a product of six counts: no integer overflow to watch for
    for (int mip = 0; mip < desc->mips; ++mip) {
        const int w = desc->width >> mip, h = desc->height >> mip, z = desc->depth >> mip;
        bytes += (double) (w ? w : 1) * (h ? h : 1) * (z ? z : 1);
    }
    bytes *= (desc->layers ? desc->layers : 1) * (double) (desc->samples ? desc->samples : 1);
    bytes *= fg_format_get(desc->format)->bytes;
    return bytes < 1e18 ? (uint64_t) bytes : UINT64_C(1000000000000000000);
}

static fg_status refuse(const gl_device *d, const char *label, const char *what, int value, int max)
{
    fg_logf(d->log, FG_LOG_ERROR, "%s: %s is %d, this device allows at most %d", label, what, value,
            max);
    return FG_ERR_UNSUPPORTED;
}

static fg_status check_texture(const gl_device *d, const char *label, const fg_tex_desc *desc)
{
    const fg_device_limits *l = &d->limits;
    const int side = desc->depth > 0 ? l->max_3d_size : l->max_texture_size;
    const uint64_t bytes = texture_bytes(desc);
    GLint samples = 1;

    if (desc->width > side)
        return refuse(d, label, "width", desc->width, side);
    if (desc->height > side)
        return refuse(d, label, "height", desc->height, side);
    if (desc->depth > l->max_3d_size)
        return refuse(d, label, "depth", desc->depth, l->max_3d_size);
    if (desc->layers > l->max_layers)
        return refuse(d, label, "layers", desc->layers, l->max_layers);
    if (desc->samples > 1)
        glGetInternalformativ(gl_target(desc), gl_format_get(desc->format)->internal, GL_SAMPLES, 1,
                              &samples);
    if (desc->samples > 1 && desc->samples > samples)
        return refuse(d, label, "samples", desc->samples, samples);
    if (bytes > l->max_buffer_bytes) {
        fg_logf(d->log, FG_LOG_ERROR, "%s: %dx%d %s takes %.1f MiB, the device has %.1f MiB", label,
                desc->width, desc->height, fg_format_get(desc->format)->name,
                (double) bytes / 1048576.0, (double) l->max_buffer_bytes / 1048576.0);
        return FG_ERR_MEMORY;
    }
    return FG_OK;
}

static void allocate(GLuint name, const fg_tex_desc *desc)
{
    const GLenum internal = gl_format_get(desc->format)->internal;
    const int w = desc->width, h = desc->height;
    switch (gl_target(desc)) {
    case GL_TEXTURE_3D: glTextureStorage3D(name, desc->mips, internal, w, h, desc->depth); break;
    case GL_TEXTURE_2D_ARRAY:
    case GL_TEXTURE_CUBE_MAP_ARRAY:
        glTextureStorage3D(name, desc->mips, internal, w, h, desc->layers);
        break;
    case GL_TEXTURE_2D_MULTISAMPLE:
        glTextureStorage2DMultisample(name, desc->samples, internal, w, h, GL_TRUE);
        break;
    case GL_TEXTURE_2D_MULTISAMPLE_ARRAY:
        glTextureStorage3DMultisample(name, desc->samples, internal, w, h, desc->layers, GL_TRUE);
        break;
    default: glTextureStorage2D(name, desc->mips, internal, w, h); break;
    }
}

// Ends a creation: the driver says only through glGetError that it had no memory. What was
// refused is deleted, the rest gets its label.
static fg_status created(gl_device *d, GLenum kind, const char *label, const char *what, int before,
                         uint32_t *object)
{
    const bool no_memory = gl_drain_errors(d);
    d->allocating = false;
    if (!no_memory && d->errors == before) {
        gl_label(d, kind, *object, label);
        return FG_OK;
    }
    fg_logf(d->log, FG_LOG_ERROR, "%s: the driver %s %s", label,
            no_memory ? "has no memory for" : "refused", what);
    if (kind == GL_BUFFER)
        glDeleteBuffers(1, object);
    else
        glDeleteTextures(1, object);
    *object = 0;
    return no_memory ? FG_ERR_MEMORY : FG_ERR_UNSUPPORTED;
}

fg_status gl_texture_create(fg_device *dev, const char *label, const fg_tex_desc *desc,
                            uint32_t *object)
{
    gl_device *d = (gl_device *) dev;
    char what[96];

    *object = 0;
    fg_status status = check_texture(d, label, desc);
    if (status)
        return status;
    gl_drain_errors(d); // those of others
    const int before = d->errors;
    d->allocating = true;
    glCreateTextures(gl_target(desc), 1, object);
    allocate(*object, desc);
    snprintf(what, sizeof what, "a texture %s %dx%d, %d mips, %d layers",
             fg_format_get(desc->format)->name, desc->width, desc->height, desc->mips,
             desc->depth > 0 ? desc->depth : desc->layers);
    return created(d, GL_TEXTURE, label, what, before, object);
}

fg_status gl_view_create(fg_device *dev, const char *label, uint32_t of, const fg_tex_desc *desc,
                         uint32_t *object)
{
    gl_device *d = (gl_device *) dev;
    const GLenum target = gl_target(desc);
    const GLuint layers = target != GL_TEXTURE_3D && desc->layers > 0 ? (GLuint) desc->layers : 1;
    char what[96];

    gl_drain_errors(d);
    const int before = d->errors;
    d->allocating = true;
    glGenTextures(1, object); // not glCreateTextures: a view takes a name without a texture
    glTextureView(*object, target, of, gl_format_get(desc->format)->internal, 0,
                  (GLuint) desc->mips, 0, layers);
    snprintf(what, sizeof what, "a view %s of texture %u", fg_format_get(desc->format)->name, of);
    return created(d, GL_TEXTURE, label, what, before, object);
}

void gl_texture_destroy(fg_device *dev, uint32_t object)
{
    gl_framebuffers_drop_object((gl_device *) dev, object);
    glDeleteTextures(1, &object);
}

// ---- buffers --------------------------------------------------------------------

fg_status gl_buffer_create(fg_device *dev, const char *label, uint64_t size, uint32_t *object)
{
    gl_device *d = (gl_device *) dev;
    char what[64];

    *object = 0;
    if (size > d->limits.max_buffer_bytes) {
        fg_logf(d->log, FG_LOG_ERROR, "%s: a buffer of %.1f MiB, the device has %.1f MiB", label,
                (double) size / 1048576.0, (double) d->limits.max_buffer_bytes / 1048576.0);
        return FG_ERR_MEMORY;
    }
    gl_drain_errors(d);
    const int before = d->errors;
    d->allocating = true;
    glCreateBuffers(1, object);
    // DYNAMIC_STORAGE: callbacks may upload with glNamedBufferSubData.
    glNamedBufferStorage(*object, (GLsizeiptr) size, NULL, GL_DYNAMIC_STORAGE_BIT);
    snprintf(what, sizeof what, "a buffer of %llu bytes", (unsigned long long) size);
    return created(d, GL_BUFFER, label, what, before, object);
}

void gl_buffer_destroy(fg_device *dev, uint32_t object)
{
    (void) dev;
    glDeleteBuffers(1, &object);
}
