// SPDX-License-Identifier: MIT
#include "gl_priv.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef EGL_EXT_device_drm_render_node
#define EGL_DRM_RENDER_NODE_FILE_EXT 0x3377
#endif
#ifndef EGL_EXT_device_query_name
#define EGL_RENDERER_EXT 0x335F
#endif

enum { MAX_CANDIDATES = 32, REASON = 160 };

struct fg_gl_context {
    EGLDisplay display; // never terminated: the host may have initialised the same one
    EGLContext context;
};

// One way to a display: an EGL device, or Mesa's platform without a surface.
typedef struct candidate {
    EGLDeviceEXT device; // EGL_NO_DEVICE_EXT: surfaceless
    bool software;
    char name[128];
} candidate;

// What was current before a temporary context was.
typedef struct current {
    EGLenum api;
    EGLDisplay display;
    EGLSurface draw, read;
    EGLContext context;
} current;

// ---- candidates -----------------------------------------------------------------

// Extension strings are lists separated by blanks; a name may begin another.
static bool has_word(const char *list, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = list ? strstr(list, word) : NULL; at; at = strstr(at + length, word)) {
        const bool starts = at == list || at[-1] == ' ';
        if (starts && (at[length] == ' ' || at[length] == '\0'))
            return true;
    }
    return false;
}

static void describe(EGLDeviceEXT device, int n, candidate *c)
{
    const char *extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
    const char *name = NULL;

    c->device = device;
    c->software = has_word(extensions, "EGL_MESA_device_software");
    if (has_word(extensions, "EGL_EXT_device_query_name"))
        name = eglQueryDeviceStringEXT(device, EGL_RENDERER_EXT);
    if (!name && has_word(extensions, "EGL_EXT_device_drm_render_node"))
        name = eglQueryDeviceStringEXT(device, EGL_DRM_RENDER_NODE_FILE_EXT);
    if (!name && has_word(extensions, "EGL_EXT_device_drm"))
        name = eglQueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT);
    if (name)
        snprintf(c->name, sizeof c->name, "%s", name);
    else
        snprintf(c->name, sizeof c->name, "EGL device %d%s", n, c->software ? " (software)" : "");
}

// All candidates in the order of fg_gl_get_device_info().
static int list_candidates(candidate *out)
{
    int count = 0;
    if (!epoxy_has_egl())
        return 0;
    const char *client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!has_word(client, "EGL_EXT_platform_base"))
        return 0;

    const bool enumerates = has_word(client, "EGL_EXT_device_base") ||
                            (has_word(client, "EGL_EXT_device_enumeration") &&
                             has_word(client, "EGL_EXT_device_query"));
    EGLDeviceEXT devices[MAX_CANDIDATES - 1];
    EGLint found = 0;
    if (enumerates && has_word(client, "EGL_EXT_platform_device") &&
        eglQueryDevicesEXT(MAX_CANDIDATES - 1, devices, &found)) {
        for (; count < found; ++count)
            describe(devices[count], count + 1, &out[count]);
    }
    if (has_word(client, "EGL_MESA_platform_surfaceless")) {
        // What stands behind it shows only in the renderer; it is tried after real devices.
        out[count] = (candidate){ .device = EGL_NO_DEVICE_EXT, .software = true };
        snprintf(out[count].name, sizeof out[count].name, "surfaceless");
        ++count;
    }
    return count;
}

// ---- contexts -------------------------------------------------------------------

static const char *egl_reason(void)
{
    switch (eglGetError()) {
    case EGL_SUCCESS: return "no reason given";
    case EGL_NOT_INITIALIZED: return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS: return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC: return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE: return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG: return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT: return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY: return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH: return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER: return "EGL_BAD_PARAMETER";
    case EGL_CONTEXT_LOST: return "EGL_CONTEXT_LOST";
    default: return "an unknown EGL error";
    }
}

static bool open_display(const candidate *c, EGLDisplay *display, char reason[REASON])
{
    if (c->device == EGL_NO_DEVICE_EXT)
        *display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA,
                                            (void *) EGL_DEFAULT_DISPLAY, NULL);
    else
        *display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, c->device, NULL);
    if (*display == EGL_NO_DISPLAY || !eglInitialize(*display, NULL, NULL)) {
        snprintf(reason, REASON, "no display (%s)", egl_reason());
        return false;
    }
    if (!epoxy_has_egl_extension(*display, "EGL_KHR_surfaceless_context")) {
        snprintf(reason, REASON, "no EGL_KHR_surfaceless_context");
        return false;
    }
    return true;
}

static EGLConfig choose_config(EGLDisplay display)
{
    const EGLint wanted[] = { EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE };
    EGLConfig config = NULL;
    EGLint count = 0;
    if (epoxy_has_egl_extension(display, "EGL_KHR_no_config_context"))
        return EGL_NO_CONFIG_KHR;
    return eglChooseConfig(display, wanted, &config, 1, &count) && count ? config : NULL;
}

static EGLContext create_45(EGLDisplay display, bool debug, bool robust)
{
    EGLint attributes[16] = {
        EGL_CONTEXT_MAJOR_VERSION,       4,
        EGL_CONTEXT_MINOR_VERSION,       5,
        EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
    };
    int n = 6;
    if (debug) {
        attributes[n++] = EGL_CONTEXT_OPENGL_DEBUG;
        attributes[n++] = EGL_TRUE;
    }
    if (robust) {
        attributes[n++] = EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY;
        attributes[n++] = EGL_LOSE_CONTEXT_ON_RESET;
    }
    attributes[n] = EGL_NONE;
    return eglCreateContext(display, choose_config(display), EGL_NO_CONTEXT, attributes);
}

// Creates a context on `c` and makes it current; says why it could not.
static bool open_context(const candidate *c, bool debug, fg_gl_context *ctx, char reason[REASON])
{
    if (!open_display(c, &ctx->display, reason))
        return false;
    if (epoxy_egl_version(ctx->display) < 15) {
        snprintf(reason, REASON, "EGL is older than 1.5");
        return false;
    }
    if (!eglBindAPI(EGL_OPENGL_API)) {
        snprintf(reason, REASON, "no OpenGL (%s)", egl_reason());
        return false;
    }
    // Without a reset notification a lost GPU shows only as wrong pictures; llvmpipe has none.
    ctx->context = create_45(ctx->display, debug, true);
    if (ctx->context == EGL_NO_CONTEXT)
        ctx->context = create_45(ctx->display, debug, false);
    if (ctx->context == EGL_NO_CONTEXT) {
        snprintf(reason, REASON, "no OpenGL 4.5 core context (%s)", egl_reason());
        return false;
    }
    if (!eglMakeCurrent(ctx->display, EGL_NO_SURFACE, EGL_NO_SURFACE, ctx->context)) {
        snprintf(reason, REASON, "the context cannot be made current (%s)", egl_reason());
        eglDestroyContext(ctx->display, ctx->context);
        return false;
    }
    return true;
}

static current save_current(void)
{
    return (current){
        .api = eglQueryAPI(),
        .display = eglGetCurrentDisplay(),
        .draw = eglGetCurrentSurface(EGL_DRAW),
        .read = eglGetCurrentSurface(EGL_READ),
        .context = eglGetCurrentContext(),
    };
}

static void restore_current(const current *c, EGLDisplay opened)
{
    if (c->context != EGL_NO_CONTEXT)
        eglMakeCurrent(c->display, c->draw, c->read, c->context);
    else if (opened != EGL_NO_DISPLAY)
        eglMakeCurrent(opened, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglBindAPI(c->api);
}

// Tries candidate `i`; on failure appends its name and reason to `why`.
static bool try_candidate(const candidate *c, bool debug, fg_gl_context *ctx, char *why,
                          size_t size)
{
    char reason[REASON];
    if (open_context(c, debug, ctx, reason))
        return true;
    const size_t used = strlen(why);
    snprintf(why + used, size - used, "%s%s: %s", used ? "; " : "", c->name, reason);
    return false;
}

static fg_status choose(const fg_gl_context_desc *desc, fg_gl_context *ctx)
{
    candidate all[MAX_CANDIDATES];
    char why[768] = "";
    const int count = list_candidates(all);

    if (count == 0) {
        fg_logf(desc->log, FG_LOG_ERROR,
                "gl context: EGL gives no device: no driver is installed, or it has neither "
                "EGL_EXT_platform_device nor EGL_MESA_platform_surfaceless");
        return FG_ERR_UNSUPPORTED;
    }
    if (desc->device < 0 || desc->device > count) {
        fg_logf(desc->log, FG_LOG_ERROR, "gl context: device is %d, must be 0 (any) to %d",
                desc->device, count);
        return FG_ERR_INVALID;
    }
    const current before = save_current();
    for (int software = 0; software < 2; ++software) {
        for (int i = 0; i < count; ++i) {
            const bool wanted =
                desc->device ? i + 1 == desc->device && !software : all[i].software == software;
            if (wanted && try_candidate(&all[i], desc->debug, ctx, why, sizeof why))
                return FG_OK;
        }
    }
    restore_current(&before, EGL_NO_DISPLAY);
    fg_logf(desc->log, FG_LOG_ERROR, "gl context: no device gives OpenGL 4.5 core: %s", why);
    return FG_ERR_UNSUPPORTED;
}

fg_status fg_gl_context_create(const fg_gl_context_desc *desc, fg_gl_context **out)
{
    static const fg_gl_context_desc plain = { 0 };
    if (!desc)
        desc = &plain;
    *out = NULL;

    fg_gl_context *ctx = calloc(1, sizeof *ctx);
    if (!ctx) {
        fg_logf(desc->log, FG_LOG_ERROR, "gl context: out of memory");
        return FG_ERR_MEMORY;
    }
    const fg_status status = choose(desc, ctx);
    if (status) {
        free(ctx);
        return status;
    }
    fg_logf(desc->log, FG_LOG_INFO, "gl context: %s, OpenGL %s", glGetString(GL_RENDERER),
            glGetString(GL_VERSION));
    *out = ctx;
    return FG_OK;
}

void fg_gl_context_destroy(fg_gl_context *ctx)
{
    if (!ctx)
        return;
    if (eglGetCurrentContext() == ctx->context)
        eglMakeCurrent(ctx->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(ctx->display, ctx->context);
    free(ctx);
}

fg_status fg_gl_context_make_current(fg_gl_context *ctx)
{
    const bool done = eglBindAPI(EGL_OPENGL_API) &&
                      eglMakeCurrent(ctx->display, EGL_NO_SURFACE, EGL_NO_SURFACE, ctx->context);
    return done ? FG_OK : FG_ERR_DEVICE;
}

// ---- listing --------------------------------------------------------------------

bool fg_gl_get_device_info(int n, fg_gl_device_info *info)
{
    candidate all[MAX_CANDIDATES];
    char reason[REASON];
    fg_gl_context ctx = { .display = EGL_NO_DISPLAY };

    *info = (fg_gl_device_info){ 0 };
    const int count = list_candidates(all);
    if (n < 1 || n > count)
        return false;

    const candidate *c = &all[n - 1];
    snprintf(info->name, sizeof info->name, "%s", c->name);
    info->software = c->software;
    const current before = save_current();
    if (open_context(c, false, &ctx, reason)) {
        snprintf(info->renderer, sizeof info->renderer, "%s", glGetString(GL_RENDERER));
        snprintf(info->version, sizeof info->version, "%s", glGetString(GL_VERSION));
        info->software = gl_is_software(info->renderer);
        restore_current(&before, ctx.display);
        eglDestroyContext(ctx.display, ctx.context);
    } else {
        restore_current(&before, EGL_NO_DISPLAY);
    }
    return true;
}
