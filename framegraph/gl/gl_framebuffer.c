// SPDX-License-Identifier: MIT
#include "gl_priv.h"

#include <stdlib.h>

// ---- cache ----------------------------------------------------------------------

static gl_framebuffer *find(gl_framebuffers *f, uint64_t key)
{
    const uint64_t mask = (uint64_t) f->capacity - 1;
    uint64_t at = (key ^ key >> 32) & mask; // keys are hashes already
    while (f->places[at].name && f->places[at].key != key)
        at = (at + 1) & mask;
    return &f->places[at];
}

static bool resize(gl_framebuffers *f, int capacity)
{
    gl_framebuffers bigger = { .capacity = capacity };
    bigger.places = calloc((size_t) capacity, sizeof *bigger.places);
    if (!bigger.places)
        return false;
    for (int i = 0; i < f->capacity; ++i) {
        if (!f->places[i].name)
            continue;
        *find(&bigger, f->places[i].key) = f->places[i];
        ++bigger.count;
    }
    free(f->places);
    *f = bigger;
    return true;
}

static void release(gl_framebuffer *f)
{
    glDeleteFramebuffers(1, &f->name);
    *f = (gl_framebuffer){ 0 };
}

void gl_framebuffers_drop(gl_device *d)
{
    gl_framebuffers *f = &d->framebuffers;
    for (int i = 0; i < f->capacity; ++i)
        if (f->places[i].name)
            release(&f->places[i]);
    free(f->places);
    *f = (gl_framebuffers){ 0 };
}

void gl_framebuffers_drop_object(gl_device *d, GLuint object)
{
    gl_framebuffers *f = &d->framebuffers;
    bool dropped = false;
    for (int i = 0; i < f->capacity; ++i) {
        bool holds = false;
        for (int k = 0; k < f->places[i].count; ++k)
            holds = holds || f->places[i].objects[k] == object;
        if (holds)
            release(&f->places[i]);
        dropped = dropped || holds;
    }
    // Holes would cut the probe sequences of what stays: lay it out anew.
    if (dropped && !resize(f, f->capacity))
        gl_framebuffers_drop(d);
}

void fg_gl_forget_texture(fg_device *dev, uint32_t object)
{
    gl_device *d = gl_device_of(dev);
    if (d)
        gl_framebuffers_drop_object(d, object);
}

// ---- building -------------------------------------------------------------------

static GLenum depth_point(GLuint texture)
{
    GLint format = 0;
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
    const bool stencil = format == GL_DEPTH24_STENCIL8 || format == GL_DEPTH32F_STENCIL8;
    return stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT;
}

static bool has_layers(GLenum target)
{
    return target == GL_TEXTURE_3D || target == GL_TEXTURE_2D_ARRAY ||
           target == GL_TEXTURE_CUBE_MAP || target == GL_TEXTURE_CUBE_MAP_ARRAY ||
           target == GL_TEXTURE_2D_MULTISAMPLE_ARRAY;
}

// One layer, or the whole level: the graph refuses what lies between.
static void attach(gl_framebuffer *f, const fg_attachment *a, GLenum point)
{
    GLint target = 0;
    glGetTextureParameteriv(a->object, GL_TEXTURE_TARGET, &target);
    if (has_layers((GLenum) target) && !a->layered)
        glNamedFramebufferTextureLayer(f->name, point, a->object, a->mip, a->layer);
    else
        glNamedFramebufferTexture(f->name, point, a->object, a->mip);
    f->objects[f->count++] = a->object;
}

static const char *status_reason(GLenum status)
{
    switch (status) {
    case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
        return "an attachment cannot be rendered to (its format, or its mip or layer is not there)";
    case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT: return "it has no attachment";
    case GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE: return "sample counts differ";
    case GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS: return "layered and other attachments are mixed";
    case GL_FRAMEBUFFER_UNSUPPORTED: return "the driver has no such combination of formats";
    default: return "it is incomplete";
    }
}

static bool build(gl_device *d, const fg_pass_begin *begin, gl_framebuffer *f)
{
    GLenum buffers[FG_MAX_WRITES];

    *f = (gl_framebuffer){ .key = begin->framebuffer_key };
    glCreateFramebuffers(1, &f->name);
    for (int i = 0; i < begin->color_count; ++i) {
        const GLenum point = GL_COLOR_ATTACHMENT0 + (GLenum) i;
        buffers[i] = begin->color[i].object ? point : GL_NONE;
        if (begin->color[i].object)
            attach(f, &begin->color[i], point);
    }
    if (begin->depth.object)
        attach(f, &begin->depth, depth_point(begin->depth.object));
    glNamedFramebufferDrawBuffers(f->name, begin->color_count, buffers);
    gl_label(d, GL_FRAMEBUFFER, f->name, begin->name);

    const GLenum status = glCheckNamedFramebufferStatus(f->name, GL_DRAW_FRAMEBUFFER);
    if (status == GL_FRAMEBUFFER_COMPLETE)
        return true;
    fg_logf(d->log, FG_LOG_ERROR, "%s: its framebuffer is refused: %s (0x%04x)", begin->name,
            status_reason(status), status);
    release(f);
    return false;
}

GLuint gl_framebuffer_get(gl_device *d, const fg_pass_begin *begin)
{
    gl_framebuffers *f = &d->framebuffers;
    if (f->capacity > 0) {
        const gl_framebuffer *there = find(f, begin->framebuffer_key);
        if (there->name)
            return there->name;
    }
    if (2 * (f->count + 1) > f->capacity && !resize(f, f->capacity ? 2 * f->capacity : 32)) {
        fg_logf(d->log, FG_LOG_ERROR, "%s: out of memory for its framebuffer", begin->name);
        return 0;
    }
    gl_framebuffer *place = find(f, begin->framebuffer_key);
    if (!build(d, begin, place))
        return 0;
    ++f->count;
    return place->name;
}
